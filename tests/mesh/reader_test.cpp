#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/files/files.h"
#include "mesh/read/polygon_soup.h"
#include "mesh/repair/inspect.h"
#include "mesh/repair/repair.h"
#include "mesh_checks.h"
#include "paths.h"

namespace tuft::mesh {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Bytes of a binary file, put together value by value.
class Binary {
  public:
    explicit Binary(std::string head = {}, bool big_endian = false)
        : bytes_(std::move(head)), big_endian_(big_endian) {}
    template <class T>
    Binary& put(T value) {
        char raw[sizeof(T)];
        std::memcpy(raw, &value, sizeof value);
        if (big_endian_) std::reverse(raw, raw + sizeof raw);
        bytes_.append(raw, sizeof raw);
        return *this;
    }
    std::vector<char> bytes() const { return bytes_of(bytes_); }

  private:
    std::string bytes_;
    bool big_endian_;
};

/// The unit cube as every format's reader must give it, however it was stored.
void expect_unit_cube(PolygonSoup soup, const char* what, std::size_t groups = 0) {
    SCOPED_TRACE(what);
    EXPECT_TRUE(soup.warnings.empty());
    EXPECT_EQ(soup.group_names.size(), groups);
    const Surface s = build_surface(std::move(soup), {.metres_per_unit = 1});
    EXPECT_THAT(broken_promises(s), ElementsAre());
    EXPECT_EQ(s.mesh.n_vertices(), 8u);
    EXPECT_EQ(s.mesh.n_triangles(), 12u);
    EXPECT_TRUE(s.report.closed);
    EXPECT_EQ(s.report.faces_flipped, 0u);
    EXPECT_DOUBLE_EQ(signed_volume(s.mesh), 1);  // small integers: exact
    EXPECT_DOUBLE_EQ(surface_area(s.mesh), 6);
}

const std::string kObjPoints = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n";
const std::string kObjQuads = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

TEST(Obj, CubeInEveryDialect) {
    const auto expect = [](const std::string& text, const char* what) {
        expect_unit_cube(read_obj(bytes_of(text), "cube.obj"), what);
    };
    expect(kObjPoints + kObjQuads, "plain");
    expect(replaced(kObjPoints + kObjQuads, "\n", "\r\n"), "CR LF");
    expect(replaced(kObjPoints + kObjQuads, "\n", "\r"), "CR");
    expect(kObjQuads + kObjPoints, "faces before their vertices");
    expect("\xEF\xBB\xBF# made by hand\n\n" + kObjPoints + "s off\nvn 0 0 1\n" + kObjQuads, "comments");
    expect(replaced(replaced(kObjPoints + kObjQuads, "v ", "V  \t"), "f ", "F "), "upper case");
    expect(kObjPoints + replaced(kObjQuads, "\n", " # a face\n"), "inline comments");
    expect(kObjPoints + "f 1 3 \\\n4 2\nf 5 6 8\\\n 7\nf 1 2 6 5\nf 3 \\\r\n 7 8 4\nf 1 5 7 3\nf 2 4 8 6",
           "continued lines, no line end at the end");
    expect(kObjPoints +
               "f -8 -6 -5 -7\nf -4 -3 -1 -2\nf 1//1 2//1 6//1 5//1\nf 3 7 8 4\n"
               "f -8 -4 -2 -6\nf 2 4 8 6\n",
           "relative");
    expect(replaced(kObjPoints, "1", "+1.0e+00") + kObjQuads, "exponents and signs");
    expect(kObjPoints + "l 1 2\np 1\nmtllib x.mtl\nfoo bar baz\n" + kObjQuads, "other lines");
}

TEST(Obj, GroupsObjectsAndMaterialsAreKept) {
    const PolygonSoup soup =
        read_obj(bytes_of(kObjPoints + "f 1 3 4\no Car\nf 1 4 2\ng Door\nusemtl Red Paint # fine\nf 5 6 8 7\n"
                                       "usemtl\nf 1 2 6 5\n"),
                 "a.obj");
    EXPECT_THAT(soup.group_names, ElementsAre("Car", "Car / Door / Red Paint", "Car / Door", ""));
    EXPECT_THAT(soup.polygon_groups, ElementsAre(3u, 0u, 1u, 2u));
    const Surface s = build_surface(soup);
    EXPECT_THAT(s.mesh.triangle_groups, ElementsAre(3u, 0u, 1u, 1u, 2u, 2u));
    EXPECT_EQ(s.mesh.group_names[1], "Car / Door / Red Paint");
    ASSERT_TRUE(s.mesh.scene);
    EXPECT_EQ(s.mesh.scene->parts[1], (ScenePart{.object = "Car", .group = "Door", .material = "Red Paint"}));
}

TEST(Obj, ThereIsNoGroupWithoutFacesAndThoseOfTheFileAreReported) {
    const PolygonSoup soup = read_obj(
        bytes_of(kObjPoints + "o Empty\no Car\ng default\ng Door\nusemtl Red\n" + kObjQuads + "o Tail\ng Lamp\n"),
        "a.obj");
    EXPECT_THAT(soup.group_names, ElementsAre("Car / Door / Red")) << "o, g and usemtl name one group together";
    EXPECT_THAT(texts(soup.warnings), ElementsAre("3 groups have no faces and are left out: 'Empty', 'Tail', 'Lamp'"));
}

TEST(Obj, VertexColoursAsRealsOrBytes) {
    const char* tail = "v 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const PolygonSoup reals = read_obj(bytes_of(std::string("v 0 0 0 1 0.5 0\n") + tail), "a.obj");
    ASSERT_EQ(reals.point_colours.size(), 3u);
    EXPECT_THAT(reals.point_colours[0], ElementsAre(255, 128, 0, 255));
    EXPECT_THAT(reals.point_colours[1], ElementsAre(255, 255, 255, 255));
    const PolygonSoup whole = read_obj(bytes_of("v 0 0 0 255 128 0\nv 1 0 0 0 0 0\nv 0 1 0 0 1 0\nf 1 2 3\n"), "a.obj");
    EXPECT_THAT(whole.point_colours[0], ElementsAre(255, 128, 0, 255));
}

// OpenMesh's own readers put the texture coordinates of quads on the wrong corners.
TEST(Obj, TextureCoordinatesStayOnTheirCorners) {
    std::string text = kObjPoints;
    for (int v = 0; v <= 1; ++v)
        for (int u = 0; u <= 1; ++u) text += "vt " + std::to_string(u) + " " + std::to_string(v) + "\n";
    // Top and bottom: the coordinate equals x and y.
    text += "f 1/1 3/3 4/4 2/2\nf 5/-4/1 6/-3/1 8/-1/1 7/-2/1\n";
    const Surface s = build_surface(read_obj(bytes_of(text), "a.obj"), {.metres_per_unit = 1});
    ASSERT_EQ(s.mesh.n_triangles(), 4u);
    for (std::size_t t = 0; t < 4; ++t)
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(s.mesh.corner_uvs[3 * t + static_cast<std::size_t>(k)],
                      Vec2f(s.mesh.position(t, k).x, s.mesh.position(t, k).y));
}

TEST(Obj, FacesWithoutTextureCoordinatesAmongOthersAreReported) {
    const PolygonSoup soup =
        read_obj(bytes_of(kObjPoints + "vt 0.5 0.25\nf 1 3 4\nf 1/1 4/1 2/1\nf 5/1 6/9 8/1\n"), "a.obj");
    ASSERT_EQ(soup.corner_uvs.size(), 9u);
    EXPECT_EQ(soup.corner_uvs[0], Vec2f(0));
    EXPECT_EQ(soup.corner_uvs[3], Vec2f(0.5, 0.25));
    EXPECT_EQ(soup.corner_uvs[6], Vec2f(0));
    EXPECT_THAT(texts(soup.warnings), ElementsAre("1 faces use texture coordinates that do not exist (line 12)",
                                                  "2 faces have no texture coordinates while others do"));
}

TEST(Obj, RowsThatAreNotFiniteAreDroppedByLine) {
    const PolygonSoup soup =
        read_obj(bytes_of("v 0 0 0\nv nan 0 0\nv 1 0 0\nv 0 1 0\nv 0 -inf 0\nv 1 1 1.#QNAN\nv 1e999 0 0\n"
                          "v 1 1e-999 1\nf 1 2 3\nf 1 3 4\nf 5 1 3 4\nf 3 8 4\n"),
                 "a.obj");
    EXPECT_EQ(soup.points.size(), 4u);
    EXPECT_THAT(soup.corners, ElementsAre(0, 1, 2, 1, 3, 2));
    EXPECT_EQ(soup.points[3], Vec3(1, 0, 1));
    ASSERT_EQ(soup.warnings.size(), 1u);
    EXPECT_THAT(soup.warnings[0].text(), HasSubstr("(line 2, 5, 6, 7), and with them 2 faces"));
}

const std::string kPlyText =
    "ply\nformat ascii 1.0\ncomment by hand\nobj_info none\nelement vertex 8\nproperty float x\n"
    "property float y\nproperty float z\nelement face 6\nproperty list uchar int vertex_indices\n"
    "end_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n"
    "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";

std::vector<char> binary_ply_cube(bool big_endian, const std::string& line_end) {
    const PolygonSoup box = make_box();
    Binary out(replaced(std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                            "_endian 1.0\nelement vertex 8\nproperty double x\nproperty short y\n"
                            "property list uchar float extra\nproperty float32 z\n"
                            "element edge 1\nproperty int vertex1\nproperty list int short l\n"
                            "element face 6\nproperty uchar flag\n"
                            "property list uint16 uint32 vertex_index\nend_header\n",
                        "\n", line_end),
               big_endian);
    for (const Vec3& p : box.points)
        out.put(p.x).put(static_cast<std::int16_t>(p.y)).put(std::uint8_t{1}).put(7.5f).put(static_cast<float>(p.z));
    out.put(std::int32_t{10}).put(std::int32_t{2}).put(std::int16_t{1}).put(std::int16_t{2});
    for (std::size_t p = 0; p < 6; ++p) {
        out.put(std::uint8_t{9}).put(std::uint16_t{4});
        for (std::size_t c = 4 * p; c < 4 * p + 4; ++c) out.put(box.corners[c]);
    }
    return out.bytes();
}

TEST(Ply, CubeInEveryDialect) {
    expect_unit_cube(read_ply(bytes_of(kPlyText), "a.ply"), "text");
    expect_unit_cube(read_ply(bytes_of(replaced(kPlyText, "\n", "\r\n")), "a.ply"), "CR LF");
    expect_unit_cube(read_ply(bytes_of(replaced(kPlyText, "\n", "\r")), "a.ply"), "CR");
    expect_unit_cube(
        read_ply(bytes_of(replaced(replaced(kPlyText, "float", "FLOAT32"), "element", "ELEMENT")), "a.ply"),
        "upper case");
    for (const bool big_endian : {false, true})
        for (const char* line_end : {"\n", "\r\n", "\r"})
            expect_unit_cube(read_ply(binary_ply_cube(big_endian, line_end), "a.ply"), "binary");
}

TEST(Ply, TriangleStripsTurnEverySecondTriangle) {
    const std::string text =
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
        "property float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n9 0 1 2 3 -1 2 3 4 4\n";
    const PolygonSoup soup = read_ply(bytes_of(text), "strip.ply");
    EXPECT_THAT(soup.corners, ElementsAre(0, 1, 2, 2, 1, 3, 2, 3, 4));
    const Surface s = build_surface(soup);
    EXPECT_EQ(s.report.faces_flipped, 0u);
    EXPECT_EQ(s.report.components, 1u);
}

TEST(Ply, TextureCoordinatesPerVertexAndPerFace) {
    const std::string head =
        "ply\nformat ascii 1.0\ncomment TextureFile a.png\ncomment TextureFile b.png\n"
        "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
    for (const auto& [u, v] : {std::pair{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}) {
        const PolygonSoup soup =
            read_ply(bytes_of(head + "property float " + u + "\nproperty float " + v +
                              "\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                              "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n4 1 2 3 0\n"),
                     "a.ply");
        EXPECT_THAT(soup.corner_uvs, ElementsAre(Vec2f(1, 0), Vec2f(1, 1), Vec2f(0, 1), Vec2f(0, 0)));
    }
    const PolygonSoup soup =
        read_ply(bytes_of(head + "element face 2\nproperty list uchar int vertex_indices\n"
                                 "property list uchar float texcoord\nproperty int texnumber\nend_header\n"
                                 "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 6 0 0 1 0 1 nan 1\n3 0 2 3 4 1 1 1 1 0\n"),
                 "a.ply");
    EXPECT_THAT(soup.corner_uvs, ElementsAre(Vec2f(0, 0), Vec2f(1, 0), Vec2f(0, 0), Vec2f(0), Vec2f(0), Vec2f(0)));
    EXPECT_THAT(soup.polygon_groups, ElementsAre(0u, 1u));
    EXPECT_THAT(soup.group_names, ElementsAre("b.png", "a.png"));
    EXPECT_EQ(soup.warnings.size(), 3u);
}

TEST(Ply, ColoursOfAllTypes) {
    const auto colour = [](const std::string& type, const std::string& row) {
        const std::string p = "property " + type + " ";
        return read_ply(bytes_of("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty "
                                 "float y\n"
                                 "property float z\n" +
                                 p + "red\n" + p + "green\n" + p +
                                 "blue\n"
                                 "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                                 "0 0 0 " +
                                 row + "\n1 0 0 " + row + "\n0 1 0 " + row + "\n3 0 1 2\n"),
                        "a.ply")
            .point_colours[2];
    };
    EXPECT_THAT(colour("uchar", "255 128 0"), ElementsAre(255, 128, 0, 255));
    EXPECT_THAT(colour("float", "1.0 0.5 0"), ElementsAre(255, 128, 0, 255));
    EXPECT_THAT(colour("ushort", "65535 32896 0"), ElementsAre(255, 128, 0, 255));
}

TEST(Ply, RowsThatAreNotFiniteAreReportedByLineOrRow) {
    const PolygonSoup text = read_ply(bytes_of(replaced(kPlyText, "0 0 1\n1 0 1", "0 0 nan\n1 0 1")), "a.ply");
    ASSERT_EQ(text.warnings.size(), 1u);
    EXPECT_THAT(text.warnings[0].text(), HasSubstr("(line 16), and with them 3 faces"));
    std::vector<char> bytes = binary_ply_cube(false, "\n");
    const double infinite = std::numeric_limits<double>::infinity();
    // The first value of row 2; a row takes 8 + 2 + 1 + 4 + 4 bytes.
    const std::size_t body = std::string(bytes.begin(), bytes.end()).find("end_header\n") + 11;
    std::memcpy(bytes.data() + body + 19, &infinite, sizeof infinite);
    const PolygonSoup binary = read_ply(bytes, "a.ply");
    ASSERT_EQ(binary.warnings.size(), 1u);
    EXPECT_THAT(binary.warnings[0].text(), HasSubstr("(row 2), and with them 3 faces"));
}

std::vector<char> binary_stl(const PolygonSoup& soup, std::string head) {
    const Surface s = build_surface(soup, {.metres_per_unit = 1});
    head.resize(80, '\0');
    Binary out(head);
    out.put(static_cast<std::uint32_t>(s.mesh.n_triangles()));
    for (std::size_t t = 0; t < s.mesh.n_triangles(); ++t) {
        for (int k = 0; k < 3; ++k) out.put(0.0f);
        for (int k = 0; k < 3; ++k)
            for (int axis = 0; axis < 3; ++axis)
                out.put(s.mesh.positions[s.mesh.triangles[t][static_cast<std::size_t>(k)]][axis]);
        out.put(std::uint16_t{0});
    }
    return out.bytes();
}

std::string text_stl(const PolygonSoup& soup, const std::string& name) {
    const Surface s = build_surface(soup, {.metres_per_unit = 1});
    std::string out = "solid " + name + "\n";
    for (std::size_t t = 0; t < s.mesh.n_triangles(); ++t) {
        out += " facet normal 0 0 0\n  outer loop\n";
        for (int k = 0; k < 3; ++k) {
            const Vec3 p = s.mesh.position(t, k);
            out += "   vertex " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
        }
        out += "  endloop\n endfacet\n";
    }
    return out + "endsolid " + name + "\n";
}

TEST(Stl, CubeInEveryDialect) {
    expect_unit_cube(read_stl(binary_stl(make_box(), "made by hand"), "a.stl"), "binary");
    expect_unit_cube(read_stl(binary_stl(make_box(), "solid in name only"), "a.stl"), "binary that says solid");
    const std::string text = text_stl(make_box(), "cube");
    expect_unit_cube(read_stl(bytes_of(text), "a.stl"), "text");
    expect_unit_cube(read_stl(bytes_of(replaced(text, "\n", "\r\n")), "a.stl"), "CR LF");
    std::string upper = text;
    for (char& c : upper) c = static_cast<char>(std::toupper(c));
    expect_unit_cube(read_stl(bytes_of(upper), "a.STL"), "upper case");
}

TEST(Stl, SolidsOfATextFileAreGroups) {
    const PolygonSoup soup =
        read_stl(bytes_of(text_stl(make_box(), "left") + text_stl(make_box(Vec3(3, 0, 0)), "")), "a.stl");
    EXPECT_THAT(soup.group_names, ElementsAre("left", "solid 2"));
    const Surface s = build_surface(soup);
    EXPECT_EQ(s.report.components, 2u);
    EXPECT_TRUE(s.report.file.loose_triangles);
    EXPECT_THAT(texts(describe_defects(s.report)), ElementsAre());
}

/// Puts 16 bits behind facet `t` of a binary STL file.
void set_facet_bits(std::vector<char>& bytes, std::size_t t, std::uint16_t bits) {
    std::memcpy(bytes.data() + 84 + 50 * t + 48, &bits, sizeof bits);
}

TEST(Stl, ColoursOfFacetsAreGroups) {
    // VisCAM: the highest bit says that there is a colour, blue is lowest.
    std::vector<char> bytes = binary_stl(make_box(), "");
    for (std::size_t t = 0; t < 12; ++t) set_facet_bits(bytes, t, t < 2 ? 0x8000 | 31 << 10 : 0x8000 | 31);
    set_facet_bits(bytes, 11, 31 << 5);  // the highest bit is 0: none
    const PolygonSoup viscam = read_stl(bytes, "a.stl");
    EXPECT_THAT(viscam.group_names, ElementsAre("#ff0000", "#0000ff", ""));
    EXPECT_THAT(viscam.polygon_groups, ElementsAre(0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2));

    // Magics: the head has the colour of all, 0 in the highest bit another, red is lowest.
    bytes = binary_stl(make_box(), std::string("COLOR=") + "\x10\x20\x30\xff" + ",MATERIAL=");
    for (std::size_t t = 0; t < 12; ++t) set_facet_bits(bytes, t, 0x8000);
    set_facet_bits(bytes, 3, 31);
    set_facet_bits(bytes, 4, 16 << 10);
    const PolygonSoup magics = read_stl(bytes, "a.stl");
    EXPECT_THAT(magics.group_names, ElementsAre("#102030", "#ff0000", "#000084"));
    EXPECT_THAT(magics.polygon_groups, ElementsAre(0, 0, 0, 1, 2, 0, 0, 0, 0, 0, 0, 0));

    // "COLOR=" at the very end of the head has no four bytes behind it.
    bytes = binary_stl(make_box(), std::string(72, ' ') + "COLOR=");
    expect_unit_cube(read_stl(bytes, "a.stl"), "a cut colour");
}

TEST(Stl, NoGroupsWhereFacetsHaveOneColourOrAnyNumberOfThem) {
    std::vector<char> bytes = binary_stl(make_box(), "");
    for (std::size_t t = 0; t < 12; ++t) set_facet_bits(bytes, t, 0x8000 | 77);
    expect_unit_cube(read_stl(bytes, "a.stl"), "one colour");
    // What some programs leave there is no colour at all.
    std::vector<char> many = binary_stl(make_sheet(20), "");
    for (std::size_t t = 0; t < 800; ++t) set_facet_bits(many, t, static_cast<std::uint16_t>(0x8000 | t));
    const PolygonSoup soup = read_stl(many, "a.stl");
    EXPECT_THAT(soup.group_names, ElementsAre());
    EXPECT_THAT(soup.polygon_groups, ElementsAre());
    EXPECT_THAT(texts(soup.warnings), ElementsAre(HasSubstr("more than 256 colours")));
}

TEST(Ply, ColoursOfFacesAreGroups) {
    const auto ply = [](const std::string& type, const std::string& red, const std::string& blue) {
        return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
               "element face 2\nproperty list uchar int vertex_indices\nproperty " +
               type + " red\nproperty " + type + " green\nproperty " + type +
               " blue\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 " + red + "\n3 0 2 3 " + blue + "\n";
    };
    for (const std::string& text : {ply("uchar", "255 0 0", "0 0 255"), ply("float", "1 0 0", "0 0 1.5"),
                                    ply("ushort", "65535 0 0", "0 0 65535")}) {
        const PolygonSoup soup = read_ply(bytes_of(text), "a.ply");
        EXPECT_THAT(soup.group_names, ElementsAre("#ff0000", "#0000ff"));
        EXPECT_THAT(soup.polygon_groups, ElementsAre(0, 1));
    }
    const PolygonSoup one = read_ply(bytes_of(ply("uchar", "9 9 9", "9 9 9")), "a.ply");
    EXPECT_THAT(one.group_names, ElementsAre());
}

TEST(Off, ColoursOfFacesAreGroups) {
    const std::string points = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    for (const char* faces : {"3 0 1 2 255 0 0\n3 0 2 3 0 0 255 128\n", "3 0 1 2 1.0 0 0 # red\n3 0 2 3 0 0 1.0\n"}) {
        const PolygonSoup soup = read_off(bytes_of(points + faces), "a.off");
        EXPECT_THAT(soup.group_names, ElementsAre("#ff0000", "#0000ff"));
        EXPECT_THAT(soup.polygon_groups, ElementsAre(0, 1));
    }
    // An index into a table of colours, or words, are none.
    EXPECT_THAT(read_off(bytes_of(points + "3 0 1 2 1\n3 0 2 3 red\n"), "a.off").group_names, ElementsAre());
}

TEST(Stl, OddLengthsAreReported) {
    std::vector<char> bytes = binary_stl(make_box(), "");
    bytes.push_back('x');
    EXPECT_THAT(texts(read_stl(bytes, "a.stl").warnings), ElementsAre("1 bytes behind the last triangle are not read"));
    bytes.pop_back();
    std::memset(bytes.data() + 80, 0, 4);
    const PolygonSoup soup = read_stl(bytes, "a.stl");
    EXPECT_EQ(soup.n_polygons(), 12u);
    EXPECT_THAT(texts(soup.warnings), ElementsAre("the head says 0 triangles, the file holds 12"));
}

const std::string kOffBody =
    "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n"
    "4 0 2 3 1\n4 4 5 7 6 255 0 0\n4 0 1 5 4 0.5 0.5 0.5 1\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";

TEST(Off, CubeInEveryDialect) {
    const auto expect = [](const std::string& text, const char* what) {
        expect_unit_cube(read_off(bytes_of(text), "a.off"), what, 3);  // two colours, and none
    };
    expect("OFF\n8 6 12\n" + kOffBody, "plain");
    expect("OFF # a comment\n# another\n\n8 6 0 # counts\n" + kOffBody, "comments");
    expect("OFF 8 6 12\n" + kOffBody, "counts on the first line");
    expect("8 6\n" + kOffBody, "no magic");
    expect("OFF8 6 12\n" + kOffBody, "no end of the first line, as in ModelNet");
    expect(replaced("off\n8 6 12\n" + kOffBody, "\n", "\r\n"), "CR LF, lower case");
    Binary out("OFF BINARY\n", true);
    out.put(std::int32_t{8}).put(std::int32_t{6}).put(std::int32_t{12});
    const PolygonSoup box = make_box();
    for (const Vec3& p : box.points)
        for (int k = 0; k < 3; ++k) out.put(static_cast<float>(p[k]));
    for (std::size_t p = 0; p < 6; ++p) {
        out.put(std::int32_t{4});
        for (std::size_t c = 4 * p; c < 4 * p + 4; ++c) out.put(box.corners[c]);
        out.put(std::int32_t{1}).put(0.5f);
    }
    expect_unit_cube(read_off(out.bytes(), "a.off"), "binary");
}

TEST(Off, ColoursOfBinaryFacesAreGroups) {
    // Real ones, as many as the face says; fewer than three are an index into a table that there is none of.
    Binary out("OFF BINARY\n", true);
    out.put(std::int32_t{4}).put(std::int32_t{4}).put(std::int32_t{0});
    for (const Vec3f& p : {Vec3f{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) out.put(p.x).put(p.y).put(p.z);
    const auto face = [&](std::array<std::int32_t, 3> corners, const std::vector<float>& colour) {
        out.put(std::int32_t{3});
        for (const std::int32_t c : corners) out.put(c);
        out.put(static_cast<std::int32_t>(colour.size()));
        for (const float c : colour) out.put(c);
    };
    face({0, 2, 1}, {1, 0, 0});
    face({0, 1, 3}, {0, 0.5f, 1, 1});
    face({0, 3, 2}, {1, 0, 0, 0.25f});
    face({1, 2, 3}, {7});
    const PolygonSoup soup = read_off(out.bytes(), "a.off");
    EXPECT_THAT(soup.group_names, ElementsAre("#ff0000", "#0080ff", ""));
    EXPECT_THAT(soup.polygon_groups, ElementsAre(0u, 1u, 0u, 2u));
}

TEST(Off, ColoursNormalsAndTextureCoordinates) {
    const std::string tail = "3 0 1 2\n";
    const PolygonSoup bytes =
        read_off(bytes_of("COFF\n3 1 0\n0 0 0 255 128 0 64\n1 0 0 0 0 0 255\n0 1 0 1 1 1 255\n" + tail), "a.off");
    EXPECT_THAT(bytes.point_colours[0], ElementsAre(255, 128, 0, 64));
    const PolygonSoup reals =
        read_off(bytes_of("COFF\n3 1 0\n0 0 0 1.0 0.5 0\n1 0 0 0 0 0\n0 1 0 1 1 1\n" + tail), "a.off");
    EXPECT_THAT(reals.point_colours[0], ElementsAre(255, 128, 0, 255));
    const PolygonSoup all =
        read_off(bytes_of("STCNOFF\n3 1 0\n0 0 0 0 0 1 9 9 9 255 0.5 0.25\n1 0 0 0 0 1 9 9 9 255 1 0\n"
                          "0 1 0 0 0 1 9 9 9 255 0 1\n" +
                          tail),
                 "a.off");
    EXPECT_THAT(all.corner_uvs, ElementsAre(Vec2f(0.5, 0.25), Vec2f(1, 0), Vec2f(0, 1)));
    EXPECT_THAT(all.point_colours[0], ElementsAre(9, 9, 9, 255));
    const PolygonSoup normals =
        read_off(bytes_of("NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n" + tail), "a.off");
    EXPECT_TRUE(normals.point_colours.empty());
}

class PolygonFiles : public ::testing::Test {
  protected:
    PolygonFiles() { std::filesystem::create_directories(folder_); }
    ~PolygonFiles() override { std::filesystem::remove_all(folder_); }
    std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / ("tuft_mesh_" + std::to_string(::getpid()));
};

TEST_F(PolygonFiles, WrittenPlyReadsBackTheSame) {
    PolygonSoup soup = make_torus(12, 7);
    for (Vec3& p : soup.points) p = glm::round(p * 1024.0) / 1024.0;  // the file holds floats
    soup.points.emplace_back(1, 2, 3);                                // used by no face, kept all the same
    for (std::size_t i = 0; i < soup.points.size(); ++i)
        soup.point_colours.push_back({static_cast<std::uint8_t>(i), 2, 3, 200});
    set_uvs_to_position(soup);
    for (const bool agreeing : {true, false}) {
        if (!agreeing) soup.corner_uvs[5] += Vec2f(1, 0);  // a seam: stored per face
        const std::filesystem::path path = folder_ / "Grüße x.PLY";
        write_ply(path, soup);
        const PolygonSoup back = read_polygon_file(path);
        EXPECT_TRUE(back.points == soup.points);
        EXPECT_EQ(back.corners, soup.corners);
        EXPECT_EQ(back.polygon_start, soup.polygon_start);
        EXPECT_EQ(back.corner_uvs, soup.corner_uvs);
        EXPECT_EQ(back.point_colours, soup.point_colours);
        EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
    }
}

TEST_F(PolygonFiles, PlyKeepsPolygonsWithManyCorners) {
    PolygonSoup soup;
    std::vector<std::uint32_t> ring;
    for (std::uint32_t i = 0; i < 300; ++i) {
        ring.push_back(i);
        soup.points.push_back(Vec3(Vec3f(std::cos(i * 0.0209439510239), std::sin(i * 0.0209439510239), 0)));
    }
    add_polygon(soup, ring);
    write_ply(folder_ / "disk.ply", soup);
    EXPECT_EQ(read_polygon_file(folder_ / "disk.ply").corners, ring);
}

TEST_F(PolygonFiles, ExtensionChoosesTheReaderInAnyCase) {
    std::ofstream(folder_ / "a.ObJ") << kObjPoints + kObjQuads;
    EXPECT_EQ(read_polygon_file(folder_ / "a.ObJ").n_polygons(), 6u);
    EXPECT_TRUE(is_polygon_file("x/y.Off"));
    EXPECT_FALSE(is_polygon_file("x/y.glb"));
    EXPECT_THROW(read_polygon_file(folder_ / "a.txt"), Error);
    EXPECT_THROW(read_polygon_file(folder_ / "missing.obj"), Error);
    EXPECT_THROW(write_ply(folder_ / "none" / "a.ply", make_box()), Error);
}

TEST(ModelFiles, ShippedModelsHaveNoDefects) {
    for (const char* name : {"bowl", "plate", "vase", "sheet", "sphere", "cylinder", "torus", "thin_plate"}) {
        const Surface s = build_surface(read_polygon_file(source_folder() + "/models/" + name + ".ply"));
        EXPECT_THAT(texts(describe_defects(s.report)), ElementsAre()) << name;
        EXPECT_THAT(broken_promises(s), ElementsAre()) << name;
    }
}

}  // namespace
}  // namespace tuft::mesh
