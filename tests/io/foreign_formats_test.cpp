#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>

#include "atlas/atlas.h"
#include "core/error.h"
#include "core/files/files.h"
#include "io/image/image.h"
#include "io/model/read_model.h"
#include "io/scene/file_scene.h"
#include "mesh/repair/repair.h"
#include "paths.h"

/// FBX, DAE, 3MF and X3D. The box files of the fuzz corpus are one scene, written by Blender 3.4 (3MF by hand): a box
/// of 1 x 2 x 3 m, moved by 10 m along x and turned by 90 degrees round z, with a mirrored pentagon of radius 1 m, 5 m
/// above its origin. One face of the box is of wood, the rest is red.
namespace tuft::io {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;
namespace fs = std::filesystem;

std::string corpus(const std::string& name) {
    return source_folder() + "/tests/fuzz/corpus/" + name;
}

std::string text_of(const fs::path& path) {
    const std::vector<char> bytes = read_file(path);
    return {bytes.begin(), bytes.end()};
}

class Folder {
  public:
    fs::path path = fs::path(::testing::TempDir()) / ("tuft_formats_" + std::to_string(::getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() { fs::remove_all(path); }

    fs::path write(const std::string& name, const std::string& text) const {
        fs::create_directories((path / name).parent_path());
        std::ofstream(path / name, std::ios::binary) << text;
        return path / name;
    }
    /// Red and green over blue and white, as in Blender's file.
    void write_picture(const std::string& name) const {
        const Image8 image{
            .width = 2, .height = 2, .channels = 3, .pixels = {0, 0, 255, 255, 255, 255, 255, 0, 0, 0, 255, 0}};
        write_image(path / name, view_of<std::uint8_t>(2, 2, 3, image.pixels.data()));
    }
};

std::string fault_of(const fs::path& path) {
    try {
        read_model(path);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    return at == text.npos ? text : text.replace(at, from.size(), to);
}

mesh::Surface surface_of(const fs::path& path) {
    mesh::PolygonSoup soup = read_model(path);
    const double unit = metres_per_unit(soup).value_or(1);
    return mesh::build_surface(std::move(soup), {.metres_per_unit = unit});
}

Box bounds_of(const mesh::PolygonSoup& soup) {
    Box box;
    for (const Vec3& p : soup.points) box.add(p);
    return box;
}

/// Signed, by the divergence theorem, of the triangles of some groups.
double volume_of(const mesh::TriangleMesh& m, const std::string& object) {
    double sum = 0;
    for (std::size_t t = 0; t < m.n_triangles(); ++t)
        if (m.scene->parts[mesh::part_of(m, t)].object == object)
            sum += glm::dot(m.position(t, 0), glm::cross(m.position(t, 1), m.position(t, 2))) / 6;
    return sum;
}

class Box123 : public testing::TestWithParam<const char*> {
  protected:
    /// A copy in a folder with the picture.
    mesh::Surface read() {
        const std::string name = fs::path(GetParam()).filename().string();
        std::ofstream(folder_.path / name, std::ios::binary) << text_of(corpus(GetParam()));
        folder_.write_picture("wood.png");
        return surface_of(folder_.path / name);
    }
    /// X3D in one of its encodings.
    static bool is_x3d() {
        const std::string extension = fs::path(GetParam()).extension().string();
        return extension == ".x3d" || extension == ".wrl";
    }
    Folder folder_;
};

TEST_P(Box123, HasItsShapeAndUnitOutwardFacesAndMirroredPartsTurnedRight) {
    const mesh::TriangleMesh m = read().mesh;
    EXPECT_EQ(m.n_triangles(), 12u + 3u);
    // Six digits in the files.
    EXPECT_NEAR(m.bounds.lo.x, 8, 1e-5);
    EXPECT_NEAR(m.bounds.hi.x, 10 + std::sin(2 * 3.14159265 / 5), 1e-5);
    EXPECT_NEAR(m.bounds.lo.z, 0, 1e-5);
    EXPECT_NEAR(m.bounds.hi.z, 5, 1e-5);
    EXPECT_NEAR(volume_of(m, "box"), 6, 1e-4);
    for (std::size_t t = 0; t < m.n_triangles(); ++t)
        if (m.scene->parts[mesh::part_of(m, t)].object == "pent") {
            const Vec3 n = glm::cross(m.position(t, 1) - m.position(t, 0), m.position(t, 2) - m.position(t, 0));
            EXPECT_GT(n.z, 0) << "of a flat part that is mirrored along x the upper side stays the upper one";
        }
}

TEST_P(Box123, KeepsItsObjectsMaterialsAndGroups) {
    const mesh::TriangleMesh m = read().mesh;
    // Names in X3D have no spaces.
    const std::string red = is_x3d() ? "red_glaze" : "red glaze";
    EXPECT_THAT(m.group_names, UnorderedElementsAre("box / " + red, "box / wood", "pent / " + red));
    std::vector<std::string> materials;
    for (const mesh::ScenePart& part : m.scene->parts) materials.push_back(part.material);
    EXPECT_THAT(materials, UnorderedElementsAre(red, "wood", red));
    ASSERT_EQ(m.materials.size(), 3u);
    for (std::size_t g = 0; g < 3; ++g) {
        if (m.group_names[g] == "box / wood") continue;
        // Bytes in 3MF: half a step.
        EXPECT_NEAR(m.materials[g].colour.r, 0.8, 0.002);
        EXPECT_NEAR(m.materials[g].colour.g, 0.1, 0.002);
        EXPECT_NEAR(m.materials[g].colour.b, 0.05, 0.002);
    }
}

TEST_P(Box123, KeepsTheUvsOfEachCorner) {
    const mesh::TriangleMesh m = read().mesh;
    ASSERT_FALSE(m.corner_uvs.empty());
    std::size_t seen = 0;
    for (std::size_t t = 0; t < m.n_triangles(); ++t) {
        if (m.scene->parts[mesh::part_of(m, t)].material != "wood") continue;
        for (int k = 0; k < 3; ++k, ++seen) {
            const Vec3 p = m.position(t, k);
            const Vec2f uv = m.corner_uvs[3 * t + static_cast<std::size_t>(k)];
            EXPECT_NEAR(uv.x, p.y < 0.5 ? 0.625 : 0.75, 1e-6);
            EXPECT_NEAR(uv.y, p.x > 9 ? 0.3125 : 0.8125, 1e-6);
        }
    }
    EXPECT_EQ(seen, 6u);
}

TEST_P(Box123, BringsItsPictureUnlessTheWriterHasLeftItOut) {
    const mesh::TriangleMesh m = read().mesh;
    const bool has_none = is_x3d();  // Blender writes none for a node material
    for (std::size_t g = 0; g < m.group_names.size(); ++g) {
        const auto& picture = m.materials[g].picture;
        EXPECT_EQ(picture != nullptr, m.group_names[g] == "box / wood" && !has_none) << m.group_names[g];
        if (!picture) continue;
        EXPECT_THAT(picture->rgb, testing::ElementsAre(0, 0, 255, 255, 255, 255, 255, 0, 0, 0, 255, 0));
    }
}

INSTANTIATE_TEST_SUITE_P(, Box123,
                         testing::Values("fbx/box.fbx", "dae/box.dae", "3mf/box.3mf", "x3d/box.x3d", "wrl/box.wrl"),
                         [](const auto& file) { return "Of" + fs::path(file.param).extension().string().substr(1); });

TEST(ForeignFormats, AreOfMetresAndKnownByTheirExtensionInAnyCase) {
    for (const char* name : {"a.fbx", "a.DAE", "a.3mf", "a.X3D", "a.glb"}) {
        EXPECT_TRUE(is_model_file(name)) << name;
        EXPECT_TRUE(states_unit(name)) << name;
    }
    // VRML is in metres by its standard, CAD writes it in millimetres; its axes are fixed.
    for (const char* name : {"a.obj", "a.stl", "a.wrl", "a.VRML"}) EXPECT_FALSE(states_unit(name)) << name;
    EXPECT_FALSE(is_model_file("a.blend"));
}

// Inches, z up, scaled by two and moved by ten.
TEST(ForeignFormats, AnFbxInTextHasItsUnitItsAxesAndItsMaterialsByFace) {
    const mesh::TriangleMesh m = surface_of(corpus("fbx/text.fbx")).mesh;
    const double inch = 0.0254;
    EXPECT_NEAR(m.bounds.lo.x, 10 * inch, 1e-7);
    EXPECT_NEAR(m.bounds.hi.x, 12 * inch, 1e-7);
    EXPECT_NEAR(m.bounds.hi.y, 4 * inch, 1e-7);
    EXPECT_NEAR(m.bounds.hi.z, 6 * inch, 1e-7);
    EXPECT_NEAR(volume_of(m, "wedge") / (inch * inch * inch), 8.0, 1e-4);
    EXPECT_THAT(m.group_names, UnorderedElementsAre("wedge / red", "wedge / blue"));
}

TEST(ForeignFormats, AnFbxWithYUpIsTurned) {
    const Folder folder;
    std::string text = text_of(corpus("fbx/text.fbx"));
    text = replaced(text, "\"UpAxis\", \"int\", \"Integer\", \"\",2", "\"UpAxis\", \"int\", \"Integer\", \"\",1");
    text = replaced(text, "\"FrontAxis\", \"int\", \"Integer\", \"\",1", "\"FrontAxis\", \"int\", \"Integer\", \"\",2");
    text = replaced(text, "\"FrontAxisSign\", \"int\", \"Integer\", \"\",-1",
                    "\"FrontAxisSign\", \"int\", \"Integer\", \"\",1");
    const Box box = bounds_of(read_model(folder.write("y.fbx", text)));
    EXPECT_NEAR(box.hi.z, 4 * 0.0254, 1e-7) << "what was y is up";
    EXPECT_NEAR(box.lo.y, -6 * 0.0254, 1e-7) << "what looked to the front looks along -y";
}

TEST(ForeignFormats, ADaeHasItsUnitAndItsAxes) {
    const Folder folder;
    const std::string text = text_of(corpus("dae/box.dae"));
    const Box plain = bounds_of(read_model(folder.write("plain.dae", text)));
    const Box small =
        bounds_of(read_model(folder.write("small.dae", replaced(text, "meter=\"1\"", "meter=\"0.0254\""))));
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(small.hi[k], 0.0254 * plain.hi[k], 1e-6);
    const Box turned = bounds_of(read_model(folder.write("turned.dae", replaced(text, "Z_UP", "Y_UP"))));
    EXPECT_NEAR(turned.hi.z, plain.hi.y, 1e-5);
    EXPECT_NEAR(turned.lo.y, -plain.hi.z, 1e-5);
}

// A unit that a person says is that of the numbers in the file, whatever it states.
TEST(ForeignFormats, AUnitThatIsSaidGoesBeforeTheOneThatTheFileStates) {
    const Folder folder;
    const std::string dae = text_of(corpus("dae/box.dae")),
                      x3d = replaced(text_of(corpus("x3d/box.x3d")), "</head>",
                                     "<unit category='length' name='foot' conversionFactor='0.3048'/></head>");
    folder.write("inch.dae", replaced(dae, "<unit name=\"meter\" meter=\"1\"", "<unit meter = '0.0254' name=\"i\""));
    folder.write("centimetre.dae",
                 replaced(dae, "<unit name=\"meter\" meter=\"1\"", "<unit name=\"centimeter\" meter=\"0.01\""));
    folder.write("meter.dae", replaced(dae, "<unit name=\"meter\" meter=\"1\"", "<unit  name='meter' meter='2.54e-2'"));
    folder.write("none.dae", replaced(dae, "<unit name=\"meter\" meter=\"1\"/>", ""));
    const std::vector<std::pair<fs::path, double>> files{
        {corpus("fbx/text.fbx"), 0.0254},        {corpus("3mf/materials.3mf"), 0.0254},
        {folder.path / "inch.dae", 0.0254},      {folder.path / "none.dae", 1},
        {folder.path / "centimetre.dae", 0.01},  {folder.path / "meter.dae", 0.0254},
        {folder.write("foot.x3d", x3d), 0.3048}, {corpus("gltf/binary.glb"), 1}};
    for (const auto& [path, stated] : files) {
        const mesh::PolygonSoup soup = read_model(path);
        EXPECT_NEAR(soup.stated_unit / stated, 1, 1e-6) << path << ": floats";
        EXPECT_EQ(metres_per_unit(soup), 1.0) << path;
        EXPECT_NEAR(metres_per_unit(soup, "cm").value() * stated, 0.01, 1e-8) << path;
    }
    const mesh::PolygonSoup vrml = read_model(corpus("wrl/box.wrl"));
    EXPECT_EQ(metres_per_unit(vrml), std::nullopt) << "VRML 2.0 states no unit";
    EXPECT_EQ(metres_per_unit(vrml, "cm"), 0.01);
}

TEST(ForeignFormats, A3mfHasItsUnitItsComponentsAndAMaterialForEachTriangle) {
    const mesh::PolygonSoup soup = read_model(corpus("3mf/materials.3mf"));
    const Box box = bounds_of(soup);
    // 1 x 2 x 3 inches, a copy 10 inches along x, both turned by 90 degrees round z and lifted by 7.
    EXPECT_NEAR(box.lo.x, -2 * 0.0254, 1e-9);
    EXPECT_NEAR(box.hi.y, 11 * 0.0254, 1e-9);
    EXPECT_NEAR(box.lo.z, 7 * 0.0254, 1e-9);
    EXPECT_NEAR(box.hi.z, 10 * 0.0254, 1e-9);
    EXPECT_THAT(soup.group_names, UnorderedElementsAre("tet / red glaze", "tet / blue", "tet / wood"));
    EXPECT_EQ(soup.n_polygons(), 8u);
    std::map<std::string, std::size_t> faces;
    for (const std::uint32_t g : soup.polygon_groups) ++faces[soup.group_names[g]];
    EXPECT_EQ(faces["tet / red glaze"], 4u);
    EXPECT_EQ(faces["tet / blue"], 2u);
}

// Written by lib3mf 1.8.1, whose archives are ZIP64: a box of one inch, and twice a group of that box, turned and twice
// as large, and of a mirrored wedge of 0.5 x 1 x 0.7 / 6 cubic inches, half as high. Floats.
TEST(ForeignFormats, A3mfInAZip64ArchiveIsRead) {
    const mesh::PolygonSoup soup = read_model(corpus("3mf/zip64.3mf"));
    ASSERT_EQ(soup.n_polygons(), 2u * (12 + 4) + 12);
    double volume = 0;
    for (std::size_t p = 0; p < soup.n_polygons(); ++p) {
        const auto at = [&](std::size_t k) { return soup.points[soup.corners[soup.polygon_start[p] + k]]; };
        volume += glm::dot(at(0), glm::cross(at(1), at(2))) / 6;
    }
    const double inch3 = 0.0254 * 0.0254 * 0.0254;
    EXPECT_NEAR(volume / inch3, 2 * 0.5 * (8 + 0.5 * 0.7 / 6) + 1, 1e-4);  // its numbers have six digits
    const Folder folder;
    const std::string whole = text_of(corpus("3mf/zip64.3mf"));
    int n_refused = 0;
    for (std::size_t n = whole.size() - 150; n < whole.size(); n += 2)  // its directory
        for (const char bad : {'\x00', '\x7f', '\xff'}) {
            std::string damaged = whole;
            damaged[n] = bad;
            // Times and checksums are not looked at; all else is read as it was, or refused.
            try {
                const mesh::PolygonSoup read = read_model(folder.write("damaged.3mf", damaged));
                EXPECT_EQ(read.points, soup.points) << n;
                EXPECT_EQ(read.corners, soup.corners) << n;
            } catch (const Error& error) {
                EXPECT_THAT(error.what(), HasSubstr("damaged.3mf: ")) << n;
                ++n_refused;
            }
        }
    EXPECT_GT(n_refused, 20);
}

void expect_sets(const std::string& file) {
    const mesh::PolygonSoup soup = read_model(corpus(file));
    const Box box = bounds_of(soup);
    EXPECT_NEAR(box.hi.x, 0.010, 1e-9) << "millimetres";
    EXPECT_NEAR(box.lo.y, -0.009, 1e-9) << "z of the file to -y";
    EXPECT_EQ(soup.n_polygons(), 2u + 1u + 1u + 2u);
    EXPECT_THAT(soup.group_names, Contains("plate / red"));
    EXPECT_THAT(soup.group_names, Contains("chosen"));
    EXPECT_THAT(texts(soup.warnings), Contains(HasSubstr("Sphere")));
    EXPECT_THAT(texts(soup.warnings), Contains(HasSubstr("Inline")));
}

TEST(ForeignFormats, AnX3dHasItsSetsStripsFansAndUnit) {
    expect_sets("x3d/sets.x3d");
    expect_sets("wrl/sets.x3dv");  // the same in the classic encoding, with a prototype that is left out
}

TEST(ForeignFormats, AnX3dOfNothingButWhatIsNotReadSaysSo) {
    const Folder folder;
    EXPECT_THAT(
        fault_of(folder.write("box.x3d", "<X3D><Scene><Shape><Box/></Shape><Shape><Cone/></Shape></Scene></X3D>")),
        HasSubstr("of <Box>, <Cone> none are"));
    EXPECT_THAT(fault_of(folder.write("ball.wrl", "#VRML V2.0 utf8\nShape { geometry Sphere { radius 2 } }\n")),
                HasSubstr("of <Sphere> none are"));
}

TEST(ForeignFormats, VrmlIsReadInItsSecondVersionAndRefusedWithTheLine) {
    const Folder folder;
    const std::string shape =
        "Shape { geometry IndexedFaceSet { coord DEF c Coordinate { point [ 0 0 0, 1 0 0, 0 1 0 ] } coordIndex [ 0 1 2 "
        "-1 ] } }";
    // The later of two nodes of one name is used; what stands for a shape in collisions is no shape.
    const std::string twice =
        "#VRML V2.0 utf8\nTransform { children DEF c Shape { } }\nCollision { proxy " + shape +
        " children [ Shape { geometry IndexedFaceSet { coord DEF c Coordinate { point [ 0 0 5 1 0 5 0 1 5 ] } "
        "coordIndex [ 0 1 2 ] } } Shape { geometry IndexedFaceSet { coord USE c coordIndex [ 2 1 0 ] } } ] }";
    const mesh::PolygonSoup soup = read_model(folder.write("twice.wrl", twice));
    EXPECT_EQ(soup.n_polygons(), 2u);
    EXPECT_NEAR(bounds_of(soup).hi.y, -5, 1e-9);
    EXPECT_THAT(fault_of(folder.write("old.wrl", "#VRML V1.0 ascii\nSeparator { Cube { } }")),
                HasSubstr("is VRML 1.0, which tuft does not read; export it as VRML 2.0"));
    EXPECT_THAT(fault_of(folder.write("zip.wrl", "\x1f\x8b\x08")), HasSubstr("gunzip"));
    EXPECT_THAT(fault_of(folder.write("a.wrl", "#VRML V2.0 utf8\n" + shape + "\nShape { geometry [")),
                HasSubstr("line 3"));
    EXPECT_THAT(fault_of(folder.write("b.wrl", "#VRML V2.0 utf8\nGroup { children \"open }")), HasSubstr("no end"));
    std::string deep = "#VRML V2.0 utf8\n";
    for (int i = 0; i < 300'000; ++i) deep += "Group { children ";
    EXPECT_THAT(fault_of(folder.write("deep.wrl", deep)), HasSubstr("256 deep"));
}

/// A face at a height z of the file.
std::string face(int z, const std::string& coord = "") {
    const std::string at = " " + std::to_string(z) + " ";
    return "Shape { geometry IndexedFaceSet { coord " + coord + " Coordinate { point [ 0 0" + at + "1 0" + at + "0 1" +
           at + "] } coordIndex [ 0 1 2 ] } }";
}

/// The heights z of the faces' points, in the order of the file.
std::vector<double> heights_of(const Folder& folder, const std::string& body) {
    const mesh::PolygonSoup soup = read_model(folder.write("a.wrl", "#VRML V2.0 utf8\n" + body));
    std::vector<double> z;
    for (std::size_t i = 0; i < soup.corners.size(); i += 3) z.push_back(-soup.points[soup.corners[i]].y);
    return z;
}

TEST(ForeignFormats, VrmlEndsACommentWithEitherEndOfLine) {
    const Folder folder;
    EXPECT_THAT(heights_of(folder, "# a comment\r" + face(2) + "\r"), ElementsAre(2));
    EXPECT_THAT(fault_of(folder.write("b.wrl", "#VRML V2.0 utf8\r\n#\rGroup { children \"open }")),
                HasSubstr("line 3"));
    EXPECT_EQ(read_model(folder.write("mark.txt", "\xef\xbb\xbf#VRML V2.0 utf8\n" + face(2))).n_polygons(), 1u);
}

TEST(ForeignFormats, VrmlCountsAmongTheChoicesOfASwitchItsChildrenAlone) {
    const Folder folder;
    const std::string choices = "choice [ " + face(1) + face(2) + " ] }";
    EXPECT_THAT(heights_of(folder, "Switch { PROTO P [ ] { } whichChoice 0 " + choices), ElementsAre(1));
    EXPECT_THAT(heights_of(folder, "Switch { metadata MetadataString { } whichChoice 1 " + choices), ElementsAre(2));
    EXPECT_THAT(heights_of(folder, "Switch { whichChoice 1 choice [ USE nothing " + face(3) + " ] }"), ElementsAre(3));
}

TEST(ForeignFormats, VrmlUsesTheNodeOfTheNameWhereverItWasDefined) {
    const Folder folder;
    const std::string use = "Shape { geometry IndexedFaceSet { coord USE c coordIndex [ 0 1 2 ] } }";
    EXPECT_THAT(heights_of(folder, "Collision { proxy " + face(4, "DEF c") + " children [ " + use + " ] }"),
                ElementsAre(4));
    // A name of the file is not taken for the second node of another name.
    EXPECT_THAT(heights_of(folder, face(1, "DEF c_2") + face(2, "DEF c") + face(3, "DEF c") + use),
                ElementsAre(1, 2, 3, 3));
    EXPECT_THAT(heights_of(folder, face(5, "DEF c") + "Shape { geometry TriangleSet { coord USE c } }"),
                ElementsAre(5, 5));
}

// A path in a file leads nowhere but into its folder.
TEST(ForeignFormats, NeverReadAPictureOutsideTheirFolder) {
    const Folder folder;
    folder.write_picture("secret.png");
    fs::create_directories(folder.path / "in");
    std::string dae = replaced(text_of(corpus("dae/box.dae")), ">wood.png<", ">../secret.png<");
    std::string x3d = replaced(text_of(corpus("x3d/sets.x3d")), "../outside.png", "../secret.png");
    const std::string wrl = replaced(text_of(corpus("wrl/sets.x3dv")), "../outside.png", "../secret.png");
    for (const fs::path& path :
         {folder.write("in/a.dae", dae), folder.write("in/a.x3d", x3d), folder.write("in/a.x3dv", wrl)}) {
        const mesh::PolygonSoup soup = read_model(path);
        EXPECT_THAT(texts(soup.warnings), Contains(HasSubstr("secret.png"))) << path;
        for (const mesh::Material& m : soup.materials) EXPECT_EQ(m.picture, nullptr) << path;
    }
}

// Assimp's recursion over nodes has no bound; the process that it crashes is not this one.
TEST(ForeignFormats, AFileThatCrashesTheImporterIsAnErrorInOneLine) {
    const Folder folder;
    std::string deep;
    constexpr int kDeep = 300'000;
    for (int i = 0; i < kDeep; ++i) deep += "<node>";
    for (int i = 0; i < kDeep; ++i) deep += "</node>";
    std::string text = text_of(corpus("dae/box.dae"));
    const std::size_t at = text.find("<node ");
    const std::string fault = fault_of(folder.write("deep.dae", text.insert(at, deep)));
    EXPECT_THAT(fault, HasSubstr("deep.dae: is damaged"));
    EXPECT_EQ(fault.find('\n'), fault.npos);
}

// Each level uses the one below ten times: 10^12 boxes in 3 kB.
TEST(ForeignFormats, CopiesOfCopiesHaveAnEnd) {
    const Folder folder;
    std::string x3d = "<X3D><Scene><Switch whichChoice='-1'><Group DEF='g0'><Shape><Box/></Shape></Group>";
    for (int level = 1; level <= 12; ++level) {
        x3d += "<Group DEF='g" + std::to_string(level) + "'>";
        for (int k = 0; k < 10; ++k) x3d += "<Group USE='g" + std::to_string(level - 1) + "'/>";
        x3d += "</Group>";
    }
    EXPECT_THAT(fault_of(folder.write("many.x3d", x3d + "</Switch><Group USE='g12'/></Scene></X3D>")),
                HasSubstr("more than four million nodes"));
    EXPECT_THAT(fault_of(folder.write("loop.x3d", "<X3D><Scene><Group DEF='a'><Group USE='a'/></Group></Scene></X3D>")),
                HasSubstr("tree"));
}

TEST(ForeignFormats, DamagedArchivesAreErrorsInOneLine) {
    const Folder folder;
    for (const char* name : {"3mf/box.3mf", "3mf/zip64.3mf"}) {
        const std::string whole = text_of(corpus(name));
        for (std::size_t n = 1; n < whole.size(); n += 13) {
            const std::string fault = fault_of(folder.write("cut.3mf", whole.substr(0, n)));
            EXPECT_THAT(fault, HasSubstr("cut.3mf: ")) << n;
            EXPECT_EQ(fault.find('\n'), fault.npos) << fault;
        }
    }
    EXPECT_THAT(fault_of(folder.write("no.3mf", "PK not at all, whatever the name says")), HasSubstr("cut short"));
}

// What the importer's process hands over is checked like a file.
TEST(ForeignFormats, APackedSceneIsReadBackAndRefusedWhereItIsDamaged) {
    FileScene scene;
    scene.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    scene.materials = {{.name = "m", .colour = {0.5f, 0.25f, 1}, .picture = "p.png", .picture_bytes = {'a', 'b'}}};
    scene.parts = {{.object = "o", .material = 0}};
    const std::array<std::uint32_t, 3> corners{0, 1, 2};
    scene.add_polygon(0, corners, {});
    scene.add_polygon(0, corners, std::array<Vec2f, 3>{Vec2f(0), Vec2f(1), Vec2f(2)});
    const std::vector<char> bytes = pack_scene(scene);
    const FileScene back = unpack_scene(bytes, "x");
    EXPECT_EQ(pack_scene(back), bytes);
    EXPECT_TRUE(std::isnan(back.uvs[2].x)) << "the first polygon has none";
    for (std::size_t n = 0; n < bytes.size(); ++n)
        EXPECT_THROW(unpack_scene(std::span(bytes).first(n), "x"), Error) << n;
    scene.corners[1] = 3;
    EXPECT_THROW(unpack_scene(pack_scene(scene), "x"), Error) << "a corner at a point that is not there";
}

}  // namespace
}  // namespace tuft::io
