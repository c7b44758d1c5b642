#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "writer/fit/knuckle_fit.h"
#include "writer/gesture/knuckles.h"

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

// Stations that are too wide swell the stroke; the knuckles of what the fit returns are fewer or blunter.
TEST(Knuckles, TheFitTakesASwellingOff) {
    stroke::WidthTables tables;
    const std::string brush = "goat-medium";
    const BrushHand hand{tables.preset(brush), tables.of(brush), tables.holder(brush), 1.3e-4};
    const FitTarget target{.wanted = cells_of(bar(220)), .weights = {}};
    const std::vector<EdgeTurn> wanted = turns_of(target.wanted, 0.5 * kKnuckle);
    std::vector<Station> stations;
    for (double x = 90; x <= 226; x += 8) stations.push_back({{x, 100}, std::min(18.0, 6 + 0.5 * (x - 90))});
    stations[9].half = 23, stations[9].centre.y = 103;
    const FitOptions options{.fine_step = 2.5, .knuckle_tries = 24};
    const std::vector<float> depths(target.wanted.inside.size(), 4.0f);
    const auto sharpness_of = [&](const std::vector<Station>& s) {
        const stroke::PlaneInk ink = draw_on_plane(s, hand, {}, options.fine_step, target.wanted.cell);
        std::vector<float> coverage;
        for (int j = 0; j < target.wanted.height; ++j)
            for (int i = 0; i < target.wanted.width; ++i)
                coverage.push_back(static_cast<float>(ink.at(target.wanted.centre(i, j) * hand.unit)));
        double sum = 0;
        for (const EdgeTurn& turn : knuckles_of(target.wanted, coverage, wanted)) sum += std::abs(turn.curvature);
        return sum;
    };
    stroke::PlaneDrawing drawing(hand.preset, hand.hold, options.fine_step * hand.unit, target.wanted.cell * hand.unit);
    const FitResult taken = take_off_knuckles({.stations = stations}, target, depths, hand, {}, options, drawing);
    EXPECT_GT(sharpness_of(stations), kKnuckle);
    EXPECT_LT(sharpness_of(taken.stations), 0.8 * sharpness_of(stations));  // a fifth is more than ripples of the edge
    EXPECT_LE(taken.tries, options.knuckle_tries);
}

}  // namespace
}  // namespace tuft::writer
