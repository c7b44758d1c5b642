#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "brush/preset/preset.h"
#include "brush/preset/rest_shape.h"
#include "brush/tuft/tuft.h"
#include "footprint/outline/cuts.h"
#include "footprint/outline/hair.h"
#include "footprint/outline/outline.h"

namespace tuft::footprint {
namespace {

constexpr double kCell = 5e-5;
const Frame kFlat;

/// A flat dragged over the plane on its broad side, leaning ahead: along −y, with `way` −1 along y.
brush::TuftState dragged(brush::Tuft tuft, int way) {
    brush::TuftState state;
    const brush::ContactPlane plane;
    const double length = tuft.preset.length;
    for (int i = 0; i <= 90; ++i) {
        brush::Pose pose;
        pose.rotation = glm::angleAxis(way * 0.4, Vec3{1, 0, 0});
        pose.position = {0, -2e-4 * way * std::max(0, i - 30),
                         length * std::cos(0.4) - 0.2 * length * std::min(1.0, i / 30.0)};
        state = brush::step(tuft, pose, std::span(&plane, 1), 1e-3);
    }
    return state;
}

/// Along −y, wet or dry.
brush::TuftState dragged(const std::string& name, double wet = 1) {
    brush::Tuft tuft = brush::make_tuft(brush::load_preset(name), 5);
    tuft.wetness = tuft.ink_left = wet;
    return dragged(std::move(tuft), 1);
}

double coverage_area(const Footprint& f) {
    double sum = 0;
    for (const std::uint8_t c : f.coverage) sum += c / 255.0;
    return sum * f.cell * f.cell;
}

/// For each column of the picture over the middle `part` of its width: where coverage begins and ends, metres.
struct Rim {
    Recycled<double> lo, hi;
    double width = 0;
};
Rim rim_of(const Footprint& f, double part) {
    Recycled<std::pair<double, double>> all;
    for (int x = 0; x < f.width; ++x) {
        double lo = 1e9, hi = -1e9;
        for (int y = 0; y < f.height; ++y) {
            if (f.coverage[static_cast<std::size_t>(y) * f.width + x] < 128) continue;
            lo = std::min(lo, f.lo.y + (y + 0.5) * f.cell);
            hi = std::max(hi, f.lo.y + (y + 0.5) * f.cell);
        }
        if (hi >= lo) all.emplace_back(lo, hi);
    }
    Rim out;
    out.width = static_cast<double>(all.size()) * f.cell;
    const auto skip = static_cast<std::size_t>(0.5 * (1 - part) * static_cast<double>(all.size()));
    for (std::size_t i = skip; i + skip < all.size(); ++i) {
        out.lo.push_back(all[i].first);
        out.hi.push_back(all[i].second);
    }
    return out;
}

struct Extent {
    double lo = 1e9, hi = -1e9;
    double width() const { return hi - lo; }
};

/// Of the outlines along x.
Extent extent_of(const Recycled<Outline>& outlines) {
    Extent out;
    for (const Outline& o : outlines) {
        for (const Vec2& p : curve_points(o, 8)) {
            out.lo = std::min(out.lo, p.x);
            out.hi = std::max(out.hi, p.x);
        }
    }
    return out;
}

double spread(const Recycled<double>& v) {
    const auto [lo, hi] = std::minmax_element(v.begin(), v.end());
    return *hi - *lo;
}

/// A flat's patch is as wide as the brush, in one piece, and its front edge and tail are straight: no lobe of a spine
/// stands out.
TEST(WideOutline, FlatHasAStraightEdge) {
    const brush::TuftState tuft = dragged("flat-12");
    const Recycled<Outline> outlines = outlines_of(tuft, kFlat);
    const Footprint f = rasterise(outlines, kFlat, 0, kCell);
    const Rim rim = rim_of(f, 0.7);
    EXPECT_NEAR(rim.width, 12e-3, 1.5e-3);
    // A spine is 2.4 mm wide; lobes of ellipses would stand out by a millimetre.
    EXPECT_LT(spread(rim.lo), 0.15e-3);
    EXPECT_LT(spread(rim.hi), 0.15e-3);
    // In one piece: columns are covered from edge to edge.
    double filled = 0;
    for (std::size_t i = 0; i < rim.lo.size(); ++i) filled += (rim.hi[i] - rim.lo[i] + f.cell) * f.cell;
    EXPECT_NEAR(filled / coverage_area(f), 0.7, 0.1);
}

/// A flat that just touches, upright and turned by φ, marks the edge of its mouth: along a line at φ to its broad side
/// [(w |cos φ|)^s + (t |sin φ|)^s]^{1/s} wide, s = q/(q − 1), the width of the superellipse.
TEST(WideOutline, EdgeIsThatOfTheMouth) {
    for (const double q : {2.0, 4.0, 16.0}) {
        brush::Preset p = brush::load_preset("flat-12");
        p.corner = q;
        p.tip_radius = p.radius;  // no taper
        p.flatten_contact = p.flatten_force = p.flatten_moment = 0;
        for (int degrees = 0; degrees < 180; degrees += 15) {
            const double turn = degrees * std::numbers::pi / 180;
            brush::Tuft tuft = brush::make_tuft(p, 5);
            brush::TuftState state;
            const brush::ContactPlane plane;
            for (int i = 0; i <= 10; ++i) {
                brush::Pose pose;
                pose.rotation = glm::angleAxis(turn, Vec3{0, 0, 1});
                pose.position = {0, 0, p.length + 1e-4 - 2e-5 * i};
                state = brush::step(tuft, pose, std::span(&plane, 1), 1e-3);
            }
            const double width = extent_of(outlines_of(state, kFlat, {}, {.film = 0})).width();
            const double s = q / (q - 1), w = p.width * std::abs(std::cos(turn)),
                         t = 2 * p.radius * std::abs(std::sin(turn));
            // Of 2 %: strips with corners in place of the curve 0.5 %, hair that falls aside by 0.1 mm the rest.
            EXPECT_NEAR(width / std::pow(std::pow(w, s) + std::pow(t, s), 1 / s), 1, 0.02)
                << "q " << q << ", " << degrees;
            // A rectangle's but for the corners, whose worst is 2^{−1/q}.
            if (q >= 14) {
                EXPECT_NEAR(width / (w + t), 1, 0.05) << degrees;
            }
        }
    }
}

/// Force and width of a row of 3, 5 and 9 spines, turned against its path, leaning and dragged.
struct Refined {
    Recycled<double> force, width;
};
Refined refined(const std::string& name, double wetness, double press) {
    Refined out;
    for (const int count : {3, 5, 9}) {
        brush::Preset p = brush::load_preset(name);
        p.spines = count;
        brush::Tuft tuft = brush::make_tuft(p, 7);
        tuft.wetness = wetness;
        brush::TuftState state;
        const brush::ContactPlane plane;
        for (int i = 0; i <= 90; ++i) {
            brush::Pose pose;
            pose.rotation = glm::angleAxis(0.4, Vec3{1, 0, 0}) * glm::angleAxis(0.3, Vec3{0, 0, 1});
            pose.position = {0, -2e-4 * std::max(0, i - 30),
                             p.length * (std::cos(0.4) - press * std::min(1.0, i / 30.0))};
            state = brush::step(tuft, pose, std::span(&plane, 1), 1e-3);
        }
        out.force.push_back(state.force.z);
        out.width.push_back(extent_of(outlines_of(state, kFlat, {}, {.film = 0, .points = 60})).width());
    }
    return out;
}

/// Order of convergence p of what 3, 5 and 9 spines give: (3⁻ᵖ − 5⁻ᵖ)/(5⁻ᵖ − 9⁻ᵖ), which grows with p; at most 6.
double order_of(const Recycled<double>& v) {
    const double found = std::abs((v[0] - v[1]) / (v[1] - v[2]));
    double p = 0.05;
    for (; p < 6; p += 0.05)
        if ((std::pow(3, -p) - std::pow(5, -p)) / (std::pow(5, -p) - std::pow(9, -p)) > found) break;
    return p;
}

/// What a row draws converges with the square of its pitch.
TEST(WideOutline, RefinedRowsConvergeWithTheSquareOfTheirPitch) {
    const Refined flat = refined("flat-12", 1, 0.2);
    EXPECT_GT(order_of(flat.force), 1.8);
    EXPECT_GT(order_of(flat.width), 1.8);
    // A filbert's toe falls steeply at its edges, 1 − √(1 − s²): the length of the outermost strip's mean hair, and
    // with it the force, converge more slowly than its breadth.
    // Pressed until the hair of its edges lies, too.
    const Refined filbert = refined("filbert-12", 1, 0.3);
    EXPECT_GT(order_of(filbert.force), 1.2);
    EXPECT_GT(order_of(filbert.width), 1.8);
    // A wet fan zips in other places for each number of spines; dry hair has no film.
    EXPECT_GT(order_of(refined("fan-30", 0, 0.2).force), 1.7);
}

/// A filbert's toe is round: its middle touches further ahead than its edges, as a mirror image.
TEST(WideOutline, FilbertHasARoundToe) {
    const brush::TuftState tuft = dragged("filbert-12");
    const Footprint f = rasterise(outlines_of(tuft, kFlat), kFlat, 0, kCell);
    const Rim rim = rim_of(f, 0.9);
    // The hair trails towards +y.
    const std::size_t n = rim.hi.size();
    EXPECT_GT(rim.hi[n / 2], rim.hi.front() + 0.5e-3);
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(rim.hi[i], rim.hi[n - 1 - i], 3 * kCell);
}

/// A stippler that just touches, upright, marks the disc of its hair: seven discs and all that lies between those that
/// ink joins, from side to side.
TEST(WideOutline, RingMarksADisc) {
    const brush::Preset p = brush::load_preset("stippler-10");
    brush::Tuft tuft = brush::make_tuft(p, 5);
    brush::TuftState state;
    const brush::ContactPlane plane;
    for (int i = 0; i <= 10; ++i) {
        brush::Pose pose;
        pose.position = {0, 0, p.length + 1e-5 - 2e-6 * i};
        state = brush::step(tuft, pose, std::span(&plane, 1), 1e-3);
    }
    const Footprint f = rasterise(outlines_of(state, kFlat, {}, {.film = 0}), kFlat, 0, kCell);
    double filled = 0;
    for (int x = 0; x < f.width; ++x) {
        int lo = f.height, hi = -1;
        for (int y = 0; y < f.height; ++y) {
            if (f.coverage[static_cast<std::size_t>(y) * f.width + x] < 128) continue;
            lo = std::min(lo, y);
            hi = std::max(hi, y);
        }
        filled += std::max(0, hi - lo + 1);
    }
    const double area = coverage_area(f), cell = brush::rest_radius(p, 1) / p.radius;
    // No bay; the middle falls to one side by a quarter of a millimetre, and leaves a gap behind it.
    EXPECT_NEAR(filled * f.cell * f.cell / area, 1, 0.035);
    // Within the disc; the hexagon of the outer discs' outer sides is the least.
    EXPECT_LT(area, 1.02 * std::numbers::pi * p.radius * p.radius);
    EXPECT_GT(area, 0.75 * std::numbers::pi * p.radius * p.radius * cell);
}

/// Width of the stripe of a sword after a long path, straight or on a circle of 60 mm, metres. Its blade goes along the
/// path where its point touches, or keeps its direction.
double stripe_of_sword(bool circle, bool follows) {
    constexpr double kRadius = 60e-3, kStep = 2e-4, kDepth = 0.06;
    const brush::Preset p = brush::load_preset("sword-8");
    brush::Tuft tuft = brush::make_tuft(p, 7);
    brush::TuftState state;
    const brush::ContactPlane plane;
    double behind = 0, widest = 0;
    for (int i = 0; i < 1800; ++i) {
        const double along = kStep * i, turn = circle ? along / kRadius : 0;
        brush::Pose pose;
        pose.position = {circle ? kRadius * std::sin(turn) : along, circle ? kRadius * (1 - std::cos(turn)) : 0,
                         p.length * (1 - kDepth * std::min(1.0, i / 150.0))};
        pose.rotation = glm::angleAxis(follows ? turn - behind : 0, Vec3{0, 0, 1});
        state = brush::step(tuft, pose, std::span(&plane, 1), 2e-3);
        const Vec3& point = state.branches.back().sections.front().centre;
        if (circle && state.touching)
            behind = std::remainder(turn - std::atan2(point.x, kRadius - point.y), 2 * std::numbers::pi);
        if (i < 1200 || i % 20 != 0) continue;
        Extent across;
        for (const Outline& o : outlines_of(state, kFlat)) {
            for (const Vec2& q : curve_points(o, 6)) {
                const double at = circle ? std::hypot(q.x, q.y - kRadius) : q.y;
                across.lo = std::min(across.lo, at);
                across.hi = std::max(across.hi, at);
            }
        }
        widest = std::max(widest, across.width());
    }
    return widest;
}

/// A sword whose blade follows a curve of 60 mm draws the stripe that it draws straight on, within 3 %; one that keeps
/// its direction draws its breadth.
TEST(WideOutline, ABladeThatFollowsACurveKeepsItsStripe) {
    const double straight = stripe_of_sword(false, true);
    EXPECT_NEAR(stripe_of_sword(true, true) / straight, 1, 0.03);
    EXPECT_GT(stripe_of_sword(true, false), 3 * straight);
}

/// The edge of a flat that is pressed down slips away by more than it is wide from pose to pose. The patches of all
/// poses leave no gap on the way of its middle.
TEST(WideOutline, AnEdgeThatLeapsMarksAllThatItPassesOver) {
    brush::Tuft tuft = brush::make_tuft(brush::load_preset("flat-12"), 5);
    const brush::ContactPlane ground;
    const double length = tuft.preset.length;
    Recycled<Trail> before;
    Recycled<std::pair<double, double>> covered;
    double most = 0, least = 1e9;
    int leaps = 0;
    for (int i = 0; i <= 30; ++i) {
        const brush::Pose pose{.position = {0, 0, length + 1e-5 - 1e-4 * i}};
        const brush::TuftState state = brush::step(tuft, pose, std::span(&ground, 1), 1e-3);
        const Recycled<Trail> trails = find_trails(state, kFlat, {}, length, 1e-4);
        const Recycled<Trail> leapt = leapt_trails(trails, kFlat, before, kFlat, {0, 0});
        leaps += !leapt.empty();
        double lo = 1e9, hi = -1e9;
        for (const Outline& o : outlines_of(trails, 20, leapt))
            for (const Vec2& p : curve_points(o, 8)) lo = std::min(lo, p.y), hi = std::max(hi, p.y);
        if (!trails.empty()) {
            covered.emplace_back(lo, hi);
            least = std::min(least, lo);
            most = std::max(most, hi);
        }
        before = trails;
    }
    EXPECT_GT(leaps, 3);
    ASSERT_GT(most - least, 3e-3);
    std::sort(covered.begin(), covered.end());
    double reached = least;
    for (const auto& [lo, hi] : covered) {
        EXPECT_LE(lo, reached + 2e-5);  // a control polygon's corners are rounded by about that
        reached = std::max(reached, hi);
    }
}

/// A trail of a spine that lies along x, `b` thick, its broad side along y.
Trail lying_trail(int branch, const Vec2& at, double a, double b) {
    Trail trail{.branch = branch, .strip = true};
    for (const double x : {1e-3, 0.0}) {
        Cut cut{.centre = at + Vec2{x, 0}, .a = a, .b = b};
        cut.e = {0, 1, 0};
        trail.cuts.push_back(cut);
        trail.along.push_back(0.9 + x);
    }
    trail.trunk = 2;
    return trail;
}

/// A strip's hair lies where its places are along its broad side, in whichever axes its section is described.
TEST(WideOutline, HairOfAStripKeepsItsPlaceWhenItsAxesTurn) {
    brush::Preset p = brush::load_preset("flat-12");
    const brush::Bundles bundles = brush::make_bundles(p, 5);
    constexpr double kLean = 0.3;  // radians: the strip's higher edge is also on the surface
    constexpr int kBranch = 2;
    Recycled<Trail> trails{lying_trail(kBranch, {0, 0}, 1e-3, 4e-4)};
    for (Cut& cut : trails[0].cuts) {
        cut.e = {0, std::cos(kLean), std::sin(kLean)}, cut.m = {0, -std::sin(kLean), std::cos(kLean)};
        cut.z = -1e-3;
    }
    const Recycled<HairContactPoint> points = hair_contact_points(trails, bundles, 5);
    ASSERT_GT(points.size(), 4u);
    double least = 1, most = -1;
    for (const HairContactPoint& point : points) {
        const double x = brush::in_branch(bundles, bundles.place[point.bundle], 5).place.x;
        // Its underside is wholly below the surface, so its middle is where it is.
        EXPECT_NEAR(point.at.y, 1e-3 * x * std::cos(kLean), 1e-12);
        least = std::min(least, x), most = std::max(most, x);
    }
    EXPECT_LT(least, -0.4) << "hair of both edges is on the surface";
    EXPECT_GT(most, 0.4);
    for (Cut& cut : trails[0].cuts) cut.e = -cut.e, cut.m = -cut.m, cut.turn = {-1, 0};
    const Recycled<HairContactPoint> turned = hair_contact_points(trails, bundles, 5);
    ASSERT_EQ(turned.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_EQ(turned[i].bundle, points[i].bundle);
        EXPECT_NEAR(glm::distance(turned[i].at, points[i].at), 0, 1e-12);
    }
}

/// Hair lies beside the path where it is set in the ferrule, to whichever side a flat is bent: its sections turn by
/// half a turn with the side.
TEST(WideOutline, HairOfAFlatLiesOnItsOwnSide) {
    for (const char* name : {"flat-12", "filbert-12"}) {
        const brush::Preset p = brush::load_preset(name);
        for (const int way : {1, -1}) {
            const brush::Tuft tuft = brush::make_tuft(p, 5);
            const brush::TuftState state = dragged(tuft, way);
            const brush::ContactPlane plane;
            Recycled<Trail> trails = find_trails(state, kFlat, node_planes(state, std::span(&plane, 1)), p.length, 0);
            fill_rows(trails);
            const Recycled<HairContactPoint> points =
                hair_contact_points(trails, tuft.bundles, static_cast<int>(state.branches.size()));
            ASSERT_GT(points.size(), 20u) << name;
            // Pressed hair spreads by a tenth, and a filbert's toe draws in: a spine's width, 2.4 mm, at most.
            for (const HairContactPoint& point : points)
                EXPECT_NEAR(point.at.x, 0.5 * p.width * tuft.bundles.place[point.bundle].x, 1.2e-3)
                    << name << ' ' << way;
        }
    }
}

/// The strips of two spines that splay meet midway between them, to three times their half-width, at constant area.
TEST(WideOutline, HairBetweenSplayedSpinesMeetsMidway) {
    constexpr double kHalf = 1e-3, kThick = 2e-4, kChord = Trail::kStripChord;
    for (const double apart : {1e-3, 3e-3, 5e-3, 9e-3}) {
        Recycled<Trail> trails{lying_trail(0, {0, 0}, kHalf, kThick), lying_trail(1, {0, apart}, kHalf, kThick)};
        trails[0].openings.push_back({1, {0.0, 0.0}});
        fill_rows(trails);
        const double reach = std::clamp(0.5 * apart, kChord * kHalf, 3 * kChord * kHalf);
        for (const Cut& cut : trails[0].cuts) {
            EXPECT_NEAR(cut.centre.y + kChord * cut.a, reach, 1e-12) << apart;
            EXPECT_NEAR(cut.centre.y - kChord * cut.a, -kChord * kHalf, 1e-12) << apart;
            EXPECT_NEAR(cut.a * cut.b, kHalf * kThick, 1e-18) << apart;
        }
        for (const Cut& cut : trails[1].cuts) EXPECT_NEAR(cut.centre.y - kChord * cut.a, apart - reach, 1e-12) << apart;
    }
}

/// Strips whose hair leans to one side of them, as turned sections have it, begin to spread without a step: their
/// corners go on from where they are.
TEST(WideOutline, LeaningHairBeginsToSpreadWithoutAStep) {
    constexpr double kHalf = 1.6e-3, kThick = 0.8e-3, kTurn = 0.3;
    const auto reach = [&](double apart) {
        Recycled<Trail> trails{lying_trail(0, {0, 0}, kHalf, kThick), lying_trail(1, {0, apart}, kHalf, kThick)};
        for (Trail& trail : trails)
            for (Cut& cut : trail.cuts) {
                // Its broad side along y: the ellipse's axes are turned from it.
                cut.turn = {std::cos(kTurn), -std::sin(kTurn)};
                const double y = std::atan2(kThick * std::sin(kTurn), kHalf * std::cos(kTurn));
                cut.e = {0, std::cos(y), std::sin(y)}, cut.m = {0, -std::sin(y), std::cos(y)};
                cut.z = -2e-3;
            }
        trails[0].openings.push_back({1, {0.0, 0.0}});
        fill_rows(trails);
        double least = 1e9;  // of the outer corners of the first
        for (const Outline& o : outlines_of({&trails[0], 1}, 20, {}))
            for (const Vec2& p : curve_points(o, 8)) least = std::min(least, p.y);
        return least;
    };
    double before = reach(2.5e-3), step = 0, moved = 0;
    for (double apart = 2.5e-3; apart < 4.5e-3; apart += 2e-6) {
        const double now = reach(apart);
        step = std::max(step, std::abs(now - before));
        moved = std::max(moved, std::abs(now - reach(2.5e-3)));
        before = now;
    }
    EXPECT_GT(moved, 0.1e-3) << "it stands up";
    // Over 0.3 of its width, 0.8 mm, at the smooth step's 1.5: 0.2 mm stand up by 1 µm a step.
    EXPECT_LT(step, 5e-6);
}

/// Five strips of a row that stands at 45° to its hair and splays, whose sections have turned about it by `turn`.
Recycled<Trail> aslant_row(double apart, double turn) {
    constexpr double kHalf = 1e-3, kThick = 2e-4;
    Recycled<Trail> trails;
    for (int k = 0; k < 5; ++k) {
        trails.push_back(lying_trail(k, apart * std::sqrt(0.5) * Vec2{k, k}, kHalf, kThick));
        for (Cut& cut : trails.back().cuts) {
            const Vec3 e = cut.e, m = cut.m;
            cut.e = std::cos(turn) * e + std::sin(turn) * m;
            cut.m = std::cos(turn) * m - std::sin(turn) * e;
        }
        if (k > 0) trails[static_cast<std::size_t>(k) - 1].openings.push_back({k, {0.0, 0.0}});
    }
    return trails;
}

/// A row that splays keeps one edge, whichever way it stands to its hair and its sections have turned: strips lie from
/// midway to midway, end to end, on the line through their spines, and keep their area.
TEST(WideOutline, ARowAslantToItsHairKeepsOneEdge) {
    constexpr double kApart = 3e-3, kChord = Trail::kStripChord;
    for (double turn = 0; turn < 1.4; turn += 0.1) {
        Recycled<Trail> trails = aslant_row(kApart, turn);
        fill_rows(trails);
        for (std::size_t k = 1; k + 1 < trails.size(); ++k)
            for (std::size_t i = 0; i < 2; ++i) {
                const Cut &cut = trails[k].cuts[i], &next = trails[k + 1].cuts[i];
                EXPECT_NEAR(glm::length(glm::cross(cut.broad(), cut.thick())), 1e-3 * 2e-4, 1e-16) << turn;
                EXPECT_NEAR(cut.broad().z, 0, 1e-15) << turn;
                const Vec2 end = cut.centre + kChord * Vec2(cut.broad());
                const Vec2 wanted =
                    (static_cast<double>(k) + 0.5) * kApart * std::sqrt(0.5) * Vec2{1, 1} + Vec2{i == 0 ? 1e-3 : 0, 0};
                EXPECT_NEAR(glm::distance(end, wanted), 0, 1e-12) << turn;
                if (k + 2 < trails.size()) {
                    EXPECT_NEAR(glm::distance(end, next.centre - kChord * Vec2(next.broad())), 0, 1e-12) << turn;
                }
            }
    }
}

/// Sections of hair that is bent to the other side have turned by half a turn: the same hair, and spread likewise.
TEST(WideOutline, SectionsTurnedByHalfATurnSpreadAsTheyWere) {
    for (const double longer : {0.0, 0.1})
        for (double turn = 0; turn < 1.4; turn += 0.2) {
            Recycled<Trail> trails = aslant_row(3e-3, turn), turned = aslant_row(3e-3, turn + std::numbers::pi);
            for (Recycled<Trail>* row : {&trails, &turned}) {
                for (std::size_t k = 0; k < row->size(); ++k) (*row)[k].length += longer * static_cast<double>(k);
                fill_rows(*row);
            }
            for (std::size_t k = 0; k < trails.size(); ++k) {
                const Cut &cut = trails[k].cuts[0], &same = turned[k].cuts[0];
                EXPECT_LT(glm::distance(cut.centre, same.centre), 1e-12) << turn << ' ' << longer;
                EXPECT_LT(glm::length(cut.broad() + same.broad()), 1e-12) << turn << ' ' << longer;
                EXPECT_LT(glm::length(cut.thick() + same.thick()), 1e-12) << turn << ' ' << longer;
                EXPECT_NEAR(cut.z, same.z, 1e-12) << turn << ' ' << longer;
            }
        }
}

/// Hair whose ends lie apart because it is longer keeps its own edge, and widens: a row of a filbert's toe.
TEST(WideOutline, HairThatIsLongerKeepsItsOwnEdge) {
    constexpr double kLength = 20e-3, kLonger = 2e-3, kAside = 1.5e-3;
    Recycled<Trail> trails{lying_trail(0, {0, 0}, 1e-3, 2e-4), lying_trail(1, {kLonger, 2 * kAside}, 1e-3, 2e-4)};
    trails[1].length += kLonger / kLength;
    trails[0].openings.push_back({1, {0.0, 0.0}});
    fill_rows(trails);
    for (const Cut& cut : trails[0].cuts) {
        const Vec2 end = cut.centre + Trail::kStripChord * Vec2(cut.broad());
        EXPECT_NEAR(end.y, kAside, 1e-12);
        EXPECT_NEAR(Vec2(cut.broad()).x, 0, 1e-15);
    }
}

/// A stiff blade of the length ℓ that is drawn round a circle of radius R, along it at its middle, marks a stripe wider
/// by ℓ²/8R: the sagitta of its ends.
TEST(WideOutline, AStiffBladeInACurveWidensByItsSagitta) {
    constexpr double kRadius = 60e-3, kWidth = 1.2e-3;
    for (const double length : {10e-3, 20e-3, 30e-3}) {
        Trail blade = lying_trail(0, {0, 0}, 0.5 * kWidth / Trail::kStripChord, 2e-4);
        blade.cuts[0].centre.x = 0.5 * length;
        blade.cuts[1].centre.x = -0.5 * length;
        double least = 1e9, most = 0;
        for (const Outline& o : outlines_of({&blade, 1}, 40))
            for (const Vec2& p : curve_points(o, 8)) {
                const double r = std::hypot(p.x, p.y + kRadius);
                least = std::min(least, r), most = std::max(most, r);
            }
        // The corners lie at √((R + w/2)² + ℓ²/4), 2.5 % less than by the first term at 30 mm; a spline rounds them by
        // up to 0.03 mm.
        const double sagitta = length * length / (8 * kRadius);
        EXPECT_NEAR(most - least - kWidth, sagitta, 0.03 * sagitta + 3e-5) << length;
    }
}

/// Between two poses of hair that leapt, trails follow each other by less than 0.4 of their extent, from the one to
/// the other.
TEST(WideOutline, NoGapIsLeftWhereHairLeapt) {
    const Recycled<Trail> before{lying_trail(2, {0, 0}, 1e-3, 2e-4)}, now{lying_trail(2, {3e-3, 1e-3}, 1e-3, 2e-4)};
    const Recycled<Trail> passed = trails_passed(now, before);
    ASSERT_GT(passed.size(), 2u);
    // Along its hair it is 1 mm long.
    const double most = 0.4 * 1.5e-3;
    Vec2 at = before[0].cuts[0].centre;
    for (const Trail& trail : passed) {
        EXPECT_EQ(trail.branch, 2);
        EXPECT_LT(glm::distance(trail.cuts[0].centre, at), most);
        EXPECT_GT(trail.cuts[0].centre.x, at.x);
        at = trail.cuts[0].centre;
    }
    EXPECT_LT(glm::distance(now[0].cuts[0].centre, at), most);
    EXPECT_TRUE(trails_passed(now, {}).empty());
}

/// The edge of a filbert that is lifted while it goes on runs forward faster than the hand. Its flank is a line: it
/// goes straight from stamp to stamp.
TEST(WideOutline, TheFlankOfALiftedFilbertHasNoTeeth) {
    brush::Tuft tuft = brush::make_tuft(brush::load_preset("filbert-12"), 5);
    const brush::ContactPlane ground;
    const double length = tuft.preset.length;
    constexpr double kStep = 0.1e-3, kBin = 0.05e-3;  // metres: between stamps, between places along the flank
    std::vector<double> flank;                        // metres beside the path, by place along it
    Recycled<Trail> before;
    double end = 0;  // metres along the path, where the flank's hair leaves
    for (int i = 0; i <= 320; ++i) {
        // Pressed within 3 mm, drawn 19 mm along y, lifted within 10 mm.
        const double gone = kStep * i, press = std::min({1.0, gone / 3e-3, (32e-3 - gone) / 10e-3});
        const brush::Pose pose{.position = {0, gone, length - 0.25 * length * press}};
        const brush::TuftState state = brush::step(tuft, pose, std::span(&ground, 1), 3e-3);
        const Recycled<Trail> trails = find_trails(state, kFlat, {}, length, 1e-4);
        const Recycled<Trail> leapt = leapt_trails(trails, kFlat, before, kFlat, {0, kStep});
        before = trails;
        if (trails.empty() || trails.front().branch != 0 || gone < 10e-3) continue;
        for (const Outline& o : outlines_of(trails, 20, leapt))
            for (const Vec2& p : curve_points(o, 16)) {
                const auto k = static_cast<std::size_t>(std::max(0.0, p.y / kBin));
                if (k >= flank.size()) flank.resize(k + 1, 0);
                flank[k] = std::max(flank[k], -p.x);
            }
        end = std::max(end, kFlat.to_local(Vec3(trails.front().cuts.front().centre, 0)).y);
    }
    const auto last = static_cast<std::size_t>((end - 0.5e-3) / kBin);
    ASSERT_GT(last, 400u);
    constexpr std::size_t kReach = 8;  // places, longer than a tooth
    double tooth = 0;
    for (std::size_t k = last - 100; k < last - kReach; ++k)
        tooth = std::max(tooth, 0.5 * (flank[k - kReach] + flank[k + kReach]) - flank[k]);
    // A tenth of a hair's thickness.
    EXPECT_LT(tooth, 0.02e-3);
}

/// Spines that are not joined keep outlines of their own; joined ones get one more between two, and one at the heel.
TEST(WideOutline, OutlinesFollowTheOpenings) {
    brush::TuftState tuft = dragged("flat-12");
    const std::size_t joined = outlines_of(tuft, kFlat).size();
    EXPECT_EQ(joined, 5u + 4u + 1u);
    const double whole = coverage_area(rasterise(outlines_of(tuft, kFlat), kFlat, 0, kCell));
    for (brush::Opening& opening : tuft.openings)
        for (double& o : opening.width) o = 1e-3;
    EXPECT_EQ(outlines_of(tuft, kFlat).size(), 5u);
    EXPECT_LT(coverage_area(rasterise(outlines_of(tuft, kFlat), kFlat, 0, kCell)), whole);
}

}  // namespace
}  // namespace tuft::footprint
