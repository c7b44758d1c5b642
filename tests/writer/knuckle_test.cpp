#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "writer/fit/ink_score.h"
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

// A top of a disc of 14 units and two necks cost at least a knuckle's least curvature each; where other ink lies over
// them nobody sees them.
TEST(Knuckles, ASwellingCostsSharpnessUnlessAnotherStrokeLiesOverIt) {
    std::vector<Ring> swollen = bar();
    swollen.push_back(disc({200, 122}, 14));
    const std::vector<float> plain = coverage_of(cells_of(bar())), ink = coverage_of(cells_of(swollen));
    FitTarget target{.wanted = cells_of(bar()), .weights = {}};
    const std::vector<EdgeTurn> turns = turns_wanted(target.wanted);
    EXPECT_EQ(sharpness_of(target, turns, plain), 0);
    EXPECT_GT(sharpness_of(target, turns, ink), 3);
    target.weights.assign(target.wanted.inside.size(), 0.25f);
    EXPECT_EQ(sharpness_of(target, turns, ink), 0);
}

}  // namespace
}  // namespace tuft::writer
