#include "footprint/outline/rough_edge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

/// Roughness of the edge of wet hair.
namespace tuft::footprint {
namespace {

constexpr double kLong = 20e-3, kWide = 6e-3;  // metres, of the bar
constexpr double kSpacing = 0.09e-3;           // metres between hairs

/// A bar along x with square ends, of control points as strips have them.
Outline bar() {
    Outline o;
    const auto side = [&](Vec2 from, Vec2 to) {
        constexpr int n = 20;
        for (int i = 0; i < n; ++i) o.control.push_back(glm::mix(from, to, double(i) / n));
    };
    const Vec2 a{-kLong / 2, -kWide / 2}, b{kLong / 2, -kWide / 2}, c{kLong / 2, kWide / 2}, d{-kLong / 2, kWide / 2};
    side(a, b), side(b, c), side(c, d), side(d, a);
    return o;
}

Footprint picture(double cell, const RoughEdge& edge) {
    static const Frame frame;
    const Outline o = bar();
    return rasterise(std::span(&o, 1), {frame, 0, cell}, edge);
}

RoughEdge hair(std::uint64_t seed) {
    // Rough ground whose own grain is too short to move the edge.
    return {{.spacing = kSpacing, .seed = seed, .travel = 0.05, .foot = {3e-3, 0}, .direction = {1, 0}},
            {.relief = 1, .length = 1e-9}};
}

double area_of(const Footprint& f) {
    return std::accumulate(f.coverage.begin(), f.coverage.end(), 0.0) / 255 * f.cell * f.cell;
}

/// Metres from the middle row or column to the edge, by column (`ends` false: the upper flank) or row (the right end).
std::vector<double> edge_of(const Footprint& f, bool ends) {
    std::vector<double> out;
    const auto at = [&](int i, int j) { return f.coverage[static_cast<std::size_t>(j) * f.width + i] / 255.0; };
    const int mid_x = f.width / 2, mid_y = f.height / 2;
    // Away from the corners.
    const int skip = static_cast<int>(0.5e-3 / f.cell) + 3;
    for (int k = skip; k < (ends ? f.height : f.width) - skip; ++k) {
        double sum = 0;
        for (int m = ends ? mid_x : mid_y; m < (ends ? f.width : f.height); ++m) sum += ends ? at(m, k) : at(k, m);
        out.push_back(sum * f.cell);
    }
    return out;
}

/// Root mean square of the difference over a lag, metres.
double difference(const std::vector<double>& v, std::size_t lag) {
    double sum = 0;
    for (std::size_t k = 0; k + lag < v.size(); ++k) sum += (v[k + lag] - v[k]) * (v[k + lag] - v[k]);
    return std::sqrt(sum / static_cast<double>(v.size() - lag));
}

TEST(RoughEdge, WithoutHairAndGrainIsTheSmoothPicture) {
    const Frame frame;
    const Outline o = bar();
    EXPECT_EQ(picture(5e-5, {}).coverage, rasterise(std::span(&o, 1), frame, 0, 5e-5).coverage);
}

TEST(RoughEdge, VanishesWhereATexelIsCoarserThanTheHair) {
    EXPECT_EQ(picture(0.75 * kSpacing, hair(1)).coverage, picture(0.75 * kSpacing, {}).coverage);
    RoughEdge paper;
    paper.grain = {15e-6, 120e-6};
    EXPECT_EQ(picture(160e-6, paper).coverage, picture(160e-6, {}).coverage);
    EXPECT_NE(picture(30e-6, paper).coverage, picture(30e-6, {}).coverage);
}

// The displacement has no mean. Over 2 · 20 mm of flank with cells of 3 mm its mean has a standard deviation of 0.02 mm
// / √13: 0.2 % of the width in one picture, 0.06 % in the mean of twelve.
TEST(RoughEdge, KeepsTheMeanWidth) {
    const double smooth = area_of(picture(4e-5, {}));
    double sum = 0;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const double rough = area_of(picture(4e-5, hair(seed)));
        EXPECT_NEAR(rough / smooth, 1, 0.008) << seed;
        sum += rough / smooth / 12;
    }
    EXPECT_NEAR(sum, 1, 0.002);
}

// On glaze without relief w D is 0.3 · 90 µm · 0.34 at cells of 50 µm: less than 0.2 texels.
TEST(RoughEdge, OnSmoothGlazeIsLeftOutOnCoarseTexels) {
    RoughEdge glaze = hair(1);
    glaze.grain = {};
    EXPECT_EQ(picture(50e-6, glaze).coverage, picture(50e-6, {}).coverage);
    EXPECT_NE(picture(15e-6, glaze).coverage, picture(15e-6, {}).coverage);
}

// Value noise with cells of one spacing: next to each other places differ little, from one hair to the next they are
// independent.
TEST(RoughEdge, OfAnEndHasTheSpacingOfTheHair) {
    constexpr double kCell = 10e-6;
    const std::vector<double> end = edge_of(picture(kCell, hair(3)), true);
    const auto lag = [&](double spacings) {
        return difference(end, static_cast<std::size_t>(std::lround(spacings * kSpacing / kCell)));
    };
    EXPECT_LT(lag(0.22), 0.45 * lag(2));
    EXPECT_NEAR(lag(2) / lag(5), 1, 0.2);
    // Rms of the noise 0.43, 0.7 spacings for a hair's end and 0.5 for both terms of the flank: 0.033 mm.
    EXPECT_GT(lag(5) / std::sqrt(2), 0.025e-3);
    EXPECT_LT(lag(5) / std::sqrt(2), 0.045e-3);
}

// A flank changes over millimetres, by less than a hair: at arm's length nobody sees it. Rms of its difference
// √2 · 0.43 · 0.5 spacings: 0.3.
TEST(RoughEdge, OfAFlankGoesFromHairToHair) {
    constexpr double kCell = 20e-6;
    const std::vector<double> flank = edge_of(picture(kCell, hair(3)), false);
    const auto lag = [&](double metres) {
        return difference(flank, static_cast<std::size_t>(std::lround(metres / kCell)));
    };
    EXPECT_LT(lag(0.1e-3), 0.35 * lag(3e-3));
    EXPECT_GT(lag(3e-3), 0.15 * kSpacing);
    EXPECT_LT(lag(3e-3), 0.45 * kSpacing);
}

// Hand and travel go on by as much: all the edge stays, but for a cell's 255 levels.
TEST(RoughEdge, StaysOnTheSurfaceWhileTheHandGoesOn) {
    RoughEdge before = hair(5), after = before;
    after.hair.foot += 1.7e-3 * after.hair.direction;
    after.hair.travel += 1.7e-3;
    const Footprint a = picture(3e-5, before), b = picture(3e-5, after);
    ASSERT_EQ(a.coverage.size(), b.coverage.size());
    for (std::size_t i = 0; i < a.coverage.size(); ++i) ASSERT_NEAR(a.coverage[i], b.coverage[i], 1);
}

// Area between the edges of two pictures, one with cells of half the size, for each metre of edge.
double between(double cell, const RoughEdge& edge) {
    const Footprint coarse = picture(cell, edge), fine = picture(cell / 2, edge);
    double sum = 0;
    for (int j = 0; j < coarse.height; ++j)
        for (int i = 0; i < coarse.width; ++i) {
            double mean = 0;
            const Vec2 at = (coarse.lo + cell * Vec2(i, j) - fine.lo) / fine.cell;
            const int x = static_cast<int>(std::lround(at.x)), y = static_cast<int>(std::lround(at.y));
            for (int k = 0; k < 4; ++k) {
                const int u = x + (k & 1), v = y + (k >> 1);
                if (u >= 0 && v >= 0 && u < fine.width && v < fine.height)
                    mean += fine.coverage[static_cast<std::size_t>(v) * fine.width + u] / 4.0;
            }
            sum += std::abs(mean - coarse.coverage[static_cast<std::size_t>(j) * coarse.width + i]) / 255;
        }
    return sum * cell * cell / (2 * (kLong + kWide));
}

TEST(RoughEdge, ConvergesWithFinerTexels) {
    const double coarse = between(40e-6, hair(7)), middle = between(20e-6, hair(7)), fine = between(10e-6, hair(7));
    EXPECT_LT(middle, 0.6 * coarse);
    EXPECT_LT(fine, 0.6 * middle);
}

}  // namespace
}  // namespace tuft::footprint
