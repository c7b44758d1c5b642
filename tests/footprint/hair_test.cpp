#include "footprint/outline/hair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "brush/tuft/tuft.h"
#include "footprint/outline/slip.h"

namespace tuft::footprint {
namespace {

const Frame kFlat;  // the plane z = 0
constexpr double kCell = 5e-5;
const PicturePlane kPlane{kFlat, 0, kCell};

struct Pressed {
    brush::Tuft tuft;
    brush::TuftState state;
    Recycled<Trail> trails;
    Recycled<Outline> outlines;
};

/// A full tuft dragged along x until it lies steadily.
const Pressed& pressed() {
    static const Pressed made = [] {
        Pressed p;
        p.tuft = brush::make_tuft(brush::load_preset("mixed-medium"), 11);
        const double length = p.tuft.preset.length;
        const brush::ContactPlane plane;
        for (int i = 0; i <= 200; ++i) {
            brush::Pose pose;
            pose.position = {2e-4 * i - 0.03, 0, length * (1.01 - 0.3 * std::min(1.0, i / 60.0))};
            p.state = brush::step(p.tuft, pose, {&plane, 1}, 0.01);
        }
        p.trails = find_trails(p.state, kFlat, {}, length, 1e-4);
        for (const Trail& t : p.trails) p.outlines.push_back(outline_of(t, 20));
        return p;
    }();
    return made;
}

double area_of(const Footprint& f) {
    double sum = 0;
    for (const std::uint8_t c : f.coverage) sum += c / 255.0;
    return sum * f.cell * f.cell;
}

Footprint marks(const brush::Bundles& bundles, double wet, double travel = 0) {
    const Pressed& p = pressed();
    const Recycled<double> all(bundles.place.size(), wet);
    return draw_hair_marks({p.trails, p.outlines, bundles}, {all, travel}, kPlane).footprint;
}

TEST(Hair, WetHairCoversTheOutline) {
    const Pressed& p = pressed();
    ASSERT_EQ(p.trails.size(), 1u);
    const Footprint whole = rasterise(p.outlines, kFlat, 0, kCell);
    const Footprint wet = marks(p.tuft.bundles, 1);
    ASSERT_EQ(whole.coverage.size(), wet.coverage.size());
    int worst = 0;
    for (std::size_t i = 0; i < whole.coverage.size(); ++i)
        worst = std::max(worst, std::abs(int(whole.coverage[i]) - int(wet.coverage[i])));
    EXPECT_LE(worst, 13) << "of 255: clusters of a band overlap or miss a little where it bends";
}

TEST(Hair, MarksCloseIntoTheOutlineAsTheyGetWet) {
    // So that a tuft may be drawn in one closed shape from wetness 1 on, and nothing jumps there.
    const brush::Bundles& bundles = pressed().tuft.bundles;
    const Footprint closed = marks(bundles, 1);
    const auto open = [&](double wet) {
        const Footprint f = marks(bundles, wet, 5e-3);
        double sum = 0;
        for (std::size_t i = 0; i < f.coverage.size(); ++i)
            sum += std::abs(int(closed.coverage[i]) - int(f.coverage[i])) / 255.0;
        return sum * f.cell * f.cell / area_of(closed);
    };
    EXPECT_GT(open(0.8), 0.02);
    // Pieces of a band overlap or miss a little where it bends, by 0.0015 of the area if the point is fine (0.09 mm). A
    // blunt one (0.25 mm) ends in a half-disc of 0.002 of the area, or more pressed flat, which they do not have.
    for (const double wet : {0.9, 0.97, 0.999}) EXPECT_LT(open(wet), 4e-3) << wet;
}

TEST(Hair, LessInkCoversLess) {
    double before = area_of(marks(pressed().tuft.bundles, 1));
    const double whole = before;
    for (double wet = 0.9; wet > 0; wet -= 0.1) {
        const double area = area_of(marks(pressed().tuft.bundles, wet));
        EXPECT_LT(area, before) << wet;
        before = area;
    }
    EXPECT_LT(before, 0.15 * whole);
    EXPECT_GT(area_of(marks(pressed().tuft.bundles, 0.5)), 0.25 * whole);
    EXPECT_LT(area_of(marks(pressed().tuft.bundles, 0.5)), 0.85 * whole);
    EXPECT_EQ(area_of(marks(pressed().tuft.bundles, 0)), 0);
}

TEST(Hair, SplayedHairGivesInkFromItsWholeLowerHalf) {
    // A splayed tip is as wide as the belly, but for round-off, and has no height: which bristles are
    // the lower ones must not hang on which of them is taken, or on a touch of lean.
    const Pressed& p = pressed();
    const Recycled<double> wet(p.tuft.bundles.place.size(), 0.5);
    // Drawn on for the length of the patch, the tip has the width of the belly.
    const double length = p.tuft.preset.length, patch = (p.trails[0].along.front() - p.trails[0].along.back()) * length;
    HairTracks tracks;
    for (double slid = 0; slid < patch + 1e-3; slid += 1e-4) {
        Recycled<Trail> now = p.trails;
        spread_trails(now, tracks, {slid, length});
    }
    const auto area = [&](double lean, double more) {
        Recycled<Trail> leaning = p.trails;
        HairTracks own = tracks;
        spread_trails(leaning, own, {patch + 1e-3, length});
        for (std::size_t i = 0; i < leaning[0].cuts.size(); ++i) {
            Cut& cut = leaning[0].cuts[i];
            cut.e.z += lean;
            if (i < 4) cut.a *= 1 + more;
        }
        Recycled<Outline> outlines{outline_of(leaning[0], 20)};
        return area_of(draw_hair_marks({leaning, outlines, p.tuft.bundles}, {wet, 0}, kPlane).footprint);
    };
    const double straight = area(0, 0);
    for (const double lean : {-1e-4, 1e-4})
        for (const double more : {-1e-12, 1e-12})
            EXPECT_NEAR(area(lean, more), straight, 0.02 * straight) << lean << " " << more;
}

TEST(Hair, AnotherSeedDrawsOtherStreaksOfTheSameSum) {
    const brush::Preset& preset = pressed().tuft.preset;
    const Footprint a = marks(brush::make_bundles(preset, 1), 0.5), b = marks(brush::make_bundles(preset, 2), 0.5);
    ASSERT_EQ(a.coverage.size(), b.coverage.size());
    double difference = 0;
    for (std::size_t i = 0; i < a.coverage.size(); ++i) difference += std::abs(a.coverage[i] - b.coverage[i]) / 255.0;
    EXPECT_GT(difference * kCell * kCell, 0.3 * area_of(a));
    EXPECT_EQ(a.coverage, marks(brush::make_bundles(preset, 1), 0.5).coverage);
}

TEST(Hair, StreaksRunAlongTheHair) {
    // A drag along x sums columns: streaks along x keep rows apart, and hardly change along them.
    const Footprint f = marks(pressed().tuft.bundles, 0.5);
    double along = 0, across = 0;
    const auto at = [&](int i, int j) { return f.coverage[std::size_t(j) * f.width + i] / 255.0; };
    for (int j = f.height / 4; j < 3 * f.height / 4; ++j)
        for (int i = f.width / 4; i < 3 * f.width / 4; ++i) {
            along += std::abs(at(i + 1, j) - at(i, j));
            across += std::abs(at(i, j + 1) - at(i, j));
        }
    EXPECT_LT(along, 0.35 * across);
}

TEST(Hair, MirroredHairDrawsTheMirroredPicture) {
    // The tuft lies along x with e along ± y: mirrored bristles are those with −x.
    brush::Bundles bundles = pressed().tuft.bundles, mirrored = bundles;
    for (brush::Bristle& b : mirrored.bristles) b.place.x = -b.place.x;
    for (Vec2& p : mirrored.place) p.x = -p.x;
    const Footprint a = marks(bundles, 0.6), b = marks(mirrored, 0.6);
    const double sum = area_of(a);
    EXPECT_NEAR(area_of(b), sum, 2e-3 * sum) << "the picture's cells lie otherwise to both";
    // First moments across the drag are opposite.
    const auto moment = [](const Footprint& f) {
        double m = 0;
        for (int j = 0; j < f.height; ++j)
            for (int i = 0; i < f.width; ++i)
                m += f.coverage[std::size_t(j) * f.width + i] / 255.0 * (f.lo.y + (j + 0.5) * f.cell);
        return m * f.cell * f.cell;
    };
    EXPECT_NEAR(moment(a), -moment(b), 2e-3 * sum * pressed().tuft.preset.radius);
}

TEST(Hair, SeparatedBundlesLeaveGapsBetweenThem) {
    double together_area = 0, parted_area = 0;
    for (const std::uint64_t seed : {11, 12, 13, 14}) {
        SCOPED_TRACE(seed);
        brush::Bundles together = brush::make_bundles(pressed().tuft.preset, seed), parted = together;
        std::fill(parted.separation.begin(), parted.separation.end(), 1.0);
        for (const double wet : {0.3, 0.5, 0.7}) {
            together_area += area_of(marks(together, wet));
            parted_area += area_of(marks(parted, wet));
        }
        EXPECT_EQ(marks(parted, 1).coverage, marks(together, 1).coverage) << "ink closes them";
    }
    EXPECT_LT(parted_area, 0.98 * together_area);
}

TEST(Hair, DriesIntoThreadsOfItsOwnWidth) {
    // A bristle alone leaves 2 · 45 µm, whatever it holds, or nothing.
    brush::Bundles one = pressed().tuft.bundles;
    one.bristles.resize(1);
    one.bristles[0].place = {0, 0};
    one.bristles[0].readiness = 1;
    one.bristles[0].end = 1;
    double before = -1;
    for (const double wet : {0.45, 0.5, 0.6, 0.7}) {
        const Footprint f = marks(one, wet);
        double most = 0, length = 0;
        for (int i = 0; i < f.width; ++i) {
            double column = 0;
            for (int j = 0; j < f.height; ++j)
                column += f.coverage[static_cast<std::size_t>(j) * f.width + i] / 255.0 * f.cell;
            most = std::max(most, column);
            length += column > 40e-6 ? f.cell : 0;
        }
        EXPECT_NEAR(most, 90e-6, 4e-6) << wet << ": its slope, and cells of 1/255";
        EXPECT_GE(length, before) << "the wetter it is, the more of it touches";
        before = length;
    }
    one.bristles[0].readiness = 0;
    EXPECT_EQ(area_of(marks(one, 0.3)), 0);
}

TEST(Hair, DrawnSidewaysHasInkForNoWiderAPath) {
    // The tuft lies along x: drawn along y its bristles would paint with their whole length.
    const Pressed& p = pressed();
    const Recycled<double> wet(p.tuft.bundles.place.size(), 0.5);
    const auto area = [&](const Vec2& direction) {
        return area_of(draw_hair_marks({p.trails, p.outlines, p.tuft.bundles}, {wet, 0, direction}, kPlane).footprint);
    };
    EXPECT_NEAR(area({1, 0}), area({0, 0}), 0.02 * area({0, 0})) << "a drag along the hair, which is bent a little";
    EXPECT_LT(area({0, 1}), 0.3 * area({1, 0}));
    EXPECT_GT(area({0, 1}), 0);
}

TEST(Hair, MovingSidewaysByItselfHasInkForNoWiderAPath) {
    // The hand stands; hair that goes aside, or spreads, or turns about a point, leaves no more than lying hair of its
    // width drawn that way, and hair that goes along itself leaves what a drag does.
    const Pressed& p = pressed();
    const Recycled<double> wet(p.tuft.bundles.place.size(), 0.4);
    const auto area = [&](const std::function<void(Cut&)>& was) {
        Recycled<Trail> before = p.trails;
        for (Trail& trail : before)
            for (Cut& cut : trail.cuts) was(cut);
        return area_of(draw_hair_marks({p.trails, p.outlines, p.tuft.bundles}, {wet, 0, {}, before}, kPlane).footprint);
    };
    const double stays = area([](Cut&) {}), along = area([](Cut&c) { c.centre.x -= 3e-5; });
    EXPECT_NEAR(along, stays, 0.02 * stays);
    EXPECT_LT(area([](Cut& c) { c.centre.y -= 3e-5; }), 0.3 * stays) << "aside";
    // About a tenth of the bristles stand in the middle, where nothing goes aside.
    EXPECT_LT(area([](Cut& c) { c.a *= 0.98; }), 0.45 * stays) << "spreads";
}

TEST(Hair, SweptAsideByAPressDrawsNoLine) {
    // The tuft goes along itself while it is pressed: hair that follows leaves what it leaves in a drag, hair that
    // spreads by 20 degrees and more leaves next to nothing, and a full tuft closes all the same.
    const Pressed& p = pressed();
    const auto area = [&](double wetness, double lands, const std::function<void(Cut&)>& was, double swings = 0,
                          const Vec2& direction = {1, 0}) {
        const Recycled<double> wet(p.tuft.bundles.place.size(), wetness);
        Recycled<Trail> before = p.trails;
        for (Trail& trail : before)
            for (Cut& cut : trail.cuts) was(cut);
        const HairInk ink{wet, 0, direction, before, lands, {1, 0}, swings};
        return area_of(draw_hair_marks({p.trails, p.outlines, p.tuft.bundles}, ink, kPlane).footprint);
    };
    const auto follows = [](Cut& c) { c.centre.x -= 3e-5; };
    const auto aside = [](Cut& c) { c.centre.x -= 3e-5, c.centre.y -= 2e-5; };
    EXPECT_NEAR(area(0.5, 1, follows), area(0.5, 0, follows), 0.02 * area(0.5, 0, follows));
    EXPECT_LT(area(0.5, 1, aside), 0.1 * area(0.5, 0, aside));
    EXPECT_EQ(area(1, 1, aside), area(1, 0, aside));
    // Nor does any hair of a tuft that swings round as a whole, whatever way it goes just now,
    const Vec2 with_it = glm::normalize(Vec2{3, 2});
    EXPECT_LT(area(0.5, 1, aside, 0, with_it), 0.1 * area(0.5, 0, aside, 0, with_it));
    EXPECT_LT(area(0.5, 1, follows, 0.6), 0.1 * area(0.5, 0, follows));
    EXPECT_EQ(area(0.5, 0, follows, 0.6), area(0.5, 0, follows));
    // but one that trails behind the hand round a curve, along itself, goes on.
    EXPECT_NEAR(area(0.5, 1, follows, 0.3), area(0.5, 0, follows), 0.02 * area(0.5, 0, follows));
}

TEST(Hair, TransportedTrailsKeepTheirPositions) {
    Recycled<Trail> trails = pressed().trails;
    Frame other;
    other.origin = {1e-3, -2e-3, 0};
    other.t = {0.6, 0.8, 0};
    other.b = {-0.8, 0.6, 0};
    change_frame(trails, kFlat, other);
    for (std::size_t i = 0; i < trails[0].cuts.size(); ++i) {
        const Cut &now = trails[0].cuts[i], &was = pressed().trails[0].cuts[i];
        EXPECT_NEAR(glm::distance(Vec2(other.to_world(Vec3(now.centre, 0))), was.centre), 0, 1e-15);
        EXPECT_NEAR(glm::distance(now.e.x * other.t + now.e.y * other.b + now.e.z * other.n, was.e), 0, 1e-12);
    }
}

TEST(Hair, FollowsInItsTrack) {
    // What lies on the surface stays as wide when the tuft is pressed or lifted on the spot, and is drawn out by what
    // the hair before it was.
    const Pressed& p = pressed();
    const double length = p.tuft.preset.length;
    const Trail& lying = p.trails[0];
    std::size_t widest = lying.cuts.size() - 1;
    for (std::size_t i = widest; i-- > 0;)
        if (lying.cuts[i].a > lying.cuts[widest].a) widest = i;
    HairTracks tracks;
    Recycled<Trail> now = p.trails;
    spread_trails(now, tracks, {0, length});
    // A track has a place every 25 µm, over which the very tip grows from nothing.
    const auto near_tip = [&](std::size_t i) { return (lying.along[0] - lying.along[i]) * length < 5e-5; };
    for (std::size_t i = 0; i < widest; ++i) {
        if (near_tip(i)) continue;
        EXPECT_NEAR(now[0].cuts[i].a, lying.cuts[i].a, 0.01 * lying.cuts[widest].a) << i;
    }
    now = p.trails;
    for (Cut& cut : now[0].cuts) cut.a *= 1.5;  // pressed
    spread_trails(now, tracks, {0, length});
    for (std::size_t i = 0; i < widest; ++i) {
        if (near_tip(i)) continue;
        EXPECT_NEAR(now[0].cuts[i].a, lying.cuts[i].a, 0.01 * lying.cuts[widest].a) << i;
    }
    // Half way drawn on, the front half of the patch is as wide as the belly.
    const double patch = (lying.along[0] - lying.along[widest]) * length;
    for (double slid = 0; slid <= 0.5 * patch; slid += 1e-4) {
        now = p.trails;
        spread_trails(now, tracks, {slid, length});
    }
    for (std::size_t i = 0; i < widest; ++i) {
        const double behind = (lying.along[i] - lying.along[widest]) * length;
        const double wanted = lying.cuts[widest].a;
        if (behind < 0.45 * patch) {
            EXPECT_NEAR(now[0].cuts[i].a, wanted, 0.03 * wanted) << behind / patch;
        }
        if (behind > 0.95 * patch) {
            EXPECT_LT(now[0].cuts[i].a, 0.9 * wanted) << behind / patch;
        }
    }
}

TEST(Hair, LeavesTheSurfaceWithTheLiftedTuft) {
    // Drawn on, splayed hair is as wide at its ends as the belly; of a tuft whose last millimetres lie it fans out by
    // 0.35 of what lies to either side at most, until it leaves with the tip.
    const Pressed& p = pressed();
    const double length = p.tuft.preset.length, drawn = length + 5e-3;
    HairTracks tracks;
    Recycled<Trail> now;
    for (double slid = 0; slid <= drawn; slid += 1e-4) {
        now = p.trails;
        spread_trails(now, tracks, {slid, length});
    }
    const double belly = now[0].cuts[12].a;
    for (const double lies : {4e-3, 2e-3, 1e-3}) {
        now = p.trails;
        Trail& trail = now[0];
        std::size_t n = 0;
        while (n < trail.cuts.size() && (trail.along[0] - trail.along[n]) * length < lies) ++n;
        trail.cuts.resize(n);
        trail.along.resize(n);
        trail.trunk = n;
        double widest = 0;
        for (Cut& cut : trail.cuts) widest = std::max(widest, cut.a *= 0.5);
        ASSERT_LT(widest + 0.35 * lies, 0.8 * belly);
        spread_trails(now, tracks, {drawn, length});
        for (const Cut& cut : trail.cuts) EXPECT_LE(cut.a, widest + 0.35 * lies + 1e-12) << lies;
        EXPECT_GT(trail.cuts[n / 4].a, widest) << lies;  // it still fans out
    }
}

TEST(Hair, ATrackIsAsWideWhateverTheSteps) {
    // Places of a track and steps of the hand used to beat: the tip of a steady drag went in and out every few dozen
    // stamps.
    const Pressed& p = pressed();
    const double length = p.tuft.preset.length, drawn = length + 5e-3;
    double least = 1, most = 0;
    for (const double step : {1.9e-5, 4.9e-5, 1.3e-4}) {
        HairTracks tracks;
        for (double slid = 0; slid <= drawn; slid += step) {
            Recycled<Trail> now = p.trails;
            spread_trails(now, tracks, {slid, length});
            if (slid < length) continue;
            least = std::min(least, now[0].cuts[12].a);
            most = std::max(most, now[0].cuts[12].a);
        }
    }
    EXPECT_GT(least, 0);
    EXPECT_LT(most - least, 1e-9) << "of " << most;
}

TEST(Hair, EndsOfBristlesFollowTheirLengths) {
    // They used to end at the next of a dozen sections, many on one line across the tuft.
    brush::Bundles one = pressed().tuft.bundles;
    one.bristles.resize(1);
    one.bristles[0].place = {0, 0};
    one.bristles[0].readiness = 1;
    const Trail& trail = pressed().trails[0];
    Recycled<double> ends;
    for (double part = 0.2; part < 0.8; part += 0.01) {
        one.bristles[0].end =
            static_cast<float>(trail.along.back() + part * (trail.along.front() - trail.along.back()));
        const Footprint f = marks(one, 0.4);  // too dry for water to draw it to the point
        double end = -1;                      // the tip trails at smaller x: cells from the root's side
        for (int i = 0; i < f.width; ++i) {
            int most = 0;
            for (int j = 0; j < f.height; ++j)
                most = std::max<int>(most, f.coverage[static_cast<std::size_t>(j) * f.width + i]);
            if (most > 40) {
                end = -i * f.cell;
                break;
            }
        }
        if (!ends.empty()) {
            EXPECT_LE(std::abs(end - ends.back()), 5 * kCell)
                << part << " " << end / kCell;  // a hundredth of the patch is 2 cells
        }
        ends.push_back(end);
    }
    EXPECT_GT(ends.back() - ends.front(), 40 * kCell);
}

TEST(Hair, BristlesRollOffAndOnAsTheyAreDrawn) {
    const brush::Bundles& b = pressed().tuft.bundles;
    const Footprint here = marks(b, 0.5, 0), near = marks(b, 0.5, 1e-5), far = marks(b, 0.5, 0.05);
    const auto difference = [](const Footprint& p, const Footprint& q) {
        double sum = 0;
        for (std::size_t i = 0; i < p.coverage.size(); ++i) sum += std::abs(p.coverage[i] - q.coverage[i]) / 255.0;
        return sum;
    };
    EXPECT_GT(difference(here, far), 10 * difference(here, near)) << "slowly";
}

TEST(Hair, TouchedCellsAreThoseOfTheLowerSideNearTheTip) {
    const Pressed& p = pressed();
    const brush::HairCells cells = brush::hair_cells(p.tuft.preset);
    const Recycled<float> touched = contact_cells(p.trails, p.tuft.bundles, 1, cells.ends);
    ASSERT_EQ(touched.size(), p.tuft.bundles.place.size() * cells.ends.size());
    double sum = 0, root = 0;
    int bundles = 0;
    for (std::size_t k = 0; k < p.tuft.bundles.place.size(); ++k) {
        double own = 0;
        for (std::size_t c = 0; c < cells.ends.size(); ++c)
            own += static_cast<double>(touched[k * cells.ends.size() + c]);
        root += static_cast<double>(touched[k * cells.ends.size()]);
        sum += own;
        bundles += own > 0;
    }
    EXPECT_NEAR(sum, 1, 1e-6);
    EXPECT_EQ(root, 0) << "the hair at the ferrule is in the air";
    EXPECT_GT(bundles, 10);
    EXPECT_LT(bundles, 26) << "the lower half of 40";
}

TEST(Hair, AFullTuftClosesAtAnyHandsSpeed) {
    for (const double holds : {0.75, 1.25}) EXPECT_GE(wetness_of_bundle(1, holds, 0.5), 1);
    EXPECT_LT(wetness_of_bundle(0.5, 1, 0.4), wetness_of_bundle(0.5, 1, 0.05)) << "fast hair is drier";
    EXPECT_EQ(wetness_of_bundle(0, 1, 0), 0);
}

/// Hair of a filbert that is hardly dry is one patch: ink spans the wedges between hairs of its toe, where no hair
/// lies.
TEST(Hair, HardlyDryHairOfAFilbertIsClosed) {
    brush::Tuft tuft = brush::make_tuft(brush::load_preset("filbert-12"), 5);
    const brush::ContactPlane ground;
    const double length = tuft.preset.length;
    brush::TuftState state;
    for (int i = 0; i <= 300; ++i) {
        const double gone = 0.1e-3 * i, press = std::min({1.0, gone / 3e-3, 0.3 + (30e-3 - gone) / 10e-3});
        state = brush::step(tuft, {.position = {0, gone, length - 0.25 * length * press}}, std::span(&ground, 1), 3e-3);
    }
    const Recycled<Trail> trails = find_trails(state, kFlat, {}, length, 1e-4);
    const Recycled<Outline> outlines = outlines_of(trails, 20);
    const TouchingHair hair{trails, outlines, tuft.bundles, static_cast<int>(state.branches.size())};
    const Recycled<double> wet(tuft.bundles.place.size(), 0.999);
    const auto area = [&](double apart) {
        HairInk ink{wet, 0, {0, 1}};
        ink.apart = apart;
        return area_of(draw_hair_marks(hair, ink, kPlane).footprint);
    };
    const double closed = area_of(rasterise(outlines, kFlat, 0, kCell));
    EXPECT_LT(area(1), 0.9 * closed) << "there are wedges";
    EXPECT_DOUBLE_EQ(area(0), closed);
    EXPECT_NEAR(area(0.5), 0.5 * (area(0) + area(1)), 0.005 * closed) << "levels of 1/255";
}

/// A flat whose ink is on its lower side stands up as it is lifted, and over to the other side by a little: the hair on
/// which it lay goes on giving ink, not all of the other side at once.
TEST(Hair, ARowThatStandsKeepsTheSideOnWhichItLay) {
    brush::Tuft tuft = brush::make_tuft(brush::load_preset("flat-12"), 5);
    const brush::ContactPlane ground;
    const double length = tuft.preset.length;
    brush::TuftState state;
    for (int i = 0; i <= 40; ++i)
        state = brush::step(tuft, {.position = {0, 0.5e-3 * i, length * (1 - 0.2 * std::min(1.0, i / 20.0))}},
                            std::span(&ground, 1), 3e-3);
    Recycled<Trail> trails = find_trails(state, kFlat, {}, length, 1e-4);
    const auto branches = static_cast<int>(state.branches.size());
    Recycled<signed char> sides;
    keep_sides(trails, sides);
    ASSERT_EQ(sides.size(), static_cast<std::size_t>(branches));
    Recycled<double> wet(tuft.bundles.place.size(), 0);
    for (std::size_t k = 0; k < wet.size(); ++k) {
        const brush::BranchPlace at = brush::in_branch(tuft.bundles, tuft.bundles.place[k], branches);
        if (sides[at.branch] * at.place.y < 0) wet[k] = 0.6;
    }
    const Recycled<Outline> outlines = outlines_of(trails, 20);
    const auto area = [&](std::span<const signed char> kept) {
        HairInk ink{wet, 0, {0, 1}};
        ink.sides = kept;
        return area_of(draw_hair_marks({trails, outlines, tuft.bundles, branches}, ink, kPlane).footprint);
    };
    const double lying = area({});
    ASSERT_GT(lying, 0);
    EXPECT_EQ(area(sides), lying);
    for (Trail& trail : trails)
        for (Cut& cut : trail.cuts) cut.e.z *= -0.1, cut.m.z *= -0.1;
    keep_sides(trails, sides);
    EXPECT_GT(area(sides), 0.6 * lying) << "places on the thickness are others";
    EXPECT_LT(area({}), 0.3 * lying) << "bundles reach over the middle";
    for (Trail& trail : trails)
        for (Cut& cut : trail.cuts) cut.e.z *= 9, cut.m.z *= 9;
    keep_sides(trails, sides);
    EXPECT_LT(area(sides), 0.3 * lying) << "laid over";
}

}  // namespace
}  // namespace tuft::footprint
