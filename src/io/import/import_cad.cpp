#include "io/import/import_cad.h"

#include <sys/mman.h>
#include <unistd.h>

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <NCollection_DataMap.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPConstruct_UnitContext.hxx>
#include <STEPControl_Reader.hxx>
#include <ShapeAnalysis_ShapeTolerance.hxx>
#include <Standard_OutOfMemory.hxx>
#include <StepData_StepModel.hxx>
#include <StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx.hxx>
#include <StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext.hxx>
#include <StepRepr_GlobalUnitAssignedContext.hxx>
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
#include "io/import/cad_faces.h"

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

/// Metres in the unit of length of the file's first shapes that state one.
double step_unit(const STEPControl_Reader& reader) {
    using Bounded = StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx;
    using Bare = StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext;
    const Handle(StepData_StepModel) model = reader.StepModel();
    for (Standard_Integer i = 1; !model.IsNull() && i <= model->NbEntities(); ++i) {
        Handle(StepRepr_GlobalUnitAssignedContext) units;
        if (const auto bounded = Handle(Bounded)::DownCast(model->Value(i)); !bounded.IsNull())
            units = bounded->GlobalUnitAssignedContext();
        else if (const auto bare = Handle(Bare)::DownCast(model->Value(i)); !bare.IsNull())
            units = bare->GlobalUnitAssignedContext();
        if (units.IsNull()) continue;
        STEPConstruct_UnitContext factors;
        factors.ComputeFactors(units);
        if (factors.LengthDone()) return factors.LengthFactor() * kMillimetre;
    }
    return kMillimetre;
}

/// Both return the metres in the unit of the file.
double read_step(std::span<const char> bytes, Document& document) {
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
    return step_unit(reader.Reader());
}

double read_iges(std::span<const char> bytes, Document& document) {
    IGESCAFControl_Reader reader;
    reader.SetReadVisible(true);  // what the file hides is no part of the model
    reader.SetColorMode(true);
    reader.SetNameMode(true);
    reader.SetLayerMode(false);
    const NamedBytes file(bytes);
    if (reader.ReadFile(file.name().c_str()) != IFSelect_RetDone || !reader.Transfer(document))
        throw std::runtime_error(kNotCad);
    return reader.IGESModel()->GlobalSection().UnitValue() * kMillimetre;
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
    std::vector<TopoDS_Shape> loose;  ///< faces outside of closed shells, until they are sewn
    ShapeMap<std::string> names;      ///< of bodies and faces
    ShapeMap<std::string> sheets;     ///< of faces of several products that are sewn as one: the product of each
    ShapeMap<XCAFPrs_Style> styles;   ///< of faces
    bool tessellated = false;
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

template <class Value>
void hand_on(const TopoDS_Shape& from, const TopoDS_Shape& to, ShapeMap<Value>& values) {
    if (const Value* value = values.Seek(from)) values.Bind(to, Value(*value));
}

/// Sews loose faces into shells. What was said of a face is said of what becomes of it.
void sew(double diagonal, Product& product) {
    const std::vector<TopoDS_Shape> faces = std::move(product.loose);
    product.loose.clear();
    ShapeAnalysis_ShapeTolerance measure;
    const double stated = measure.Tolerance(compound_of(faces), 1);
    BRepBuilderAPI_Sewing sewing(std::clamp(stated, kSewn * diagonal, kChordPart * diagonal));
    for (const TopoDS_Shape& face : faces) sewing.Add(face);
    sewing.Perform();
    for (const TopoDS_Shape& face : faces) {
        if (!sewing.IsModified(face)) continue;
        const TopoDS_Shape& became = sewing.Modified(face);
        hand_on(face, became, product.styles);
        hand_on(face, became, product.names);
        hand_on(face, became, product.sheets);
    }
    const TopoDS_Shape sewn = sewing.SewedShape();
    if (sewn.IsNull()) return;
    const std::vector<TopoDS_Shape> shells = parts_of(sewn, TopAbs_SHELL);
    product.bodies.insert(product.bodies.end(), shells.begin(), shells.end());
    const std::vector<TopoDS_Shape> alone = parts_of(sewn, TopAbs_FACE, TopAbs_SHELL);
    if (!alone.empty()) product.bodies.push_back(compound_of(alone));
}

void find_bodies(const TopoDS_Shape& shape, Product& product) {
    std::vector<TopoDS_Shape>& loose = product.loose;
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
        join_sheets();
        for (XCAFPrs_DocumentExplorer at(document_, XCAFPrs_DocumentExplorerFlags_OnlyLeafNodes); at.More();
             at.Next()) {
            const XCAFPrs_DocumentNode& node = at.Current();
            Product& one = product(node.RefLabel);
            tessellate_once(one);
            add_product(one, node);
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
        if (!shape.IsNull()) find_bodies(shape.Located(TopLoc_Location()), *known);
        return *known;
    }

    void tessellate_once(Product& product) {
        if (product.tessellated) return;
        product.tessellated = true;
        if (!product.loose.empty()) sew(diagonal_, product);
        for (const TopoDS_Shape& body : product.bodies) tessellate(body, chord_);
    }

    /// A product with loose faces, and a place of it.
    struct Sheet {
        Product* product;
        XCAFPrs_DocumentNode node;
    };

    /// Some modellers write each surface of a body as a product of its own (73 of them for one transistor): loose faces
    /// of products that have one place are sewn together, as part of the first of these.
    void join_sheets() {
        std::vector<Sheet> sheets;
        std::map<const Product*, std::size_t> uses;
        std::size_t placements = 0;
        for (XCAFPrs_DocumentExplorer at(document_, XCAFPrs_DocumentExplorerFlags_OnlyLeafNodes); at.More();
             at.Next()) {
            if (++placements > kMostPlacements) throw std::runtime_error(kTooManyCopies);
            Product& one = product(at.Current().RefLabel);
            if (!one.loose.empty() && ++uses[&one] == 1) sheets.push_back({&one, at.Current()});
        }
        std::erase_if(sheets, [&](const Sheet& sheet) { return uses[sheet.product] > 1; });
        if (sheets.size() < 2) return;
        Product& whole = *sheets.front().product;
        const TopLoc_Location back = sheets.front().node.Location.Inverted();
        std::vector<TopoDS_Shape> joined;
        for (const Sheet& sheet : sheets) {
            const std::string name = unique(name_of(*sheet.product, sheet.node));
            const std::vector<TopoDS_Shape> faces = std::move(sheet.product->loose);
            sheet.product->loose.clear();
            for (const TopoDS_Shape& face : faces) {
                const TopoDS_Shape moved = face.Moved(back * sheet.node.Location);
                const XCAFPrs_Style* style = sheet.product->styles.Seek(face);
                whole.styles.Bind(moved, XCAFPrs_Style(style ? *style : sheet.node.Style));
                if (const std::string* own = sheet.product->names.Seek(face))
                    whole.names.Bind(moved, std::string(*own));
                whole.sheets.Bind(moved, name);
                joined.push_back(moved);
            }
        }
        whole.loose = std::move(joined);
    }

    static std::string name_of(const Product& product, const XCAFPrs_DocumentNode& node) {
        std::string name = product.name.empty() ? io::name_of(node.Label) : product.name;
        return name.empty() ? "part" : name;
    }

    void add_product(const Product& product, const XCAFPrs_DocumentNode& node) {
        const std::string name = name_of(product, node);
        for (const TopoDS_Shape& body : product.bodies) {
            std::string of_body = name;
            if (const std::string* own = product.names.Seek(body); own && product.bodies.size() > 1) of_body = *own;
            const bool joined = product.sheets.IsBound(TopExp_Explorer(body, TopAbs_FACE).Current());
            if (!joined) of_body = unique(of_body);
            std::map<std::pair<std::string, std::uint32_t>, std::uint32_t> parts;  // by sheet or body, and material
            std::map<std::string, std::size_t> n_faces;
            const auto part_of = [&](const TopoDS_Shape& face) {
                const XCAFPrs_Style* style = product.styles.Seek(face);
                const std::string* sheet = product.sheets.Seek(face);
                const std::uint32_t material =
                    material_of(style ? *style : XCAFPrs_Style(), sheet ? XCAFPrs_Style() : node.Style);
                const std::string& object = sheet ? *sheet : of_body;
                if (by_faces_) {
                    const std::string* own = product.names.Seek(face);
                    const std::size_t n = ++n_faces[object];
                    return add_part(object + (own ? " " + *own : " face " + std::to_string(n)), material);
                }
                const auto [at, is_new] = parts.try_emplace({object, material}, kNone);
                if (is_new) at->second = add_part(object, material);
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
        const double unit = format == "igs" ? read_iges(bytes, document) : read_step(bytes, document);
        FileScene scene = CadScene(document, request).run();
        if (unit > 0 && std::isfinite(unit)) scene.stated_unit = unit;
        return scene;
    } catch (const Standard_OutOfMemory&) {
        throw std::bad_alloc();
    } catch (const Standard_Failure& failure) {
        throw std::runtime_error(failure.GetMessageString() ? failure.GetMessageString() : "");
    }
}

}  // namespace tuft::io
