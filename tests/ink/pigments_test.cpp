#include "ink/colour/pigments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

#include "core/error.h"
#include "core/random.h"
#include "ink/composite/composite.h"
#include "ink/film/tile/film_params.h"
#include "ink/spectra/colorimetry.h"

namespace tuft::ink {
namespace {

std::string message_of(const std::function<void()>& fn) {
    try {
        fn();
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

TEST(Presets, EveryInkLoadsAndWritesItselfBack) {
    const auto names = list_inks();
    for (const char* wanted :
         {"carbon", "cinnabar", "indigo", "cobalt", "shell-white", "titanium-white", "gamboge", "iron-red"})
        EXPECT_NE(std::find(names.begin(), names.end(), wanted), names.end()) << wanted;
    for (const std::string& name : names) {
        const Ink ink = load_ink(name);
        EXPECT_EQ(ink.name, name);
        const Ink again = parse_ink(ink_toml(ink), "again");
        EXPECT_EQ(ink_toml(again), ink_toml(ink)) << name;
        ASSERT_EQ(again.parts.size(), ink.parts.size());
        if (ink.parts.empty()) continue;  // clean water
        EXPECT_EQ(again.parts[0].pigment.k, ink.parts[0].pigment.k);
        EXPECT_EQ(again.parts[0].pigment.s, ink.parts[0].pigment.s);
        EXPECT_EQ(again.film, ink.film);
    }
}

TEST(Presets, EverySubstrateLoadsAndWritesItselfBack) {
    for (const char* name : {"porcelain", "bisque", "rice-paper", "primed-metal", "clay"}) {
        const Substrate s = load_substrate(name);
        EXPECT_EQ(s.name, name);
        EXPECT_EQ(substrate_toml(parse_substrate(substrate_toml(s), "again")), substrate_toml(s));
    }
    EXPECT_GE(list_substrates().size(), 5u);
}

TEST(Presets, StillAirAndLineHysteresisAreWrittenWhereTheyAreStated) {
    const std::string plain = substrate_toml(load_substrate("porcelain"));
    EXPECT_EQ(plain.find("still_air_mm"), std::string::npos) << "earlier versions read it";
    EXPECT_EQ(plain.find("line_hysteresis"), std::string::npos);
    const Substrate stated = parse_substrate(plain + "still_air_mm = 20\nline_hysteresis = 0.08\n", "text");
    const Substrate again = parse_substrate(substrate_toml(stated), "again");
    EXPECT_FLOAT_EQ(again.wetting.still_air, 0.02f);
    EXPECT_FLOAT_EQ(again.wetting.line_hysteresis, 0.08f);
    EXPECT_FLOAT_EQ(static_cast<float>(film_params(again, {0, 0, -1}).weight.hysteresis), 0.08f);
}

TEST(Presets, NumbersInOtherUnitsAreReadBackToTheBit) {
    // Micrometres of a float and millimetres of a double: a project stores this text, and its replay gives the same
    // bits.
    Random random(3);
    for (int i = 0; i < 2000; ++i) {
        Substrate substrate;
        substrate.reflectance.fill(0.5f);
        substrate.relief = static_cast<float>(random.uniform(0, 1e-3));
        substrate.relief_length = static_cast<float>(random.uniform(1e-6, 1e-2));
        const Substrate read = parse_substrate(substrate_toml(substrate), "text");
        ASSERT_EQ(read.relief, substrate.relief);
        ASSERT_EQ(read.relief_length, substrate.relief_length);
        Ink ink = load_ink("carbon");
        ink.supply_length = random.uniform(0.001, 100) * 1e-3;  // as it is read
        ASSERT_EQ(parse_ink(ink_toml(ink), "text").supply_length, ink.supply_length);
    }
    EXPECT_EQ(ink_toml(parse_ink("film = 1\nyield_pa = -0.0\npigment = []", "text")),
              ink_toml(parse_ink("film = 1\nyield_pa = 0\npigment = []", "text")));
}

TEST(Presets, SubstratesDifferAsTheirMaterialsDo) {
    const Substrate glaze = load_substrate("porcelain"), bisque = load_substrate("bisque"),
                    paper = load_substrate("rice-paper");
    // Relief and diffusion measured or estimated for glaze, bisque and xuan paper; of paper a tenth of
    // the estimate, 1e-7, which texels of 0.05 mm cannot follow.
    EXPECT_FLOAT_EQ(glaze.relief, 1e-6f);
    EXPECT_FLOAT_EQ(bisque.relief, 8e-6f);
    EXPECT_FLOAT_EQ(paper.relief, 15e-6f);
    EXPECT_FLOAT_EQ(glaze.wetting.diffusion, 1e-10f);
    EXPECT_FLOAT_EQ(bisque.wetting.diffusion, 1e-8f);
    EXPECT_FLOAT_EQ(paper.wetting.diffusion, 1e-8f);
    EXPECT_EQ(glaze.wetting.absorbency, 0) << "nothing soaks into a glaze";
    EXPECT_LT(bisque.wetting.absorbency, paper.wetting.absorbency);
    EXPECT_LT(bisque.wetting.retention, paper.wetting.retention) << "fibres sieve";
    EXPECT_EQ(glaze.interface, 1);
    EXPECT_EQ(paper.interface, 0);
    // A file from before these fields keeps its meaning: a matte surface.
    const Substrate old = parse_substrate("reflectance = [0.5, 0.5, 0.5]\ncapacity = 7\n", "old");
    EXPECT_EQ(old.interface, 0);
    EXPECT_EQ(old.wetting.retention, 0);
    EXPECT_EQ(old.capacity, 7);
}

/// Colour of a full film of the ink over a substrate.
Rgb seen(const std::string& ink, const std::string& substrate) {
    return colour_of_film(load_ink(ink), load_substrate(substrate).reflectance);
}

TEST(Presets, InksLookLikeTheirNames) {
    const Rgb carbon = seen("carbon", "porcelain");
    EXPECT_LT(carbon[0], 0.03f) << "a full film on white reads as black: under 3 %";
    EXPECT_LT(carbon[2] / carbon[0], 1.3f);
    const Rgb red = seen("cinnabar", "porcelain");
    EXPECT_GT(red[0], 5 * red[1]);
    EXPECT_GT(red[0], 5 * red[2]);
    const Rgb blue = seen("cobalt", "porcelain");
    EXPECT_GT(blue[2], 3 * blue[1]);
    const Rgb yellow = seen("gamboge", "porcelain");
    EXPECT_GT(yellow[1], 5 * yellow[2]);
    EXPECT_GT(yellow[0], yellow[1]);
    const Rgb white = seen("titanium-white", "clay");
    EXPECT_GT(white[1], 0.6f) << "hides clay";
}

/// CIELAB of a thick film of a pigment, and of one part in ten of titanium white.
Lab masstone(const char* pigment, double part = 1) {
    Substrate matte;
    std::array<Plane, 2> planes;
    planes[0].fill(static_cast<float>(40 * part));
    planes[1].fill(static_cast<float>(40 * (1 - part)));
    const TileFilm film{.pigments = {&planes[0], &planes[1]}};
    const std::vector<Pigment> pigments{load_pigment(pigment), load_pigment("titanium-white")};
    const TileAppearance look = shade_films(std::span(&film, 1), nullptr, pigments, matte);
    return lab_of_rgb({look.colour[0][0], look.colour[1][0], look.colour[2][0]});
}

TEST(Presets, MasstonesAndTintsLieWherePublishedOnesDo) {
    // Vermilion of A. Maerz, M. R. Paul, A Dictionary of Color, 1930: #E34234. Grinds of it differ by some 5 (coarse
    // ones are darker and bluer).
    const std::array<double, 3> encoded{0xE3, 0x42, 0x34};
    std::array<double, 3> vermilion;
    for (int c = 0; c < 3; ++c) vermilion[c] = srgb_decode(static_cast<float>(encoded[c] / 255));
    EXPECT_LT(delta_e_2000(masstone("cinnabar"), lab_of_rgb(vermilion)), 6);
    // By their closed forms from the measured spectra: R = 1 + K/S − √((K/S)² + 2 K/S) at 550 nm, where the eye is.
    for (const char* name : {"bone-black", "titanium-white"}) {
        const Coefficients at = coefficients_at(load_pigment(name).curve, 550);
        const double ratio = at.k / at.s, reflectance = 1 + ratio - std::sqrt(ratio * ratio + 2 * ratio);
        const Lab grey = lab_of_rgb({reflectance, reflectance, reflectance});
        EXPECT_NEAR(masstone(name)[0], grey[0], 1.5) << name << ": L*, its spectrum is nearly level";
    }
    // Tints with white turn bluer than masstones, as finely divided pigments do: hue of red ones towards blue, blacks
    // grey with a cold cast.
    const auto hue = [](const Lab& lab) { return std::atan2(lab[2], lab[1]) * 180 / 3.14159265; };
    for (const char* name : {"cinnabar", "iron-red"})
        EXPECT_LT(hue(masstone(name, 0.1)), hue(masstone(name)) - 1) << name;
    EXPECT_LT(masstone("bone-black", 0.1)[2], -1);
    // Hues of tints with white (deep masstones have next to none), by the names that the trade gives them: CIELAB hue
    // of Munsell 5Y 90, 5R 20, 5RP 350, 5PB 280, 5B 240, 5G 160 degrees, each within half a step to the next name, and
    // a step towards blue for the red and the ultramarine, whose tints turn.
    for (const auto& [name, lo, hi] : {std::tuple("hansa-yellow", 75, 110), std::tuple("pyrrole-red", -15, 45),
                                       std::tuple("quinacridone-magenta", -40, 5), std::tuple("ultramarine", -105, -55),
                                       std::tuple("phthalo-blue", -115, -65), std::tuple("phthalo-green", 140, 180)}) {
        EXPECT_GT(hue(masstone(name, 0.1)), lo) << name;
        EXPECT_LT(hue(masstone(name, 0.1)), hi) << name;
    }
    for (const char* name : {"cobalt-underglaze", "indigo"})
        EXPECT_LT(hue(masstone(name, 0.1)), -60) << name << ": blue, not purple";
    EXPECT_GT(hue(masstone("gamboge", 0.1)), hue(masstone("gamboge")) + 10) << "orange-brown in mass, lemon as a tint";
}

TEST(Presets, UnknownNamesAreAnsweredWithTheNearest) {
    EXPECT_EQ(message_of([] { load_ink("carbn"); }), "unknown ink 'carbn', did you mean 'carbon'?");
    EXPECT_EQ(message_of([] { load_substrate("porcelian"); }),
              "unknown substrate 'porcelian', did you mean 'porcelain'?");
    EXPECT_NE(message_of([] { load_ink("../../etc/passwd"); }).find("unknown ink"), std::string::npos);
}

TEST(Presets, BadFilesAreRefusedWithTheirLine) {
    const std::string good = "film = 2\n[[pigment]]\nname = \"p\"\nK = [1,1,1]\nS = [1,1,1]\n";
    EXPECT_EQ(parse_ink(good, "x.toml").film, 2);
    const auto says = [](const std::string& text) { return message_of([&] { parse_ink(text, "x.toml"); }); };
    EXPECT_NE(says("film = \n").find("x.toml:1: "), std::string::npos);
    EXPECT_NE(says("film = 99\n" + good.substr(9)).find("x.toml:1: 'film' must lie in"), std::string::npos);
    EXPECT_NE(says("flim = 2\n" + good.substr(9)).find("did you mean 'film'?"), std::string::npos);
    EXPECT_NE(says("film = 2\n").find("at least one [[pigment]]"), std::string::npos);
    EXPECT_NE(says(good + "[[pigment]]\nname = \"q\"\nK = [1,1]\nS = [1,1,1]\n").find("x.toml:8: 'K' must be 3"),
              std::string::npos);
    EXPECT_NE(says(good + "[[pigment]]\nname = \"q\"\nK = [1,1,nan]\nS = [1,1,1]\n").find("x.toml:8: "),
              std::string::npos);
    EXPECT_NE(says(good + good.substr(9)).find("listed twice"), std::string::npos);
    EXPECT_NE(says(good + "[[pigment]]\nname = \"q\"\nK = [1,1,1]\nS = [1,1,1]\n").find("sum to 2"), std::string::npos);
}

}  // namespace
}  // namespace tuft::ink
