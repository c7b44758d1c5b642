#include <gtest/gtest.h>

#include <cmath>

#include "ink/composite/composite.h"
#include "ink/spectra/kubelka_munk.h"
#include "texels.h"

namespace tuft::ink {
namespace {

/// A layer with one film of some pigments on one tile, amounts growing over the texels.
Canvas layer_of(const std::vector<std::string>& pigments, float most) {
    Canvas canvas(1);
    for (const std::string& name : pigments) {
        Plane& plane = canvas.touch(0, canvas.add_pigment(load_pigment(name)));
        for (int t = 0; t < kN; ++t) plane[t] = most * static_cast<float>(t) / kN;
    }
    return canvas;
}

TileAppearance look_of(const std::vector<LayerView>& layers, const Substrate& substrate) {
    return shade_tile(Stack(layers), 0, substrate);
}

/// Reflectance R of the bare substrate below its interface, and the colour of one above it.
double bare(const Substrate& s, int b) {
    return saunderson_inverse(static_cast<double>(bands_of_rgb(s.reflectance)[b]),
                              {.k1 = 0, .k2 = 0.6 * static_cast<double>(s.interface)}, false);
}
Rgb seen(const std::array<double, kBands>& r, const Substrate& s) {
    Bands bands;
    for (int b = 0; b < kBands; ++b)
        bands[b] = static_cast<float>(saunderson(r[b], {.k1 = 0, .k2 = 0.6 * static_cast<double>(s.interface)}, false));
    return into_gamut(rgb_of_bands(bands));
}

TEST(Blend, AGlazeOnlyAbsorbs) {
    const Substrate porcelain = load_substrate("porcelain");
    const Canvas cinnabar = layer_of({"cinnabar", "cobalt-underglaze"}, 2);
    const TileAppearance look = look_of({{.canvas = &cinnabar, .blend = Blend::glaze}}, porcelain);
    for (const int t : {0, 40, 255}) {
        const double w = 2.0 * t / kN;
        std::array<double, kBands> r;
        for (int b = 0; b < kBands; ++b) {
            double k = 0;
            for (const Pigment& p : cinnabar.pigments()) k += w * static_cast<double>(p.k[b]);
            r[b] = bare(porcelain, b) * std::exp(-2 * k);
        }
        // What single precision may differ by.
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(look.colour[c][t], seen(r, porcelain)[c], 4e-6f) << t;
    }
}

TEST(Blend, MultiplyIsAFilterOfTheColourOverWhite) {
    const Substrate clay = load_substrate("clay");
    const Canvas film = layer_of({"cinnabar", "shell-white"}, 2);
    const TileAppearance look = look_of({{.canvas = &film, .blend = Blend::multiply}}, clay);
    for (const int t : {0, 40, 255}) {
        const double w = 2.0 * t / kN;
        std::array<double, kBands> r;
        for (int b = 0; b < kBands; ++b) {
            double k = 0, s = 0;
            for (const Pigment& p : film.pigments())
                k += w * static_cast<double>(p.k[b]), s += w * static_cast<double>(p.s[b]);
            r[b] = bare(clay, b) * over(layer(k, s, 1), 1);
        }
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(look.colour[c][t], seen(r, clay)[c], 4e-6f) << t;
    }
}

// White paint covers normally, and darkens nothing as a glaze or a filter.
TEST(Blend, WhiteCoversOnlyNormally) {
    const Substrate clay = load_substrate("clay");
    const Canvas white = layer_of({"titanium-white"}, 4), empty(1);
    const TileAppearance none = look_of({{.canvas = &empty}}, clay);
    const auto change = [&](Blend blend) {
        return look_of({{.canvas = &white, .blend = blend}}, clay).colour[1][255] - none.colour[1][255];
    };
    EXPECT_GT(change(Blend::normal), 0.3f);
    // Titanium white absorbs a few per cent.
    EXPECT_NEAR(change(Blend::glaze), 0, 0.05f);
    EXPECT_NEAR(change(Blend::multiply), 0, 0.05f);
    // Some bands count negatively for green.
    EXPECT_LE(change(Blend::glaze), 1e-4f);
    EXPECT_LE(change(Blend::multiply), 1e-4f);
}

TEST(Blend, NothingGetsLighterByGlazesAndFilters) {
    for (const std::string& name : list_substrates())
        for (const std::string& pigment : list_pigments())
            for (const Blend blend : {Blend::glaze, Blend::multiply}) {
                const Substrate substrate = load_substrate(name);
                const Canvas film = layer_of({pigment}, 3);
                const TileAppearance look = look_of({{.canvas = &film, .blend = blend}}, substrate);
                const auto luminance = [&](int t) {
                    return 0.2126f * look.colour[0][t] + 0.7152f * look.colour[1][t] + 0.0722f * look.colour[2][t];
                };
                // Thicker is darker, up to rounding.
                for (int t = 1; t < kN; ++t) EXPECT_LE(luminance(t), luminance(t - 1) + 1e-6f) << pigment;
            }
}

TEST(Blend, HeightAndRoughnessAreThoseOfTheFilms) {
    const Substrate clay = load_substrate("clay");
    const Canvas film = layer_of({"cinnabar"}, 3);
    const TileAppearance normal = look_of({{.canvas = &film}}, clay);
    for (const Blend blend : {Blend::glaze, Blend::multiply}) {
        const TileAppearance look = look_of({{.canvas = &film, .blend = blend}}, clay);
        EXPECT_EQ(look.height, normal.height);
        EXPECT_EQ(look.roughness, normal.roughness);
    }
}

TEST(Blend, OpacityFadesEachTowardsWhatLiesBelow) {
    const Substrate porcelain = load_substrate("porcelain");
    const Canvas film = layer_of({"cinnabar"}, 2);
    for (const Blend blend : {Blend::normal, Blend::glaze, Blend::multiply}) {
        const float whole = look_of({{.canvas = &film, .blend = blend}}, porcelain).colour[1][200];
        const float half = look_of({{.canvas = &film, .opacity = 0.5f, .blend = blend}}, porcelain).colour[1][200];
        const float none = look_of({{.canvas = &film, .opacity = 0, .blend = blend}}, porcelain).colour[1][200];
        EXPECT_GT(half, whole);
        EXPECT_LT(half, none);
        EXPECT_EQ(none, look_of({}, porcelain).colour[1][200]);
    }
}

TEST(Blend, WordsAreReadAndWritten) {
    for (const Blend blend : {Blend::normal, Blend::glaze, Blend::multiply}) EXPECT_EQ(blend_of(name_of(blend)), blend);
    EXPECT_FALSE(blend_of("screen"));
}

}  // namespace
}  // namespace tuft::ink
