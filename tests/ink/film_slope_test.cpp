#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "core/system/parallel.h"
#include "wet_stage.h"

// Sheets of liquid that run down a wall.
namespace tuft::ink {
namespace {

/// A band of liquid on a wall of glazed porcelain, in air that is saturated. Downhill is turned by `angle` from the
/// rows of texels.
struct Band {
    double film = 4;                       // film units
    double length = 24e-3, width = 20e-3;  // m, along and across the slope
    double side = 90e-3, texel = 0.3e-3;   // m
    double angle = 0;                      // radians
    double steepness = 1;                  // sin α
    int charts = 1;
};

struct Slope {
    Band band;
    Wet s;
    FilmParams params;
    Vec3 downhill, across;
    double water = 0, ink = 0;

    explicit Slope(const Band& b)
        : band(b),
          s(testing::sheet(b.side, b.charts, std::round(b.side / b.texel / b.charts))),
          downhill{std::sin(b.angle), -std::cos(b.angle), 0},
          across{std::cos(b.angle), std::sin(b.angle), 0} {
        const Vec3 down = b.steepness * downhill - std::sqrt(1 - b.steepness * b.steepness) * Vec3{0, 0, 1};
        Substrate ware = load_substrate("porcelain");
        ware.wetting.line_hysteresis = 0.082f;  // lines of ware that ink wets well: 0.5 mm² hold
        params = film_params(ware, down);
        params.drying.evaporation = params.drying.rim_evaporation = 0;
        const auto amount = [&](const Vec3& at) {
            const double x = below_top(at);
            return x > 0 && x < b.length && std::abs(glm::dot(at, across)) < 0.5 * b.width ? b.film : 0;
        };
        s.wet(amount);
        s.ink(0, [&](const Vec3& at) { return 0.1 * amount(at); });
        water = s.canvas.total_liquid(s.map);
        ink = s.canvas.total(s.map, 0);
    }
    double below_top(const Vec3& at) const { return glm::dot(at, downhill) + 0.5 * band.side - 5e-3; }
    void run(double seconds) { s.film.advance(s.canvas, seconds, params); }
    /// Mean over the middle half of the width of where the lowest liquid is, metres below the top.
    double front() const {
        std::map<long, double> lowest;
        s.each([&](std::uint32_t slot, int t, const Vec3& at) {
            const double x = glm::dot(at, across);
            if (s.water(slot, t) < 0.2 || std::abs(x) > 0.25 * band.width) return;
            double& low = lowest[std::lround(x / (2 * band.texel))];
            low = std::max(low, below_top(at) + 0.5 * band.texel);
        });
        double sum = 0;
        for (const auto& [column, low] : lowest) sum += low;
        return sum / static_cast<double>(lowest.size());
    }
    /// (9 A² ρ g sin α t / (4 η))^⅓ [Huppert1982].
    double huppert(double seconds) const {
        const double amount = band.film * kFilmUnit * band.length;
        return std::cbrt(9 * amount * amount * 1000 * 9.81 * band.steepness * seconds / (4 * params.ripples.viscosity));
    }
    /// Sums of single precision.
    void expect_all_is_kept() const {
        EXPECT_NEAR(s.canvas.total_liquid(s.map) / water, 1, 1e-6);
        EXPECT_NEAR(s.canvas.total(s.map, 0) / ink, 1, 1e-6);
    }
};

// Where the film has thinned from its top down to the front, x = 1.5 lengths: from 2.3 s on at 40 µm, 0.6 s at 80.
TEST(FilmSlope, TheFrontOfAThickFilmGoesWithTheCubeRootOfTime) {
    for (const auto& [film, first] : {std::pair{4.0, 3.0}, {8.0, 0.75}}) {
        Slope slope({.film = film});
        slope.run(first);
        const double early = slope.front();
        slope.run(3 * first);
        const double late = slope.front();
        EXPECT_NEAR(std::log(late / early) / std::log(4.0), 1.0 / 3, 0.03) << film;
        // Texels of 0.3 mm; the first order of the scheme lags a texel or two behind.
        EXPECT_NEAR(early / slope.huppert(first), 1, 0.05) << film;
        EXPECT_NEAR(late / slope.huppert(4 * first), 1, 0.05) << film;
        slope.expect_all_is_kept();
    }
}

TEST(FilmSlope, GentlerSlopesAreSlowerByTheirSine) {
    Slope slope({.film = 8, .length = 30e-3, .steepness = 0.5});
    slope.run(3);
    EXPECT_NEAR(slope.front() / slope.huppert(3), 1, 0.05) << "as above";
}

TEST(FilmSlope, TheDirectionOfTexelsDoesNotMatter) {
    // 16 mm wide: first order across the stream spreads its sides by a millimetre.
    const Band straight{.film = 6, .length = 18e-3, .width = 16e-3, .side = 60e-3, .texel = 0.2e-3};
    std::vector<double> fronts;
    for (const double degrees : {0.0, 22.5, 45.0, 70.0}) {
        Band turned = straight;
        turned.angle = degrees * std::numbers::pi / 180;
        Slope slope(turned);
        slope.run(2);
        fronts.push_back(slope.front());
        slope.expect_all_is_kept();
        // A texel, and what lines hold less or more at other places of the wall.
        EXPECT_NEAR(fronts.back() / fronts.front(), 1, 0.03) << degrees;
    }
}

TEST(FilmSlope, TheDirectionOfTexelsDoesNotMatterToThinFilms) {
    // Little more than enters dry texels, on a wall whose lines hold nothing.
    std::vector<double> fronts;
    for (const double degrees : {0.0, 22.5}) {
        Slope slope({.film = 1.1, .side = 60e-3, .angle = degrees * std::numbers::pi / 180});
        slope.params.weight.hysteresis = 1e-9;
        slope.run(12);
        fronts.push_back(slope.front() - slope.band.length);
    }
    EXPECT_GT(fronts[0], 3e-3);
    EXPECT_NEAR(fronts[1], fronts[0], 2 * 0.3e-3) << "texels, of 4 mm";
}

// 20 texels in a step, more than there are in a tile.
TEST(FilmSlope, FastSheetsDoNotPileUpAtTheBordersOfTiles) {
    Slope slope({.film = 8, .length = 14e-3, .width = 12e-3, .side = 24e-3, .texel = 0.05e-3});
    slope.run(0.1);
    double most = 0;
    slope.s.each([&](std::uint32_t slot, int t, const Vec3&) { most = std::max(most, slope.s.water(slot, t)); });
    EXPECT_LT(most, 8.1) << "a sheet gets no thicker than it was";
    EXPECT_NEAR(slope.front(), 14e-3 + 0.1 * 9.81e6 / 3 * std::pow(8e-5, 2), 0.3e-3) << "less than 2 %";
    slope.expect_all_is_kept();
}

/// A wall that meets a floor at y = z = 0, each a chart.
testing::Unwrapped wall_and_floor() {
    testing::Patch wall = testing::flat({-12e-3, 0, 0}, {24e-3, 0, 0}, {0, 0, 32e-3}, 8, 8),
                   floor = testing::flat({-12e-3, -20e-3, 0}, {24e-3, 0, 0}, {0, 20e-3, 0}, 8, 8);
    testing::place(wall, {8.21, 8.13}, {96, 0}, {0, 128});
    testing::place(floor, {118.4, 9.3}, {96, 0}, {0, 80});
    return testing::build({wall, floor}, 224);
}

TEST(FilmSlope, ASheetRunsIntoAPoolAtTheFootOfAWall) {
    Wet s(wall_and_floor());
    FilmParams p = film_params(load_substrate("porcelain"), {0, 0, -1});
    p.drying.evaporation = p.drying.rim_evaporation = 0;
    const auto on_floor = [](const Vec3& at) { return at.z < 1e-5; };
    p.weight.hysteresis = 1e-9;
    // Too thin for beads.
    s.wet([&](const Vec3& at) { return on_floor(at) ? 1.5 : at.z < 24e-3 ? 1.9 : 0; });
    s.ink(0, [&](const Vec3& at) { return on_floor(at) ? 0 : at.z < 24e-3 ? 0.2 : 0; });
    const auto ink_of_floor = [&] {
        double sum = 0;
        s.each([&](std::uint32_t slot, int t, const Vec3& at) {
            if (on_floor(at)) sum += s.amount(slot, t) * static_cast<double>(s.map.tiles[slot].area[t]);
        });
        return sum;
    };
    const double water = s.canvas.total_liquid(s.map), ink = s.canvas.total(s.map, 0), before = ink_of_floor();
    s.film.advance(s.canvas, 4, p);
    EXPECT_NEAR(s.canvas.total_liquid(s.map) / water, 1, 1e-6) << "sums of single precision";
    EXPECT_NEAR(s.canvas.total(s.map, 0) / ink, 1, 1e-6);
    // ρ g h² / 3 η of 19 µm: 1.2 mm/s, 4.7 mm of 24 in all. Texels are 0.25 mm.
    EXPECT_NEAR((ink_of_floor() - before) / ink, 4.7 / 24, 0.02);
}

// Also where the ground was of another kind at the last stroke.
TEST(FilmSlope, FacesMayChangeBetweenCalls) {
    Slope slope({.film = 6, .length = 20e-3, .width = 10e-3, .side = 60e-3, .charts = 2});
    slope.run(0.5);
    slope.params.unevenness = 0.5;
    slope.run(0.5);
    slope.expect_all_is_kept();
    Slope even({.film = 6, .length = 20e-3, .width = 10e-3, .side = 60e-3, .charts = 2});
    even.run(1);
    EXPECT_NEAR(slope.front() / even.front(), 1, 0.02) << "fibres do not slow what is above them; a texel";
}

TEST(FilmSlope, SheetsCrossASeamAsIfThereWereNone) {
    double fronts[2];
    for (const int charts : {1, 2}) {
        Slope slope({.film = 6, .length = 20e-3, .width = 10e-3, .side = 60e-3, .angle = 0.3, .charts = charts});
        slope.run(2);
        fronts[charts - 1] = slope.front();
        slope.expect_all_is_kept();
    }
    EXPECT_NEAR(fronts[1] / fronts[0], 1, 0.02) << "two seams, one of them across; a texel of 0.3 mm at each";
}

// ρ g A against σ (cos θ_r − cos θ_a): A = 0.5 mm² on a wall, a third more for the sides of a band of 16 mm or more, by
// a fifth more or less as the place is rough, and from 0.8 to 1.2 of that a column is ever less slow.
TEST(FilmSlope, AColumnHoldsWhileItsWeightIsLessThanItsLineBears) {
    for (const double length : {12e-3, 60e-3}) {
        Slope slope({.film = 1.8, .length = length});
        slope.run(4);
        if (length < 20e-3)
            EXPECT_NEAR(slope.front(), length, slope.band.texel) << "0.22 mm²";
        else
            EXPECT_NEAR(slope.front(), length + 4 * 9.81e6 / 3 * std::pow(1.8e-5, 2), 2 * slope.band.texel)
                << "1.08 mm²; a scheme of first order";
        slope.expect_all_is_kept();
    }
}

// A narrow tongue is held by its sides too: 1 + 5 mm / 3 mm of 0.5 mm² are more than the 1.08 that run where it is
// wide.
TEST(FilmSlope, ANarrowTongueHoldsMore) {
    Slope slope({.film = 1.8, .length = 60e-3, .width = 3e-3});
    slope.run(4);
    EXPECT_NEAR(slope.front(), 60e-3, slope.band.texel);
}

TEST(FilmSlope, TheLengthOfCallsDoesNotMatter) {
    double fronts[2];
    for (const bool short_calls : {false, true}) {
        Slope slope({.film = 6, .side = 60e-3});
        for (int i = 0; i < (short_calls ? 20 : 1); ++i) {
            slope.run(short_calls ? 0.05 : 1);
            slope.params.drying.goes_on = true;
        }
        fronts[short_calls] = slope.front();
    }
    EXPECT_NEAR(fronts[1], fronts[0], 0.3e-3) << "a texel";
}

TEST(FilmSlope, SheetsAreTheSameOnAnyNumberOfThreads) {
    std::uint64_t hashes[2];
    for (int i = 0; i < 2; ++i) {
        set_thread_count(i ? 3 : 1);
        Slope slope({.film = 6, .length = 15e-3, .width = 10e-3, .side = 40e-3, .angle = 0.4, .charts = 2});
        slope.run(1);
        hashes[i] = slope.s.canvas.hash();
    }
    set_thread_count(0);
    EXPECT_EQ(hashes[0], hashes[1]);
}

}  // namespace
}  // namespace tuft::ink
