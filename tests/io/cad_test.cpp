#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <GProp_GProps.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Reader.hxx>
#include <STEPControl_Writer.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <algorithm>
#include <fstream>
#include <gp_Ax1.hxx>
#include <map>

#include "core/error.h"
#include "core/files/files.h"
#include "core/text/units.h"
#include "io/model/read_model.h"
#include "mesh/repair/repair.h"
#include "paths.h"

/// STEP and IGES. Parts are made and measured by Open CASCADE itself; those of other people come with Debian's
/// occt-misc, gmsh-doc and netgen-doc.
namespace tuft::io {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;
namespace fs = std::filesystem;

class Cad : public testing::Test {
  protected:
    fs::path folder_ = fs::path(::testing::TempDir()) / ("tuft_cad_" + std::to_string(::getpid()));
    void SetUp() override {
        fs::create_directories(folder_);
        // Open CASCADE says on standard output what it does.
        ::Message::DefaultMessenger()->ChangePrinters().Clear();
    }
    void TearDown() override { fs::remove_all(folder_); }

    fs::path step(const TopoDS_Shape& shape, const std::string& name, const char* unit = "MM") const {
        STEPControl_Controller::Init();
        Interface_Static::SetCVal("write.step.unit", unit);  // before the writer, which scales by it
        STEPControl_Writer writer;
        EXPECT_EQ(writer.Transfer(shape, STEPControl_AsIs), IFSelect_RetDone);
        EXPECT_EQ(writer.Write((folder_ / name).c_str()), IFSelect_RetDone);
        Interface_Static::SetCVal("write.step.unit", "MM");
        return folder_ / name;
    }
    /// A file of faces that share no edges.
    fs::path iges(const TopoDS_Shape& shape, const std::string& name) const {
        IGESControl_Writer writer("MM", 0);
        EXPECT_TRUE(writer.AddShape(shape));
        EXPECT_TRUE(writer.Write((folder_ / name).c_str()));
        return folder_ / name;
    }
};

mesh::Surface surface_of(const fs::path& path, const CadReading& how = {}) {
    return mesh::build_surface(read_model(path, how), {.metres_per_unit = 1});
}

/// By Open CASCADE, mm².
double area_of(const TopoDS_Shape& shape) {
    GProp_GProps surface;
    BRepGProp::SurfaceProperties(shape, surface, 1e-5);
    return surface.Mass();
}

double area_mm2(const mesh::TriangleMesh& mesh) {
    return mesh::surface_area(mesh) / (kMillimetre * kMillimetre);
}

TopoDS_Shape moved(const TopoDS_Shape& shape, const gp_Trsf& by) {
    return shape.Moved(TopLoc_Location(by));
}

gp_Trsf shift(double x, double y, double z) {
    gp_Trsf t;
    t.SetTranslation(gp_Vec(x, y, z));
    return t;
}

/// A block with two holes that cross, and its upright edges rounded.
TopoDS_Shape bracket() {
    const TopoDS_Shape block = BRepPrimAPI_MakeBox(60, 40, 20).Shape();
    BRepFilletAPI_MakeFillet rounded(block);
    for (TopExp_Explorer at(block, TopAbs_EDGE); at.More(); at.Next()) {
        Bnd_Box box;
        BRepBndLib::Add(at.Current(), box);
        const gp_XYZ size = box.CornerMax().XYZ() - box.CornerMin().XYZ();
        if (size.Z() > 19) rounded.Add(5, TopoDS::Edge(at.Current()));
    }
    const TopoDS_Shape upright = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(30, 20, -1), gp::DZ()), 8, 22).Shape();
    const TopoDS_Shape across = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(30, -1, 10), gp::DY()), 5, 42).Shape();
    return BRepAlgoAPI_Cut(BRepAlgoAPI_Cut(rounded.Shape(), upright).Shape(), across).Shape();
}

std::string fault_of(const fs::path& path, const CadReading& how = {}) {
    try {
        read_model(path, how);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

TEST_F(Cad, ABoxIsClosedAndHasItsAreaAndPlace) {
    const fs::path path = step(moved(BRepPrimAPI_MakeBox(30, 20, 10).Shape(), shift(100, 0, 5)), "box.step");
    const mesh::Surface surface = surface_of(path);
    EXPECT_TRUE(surface.report.closed);
    EXPECT_EQ(surface.mesh.n_triangles(), 12u);
    EXPECT_EQ(surface.report.degenerate_faces_dropped + surface.report.non_manifold.edges_split, 0u);
    EXPECT_NEAR(area_mm2(surface.mesh), 2200, 2200 * 1e-6);  // float positions
    EXPECT_NEAR(surface.mesh.bounds.lo.x, 0.1, 1e-7);
    EXPECT_NEAR(surface.mesh.bounds.hi.z, 0.015, 1e-8);
    EXPECT_TRUE(states_unit("a.STP"));
    for (const char* name : {"a.step", "a.stp", "a.iges", "a.IGS"})
        EXPECT_TRUE(is_model_file(name) && is_cad_file(name));
    EXPECT_FALSE(is_cad_file("a.stl"));
}

TEST_F(Cad, AFileHasTheLengthsOfItsUnit) {
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(25.4, 50.8, 76.2).Shape();
    const std::map<const char*, const char*> units{
        {"MM", "mm"}, {"INCH", "in"}, {"M", "m"}, {"CM", "cm"}, {"FT", "ft"}};
    for (const auto& [unit, name] : units) {
        const fs::path path = step(box, std::string(unit) + ".step", unit);
        const mesh::TriangleMesh mesh = surface_of(path).mesh;
        EXPECT_NEAR(mesh.bounds.hi.x, 0.0254, 1e-8) << unit;
        EXPECT_NEAR(mesh.bounds.hi.z, 0.0762, 1e-8) << unit;
        EXPECT_NEAR(read_model(path).stated_unit / metres_per(name).value(), 1, 1e-9) << unit;
    }
}

TEST_F(Cad, AnIgesFileStatesItsUnit) {
    for (const auto& [unit, name] : {std::pair("MM", "mm"), {"IN", "in"}, {"M", "m"}, {"CM", "cm"}, {"FT", "ft"}}) {
        IGESControl_Writer writer(unit, 0);
        EXPECT_TRUE(writer.AddShape(BRepPrimAPI_MakeBox(25.4, 50.8, 76.2).Shape()));
        EXPECT_TRUE(writer.Write((folder_ / "box.igs").c_str()));
        EXPECT_NEAR(read_model(folder_ / "box.igs").stated_unit / metres_per(name).value(), 1, 1e-9) << unit;
    }
}

// A tolerance is that of the model, whatever unit the numbers are said to be in.
TEST_F(Cad, AChordIsOfTheModelInTheUnitThatIsSaid) {
    const TopoDS_Shape cylinder = BRepPrimAPI_MakeCylinder(50, 80).Shape();
    const fs::path small = step(cylinder, "small.step");
    BRepBuilderAPI_Transform scaled(cylinder, [] {
        gp_Trsf t;
        t.SetScale(gp_Pnt(0, 0, 0), 10);
        return t;
    }());
    const std::size_t wanted = read_model(step(scaled.Shape(), "large.step"), {.chord = 1e-4}).n_polygons();
    EXPECT_EQ(read_model(small, {.chord = 1e-4, .unit = "cm"}).n_polygons(), wanted);
    EXPECT_EQ(read_model(small, {.chord = 1e-4, .unit = "mm"}).n_polygons(),
              read_model(small, {.chord = 1e-4}).n_polygons());
}

// Numbers of millimetres that the file states as metres: 50 m across, where a tenth of a millimetre is too fine.
TEST_F(Cad, AChordThatIsTooFineForTheStatedUnitIsNotForTheOneThatIsSaid) {
    const fs::path wrong = step(BRepPrimAPI_MakeCylinder(5e4, 8e4).Shape(), "wrong.step", "M");
    const fs::path right = step(BRepPrimAPI_MakeCylinder(50, 80).Shape(), "right.step");
    ASSERT_NEAR(read_model(wrong).stated_unit, 1, 1e-9);
    EXPECT_EQ(read_model(wrong, {.chord = 1e-4, .unit = "mm"}).n_polygons(),
              read_model(right, {.chord = 1e-4}).n_polygons());
}

// n chords of a circle of radius r miss its length by (π/n)²/6, and its arc by c = r (π/n)²/2: the area of the side is
// short by c / 3r.
TEST_F(Cad, ACylindersAreaConvergesWithTheFirstOrderOfTheChord) {
    constexpr double kRadius = 50, kHeight = 80, kSide = 2 * 3.14159265358979 * kRadius * kHeight;
    const fs::path path = step(BRepPrimAPI_MakeCylinder(kRadius, kHeight).Shape(), "cylinder.step");
    std::vector<double> missing;
    const std::vector<double> chords{0.4, 0.1, 0.025};
    for (const double chord : chords) {
        const mesh::Surface surface = surface_of(path, {.chord = chord * kMillimetre});
        EXPECT_TRUE(surface.report.closed);
        double side = 0;
        for (std::size_t t = 0; t < surface.mesh.n_triangles(); ++t) {
            const Vec3 a = surface.mesh.position(t, 0), b = surface.mesh.position(t, 1),
                       c = surface.mesh.position(t, 2);
            const Vec3 n = 0.5 * glm::cross(b - a, c - a);
            if (std::abs(n.z) < 0.5 * glm::length(n)) side += glm::length(n) / (kMillimetre * kMillimetre);
        }
        missing.push_back(1 - side / kSide);
        EXPECT_GT(missing.back(), 0) << "chords lie inside";
        EXPECT_LE(missing.back(), 1.05 * chord / (3 * kRadius)) << "the chord is kept, to a twentieth";
    }
    // The number of chords is whole: 25 at the least, 4 % in each.
    const double order = std::log(missing.front() / missing.back()) / std::log(chords.front() / chords.back());
    EXPECT_NEAR(order, 1, 0.1);
}

TEST_F(Cad, NormalsAreThoseOfTheSurface) {
    const TopoDS_Shape sphere = BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, 0), 20).Shape();
    const mesh::Surface surface = surface_of(step(sphere, "sphere.step"), {.chord = 1e-3});
    const mesh::TriangleMesh& m = surface.mesh;
    EXPECT_TRUE(surface.report.closed) << "poles and the seam of the parameters are joined";
    double worst = 0;
    for (std::size_t c = 0; c < m.corner_normals.size(); ++c) {
        const Vec3 p = m.position(c / 3, static_cast<int>(c % 3));
        worst = std::max(worst, glm::length(Vec3(m.corner_normals[c]) - glm::normalize(p)));
    }
    EXPECT_LT(worst, 1e-5) << "what floats keep; the mean of triangles of 1 mm chord misses by 0.01 and more";
}

TEST_F(Cad, ATrimmedPartIsClosedAndHasItsAreaInStepAndSewnInIges) {
    const TopoDS_Shape part = bracket();
    const double area = area_of(part);
    for (const fs::path& path : {step(part, "bracket.step"), iges(part, "bracket.igs")}) {
        const mesh::Surface surface = surface_of(path);
        EXPECT_TRUE(surface.report.closed) << path;
        EXPECT_EQ(surface.report.components, 1u) << path;
        EXPECT_EQ(surface.report.faces_flipped, 0u) << path << ": faces of a body agree";
        EXPECT_NEAR(area_mm2(surface.mesh), area, 1e-3 * area) << path;
    }
}

TEST_F(Cad, EachFaceIsAGroupWhereThatIsAsked) {
    const fs::path path = step(bracket(), "bracket.step");
    EXPECT_EQ(read_model(path).group_names.size(), 1u);
    const mesh::PolygonSoup faces = read_model(path, {.groups = CadGroups::faces});
    std::size_t n = 0;
    for (TopExp_Explorer at(bracket(), TopAbs_FACE); at.More(); at.Next()) ++n;
    EXPECT_EQ(faces.group_names.size(), n);
    EXPECT_GT(n, 10u);
}

class Assembly : public Cad {
  protected:
    static void name(const TDF_Label& label, const char* text) {
        TDataStd_Name::Set(label, TCollection_ExtendedString(text, true));
    }
    /// Two wheels of one product, red with one blue face, and a green body; its name is not of ASCII.
    fs::path write() const {
        Handle(TDocStd_Document) document = new TDocStd_Document("BinXCAF");
        const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
        const Handle(XCAFDoc_ColorTool) colours = XCAFDoc_DocumentTool::ColorTool(document->Main());
        const TopoDS_Shape wheel = BRepPrimAPI_MakeCylinder(10, 4).Shape(),
                           body = BRepPrimAPI_MakeBox(60, 20, 10).Shape();
        const TDF_Label of_wheel = shapes->AddShape(wheel, false), of_body = shapes->AddShape(body, false);
        const TDF_Label whole = shapes->NewShape();
        gp_Trsf upright;
        upright.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp::DX()), M_PI / 2);
        for (const double x : {10.0, 50.0})
            shapes->AddComponent(whole, of_wheel, TopLoc_Location(shift(x, 0, 0) * upright));
        shapes->AddComponent(whole, of_body, TopLoc_Location(shift(0, 0, 3)));
        shapes->UpdateAssemblies();
        name(whole, "car"), name(of_wheel, "wheel"), name(of_body, "Karosserie grün");
        const auto srgb = [](double r, double g, double b) { return Quantity_Color(r, g, b, Quantity_TOC_sRGB); };
        colours->SetColor(of_wheel, srgb(0.8, 0.2, 0), XCAFDoc_ColorSurf);
        colours->SetColor(of_body, srgb(0, 0.6, 0.2), XCAFDoc_ColorSurf);
        for (TopExp_Explorer at(wheel, TopAbs_FACE); at.More(); at.Next()) {
            Bnd_Box box;
            BRepBndLib::Add(at.Current(), box);
            if (box.CornerMin().Z() < 3.9) continue;
            colours->SetColor(shapes->AddSubShape(of_wheel, at.Current()), srgb(0, 0, 1), XCAFDoc_ColorSurf);
        }
        STEPCAFControl_Writer writer;
        EXPECT_TRUE(writer.Transfer(document, STEPControl_AsIs));
        EXPECT_EQ(writer.Write((folder_ / "car.step").c_str()), IFSelect_RetDone);
        return folder_ / "car.step";
    }
};

TEST_F(Assembly, HasItsPlacementsNamesAndColours) {
    const mesh::Surface surface = surface_of(write());
    const mesh::TriangleMesh& m = surface.mesh;
    EXPECT_TRUE(surface.report.closed);
    EXPECT_EQ(surface.report.components, 3u);
    EXPECT_THAT(m.group_names, UnorderedElementsAre("wheel / #cc3300", "wheel / #0000ff", "wheel 2 / #cc3300",
                                                    "wheel 2 / #0000ff", "Karosserie grün / #009933"));
    std::map<std::string, Box> box;
    for (std::size_t t = 0; t < m.n_triangles(); ++t)
        for (int k = 0; k < 3; ++k) box[m.scene->parts[mesh::part_of(m, t)].object].add(m.position(t, k));
    // A chord of 1/5000 of 70 mm may be missing at a rim.
    constexpr double kNear = 2e-5;
    EXPECT_NEAR(box["wheel"].lo.x, 0, kNear);
    EXPECT_NEAR(box["wheel"].hi.x, 0.02, kNear);
    EXPECT_NEAR(box["wheel 2"].hi.x, 0.06, kNear);
    EXPECT_NEAR(box["wheel 2"].lo.y, -0.004, 1e-8) << "z turned to -y";
    EXPECT_NEAR(box["wheel"].hi.z, 0.01, kNear);
    EXPECT_NEAR(box["Karosserie grün"].lo.z, 0.003, 1e-8);
    ASSERT_EQ(m.materials.size(), m.group_names.size());
    for (std::size_t g = 0; g < m.group_names.size(); ++g)
        if (m.group_names[g] == "wheel 2 / #cc3300") {
            EXPECT_NEAR(m.materials[g].colour.r, 0.8, 1e-4);  // six digits in the file
            EXPECT_NEAR(m.materials[g].colour.g, 0.2, 1e-4);
            EXPECT_NEAR(m.materials[g].colour.b, 0, 1e-4);
        }
}

TEST_F(Assembly, KeepsItsNamesAndColoursInTheDocumentThatExportsWrite) {
    const mesh::PolygonSoup soup = read_model(write());
    for (const char* text : {"\"wheel\"", "\"wheel 2\"", "\"Karosserie gr\xc3\xbcn\"", "\"#cc3300\""})
        EXPECT_THAT(soup.scene->document, HasSubstr(text));
}

TEST_F(Cad, LooseFacesAreSewnAndOpenOnesStayOpen) {
    BRep_Builder builder;
    TopoDS_Compound loose;
    builder.MakeCompound(loose);
    std::size_t n = 0;
    for (TopExp_Explorer at(bracket(), TopAbs_FACE); at.More(); at.Next(), ++n)
        if (n > 0) builder.Add(loose, at.Current());
    const mesh::Surface surface = surface_of(iges(loose, "loose.igs"));
    EXPECT_FALSE(surface.report.closed);
    EXPECT_EQ(surface.report.holes, 1u) << "where the face is missing";
    EXPECT_EQ(surface.report.components, 1u);
}

// As of SOT23.stp of FreeCAD's electronic parts: 73 surfaces of one body, each a product.
TEST_F(Cad, SurfacesThatAreProductsOfTheirOwnAreSewnAndKeepTheirNames) {
    Handle(TDocStd_Document) document = new TDocStd_Document("BinXCAF");
    const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
    const TopoDS_Shape part = bracket();
    std::vector<std::string> names;
    for (TopExp_Explorer at(part, TopAbs_FACE); at.More(); at.Next()) {
        names.push_back("skin " + std::to_string(names.size() + 1));
        // A copy: no edge is shared.
        const TopoDS_Shape face = BRepBuilderAPI_Transform(at.Current(), shift(0, 0, 0), true).Shape();
        TDataStd_Name::Set(shapes->AddShape(face, false), TCollection_ExtendedString(names.back().c_str(), true));
    }
    STEPCAFControl_Writer writer;
    ASSERT_TRUE(writer.Transfer(document, STEPControl_AsIs));
    const fs::path path = folder_ / "skins.step";
    ASSERT_EQ(writer.Write(path.c_str()), IFSelect_RetDone);
    const mesh::Surface surface = surface_of(path);
    EXPECT_TRUE(surface.report.closed);
    EXPECT_EQ(surface.report.components, 1u);
    EXPECT_EQ(surface.report.faces_flipped, 0u) << "faces of a body agree";
    EXPECT_NEAR(area_mm2(surface.mesh), area_of(part), 1e-3 * area_of(part));
    EXPECT_THAT(surface.mesh.group_names, ::testing::UnorderedElementsAreArray(names));
    EXPECT_EQ(read_model(path, {.groups = CadGroups::faces}).group_names.size(), names.size());
}

TEST_F(Cad, SameFileSameBits) {
    const fs::path path = step(bracket(), "bracket.step");
    const mesh::PolygonSoup a = read_model(path), b = read_model(path);
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.corners, b.corners);
}

TEST_F(Cad, DamagedFilesAreErrorsInOneLine) {
    const auto text_of = [](const fs::path& path) {
        const std::vector<char> bytes = read_file(path);
        return std::string(bytes.begin(), bytes.end());
    };
    const fs::path whole = step(BRepPrimAPI_MakeBox(30, 20, 10).Shape(), "box.step");
    const std::string text = text_of(whole);
    const auto written = [&](const char* name, const std::string& content) {
        std::ofstream(folder_ / name, std::ios::binary) << content;
        return folder_ / name;
    };
    for (const double part : {0.0, 0.02, 0.3, 0.6, 0.9}) {
        const std::string fault = fault_of(
            written("cut.step", text.substr(0, static_cast<std::size_t>(part * static_cast<double>(text.size())))));
        EXPECT_THAT(fault, HasSubstr("cut.step: ")) << part;
        EXPECT_EQ(fault.find('\n'), fault.npos) << fault;
    }
    for (const char* name : {"no.igs", "no.stp"})
        EXPECT_THAT(fault_of(written(name, "not at all, whatever the name says\n")),
                    HasSubstr("is no sound STEP or IGES file"))
            << name;
    EXPECT_THAT(fault_of(whole, {.chord = 1e-9}), HasSubstr("chord tolerance"));
}

TEST_F(Cad, IsReadByItsContentWhateverItsNameSays) {
    const fs::path box = iges(bracket(), "part.igs");
    fs::rename(box, folder_ / "iges.step");
    fs::rename(step(bracket(), "part.stp"), folder_ / "step.igs");
    for (const char* name : {"iges.step", "step.igs"})
        // The chord tolerance cuts the rounded edges short.
        EXPECT_NEAR(area_mm2(surface_of(folder_ / name).mesh) / area_of(bracket()), 1, 1e-3) << name;
    fs::rename(folder_ / "iges.step", folder_ / "part.txt");
    EXPECT_EQ(metres_per_unit(read_model(folder_ / "part.txt")), 1.0) << "its unit, too";
}

/// A part of somebody else, as it was shipped, or written as STEP.
struct Foreign {
    const char* package;  ///< of Debian
    const char* path;     ///< under /usr/share
    bool closed = true;
    double tolerance = 1e-3;   ///< of the area: the chords of a 5000th of the size cut rounded edges short
    std::size_t touching = 0;  ///< edges at which bodies of an assembly touch
};

class ForeignPart : public Cad, public testing::WithParamInterface<Foreign> {
  protected:
    fs::path path_ = fs::path("/usr/share") / GetParam().path;

    static TopoDS_Shape read(XSControl_Reader&& reader, const fs::path& path) {
        EXPECT_EQ(reader.ReadFile(path.c_str()), IFSelect_RetDone);
        reader.TransferRoots();
        return reader.OneShape();
    }
    /// As a file that `tuft` reads: documentation is packed, and .brep is no format of exchange.
    fs::path readable() const {
        if (path_.extension() == ".gz") {
            const fs::path plain = folder_ / path_.stem();
            EXPECT_EQ(std::system(("gzip -dc '" + path_.string() + "' > '" + plain.string() + "'").c_str()), 0);
            return plain;
        }
        if (path_.extension() != ".brep") return path_;
        TopoDS_Shape shape;
        const BRep_Builder builder;
        EXPECT_TRUE(BRepTools::Read(shape, path_.c_str(), builder));
        return step(shape, "part.step");
    }
};

TEST_P(ForeignPart, IsWatertightAndHasTheAreaThatOpenCascadeGives) {
    if (!fs::exists(path_)) GTEST_SKIP() << path_ << " is not there (package " << GetParam().package << ")";
    const fs::path path = readable();
    const double area =
        area_of(path.extension() == ".iges" ? read(IGESControl_Reader(), path) : read(STEPControl_Reader(), path));
    const mesh::Surface surface = surface_of(path);
    EXPECT_EQ(surface.report.closed, GetParam().closed) << surface.report.holes << " holes";
    EXPECT_NEAR(area_mm2(surface.mesh) / area, 1, GetParam().tolerance);
    EXPECT_EQ(surface.report.non_manifold.edges_split, GetParam().touching);
}

// STEP as shipped: a screw and linked rods of Open CASCADE, the assembly AS1 of the CAx Implementor Forum written by
// Theorem Solutions from Unigraphics, component 8 of Gmsh's demonstrations, a frame of Pro/Engineer's. The bearing
// has no face on its underside.
INSTANTIATE_TEST_SUITE_P(, ForeignPart,
                         testing::Values(Foreign{"occt-misc", "opencascade/data/step/screw.step"},
                                         Foreign{"occt-misc", "opencascade/data/step/linkrods.step"},
                                         Foreign{"gmsh-doc", "doc/gmsh-doc/doc/gmsh/demos/boolean/as1-tu-203.stp.gz",
                                                 true, 1e-3, 264},
                                         Foreign{"gmsh-doc", "doc/gmsh-doc/doc/gmsh/demos/boolean/component8.step.gz"},
                                         Foreign{"netgen-doc", "doc/netgen/examples/frame.step"},
                                         Foreign{"occt-misc", "opencascade/data/iges/hammer.iges"},
                                         Foreign{"occt-misc", "opencascade/data/occ/bottle.brep"},
                                         Foreign{"occt-misc", "opencascade/data/occ/Pump_TopCover.brep"},
                                         Foreign{"occt-misc", "opencascade/data/occ/Pump_Nut.brep"},
                                         Foreign{"occt-misc", "opencascade/data/occ/CrankArm.brep"},
                                         Foreign{"occt-misc", "opencascade/data/occ/Top.brep"},
                                         Foreign{"occt-misc", "opencascade/data/iges/bearing.iges", false, 3e-3}),
                         [](const auto& part) {
                             std::string name = fs::path(part.param.path).stem().stem().string();
                             std::erase_if(name, [](char c) { return c == '-' || c == '_'; });
                             return name;
                         });

}  // namespace
}  // namespace tuft::io
