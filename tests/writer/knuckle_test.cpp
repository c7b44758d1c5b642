#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/files/files.h"
#include "writer/fit/edge_response.h"
#include "writer/fit/fairing.h"
#include "writer/fit/ink_score.h"
#include "writer/fit/knuckle_fit.h"
#include "writer/gesture/knuckles.h"
#include "writer/gesture/side_table.h"
#include "writer/gesture/stroke_line.h"

namespace tuft::writer {
namespace {

Ring disc(const Vec2& middle, double radius) {
    Ring ring;
    for (int i = 0; i < 360; ++i) {
        const double a = 2 * 3.14159265358979 * i / 360;
        ring.push_back(middle + radius * Vec2(std::cos(a), std::sin(a)));
    }
    return ring;
}

Cells cells_of(const std::vector<Ring>& rings) {
    const Ring frame{{0, 0}, {400, 200}};
    Cells cells = cells_over(std::span(&frame, 1), 2, 80);
    for (const Ring& ring : rings) fill(cells, std::span(&ring, 1));
    return cells;
}

std::vector<EdgeTurn> turns_of(const Cells& cells, double least) {
    return edge_turns(cells, coverage_of(cells), least);
}

/// A level bar of 40 units with round ends, from 100 to `end`.
std::vector<Ring> bar(double end = 300) {
    return {{{100, 80}, {end, 80}, {end, 120}, {100, 120}}, disc({100, 100}, 20), disc({end, 100}, 20)};
}

// The Gaussian draws a disc of radius r in to r e^(−σ² / 2r²), a twentieth here; the edge between cells of 2 units is
// known to a fifth of a unit, which leaves ripples of a tenth.
TEST(Knuckles, TheTurnsOfADiscAreAsSharpAsItsRadius) {
    const std::vector<EdgeTurn> turns = turns_of(cells_of({disc({200, 100}, 20)}), 0.5 / 20);
    ASSERT_FALSE(turns.empty());
    for (const EdgeTurn& turn : turns) {
        EXPECT_NEAR(turn.curvature * 20, 1, 0.2);
        EXPECT_NEAR(glm::distance(turn.at, Vec2(200, 100)), 20, 2);
    }
    EXPECT_TRUE(turns_of(cells_of({disc({200, 100}, 60)}), kKnuckle).empty());
}

// A swelling is convex at its top and leaves a neck to either side, where the discs' edges meet the bar's.
TEST(Knuckles, ASwellingThatTheAreaHasNotIsOneWithTwoNecksAndElseNone) {
    std::vector<Ring> swollen = bar();
    swollen.push_back(disc({200, 122}, 14));
    const Cells plain = cells_of(bar()), ink = cells_of(swollen);
    const std::vector<EdgeTurn> wanted = turns_of(plain, 0.5 * kKnuckle);
    std::vector<EdgeTurn> knuckles = knuckles_of(ink, coverage_of(ink), wanted);
    ASSERT_EQ(knuckles.size(), 3u);
    std::sort(knuckles.begin(), knuckles.end(), [](const EdgeTurn& a, const EdgeTurn& b) { return a.at.x < b.at.x; });
    const Vec2 places[] = {{186, 120}, {200, 136}, {214, 120}};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_LT(glm::distance(knuckles[i].at, places[i]), 6) << i;  // the Gaussian's σ
        EXPECT_EQ(knuckles[i].curvature > 0, i == 1) << i;
    }
    EXPECT_TRUE(knuckles_of(plain, coverage_of(plain), wanted).empty());
    EXPECT_TRUE(knuckles_of(ink, coverage_of(ink), turns_of(ink, 0.5 * kKnuckle)).empty());
}

// A top of a disc of 14 units and two necks cost at least a knuckle's least curvature each; where other ink lies over
// them nobody sees them.
TEST(Knuckles, ASwellingCostsSharpnessUnlessAnotherStrokeLiesOverIt) {
    std::vector<Ring> swollen = bar();
    swollen.push_back(disc({200, 122}, 14));
    const std::vector<float> plain = coverage_of(cells_of(bar())), ink = coverage_of(cells_of(swollen));
    FitTarget target{.wanted = cells_of(bar()), .weights = {}};
    const std::vector<EdgeTurn> turns = wanted_edge_turns(target.wanted);
    EXPECT_EQ(sharpness_of(target, turns, plain), 0);
    EXPECT_GT(sharpness_of(target, turns, ink), 3);
    target.weights.assign(target.wanted.inside.size(), 0.25f);
    EXPECT_EQ(sharpness_of(target, turns, ink), 0);
}

// The sum whose least value is asked for is a parabola along any line: a step to either side makes it larger. Without a
// wave nothing is to be done, and a wave keeps 1 / (1 + stiffness (2 - 2 cos 2π / L)²) of its height far from the ends.
TEST(Fairing, IsTheLeastSumOfChangesAndBends) {
    std::vector<double> wave, straight;
    for (int i = 0; i < 64; ++i)
        wave.push_back(std::sin(2 * 3.14159265358979 * i / 8)), straight.push_back(3 - 0.5 * i);
    constexpr double kStiffness = 0.7;
    const std::vector<double> fair = faired(wave, kStiffness), same = faired(straight, kStiffness);
    for (std::size_t i = 0; i < straight.size(); ++i) EXPECT_NEAR(same[i], straight[i], 1e-12);
    const double bend = 2 - 2 * std::cos(2 * 3.14159265358979 / 8);
    for (std::size_t i = 24; i < 40; ++i)  // an end is forgotten by 1/e in a station or two
        EXPECT_NEAR(fair[i], wave[i] / (1 + kStiffness * bend * bend), 1e-6);
    const auto sum = [&](const std::vector<double>& x) {
        double all = 0;
        for (std::size_t i = 0; i < x.size(); ++i) all += (x[i] - wave[i]) * (x[i] - wave[i]);
        for (std::size_t i = 1; i + 1 < x.size(); ++i)
            all += kStiffness * (x[i - 1] - 2 * x[i] + x[i + 1]) * (x[i - 1] - 2 * x[i] + x[i + 1]);
        return all;
    };
    EXPECT_EQ(fair.front(), wave.front());
    EXPECT_EQ(fair.back(), wave.back());
    for (std::size_t i = 1; i + 1 < fair.size(); ++i)
        for (const double step : {-1e-3, 1e-3}) {
            std::vector<double> moved = fair;
            moved[i] += step;
            EXPECT_GT(sum(moved), sum(fair)) << i;
        }
    EXPECT_EQ(faired({1, 5, 2}, kStiffness), (std::vector<double>{1, 5, 2}));
}

// 橫撇 and 撇 as a typeface draws them. A correction that follows each wrong cell makes the hand pump at heads and
// corners: in characters a third of all knuckles came from it. The overlap that it gains is less than a hundredth.
TEST(Fairing, AFittedPathPumpsLessAndCoversAsMuch) {
    const SideTable table = SideTable::load(data_folder() / "models" / "writer" / "sides.txt");
    stroke::WidthTables tables;
    const std::string brush = "goat-medium";
    const BrushHand hand{tables.preset(brush), tables.of(brush), tables.holder(brush), 1.3e-4};
    const Glyph glyph{.code = U'x',
                      .strokes = {{.median = {{150, 600}, {160, 590}, {340, 640}, {390, 630}, {370, 580}, {180, 330}}},
                                  {.median = {{600, 800}, {640, 760}, {620, 720}, {520, 600}, {400, 500}}}}};
    for (std::size_t k = 0; k < glyph.strokes.size(); ++k) {
        const StrokeLine line = make_stroke_line(glyph.strokes[k].median);
        const StrokeSides sides = table.predict(line, glyph, k);
        const std::vector<Ring> rings = area_of(line, sides);
        FitTarget target{.wanted = cells_over(rings, 2, 80), .weights = {}};
        for (const Ring& ring : rings) fill(target.wanted, std::span(&ring, 1));
        const std::vector<Station> first = make_stations(line, sides, target.wanted);
        double bends[2] = {}, overlap[2] = {};
        for (const bool fair : {false, true}) {
            const std::vector<Station> s = fit_stations(first, target, hand, {}, {.fair = fair}).stations;
            for (std::size_t i = 1; i + 1 < s.size(); ++i)
                bends[fair] += std::pow(s[i - 1].half - 2 * s[i].half + s[i + 1].half, 2);
            const std::vector<float> ink =
                coverage_by(draw_on_plane(s, hand, {}, 1.5, target.wanted.cell), target.wanted);
            overlap[fair] = score_of(target, std::vector<float>(ink.size(), 1), ink).iou;
        }
        EXPECT_LT(bends[true], 0.6 * bends[false]) << k;
        EXPECT_GT(overlap[true], overlap[false] - 0.01) << k;
    }
}

// Binary cells know their edge to a cell, the distance from cell to cell is handed on
// within a tenth of a unit.
TEST(EdgeResponse, DistancesFromADiscAreThoseOfItsRadius) {
    const Cells cells = cells_of({disc({200, 100}, 40)});
    const std::vector<float> distances = edge_distances(cells, coverage_of(cells));
    double worst = 0, sum = 0;
    int n = 0;
    for (int j = 0; j < cells.height; ++j)
        for (int i = 0; i < cells.width; ++i) {
            const double from = glm::distance(cells.centre(i, j), Vec2(200, 100));
            if (std::abs(from - 40) > 20) continue;
            const double error = double(distances[std::size_t(j) * cells.width + i]) - (40 - from);
            worst = std::max(worst, std::abs(error)), sum += error * error, ++n;
        }
    EXPECT_LT(worst, 2);                                 // a cell
    EXPECT_LT(std::sqrt(sum / n), 2 / std::sqrt(12.0));  // of what is known to a cell of 2 units
}

// The edge of a half plane moves as the numbers say, so the response of two drawings foretells all; of a number whose
// slope was taken wrongly, one more drawing puts it right along the change that was drawn.
TEST(EdgeResponse, ForetellsLinesThatMoveAndLearnsWhatItDoesNotKnow) {
    const auto line = [](double a, double b) {
        std::vector<float> d;
        for (int i = 0; i < 50; ++i) d.push_back(static_cast<float>(i - 20 + 2 * a - 3 * b));
        return d;
    };
    EdgeResponse<2> response(line(0, 0));
    response.set_slope(0, 1, line(1, 0));
    response.set_slope(1, -1, line(0, -1));
    EXPECT_EQ(response.distances({3, 2}), line(3, 2));
    EdgeResponse<2> wrong(line(0, 0));
    wrong.set_slope(0, 1, line(1, 0));
    wrong.learn({0, 2}, line(0, 2), true);
    EXPECT_EQ(wrong.at(), (EdgeResponse<2>::Numbers{0, 2}));
    const std::vector<float> after = wrong.distances({1, 4}), truth = line(1, 4);
    for (std::size_t i = 0; i < truth.size(); ++i) EXPECT_NEAR(after[i], truth[i], 1e-4);
}

/// A straight bar of half width 20 with round ends, and a path that swells by `more` units in its middle.
struct SwollenBar {
    FitTarget target{.wanted = cells_of(bar()), .weights = {}};
    FitResult fitted;

    explicit SwollenBar(double more) {
        for (int k = 0; k <= 30; ++k) {
            const double x = 84 + 8.0 * k, near = std::max(0.0, 1 - std::abs(x - 204) / 40);
            const double end = std::min(x - 80, 320 - x);
            fitted.stations.push_back({{x, 100}, std::min(20.0, 2 + end) + more * near * near});
        }
    }
};

// A stroke that is drawn in three parts, each from where the tuft was bent to, is the stroke that is drawn at once.
TEST(Knuckles, TheInkOfPartsIsThatOfTheWhole) {
    stroke::WidthTables tables;
    const std::string brush = "goat-medium";
    const BrushHand hand{tables.preset(brush), tables.of(brush), tables.holder(brush), 1.3e-4};
    const SwollenBar bar(10);
    const Cells& cells = bar.target.wanted;
    const stroke::StrokeSamples trace = samples_of(bar.fitted.stations, hand, {});
    const double all = trace.samples.back().time;
    stroke::PlaneDrawing drawing(hand.preset, hand.hold, 2.5 * hand.unit, cells.cell * hand.unit);
    const std::vector<float> whole = coverage_by(drawing.draw(trace), cells);
    std::vector<float> parts = coverage_by(drawing.keep(trace, 0.4 * all), cells);
    EXPECT_NE(parts, whole);
    for (const auto& next :
         {coverage_by(drawing.draw_part(trace, 0.7 * all), cells), coverage_by(drawing.draw_rest(trace), cells)})
        for (std::size_t k = 0; k < parts.size(); ++k) parts[k] = std::max(parts[k], next[k]);
    EXPECT_EQ(parts, whole);
}

// By its score less the price of its knuckles (knuckle_fit.h) no stroke may lose; of this one's three knuckles, two at
// its ends and one in its middle, at least one goes. The result states what the whole stroke then reaches, and is the
// same at each run.
TEST(Knuckles, TakenOffOneByOneTheyAreFewerAndTheStrokeIsWorthMore) {
    stroke::WidthTables tables;
    const std::string brush = "goat-medium";
    const BrushHand hand{tables.preset(brush), tables.of(brush), tables.holder(brush), 1.3e-4};
    const FitOptions options;
    const SwollenBar swollen(10);
    const FitTarget& target = swollen.target;
    const std::vector<float> depths(target.wanted.inside.size(), 4.0f);
    const std::vector<EdgeTurn> turns = wanted_edge_turns(target.wanted);
    struct Seen {
        std::size_t knuckles = 0;
        double iou = 0, value = 0;
    };
    const auto seen = [&](const std::vector<Station>& stations) {
        const std::vector<float> coverage =
            coverage_by(draw_on_plane(stations, hand, {}, options.fine_step, target.wanted.cell), target.wanted);
        const std::vector<EdgeTurn> knuckles = seen_knuckles(target, turns, coverage);
        const InkScore reached = score_of(target, depths, coverage);
        return Seen{knuckles.size(), reached.iou, reached.score - 0.002 * sharpness_of(knuckles)};
    };
    FitResult once = swollen.fitted, again = swollen.fitted;
    take_off_knuckles(once, {target, target, depths}, hand, {}, options);
    take_off_knuckles(again, {target, target, depths}, hand, {}, options);
    const Seen before = seen(swollen.fitted.stations), after = seen(once.stations);
    EXPECT_LT(after.knuckles, before.knuckles);
    EXPECT_GT(after.value, before.value);
    EXPECT_EQ(after.iou, once.iou);
    ASSERT_EQ(once.stations.size(), again.stations.size());
    for (std::size_t i = 0; i < once.stations.size(); ++i) {
        EXPECT_EQ(once.stations[i].centre, again.stations[i].centre);
        EXPECT_EQ(once.stations[i].half, again.stations[i].half);
    }
}

}  // namespace
}  // namespace tuft::writer
