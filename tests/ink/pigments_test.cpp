#include "ink/pigments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "core/error.h"
#include "ink/composite.h"

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
    for (const char* wanted : {"carbon", "cinnabar", "indigo", "cobalt", "shell-white",
                               "titanium-white", "gamboge", "iron-red"})
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

TEST(Presets, SubstratesDifferAsTheirMaterialsDo) {
    const Substrate glaze = load_substrate("porcelain"), bisque = load_substrate("bisque"),
                    paper = load_substrate("rice-paper");
    // Relief and diffusion measured or estimated for glaze, bisque and xuan paper; of paper a tenth of
    // the estimate, 1e-7, which texels of 0.05 mm cannot follow.
    EXPECT_FLOAT_EQ(glaze.relief, 1e-6f);
    EXPECT_FLOAT_EQ(bisque.relief, 8e-6f);
    EXPECT_FLOAT_EQ(paper.relief, 15e-6f);
    EXPECT_FLOAT_EQ(glaze.diffusion, 1e-10f);
    EXPECT_FLOAT_EQ(bisque.diffusion, 1e-8f);
    EXPECT_FLOAT_EQ(paper.diffusion, 1e-8f);
    EXPECT_EQ(glaze.absorbency, 0) << "nothing soaks into a glaze";
    EXPECT_LT(bisque.absorbency, paper.absorbency);
    EXPECT_LT(bisque.retention, paper.retention) << "fibres sieve";
    EXPECT_EQ(glaze.interface, 1);
    EXPECT_EQ(paper.interface, 0);
    // A file from before these fields keeps its meaning: a matte surface.
    const Substrate old = parse_substrate("reflectance = [0.5, 0.5, 0.5]\ncapacity = 7\n", "old");
    EXPECT_EQ(old.interface, 0);
    EXPECT_EQ(old.retention, 0);
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

TEST(Presets, UnknownNamesAreAnsweredWithTheNearest) {
    EXPECT_EQ(message_of([] { load_ink("carbn"); }), "unknown ink 'carbn', did you mean 'carbon'?");
    EXPECT_EQ(message_of([] { load_substrate("porcelian"); }),
              "unknown substrate 'porcelian', did you mean 'porcelain'?");
    EXPECT_NE(message_of([] { load_ink("../../etc/passwd"); }).find("unknown ink"),
              std::string::npos);
}

TEST(Presets, BadFilesAreRefusedWithTheirLine) {
    const std::string good = "film = 2\n[[pigment]]\nname = \"p\"\nK = [1,1,1]\nS = [1,1,1]\n";
    EXPECT_EQ(parse_ink(good, "x.toml").film, 2);
    const auto says = [](const std::string& text) {
        return message_of([&] { parse_ink(text, "x.toml"); });
    };
    EXPECT_NE(says("film = \n").find("x.toml:1: "), std::string::npos);
    EXPECT_NE(says("film = 99\n" + good.substr(9)).find("x.toml:1: 'film' must lie in"),
              std::string::npos);
    EXPECT_NE(says("flim = 2\n" + good.substr(9)).find("did you mean 'film'?"), std::string::npos);
    EXPECT_NE(says("film = 2\n").find("at least one [[pigment]]"), std::string::npos);
    EXPECT_NE(says(good + "[[pigment]]\nname = \"q\"\nK = [1,1]\nS = [1,1,1]\n")
                  .find("x.toml:8: 'K' must be 3"),
              std::string::npos);
    EXPECT_NE(
        says(good + "[[pigment]]\nname = \"q\"\nK = [1,1,nan]\nS = [1,1,1]\n").find("x.toml:8: "),
        std::string::npos);
    EXPECT_NE(says(good + good.substr(9)).find("listed twice"), std::string::npos);
    EXPECT_NE(says(good + "[[pigment]]\nname = \"q\"\nK = [1,1,1]\nS = [1,1,1]\n").find("sum to 2"),
              std::string::npos);
}

}  // namespace
}  // namespace tuft::ink
