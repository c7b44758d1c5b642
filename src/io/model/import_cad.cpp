#include "io/model/import_cad.h"

#include <sys/mman.h>
#include <unistd.h>

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <NCollection_DataMap.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <ShapeAnalysis_ShapeTolerance.hxx>
#include <Standard_OutOfMemory.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDF_Tool.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Iterator.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XCAFPrs.hxx>
#include <XCAFPrs_DocumentExplorer.hxx>
#include <XCAFPrs_Style.hxx>
#include <algorithm>
#include <cmath>
#include <istream>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <streambuf>
#include <string>

#include "core/text/units.h"
#include "io/model/cad_faces.h"

namespace tuft::io {
namespace {

constexpr double kSewn = 1e-5;  // of the diagonal: edges of loose faces so close are one
constexpr std::size_t kMostPlacements = 1'000'000;

/// Bytes in memory, of which a stream reads.
class MemoryBuffer : public std::streambuf {
  public:
    explicit MemoryBuffer(std::span<const char> bytes) {
        char* begin = const_cast<char*>(bytes.data());
        setg(begin, begin, begin + bytes.size());
    }

  private:
    pos_type seekoff(off_type by, std::ios_base::seekdir from, std::ios_base::openmode) override {
        const off_type base = from == std::ios_base::beg   ? 0
                              : from == std::ios_base::cur ? gptr() - eback()
                                                           : egptr() - eback();
        if (base + by < 0 || base + by > egptr() - eback()) return pos_type(off_type(-1));
        setg(eback(), eback() + base + by, egptr());
        return pos_type(base + by);
    }
    pos_type seekpos(pos_type at, std::ios_base::openmode which) override {
        return seekoff(off_type(at), std::ios_base::beg, which);
    }
};

/// Bytes in memory as a file with a name: the reader of IGES takes nothing else.
class NamedBytes {
  public:
    explicit NamedBytes(std::span<const char> bytes) : fd_(memfd_create("tuft", MFD_CLOEXEC)) {
        for (std::size_t at = 0; fd_ >= 0 && at < bytes.size();) {
            const ssize_t n = write(fd_, bytes.data() + at, bytes.size() - at);
            if (n <= 0) break;
            at += static_cast<std::size_t>(n);
        }
    }
    ~NamedBytes() {
        if (fd_ >= 0) close(fd_);
    }
    NamedBytes(const NamedBytes&) = delete;
    NamedBytes& operator=(const NamedBytes&) = delete;
    std::string name() const { return "/proc/self/fd/" + std::to_string(fd_); }

  private:
    int fd_;
};

using Document = Handle(TDocStd_Document);

void read_step(std::span<const char> bytes, Document& document) {
    STEPCAFControl_Reader reader;
    Interface_Static::SetIVal("read.stepcaf.subshapes.name", 1);
    reader.SetColorMode(true);
    reader.SetNameMode(true);
    reader.SetLayerMode(false);
    reader.SetPropsMode(false);
    reader.SetSHUOMode(true);
    reader.SetGDTMode(false);
    reader.SetMatMode(false);
    reader.SetViewMode(false);
    MemoryBuffer buffer(bytes);
    std::istream stream(&buffer);
    if (reader.ChangeReader().ReadStream("model.stp", stream) != IFSelect_RetDone || !reader.Transfer(document))
        throw std::runtime_error(kNotCad);
}

void read_iges(std::span<const char> bytes, Document& document) {
    IGESCAFControl_Reader reader;
    reader.SetReadVisible(true);  // what the file hides is no part of the model
    reader.SetColorMode(true);
    reader.SetNameMode(true);
    reader.SetLayerMode(false);
    const NamedBytes file(bytes);
    if (reader.ReadFile(file.name().c_str()) != IFSelect_RetDone || !reader.Transfer(document))
        throw std::runtime_error(kNotCad);
}

std::string name_of(const TDF_Label& label) {
    Handle(TDataStd_Name) name;
    if (label.IsNull() || !label.FindAttribute(TDataStd_Name::GetID(), name)) return {};
    const TCollection_AsciiString text(name->Get());  // UTF-8
    std::string out(text.ToCString(), static_cast<std::size_t>(text.Length()));
    const bool made_up = out.starts_with("=>[") || out == "NONE" || out == "SOLID" || out == "SHELL" ||
                         out == "COMPOUND" || out == "ASSEMBLY" || out == "FACE";
    return made_up ? std::string() : out;
}

template <class Value>
using ShapeMap = NCollection_DataMap<TopoDS_Shape, Value, TopTools_ShapeMapHasher>;

/// A product of the file: its bodies, each a solid or a shell, and what is said of its faces.
struct Product {
    std::string name;
    std::vector<TopoDS_Shape> bodies;
    ShapeMap<std::string> names;     ///< of bodies and faces
    ShapeMap<XCAFPrs_Style> styles;  ///< of faces
};

std::vector<TopoDS_Shape> parts_of(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind,
                                   TopAbs_ShapeEnum outside = TopAbs_SHAPE) {
    std::vector<TopoDS_Shape> out;
    for (TopExp_Explorer at(shape, kind, outside); at.More(); at.Next()) out.push_back(at.Current());
    return out;
}

/// Whether all shells of a solid, or a shell, are closed.
bool is_closed(const TopoDS_Shape& body) {
    const std::vector<TopoDS_Shape> shells = parts_of(body, TopAbs_SHELL);
    return !shells.empty() && std::all_of(shells.begin(), shells.end(),
                                          [](const TopoDS_Shape& shell) { return BRep_Tool::IsClosed(shell); });
}

TopoDS_Compound compound_of(const std::vector<TopoDS_Shape>& shapes) {
    const BRep_Builder builder;
    TopoDS_Compound all;
    builder.MakeCompound(all);
    for (const TopoDS_Shape& shape : shapes) builder.Add(all, shape);
    return all;
}

/// Sews loose faces into shells. What was said of a face is said of what becomes of it.
void sew(const std::vector<TopoDS_Shape>& faces, double diagonal, Product& product) {
    ShapeAnalysis_ShapeTolerance measure;
    const double stated = measure.Tolerance(compound_of(faces), 1);
    BRepBuilderAPI_Sewing sewing(std::clamp(stated, kSewn * diagonal, kChordPart * diagonal));
    for (const TopoDS_Shape& face : faces) sewing.Add(face);
    sewing.Perform();
    for (const TopoDS_Shape& face : faces) {
        if (!sewing.IsModified(face)) continue;
        const TopoDS_Shape became = sewing.Modified(face);
        if (product.styles.IsBound(face)) product.styles.Bind(became, product.styles.Find(face));
        if (product.names.IsBound(face)) product.names.Bind(became, product.names.Find(face));
    }
    const TopoDS_Shape sewn = sewing.SewedShape();
    if (sewn.IsNull()) return;
    const std::vector<TopoDS_Shape> shells = parts_of(sewn, TopAbs_SHELL);
    product.bodies.insert(product.bodies.end(), shells.begin(), shells.end());
    const std::vector<TopoDS_Shape> alone = parts_of(sewn, TopAbs_FACE, TopAbs_SHELL);
    if (!alone.empty()) product.bodies.push_back(compound_of(alone));
}

void find_bodies(const TopoDS_Shape& shape, double diagonal, Product& product) {
    std::vector<TopoDS_Shape> loose;
    const auto sort_out = [&](const std::vector<TopoDS_Shape>& bodies) {
        for (const TopoDS_Shape& body : bodies) {
            if (is_closed(body)) {
                product.bodies.push_back(body);
                continue;
            }
            const std::vector<TopoDS_Shape> faces = parts_of(body, TopAbs_FACE);
            loose.insert(loose.end(), faces.begin(), faces.end());
        }
    };
    sort_out(parts_of(shape, TopAbs_SOLID));
    sort_out(parts_of(shape, TopAbs_SHELL, TopAbs_SOLID));
    const std::vector<TopoDS_Shape> faces = parts_of(shape, TopAbs_FACE, TopAbs_SHELL);
    loose.insert(loose.end(), faces.begin(), faces.end());
    if (!loose.empty()) sew(loose, diagonal, product);
}

/// The finest statement counts: that of a face before that of its shell, of its solid, of the whole.
void find_styles(const TDF_Label& label, Product& product) {
    XCAFPrs_IndexedDataMapOfShapeStyle stated;
    XCAFPrs::CollectStyleSettings(label, TopLoc_Location(), stated);
    for (int kind = TopAbs_FACE; kind >= TopAbs_COMPOUND; --kind)
        for (int i = 1; i <= stated.Extent(); ++i) {
            if (stated.FindKey(i).ShapeType() != kind) continue;
            for (const TopoDS_Shape& face : parts_of(stated.FindKey(i), TopAbs_FACE))
                if (!product.styles.IsBound(face)) product.styles.Bind(face, stated.FindFromIndex(i));
        }
}

void find_names(const TDF_Label& label, Product& product) {
    product.name = name_of(label);
    TDF_LabelSequence inside;
    XCAFDoc_ShapeTool::GetSubShapes(label, inside);
    for (const TDF_Label& part : inside) {
        const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(part);
        const std::string name = name_of(part);
        if (!shape.IsNull() && !name.empty()) product.names.Bind(shape, name);
    }
}

class CadScene {
  public:
    CadScene(const Document& document, const CadRequest& request) : document_(document), by_faces_(request.by_faces) {
        Bnd_Box box;
        TDF_LabelSequence roots;
        XCAFDoc_DocumentTool::ShapeTool(document->Main())->GetFreeShapes(roots);
        for (const TDF_Label& root : roots) BRepBndLib::Add(XCAFDoc_ShapeTool::GetShape(root), box, false);
        if (box.IsVoid() || box.IsOpen() || !(box.SquareExtent() > 0)) throw std::runtime_error(kNoCadFaces);
        diagonal_ = std::sqrt(box.SquareExtent());
        chord_ = request.chord > 0 ? request.chord / kMillimetre : kChordPart * diagonal_;
        if (chord_ < 1e-6 * diagonal_) throw std::runtime_error(kTooFineChord);
    }

    FileScene run() {
        std::size_t placements = 0;
        for (XCAFPrs_DocumentExplorer at(document_, XCAFPrs_DocumentExplorerFlags_OnlyLeafNodes); at.More();
             at.Next()) {
            if (++placements > kMostPlacements) throw std::runtime_error(kTooManyCopies);
            const XCAFPrs_DocumentNode& node = at.Current();
            add_product(product(node.RefLabel), node);
        }
        if (bare_ > 0) out_.warnings.push_back(Message("{} faces of the file could not be made into triangles", bare_));
        if (out_.counts.empty()) throw std::runtime_error(kNoCadFaces);
        return std::move(out_);
    }

  private:
    Product& product(const TDF_Label& label) {
        TCollection_AsciiString entry;
        TDF_Tool::Entry(label, entry);
        std::unique_ptr<Product>& known = products_[entry.ToCString()];
        if (known) return *known;
        known = std::make_unique<Product>();
        find_names(label, *known);
        find_styles(label, *known);
        const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(label);
        if (!shape.IsNull()) find_bodies(shape.Located(TopLoc_Location()), diagonal_, *known);
        for (const TopoDS_Shape& body : known->bodies) tessellate(body, chord_);
        return *known;
    }

    void add_product(const Product& product, const XCAFPrs_DocumentNode& node) {
        std::string name = product.name.empty() ? name_of(node.Label) : product.name;
        if (name.empty()) name = "part";
        for (std::size_t i = 0; i < product.bodies.size(); ++i) {
            const TopoDS_Shape& body = product.bodies[i];
            std::string of_body = name;
            if (const std::string* own = product.names.Seek(body); own && product.bodies.size() > 1) of_body = *own;
            of_body = unique(of_body);
            std::map<std::uint32_t, std::uint32_t> parts;  // by material
            const auto part_of = [&](const TopoDS_Shape& face, std::size_t n) {
                const XCAFPrs_Style* style = product.styles.Seek(face);
                const std::uint32_t material = material_of(style ? *style : XCAFPrs_Style(), node.Style);
                if (by_faces_) {
                    const std::string* own = product.names.Seek(face);
                    return add_part(of_body + (own ? " " + *own : " face " + std::to_string(n + 1)), material);
                }
                const auto [at, is_new] = parts.try_emplace(material, kNone);
                if (is_new) at->second = add_part(of_body, material);
                return at->second;
            };
            bare_ += add_body(body, node.Location.Transformation(), part_of, out_);
        }
    }

    std::uint32_t add_part(const std::string& name, std::uint32_t material) {
        out_.parts.push_back({.object = name, .material = material});
        return static_cast<std::uint32_t>(out_.parts.size() - 1);
    }

    /// `name`, with a number from the second of it on.
    std::string unique(const std::string& name) {
        std::string out = name;
        while (!names_.insert(out).second) out = name + " " + std::to_string(++uses_[name] + 1);
        return out;
    }

    std::uint32_t material_of(const XCAFPrs_Style& own, const XCAFPrs_Style& inherited) {
        const XCAFPrs_Style& style = own.IsSetColorSurf() ? own : inherited;
        if (!style.IsSetColorSurf()) return kNone;
        const Quantity_ColorRGBA& colour = style.GetColorSurfRGBA();
        std::array<double, 3> rgb{};
        colour.GetRGB().Values(rgb[0], rgb[1], rgb[2], Quantity_TOC_sRGB);
        const float alpha = colour.Alpha();
        std::string name = "#";
        for (const double channel : rgb) {
            const int byte = static_cast<int>(std::lround(255 * std::clamp(channel, 0.0, 1.0)));
            for (const int digit : {byte / 16, byte % 16}) name += "0123456789abcdef"[digit];
        }
        const auto [at, is_new] = materials_.try_emplace({name, alpha}, kNone);
        if (is_new) {
            at->second = static_cast<std::uint32_t>(out_.materials.size());
            out_.materials.push_back({.name = name, .colour = Vec3f(Vec3(rgb[0], rgb[1], rgb[2])), .alpha = alpha});
        }
        return at->second;
    }

    Document document_;
    bool by_faces_;
    double diagonal_ = 0, chord_ = 0;                           ///< millimetres
    std::map<std::string, std::unique_ptr<Product>> products_;  ///< by entry of the label
    std::map<std::pair<std::string, float>, std::uint32_t> materials_;
    std::set<std::string> names_;
    std::map<std::string, std::size_t> uses_;
    std::size_t bare_ = 0;
    FileScene out_;
};

}  // namespace

FileScene import_cad(std::string_view format, std::span<const char> bytes, const CadRequest& request) {
    ::Message::DefaultMessenger()->ChangePrinters().Clear();
    try {
        Document document = new TDocStd_Document("BinXCAF");
        if (format == "igs")
            read_iges(bytes, document);
        else
            read_step(bytes, document);
        return CadScene(document, request).run();
    } catch (const Standard_OutOfMemory&) {
        throw std::bad_alloc();
    } catch (const Standard_Failure& failure) {
        throw std::runtime_error(failure.GetMessageString() ? failure.GetMessageString() : "");
    }
}

}  // namespace tuft::io
