#include <gtest/gtest.h>

#include <cmath>

#include "../atlas/analytic_surfaces.h"
#include "core/system/parallel.h"
#include "ink/film/film.h"

// Ink that runs down a wall.
namespace tuft::ink {
namespace {

using atlas::TexelMap;

/// A wall of 24 × 40 mm of glazed porcelain, 8 texels a millimetre, in one chart turned by `angle`
/// in the atlas, or in two with the seam down its middle, the right one turned by a quarter.
testing::Unwrapped wall(double angle, bool cut) {
    const double width = 24e-3, height = 40e-3, per_metre = 8e3;
    const Vec2 across{std::cos(angle), std::sin(angle)}, up{-across.y, across.x};
    const auto part = [&](double from, double to, const Vec2& at, const Vec2& x, const Vec2& y) {
        testing::Patch p = testing::flat({from, 0, -0.5 * height}, {to - from, 0, 0}, {0, 0, height}, 8, 16);
        testing::place(p, at, (to - from) * per_metre * x, height * per_metre * y);
        return p;
    };
    if (!cut)
        return testing::build(
            {part(-0.5 * width, 0.5 * width, {8.21 + height * per_metre * std::sin(angle), 8.13}, across, up)}, 450);
    return testing::build(
        {part(-0.5 * width, 0, {8.21, 8.13}, {1, 0}, {0, 1}), part(0, 0.5 * width, {450.4, 20.3}, {0, 1}, {-1, 0})},
        480);
}

struct Wall {
    testing::Unwrapped u;
    TexelMap map;
    WetFilm film;
    Canvas canvas;

    explicit Wall(double angle = 0, bool cut = false)
        : u(wall(angle, cut)),
          map(atlas::build_texel_map(u.mesh, u.atlas)),
          film(map, atlas::build_seam_links(u.mesh, u.atlas, map)),
          canvas(map.n_slots()) {
        canvas.add_pigment(load_ink("carbon").parts[0].pigment);
    }
    template <class Fn>
    void each(Fn&& fn) const {
        for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot)
            for (int t = 0; t < atlas::kTileTexels; ++t)
                if (map.tiles[slot].cluster[t] != atlas::kNoCluster) fn(slot, t, Vec3(map.position(slot, t)));
    }
    /// A blot of `radius` about (0, 12 mm), `film` thick, a tenth of it ink; as much of it however the
    /// texels lie.
    void blot(double thickness, double radius) {
        const auto part = [&](const Vec3& p) {
            return std::clamp((radius - glm::distance(p, Vec3{0, 0, 12e-3})) / 0.3e-3 + 0.5, 0.0, 1.0);
        };
        double area = 0;
        each([&](std::uint32_t slot, int t, const Vec3& p) {
            area += part(p) * static_cast<double>(map.tiles[slot].area[t]);
        });
        thickness *= std::numbers::pi * radius * radius / area;
        each([&](std::uint32_t slot, int t, const Vec3& p) {
            if (!(part(p) > 0)) return;
            canvas.touch_liquid(slot, Liquid::film)[t] = static_cast<float>(thickness * part(p));
            canvas.touch(slot, 0)[t] = static_cast<float>(0.1 * thickness * part(p));
        });
    }
    double ink(std::uint32_t slot, int t) const {
        double sum = 0;
        for (int film_index = 0; film_index < kFilms; ++film_index)
            if (const Plane* p = canvas.film_plane(slot, film_index, 0)) sum += static_cast<double>((*p)[t]);
        return sum;
    }
    /// Mean ink in squares of `side` metres, [n × n] from (−n/2, n/2) side downwards.
    std::vector<double> squares(double side, int n) const {
        std::vector<double> sum(static_cast<std::size_t>(n * n)), area(sum.size());
        each([&](std::uint32_t slot, int t, const Vec3& p) {
            const int x = static_cast<int>(std::floor(p.x / side)) + n / 2,
                      y = static_cast<int>(std::floor(-p.z / side)) + n / 2;
            if (x < 0 || y < 0 || x >= n || y >= n) return;
            const auto a = static_cast<double>(map.tiles[slot].area[t]);
            sum[static_cast<std::size_t>(y * n + x)] += ink(slot, t) * a;
            area[static_cast<std::size_t>(y * n + x)] += a;
        });
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = area[i] > 0 ? sum[i] / area[i] : 0;
        return sum;
    }
    double lowest() const {
        double z = 1;
        each([&](std::uint32_t slot, int t, const Vec3& p) {
            if (ink(slot, t) > 0.01) z = std::min(z, p.z);
        });
        return z;
    }
};

FilmParams porcelain(const Vec3& down = {0, 0, -1}) {
    return film_params(load_substrate("porcelain"), down);
}

/// A drop of three times the critical volume.
void drop(Wall& w) {
    w.blot(8, 1.5e-3);
}

/// Σ |a − b| over Σ a of means over squares of 1 mm, down to 3 mm above the lowest ink: of the trails.
double difference(const Wall& a, const Wall& b) {
    const std::vector<double> one = a.squares(1e-3, 40), other = b.squares(1e-3, 40);
    const auto rows = static_cast<std::size_t>(20 - std::max(a.lowest(), b.lowest()) / 1e-3 - 3);
    double sum = 0, apart = 0;
    for (std::size_t i = 0; i < 40 * rows; ++i) apart += std::abs(one[i] - other[i]), sum += one[i];
    return apart / sum;
}

TEST(Drips, AThinFilmStaysAndAThickOneRuns) {
    for (const double thickness : {2.0, 3.5}) {
        Wall w;
        w.blot(thickness, 4e-3);
        w.film.advance(w.canvas, 6, porcelain());
        if (thickness < 3)
            EXPECT_NEAR(w.lowest(), 8e-3, 0.3e-3) << "two texels";
        else
            EXPECT_LT(w.lowest(), 5e-3);
    }
}

// Of a vertical wall of porcelain: R_c = 2 l √(θ / π) = 1.18 mm at θ = 0.15. A contact line that moves holds 0.65 of
// what one at rest does, so that a running bead stops at 1.06 √0.65 R_c = 1.0 mm.
constexpr double kLastRadius = 1.0e-3, kCapInk = 0.1 * 0.5 * 0.15 * kLastRadius / kFilmUnit;

TEST(Drips, ADropRunsInANarrowTrailUntilTheTrailHasUsedItUpAndEndsInABead) {
    Wall thick;
    thick.blot(8, 1.25e-3);  // twice the critical volume
    const double ink = thick.canvas.total(thick.map, 0), water = thick.canvas.total_liquid(thick.map);
    const double gone = thick.film.advance(thick.canvas, 15, porcelain()).evaporated;
    EXPECT_NEAR(thick.canvas.total(thick.map, 0) / ink, 1, 1e-5);
    EXPECT_NEAR((thick.canvas.total_liquid(thick.map) + gone) / water, 1, 1e-5);

    const double end = thick.lowest();
    EXPECT_LT(end, 0);
    EXPECT_GT(end, -18e-3) << "or else the wall ends before the trail";
    thick.film.advance(thick.canvas, 5, porcelain());
    EXPECT_NEAR(thick.lowest(), end, 0.3e-3);
    // Lying at half the angle it is 2^(1/3) as wide, and drawn out by five radii behind.
    const double wide = 2 * std::cbrt(2.0) * kLastRadius;
    double trail = 0, most_bead = 0, most_trail = 0, most_early = 0;
    std::array<double, 2> sides{1, -1};
    thick.each([&](std::uint32_t slot, int t, const Vec3& p) {
        const double above = p.z - end, amount = thick.ink(slot, t),
                     area = static_cast<double>(thick.map.tiles[slot].area[t]);
        if (above < 8e-3) most_bead = std::max(most_bead, amount);
        if (above < 2.5e-3 && amount > 0.01) sides = {std::min(sides[0], p.x), std::max(sides[1], p.x)};
        if (above > 8.5e-3 && above < 9.5e-3) most_trail = std::max(most_trail, amount);
        if (above > 8.5e-3 && above < 9.5e-3 && amount > 0.01) trail += area / 1e-3;
        if (p.z > 8e-3 && p.z < 9e-3) most_early = std::max(most_early, amount);
    });
    EXPECT_NEAR((sides[1] - sides[0]) / wide, 1, 0.1) << "a texel on each side";
    EXPECT_GT(trail, 1.9e-3) << "√(R R_k), R_k = 0.95 mm";
    EXPECT_LT(trail, wide);
    EXPECT_GT(most_bead, 3 * most_trail);
    EXPECT_LT(most_bead, 0.4 * kCapInk) << "it fades into its trail";
    // In 9 mm of trail is 0.6 of what the last bead has: R there is 1.17 mm, its pace 0.51, to the power of 2/3.
    EXPECT_NEAR(most_trail / most_early, 0.64, 0.05);
}

// Texels lie otherwise at the edges of the squares, but the trail gets thin towards its edges.
constexpr double kTexelsOfSquares = 0.05;
constexpr double kRoughness = 0.2e-3;  // metres, where drops have come to after 17 mm: as texels lie, 0.1 mm apart

TEST(Drips, TheDirectionOfTexelsDoesNotShow) {
    Wall straight, turned(std::numbers::pi / 6);
    for (Wall* w : {&straight, &turned}) {
        drop(*w);
        w->film.advance(w->canvas, 6, porcelain());
    }
    EXPECT_LT(difference(straight, turned), kTexelsOfSquares);
    EXPECT_NEAR(straight.lowest(), turned.lowest(), kRoughness);
}

TEST(Drips, BeadsCrossASeamAsIfThereWereNone) {
    Wall whole, cut(0, true);
    for (Wall* w : {&whole, &cut}) {
        drop(*w);
        w->film.advance(w->canvas, 6, porcelain(glm::normalize(Vec3{0.3, 0, -1})));
    }
    EXPECT_LT(difference(whole, cut), kTexelsOfSquares);
    EXPECT_NEAR(whole.lowest(), cut.lowest(), kRoughness);
}

TEST(Drips, ABeadDriesBluntInFrontAndRunsOutIntoItsTrail) {
    for (const double angle : {0.0, 0.4}) {
        Wall w(angle);
        drop(w);
        w.film.dry(w.canvas, porcelain());
        // Means over squares of 0.3 mm from the middle of the head on; a texel is 0.125 mm.
        constexpr double kSquare = 0.3e-3;
        Vec3 middle{0};
        double sum = 0;
        w.each([&](std::uint32_t slot, int t, const Vec3& p) {
            if (const double ink = w.ink(slot, t); ink > 0.12) sum += ink, middle += ink * p;
        });
        ASSERT_GT(sum, 0);
        middle /= sum;
        const auto at = [&](double x, double z) {
            double mean = 0, n = 0;
            w.each([&](std::uint32_t slot, int t, const Vec3& p) {
                if (std::abs(p.x - middle.x - x) < 0.5 * kSquare && std::abs(p.z - middle.z - z) < 0.5 * kSquare)
                    mean += w.ink(slot, t), n += 1;
            });
            return mean / n;
        };
        const double head = at(0, 0);
        EXPECT_LT(head, 0.4 * kCapInk);
        for (const double z : {-0.3e-3, 0.0, 0.6e-3, 1.2e-3})
            EXPECT_NEAR(at(0.5e-3, z) / at(-0.5e-3, z), 1, 0.1) << "its two sides, turned by " << angle;
        double behind = 0, front = 0, above = at(0, 0.3e-3);
        for (double z = 0.6e-3; z < 5e-3; z += kSquare) {
            const double ink = at(0, z);
            EXPECT_LT(ink, 1.02 * above) << "thinner and thinner; texels under a square vary";
            if (ink > 0.5 * head) behind = z;
            above = ink;
        }
        EXPECT_LT(above, 0.07) << "the trail has 0.046";
        for (double z = -kSquare; z > -3e-3; z -= kSquare)
            if (at(0, z) > 0.5 * head) front = -z;
        EXPECT_GT(behind, 1.3 * front);
    }
}

// A bead at rest is drawn out into the trail that it came down on, and no further: nothing flows uphill. 0.6 mm: the
// blot's soft edge of 0.15 mm, and three texels over which the cap of a bead that hardly moved rounds it.
TEST(Drips, NothingRisesAboveWhereItWasDeposited) {
    for (const auto& [thickness, radius] :
         {std::pair{6.0, 0.75e-3}, {7.0, 0.75e-3}, {8.0, 0.75e-3}, {9.0, 0.75e-3}, {8.0, 1.25e-3}}) {
        Wall w;
        w.blot(thickness, radius);
        w.film.advance(w.canvas, 15, porcelain());
        double top = -1;
        w.each([&](std::uint32_t slot, int t, const Vec3& p) {
            if (w.ink(slot, t) > 0.002) top = std::max(top, p.z);
        });
        EXPECT_LT(top, 12e-3 + radius + 0.6e-3) << thickness << ", down to " << w.lowest();
    }
}

// Dots of 0.77 to 0.88 of the critical radius, which hold at the weakest places (grain 0.8: 0.89 of it), as high as
// caps of their volume that run. 0.3 mm: two texels.
TEST(Drips, AThickDotOnDrySurfaceStaysWhereItsVolumeIsHeld) {
    for (const double part : {0.77, 0.82, 0.88})
        for (const double thickness : {7.0, 8.0, 9.0}) {
            const double critical = 1.18e-3, volume = 0.25 * std::numbers::pi * 0.15 * std::pow(part * critical, 3);
            const double radius = std::sqrt(volume / (std::numbers::pi * thickness * kFilmUnit));
            Wall w;
            w.blot(thickness, radius);
            const double lowest = w.lowest();
            w.film.advance(w.canvas, 10, porcelain());
            EXPECT_NEAR(w.lowest(), lowest, 0.3e-3) << part << " of the critical radius, " << thickness << " thick";
        }
}

TEST(Drips, BeadsStopAtAStencil) {
    for (const bool cut : {false, true}) {
        Wall w(0, cut);
        w.film.keep_within([&](std::uint32_t slot, int t) { return w.map.position(slot, t).z > 5e-3f ? 255 : 0; });
        drop(w);
        const double ink = w.canvas.total(w.map, 0);
        w.film.advance(w.canvas, 6, porcelain());
        EXPECT_GE(w.lowest(), 5e-3);
        EXPECT_LT(w.lowest(), 5.2e-3) << "it ran as far as that";
        EXPECT_NEAR(w.canvas.total(w.map, 0) / ink, 1, 1e-5);
    }
}

TEST(Drips, GentlerSlopesTakeMoreLiquid) {
    for (const double steepness : {1.0, 0.15}) {
        Wall w;
        drop(w);
        w.film.advance(w.canvas, 3, porcelain({0, std::sqrt(1 - steepness * steepness), -steepness}));
        EXPECT_EQ(w.lowest() < 6e-3, steepness == 1.0) << "critical radius 1.2 mm, and 3 mm with 17 times the volume";
    }
}

TEST(Drips, ThreadsAndTheLengthOfCallsChangeNothingThatMatters) {
    std::uint64_t hashes[2];
    double ends[2];
    for (int i = 0; i < 2; ++i) {
        set_thread_count(i ? 3 : 1);
        Wall w;
        drop(w);
        w.film.advance(w.canvas, 2, porcelain());
        hashes[i] = w.canvas.hash();
    }
    set_thread_count(0);
    EXPECT_EQ(hashes[0], hashes[1]);
    for (int i = 0; i < 2; ++i) {
        Wall w;
        drop(w);
        for (int part = 0; part < (i ? 30 : 1); ++part) w.film.advance(w.canvas, i ? 0.1 : 3, porcelain());
        ends[i] = w.lowest();
    }
    EXPECT_NEAR(ends[0], ends[1], 1e-3) << "of some 15 mm";
}

}  // namespace
}  // namespace tuft::ink
