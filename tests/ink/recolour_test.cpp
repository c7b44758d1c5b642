#include "ink/composite/recolour.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "ink/composite/composite.h"
#include "ink/exchange/deposit.h"
#include "texels.h"

namespace tuft::ink {
namespace {

Ink recipe(const std::string& name, std::vector<std::pair<const char*, double>> parts) {
    Ink ink;
    ink.name = name;
    for (const auto& [pigment, fraction] : parts) ink.parts.push_back({load_pigment(pigment), fraction});
    return ink;
}

/// A tile painted with `ink`: random film W, its pigments in the ink's fractions.
Canvas painted_with(const Ink& ink) {
    Canvas canvas(2);
    const Mix mix = mix_of(canvas, ink);
    for (std::size_t p = 0; p < canvas.pigments().size(); ++p)
        for (int t = 0; t < kN; ++t)
            canvas.touch(1, static_cast<int>(p))[t] = mix[p] * static_cast<float>(4 * uniform(3, t));
    return canvas;
}

TEST(Recolour, OldTexelsLookAsIfPaintedWithTheNewRecipe) {
    const Substrate porcelain = load_substrate("porcelain");
    const Ink old = recipe("old", {{"cinnabar", 0.6}, {"gamboge", 0.3}});
    for (const Ink& wanted :
         {recipe("more-yellow", {{"cinnabar", 0.1}, {"gamboge", 0.8}}),
          recipe("other", {{"indigo", 0.5}, {"titanium-white", 0.2}}),
          recipe("both", {{"gamboge", 0.4}, {"indigo", 0.4}}), recipe("one", {{"carbon-black", 1.0}})}) {
        Canvas canvas = painted_with(old);
        const std::uint64_t hash = canvas.hash();
        canvas.take_dirty();
        recolour(canvas, old, wanted);
        EXPECT_EQ(canvas.hash(), hash) << "amounts and names stay";
        EXPECT_EQ(canvas.take_dirty(), (std::vector<std::uint32_t>{1}));
        const TileAppearance look = shade_tile(canvas, 1, porcelain);
        const TileAppearance anew = shade_tile(painted_with(wanted), 1, porcelain);
        for (int t = 0; t < kN; ++t) {
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(look.colour[c][t], anew.colour[c][t], 4e-6) << wanted.name << " " << t;
            EXPECT_NEAR(look.height[t], anew.height[t], 1e-5 * anew.height[t]) << wanted.name;
        }
    }
}

TEST(Recolour, TheSameRecipeChangesNoColourAndBackIsBack) {
    const Ink old = recipe("old", {{"cinnabar", 0.6}, {"gamboge", 0.3}});
    const Ink blue = recipe("blue", {{"indigo", 0.9}});
    Canvas canvas = painted_with(old);
    const TileAppearance before = shade_tile(canvas, 1, load_substrate("bisque"));
    recolour(canvas, old, old);
    const TileAppearance same = shade_tile(canvas, 1, load_substrate("bisque"));
    recolour(canvas, old, blue);
    recolour(canvas, old, old);
    const TileAppearance back = shade_tile(canvas, 1, load_substrate("bisque"));
    EXPECT_EQ(same.colour, before.colour);
    EXPECT_EQ(back.colour, before.colour);
}

TEST(Recolour, SharedPigmentsAreNamed) {
    const Ink a = recipe("a", {{"cinnabar", 0.6}, {"gamboge", 0.3}}), b = recipe("b", {{"gamboge", 1}});
    EXPECT_EQ(shared_pigments(a, b), (std::vector<std::string>{"gamboge"}));
    EXPECT_TRUE(shared_pigments(a, recipe("c", {{"indigo", 1}})).empty());
}

}  // namespace
}  // namespace tuft::ink
