#include "brush/preset/geometry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "brush/tuft/tuft.h"
#include "core/error.h"

/// Tufts with a geometry of their own.
namespace tuft::brush {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kTetrahedron = "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 -20\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n";

std::string fault_of(const std::string& text) {
    try {
        parse_geometry(text, "leaf.obj");
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

/// A folder of its own for brushes and geometries.
struct Folder {
    fs::path path = fs::temp_directory_path() / ("tuft_geometry_" + std::to_string(::getpid()));
    Folder() { fs::create_directories(path / "in"); }
    ~Folder() { fs::remove_all(path); }
    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(path / name) << text;
        return (path / name).string();
    }
    std::string fault(const std::string& brush) const {
        try {
            load_preset(write("in/test.toml", brush));
        } catch (const Error& e) {
            return e.what();
        }
        return "";
    }
};

TEST(Geometry, ReadsFacesAndLines) {
    const Geometry mesh = parse_geometry(kTetrahedron, "leaf.obj");
    EXPECT_EQ(mesh.points.size(), 4u);
    EXPECT_EQ(mesh.triangles.size(), 4u);
    EXPECT_EQ(mesh.bounds().lo.z, -20);
    const Geometry hair =
        parse_geometry("# hair\nv 0 0 0\nv 0 0 -10\nv 1 0 -20\nl 1 2 3\nl -3 -1\nvn 0 0 1\n", "hair.obj");
    ASSERT_EQ(hair.lines.size(), 2u);
    EXPECT_EQ(hair.lines[0].size(), 3u);
    EXPECT_EQ(hair.lines[1], (std::vector<std::uint32_t>{0, 2}));
}

TEST(Geometry, OfAHostileFileIsRefusedInOneLine) {
    const std::string points = "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 -20\n";
    EXPECT_THAT(fault_of("v 0 0 nan\n"), HasSubstr("leaf.obj:1"));
    EXPECT_THAT(fault_of("v 0 0 1e300\n"), HasSubstr("within 300 mm"));
    EXPECT_THAT(fault_of("v 0 0\n"), HasSubstr("leaf.obj:1"));
    EXPECT_THAT(fault_of(points + "f 1 2 9\n"), HasSubstr("point 9 does not exist"));
    EXPECT_THAT(fault_of(points + "f 1 2 99999999999999999999\n"), HasSubstr("not a point number"));
    EXPECT_THAT(fault_of(points + "f 1 2 0\n"), HasSubstr("point 0"));
    EXPECT_THAT(fault_of(points + "f 1 2 -9\n"), HasSubstr("point -9"));
    EXPECT_THAT(fault_of(points + "f 1 2\n"), HasSubstr("three points"));
    EXPECT_THAT(fault_of(points + "f 1 2 3\n"), HasSubstr("closed"));
    EXPECT_THAT(fault_of(points + "f 1 2 3\nf 1 2 4\nf 2 4 3\nf 3 4 1\n"), HasSubstr("turned one way"));
    EXPECT_THAT(fault_of(points + "f 3 2 1\nf 2 4 1\nf 3 4 2\nf 1 4 3\n"), HasSubstr("inside out"));
    EXPECT_THAT(fault_of(points + "l 1\n"), HasSubstr("two points"));
    EXPECT_THAT(fault_of(std::string(kTetrahedron) + "l 1 4\n"), HasSubstr("either"));
    EXPECT_THAT(fault_of(points), HasSubstr("either"));
    EXPECT_THAT(fault_of(""), HasSubstr("either"));
    EXPECT_THAT(fault_of(std::string(kMostGeometryBytes + 1, ' ')), HasSubstr("bytes"));
    std::string many;
    for (std::size_t i = 0; i <= kMostPoints; ++i) many += "v 0 0 0\n";
    EXPECT_THAT(fault_of(many), HasSubstr("at most 20000 points"));
    many = points;
    for (std::size_t i = 0; i < 60; ++i) many += "f" + std::string(1000, ' ') + "1 2 3\n";
    EXPECT_THAT(fault_of(many), HasSubstr("closed"));
    // One face of very many corners.
    many = points + "f";
    for (std::size_t i = 0; i < kMostTriangles + 2; ++i) many += " 1 2 3";
    EXPECT_THAT(fault_of(many), HasSubstr("at most 40000 triangles"));
    for (const std::string& text : {std::string("v 0 0 nan"), points + "f 1 2 9", many})
        EXPECT_EQ(fault_of(text).find('\n'), std::string::npos);
}

TEST(Geometry, LiesInTheFolderOfItsBrush) {
    const Folder folder;
    folder.write("in/leaf.obj", kTetrahedron);
    folder.write("out.obj", kTetrahedron);
    fs::create_symlink(folder.path / "out.obj", folder.path / "in" / "link.obj");
    const std::string shape = "\n[shape]\nlength_mm = 20\nradius_mm = 2\n";
    const auto brush = [&](const std::string& name) { return "geometry = \"" + name + "\"" + shape; };
    EXPECT_EQ(folder.fault(brush("leaf.obj")), "");
    for (const std::string& name :
         {std::string("../out.obj"), std::string("link.obj"), (folder.path / "out.obj").string(),
          std::string("/etc/passwd"), std::string("in/../../out.obj")})
        EXPECT_THAT(folder.fault(brush(name)), HasSubstr("must lie in the folder")) << name;
    EXPECT_THAT(folder.fault(brush("none.obj")), HasSubstr("none.obj"));
    EXPECT_THAT(folder.fault(brush("leaf.obj") + "[ferrule]\nspines = 3\nwidth_mm = 5\n"), HasSubstr("one or two"));
    EXPECT_THAT(folder.fault("geometry = \"leaf.obj\"\n[shape]\nlength_mm = 60\nradius_mm = 2\n"),
                HasSubstr("must fill the hair"));
    EXPECT_THAT(folder.fault("geometry = 3" + shape), HasSubstr("text in quotes"));
    // A project's brush reads no file.
    EXPECT_THROW(parse_preset(brush("leaf.obj"), "stored"), Error);
}

TEST(Geometry, IsHeldInTheTextOfItsBrushToTheBit) {
    const Folder folder;
    folder.write("in/leaf.obj",
                 "v 0.1234567891234 0 0\nv 4 0 0\nv 0 4.1 0\nv 0 0 -20\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n");
    const Preset p =
        load_preset(folder.write("in/test.toml", "geometry = \"leaf.obj\"\n[shape]\nlength_mm = 20\nradius_mm = 2\n"));
    ASSERT_TRUE(p.geometry);
    const Preset q = parse_preset(preset_toml(p), "stored");
    ASSERT_TRUE(q.geometry);
    EXPECT_EQ(q.geometry->points, p.geometry->points);
    EXPECT_EQ(q.geometry->triangles, p.geometry->triangles);
    EXPECT_EQ(preset_toml(q), preset_toml(p));
    const Preset twice = scaled(p, 2);
    EXPECT_EQ(twice.geometry->points[3], (Vec3{0, 0, -40}));
}

/// A ring of n points at each of `rows` heights round the axis of a tuft, as OBJ; radius(u) in metres.
template <class F>
Geometry tube(int n, int rows, double length, F radius, double mirror = 1) {
    Geometry g;
    for (int k = 0; k <= rows; ++k)
        for (int i = 0; i < n; ++i) {
            const double u = static_cast<double>(k) / rows, w = 2 * std::numbers::pi * i / n, r = 1e3 * radius(u);
            g.points.emplace_back(1.3 * r * std::cos(w) + 0.2 * r, mirror * r * std::sin(w), -1e3 * length * u);
        }
    const auto at = [&](int k, int i) { return static_cast<std::uint32_t>(k * n + i % n); };
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (mirror > 0)
            g.triangles.push_back({a, b, c});
        else
            g.triangles.push_back({a, c, b});
    };
    for (int k = 0; k < rows; ++k)
        for (int i = 0; i < n; ++i) {
            add(at(k, i), at(k + 1, i), at(k + 1, i + 1));
            add(at(k, i), at(k + 1, i + 1), at(k, i + 1));
        }
    g.points.emplace_back(0, 0, 0);
    g.points.emplace_back(0, 0, -1e3 * length);
    const auto top = static_cast<std::uint32_t>(g.points.size() - 2), tip = top + 1;
    for (int i = 0; i < n; ++i) {
        add(at(0, i), at(0, i + 1), top);
        add(at(rows, i + 1), at(rows, i), tip);
    }
    return g;
}

// The mirror image of hand and brush bends to the mirror image: rounding of the solver's sums.
TEST(Geometry, OfAMirroredBrushBendsToItsMirrorImage) {
    for (const int spines : {1, 2}) {
        Preset p = load_preset(spines == 1 ? "mixed-medium" : "flat-12");
        p.spines = spines;
        const auto radius = [&](double u) { return 0.9 * p.radius * (1 - 0.6 * u); };
        Tuft tufts[2];
        for (int side = 0; side < 2; ++side) {
            Preset own = p;
            own.geometry = std::make_shared<Geometry>(tube(16, 12, p.length, radius, side ? -1 : 1));
            tufts[side] = make_tuft(own);
        }
        const ContactPlane sheet;
        for (int i = 0; i <= 60; ++i) {
            TuftState states[2];
            for (int side = 0; side < 2; ++side) {
                const double s = side ? -1 : 1, f = i / 60.0;
                const Pose pose{{0.01 * f, s * 4e-3 * f * f, p.length * (1.01 - 0.3 * f)},
                                glm::angleAxis(0.2 * f, Vec3{0, 1, 0}) * glm::angleAxis(s * 0.1, Vec3{1, 0, 0}),
                                0.01 * i};
                states[side] = step(tufts[side], pose, {&sheet, 1}, 0.01);
            }
            for (std::size_t v = 0; v < states[0].shape.position.size(); ++v) {
                const Vec3 &a = states[0].shape.position[v], &b = states[1].shape.position[v];
                ASSERT_NEAR(glm::length(a - Vec3{b.x, -b.y, b.z}), 0, 1e-6 * p.length) << i << " " << v;
            }
        }
    }
}

// In air it is the geometry itself, moved with the ferrule.
TEST(Geometry, InAirIsThatOfItsFile) {
    Preset p = load_preset("mixed-medium");
    p.geometry = std::make_shared<Geometry>(tube(8, 6, p.length, [](double) { return 2e-3; }));
    Tuft tuft = make_tuft(p);
    const Pose pose{{0.1, 0.2, 0.3}, glm::angleAxis(0.7, glm::normalize(Vec3{1, 2, 3})), 0};
    const TuftState state = step(tuft, pose, {}, 0);
    ASSERT_EQ(state.shape.position.size(), p.geometry->points.size());
    EXPECT_TRUE(state.shape.height.empty());
    for (std::size_t v = 0; v < state.shape.position.size(); ++v) {
        const Vec3 at = pose.position + pose.rotation * (1e-3 * p.geometry->points[v]);
        EXPECT_NEAR(glm::length(state.shape.position[v] - at), 0, 1e-9);  // the solver's tolerance
    }
}

}  // namespace
}  // namespace tuft::brush
