#include "footprint/hair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "brush/tuft.h"

namespace tuft::footprint {
namespace {

const Frame kFlat;  // the plane z = 0
constexpr double kCell = 5e-5;

struct Pressed {
    brush::Tuft tuft;
    brush::TuftState state;
    std::vector<Trail> trails;
    std::vector<Outline> outlines;
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
        p.trails = trails(p.state, kFlat, {}, length, 1e-4);
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
    const std::vector<double> all(bundles.place.size(), wet);
    return hair_marks(p.trails, p.outlines, bundles, 1, {all, travel}, kFlat, 0, kCell).footprint;
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
    EXPECT_LE(worst, 13) << "of 255: pieces of a band overlap or miss a little where it bends";
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
    const std::vector<double> wet(p.tuft.bundles.place.size(), 0.5);
    const auto area = [&](double lean, double more) {
        std::vector<Trail> leaning = p.trails;
        splay(leaning, 1);
        for (std::size_t i = 0; i < leaning[0].cuts.size(); ++i) {
            Cut& cut = leaning[0].cuts[i];
            cut.e.z += lean;
            if (i < 4) cut.a *= 1 + more;
        }
        std::vector<Outline> outlines{outline_of(leaning[0], 20)};
        return area_of(hair_marks(leaning, outlines, p.tuft.bundles, 1, {wet, 0}, kFlat, 0, kCell).footprint);
    };
    const double straight = area(0, 0);
    for (const double lean : {-1e-4, 1e-4})
        for (const double more : {-1e-12, 1e-12}) EXPECT_NEAR(area(lean, more), straight, 0.02 * straight) << lean << " " << more;
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

/// Lateral places of the bristles that give ink, sorted: those of the lower half of the widest section.
std::vector<double> lower_places(const brush::Bundles& bundles) {
    const auto& cuts = pressed().trails[0].cuts;
    const Cut* widest = &cuts.back();
    for (std::size_t i = cuts.size(); i-- > 0;)
        if (cuts[i].a > (1 + 1e-6) * widest->a) widest = &cuts[i];
    std::vector<double> x;
    for (const brush::Bristle& b : bundles.bristles) {
        const Vec2 at = brush::place_of(bundles, b);
        if (widest->a * at.x * widest->e.z + widest->b * at.y * widest->m.z <= 0) x.push_back(at.x);
    }
    std::sort(x.begin(), x.end());
    return x;
}

/// Part of the section's width, -1 to 1, that ink covers which reaches 3 spacings at half wetness: 3 · 2/n ·
/// w/(1 - w) to both sides of each place.
double covered_part(const std::vector<double>& x, double wet) {
    const double reach = 3 * 2.0 / static_cast<double>(x.size()) * wet / (1 - wet);
    double covered = 0, end = -1;
    for (const double at : x) {
        const double lo = std::max(end, at - reach), hi = std::min(1.0, at + reach);
        covered += std::max(0.0, hi - lo);
        end = std::max(end, hi);
    }
    return 0.5 * covered;
}

TEST(Hair, PartedBundlesLeaveGapsBetweenThem) {
    for (const std::uint64_t seed : {11, 12, 13}) {
        SCOPED_TRACE(seed);
        brush::Bundles together = brush::make_bundles(pressed().tuft.preset, seed), parted = together;
        std::fill(parted.apart.begin(), parted.apart.end(), 1.0);
        for (const double wet : {0.3, 0.5}) EXPECT_LT(area_of(marks(parted, wet)), area_of(marks(together, wet))) << wet;
        EXPECT_EQ(marks(parted, 1).coverage, marks(together, 1).coverage) << "ink closes them";
        // With all bristles ready none stops above a wetness of 0.33, and only the ink's reach over the gaps counts.
        for (brush::Bundles* b : {&together, &parted})
            for (brush::Bristle& bristle : b->bristles) bristle.readiness = 1;
        const std::vector<double> near = lower_places(together), apart = lower_places(parted);
        for (const double wet : {0.35, 0.4, 0.5, 0.6, 0.7, 0.8}) {
            const double share = area_of(marks(parted, wet)) / area_of(marks(together, wet));
            EXPECT_LT(share, 1) << wet;
            // Hair in the middle, where parting opens less, lies on the sheet a little longer than at the sides.
            EXPECT_NEAR(share, covered_part(apart, wet) / covered_part(near, wet), 0.03) << wet;
        }
    }
}

TEST(Hair, EndsOfBristlesFollowTheirLengths) {
    // They used to end at the next of a dozen sections, many on one line across the tuft.
    brush::Bundles one = pressed().tuft.bundles;
    one.bristles.resize(1);
    one.bristles[0].place = {0, 0};
    one.bristles[0].readiness = 1;
    const Trail& trail = pressed().trails[0];
    std::vector<double> ends;
    for (double part = 0.2; part < 0.8; part += 0.01) {
        one.bristles[0].end = static_cast<float>(trail.along.back() + part * (trail.along.front() - trail.along.back()));
        const Footprint f = marks(one, 0.4);  // too dry for water to draw it to the point
        double end = -1;                      // the tip trails at smaller x: cells from the root's side
        for (int i = 0; i < f.width; ++i) {
            int most = 0;
            for (int j = 0; j < f.height; ++j) most = std::max<int>(most, f.coverage[static_cast<std::size_t>(j) * f.width + i]);
            if (most > 40) {
                end = -i * f.cell;
                break;
            }
        }
        if (!ends.empty()) {
            EXPECT_LE(std::abs(end - ends.back()), 5 * kCell) << part << " " << end / kCell;  // a hundredth of the patch is 2 cells
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
    const std::vector<float> touched = touched_cells(p.trails, p.tuft.bundles, 1, cells.ends);
    ASSERT_EQ(touched.size(), p.tuft.bundles.place.size() * cells.ends.size());
    double sum = 0, root = 0;
    int bundles = 0;
    for (std::size_t k = 0; k < p.tuft.bundles.place.size(); ++k) {
        double own = 0;
        for (std::size_t c = 0; c < cells.ends.size(); ++c) own += static_cast<double>(touched[k * cells.ends.size() + c]);
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

}  // namespace
}  // namespace tuft::footprint
