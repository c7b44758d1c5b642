#include "ink/texels/pool.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "../atlas/analytic_surfaces.h"
#include "core/system/parallel.h"
#include "ink/film/film.h"
#include "texels.h"

// Thin ink over thick dry paint.
namespace tuft::ink {
namespace {

constexpr double kSideLength = 8e-3, kWave = 1e-3;  // metres

/// A sheet of 8 mm in n × n charts, 20 texels a millimetre, with dry furrows `deep` micrometres deep across x, and 2
/// film units of ink in the open film.
struct Furrowed {
    testing::Unwrapped u;
    atlas::TexelMap map;
    atlas::SeamLinks seams;
    Canvas canvas;
    std::vector<TileSnapshot> before;

    explicit Furrowed(double deep, int n = 1, double shift = 0)
        : u(testing::sheet(kSideLength, n, 160.0 / n)),
          map(atlas::build_texel_map(u.mesh, u.atlas)),
          seams(atlas::build_seam_links(u.mesh, u.atlas, map)),
          canvas(map.n_slots()) {
        canvas.add_pigment({.name = "thick", .height = 5e-6f});
        canvas.add_pigment({.name = "a", .height = 2e-6f});
        canvas.add_pigment({.name = "b", .height = 2e-6f});
        each([&](std::uint32_t slot, int t, const Vec3& p) {
            canvas.touch_film(slot, kFirstDryFilm, 0)[t] = static_cast<float>((60 + deep * ridge(p.x + shift)) / 5);
        });
        for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot) before.push_back(canvas.snapshot(slot));
        each([&](std::uint32_t slot, int t, const Vec3& p) {
            const double part = p.y > 0 ? 0.25 : 0.75;
            canvas.touch(slot, 1)[t] = static_cast<float>(2 * part);
            canvas.touch(slot, 2)[t] = static_cast<float>(2 * (1 - part));
        });
    }
    /// 0 at the bottom of a furrow, 1 on the ridge.
    static double ridge(double x) { return std::abs(2 * (x / kWave - std::floor(x / kWave)) - 1); }
    template <class Fn>
    void each(Fn&& fn) const {
        for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot)
            for (int t = 0; t < kN; ++t)
                if (map.tiles[slot].cluster[t] != atlas::kNoCluster) fn(slot, t, Vec3(map.position(slot, t)));
    }
    double film(std::uint32_t slot, int t) const {
        return static_cast<double>((*canvas.plane(slot, 1))[t]) + static_cast<double>((*canvas.plane(slot, 2))[t]);
    }
    void settle(const PoolOptions& options = {}) {
        std::vector<const TileSnapshot*> tiles;
        for (const TileSnapshot& b : before) tiles.push_back(&b);
        pool(canvas, map, seams, tiles, options);
    }
};

/// Where a film of 2 stands in furrows `deep` micrometres deep: max(ridge_film, level − z) holds as much.
double level_in(double deep, double ridge_film) {
    double low = 0, high = deep / 10 + 2;
    for (int i = 0; i < 60; ++i) {
        const double level = 0.5 * (low + high);
        double sum = 0;
        constexpr int kParts = 1000;
        for (int k = 0; k < kParts; ++k) sum += std::max(ridge_film, level - deep / 10 * (k + 0.5) / kParts) / kParts;
        (sum < 2 ? low : high) = level;
    }
    return low;
}

TEST(Pool, StandsLevelInTheFurrowsAndThinOnTheRidges) {
    const PoolOptions options;
    for (const double deep : {60.0, 150.0}) {
        Furrowed f(deep);
        f.settle(options);
        const double level = level_in(deep, options.ridge_film);
        double apart = 0, n = 0, thinnest = 9;
        f.each([&](std::uint32_t slot, int t, const Vec3& p) {
            if (std::abs(p.x) > 3e-3 || std::abs(p.y) > 3e-3) return;  // the sheet's ends stop what would flow on
            const double z = deep / 10 * Furrowed::ridge(p.x), w = f.film(slot, t);
            thinnest = std::min(thinnest, w);
            apart += std::abs(w - std::max(options.ridge_film, level - z));
            n += 1;
        });
        EXPECT_LT(apart / n, 0.1) << "film units of 2 in the mean: a texel is a tenth of a furrow's side, deep "
                                  << deep;
        EXPECT_NEAR(thinnest, options.ridge_film, 0.05);
    }
}

TEST(Pool, KeepsEachPigmentOverSeamsAndOnAnyNumberOfThreads) {
    std::map<int, std::uint64_t> hashes;
    for (const int threads : {1, 3}) {
        set_thread_count(threads);
        Furrowed f(150, 2);
        const double a = f.canvas.total(f.map, 1), b = f.canvas.total(f.map, 2), thick = f.canvas.total(f.map, 0);
        f.settle();
        EXPECT_NEAR(f.canvas.total(f.map, 1) / a, 1, 1e-6) << "floats";
        EXPECT_NEAR(f.canvas.total(f.map, 2) / b, 1, 1e-6);
        EXPECT_EQ(f.canvas.total(f.map, 0), thick);
        hashes[threads] = f.canvas.hash();
    }
    set_thread_count(0);
    EXPECT_EQ(hashes[1], hashes[3]);
}

/// Means of `film` about ridges and bottoms, 0.5 mm wide and 0.25 mm along: what is beside the seam too.
void expect_same_means(const Furrowed& whole, const Furrowed& cut) {
    const auto means = [](const Furrowed& f) {
        std::map<std::pair<int, int>, std::pair<double, double>> sums;
        f.each([&](std::uint32_t slot, int t, const Vec3& p) {
            if (std::abs(p.x) > 1e-3 || std::abs(p.y) > 1e-3) return;
            auto& [sum, area] =
                sums[{static_cast<int>(std::floor(p.x / 0.5e-3)), static_cast<int>(std::floor(p.y / 0.25e-3))}];
            sum += f.film(slot, t) * static_cast<double>(f.map.tiles[slot].area[t]);
            area += static_cast<double>(f.map.tiles[slot].area[t]);
        });
        return sums;
    };
    const auto a = means(whole), b = means(cut);
    double least = 9, most = 0;
    for (const auto& [place, sum] : a) {
        const auto& other = b.at(place);
        const double film = sum.first / sum.second;
        EXPECT_NEAR(film, other.first / other.second, 0.2) << "half a texel of ten, at an edge with 2 to 4";
        least = std::min(least, film);
        most = std::max(most, film);
    }
    EXPECT_LT(least, 0.8) << "it did run off the ridges";
    EXPECT_GT(most, 3.2);
}

TEST(Pool, ASeamDoesNotShow) {
    // The seam at x = 0 runs half way down a furrow's side, that at y = 0 across all of them.
    Furrowed whole(150, 1, 0.25e-3), cut(150, 2, 0.25e-3);
    for (Furrowed* f : {&whole, &cut}) f->settle();
    expect_same_means(whole, cut);
}

TEST(Pool, StopsAtAStencil) {
    Furrowed f(150, 2);
    const auto masked = [&](std::uint32_t slot, int t) { return f.map.position(slot, t).x > 0.4e-3f; };
    const auto under = [&] {
        std::vector<float> out;
        f.each([&](std::uint32_t slot, int t, const Vec3&) {
            if (masked(slot, t)) out.push_back((*f.canvas.plane(slot, 1))[t]);
        });
        return out;
    };
    const std::vector<float> before = under();
    const double all = f.canvas.total(f.map, 1);
    f.settle({.free = [&](std::uint32_t slot, int t) { return !masked(slot, t); }});
    EXPECT_EQ(under(), before);
    EXPECT_NEAR(f.canvas.total(f.map, 1) / all, 1, 1e-6);
}

TEST(Pool, LeavesASmoothSubstrateAsItIsPainted) {
    Furrowed thin(0);  // 60 µm all over, level
    thin.each(
        [&](std::uint32_t slot, int t, const Vec3&) { thin.canvas.touch_film(slot, kFirstDryFilm, 0)[t] = 5.9f; });
    thin.each([&](std::uint32_t slot, int t, const Vec3& p) { thin.canvas.touch(slot, 1)[t] = p.x > 0 ? 2 : 1; });
    const std::uint64_t hash = thin.canvas.hash();
    thin.settle();
    EXPECT_EQ(thin.canvas.hash(), hash) << "29.5 µm are no relief";
}

/// Lets 2 film units of liquid that carry the ink run for `seconds` without drying; steps of `shortest` at least.
FilmParams wash(const Vec3& down = Vec3{0}) {
    FilmParams p = film_params(load_substrate("porcelain"), down);
    p.evaporation = p.rim_evaporation = 0;
    return p;
}
void run_wet(Furrowed& f, double seconds, const FilmParams& p) {
    f.each([&](std::uint32_t slot, int t, const Vec3&) { f.canvas.touch_liquid(slot, Liquid::film)[t] = 2; });
    const double before = f.canvas.total_liquid(f.map);
    WetFilm(f.map, f.seams).advance(f.canvas, seconds, p);
    EXPECT_NEAR(f.canvas.total_liquid(f.map) / before, 1, 1e-6) << "floats";
}

TEST(WetPool, StandsLevelInTheFurrowsAndThinOnTheRidges) {
    // With and without weight, which acts against the wall here and moves nothing along it.
    for (const Vec3& down : {Vec3{0}, Vec3{0, 0, -1}}) {
        const FilmParams p = wash(down);
        Furrowed f(150);
        run_wet(f, 30, p);
        const double level = level_in(150, p.ridge);
        double apart = 0, n = 0, thinnest = 9;
        f.each([&](std::uint32_t slot, int t, const Vec3& at) {
            if (std::abs(at.x) > 3e-3 || std::abs(at.y) > 3e-3) return;
            const double w = static_cast<double>((*f.canvas.liquid(slot, Liquid::film))[t]);
            thinnest = std::min(thinnest, w);
            apart += std::abs(w - std::max(p.ridge, level - 15 * Furrowed::ridge(at.x)));
            n += 1;
        });
        EXPECT_LT(apart / n, 0.1) << "film units of 2 in the mean, as for still ink";
        EXPECT_NEAR(thinnest, p.ridge, 0.05);
    }
}

TEST(WetPool, KeepsEachPigmentOverSeamsAndOnAnyNumberOfThreads) {
    std::map<int, std::uint64_t> hashes;
    for (const int threads : {1, 3}) {
        set_thread_count(threads);
        Furrowed f(150, 2);
        const double a = f.canvas.total(f.map, 1), b = f.canvas.total(f.map, 2), thick = f.canvas.total(f.map, 0);
        run_wet(f, 3, wash());
        EXPECT_NEAR(f.canvas.total(f.map, 1) / a, 1, 1e-6) << "floats";
        EXPECT_NEAR(f.canvas.total(f.map, 2) / b, 1, 1e-6);
        EXPECT_EQ(f.canvas.total(f.map, 0), thick);
        hashes[threads] = f.canvas.hash();
    }
    set_thread_count(0);
    EXPECT_EQ(hashes[1], hashes[3]);
}

TEST(WetPool, ASeamDoesNotShow) {
    Furrowed whole(150, 1, 0.25e-3), cut(150, 2, 0.25e-3);
    for (Furrowed* f : {&whole, &cut}) run_wet(*f, 10, wash());
    expect_same_means(whole, cut);
}

TEST(WetPool, ShorterStepsChangeLittle) {
    // While it runs off, in steps as long as a film may take and a quarter as long.
    Furrowed coarse(150), fine(150);
    FilmParams p = wash();
    run_wet(coarse, 0.5, p);
    p.shortest_step /= 4;
    const double before = 2;
    run_wet(fine, 0.5, p);
    double apart = 0, moved = 0, n = 0;
    coarse.each([&](std::uint32_t slot, int t, const Vec3& at) {
        if (std::abs(at.x) > 3e-3 || std::abs(at.y) > 3e-3) return;
        const double a = static_cast<double>((*coarse.canvas.liquid(slot, Liquid::film))[t]);
        const double b = static_cast<double>((*fine.canvas.liquid(slot, Liquid::film))[t]);
        apart += std::abs(a - b), moved += std::abs(b - before), n += 1;
    });
    EXPECT_GT(moved / n, 0.5) << "film units";
    EXPECT_LT(apart, 0.03 * moved);
}

}  // namespace
}  // namespace tuft::ink
