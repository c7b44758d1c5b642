#include "ink/composite/match.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/random.h"
#include "ink/canvas/canvas.h"
#include "ink/composite/composite.h"
#include "ink/spectra/srgb.h"

namespace tuft::ink {
namespace {

Lab lab_of(const Rgb& c) {
    return lab_of_rgb({static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])});
}

double difference(const Rgb& a, const Rgb& b) {
    return delta_e_2000(lab_of(a), lab_of(b));
}

const std::vector<Pigment>& pigments() {
    static const std::vector<Pigment> all = shipped_pigments();
    return all;
}

/// Numbers in [0, 1), one after the other.
struct Draws {
    std::uint64_t seed, n = 0;
    double operator()() { return uniform(seed, n++); }
    std::size_t below(std::size_t end) {
        return std::min(end - 1, static_cast<std::size_t>((*this)() * static_cast<double>(end)));
    }
};

Rgb random_colour(Draws& draw) {
    Rgb c;
    for (float& v : c) v = srgb_decode(static_cast<float>(draw()));
    return c;
}

/// Fractions of one to three different pigments and water, strong ones in small amounts.
Ink random_ink(Draws& draw, double film) {
    Ink ink;
    ink.film = film;
    const std::size_t parts = 1 + draw.below(3);
    double left = 1;
    for (std::size_t i = 0; i < parts; ++i) {
        const Pigment& p = pigments()[draw.below(pigments().size())];
        if (std::any_of(ink.parts.begin(), ink.parts.end(), [&](const InkPart& o) { return o.pigment.name == p.name; }))
            continue;
        const double fraction = std::min(left, 0.005 * std::pow(200.0, draw()));
        if (fraction < 1e-4) break;
        ink.parts.push_back({p, fraction});
        left -= fraction;
    }
    return ink;
}

// The colour that a mix is said to reach is the one that is drawn.
TEST(Match, ColourOnASubstrateIsWhatAFilmThereLooksLike) {
    Draws draw{11};
    for (const std::string& name : list_substrates()) {
        const Substrate substrate = load_substrate(name);
        for (int i = 0; i < 20; ++i) {
            const double film = 0.2 + 5 * draw();
            const Ink ink = random_ink(draw, film);
            std::vector<Plane> planes(ink.parts.size());
            std::vector<Pigment> held;
            TileFilm tile;
            for (std::size_t p = 0; p < ink.parts.size(); ++p) {
                planes[p].fill(static_cast<float>(film * ink.parts[p].fraction));
                tile.pigments[p] = &planes[p];
                held.push_back(ink.parts[p].pigment);
            }
            const TileAppearance look = shade_films(std::span(&tile, 1), nullptr, held, substrate);
            const Rgb colour = colour_on(ink, substrate);
            // What the tile's single precision may differ by.
            for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(colour[c], look.colour[c][7], 4e-6f) << name;
        }
    }
}

TEST(Match, RecoversTheColoursOfRandomMixes) {
    Draws draw{5};
    for (const char* name : {"porcelain", "bisque", "clay"}) {
        const Substrate substrate = load_substrate(name);
        for (const double film : {1.0, 2.0, 5.0}) {
            const MixSearch search(pigments(), substrate, film);
            for (int i = 0; i < 12; ++i) {
                const Ink ink = random_ink(draw, film);
                const Rgb wanted = colour_on(ink, substrate);
                const ColourMatch match = search.nearest(wanted);
                // Half of what a trained eye tells side by side.
                EXPECT_LT(match.delta_e, 0.5) << name << " film " << film << ' ' << to_hex(wanted);
                EXPECT_NEAR(match.delta_e, difference(colour_on(match.ink, substrate), wanted), 1e-9);
            }
        }
    }
}

TEST(Match, MixesAreInksThatCanBeWritten) {
    Draws draw{6};
    const Substrate substrate = load_substrate("porcelain");
    const MixSearch search(pigments(), substrate);
    for (int i = 0; i < 40; ++i) {
        const ColourMatch match = search.nearest(random_colour(draw), 1 + draw.below(4));
        EXPECT_GE(match.ink.parts.size(), 1u);
        EXPECT_LE(match.ink.strength(), 1 + 1e-12);
        const Ink read = parse_ink(ink_toml(match.ink), "mix.toml");
        EXPECT_EQ(read.name, to_hex(match.wanted));
        // Bands are written with their samples and read as the same floats.
        EXPECT_LT(difference(colour_on(read, substrate), match.reached), 1e-3);
    }
}

// The best thickness of each pigment alone is a mix, too.
TEST(Match, IsNeverWorseThanTheBestSinglePigment) {
    Draws draw{7};
    for (const char* name : {"porcelain", "clay"}) {
        const Substrate substrate = load_substrate(name);
        const MixSearch search(pigments(), substrate);
        for (int i = 0; i < 15; ++i) {
            const Rgb wanted = random_colour(draw);
            double best = 1e9;
            for (const Pigment& p : pigments())
                for (int k = 0; k <= 200; ++k) {
                    const double fraction = std::pow(10.0, -4 + k / 50.0);
                    best = std::min(
                        best, difference(colour_on({.parts = {{p, fraction}}}, substrate, search.film()), wanted));
                }
            for (const std::size_t parts : {1, 4}) {
                // The grid is fine enough to come this close to its own optimum.
                EXPECT_LT(search.nearest(wanted, parts).delta_e, best + kSameColour + 0.02)
                    << name << ' ' << to_hex(wanted) << ' ' << parts;
            }
        }
    }
}

// Colours within and out of reach of three pigments, against all mixes of them on a fine grid.
TEST(Match, AgreesWithBruteForceOnAGrid) {
    Draws draw{8};
    const Substrate substrate = load_substrate("porcelain");
    for (int set = 0; set < 3; ++set) {
        std::vector<Pigment> three;
        while (three.size() < 3) {
            const Pigment& p = pigments()[draw.below(pigments().size())];
            if (std::none_of(three.begin(), three.end(), [&](const Pigment& o) { return o.name == p.name; }))
                three.push_back(p);
        }
        const MixSearch search(three, substrate);
        std::vector<Lab> grid;
        constexpr int kSide = 26;  // levels of a fraction, evenly in its logarithm, and none
        const auto level = [](int i) { return i == 0 ? 0.0 : std::pow(10.0, -3.5 + 3.5 * i / kSide); };
        for (int a = 0; a <= kSide; ++a)
            for (int b = 0; b <= kSide; ++b)
                for (int c = 0; c <= kSide; ++c) {
                    const double f[] = {level(a), level(b), level(c)};
                    if (f[0] + f[1] + f[2] > 1) continue;
                    Ink ink;
                    for (std::size_t p = 0; p < 3; ++p) ink.parts.push_back({three[p], f[p]});
                    grid.push_back(lab_of(colour_on(ink, substrate, search.film())));
                }
        for (int i = 0; i < 10; ++i) {
            const Rgb wanted = random_colour(draw);
            double best = 1e9;
            for (const Lab& lab : grid) best = std::min(best, delta_e_2000(lab, lab_of(wanted)));
            // A mix with fewer pigments may be worse by what nobody sees. Where the wanted hue is
            // opposite to all that there are, ΔE2000 itself jumps ([Sharma2005],
            // "Discontinuities").
            const double jump = best > 20 ? 1 : 0;
            EXPECT_LT(search.nearest(wanted, 3).delta_e, best + kSameColour + 1e-3 + jump)
                << three[0].name << ' ' << three[1].name << ' ' << three[2].name << ' ' << to_hex(wanted);
        }
    }
}

TEST(Match, ThickerFilmsReachMore) {
    const Substrate clay = load_substrate("clay");
    const Rgb white = *colour_of_hex("#f0f0f0");
    const ColourMatch thin = match_colour(white, pigments(), clay, {.film = 1});
    const ColourMatch free = match_colour(white, pigments(), clay, {.film = 0});
    EXPECT_LT(free.delta_e, 0.5 * thin.delta_e);
    EXPECT_GT(free.ink.film, 1);
    // What needs no thick film gets none.
    EXPECT_EQ(match_colour(*colour_of_hex("#202020"), pigments(), clay, {.film = 0}).ink.film, 2);
}

TEST(Match, SaysHowFarAColourOutOfReachIs) {
    const ColourMatch match = match_colour(*colour_of_hex("#00ff00"), pigments(), load_substrate("porcelain"));
    EXPECT_GT(match.delta_e, 6);
    EXPECT_NE(std::string(difference_in_words(match.delta_e)).find("do not reach"), std::string::npos);
}

TEST(Match, LabAndLinearLightAreInverse) {
    Draws draw{9};
    for (int i = 0; i < 100; ++i) {
        const std::array<double, 3> rgb{draw(), draw(), 0.01 * draw()}, back = rgb_of_lab(lab_of_rgb(rgb));
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(back[c], rgb[c], 1e-9);  // constants of nine digits
    }
}

// Eight pigments are all that a canvas holds.
TEST(Match, OnAFullCanvasUsesItsPigmentsOnly) {
    const Substrate porcelain = load_substrate("porcelain");
    std::vector<Pigment> held;  // as many as a canvas takes, none of them yellow
    for (const char* name : {"bone-black", "carbon-black", "cinnabar", "cobalt-underglaze", "indigo", "iron-red",
                             "shell-white", "titanium-white"})
        held.push_back(load_pigment(name));
    ASSERT_EQ(held.size(), static_cast<std::size_t>(kMaxPigments));
    const Rgb yellow = *colour_of_hex("#e0c040");
    const ColourMatch free = match_on_canvas(yellow, porcelain, {});
    const ColourMatch bound = match_on_canvas(yellow, porcelain, held);
    for (const InkPart& part : bound.ink.parts)
        EXPECT_TRUE(std::any_of(held.begin(), held.end(), [&](const Pigment& p) {
            return p.name == part.pigment.name;
        })) << part.pigment.name;
    EXPECT_GT(bound.delta_e, free.delta_e);
}

// Two colour circles, a dark and a light one, need more pigments than a canvas has planes for. Mixed one after the
// other the last colours get what is left.
TEST(Match, PigmentsChosenTogetherSuitAllColoursBetterThanOneAfterTheOther) {
    const Substrate porcelain = load_substrate("porcelain");
    std::vector<WeightedColour> colours;
    for (const float light : {0.05f, 0.4f})
        for (int i = 0; i < 10; ++i) {
            const double hue = 2 * 3.14159265 * i / 10;
            const auto part = [&](double at) {
                return light * static_cast<float>(0.05 + 0.95 * (1 + std::cos(hue - at)));
            };
            colours.push_back({{part(0), part(2.0944), part(4.18879)}, 1});
        }
    const std::vector<Pigment> chosen = choose_pigments(colours, pigments(), {}, porcelain);
    ASSERT_LE(chosen.size(), static_cast<std::size_t>(kMaxPigments));
    MixSearches together(chosen, porcelain), all(pigments(), porcelain);
    double sum = 0, one_by_one = 0;
    std::vector<Pigment> present;
    for (const WeightedColour& c : colours) {
        sum += together.nearest(c.colour).delta_e;
        const ColourMatch match = match_on_canvas(c.colour, porcelain, present, {.film = 0}, &all);
        one_by_one += match.delta_e;
        for (const InkPart& part : match.ink.parts)
            if (std::none_of(present.begin(), present.end(),
                             [&](const Pigment& p) { return p.name == part.pigment.name; }))
                present.push_back(part.pigment);
    }
    EXPECT_LT(sum, 0.9 * one_by_one);
}

TEST(Match, PigmentsOnTheCanvasStayAndFewColoursKeepTheirBestMixes) {
    const Substrate porcelain = load_substrate("porcelain");
    const std::vector<Pigment> present{load_pigment("indigo"), load_pigment("shell-white")};
    const std::vector<WeightedColour> colours{{*colour_of_hex("#c02020"), 1}, {*colour_of_hex("#208040"), 1}};
    const std::vector<Pigment> chosen = choose_pigments(colours, pigments(), present, porcelain);
    EXPECT_EQ(chosen[0].name, "indigo");
    EXPECT_EQ(chosen[1].name, "shell white");
    MixSearches together(chosen, porcelain), all(pigments(), porcelain);
    for (const WeightedColour& c : colours)  // two mixes of at most three pigments fit into the six free planes
        EXPECT_LE(together.nearest(c.colour).delta_e, all.nearest(c.colour).delta_e + kWorthThickness);
}

TEST(Match, HexIsReadAndWritten) {
    EXPECT_EQ(to_hex(*colour_of_hex("#c03020")), "#c03020");
    EXPECT_EQ(to_hex(*colour_of_hex("#fA0")), "#ffaa00");
    for (const char* text : {"", "c03020", "#", "#12345", "#1234567", "#gg0000", "# 12345", "#12 456"})
        EXPECT_FALSE(colour_of_hex(text)) << text;
}

TEST(Match, AColourIsTheNameOfAnInk) {
    const Substrate porcelain = load_substrate("porcelain");
    const Ink ink = ink_named("#c03020", porcelain);
    EXPECT_EQ(ink.name, "#c03020");
    EXPECT_LT(difference(colour_on(ink, porcelain), *colour_of_hex("#c03020")),
              2);  // close: the shipped reds are no brighter
    EXPECT_EQ(ink_named("carbon", porcelain).name, "carbon");
    EXPECT_THROW(ink_named("#c0302", porcelain), Error);
}

TEST(Match, RefusesNoPigmentsAndFilmsThatCannotBe) {
    const Substrate porcelain = load_substrate("porcelain");
    EXPECT_THROW(MixSearch({}, porcelain), Error);
    EXPECT_THROW(MixSearch(pigments(), porcelain, 0), Error);
    EXPECT_THROW(MixSearch(pigments(), porcelain, std::nan("")), Error);
    EXPECT_THROW(MixSearch(pigments(), porcelain, 9), Error);
}

}  // namespace
}  // namespace tuft::ink
