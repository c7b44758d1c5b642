#include "ink/texels/drying.h"

#include <gtest/gtest.h>

#include <memory>
#include <span>

#include "core/random.h"
#include "core/system/parallel.h"
#include "ink/composite/composite.h"
#include "texels.h"

namespace tuft::ink {
namespace {

constexpr std::array<const char*, 4> kInks{"carbon", "cinnabar", "gamboge", "titanium-white"};

Canvas canvas_of(std::uint32_t slots) {
    Canvas canvas(slots);
    for (const char* name : kInks) canvas.add_pigment(load_ink(name).parts[0].pigment);
    return canvas;
}

std::array<std::uint8_t, kN> every_texel() {
    std::array<std::uint8_t, kN> all;
    all.fill(1);
    return all;
}

/// Random amounts of some of the pigments in the open film.
void paint(Canvas& canvas, std::uint64_t seed) {
    for (int p = 0; p < 4; ++p) {
        if (p > 0 && uniform(seed, 1000 + p) < 0.4) continue;
        for (int t = 0; t < kN; ++t) canvas.touch(0, p)[t] += static_cast<float>(2 * uniform(seed + 77 * p, t));
    }
}

double on_texel(const Canvas& canvas, int pigment, int t) {
    double sum = 0;
    for (int film = 0; film < kFilms; ++film)
        if (const Plane* w = canvas.film_plane(0, film, pigment)) sum += static_cast<double>((*w)[t]);
    return sum;
}

float worst(const TileAppearance& a, const TileAppearance& b) {
    float worst = 0;
    for (std::size_t band = 0; band < a.colour.size(); ++band)
        for (int t = 0; t < kN; ++t) worst = std::max(worst, std::abs(a.colour[band][t] - b.colour[band][t]));
    return worst;
}

TEST(Drying, DoesNotChangeTheColourByABit) {
    Canvas canvas = canvas_of(1);
    const Substrate paper = load_substrate("rice-paper");
    for (int coat = 0; coat < kDryFilms; ++coat) {
        paint(canvas, 10 + coat);
        const TileAppearance wet = shade_tile(canvas, 0, paper);
        close_films(canvas, 0, every_texel());
        const TileAppearance dry = shade_tile(canvas, 0, paper);
        // Films of random mixtures: none joins the one under it, so the same numbers in the same order.
        EXPECT_EQ(worst(wet, dry), 0) << coat;
        EXPECT_EQ(wet.height, dry.height);
        EXPECT_FALSE(canvas.has_film(0, kOpenFilm));
    }
}

TEST(Drying, DriesOnlyTheGivenTexels) {
    Canvas canvas = canvas_of(1);
    paint(canvas, 1);
    const Canvas before = canvas;
    std::array<std::uint8_t, kN> closing{};
    for (int t = 0; t < kN; t += 3) closing[t] = 1;
    close_films(canvas, 0, closing);
    for (int t = 0; t < kN; ++t) {
        const Plane* dry = canvas.film_plane(0, kFirstDryFilm, 0);
        const float amount = (*before.plane(0, 0))[t];
        EXPECT_EQ((*canvas.plane(0, 0))[t], t % 3 ? amount : 0);
        EXPECT_EQ((*dry)[t], t % 3 ? 0 : amount);
    }
}

TEST(Drying, AFilmLikeTheOneUnderItJoinsIt) {
    Canvas canvas = canvas_of(1);
    const Substrate clay = load_substrate("clay");
    for (int coat = 1; coat <= 20; ++coat) {
        for (int t = 0; t < kN; ++t) {
            canvas.touch(0, 1)[t] += 0.1f * static_cast<float>(uniform(coat, t));
            canvas.touch(0, 2)[t] += 0.05f * static_cast<float>(uniform(coat, t));
        }
        const TileAppearance wet = shade_tile(canvas, 0, clay);
        close_films(canvas, 0, every_texel());
        // The composite's own error, 2e-6 for each of two films.
        EXPECT_LT(worst(wet, shade_tile(canvas, 0, clay)), 5e-6f);
        EXPECT_FALSE(canvas.has_film(0, kFirstDryFilm + 1)) << "one recipe needs one film";
    }
}

TEST(Drying, EachTexelHasItsOwnDepth) {
    Canvas canvas = canvas_of(1);
    for (int coat = 0; coat < 5; ++coat) {
        for (int t = coat; t < kN; ++t) canvas.touch(0, coat % 2)[t] += 1;
        close_films(canvas, 0, every_texel());
    }
    for (int film = 0; film < 5; ++film) {
        const Plane* w = canvas.film_plane(0, kFirstDryFilm + film, 0);
        const Plane* other = canvas.film_plane(0, kFirstDryFilm + film, 1);
        EXPECT_EQ((w ? (*w)[2] : 0) + (other ? (*other)[2] : 0), film < 3) << "texel 2 had three coats";
    }
}

TEST(Drying, PastTheLastFilmTheLowestMergeAndNothingIsLost) {
    Canvas canvas = canvas_of(1);
    const Substrate porcelain = load_substrate("porcelain");
    std::array<std::array<double, kN>, 4> painted{};
    for (int coat = 0; coat < 3 * kDryFilms; ++coat) {
        paint(canvas, 100 + coat);
        for (int p = 0; p < 4; ++p)
            if (const Plane* w = canvas.plane(0, p))
                for (int t = 0; t < kN; ++t) painted[p][t] += static_cast<double>((*w)[t]);
        const TileAppearance wet = shade_tile(canvas, 0, porcelain);
        close_films(canvas, 0, every_texel());
        // Two films at the bottom become one mixture under seven others of up to 8 units each:
        // nothing of them is seen but for texels whose films are thin all over.
        EXPECT_LT(worst(wet, shade_tile(canvas, 0, porcelain)), 0.02f) << coat;
    }
    for (int p = 0; p < 4; ++p)
        for (int t = 0; t < kN; ++t)
            EXPECT_NEAR(on_texel(canvas, p, t), painted[p][t], 3e-6 * painted[p][t]) << "single precision sums";
}

TEST(Drying, AllAtOnceTakesTheLiquidAndClosesEverything) {
    atlas::TexelMap map;
    const auto tiles = std::make_shared<std::vector<atlas::TexelTile>>(40);
    for (atlas::TexelTile& tile : *tiles) tile.area.fill(1e-8f);
    map.tiles = {tiles, std::span<const atlas::TexelTile>(*tiles)};
    const auto dried = [&](int threads) {
        Canvas canvas = canvas_of(40);
        for (std::uint32_t slot = 0; slot < 40; slot += 3) {
            for (int t = 0; t < kN; ++t) canvas.touch(slot, slot % 4)[t] = static_cast<float>(uniform(slot, t));
            canvas.touch_liquid(slot, Liquid::film).fill(2);
        }
        set_thread_count(threads);
        EXPECT_NEAR(dry_all(canvas, map), 14 * kN * 2e-8, 1e-12) << "1e-8f is 6e-9 off";
        set_thread_count(0);
        EXPECT_FALSE(canvas.wet());
        for (std::uint32_t slot = 0; slot < 40; ++slot) EXPECT_FALSE(canvas.has_film(slot, kOpenFilm));
        return canvas.hash();
    };
    EXPECT_EQ(dried(1), dried(4));
}

}  // namespace
}  // namespace tuft::ink
