#include "footprint/outline/outline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"

namespace tuft::footprint {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kTexel = 1e-4;
const Frame kFlat;  // the plane z = 0

/// Straight tuft along `axis` (root to tip) with its tip at `tip`; radius(s) at distance s from
/// the tip, bending plane upright, n sections unevenly spaced as the spine's are.
template <class Radius>
brush::TuftState straight(const Vec3& tip, const Vec3& axis, double length, int n, Radius radius, double flatten = 1) {
    brush::TuftState tuft;
    tuft.branches.emplace_back();
    const Vec3 side = std::abs(axis.z) < 0.999 ? glm::normalize(glm::cross(Vec3{0, 0, 1}, axis)) : Vec3{0, 1, 0};
    for (int i = 0; i < n; ++i) {
        const double f = double(i) / (n - 1), s = length * (0.5 * f + 0.5 * f * f);
        brush::Section section;
        section.centre = tip - s * axis;
        section.tangent = axis;
        section.e = side;
        section.m = glm::cross(side, axis);
        section.a = flatten * radius(s);
        section.b = radius(s) / flatten;
        tuft.branches[0].sections.push_back(section);
    }
    return tuft;
}

double area_of(const Recycled<Vec2>& polygon) {
    double sum = 0;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec2 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
        sum += 0.5 * (p.x * q.y - p.y * q.x);
    }
    return sum;
}

double coverage_area(const Footprint& f) {
    double sum = 0;
    for (const std::uint8_t c : f.coverage) sum += c / 255.0;
    return sum * f.cell * f.cell;
}

OutlineOptions dry() {
    return {.film = 0};
}

TEST(Outline, OfAnEllipsoidIsTheEllipseThePlaneCuts) {
    // Half axes c along the plane, r across: at height z the cut has √(1 − z²/r²) of both.
    const double c = 0.012, r = 0.004;
    for (const double z : {0.0, 0.002, 0.0035}) {
        const auto tuft = straight({c, 0, z}, {1, 0, 0}, 2 * c, 25, [&](double s) {
            const double x = (s - c) / c;
            return r * std::sqrt(std::max(0.0, 1 - x * x));
        });
        const auto outlines = outlines_of(tuft, kFlat, {}, dry());
        ASSERT_EQ(outlines.size(), 1u);
        const double k = std::sqrt(1 - z * z / (r * r));
        // 25 sections of an ellipsoid, cubics between them (poor where r falls like a root).
        EXPECT_NEAR(area_of(curve_points(outlines[0])) / (kPi * c * r * k * k), 1, 0.02) << z;
        EXPECT_NEAR(outlines[0].tip.x, c * k, 0.02 * c);
        EXPECT_NEAR(outlines[0].tail.x, -c * k, 0.02 * c);
        const Footprint f = rasterise(outlines, kFlat, 0, kTexel);
        EXPECT_NEAR(coverage_area(f) / area_of(curve_points(outlines[0])), 1, 1e-3);
        EXPECT_GE(f.radius, c * k);
    }
}

TEST(Outline, OfALyingConeHasTheHyperbolaOfItsCut) {
    // Axis at height h over the plane, radius g s at distance s from the tip: half-width
    // √(g² s² − h²) from s = h/g on; the root end at s = L is closed straight.
    const double L = 0.03, g = 0.15, h = 0.001;
    const auto tuft = straight({0.03, 0, h}, {1, 0, 0}, L, 17, [&](double s) { return g * s; });
    const auto outlines = outlines_of(tuft, kFlat, {}, dry());
    ASSERT_EQ(outlines.size(), 1u);
    EXPECT_NEAR(outlines[0].tip.x, 0.03 - h / g, 1e-6);
    double area = 0;
    const int n = 100000;
    for (int i = 0; i < n; ++i) {
        const double s = h / g + (L - h / g) * (i + 0.5) / n;
        area += 2 * std::sqrt(g * g * s * s - h * h) * (L - h / g) / n;
    }
    // A spline through 20 points a side rounds the two corners at the root.
    EXPECT_NEAR(area_of(curve_points(outlines[0])) / area, 1, 0.02);
    for (const Vec2& p : outlines[0].left) {
        const double s = 0.03 - p.x;
        if (s > 0.9 * L) continue;
        EXPECT_NEAR(p.y, std::sqrt(std::max(0.0, g * g * s * s - h * h)),
                    2e-5);  // a fifth of a texel
    }
}

TEST(Outline, UsesTheChordOfAFlattenedSection) {
    // Chord half-width a √(1 − z²/b²), a = 2 r, b = r/2.
    const double r = 0.003, z = 0.001;
    const auto tuft = straight(
        {0.02, 0, z}, {1, 0, 0}, 0.04, 17, [&](double) { return r; }, 2);
    const auto outlines = outlines_of(tuft, kFlat, {}, dry());
    ASSERT_EQ(outlines.size(), 1u);
    const double half = 2 * r * std::sqrt(1 - z * z / (0.25 * r * r));
    double widest = 0;
    for (const Vec2& p : outlines[0].left) widest = std::max(widest, p.y);
    EXPECT_NEAR(widest, half, 1e-9);
}

TEST(Outline, IsSymmetricForASymmetricTuft) {
    const auto tuft = straight(
        {0.01, 0, -0.0005}, glm::normalize(Vec3{1, 0, -0.25}), 0.04, 17,
        [](double s) { return 0.18 * s * std::exp(-s / 0.03); }, 1.3);
    const auto outlines = outlines_of(tuft, kFlat);
    ASSERT_EQ(outlines.size(), 1u);
    const Outline& o = outlines[0];
    EXPECT_NEAR(o.tip.y, 0, 1e-12);
    EXPECT_NEAR(o.tail.y, 0, 1e-12);
    for (std::size_t k = 0; k < o.left.size(); ++k) {
        EXPECT_NEAR(o.left[k].x, o.right[k].x, 1e-12);
        EXPECT_NEAR(o.left[k].y, -o.right[k].y, 1e-12);
    }
}

TEST(Outline, MovesWithTheTuftAndTheFrame) {
    const Quat turn = glm::angleAxis(1.1, glm::normalize(Vec3{1, -2, 0.7}));
    const Vec3 shift{0.1, 0.05, -0.2};
    const auto tuft = straight({0.01, 0, 0}, glm::normalize(Vec3{1, 0.3, -0.2}), 0.04, 17,
                               [](double s) { return 0.15 * s * std::exp(-s / 0.03); });
    auto moved = tuft;
    for (brush::Section& s : moved.branches[0].sections) {
        s.centre = turn * s.centre + shift;
        s.tangent = turn * s.tangent;
        s.e = turn * s.e;
        s.m = turn * s.m;
    }
    const Frame frame{shift, turn * Vec3{1, 0, 0}, turn * Vec3{0, 1, 0}, turn * Vec3{0, 0, 1}};
    const auto a = outlines_of(tuft, kFlat), b = outlines_of(moved, frame);
    ASSERT_EQ(a.size(), 1u);
    ASSERT_EQ(b.size(), 1u);
    ASSERT_EQ(a[0].control.size(), b[0].control.size());
    for (std::size_t k = 0; k < a[0].control.size(); ++k)
        EXPECT_LT(glm::length(a[0].control[k] - b[0].control[k]), 1e-9);
}

TEST(Outline, ChangesContinuouslyWhileTheTuftIsPressed) {
    // One micrometre down at a time; sections come into reach one after the other.
    double area_before = -1;
    Vec2 tip_before{0}, tail_before{0};
    double largest = 0;
    for (int i = 0; i <= 3000; ++i) {
        const double depth = i * 1e-6;
        const auto tuft = straight({0, 0, -depth}, glm::normalize(Vec3{1, 0, -0.35}), 0.04, 17,
                                   [](double s) { return 0.2 * s * std::exp(-s / 0.02); });
        const auto outlines = outlines_of(tuft, kFlat);
        ASSERT_EQ(outlines.size(), 1u) << i;
        const double area = area_of(curve_points(outlines[0]));
        if (i > 0) {
            largest = std::max(largest, std::abs(area - area_before));
            EXPECT_GT(area, area_before - 1e-9);
            EXPECT_LT(glm::length(outlines[0].tip - tip_before), 2e-5);
            EXPECT_LT(glm::length(outlines[0].tail - tail_before), 6e-5);
        }
        area_before = area;
        tip_before = outlines[0].tip;
        tail_before = outlines[0].tail;
    }
    // No step larger than a texel's area, of a patch that grows to hundreds of them.
    EXPECT_LT(largest, kTexel * kTexel);
    EXPECT_GT(area_before, 300 * kTexel * kTexel);
}

TEST(Outline, OfATouchIsADot) {
    for (const double lean : {0.0, 0.3, 1.0}) {
        const auto tuft =
            straight({0, 0, 0}, glm::normalize(Vec3{lean, 0, -1}), 0.04, 17, [](double s) { return 0.15 * s; });
        const auto outlines = outlines_of(tuft, kFlat);
        ASSERT_EQ(outlines.size(), 1u) << lean;
        const auto curve = curve_points(outlines[0]);
        const double area = area_of(curve);
        EXPECT_GT(area, kPi * 0.09e-3 * 0.09e-3) << lean;  // the ball of 0.1 mm film at the tip
        EXPECT_LT(area, kPi * 0.4e-3 * 0.4e-3) << lean;
    }
    const auto above = straight({0, 0, 0.0002}, {0, 0, -1}, 0.04, 17, [](double s) { return 0.15 * s; });
    EXPECT_TRUE(outlines_of(above, kFlat).empty());
}

TEST(Outline, OfAPokeIsTheWholeDisc) {
    // Upright and pressed in without bending: the shadow is the section at the surface.
    const double g = 0.2, depth = 0.005;
    const auto tuft = straight({0, 0, -depth}, {0, 0, -1}, 0.04, 17, [&](double s) { return g * s; });
    const auto outlines = outlines_of(tuft, kFlat, {}, dry());
    ASSERT_EQ(outlines.size(), 1u);
    const double r = g * depth;
    EXPECT_NEAR(area_of(curve_points(outlines[0])) / (kPi * r * r), 1, 0.02);
}

TEST(Outline, SurvivesFewSectionsAndFlatOnes) {
    brush::TuftState tuft;
    EXPECT_TRUE(outlines_of(tuft, kFlat).empty());
    tuft.branches.resize(2);
    tuft.branches[0].sections.resize(1);
    tuft.branches[1].sections.resize(2);  // two equal sections of no size on the plane
    for (const Outline& o : outlines_of(tuft, kFlat)) {
        for (const Vec2& p : curve_points(o)) EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y));
    }
    for (const int n : {2, 3, 4}) {
        const auto few = straight({0.01, 0, 0.001}, {1, 0, 0}, 0.02, n, [](double s) { return 0.2 * s; });
        const auto outlines = outlines_of(few, kFlat);
        ASSERT_EQ(outlines.size(), 1u) << n;
        EXPECT_GT(area_of(curve_points(outlines[0])), 0) << n;
    }
}

TEST(Outline, FollowsNodePlanesRoundACylinder) {
    // A tuft laid round a cylinder of 20 mm touches it along its whole length: laid out along
    // the surface the patch is as long as the tuft; one plane would cut off its ends.
    const double R = 0.02, r = 0.002, length = 0.02;
    brush::TuftState tuft;
    tuft.branches.emplace_back();
    NodePlanes planes;
    for (int i = 0; i < 17; ++i) {
        const double angle = (0.5 - i / 16.0) * length / R;
        const Vec3 n{std::sin(angle), 0, std::cos(angle)}, t{std::cos(angle), 0, -std::sin(angle)};
        brush::Section s;
        s.centre = (R + 0.5 * r) * n - Vec3{0, 0, R};
        s.tangent = t;
        s.e = {0, 1, 0};
        s.m = glm::cross(s.e, t);
        s.a = s.b = r;
        tuft.branches[0].sections.push_back(s);
        planes.push_back({R * n - Vec3{0, 0, R}, n});
    }
    const Recycled<NodePlanes> by_branch = node_planes(tuft, planes);
    ASSERT_EQ(by_branch.size(), 1u);
    EXPECT_EQ(node_planes(tuft, {planes.data(), 1}).at(0).size(), 17u);  // one serves all
    EXPECT_TRUE(node_planes(tuft, {planes.data(), 5}).empty());
    const auto outlines = outlines_of(tuft, kFlat, by_branch, dry());
    ASSERT_EQ(outlines.size(), 1u);
    EXPECT_NEAR(outlines[0].tail.x, -0.5 * length, 1e-5);
    // The blunt tip ends in a ball, seen by the plane of the last node: a chord of √¾ r.
    EXPECT_NEAR(outlines[0].tip.x, 0.5 * length + std::sqrt(0.75) * r, 1e-4);
    double widest = 0;
    for (const Vec2& p : outlines[0].left) widest = std::max(widest, p.y);
    EXPECT_NEAR(widest, r * std::sqrt(0.75), 1e-6);
}

TEST(Rasterise, IsExactForAnyPlaceOnTheGrid) {
    // A circle of 20.3 cells: the area of the picture is that of the curve, wherever it lies.
    for (const double shift : {0.0, 0.31, 0.77}) {
        Outline o;
        const int n = 40;
        for (int k = 0; k < n; ++k) {
            const double a = 2 * kPi * k / n;
            // Control points on a circle larger by 3/(2 + cos): the curve's knots lie on 20.3
            // cells.
            o.control.push_back(20.3 * kTexel * 3 / (2 + std::cos(2 * kPi / n)) * Vec2{std::cos(a), std::sin(a)} +
                                shift * kTexel);
        }
        const Footprint f = rasterise({&o, 1}, kFlat, 0, kTexel);
        EXPECT_NEAR(coverage_area(f) / area_of(curve_points(o)), 1, 2e-4);  // 8-bit rounding
        EXPECT_NEAR(coverage_area(f) / (kPi * 20.3 * 20.3 * kTexel * kTexel), 1, 2e-3);
        for (int i = 0; i < f.width; ++i) {
            EXPECT_EQ(f.coverage[i], 0);
            EXPECT_EQ(f.coverage[std::size_t(f.height - 1) * f.width + i], 0);
        }
    }
    EXPECT_TRUE(rasterise({}, kFlat, 0, kTexel).empty());
}

TEST(Rasterise, TakesCoarserCellsWhereTexelsAreSmallAgainstTheTuft) {
    Outline huge;
    huge.control = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const Footprint f = rasterise({&huge, 1}, kFlat, 0, kTexel);
    EXPECT_LE(std::max(f.width, f.height), 4096);
    EXPECT_GT(std::max(f.width, f.height), 1024);
    EXPECT_NEAR(coverage_area(f) / area_of(curve_points(huge)), 1, 1e-4);
    huge.control[1].x = std::numeric_limits<double>::infinity();
    EXPECT_THROW(rasterise({&huge, 1}, kFlat, 0, kTexel), Error);
}

}  // namespace
}  // namespace tuft::footprint
