#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

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
        if (radius > 6e-3) EXPECT_EQ(s.water(slot, t), 0);
        if (radius > 5.88e-3) EXPECT_FLOAT_EQ(s.water(slot, t), blot(at)) << "beside dry texels of 0.125 mm";
        // Ridges of 1.3 mm level in a hundredth of a second; in tiles with contact lines to 5 % of the thickness.
        if (radius < 4e-3) EXPECT_NEAR(s.water(slot, t), 2, 0.1);
    });
    EXPECT_NEAR(s.canvas.total_liquid(s.map) / water, 1, 1e-6);
    EXPECT_NEAR(s.canvas.total(s.map, 0) / ink, 1, 1e-6);
}

TEST(FilmLaws, LevellingKeepsAllAndIsTheSameOnAnyNumberOfThreads) {
    std::uint64_t hashes[2];
    for (int i = 0; i < 2; ++i) {
        set_thread_count(i ? 4 : 1);
        Wet s(testing::sphere(0.01, 64));
        const auto deep = [](const Vec3& at) { return 2.5 + 2.1 * std::sin(1500 * at.x) * std::sin(1100 * (at.y + at.z)); };
        s.wet(deep);
        s.ink(0, [](const Vec3& at) { return 1 + std::cos(900 * at.y); });
        const double water = s.canvas.total_liquid(s.map), ink = s.canvas.total(s.map, 0);
        FilmParams p = level_porcelain();
        p.down = Vec3{0};  // all round the ball
        s.film.advance(s.canvas, 4, p);
        double least = 1, most = 0;
        s.each([&](std::uint32_t slot, int t, const Vec3&) {
            least = std::min({least, s.water(slot, t), s.amount(slot, t)});
            most = std::max(most, s.water(slot, t));
        });
        EXPECT_GE(least, 0);
        EXPECT_LT(most, 3.6) << "of 4.6, where a ripple is widest, 13 mm about a pole";
        EXPECT_NEAR(s.canvas.total_liquid(s.map) / water, 1, 1e-6);
        EXPECT_NEAR(s.canvas.total(s.map, 0) / ink, 1, 1e-6);
        hashes[i] = s.canvas.hash();
    }
    set_thread_count(0);
    EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(FilmLaws, Soaking) {
    for (const int kind : {0, 1, 4}) {
        Wet s(testing::sheet(0.012, 1, 120));
        FilmParams p = film_params(load_substrate(kind == 3 ? "bisque" : "rice-paper"));
        p.unevenness = 0;
        p.evaporation = p.rim_evaporation = 0;
        if (kind == 4) p.shortest_step = 0;
        double t = 0;
        const double call = 0.1;
        for (const double until : {0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0}) {
            for (; t < until - 1e-9; t += call) {
                s.each([&](std::uint32_t slot, int i, const Vec3& at) {
                    if (at.x > -5.5e-3) return;
                    s.canvas.touch_liquid(slot, Liquid::pores)[i] = static_cast<float>(p.pores);
                    if (kind == 1) s.canvas.touch_liquid(slot, Liquid::film)[i] = 3;
                    if (kind == 2) s.canvas.touch_liquid(slot, Liquid::film)[i] = 1;
                });
                s.film.advance(s.canvas, call, p);
            }
            double all = 0, n = 0, front = -1;
            s.each([&](std::uint32_t slot, int i, const Vec3& at) {
                if (std::abs(at.y) > 3e-3) return;
                if (at.x > -5.5e-3) all += s.water(slot, i) + s.water(slot, i, Liquid::pores);
                n += 1;
                if (s.water(slot, i, Liquid::pores) > 0.02 * p.pores) front = std::max(front, at.x);
            });
            std::printf("kind %d t %g: uptake %g mm front %g mm\n", kind, t, all / n * 12 / p.pores, (front + 5.5e-3) * 1e3);
        }
    }
}
TEST(FilmLaws, Cost) {
    set_thread_count(1);
    for (const int kind : {0, 1, 2, 3, 4, 5}) {
        Wet s(testing::sheet(0.04, 1, 400));
        for (const char* name : {"indigo", "gamboge"}) s.canvas.add_pigment(load_ink(name).parts[0].pigment);
        FilmParams p = film_params(load_substrate("porcelain"));
        if (kind == 0 || kind == 4) p.tension = 0;
        const double a = kind == 1 ? 0 : 0.2, h = kind == 3 ? 5 : 1.5;
        s.wet([&](const Vec3& at) {
            return kind > 3 ? h * disc(at, 15e-3) : h * (1 + a * std::sin(4000 * at.x) * std::cos(1500 * at.y));
        });
        for (int k = 0; k < 4; ++k) s.ink(k, [&](const Vec3& at) { return 0.5 + 0.2 * std::sin(4000 * at.x + k); });
        timespec t0{}, t1{};
        ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t0);
        const FilmReport r =
            s.film.advance(s.canvas, std::getenv("SECONDS") ? std::atof(std::getenv("SECONDS")) : 5, p);
        ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t1);
        const double ns = 1e9 * double(t1.tv_sec - t0.tv_sec) + double(t1.tv_nsec - t0.tv_nsec);
        std::printf("kind %d: %zu steps %zu tile steps %.1f ns per texel and step\n", kind, r.steps, r.tile_steps,
                    ns / (160000.0 * (kind > 3 ? 0.4418 : 1) * double(r.steps)));
    }
    set_thread_count(0);
}

}  // namespace
}  // namespace tuft::ink
