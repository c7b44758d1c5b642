#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "footprint/outline/cuts.h"
#include "footprint/outline/slip.h"

// Hair of a row whose spines differ in length.

namespace tuft::footprint {
namespace {

/// The ends of its strips are the quadratic B-spline of the spines' ends: they meet midway between two spines, in the
/// direction from one to the other, and halve the way to the spine between.
TEST(RowHair, EndsOfStripsOfOtherLengthsAreOneSmoothCurve) {
    constexpr double kApart = 2e-3, kChord = Cut::kStripChord;
    const double ends[] = {-4e-3, -1e-3, 0, -1e-3, -4e-3};  // metres along the hair
    Recycled<Trail> trails;
    for (int k = 0; k < 5; ++k) {
        Trail trail{.branch = k, .length = 1 + ends[k] / 22e-3, .strip = true};
        for (const double x : {0.0, -6e-3}) {
            Cut cut{.centre = {ends[k] + x, kApart * k}, .a = 1e-3, .b = 3e-4};
            cut.e = {0, 1, 0};
            trail.cuts.push_back(cut);
            trail.along.push_back(0.9 + x);
        }
        if (k > 0) trails.back().openings.push_back({k, {0.0, 0.0}});
        trails.push_back(std::move(trail));
    }
    fill_rows(trails);
    const auto place = [&](int k, double s) {
        const Cut& cut = trails[static_cast<std::size_t>(k)].cuts.front();
        return cut.centre + cut.bent(s * kChord) + s * kChord * Vec2(cut.broad());
    };
    for (int k = 0; k < 4; ++k) {
        EXPECT_NEAR(place(k, 1).x, 0.5 * (ends[k] + ends[k + 1]), 1e-15) << k;
        EXPECT_NEAR(place(k + 1, -1).x, 0.5 * (ends[k] + ends[k + 1]), 1e-15) << k;
        const auto slope = [&](int of, double s) {  // of a parabola in s, from its values
            const double h = s > 0 ? -0.5 : 0.5;
            return (-3 * place(of, s).x + 4 * place(of, s + h).x - place(of, s + 2 * h).x) / (2 * h);
        };
        EXPECT_NEAR(slope(k, 1), 0.5 * (ends[k + 1] - ends[k]), 1e-15) << k;
        EXPECT_NEAR(slope(k + 1, -1), 0.5 * (ends[k + 1] - ends[k]), 1e-15) << k;
    }
    EXPECT_NEAR(place(2, 0).x, 0.25 * (0.5 * (ends[1] + ends[2]) + 2 * ends[2] + 0.5 * (ends[2] + ends[3])), 1e-15);
    // Outer hair goes on straight.
    EXPECT_NEAR(place(0, -1).x - place(0, 0).x, place(0, 0).x - place(0, 1).x, 1e-15);
}

/// Two strips side by side along y, of hair along x, the second `ahead`; the first one's free edge is 3 mm shorter.
Recycled<Trail> two_strips(double ahead, double reach) {
    Recycled<Trail> trails;
    for (int k = 0; k < 2; ++k) {
        Trail trail{.branch = k, .strip = true, .edge_short = k == 0 ? 3e-3 : 0};
        for (const double x : {0.0, -2e-3}) {
            Cut cut{.centre = {x + k * ahead, 2e-3 * k}, .a = 1.3e-3, .b = 3e-4};
            cut.e = {0, 1, 0};
            if (k == 0) cut.reach.x = reach;
            trail.cuts.push_back(cut);
            trail.along.push_back(0.9 + x);
        }
        trails.push_back(std::move(trail));
    }
    trails[0].openings.push_back({1, {0.0, 0.0}});
    return trails;
}

/// A row that turns to be square to its hair keeps its toe: what it drops changes as much as the row does.
TEST(RowHair, TheToeOfASquareRowDropsToo) {
    const double half = Cut::kStripChord * 1.3e-3;
    const auto drop = [&](double slant) {
        Recycled<Trail> trails = two_strips(2 * slant * half, 1);
        fill_rows(trails);
        return trails[0].cuts.front().bent(-Cut::kStripChord).x;
    };
    EXPECT_LT(drop(0), -half) << "3 mm, of a half width of 1.2";
    EXPECT_NEAR(drop(0.0099), drop(0.0101), 0.001 * half);
    EXPECT_NEAR(drop(0), drop(0.0101), 0.03 * half);
}

/// A toe touches up to where its hair reaches, or less where the surface bounds it: both are of the same half width.
TEST(RowHair, AToeTouchesNoFurtherThanTheSurface) {
    const auto reach = [](double bounded) {
        Recycled<Trail> trails = two_strips(0, bounded);
        fill_rows(trails);
        return trails[0].cuts.front().reach.x;
    };
    const double hair = reach(1);
    ASSERT_GT(hair, 0.1);
    ASSERT_LT(hair, 0.95);
    EXPECT_EQ(reach(0.5 * (hair + 1)), hair);
    EXPECT_EQ(reach(0.5 * hair), 0.5 * hair);
    EXPECT_EQ(reach(-0.5), -0.5) << "all that touches lies beyond the middle";
}

/// Of a strip whose end goes aslant, the edges are displaced along the hair by ±slant beside what the strip is.
TEST(RowHair, TheEdgesOfAStripThatGoesAslantSlideAlongTheirHair) {
    constexpr double kHalf = 1e-3, kAside = 3e-4, kSlant = 4e-4, kBow = 2e-4;  // metres
    Trail trail{.branch = 1, .strip = true};
    for (const double along : {1e-3, 0.0}) {
        Cut cut{.centre = {along, 0}, .a = kHalf, .b = 4e-4};
        cut.e = {0, 1, 0};
        trail.cuts.push_back(cut);
        trail.along.push_back(0.9 + along);
    }
    const Recycled<Trail> before{trail};
    for (Cut& cut : trail.cuts) cut.centre.y += kAside, cut.slant = {kSlant, 0}, cut.bow = {kBow, 0};
    const TransverseLength across({trail, 0, trail.cuts.size()}, before, {0, 1});
    const double edge = std::sqrt(0.25 * std::numbers::pi);
    for (const double s : {-1.0, 0.0, 1.0}) {
        const Vec2 moved{s * kSlant + (1 - s * s) * kBow, kAside};
        // Places are linear between 17 of them.
        EXPECT_NEAR(across.mean_sine(s * edge), kAside / glm::length(moved), 0.02) << s;
        EXPECT_NEAR(across.sine_to(s * edge, {0, 1}), std::abs(moved.x) / glm::length(moved), 0.02) << s;
    }
}

}  // namespace
}  // namespace tuft::footprint
