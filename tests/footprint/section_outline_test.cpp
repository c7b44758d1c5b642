#include "footprint/outline/section_outline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "brush/preset/rest_shape.h"
#include "core/system/allocations.h"
#include "footprint/outline/outline.h"

/// Contact patches of carried shapes.
namespace tuft::footprint {
namespace {

using std::numbers::pi;

double area_of(const Footprint& f) {
    double sum = 0;
    for (const std::uint8_t c : f.coverage) sum += c / 255.0 * f.cell * f.cell;
    return sum;
}

/// Adds a tube of n sides and its lids to the shape; radius by height, z from 0 down to −length.
template <class F>
void add_tube(brush::Geometry& g, int n, int rows, double length, F radius, bool turned = false) {
    const auto first = static_cast<std::uint32_t>(g.points.size());
    for (int k = 0; k <= rows; ++k)
        for (int i = 0; i < n; ++i) {
            const double u = static_cast<double>(k) / rows, w = 2 * pi * i / n;
            g.points.emplace_back(1e3 * radius(u) * Vec3{std::cos(w), std::sin(w), 0} - Vec3{0, 0, 1e3 * length * u});
        }
    const auto at = [&](int k, int i) { return first + static_cast<std::uint32_t>(k * n + i % n); };
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        g.triangles.push_back(turned ? std::array{a, c, b} : std::array{a, b, c});
    };
    for (int k = 0; k < rows; ++k)
        for (int i = 0; i < n; ++i) {
            add(at(k, i), at(k + 1, i), at(k + 1, i + 1));
            add(at(k, i), at(k + 1, i + 1), at(k, i + 1));
        }
    const auto top = static_cast<std::uint32_t>(g.points.size()), tip = top + 1;
    g.points.emplace_back(0, 0, 0);
    g.points.emplace_back(0, 0, -1e3 * length);
    for (int i = 0; i < n; ++i) {
        add(at(0, i), at(0, i + 1), top);
        add(at(rows, i + 1), at(rows, i), tip);
    }
}

/// A shape as it is, over the plane z = 0, its mouth `up` over it.
struct Standing {
    brush::CarriedShape carried;
    brush::TuftShape shape;

    Standing(const brush::Geometry& g, double up) {
        carried.triangles = g.triangles;
        carried.lines = g.lines;
        for (const Vec3& p : g.points) {
            carried.rest.push_back(1e-3 * p);
            shape.position.push_back(1e-3 * p + Vec3{0, 0, up});
            shape.height.push_back(shape.position.back().z);
            shape.normal.emplace_back(0, 0, 1);
        }
        carried.bundle.assign(g.points.size(), 0);
        carried.along.assign(g.points.size(), 1);
        carried.area.assign(g.points.size(), 1);
    }
};

// A cone of 96 sides: its section is a 96-gon, (n/2) sin(2π/n) r².
TEST(SectionOutline, OfAConeIsItsCircle) {
    brush::Geometry g;
    add_tube(g, 96, 7, 0.03, [](double u) { return 6e-3 * (1 - 0.9 * u); });
    const Standing stand(g, 0.02);
    const Recycled<Polygon> polygons = section_polygons(stand.carried, stand.shape, Frame{}, {.film = 0});
    ASSERT_EQ(polygons.size(), 1u);
    const double r = 6e-3 * (1 - 0.9 * 2 / 3.0), area = 48 * std::sin(pi / 48) * r * r;
    // Coverage is in steps of 1/255 along the border.
    EXPECT_NEAR(area_of(rasterise_polygons(polygons, Frame{}, 0, 5e-5)) / area, 1, 1e-3);
}

// Even-odd: a pipe leaves a ring, also when its inner wall is turned like its outer one; two stalks leave two discs.
TEST(SectionOutline, LeavesHolesAndSeveralParts) {
    const auto outer = [](double) { return 6e-3; };
    const auto inner = [](double) { return 3e-3; };
    const double ring = 48 * std::sin(pi / 48) * 27e-6;
    for (const bool turned : {false, true}) {
        brush::Geometry g;
        add_tube(g, 96, 3, 0.03, outer);
        add_tube(g, 96, 3, 0.03, inner, turned);
        const Standing stand(g, 0.02);
        const Recycled<Polygon> polygons = section_polygons(stand.carried, stand.shape, Frame{});
        EXPECT_EQ(polygons.size(), 2u);
        EXPECT_NEAR(area_of(rasterise_polygons(polygons, Frame{}, 0, 5e-5)) / ring, 1, 2e-3);
    }
    brush::Geometry g;
    add_tube(g, 96, 3, 0.03, inner);
    const std::size_t first = g.points.size();
    add_tube(g, 96, 3, 0.03, inner);
    for (std::size_t i = first; i < g.points.size(); ++i) g.points[i].x += 10;
    const Standing stand(g, 0.02);
    const Recycled<Polygon> polygons = section_polygons(stand.carried, stand.shape, Frame{});
    EXPECT_EQ(polygons.size(), 2u);
    EXPECT_NEAR(area_of(rasterise_polygons(polygons, Frame{}, 0, 5e-5)) / (96 * std::sin(pi / 48) * 9e-6), 1, 2e-3);
}

TEST(SectionOutline, OfHairIsAStadiumForEachPartBelow) {
    brush::Geometry g;
    g.points = {{0, 0, 0}, {0, 0, -20}, {10, 0, -20}};
    g.lines = {{0, 1, 2}};
    const Standing stand(g, 0.02);
    const double half = 0.05e-3 + 0.1e-3;
    const Recycled<Polygon> polygons = hair_polygons(stand.carried, stand.shape, Frame{}, 1e-4, {}, {.film = 1e-4});
    ASSERT_EQ(polygons.size(), 2u);  // the end of the upright part and the part that lies
    // Half discs of 12 sides at both ends.
    const double ends = 6 * std::sin(pi / 6) * half * half;
    EXPECT_NEAR(area_of(rasterise_polygons(polygons, Frame{}, 0, 2e-5)) / (20e-3 * half + ends), 1, 5e-3);
    const Recycled<double> dry{0.0};
    EXPECT_TRUE(hair_polygons(stand.carried, stand.shape, Frame{}, 1e-4, {.wet = dry}).empty());
}

/// A round tuft pressed upright while its hand moves a little: areas of its outline, and of a mesh of its own form.
struct Areas {
    double tuft = 0, mesh = 0;
};

Areas pressed(const std::string& name, double depth) {
    brush::Preset p = brush::load_preset(name);
    brush::Geometry g;
    add_tube(g, 48, 60, p.length, [&](double u) { return brush::rest_radius(p, u); });
    p.geometry = std::make_shared<brush::Geometry>(g);
    brush::Tuft tuft = brush::make_tuft(p);
    const brush::ContactPlane sheet;
    brush::TuftState state;
    for (int i = 0; i <= 60; ++i) {
        const double f = i / 60.0;
        const brush::Pose pose{{1e-3 * f, 0, p.length - f * depth * p.length}, {1, 0, 0, 0}, 0.01 * i};
        state = brush::step(tuft, pose, {&sheet, 1}, 0.01);
    }
    const double film = 1e-4;
    const Recycled<Outline> outlines = outlines_of(state, Frame{}, {}, {.film = film});
    return {area_of(rasterise(outlines, Frame{}, 0, 5e-5)),
            area_of(rasterise_polygons(section_polygons(*tuft.carried, state.shape, Frame{}, {.film = film}), Frame{},
                                       0, 5e-5))};
}

// A mesh of the tuft's own form covers what the tuft covers. The outline is the envelope of shadows of what lies below,
// widened by the film all round; the mesh is cut by the surface, where its flattened underside is steep.
TEST(SectionOutline, OfAMeshOfItsOwnFormCoversWhatARoundTuftCovers) {
    for (const char* name : {"mixed-medium", "wolf-medium", "wash-12"})
        for (const double depth : {0.1, 0.2, 0.35}) {
            const Areas a = pressed(name, depth);
            EXPECT_NEAR(a.mesh / a.tuft, 1, 0.15) << name << " " << depth;
        }
}

// Foam: a pressed sponge covers more, and never more than its face; its pores are of its material, so a turned sponge
// prints the turned picture.
TEST(SectionOutline, OfASpongeGrowsWithPressureAndTurnsWithIt) {
    const brush::Preset p = brush::load_preset("sponge-30");
    brush::Tuft tuft = brush::make_tuft(p);
    const brush::ContactPlane sheet;
    const auto dab = [&](double depth, double turn) {
        const brush::Pose pose{{0, 0, p.length - depth}, glm::angleAxis(turn, Vec3{0, 0, 1}), 0};
        const brush::TuftState state = brush::step(tuft, pose, {&sheet, 1}, 0.01);
        Footprint f = rasterise_polygons(section_polygons(*tuft.carried, state.shape, Frame{}), Frame{}, 0, 1e-4);
        open_pores(*tuft.carried, state.shape, {}, f);
        brush::reshape(tuft);
        return f;
    };
    double before = 0;
    for (const double depth : {0.8e-3, 1.5e-3, 3e-3, 8e-3}) {
        const double area = area_of(dab(depth, 0));
        EXPECT_GT(area, 1.1 * before) << depth;
        EXPECT_LT(area, pi * p.radius * p.radius) << depth;
        before = area;
    }
    // Foam does not bulge: pressed to half its height its pores are half shut. They leave 55 % of the skin open at
    // rest, of which 1 − 0.5/0.958 is left, less 30 µm of ink at each rim: 0.78 of a face without rim and dome.
    const double deep = area_of(dab(0.5 * p.length, 0)) / (pi * p.radius * p.radius);
    EXPECT_GT(deep, 0.5);
    EXPECT_LT(deep, 0.8);
    const Footprint a = dab(3e-3, 0), b = dab(3e-3, 0.5 * pi), again = dab(3e-3, 0);
    EXPECT_EQ(a.coverage, again.coverage);
    const auto at = [](const Footprint& f, const Vec2& q) {
        const Vec2 c = (q - f.lo) / f.cell;
        const int i = static_cast<int>(std::floor(c.x)), j = static_cast<int>(std::floor(c.y));
        return i < 0 || j < 0 || i >= f.width || j >= f.height ? 0 : int{f.coverage[std::size_t(j) * f.width + i]};
    };
    // Cell by cell where the other lies; edges fall into cells otherwise by rounding.
    double same = 0, different = 0, straight = 0;
    for (int j = -150; j < 150; ++j)
        for (int i = -150; i < 150; ++i) {
            const Vec2 q{(i + 0.5) * a.cell, (j + 0.5) * a.cell}, turned{-q.y, q.x};
            same += at(a, q) > 0 || at(b, turned) > 0;
            different += std::abs(at(a, q) - at(b, turned)) > 8;
            straight += std::abs(at(a, q) - at(b, q)) > 8;
        }
    EXPECT_LT(different, 0.01 * same);
    EXPECT_GT(straight, 0.2 * same);
}

// The section of a sponge has some hundred crossings; a warm one finds the memory of the one before.
TEST(SectionOutline, OfAWarmSpongeAllocatesNothing) {
    brush::Tuft tuft = brush::make_tuft(brush::load_preset("sponge-30"));
    const brush::ContactPlane sheet;
    const brush::Pose pose{{0, 0, tuft.preset.length - 3e-3}, {1, 0, 0, 0}, 0};
    const brush::TuftState state = brush::step(tuft, pose, {&sheet, 1}, 0.01);
    const auto allocations = [&] {
        const std::uint64_t before = allocations_of_this_thread();
        Footprint f = rasterise_polygons(section_polygons(*tuft.carried, state.shape, Frame{}), Frame{}, 0, 1e-4);
        open_pores(*tuft.carried, state.shape, {}, f);
        EXPECT_GT(f.width, 100);
        return allocations_of_this_thread() - before;
    };
    allocations();
    EXPECT_EQ(allocations(), 0u);
}

}  // namespace
}  // namespace tuft::footprint
