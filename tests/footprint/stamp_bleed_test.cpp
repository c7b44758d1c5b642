#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stage.h"

// Stamps stay on the surface that they touch: thin walls, sheets one over the other, gaps, rolls.

namespace tuft::footprint {
namespace {

using testing::Unwrapped;
constexpr double kPi = std::numbers::pi;

TEST(Stamp, DoesNotBleedThroughAPlate) {
    const double thickness = 0.0002;
    Stage stage(testing::plate(0.04, thickness, 300));
    const double r = 0.01;
    for (const double x : {0.0, 0.008, 0.013, 0.0199}) {
        const Vec3 at{x, 0.0012, 0};
        const Footprint f = disc(make_frame(at, {0, 0, 1}), stage.triangle_at(at, {0, 0, 1}), r, r / 64);
        const StampJobs jobs = stage.plan(f);
        double front = 0, back = 0, rim = 0;
        for_exposed(stage, jobs, [&](std::uint32_t slot, int t, float e) {
            const double nz = stage.map.normal(slot, t).z, area = stage.map.tiles[slot].area[t];
            (nz > 0.5 ? front : nz < -0.5 ? back : rim) += e * area;
        });
        EXPECT_GT(front, 0) << x;
        EXPECT_EQ(back, 0) << x;
        EXPECT_LT(rim, 0.02 * kPi * r * r) << x;
    }
}

TEST(Stamp, StaysOnItsOwnOfTwoStackedSheets) {
    // Two faces 0.05 r apart that nothing joins.
    Unwrapped u = testing::plate(0.04, 0.0005, 300);
    const std::size_t n = 2 * 2 * 16 * 16;
    u.mesh.triangles.resize(n);
    u.mesh.corner_normals.resize(3 * n);
    u.mesh.neighbours.resize(3 * n);
    for (std::uint32_t& x : u.mesh.neighbours) x = x < n ? x : kNone;
    for (std::size_t t = n / 2; t < n; ++t) {  // both face up
        std::swap(u.mesh.triangles[t][1], u.mesh.triangles[t][2]);
        std::swap(u.atlas.corner_uvs[3 * t + 1], u.atlas.corner_uvs[3 * t + 2]);
        for (int k = 0; k < 3; ++k) u.mesh.corner_normals[3 * t + k] = {0, 0, 1};
        std::swap(u.mesh.neighbours[3 * t], u.mesh.neighbours[3 * t + 2]);
    }
    u.atlas.corner_uvs.resize(3 * n);
    u.atlas.triangle_chart.resize(n);
    Stage stage(std::move(u));
    const Vec3 at{0.001, 0.0012, 0};
    const Footprint f = disc(make_frame(at, {0, 0, 1}), stage.triangle_at(at), 0.01, 0.01 / 64);
    std::size_t exposed = 0, wrong = 0;
    for_exposed(stage, stage.plan(f), [&](std::uint32_t slot, int t, float) {
        ++exposed;
        wrong += stage.map.position(slot, t).z < -1e-4;
    });
    EXPECT_GT(exposed, 10000u);
    EXPECT_EQ(wrong, 0u);
}

TEST(Stamp, DoesNotJumpAcrossAGap) {
    // Two sheets in one plane, 0.02 r apart, in charts side by side.
    const double r = 0.01, gap = 0.02 * r;
    testing::Patch left = testing::flat({-0.03 - gap / 2, -0.015, 0}, {0.03, 0, 0}, {0, 0.03, 0}, 8, 8);
    testing::Patch right = testing::flat({gap / 2, -0.015, 0}, {0.03, 0, 0}, {0, 0.03, 0}, 8, 8);
    testing::place(left, {8.3, 8.4}, {200, 0}, {0, 200});
    testing::place(right, {217.6, 8.4}, {200, 0}, {0, 200});
    Stage stage(testing::build({left, right}, 430));
    const Vec3 at{-0.2 * r, 0.0003, 0};
    const Footprint f = disc(make_frame(at, {0, 0, 1}), stage.triangle_at(at), r, r / 64);
    std::size_t here = 0, beyond = 0;
    for_exposed(stage, stage.plan(f),
                [&](std::uint32_t slot, int t, float) { ++(stage.map.position(slot, t).x < 0 ? here : beyond); });
    EXPECT_GT(here, 3000u);
    EXPECT_EQ(beyond, 0u);
}

TEST(Stamp, StaysOnItsTurnOfARolledSheet) {
    // A spiral whose turns lie 0.1 r apart: unrolled it is flat, and other turns are far away.
    const double r = 0.008, inner = 0.01, pitch = 0.1 * r / (2 * kPi), turns = 3;
    const auto radius = [=](double a) { return inner + pitch * a; };
    const auto length = [=](double a) {  // ∫ √(ρ² + ρ'²), ρ' = pitch ≪ ρ: Simpson
        const int n = 2000;
        double sum = 0;
        for (int i = 0; i <= n; ++i) {
            const double w = i == 0 || i == n ? 1 : i % 2 ? 4 : 2;
            sum += w * std::hypot(radius(a * i / n), pitch);
        }
        return sum * a / n / 3;
    };
    std::vector<testing::Patch> patches;
    const int charts = 6;
    const double texels = 64 / r;
    for (int k = 0; k < charts; ++k) {
        const double a0 = 2 * kPi * turns * k / charts, da = 2 * kPi * turns / charts;
        testing::Patch p;
        p.position = [=](double s, double t) {
            const double a = a0 + s * da;
            return Vec3{radius(a) * std::cos(a), radius(a) * std::sin(a), (t - 0.5) * 0.024};
        };
        p.normal = [=](double s, double) {
            const double a = a0 + s * da;
            const Vec2 along =
                Vec2{-radius(a) * std::sin(a), radius(a) * std::cos(a)} + pitch * Vec2{std::cos(a), std::sin(a)};
            return glm::normalize(Vec3{along.y, -along.x, 0});
        };
        p.ns = 96;
        p.nt = 4;
        testing::place(p, {8.3, 8.4 + k * (0.024 * texels + 9.1)}, {(length(a0 + da) - length(a0)) * texels, 0},
                       {0, 0.024 * texels});
        patches.push_back(p);
    }
    Stage stage(testing::build(patches, 1300));
    const double middle = 2 * kPi * 1.5;
    const Vec3 n = patches[3].normal(0, 0),
               at{radius(middle) * std::cos(middle), radius(middle) * std::sin(middle), 0.0003};
    const Footprint f = disc(make_frame(at, n, {0, 0, 1}), stage.triangle_at(at, n), r, r / 64);
    const StampJobs jobs = stage.plan(f);
    std::size_t exposed = 0, wrong = 0;
    double worst = 0;
    for_exposed(stage, jobs, [&](std::uint32_t slot, int t, float) {
        const Vec3 p(stage.map.position(slot, t));
        // The turn it lies on, from its distance to the axis.
        const double phase = std::atan2(p.y, p.x);
        const double a = phase + 2 * kPi * std::round((((std::hypot(p.x, p.y) - inner) / pitch) - phase) / (2 * kPi));
        const double distance = std::hypot(length(a) - length(middle), p.z - at.z);
        wrong += distance > 1.05 * r;
        worst = std::max(worst, std::abs(distance - glm::length(place_of(stage, jobs, f, slot, t))) / r);
        ++exposed;
    });
    EXPECT_GT(exposed, 10000u);
    EXPECT_EQ(wrong, 0u);
    // A developable surface of slowly changing curvature, radius over curvature 0.7; 96 chords a
    // half turn.
    EXPECT_LT(worst, 5e-3);
}

}  // namespace
}  // namespace tuft::footprint
