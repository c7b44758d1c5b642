#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "brush/tuft/tuft.h"
#include "brush/tuft/upright_hair.h"
#include "footprint/outline/cuts.h"

/// Hair round the foot of the axis: what an upright press leaves.
namespace tuft::footprint {
namespace {

constexpr double kBin = 5e-5, kFirst = -4e-3;  // m along x

/// Half widths of what a tuft covers that is pressed straight down on z = 0 and lifted again, by bins along x.
Recycled<double> pressed(const std::string& brush, double depth, int ms) {
    brush::Tuft tuft = brush::make_tuft(brush::load_preset(brush));
    const double length = tuft.preset.length, film = OutlineOptions{}.film;
    const brush::ContactPlane sheet;
    Frame frame = make_frame({0, 0, 0}, {0, 0, 1});
    frame.t = {1, 0, 0};
    frame.b = {0, 1, 0};
    Recycled<double> half(600, 0);
    for (int i = -20; i <= ms + 20; ++i) {
        const double down = std::sin(std::numbers::pi * std::clamp(double(i) / ms, 0.0, 1.0));
        const double air = i < 0 || i > ms ? 5e-4 : 0;
        brush::Pose pose{.position = {0, 0, length - depth * length * down + air}, .time = 1e-3 * i};
        const brush::TuftState state = step(tuft, pose, {&sheet, 1}, 1e-3);
        Recycled<Trail> found = find_trails(state, frame, {}, length, film);
        cover_upright_hair(found, upright_hair_of(tuft, sheet), frame, film);
        for (const Trail& trail : found) {
            const Outline o = outline_of(trail, OutlineOptions{}.points);
            if (o.left.size() < 3) continue;
            const Recycled<Vec2> curve = curve_points(o, 16);
            for (std::size_t k = 0; k < curve.size(); ++k) {
                const Vec2 &p = curve[k], &q = curve[(k + 1) % curve.size()];
                for (int s = 0; s <= 8; ++s) {
                    const Vec2 x = glm::mix(p, q, s / 8.0);
                    const auto bin = static_cast<std::size_t>((x.x - kFirst) / kBin);
                    if (bin < half.size()) half[bin] = std::max(half[bin], std::abs(x.y));
                }
            }
        }
    }
    return half;
}

TEST(UprightHair, APressStraightDownLeavesADropRoundAtTheAxisWithoutASpur) {
    for (const char* brush : {"wolf-medium", "goat-medium", "mixed-medium"}) {
        for (const double depth : {0.08, 0.16}) {
            for (const int ms : {80, 400}) {
                SCOPED_TRACE(std::string(brush) + " " + std::to_string(depth) + " in " + std::to_string(ms) + " ms");
                const Recycled<double> half = pressed(brush, depth, ms);
                const auto touched = [](double h) { return h > 0; };
                const auto rear =
                    static_cast<std::size_t>(std::find_if(half.begin(), half.end(), touched) - half.begin());
                const auto widest = static_cast<std::size_t>(std::max_element(half.begin(), half.end()) - half.begin());
                ASSERT_LT(rear, half.size());
                // It begins behind the axis, no further than half its width, and is round there: at a place
                // x from the end of a circle of radius R the half width is √(x (2R - x)).
                const double end = kFirst + kBin * static_cast<double>(rear), most = half[widest];
                EXPECT_LT(end, 0);
                EXPECT_GT(end, -most - kBin);
                const double radius = std::min(-end, most);
                for (double x = 0.2 * radius; x < 0.9 * radius; x += kBin)
                    EXPECT_GT(half[rear + static_cast<std::size_t>(x / kBin)], 0.8 * std::sqrt(x * (2 * radius - x)))
                        << x;
                // And widens from there on without a neck; the spur was a neck of a seventh.
                double before = 0;
                for (std::size_t i = rear + static_cast<std::size_t>(radius / kBin); i <= widest; ++i) {
                    EXPECT_GT(half[i], 0.93 * before) << i;
                    before = std::max(before, half[i]);
                }
            }
        }
    }
}

TEST(UprightHair, HairDrawnToOneSideHasNone) {
    brush::Tuft tuft = brush::make_tuft(brush::load_preset("goat-medium"));
    const double length = tuft.preset.length;
    const brush::ContactPlane sheet;
    brush::Pose pose{.position = {0, 0, length + 5e-4}};
    EXPECT_EQ(upright_hair_of(tuft, sheet).share, 0);  // in the air
    for (int i = 0; i <= 100; ++i) {
        pose.position.z = length - 0.15 * length * i / 100;
        step(tuft, pose, {&sheet, 1}, 2e-3);
    }
    const brush::UprightHair upright = upright_hair_of(tuft, sheet);
    EXPECT_GT(upright.share, 0.99);
    EXPECT_NEAR(glm::length(upright.centre), 0, 1e-9);
    EXPECT_NEAR(upright.radius, brush::rest_radius(tuft.preset, 0.85), 1e-9);
    double before = upright.share;
    for (int i = 0; i <= 100; ++i) {
        pose.position.x += 1e-4;
        step(tuft, pose, {&sheet, 1}, 2e-3);
        const double share = upright_hair_of(tuft, sheet).share;
        EXPECT_LE(share, before + 1e-12);
        EXPECT_GT(share, before - 0.1);  // 0.1 mm of a path of some 4 mm
        before = share;
    }
    EXPECT_EQ(before, 0);
}

}  // namespace
}  // namespace tuft::footprint
