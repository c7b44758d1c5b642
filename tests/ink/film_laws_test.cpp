#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/system/parallel.h"
#include "wet_stage.h"

// Laws of thin films that are known in closed form.
namespace tuft::ink {
namespace {

/// Level porcelain in air that is saturated.
FilmParams level_porcelain() {
    FilmParams p = film_params(load_substrate("porcelain"), {0, 0, -1});
    p.evaporation = p.rim_evaporation = 0;
    return p;
}

/// Rate at which a ripple of wavelength `lambda` decays on a film of `h` film units, 1/s; in one chart or over a seam.
double ripple_rate(double h, double lambda, double seconds, const FilmParams& p, int charts = 1) {
    const double side = 2 * lambda, k = 2 * std::numbers::pi / lambda, part = 0.05;
    Wet s(testing::sheet(side, charts, std::round(side / 0.1e-3 / charts)));
    const auto wave = [&](const Vec3& at) { return std::cos(k * (at.x + 0.5 * side)); };
    s.wet([&](const Vec3& at) { return h * (1 + part * wave(at)); });
    const auto amplitude = [&] {
        double sum = 0, square = 0;
        s.each([&](std::uint32_t slot, int t, const Vec3& at) {
            sum += (s.water(slot, t) - h) * wave(at);
            square += wave(at) * wave(at);
        });
        return sum / square;
    };
    const double from = amplitude(), water = s.canvas.total_liquid(s.map);
    s.film.advance(s.canvas, seconds, p);
    EXPECT_NEAR(s.canvas.total_liquid(s.map) / water, 1, 1e-6);
    return std::log(from / amplitude()) / seconds;
}
double orchard(double h, double lambda, const FilmParams& p) {
    const double k = 2 * std::numbers::pi / lambda;
    return p.tension * std::pow(h * kFilmUnit, 3) * std::pow(k, 4) / (3 * p.viscosity);
}

TEST(FilmLaws, RipplesLevelAsThinFilmTheorySays) {
    const FilmParams p = level_porcelain();
    const auto rate = [&](double h, double lambda, int charts = 1) {
        return ripple_rate(h, lambda, 0.5 / orchard(h, lambda, p), p, charts);
    };
    const double plain = rate(1, 4e-3), thick = rate(2, 4e-3), narrow = rate(1, 2e-3), thin = rate(0.5, 2e-3);
    // Implicit steps z long have ln(1 + z) / z of the rate: z up to 0.2 here.
    EXPECT_NEAR(plain / orchard(1, 4e-3, p), 1, 0.1);
    EXPECT_NEAR(thick / orchard(2, 4e-3, p), 1, 0.1);
    EXPECT_NEAR(narrow / orchard(1, 2e-3, p), 1, 0.15);
    EXPECT_NEAR(thin / orchard(0.5, 2e-3, p), 1, 0.15);
    EXPECT_NEAR(std::log2(thick / plain), 3, 0.09) << "3 %: as steps differ in z";
    EXPECT_NEAR(std::log2(narrow / plain), 4, 0.12);
    EXPECT_NEAR(rate(1, 4e-3, 2) / plain, 1, 0.05) << "over a seam down the crest";
}

TEST(FilmLaws, SoThinAFilmIsHeld) {
    FilmParams p = level_porcelain();
    p.mobility = 0;
    EXPECT_NEAR(ripple_rate(0.9 * p.held, 1e-3, 5, p), 0, 1e-9);
}

TEST(FilmLaws, AFilmKeepsItsEdgeWhileItsRidgesLevel) {
    FilmParams p = level_porcelain();
    p.mobility = 0;
    Wet s(testing::sheet(0.02, 1, 160));
    const auto ridges = [](const Vec3& at) { return 2 + std::sin(5000 * at.x); };
    const auto blot = [&](const Vec3& at) { return glm::length(at) < 6e-3 ? ridges(at) : 0; };
    s.wet(blot);
    s.ink(0, blot);
    const double water = s.canvas.total_liquid(s.map), ink = s.canvas.total(s.map, 0);
    for (int i = 0; i < 20; ++i) s.film.advance(s.canvas, 0.25, p);
    s.each([&](std::uint32_t slot, int t, const Vec3& at) {
        const double radius = glm::length(at);
        if (radius > 6e-3) {
            EXPECT_EQ(s.water(slot, t), 0);
        } else if (radius > 5.88e-3) {
            EXPECT_FLOAT_EQ(s.water(slot, t), blot(at)) << "beside dry texels of 0.125 mm";
        } else if (radius < 4e-3) {
            // Ridges of 1.3 mm level in a hundredth of a second; in tiles with contact lines to 5 % of the thickness.
            EXPECT_NEAR(s.water(slot, t), 2, 0.1);
        }
    });
    EXPECT_NEAR(s.canvas.total_liquid(s.map) / water, 1, 1e-6);
    EXPECT_NEAR(s.canvas.total(s.map, 0) / ink, 1, 1e-6);
}

TEST(FilmLaws, LevellingKeepsAllAndIsTheSameOnAnyNumberOfThreads) {
    std::uint64_t hashes[2];
    for (int i = 0; i < 2; ++i) {
        set_thread_count(i ? 4 : 1);
        Wet s(testing::sphere(0.005, 32));
        s.wet([](const Vec3& at) { return 2.5 + 2.1 * std::sin(1500 * at.x) * std::sin(1100 * (at.y + at.z)); });
        s.ink(0, [](const Vec3& at) { return 1 + std::cos(900 * at.y); });
        FilmParams p = level_porcelain();
        p.down = Vec3{0};  // all round the ball
        p.levelling = 0;
        const auto unevenness = [&] {
            double square = 0, n = 0;
            s.each([&](std::uint32_t slot, int t, const Vec3&) {
                EXPECT_GE(s.water(slot, t), 0);
                EXPECT_GE(s.amount(slot, t), 0);
                square += std::pow(s.water(slot, t) - 2.5, 2);
                n += 1;
            });
            return std::sqrt(square / n);
        };
        const double water = s.canvas.total_liquid(s.map), ink = s.canvas.total(s.map, 0), before = unevenness();
        s.film.advance(s.canvas, 2, p);
        EXPECT_LT(unevenness(), 0.6 * before) << "over six charts; ripples are up to 9 mm long about the poles";
        EXPECT_NEAR(s.canvas.total_liquid(s.map) / water, 1, 1e-6);
        EXPECT_NEAR(s.canvas.total(s.map, 0) / ink, 1, 1e-6);
        hashes[i] = s.canvas.hash();
    }
    set_thread_count(0);
    EXPECT_EQ(hashes[0], hashes[1]);
}

/// ∫ u dx / √t of ∂u/∂t = ∂(u ∂u/∂x)/∂x with u = 1 at x = 0 (Boussinesq's equation): the similar solution u(x / √t),
/// (u u′)′ = −½ ξ u′, from its front at ξ = 1 back to 0, and scaled.
double boussinesq_uptake() {
    constexpr int kSteps = 20000;
    const double step = 1.0 / kSteps;
    double u = 0.5 * step, flux = u * 0.5;  // −u u′; at the front u = ½ ξ_f (ξ_f − ξ)
    for (int i = 1; i < kSteps; ++i) {
        const double xi = 1 - i * step, slope = flux / u, middle = u + 0.5 * step * slope,
                     middle_flux = flux + 0.25 * step * xi * slope, next = middle_flux / middle;
        u += step * next;
        flux += 0.5 * step * (xi - 0.5 * step) * next;
    }
    return 2 * flux / std::pow(u, 1.5);
}

// A strip of paper that dips into ink: Lucas and Washburn's √t, D · pores standing for r σ cos θ / η of its pores.
TEST(FilmLaws, PaperDrinksWithTheRootOfTime) {
    Wet s(testing::sheet(0.008, 1, 80));
    FilmParams p = film_params(load_substrate("rice-paper"), {0, 0, -1});
    p.unevenness = p.evaporation = p.rim_evaporation = p.shortest_step = 0;
    const double edge = -3.5e-3, call = 0.1;
    const auto drunk = [&] {  // metres of full pores
        double sum = 0, n = 0;
        s.each([&](std::uint32_t slot, int t, const Vec3& at) {
            if (at.x > edge) sum += s.water(slot, t, Liquid::pores);
            n += 1;
        });
        return sum / n * 0.008 / p.pores;
    };
    std::vector<double> at;
    double t = 0;
    for (const double until : {0.5, 2.0, 8.0, 32.0}) {
        for (; t < until - 1e-9; t += call) {
            s.each([&](std::uint32_t slot, int i, const Vec3& where) {
                if (where.x < edge) s.canvas.touch_liquid(slot, Liquid::pores)[i] = static_cast<float>(p.pores);
            });
            s.film.advance(s.canvas, call, p);
        }
        at.push_back(drunk());
    }
    // Of differences: from texel to texel at the edge it goes by less than along a line, 0.07 mm in all.
    for (std::size_t i = 2; i < at.size(); ++i)
        EXPECT_NEAR(std::log((at[i] - at[i - 1]) / (at[i - 1] - at[i - 2])) / std::log(4.0), 0.5, 0.03) << i;
    const double theory = boussinesq_uptake() * std::sqrt(p.mobility * p.pores);
    EXPECT_NEAR(boussinesq_uptake(), 0.8875, 0.002) << "twice 0.4437";
    EXPECT_NEAR((at[3] - at[2]) / (std::sqrt(32.0) - std::sqrt(8.0)) / theory, 1, 0.03) << "of 11 texels";
}

}  // namespace
}  // namespace tuft::ink
