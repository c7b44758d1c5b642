#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/system/parallel.h"
#include "ink/film/tile/paste.h"
#include "wet_stage.h"

// Thin ink over paste that has not dried.
namespace tuft::ink {
namespace {

constexpr double kWave = 1e-3;  // metres

TEST(PasteUnderAWash, WhatComesLooseFollowsArchardsLaw) {
    // V = K F s / H: per area h = K p s / H, H = (2 + π) τ = 2.06 kPa: 1.4 kPa over 15 mm wear 10.2
    // µm off.
    const Rub rub{.pressure = 1400, .length = 15e-3, .yield = 400};
    EXPECT_NEAR(loosened(rub) * kFilmUnit, 10.2e-6, 0.05e-6);
    // What rests on twice the area goes as deep: the force counts, and the path, in whatever parts.
    EXPECT_NEAR(loosened({.pressure = 700, .length = 30e-3, .yield = 400}), loosened(rub), 1e-12);
    EXPECT_NEAR(loosened({.pressure = 2800, .length = 15e-3, .yield = 800}), loosened(rub), 1e-12);
    EXPECT_EQ(loosened({.pressure = -1, .length = 1}), 0);
    EXPECT_EQ(loosened({.pressure = 1, .length = 1, .yield = 0}), 0) << "what does not yield is no paste";
}

/// Paste with furrows 100 µm deep across x, dry height 5 µm a film unit, and ink with water over a
/// disc of 2.5 mm.
struct PasteBed : Wet {
    std::vector<double> white;  ///< film units, as laid
    double had[3]{};            ///< paste, ink, liquid

    explicit PasteBed(int charts = 1, double loose = 0.8) : Wet(testing::sheet(8e-3, charts, 160.0 / charts)) {
        Pigment thick = load_ink("titanium-white").parts[0].pigment;
        thick.height = 5e-6f;
        canvas.set_pigment(0, thick);
        Wet::ink(0, [](const Vec3& at) { return std::abs(at.y) < 3e-3 ? 14 + 20 * ridge(at.x) : 0; });
        each([&](std::uint32_t slot, int t, const Vec3&) { white.push_back(amount(slot, t)); });
        had[0] = canvas.total(map, 0);
        const auto spot = [](const Vec3& at) { return 3 * disc(at, 2.5e-3); };
        for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot) {
            std::array<float, kN> flooded;
            for (int t = 0; t < kN; ++t) flooded[t] = static_cast<float>(spot(Vec3(map.position(slot, t))));
            bed_paste(canvas, slot, paste_height(canvas, slot), flooded, loose);
        }
        wet(spot);
        Wet::ink(1, spot);
        had[1] = canvas.total(map, 1), had[2] = canvas.total_liquid(map);
    }
    static double ridge(double x) { return std::abs(2 * (x / kWave - std::floor(x / kWave)) - 1); }
    void run(double seconds) {
        FilmParams p = film_params(load_substrate("porcelain"));
        p.drying.evaporation = p.drying.rim_evaporation = 0;
        film.advance(canvas, seconds, p);
    }
};

TEST(PasteUnderAWash, BeddingMovesNothingAndLeavesOfItWhatCameLoose) {
    PasteBed g;
    std::size_t i = 0, bedded = 0;
    g.each([&](std::uint32_t slot, int t, const Vec3&) {
        const double all = g.amount(slot, t), was = g.white[i++];
        ASSERT_NEAR(all, was, 1e-5) << "floats";
        if (!(g.water(slot, t) > 0) || !(was * 5 > 30)) return;
        EXPECT_NEAR((*g.canvas.plane(slot, 0))[t], 0.8, 1e-5);
        ++bedded;
    });
    EXPECT_GT(bedded, 1000u);
    EXPECT_NEAR(g.canvas.total(g.map, 0) / g.had[0], 1, 1e-7);
}

TEST(PasteUnderAWash, LiquidRunsOverItAndItStands) {
    std::uint64_t hashes[2];
    for (const int charts : {1, 2})
        for (int i = 0; i < 2; ++i) {
            set_thread_count(i ? 3 : 1);
            PasteBed g(charts);
            g.run(20);
            hashes[i] = g.canvas.hash();
            if (i) {
                EXPECT_EQ(hashes[0], hashes[1]);
            }
            EXPECT_NEAR(g.canvas.total(g.map, 0) / g.had[0], 1, 1e-6) << "floats";
            EXPECT_NEAR(g.canvas.total(g.map, 1) / g.had[1], 1, 1e-6);
            EXPECT_NEAR(g.canvas.total_liquid(g.map) / g.had[2], 1, 1e-6);
            std::size_t k = 0, flooded = 0;
            double ridges = 0, furrows = 0, n_ridges = 0, n_furrows = 0;
            g.each([&](std::uint32_t slot, int t, const Vec3& at) {
                const double was = g.white[k++];
                // What came loose goes with the liquid and may heap up where that stands, some
                // units deep in a furrow.
                EXPECT_GE(g.amount(slot, t), was - 0.801);
                EXPECT_LE(g.amount(slot, t), was + 5);
                if (!(g.water(slot, t) > 0)) {
                    EXPECT_NEAR(g.amount(slot, t), was, 1e-5) << "dry paste stays where it is";
                    return;
                }
                flooded += glm::length(at) > 2.8e-3;
                if (glm::length(at) > 2e-3) return;
                const bool low = PasteBed::ridge(at.x)<0.2, high = PasteBed::ridge(at.x)> 0.8;
                (low ? furrows : ridges) += low || high ? g.water(slot, t) : 0;
                n_furrows += low, n_ridges += high;
            });
            EXPECT_GT(flooded, 20u) << "it runs along furrows beyond where it was laid";
            EXPECT_GT(furrows / n_furrows, 3 * ridges / n_ridges) << "laid evenly";
        }
    set_thread_count(0);
}

}  // namespace
}  // namespace tuft::ink
