#include "ink/film/tile/paste.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <span>

#include "core/random.h"
#include "ink/exchange/stir.h"
#include "ink/film/level.h"
#include "texels.h"

namespace tuft::ink {
namespace {

std::vector<BundleFirmness> bundles(int n) {
    std::vector<BundleFirmness> out;
    for (int k = 0; k < n; ++k)
        out.push_back({(k + 0.2 + 0.6 * uniform(5, static_cast<std::uint64_t>(k))) / n,
                       0.5 + 0.5 * uniform(6, static_cast<std::uint64_t>(k))});
    return out;
}

double mean_of(const FurrowDepths& furrows) {
    double sum = 0;
    for (int i = 0; i < kFirmnessSamples; ++i)
        sum += (i == 0 || i == kFirmnessSamples - 1 ? 0.5 : 1.0) * static_cast<double>(furrows[i]) /
               (kFirmnessSamples - 1);
    return sum;
}

/// Amplitude of mode n of the cosine series over the width.
double mode(const FurrowDepths& furrows, int n) {
    double a = 0;
    for (int i = 0; i < kFirmnessSamples; ++i)
        a += (i == 0 || i == kFirmnessSamples - 1 ? 1.0 : 2.0) * static_cast<double>(furrows[i]) *
             std::cos(M_PI * n * i / (kFirmnessSamples - 1)) / (kFirmnessSamples - 1);
    return a;
}

TEST(FurrowDepths, NoWaveIsHigherThanTheYieldStressCanHold) {
    const std::vector<BundleFirmness> hair = bundles(18);
    for (const double yield : {20.0, 400.0, 3000.0})
        for (const double film : {5e-5, 3e-4}) {
            const FurrowDepths furrows = furrow_depths(hair, {.width = 9e-3, .film = film, .yield = yield});
            EXPECT_NEAR(mean_of(furrows), 1, 1e-6) << "floats of about 1";
            for (int n = 1; n <= 60; ++n) {
                const double k = M_PI * n / 9e-3;
                // Orchard: stress σ k³ a h at the foot of the film; the furrows is over its mean.
                EXPECT_LE(0.03 * k * k * k * std::abs(mode(furrows, n)) * film * film,
                          yield * (1 + 1e-3) + 1e-6 * k * k * k * film * film)
                    << n;
            }
        }
}

TEST(FurrowDepths, AStiffPasteKeepsTheFurrowsThatAThinOneLoses) {
    const std::vector<BundleFirmness> hair = bundles(18);
    const auto rough = [&](double yield) {
        const FurrowDepths furrows = furrow_depths(hair, {.width = 9e-3, .film = 3e-4, .yield = yield});
        double sum = 0;
        for (const float v : furrows)
            sum += (static_cast<double>(v) - 1) * (static_cast<double>(v) - 1) / kFirmnessSamples;
        return std::sqrt(sum);
    };
    EXPECT_EQ(rough(0), 0) << "what flows lies even";
    EXPECT_LT(rough(1), rough(30));
    EXPECT_LT(rough(30), rough(1000));
    EXPECT_GT(rough(1000), 0.05) << "of 300 µm: what raking light shows";
}

TEST(FurrowDepths, WhatIsPushedOutStandsAtTheSides) {
    const FurrowDepths furrows =
        furrow_depths({}, {.width = 9e-3, .film = 3e-4, .yield = 1000, .depth = 0, .rim = 0.5});
    EXPECT_GT(furrows.front(), 1.1);
    EXPECT_GT(furrows.back(), 1.1);
    EXPECT_LT(furrows[kFirmnessSamples / 2], 1);
    EXPECT_NEAR(mean_of(furrows), 1, 1e-6);
}

TEST(FurrowDepths, PasteStandsAsHighAsItsWeightLets) {
    // τ / ρ g: 400 Pa hold 27 mm of paint of 1500 kg/m³.
    EXPECT_NEAR(standing_film(400) * kFilmUnit, 400 / (1500 * 9.81), 1e-9);
    EXPECT_EQ(standing_film(0), 0);
}

struct Pass {
    NodeContents given{}, taken{};
};

double sum_of(const NodeContents& c, int plane) {
    double sum = 0;
    for (const Reservoir::Content& node : c) sum += node[plane];
    return sum;
}

TEST(Paste, ItIsDepositedAndPloughedAndEachPigmentIsConserved) {
    // A tile over all of the grid's width.
    Canvas canvas(1);
    const Pigment a{.name = "a"}, b{.name = "b"};
    canvas.add_pigment(a);
    canvas.add_pigment(b);
    TexelPlaces places;
    Texels coverage;
    for (int t = 0; t < atlas::kTileTexels; ++t) {
        places.along[t] = 1.5f;
        places.across[t] = static_cast<float>(t % 16) / 15 * (kAcross - 1);
        coverage[t] = t / 16 < 12 ? 1.0f : 0.5f;
    }
    HatBasis hats;
    hat_basis(hats, places, coverage);
    NodeMixes first{}, second{};
    first[0].fill(0.8f);
    first[kMaxPigments].fill(0.2f);
    second[1].fill(1);
    PasteParams params{.target = 40, .exchange = 0.01, .free_capacity = 1e3};
    params.furrows = furrow_depths(bundles(9), {.width = 9e-3, .film = 4e-4, .yield = 800});
    const Texels area = random_texels(3, 0.9e-8, 1.1e-8);
    const auto total = [&](int p) {
        double sum = 0;
        for (int t = 0; t < kN && canvas.plane(0, p); ++t)
            sum += static_cast<double>((*canvas.plane(0, p))[t]) * static_cast<double>(area[t]);
        return sum;
    };
    const auto pass = [&](const NodeMixes& mixes, const Plane& before) {
        const double had[] = {total(0), total(1)};
        Pass out;
        deposit_paste(canvas, {{{0, coverage, area}, 5e-5}, places, hats}, params, mixes, before,
                      {out.given, out.taken});
        for (int p = 0; p < 2; ++p) {
            const double kept = sum_of(out.given, p) - sum_of(out.taken, p);
            // Doubles of what floats took; 256 of them.
            EXPECT_NEAR(total(p) - had[p], kept, 1e-12 * (had[p] + 1e-6)) << p;
            EXPECT_GE(sum_of(out.given, p), 0);
            EXPECT_GE(sum_of(out.taken, p), -1e-15);
        }
        return out;
    };
    const Plane clean = open_pigment(canvas, 0);
    for (int i = 0; i < 60; ++i) {
        const Pass p = pass(first, clean);
        // The fifth that is water leaves with the pigment, in that proportion.
        EXPECT_NEAR(sum_of(p.given, kMaxPigments), 0.25 * sum_of(p.given, 0), 1e-6 * sum_of(p.given, 0));
    }
    // Many touches: the film is the furrows's, under half coverage half of it.
    const Plane* w = canvas.plane(0, 0);
    ASSERT_NE(w, nullptr);
    for (int t = 0; t < atlas::kTileTexels; ++t) {
        const double at = (t % 16) / 15.0 * (kFirmnessSamples - 1);
        const int i = std::min(static_cast<int>(at), kFirmnessSamples - 2);
        const double phi = static_cast<double>(params.furrows[i]) +
                           (at - i) * static_cast<double>(params.furrows[i + 1] - params.furrows[i]);
        // 60 touches of 0.05 mm over a transfer length of 0.08: exp(−37) is left. Renewal under half
        // coverage keeps what lies there.
        EXPECT_NEAR((*w)[t], 0.8 * 40 * phi * static_cast<double>(coverage[t]), 1e-3) << t;
    }
    // Another furrows and another paint: it rides on a part of the first, which it ploughs and takes up.
    params.furrows = furrow_depths(bundles(7), {.width = 9e-3, .film = 4e-4, .yield = 800});
    const Plane before = open_pigment(canvas, 0);
    double lifted = 0;
    for (int i = 0; i < 60; ++i) lifted += sum_of(pass(second, before).taken, 0);
    EXPECT_GT(lifted, 0);
    const Plane after = open_pigment(canvas, 0);
    for (int t = 0; t < 12 * 16; ++t) {
        EXPECT_GE(after[t], before[t] * (1 - params.dig));
        EXPECT_LE(after[t], before[t] + 40 * 2.0);
    }
    // A brush without room leaves what stands there.
    params.free_capacity = 0;
    params.exchange = 0;
    params.furrows.fill(0);
    const Pass none = pass(first, open_pigment(canvas, 0));
    EXPECT_EQ(sum_of(none.taken, 0) + sum_of(none.taken, 1), 0);
}

/// A chart of two tiles side by side, or the same texels as two charts that meet at a seam.
struct TwoTiles {
    atlas::TexelMap map;
    atlas::SeamLinks seams;
};

TwoTiles two_tiles(bool seam) {
    TwoTiles out;
    const std::uint32_t side = seam ? 4 : 2;
    out.map.size = side * atlas::kTile;
    out.map.tiles_per_side = side;
    out.map.texel_size = 1e-4;
    out.map.slot_of_tile.assign(side * side, kNone);
    const std::uint32_t second = seam ? 2 * side + 2 : 1;  // beside the first, or far from it
    out.map.slot_of_tile[0] = 0;
    out.map.slot_of_tile[second] = 1;
    out.map.tile_of_slot = {0, second};
    const auto tiles = std::make_shared<std::vector<atlas::TexelTile>>(2);
    for (atlas::TexelTile& tile : *tiles) {
        tile.area.fill(1e-8f);
        tile.cluster.fill(0);
    }
    out.map.tiles = {tiles, std::span<const atlas::TexelTile>(*tiles)};
    out.seams.start = {0, 0, 0};
    if (!seam) return out;
    for (const std::uint32_t slot : {0u, 1u}) {
        for (int y = 0; y < atlas::kTile; ++y)
            out.seams.links.push_back({1 - slot, 1, static_cast<std::uint8_t>(y * 16 + (slot ? 0 : 15)),
                                       static_cast<std::uint8_t>(y * 16 + (slot ? 15 : 0))});
        out.seams.start[slot + 1] = static_cast<std::uint32_t>(out.seams.links.size());
    }
    return out;
}

TEST(Levelling, AWaveFallsAsItsLengthSaysAndEachPigmentIsKept) {
    const TwoTiles on = two_tiles(false);
    const double length = 1.5e-4;
    for (const int waves : {2, 4}) {
        Canvas canvas(2);
        canvas.add_pigment({.name = "a"});
        OpenBefore before;
        double had = 0;
        for (const std::uint32_t slot : {0u, 1u}) {
            before.emplace(slot, std::make_unique<Plane>(open_pigment(canvas, slot)));
            for (int t = 0; t < kN; ++t) {
                // Level at both ends, so that nothing comes from where nothing is.
                const double x = (slot * 16.0 + t % 16 + 0.5) / 32;
                canvas.touch(slot, 0)[t] = static_cast<float>(20 + 3 * std::cos(2 * M_PI * waves * x));
                had += static_cast<double>(canvas.touch(slot, 0)[t]);
            }
        }
        level_paste(canvas, on.map, on.seams, before, length);
        double has = 0, height = 0;
        for (const std::uint32_t slot : {0u, 1u})
            for (int t = 0; t < kN; ++t) {
                const double w = static_cast<double>((*canvas.plane(slot, 0))[t]);
                has += w;
                height += (w - 20) * std::cos(2 * M_PI * waves * (slot * 16.0 + t % 16 + 0.5) / 32) / (16 * 16);
            }
        EXPECT_NEAR(has / had, 1, 1e-6) << "floats";
        const double k = 2 * M_PI * waves / 32e-4;
        // Explicit steps of a fifth, and texels for a line: some percent at eight texels a wave.
        EXPECT_NEAR(height / 3, std::exp(-0.5 * k * k * length * length), 0.02) << waves;
    }
}

TEST(Levelling, ItGoesOverSeamsAndNotOntoBareTexels) {
    std::array<std::vector<float>, 2> levelled;
    for (const bool seam : {false, true}) {
        const TwoTiles on = two_tiles(seam);
        Canvas canvas(2);
        canvas.add_pigment({.name = "a"});
        OpenBefore before;
        for (const std::uint32_t slot : {0u, 1u}) {
            before.emplace(slot, std::make_unique<Plane>(open_pigment(canvas, slot)));
            // The last rows are bare.
            for (int t = 0; t < 13 * 16; ++t)
                canvas.touch(slot, 0)[t] =
                    static_cast<float>(uniform(8, slot * 256u + static_cast<unsigned>(t)) * 30 + 1);
        }
        level_paste(canvas, on.map, on.seams, before, 2e-4);
        for (const std::uint32_t slot : {0u, 1u}) {
            const Plane& w = *canvas.plane(slot, 0);
            for (int t = 13 * 16; t < kN; ++t) EXPECT_EQ(w[t], 0);
            levelled[seam].insert(levelled[seam].end(), w.begin(), w.end());
        }
    }
    // The same fluxes, summed in another order.
    for (std::size_t i = 0; i < levelled[0].size(); ++i) EXPECT_NEAR(levelled[0][i], levelled[1][i], 1e-4) << i;
}

TEST(Stirring, BendingMixesNeighboursAndKeepsEachPlane) {
    Reservoir tuft = make_reservoir(
        0.5,
        {.bundles = {{-0.5, 0}, {0, 0}, {0.5, 0}, {0, 0.5}}, .cell_ends = {0.5, 1}, .cell_capacities = {0.5, 0.5}});
    Mix red{}, blue{};
    red[0] = 1;
    blue[1] = 1;
    dip(tuft, red, {.side = -0.5});
    dip(tuft, blue);
    const double before[] = {tuft.pigment(0), tuft.pigment(1)};
    const auto red_at_right = [&] { return tuft.content[2 * 2][0] + tuft.content[2 * 2 + 1][0]; };
    const std::vector<Vec2> still(2, Vec2{0}), along(2, Vec2{0, 0.3}), bent(2, Vec2{0.3, 0});
    const Reservoir was = tuft;
    stir(tuft, still, 4e-3);
    for (std::size_t i = 0; i < tuft.content.size(); ++i) EXPECT_EQ(tuft.content[i], was.content[i]);
    double last = red_at_right();
    for (int i = 0; i < 8; ++i) {
        stir(tuft, i % 2 ? bent : std::vector<Vec2>(2, Vec2{-0.3, 0}), 4e-3);
        EXPECT_GT(red_at_right(), last) << "to and fro both mix";
        last = red_at_right();
    }
    // Four bundles of two cells, 8 steps: rounding.
    for (int p = 0; p < 2; ++p) EXPECT_NEAR(tuft.pigment(p), before[p], 1e-13 * before[p]);
    for (std::size_t i = 0; i < tuft.content.size(); ++i) EXPECT_NEAR(tuft.saturation(i), was.saturation(i), 1e-12);
}

}  // namespace
}  // namespace tuft::ink
