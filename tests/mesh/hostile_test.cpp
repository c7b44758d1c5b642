#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "core/error.h"
#include "core/random.h"
#include "mesh/read/polygon_soup.h"
#include "mesh/repair/repair.h"
#include "mesh_checks.h"

// What no well-meaning program writes: every file ends in one clear line, none in a crash.
namespace tuft::mesh {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

using Reader = PolygonSoup (*)(const std::vector<char>&, const std::filesystem::path&);

std::string error_of(Reader read, const std::string& bytes, const char* path) {
    try {
        read(bytes_of(bytes), path);
    } catch (const Error& e) {
        return e.what();
    }
    return "no error";
}

TEST(HostileObj, SaysFileAndLine) {
    const auto error = [](const std::string& text) { return error_of(read_obj, text, "a.obj"); };
    const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    EXPECT_EQ(error(v + "f 1 2 4\n"), "a.obj:4: the face uses vertex 4, but the file has only 3");
    EXPECT_EQ(error(v + "f 1 2 3\nf 1 2 -4\n"), "a.obj:5: the face uses vertex -4, which does not exist");
    EXPECT_THAT(error(v + "f 0 1 2\n"), StartsWith("a.obj:4: the face uses vertex 0"));
    EXPECT_THAT(error(v + "f 1 2 99999999999999999999\n"), StartsWith("a.obj:4: "));
    EXPECT_THAT(error(v + "f 1 2 9223372036854775807\n"), StartsWith("a.obj:4: "));
    EXPECT_THAT(error(v + "f 1 2 -9223372036854775808\n"), StartsWith("a.obj:4: "));
    EXPECT_THAT(error(v + "f 1 two 3\n"), StartsWith("a.obj:4: 'two' is not a vertex number"));
    EXPECT_THAT(error(v + "f 1 2,5 3\n"), StartsWith("a.obj:4: '2,5' is not a face corner"));
    EXPECT_EQ(error("v 0 0\n"), "a.obj:1: a vertex needs three coordinates");
    EXPECT_THAT(error("v 0,5 0 0\n"), StartsWith("a.obj:1: '0,5' is not a number"));
    EXPECT_THAT(error("v 0 0 \x01\x02\n"), StartsWith("a.obj:1: '\?\?' is not a number"));
    EXPECT_EQ(error(v), "a.obj: has 3 vertices but no faces; a surface is needed");
    EXPECT_EQ(error("# nothing\n"), "a.obj: has no vertices and no faces");
    EXPECT_EQ(error("v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
              "a.obj: every face uses a vertex that is no finite number or lies beyond 1e10");
    EXPECT_EQ(error(v + "f 1 2\n"), "a.obj: has 3 vertices but no faces; a surface is needed");
}

TEST(HostilePly, SaysFileAndLineOrRow) {
    const auto error = [](const std::string& text) { return error_of(read_ply, text, "a.ply"); };
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\n";
    const std::string body = "0 0 0\n1 0 0\n0 1 0\n";
    EXPECT_THAT(error("solid"), HasSubstr("a.ply:1: is not a PLY file"));
    EXPECT_THAT(error("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                      "property float z\nproperty uchar red\nproperty uchar green\n"
                      "property uchar blue\nelement vertex 2\nproperty float x\nproperty float y\n"
                      "property float z\nend_header\n0 0 0 1 2 3\n1 0 0\nnan 1 0\n"),
                HasSubstr("a.ply:10: the element 'vertex' is there twice"));
    EXPECT_THAT(error(""), HasSubstr("is not a PLY file"));
    EXPECT_THAT(error(head + body + "3 0 1 2\n"), HasSubstr("is not a PLY keyword"));
    EXPECT_THAT(error(head), StartsWith("a.ply:9: the head has no end_header line"));
    EXPECT_THAT(error("ply\nproperty float x\n"), StartsWith("a.ply:2: a property stands before any element"));
    EXPECT_THAT(error("ply\nelement vertex -5\n"), StartsWith("a.ply:2: an element cannot have -5 rows"));
    EXPECT_THAT(error("ply\nelement vertex nan\n"), StartsWith("a.ply:2: a whole number"));
    EXPECT_THAT(error("ply\nformat ascii 1.0\nelement vertex 1\nproperty string x\n"), StartsWith("a.ply:4: 'string'"));
    EXPECT_THAT(error("ply\nend_header\n"), StartsWith("a.ply:2: the head does not say its format"));
    EXPECT_EQ(error(head + "end_header\n" + body + "3 0 1 3\n"),
              "a.ply:13: the face uses vertex 3, but the file has only 3 (counted from 0)");
    EXPECT_THAT(error(head + "end_header\n" + body + "3 0 1 -1\n"), StartsWith("a.ply:13: the face uses vertex -1"));
    EXPECT_THAT(error(head + "end_header\n" + body + "3 0 1 nan\n"), StartsWith("a.ply:13: the face uses vertex"));
    EXPECT_THAT(error(head + "end_header\n" + body + "3 0 1 0.5\n"), StartsWith("a.ply:13: the face uses vertex"));
    EXPECT_THAT(error(head + "end_header\n" + body + "-3 0 1 2\n"), HasSubstr("impossible length"));
    EXPECT_THAT(error(head + "end_header\n" + body + "300 0 1 2\n"), HasSubstr("longer than the rest of the file"));
    EXPECT_THAT(error(head + "end_header\n" + body + "3 0 1\n"), HasSubstr("cut off"));
    EXPECT_THAT(error(head + "end_header\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n"),
                StartsWith("a.ply:11: the row of element 'vertex'"));
    EXPECT_THAT(error(head + "end_header\n0 0 0\n1 0 x\n0 1 0\n3 0 1 2\n"), StartsWith("a.ply:11: "));
    std::string lying = head;
    lying.replace(lying.find("vertex 3"), 8, "vertex 1000000000");
    EXPECT_THAT(error(lying + "end_header\n" + body), StartsWith("a.ply:3: element 'vertex' promises 1000000000 rows"));
    lying.replace(lying.find("ascii"), 5, "binary_little_endian");
    EXPECT_THAT(error(lying + "end_header\n" + body), HasSubstr("promises 1000000000 rows"));
    lying.replace(lying.find("1000000000"), 10, "99999999999999999999999");
    EXPECT_THAT(error(lying + "end_header\n" + body), StartsWith("a.ply:3: a whole number"));
    EXPECT_THAT(error("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n"),
                HasSubstr("the vertices have no x, y and z"));
    EXPECT_THAT(error("ply\nformat ascii 1.0\nelement empty 1000000000000\nend_header\n"),
                HasSubstr("has no vertices and no faces"));
}

TEST(HostilePly, EveryPrefixOfABinaryFileIsAnError) {
    PolygonSoup torus = make_torus(5, 4);
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("tuft_prefix_" + std::to_string(::getpid()) + ".ply");
    write_ply(path, torus);
    std::ifstream file(path, std::ios::binary);
    const std::string whole((std::istreambuf_iterator<char>(file)), {});
    std::filesystem::remove(path);
    for (std::size_t n = 0; n < whole.size(); ++n)
        EXPECT_THAT(error_of(read_ply, whole.substr(0, n), "a.ply"), StartsWith("a.ply:")) << n;
}

TEST(HostileStl, SaysWhatIsMissing) {
    const auto error = [](const std::string& text) { return error_of(read_stl, text, "a.stl"); };
    std::string binary(84 + 2 * 50, '\0');
    binary[80] = 2;
    binary.resize(84 + 60);
    EXPECT_EQ(error(binary),
              "a.stl: the head promises 2 triangles, but the file holds only 1; "
              "it is cut off or not an STL file");
    std::memset(binary.data() + 80, 0xff, 4);
    EXPECT_THAT(error(binary), HasSubstr("promises 4294967295 triangles"));
    EXPECT_THAT(error("short"), HasSubstr("too short"));
    EXPECT_THAT(error(std::string(84, '\0')), HasSubstr("no vertices and no faces"));
    EXPECT_THAT(error("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"),
                StartsWith("a.stl:6: the file ends inside a solid"));
    EXPECT_THAT(error("solid a\nvertex 0 0 0\n"), StartsWith("a.stl:2: a vertex stands outside of a loop"));
    EXPECT_THAT(error("solid a\nouter loop\nvertex 0 0 x\n"), StartsWith("a.stl:3: 'x' is not a number"));
    EXPECT_THAT(error("solid a\nouter loop\nvertex 0 0\n"), StartsWith("a.stl:3: the line ends where a coordinate"));
    EXPECT_THAT(error("solid a\nendloop\n"), StartsWith("a.stl:2: endloop without"));
    EXPECT_THAT(error("solid a\nhello\n"), StartsWith("a.stl:2: 'hello' is not an STL keyword"));
    EXPECT_THAT(error("solid a\nendsolid a\n"), HasSubstr("no vertices and no faces"));
}

TEST(HostileOff, SaysFileAndLine) {
    const auto error = [](const std::string& text) { return error_of(read_off, text, "a.off"); };
    EXPECT_THAT(error("OFF\n400000000 1 0\n0 0 0\n"), StartsWith("a.off:2: promises 400000000 vertices"));
    EXPECT_THAT(error("OFF\n3 -1 0\n0 0 0\n"), StartsWith("a.off:2: promises"));
    EXPECT_THAT(error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"), StartsWith("a.off:6: the face uses vertex 3"));
    EXPECT_THAT(error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n900 0 1 2\n"), StartsWith("a.off:6: a face cannot have 900"));
    EXPECT_THAT(error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n"), StartsWith("a.off:6: the line ends"));
    EXPECT_THAT(error("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), HasSubstr("ends among its faces"));
    EXPECT_THAT(error("OFF\n3 0 0\n0 0 0\n1 0 0\n"), HasSubstr("cut off"));
    EXPECT_THAT(error("OFF\n"), HasSubstr("ends before its counts"));
    EXPECT_THAT(error("4OFF\n1 1 1\n"), HasSubstr("is not a three-dimensional OFF head"));
    EXPECT_THAT(error("OFF BINARY\n\0\0\0\1"), HasSubstr("cut off"));
    EXPECT_THAT(error("# only a comment\n"), HasSubstr("holds no data"));
}

TEST(HostilePolygon, IntricateOnesEndInTime) {
    // A comb of 60,000 teeth: ear clipping alone would take some 4e9 steps.
    std::string text;
    const int n = 120000;
    for (int i = 0; i < n; ++i) text += "v " + std::to_string(i) + " " + std::to_string(i % 2 ? 1000 : 1) + " 0\n";
    text += "v " + std::to_string(n) + " 0 0\nv 0 0 0\nf";
    for (int i = 1; i <= n + 2; ++i) text += " " + std::to_string(i);
    const Surface s = build_surface(read_obj(bytes_of(text), "comb.obj"));
    EXPECT_GT(s.mesh.n_triangles(), 0u);
}

/// Small sound files of every kind, to be damaged.
std::vector<std::pair<Reader, std::string>> samples() {
    std::vector<std::pair<Reader, std::string>> out;
    std::string obj =
        "o a\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nv 0 0 1 1 1 1\nvt 0 0\nvt 1 0\nvt 0 1\n"
        "g x\nf 1/1 3/3 2/2\nf 1 2 4\nusemtl m\nf 2 3 4\nf -4 -1 -2\nf 1 2 3 4\n";
    out.emplace_back(read_obj, obj);
    out.emplace_back(read_ply,
                     "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
                     "float z\n"
                     "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 4\n"
                     "property list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n"
                     "0 0 0 1 2 3\n1 0 0 4 5 6\n0 1 0 7 8 9\n0 0 1 1 1 1\n3 0 2 1 6 0 0 0 1 1 0\n3 0 1 3 0\n"
                     "3 1 2 3 0\n3 0 3 2 0\n");
    PolygonSoup tetra;
    tetra.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const auto& f : {std::vector<std::uint32_t>{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}) add_polygon(tetra, f);
    set_uvs_to_position(tetra);
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("tuft_fuzz_" + std::to_string(::getpid()) + ".ply");
    write_ply(path, tetra);
    std::ifstream file(path, std::ios::binary);
    out.emplace_back(read_ply, std::string((std::istreambuf_iterator<char>(file)), {}));
    std::filesystem::remove(path);
    out.emplace_back(read_ply,
                     "ply\nformat ascii 1.0\nelement vertex 5\nproperty double x\nproperty double y\n"
                     "property double z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"
                     "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 1\n9 0 1 2 3 -1 2 3 4 4\n");
    std::string stl(80, ' ');
    stl += std::string("\4\0\0\0", 4);
    std::string text_stl = "solid a\n";
    for (std::size_t t = 0; t < 4; ++t) {
        stl.append(12, '\0');
        text_stl += "facet normal 0 0 0\nouter loop\n";
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 p = tetra.points[tetra.corners[3 * t + k]];
            for (int axis = 0; axis < 3; ++axis) {
                const auto value = static_cast<float>(p[axis]);
                stl.append(reinterpret_cast<const char*>(&value), 4);
            }
            text_stl += "vertex " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
        }
        stl.append(2, '\0');
        text_stl += "endloop\nendfacet\n";
    }
    out.emplace_back(read_stl, stl);
    out.emplace_back(read_stl, text_stl + "endsolid a\n");
    out.emplace_back(read_off,
                     "STCOFF\n4 4 6\n0 0 0 9 9 9 9 0 0\n1 0 0 9 9 9 9 0 0\n0 1 0 9 9 9 9 0 0\n"
                     "0 0 1 9 9 9 9 0 0\n3 0 2 1\n3 0 1 3\n3 1 2 3 1 0 0\n3 0 3 2\n");
    std::string off = "OFF BINARY\n";
    const auto put = [&](std::uint32_t bits) {
        for (int shift = 24; shift >= 0; shift -= 8) off.push_back(static_cast<char>(bits >> shift & 255));
    };
    for (const std::uint32_t n : {4u, 4u, 6u}) put(n);
    for (const Vec3& p : tetra.points)
        for (int k = 0; k < 3; ++k) put(p[k] != 0 ? 0x3f800000u : 0u);
    for (std::size_t t = 0; t < 4; ++t) {
        put(3);
        for (std::size_t k = 0; k < 3; ++k) put(tetra.corners[3 * t + k]);
        put(0);
    }
    out.emplace_back(read_off, off);
    return out;
}

std::string damaged(std::string bytes, Random& random) {
    const auto below = [&](std::size_t n) {
        return static_cast<std::size_t>(random.uniform() * static_cast<double>(n));
    };
    const std::size_t edits = 1 + below(4);
    constexpr const char* kTokens[] = {"nan",          "inf",  "-1", "1e39", "1e-46", "4294967295",
                                       "2147483648",   " ",    "\n", "\r",   "0",     "\\\n",
                                       "end_header\n", "list", "#",  "/",    "-"};
    for (std::size_t e = 0; e < edits && !bytes.empty(); ++e) {
        const std::size_t at = below(bytes.size());
        switch (below(6)) {
            case 0:
                bytes[at] = static_cast<char>(random.bits() & 255);
                break;
            case 1:
                bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
                break;
            case 2:
                bytes.erase(at, 1 + below(8));
                break;
            case 3:
                bytes.insert(at, bytes.substr(below(bytes.size()), 1 + below(30)));
                break;
            case 4:
                bytes.insert(at, kTokens[below(std::size(kTokens))]);
                break;
            default:
                bytes.resize(bytes.size() - below(bytes.size() / 4 + 1));
        }
    }
    return bytes;
}

TEST(Fuzz, DamagedFilesGiveAnErrorOrASoundSurface) {
    const auto files = samples();
    std::size_t read = 0, refused = 0;
    for (std::size_t f = 0; f < files.size(); ++f) {
        EXPECT_EQ(build_surface(files[f].first(bytes_of(files[f].second), "whole")).report.closed, f != 3) << f;
        for (std::uint64_t seed = 0; seed < 2000; ++seed) {
            Random random(hash_bits(f, seed));
            const std::string bytes = damaged(files[f].second, random);
            try {
                const Surface s = build_surface(files[f].first(bytes_of(bytes), "damaged"));
                EXPECT_THAT(broken_promises(s), ElementsAre()) << "file " << f << " seed " << seed;
                ++read;
            } catch (const Error& e) {
                EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
                ++refused;
            }
        }
    }
    // Neither outcome may be the only one: then the damage would test nothing.
    EXPECT_GT(read, 500u);
    EXPECT_GT(refused, 500u);
}

}  // namespace
}  // namespace tuft::mesh
