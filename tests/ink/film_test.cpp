#include "ink/film/film.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/system/parallel.h"
#include "ink/texels/drying.h"
#include "wet_stage.h"

namespace tuft::ink {
namespace {

TEST(WetFilm, APointOfPigmentSpreadsAsAGaussian) {
    // A sheet of 20 mm, texels of 0.125 mm, water all over: ∂p/∂t = D ∇²p.
    Wet s(testing::sheet(0.02, 1, 160));
    FilmParams p = still();
    p.mixing = 2e-9;
    const double sigma0 = 0.6e-3, seconds = 500, sigma2 = sigma0 * sigma0 + 2 * p.mixing * seconds;
    s.wet([](const Vec3&) { return 1.5; });
    const auto gaussian = [](const Vec3& at, double variance) {
        return std::exp(-glm::dot(at, at) / (2 * variance)) / variance * 1e-6;
    };
    s.ink(0, [&](const Vec3& at) { return gaussian(at, sigma0 * sigma0); });
    const double before = s.canvas.total(s.map, 0);
    s.film.advance(s.canvas, seconds, p);
    double worst = 0;
    s.each([&](std::uint32_t slot, int t, const Vec3& at) {
        if (glm::length(at) < 6e-3)  // beyond, the sheet's edge reflects
            worst = std::max(worst, std::abs(s.amount(slot, t) - gaussian(at, sigma2)));
    });
    // Second order in texels, 4.8 of them to the first σ, and 2 k steps a texel: some 0.1 %.
    EXPECT_LT(worst / gaussian(Vec3{0}, sigma2), 2e-3);
    EXPECT_NEAR(s.canvas.total(s.map, 0) / before, 1, 1e-6);
}

TEST(WetFilm, AnUnevenSurfaceCrinklesFrontsAndSpreadsThemAsFarInTheMean) {
    Wet s(testing::sheet(0.02, 1, 100));
    FilmParams p = still();
    p.mixing = 2e-9;
    p.unevenness = 0.6;
    const double sigma0 = 0.6e-3, seconds = 1200, sigma2 = sigma0 * sigma0 + 2 * p.mixing * seconds;
    s.wet([](const Vec3&) { return 1.5; });
    s.ink(0, [&](const Vec3& at) { return std::exp(-glm::dot(at, at) / (2 * sigma0 * sigma0)); });
    const double before = s.canvas.total(s.map, 0);
    s.film.advance(s.canvas, seconds, p);
    EXPECT_NEAR(s.canvas.total(s.map, 0) / before, 1, 1e-5);
    Vec3 centre{0};
    double sum = 0, second = 0;
    s.each(
        [&](std::uint32_t slot, int t, const Vec3& at) { sum += s.amount(slot, t), centre += s.amount(slot, t) * at; });
    centre /= sum;
    s.each([&](std::uint32_t slot, int t, const Vec3& at) {
        second += s.amount(slot, t) * glm::dot(at - centre, at - centre);
    });
    // The flow in the large of a plane whose ease is lognormal is that of its geometric mean (of the mean it
    // would be a fifth more); the blot covers a dozen clouds, whose own mean is off by 0.6 / √12.
    EXPECT_NEAR(second / (2 * sum) / sigma2, 1, 0.18);
    // On a ring of two sigma it is a tenth more or less, from place to place; on an even sheet 0.2 %.
    double n = 0, mean = 0, square = 0;
    s.each([&](std::uint32_t slot, int t, const Vec3& at) {
        if (std::abs(glm::length(at) - 2 * std::sqrt(sigma2)) > 1e-4) return;
        const double a = s.amount(slot, t);
        n += 1, mean += a, square += a * a;
    });
    EXPECT_GT(std::sqrt(square / n - mean * mean / (n * n)) / (mean / n), 0.08);
}

TEST(WetFilm, OnASphereItFollowsTheHeatKernel) {
    // Six charts with shear up to 30°, from the kernel of one time to that of a later one.
    const double r = 0.01;
    Wet s(testing::sphere(r, 60));
    FilmParams p = still();
    p.mixing = 2e-9;
    const Vec3 pole = glm::normalize(Vec3{0.9, 0.5, 0.62});  // beside a corner of three charts
    const auto kernel = [&](const Vec3& at, double t) {
        const double x = glm::dot(glm::normalize(at), pole);
        double sum = 0, p0 = 1, p1 = x;
        for (int l = 0; l < 60; ++l) {
            sum += (2 * l + 1) * std::exp(-l * (l + 1) * p.mixing * t / (r * r)) * p0;
            const double p2 = ((2 * l + 3) * x * p1 - (l + 1) * p0) / (l + 2);
            p0 = p1;
            p1 = p2;
        }
        return std::max(0.0, sum) / 60;
    };
    const double t0 = 500, t1 = 1500;  // σ 1.4 to 2.4 mm, texels of 0.26 mm
    s.wet([](const Vec3&) { return 1.0; });
    s.ink(0, [&](const Vec3& at) { return kernel(at, t0); });
    const double before = s.canvas.total(s.map, 0);
    s.film.advance(s.canvas, t1 - t0, p);
    double worst = 0, sum2 = 0, area = 0;
    s.each([&](std::uint32_t slot, int t, const Vec3& at) {
        const double e = (s.amount(slot, t) - kernel(at, t1)) / kernel(pole, t1);
        const auto a = static_cast<double>(s.map.tiles[slot].area[t]);
        worst = std::max(worst, std::abs(e));
        sum2 += e * e * a;
        area += a;
    });
    // Over eleven seams and seven corners; inside one chart it is some 0.1 %.
    EXPECT_LT(worst, 0.04);
    EXPECT_LT(std::sqrt(sum2 / area), 0.004);
    EXPECT_NEAR(s.canvas.total(s.map, 0) / before, 1, 1e-6);
}

TEST(WetFilm, AMoundOfWaterSinksAsBarenblattsSolution) {
    // ∂w/∂t = D/2 ∇²w²: w = τ^-1/2 ⟨C − r²/(16 τ^1/2)⟩ with τ = D t / 2 in units of L = 1 mm.
    Wet s(testing::sheet(0.02, 1, 160));
    FilmParams p = still();
    p.mobility = 1e-9;
    const auto mound = [](const Vec3& at, double tau) {
        const double r2 = glm::dot(at, at) / 1e-6;
        return std::max(0.0, 3 - r2 / (16 * std::sqrt(tau))) / std::sqrt(tau);
    };
    const auto seconds = [&](double tau) { return 2 * tau * 1e-6 / p.mobility; };
    s.wet([&](const Vec3& at) { return mound(at, 0.02); });
    const double before = s.canvas.total_liquid(s.map);
    s.film.advance(s.canvas, seconds(0.3) - seconds(0.02), p);
    double worst = 0;
    s.each([&](std::uint32_t slot, int t, const Vec3& at) {
        worst = std::max(worst, std::abs(s.water(slot, t) - mound(at, 0.3)));
    });
    EXPECT_LT(worst / mound(Vec3{0}, 0.3), 0.01) << "at the front, where the slope jumps";
    EXPECT_NEAR(s.canvas.total_liquid(s.map) / before, 1, 1e-6);
}

/// Barenblatt's solution of ∂u/∂τ = ∇²u³ in the plane, τ in mm²: √⟨C − r² / (18 τ^⅓)⟩ / τ^⅓.
double barenblatt(const Vec3& at, double tau) {
    const double root = std::cbrt(tau);
    return std::sqrt(std::max(0.0, 0.4 - glm::dot(at, at) / 1e-6 / (18 * root))) / root;
}
/// Pores through which liquid flows so that τ = 0.1 passes in a second. u is saturation.
FilmParams seeping() {
    FilmParams p = still();
    p.pores.capacity = 100;
    p.pores.suction = 3 * 0.1e-6 * 1.0903204 * 1.0903204;  // u³ / 3
    return p;
}

TEST(WetFilm, LiquidInPoresSpreadsAsBarenblattsSolution) {
    for (const int charts : {1, 2}) {
        Wet s(testing::sheet(0.012, charts, 120 / charts));
        const FilmParams p = seeping();
        const double from = 1, to = 8;
        s.wet([&](const Vec3& at) { return p.pores.capacity * barenblatt(at, from); }, Liquid::pores);
        const double before = s.canvas.total_liquid(s.map);
        s.film.advance(s.canvas, (to - from) / 0.1, p);
        double sum = 0, square = 0, worst = 0;
        s.each([&](std::uint32_t slot, int t, const Vec3& at) {
            const double e = std::abs(s.water(slot, t, Liquid::pores) / p.pores.capacity - barenblatt(at, to));
            sum += barenblatt(at, to), square += e;
            if (barenblatt(at, to) > 0.5 * barenblatt(Vec3{0}, to)) worst = std::max(worst, e);
        });
        // At the front the slope is vertical: a texel there, of 0.1 mm and 40 on the way round, is half full.
        EXPECT_LT(square / sum, 0.02) << charts;
        EXPECT_LT(worst / barenblatt(Vec3{0}, to), 0.02) << charts;
        EXPECT_NEAR(s.canvas.total_liquid(s.map) / before, 1, 1e-6) << charts;
    }
}

// What seeps runs as Barenblatt's solution runs, outwards at x R'/R. Grains that go (1 − retention) as fast keep
// their places in a disc that grows with R^(1 − retention). Of thin ink, fibres hold c / (c + 0.1) of that.
TEST(WetFilm, FibresHoldGrainsBackFromWhatSeeps) {
    struct Case {
        double retention, held, strength;
    };
    for (const auto& [retention, held, strength] :
         {Case{0, 0, 1e3}, Case{0.5, 0.5, 1e3}, Case{1, 1, 1e3}, Case{1, 0, 1e-3}}) {
        Wet s(testing::sheet(0.012, 1, 120));
        FilmParams p = seeping();
        p.pores.retention = retention;
        const double from = 1, to = 10, growth = std::pow(to / from, 1.0 / 6);
        s.wet([&](const Vec3& at) { return p.pores.capacity * barenblatt(at, from); }, Liquid::pores);
        s.ink(0, [&, factor = strength](const Vec3& at) { return factor * barenblatt(at, from); });
        const auto radius = [&] {
            double sum = 0, square = 0;
            s.each([&](std::uint32_t slot, int t, const Vec3& at) {
                sum += s.amount(slot, t);
                square += s.amount(slot, t) * glm::dot(at, at);
            });
            return std::sqrt(square / sum);
        };
        const double before = s.canvas.total(s.map, 0), start = radius();
        s.film.advance(s.canvas, (to - from) / 0.1, p);
        // Upwind, first order: r² grows by a texel of 0.1 mm times the path, 1.2 mm, more: 3 % of 2 mm squared.
        EXPECT_NEAR(radius() / start, std::pow(growth, 1 - held), 0.03) << retention;
        EXPECT_NEAR(s.canvas.total(s.map, 0) / before, 1, 1e-5) << retention;
    }
}

TEST(WetFilm, AStencilReflectsWhatSpreadsAndLetsNothingPass) {
    // A Gaussian 1.5 mm beside the edge of a stencil edge goes on as it and its image do; on the stencil edge there is
    // nothing. In one chart, and over a seam at right angles to the edge.
    for (const int charts : {1, 2}) {
        Wet s(testing::sheet(0.02, charts, 160.0 / charts));
        FilmParams p = still();
        p.mixing = 2e-9;
        const auto is_free = [&](const Vec3& at) { return at.x > -1.5e-3; };
        s.film.keep_within([&](std::uint32_t slot, int t) { return is_free(Vec3(s.map.position(slot, t))) ? 255 : 0; });
        double edge = -1;  // between the last texels that are masked and the first that are free
        s.each([&](std::uint32_t, int, const Vec3& at) {
            if (!is_free(at)) edge = std::max(edge, at.x + 0.5 * s.map.texel_size);
        });
        const double sigma0 = 0.6e-3, seconds = 500, sigma2 = sigma0 * sigma0 + 2 * p.mixing * seconds;
        const auto gaussian = [&](const Vec3& at, double variance) {
            const Vec3 image{2 * edge - at.x, at.y, at.z};
            return (std::exp(-glm::dot(at, at) / (2 * variance)) + std::exp(-glm::dot(image, image) / (2 * variance))) /
                   variance * 1e-6;
        };
        s.wet([](const Vec3&) { return 1.5; });
        s.ink(0, [&](const Vec3& at) { return is_free(at) ? gaussian(at, sigma0 * sigma0) : 0; });
        const double before = s.canvas.total(s.map, 0);
        s.film.advance(s.canvas, seconds, p);
        double worst = 0;
        s.each([&](std::uint32_t slot, int t, const Vec3& at) {
            if (!is_free(at))
                ASSERT_EQ(s.amount(slot, t), 0);
            else if (glm::length(at) < 6e-3)
                worst = std::max(worst, std::abs(s.amount(slot, t) - gaussian(at, sigma2)));
        });
        // As without stencil edge; over the seam its edge is ragged by part of a texel of 0.125 mm.
        EXPECT_LT(worst / gaussian(Vec3{0}, sigma2), charts == 1 ? 2e-3 : 0.03);
        EXPECT_NEAR(s.canvas.total(s.map, 0) / before, 1, 1e-6);
    }
}

TEST(WetFilm, UniformWaterStaysUniformOverEverySeam) {
    Wet s(testing::sphere(0.01, 48));
    FilmParams p = still();
    p.mobility = 1e-8;
    p.mixing = 1e-9;
    p.pores.capacity = 5;
    s.wet([](const Vec3&) { return 2.0; });
    s.ink(0, [](const Vec3&) { return 0.7; });
    s.film.advance(s.canvas, 20, p);
    s.each([&](std::uint32_t slot, int t, const Vec3&) {
        ASSERT_NEAR(s.water(slot, t), 2, 1e-6);
        ASSERT_NEAR(s.amount(slot, t), 0.7, 1e-6);
    });
}

/// A blot on a ball, heavy, soaking and drying.
FilmParams everything() {
    FilmParams p = film_params(load_substrate("bisque"), {0, 0.6, -0.8});
    p.retained = 0.5;
    return p;
}
void blot(Wet& s) {
    const Vec3 at = glm::normalize(Vec3{1, 0.9, 0.8}) * 0.01;  // over a corner of three charts
    s.wet([&](const Vec3& p) { return 5 * disc(p - at, 3e-3); });
    s.ink(0, [&](const Vec3& p) { return 2 * disc(p - at, 3e-3); });
    s.ink(1, [&](const Vec3& p) { return 1.5 * disc(p - at - Vec3{0, 0, 1e-3}, 1e-3); });
}

TEST(WetFilm, KeepsEveryPigmentAndAllWater) {
    Wet s(testing::sphere(0.01, 64));
    blot(s);
    const double ink0 = s.canvas.total(s.map, 0), ink1 = s.canvas.total(s.map, 1);
    const double water = s.canvas.total_liquid(s.map);
    FilmReport r;
    double gone = 0;
    for (int i = 0; i < 60; ++i) {
        r = s.film.advance(s.canvas, 2, everything());
        gone += r.evaporated;
        EXPECT_NEAR((s.canvas.total_liquid(s.map) + gone) / water, 1, 1e-5);
    }
    gone += s.film.dry(s.canvas, everything()).evaporated;
    EXPECT_FALSE(s.canvas.wet());
    EXPECT_NEAR(gone / water, 1, 1e-5);
    EXPECT_NEAR(s.canvas.total(s.map, 0) / ink0, 1, 1e-5);
    EXPECT_NEAR(s.canvas.total(s.map, 1) / ink1, 1, 1e-5);
}

TEST(WetFilm, ThousandsOfStepsDriftByLessThanTheirRounding) {
    Wet s(testing::sphere(0.002, 18));
    blot(s);
    s.each([&](std::uint32_t slot, int t, const Vec3& p) {
        s.canvas.touch_liquid(slot, Liquid::film)[t] = static_cast<float>(2 + std::sin(900 * p.x));
        s.canvas.touch(slot, 0)[t] = static_cast<float>(1 + std::cos(700 * p.y));
    });
    FilmParams p = everything();
    p.drying.evaporation = p.drying.rim_evaporation = 0;
    const double ink = s.canvas.total(s.map, 0), water = s.canvas.total_liquid(s.map);
    std::size_t steps = 0;
    while (steps < 4000) steps += s.film.advance(s.canvas, 10, p).steps;
    // A drift grows with the steps: 1e-9 in each, a sixtieth of what one value rounds by.
    const double allowed = 1e-9 * static_cast<double>(steps);
    EXPECT_NEAR(s.canvas.total(s.map, 0) / ink, 1, allowed);
    EXPECT_NEAR(s.canvas.total_liquid(s.map) / water, 1, allowed);
}

TEST(WetFilm, PoresNeverHoldMoreThanTheirCapacityAndNothingGetsNegative) {
    for (const double shortest : {0.0, 0.05}) {  // the second far beyond what stability allows
        Wet s(testing::sphere(0.01, 48));
        FilmParams p = film_params(load_substrate("rice-paper"), {0, 0, -1});
        p.mobility = 2e-8;
        p.pores.capacity = 1.2;
        p.retained = 0;
        p.shortest_step = shortest;
        blot(s);
        const double ink = s.canvas.total(s.map, 0);
        for (int i = 0; i < 20; ++i) {
            s.film.advance(s.canvas, 0.5, p);
            s.each([&](std::uint32_t slot, int t, const Vec3&) {
                ASSERT_LE(s.water(slot, t, Liquid::pores), 1.2f);
                ASSERT_GE(s.water(slot, t, Liquid::pores), 0);
                ASSERT_GE(s.water(slot, t), 0);
                ASSERT_GE(s.amount(slot, t), 0);
            });
        }
        EXPECT_NEAR(s.canvas.total(s.map, 0) / ink, 1, 1e-5) << shortest;
    }
}

/// Σ |difference| of all texels' water between steps of 0.24 s and their halves, and so on.
std::vector<double> halvings(const FilmParams& p, int n) {
    const auto after = [&](int parts) {
        Wet s(testing::sheet(0.01, 2, 40));
        s.wet([](const Vec3& at) { return 3 * disc(at, 2.5e-3, 1e-3); });
        s.ink(0, [](const Vec3& at) { return 2 * disc(at, 2.5e-3, 1e-3); });
        for (int i = 0; i < 40 * parts; ++i) s.film.advance(s.canvas, 0.24 / parts, p);
        std::vector<double> water;
        s.each([&](std::uint32_t slot, int t, const Vec3&) {
            water.push_back(s.water(slot, t) + s.water(slot, t, Liquid::pores));
        });
        return water;
    };
    std::vector<double> out;
    std::vector<double> last = after(1);
    for (int i = 0; i < n; ++i) {
        const std::vector<double> next = after(2 << i);
        double sum = 0;
        for (std::size_t t = 0; t < last.size(); ++t) sum += std::abs(next[t] - last[t]);
        out.push_back(sum / static_cast<double>(last.size()));
        last = next;
    }
    return out;
}

TEST(WetFilm, HalvingTheStepHalvesTheError) {
    FilmParams p = film_params(load_substrate("bisque"));
    p.unevenness = 0;       // its easiest place would set the steps
    p.ripples.tension = 0;  // it is implicit: what it levels faster than a step lasts is not followed
    p.mobility = 1e-9;
    // Texels get wet and dry at times that fall to either side of a step: convergence in the mean.
    const std::vector<double> all = halvings(p, 4);
    EXPECT_LT(all[3], all[0] / 2);
    EXPECT_LT(all[0], 4e-4) << "film units, of 3: at fronts, whose slope is vertical";
    p.pin = 1e6;
    p.drying.evaporation = p.drying.rim_evaporation = 0;
    p.pores.capacity = p.pores.absorbency = 0;  // a step in the pores has now one stage more, now one less
    const std::vector<double> smooth = halvings(p, 4);
    EXPECT_NEAR(smooth[2] / smooth[3], 2, 0.1) << "first order in time";
}

TEST(WetFilm, ThreadsDoNotChangeABit) {
    std::uint64_t hashes[2];
    for (int i = 0; i < 2; ++i) {
        set_thread_count(i ? 4 : 1);
        Wet s(testing::sphere(0.01, 64));
        blot(s);
        s.film.advance(s.canvas, 20, everything());
        hashes[i] = s.canvas.hash();
    }
    set_thread_count(0);
    EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(WetFilm, ADryCanvasCostsNothingAndOnlyWetTilesDo) {
    Wet s(testing::sheet(0.02, 1, 320));
    s.ink(0, [](const Vec3& at) { return disc(at, 8e-3); });
    const std::uint64_t hash = s.canvas.hash();
    const FilmReport none = s.film.advance(s.canvas, 100, everything());
    EXPECT_EQ(none.steps + none.tile_steps, 0u);
    EXPECT_EQ(s.canvas.hash(), hash);
    EXPECT_TRUE(s.canvas.plane(s.canvas.touched_slots()[0], 0)) << "an open film that never was wet stays open";
    const std::uint32_t slot = atlas::texel_ref(s.map, 168, 168).slot;
    s.canvas.touch_liquid(slot, Liquid::film)[8 * 16 + 8] = 1;  // a drop in the middle of a tile
    std::size_t calls = 0;
    const FilmReport one =
        s.film.advance(s.canvas, 1, film_params(load_substrate("porcelain")), [&](std::uint32_t) { ++calls; });
    EXPECT_GT(one.steps, 0u);
    EXPECT_LE(one.tile_steps, 9u + one.steps) << "its own tile, and once those round it";
    EXPECT_LE(calls, 9u);
    EXPECT_EQ(s.film.advance(s.canvas, 300, film_params(load_substrate("porcelain"))).evaporated > 0, true);
    EXPECT_FALSE(s.canvas.wet());
}

TEST(WetFilm, ADryingSpotHasADarkRim) {
    Wet s(testing::sheet(0.012, 1, 120));
    s.wet([](const Vec3& at) { return 3 * disc(at, 3e-3); });
    s.ink(0, [](const Vec3& at) { return disc(at, 3e-3); });
    FilmParams p = film_params(load_substrate("bisque"));
    p.pores.capacity = p.pores.absorbency = p.drying.stain = 0;
    s.film.dry(s.canvas, p);
    double middle = 0, rim = 0;
    s.each([&](std::uint32_t slot, int t, const Vec3& at) {
        if (glm::length(at) < 1e-3) middle = std::max(middle, s.amount(slot, t));
        rim = std::max(rim, s.amount(slot, t));
    });
    EXPECT_GT(rim, 1.5 * middle);
    EXPECT_LT(middle, 1);
}

TEST(WetFilm, CleanWaterPushesInkAway) {
    // A drop of water into a damp wash: a backrun, lighter inside and darker at its front.
    Wet s(testing::sheet(0.016, 1, 160));
    s.wet([](const Vec3&) { return 0.8; });
    s.ink(0, [](const Vec3&) { return 1.0; });
    s.wet([](const Vec3& at) { return 0.8 + 5 * disc(at, 1.5e-3); });
    FilmParams p = film_params(load_substrate("bisque"));
    p.pores.capacity = p.pores.absorbency = 0;
    const double before = s.canvas.total(s.map, 0);
    for (const bool dry : {false, true}) {
        if (dry)
            s.film.dry(s.canvas, p);
        else
            s.film.advance(s.canvas, 10, p);
        // Means over rings of 0.2 mm.
        std::array<double, 40> sum{}, n{};
        s.each([&](std::uint32_t slot, int t, const Vec3& at) {
            const auto ring = static_cast<std::size_t>(glm::length(at) / 0.2e-3);
            if (ring < 40) sum[ring] += s.amount(slot, t), n[ring] += 1;
        });
        for (std::size_t i = 0; i < 40; ++i) sum[i] /= n[i];
        const auto front = static_cast<std::size_t>(std::max_element(sum.begin(), sum.end()) - sum.begin());
        for (int i = 0; i < 5; ++i) EXPECT_LT(sum[i], 0.75) << "within a millimetre";
        EXPECT_GT(sum[front], 1.1) << "of the wash far away";
        EXPECT_NEAR(sum[39], 1, 0.01);
        EXPECT_GT(front, 7u) << "beyond the drop's radius of 1.5 mm";
        EXPECT_NEAR(s.canvas.total(s.map, 0) / before, 1, 1e-6);
    }
}

}  // namespace
}  // namespace tuft::ink
