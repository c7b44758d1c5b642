#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "brush/preset/preset.h"
#include "brush/state/tuft_state.h"
#include "brush/tuft/tuft.h"
#include "footprint/outline/cuts.h"
#include "footprint/outline/outline.h"

// A row of spines that lands spine by spine.

namespace tuft::footprint {
namespace {

constexpr int kSpines = 5;
constexpr double kPitch = 2e-3, kHalfThick = 0.4e-3;  // metres

/// A row along y whose hair lies along x, its middle `press` below the touch and its spines higher by `step` each from
/// the middle on.
brush::TuftState lying_row(double press, double step) {
    brush::TuftState tuft;
    tuft.wide = tuft.strips = true;
    for (int k = 0; k < kSpines; ++k) {
        const int out = std::abs(k - kSpines / 2);
        brush::Branch branch;
        for (int i = 0; i < 6; ++i) {
            brush::Section s;
            s.centre = {-1e-3 * i, kPitch * (k - kSpines / 2), kHalfThick - press + out * step};
            s.tangent = {1, 0, 0};
            s.e = {0, 1, 0};
            s.m = {0, 0, 1};
            s.a = 0.5 * kPitch / Cut::kStripChord;
            s.b = kHalfThick;
            branch.sections.push_back(s);
        }
        tuft.branches.push_back(branch);
        if (k > 0) tuft.openings.push_back({k - 1, k, Recycled<double>(6, -1e-4)});
    }
    return tuft;
}

/// How far out on each side the outlines reach, metres.
struct Sides {
    double lo = 0, hi = 0;
};
Sides sides_of(const brush::TuftState& tuft) {
    Sides out{1, -1};
    for (const Outline& o : outlines_of(tuft, Frame{}, {}, {.film = 0}))
        for (const Vec2& p : o.control) out = {std::min(out.lo, p.y), std::max(out.hi, p.y)};
    return out;
}

/// A row that is higher to its sides by a slope touches as far out as press over slope: no strip lands at once.
TEST(RowLanding, GoesOutEvenlyToItsSides) {
    constexpr double kSlope = 0.05;
    for (double out = 0.1; out < 2.2; out += 0.1) {  // pitches from the middle
        const Sides sides = sides_of(lying_row(kSlope * out * kPitch, kSlope * kPitch));
        // Round ends of a spine that has just landed lie behind its neighbour's, which slants its strip: by 0.0144. The
        // free side of the last one goes over into all of it: 0.0373 further.
        EXPECT_NEAR(sides.hi / kPitch, out, out < 1.95 ? 0.02 : 0.05) << out;
        EXPECT_NEAR(sides.lo / kPitch, -sides.hi / kPitch, 1e-9) << out;
    }
}

/// A row that lies evenly touches over its whole width at once.
TEST(RowLanding, OfAnEvenRowIsAtOnce) {
    for (const double press : {1e-7, 1e-5, 1e-4}) {
        const Sides sides = sides_of(lying_row(press, 0));
        EXPECT_NEAR(sides.hi, 2.5 * kPitch, 1e-9) << press;
        EXPECT_NEAR(sides.lo, -2.5 * kPitch, 1e-9) << press;
    }
}

/// Bent lengths of hair of one length are chord sums, which differ from pose to pose; a strip's reach goes with them,
/// at most as a length does.
TEST(RowLanding, DoesNotLeapWithBentLengths) {
    const auto reach_of = [](double longer) {
        brush::TuftState tuft = lying_row(1e-4, 1.5e-4);
        for (brush::Section& s : tuft.branches[1].sections) s.centre.x *= 1 + longer;
        Recycled<double> out;
        for (const Trail& trail : find_trails(tuft, Frame{}, {}, 26e-3, 0))
            for (const Cut& cut : trail.cuts) out.push_back(cut.reach.x);
        return out;
    };
    const Recycled<double> even = reach_of(0), bent = reach_of(1e-6);
    ASSERT_EQ(even.size(), bent.size());
    ASSERT_LT(*std::min_element(even.begin(), even.end()), 0.9) << "nothing is bounded";
    for (std::size_t i = 0; i < even.size(); ++i) EXPECT_NEAR(bent[i], even[i], 1e-5) << i;
}

/// A row on its edge that is sheared lies more closely than it is wide: its second spine is 0.4 pitches up, and midway
/// to it the hair is in the air by 0.2. Its own half width would reach the surface 2 mm ahead of the first one.
TEST(RowLanding, OnItsEdgeTouchesWithItsLowestHairOnly) {
    brush::TuftState tuft = lying_row(0, 0);
    for (int k = 0; k < kSpines; ++k)
        for (brush::Section& s : tuft.branches[static_cast<std::size_t>(k)].sections) {
            s.centre = {s.centre.x + kPitch * k, 0, 0.4 * kPitch * k};
            s.e = {0, 0, 1};
            s.m = {0, 1, 0};
        }
    const Recycled<Trail> trails = find_trails(tuft, Frame{}, {}, 26e-3, 1e-4);
    ASSERT_EQ(trails.size(), 1u);
    EXPECT_EQ(trails[0].branch, 0);
    EXPECT_NEAR(glm::length(trails[0].cuts.back().thick()), kHalfThick + 1e-4, 1e-9) << "as thick as it is, and ink";
}

/// A filbert lands from its middle outwards: hair touches where it is long enough.
TEST(RowLanding, AFilbertLandsFromItsMiddle) {
    constexpr double kLean = 0.4;
    const brush::Preset p = brush::load_preset("filbert-12");
    for (const double press : {0.06, 0.1}) {
        brush::Tuft tuft = brush::make_tuft(p, 5);
        brush::TuftState state;
        const brush::ContactPlane plane;
        for (int i = 0; i <= 30; ++i) {
            const brush::Pose pose{.position = {0, 0, p.length * (std::cos(kLean) - press * i / 30)},
                                   .rotation = glm::angleAxis(kLean, Vec3{1, 0, 0})};
            state = brush::step(tuft, pose, std::span(&plane, 1), 1e-3);
        }
        // L − h (1 − √(1 − s²)) reaches the surface, straight.
        const double shorter = press / std::cos(kLean) * p.length / p.toe,
                     s = std::sqrt(1 - (1 - shorter) * (1 - shorter));
        double lo = 1e9, hi = -1e9;
        for (const Outline& o : outlines_of(state, {}, {}, {.film = 0, .points = 60}))
            for (const Vec2& q : curve_points(o, 8)) lo = std::min(lo, q.x), hi = std::max(hi, q.x);
        const double width = hi - lo;
        // Straight hair reaches furthest; a spine stands for a strip of 2.4 mm.
        EXPECT_LT(width, s * p.width + 2 * p.tip_radius) << press;
        EXPECT_GT(width, s * p.width - 0.75 * p.width / p.spines) << press;
        EXPECT_NEAR(-lo, hi, 1e-6 * width) << "is its own mirror image: rounding of 31 solved steps";
    }
}

}  // namespace
}  // namespace tuft::footprint
