#include "ink/film/tile/paste.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/system/parallel.h"
#include "ink/composite/composite.h"
#include "sheet.h"

namespace tuft::stroke {
namespace {

const std::string kBrush = "mixed-medium", kWhite = "titanium-white-paste";

ink::Ink red_paste() {
    ink::Ink ink = ink::load_ink(kWhite);
    ink.name = "red paste";
    ink.parts[0].pigment = ink::load_pigment("cinnabar");
    return ink;
}

PaintStroke stroke_of(const std::string& ink, const Frame& frame) {
    PaintStroke s = line(kBrush, 8e-3, frame);
    s.ink = ink;
    return s;
}

double capacity() {
    return ink::film_of_millilitres(brush::load_preset(kBrush).capacity * 1e6);
}

// Heights along a line across the stroke, micrometres.
std::vector<double> heights_across(const Document& painting, double x) {
    const ink::AtlasMap<float> map = ink::compose_height(painting.appearance().stack(), painting.model().texels);
    std::vector<double> out;
    const double texel = painting.model().texels.texel_size;
    const auto column = static_cast<std::size_t>(kSize / 2 + x / texel);
    for (std::size_t row = 0; row < kSize; ++row) out.push_back(static_cast<double>(map.texels[row * kSize + column]));
    return out;
}

TEST(PasteStroke, ItLeavesFurrowsAlongTheHairAndSmoothOnes) {
    const Model model = sheet();
    Document painting(model);
    painting.paint(stroke_of(kWhite, {}));
    const std::vector<double> across = heights_across(painting, 0), further = heights_across(painting, 0.003);
    std::vector<double> inside, beside;
    // Within the flanks of its edges, which surface tension rounds over 1/k (Orchard).
    const ink::Ink white = ink::load_ink(kWhite);
    const double rounded = ink::levelling_length(white.yield, white.film * ink::kFilmUnit);
    const auto flank = static_cast<std::size_t>(std::ceil(rounded / model.texels.texel_size));
    for (std::size_t i = flank; i + flank < kSize; ++i)
        if (further[i] > 60 && *std::min_element(&across[i - flank], &across[i + flank + 1]) > 60) {
            inside.push_back(across[i]);
            beside.push_back(further[i]);
        }
    ASSERT_GT(inside.size(), 60u) << "texels of 0.06 mm";
    const auto mean = [](const std::vector<double>& v) {
        double sum = 0;
        for (const double x : v) sum += x / static_cast<double>(v.size());
        return sum;
    };
    const double m = mean(inside), n = mean(beside);
    EXPECT_GT(m, 100) << "45 film units leave 225 µm of dry white";
    EXPECT_LT(m, 260);
    double a = 0, b = 0, ab = 0, steepest = 0;
    for (std::size_t i = 0; i < inside.size(); ++i) {
        a += (inside[i] - m) * (inside[i] - m);
        b += (beside[i] - n) * (beside[i] - n);
        ab += (inside[i] - m) * (beside[i] - n);
        if (i) steepest = std::max(steepest, std::abs(inside[i] - inside[i - 1]));
    }
    EXPECT_GT(std::sqrt(a / static_cast<double>(inside.size())), 5) << "relief of micrometres that raking light shows";
    EXPECT_GT(ab / std::sqrt(a * b), 0.5) << "furrows go on along the stroke";
    EXPECT_LT(steepest, 60) << "slope below one: no steps of texels";
}

TEST(PasteStroke, EachPigmentIsKeptWhenItPloughsAnother) {
    const Model model = sheet();
    Document painting(model);
    painting.use(red_paste());
    painting.paint(stroke_of(kWhite, {}));
    const double left = painting.brushes().find(kBrush)->reservoir.pigment(0);
    const double white = painting.layers().canvas().total(model.texels, 0);
    // Floats on texels, some 1e5 of them: what goes astray is rounding.
    EXPECT_NEAR((left + white) / capacity(), 1, 1e-6);
    painting.paint(stroke_of("red paste", make_frame({0, 0, 0}, {0, 0, 1}, {0, 1, 0})));
    const ink::Reservoir& brush = painting.brushes().find(kBrush)->reservoir;
    EXPECT_GT(brush.pigment(0), 0) << "it took white up";
    EXPECT_NEAR((painting.layers().canvas().total(model.texels, 0) + brush.pigment(0)) / white, 1, 1e-6);
    EXPECT_NEAR((painting.layers().canvas().total(model.texels, 1) + brush.pigment(1)) / capacity(), 1, 1e-6);
    EXPECT_EQ(painting.layers().canvas().liquid(painting.layers().canvas().touched_slots()[0], ink::Liquid::film),
              nullptr);
}

TEST(PasteStroke, ThinInkOverDryPasteStandsInItsFurrows) {
    const Model model = sheet();
    Document painting(model);
    painting.paint(stroke_of(kWhite, {}));
    painting.paint(Dry{});
    const std::uint64_t before = painting.layers().hash();
    const std::vector<double> relief = heights_across(painting, 0);
    PaintStroke glaze = stroke_of("carbon", make_frame({0, 0, 0}, {0, 0, 1}, {0, 1, 0}));
    painting.paint(glaze);
    EXPECT_NEAR(
        (painting.layers().canvas().total(model.texels, 1) + painting.brushes().find(kBrush)->reservoir.pigment(1)) /
            capacity(),
        1, 1e-6);
    const ink::AtlasMap<float> amounts = ink::compose_amounts(painting.appearance().stack(), model.texels);
    double ridges = 0, n_ridges = 0, furrows = 0, n_furrows = 0;
    const double texel = model.texels.texel_size;
    const auto reach = static_cast<std::size_t>(0.4e-3 / texel);  // half a furrow and more
    for (std::size_t row = kSize / 2 - 40; row < kSize / 2 + 40; ++row) {
        const auto [low, high] = std::minmax_element(relief.begin() + static_cast<std::ptrdiff_t>(row - reach),
                                                     relief.begin() + static_cast<std::ptrdiff_t>(row + reach));
        if (*high - *low < 30) continue;
        const double ink = static_cast<double>(
            amounts.texels[(row * kSize + kSize / 2) * static_cast<std::size_t>(amounts.channels) + 1]);
        if (relief[row] > *low + 0.8 * (*high - *low)) ridges += ink, n_ridges += 1;
        if (relief[row] < *low + 0.2 * (*high - *low)) furrows += ink, n_furrows += 1;
    }
    ASSERT_GT(n_ridges, 5);
    ASSERT_GT(n_furrows, 5);
    EXPECT_GT(furrows / n_furrows, 2 * ridges / n_ridges) << "as mapped they are alike";
    const std::uint64_t after = painting.layers().hash();
    painting.undo();
    EXPECT_EQ(painting.layers().hash(), before);
    painting.redo();
    EXPECT_EQ(painting.layers().hash(), after);
}

PaintStroke wash_over(double depth) {
    PaintStroke s = line(kBrush, depth, make_frame({0, 0, 0}, {0, 0, 1}, {0, 1, 0}));
    s.settings.film = FilmModel::wet;
    return s;
}

TEST(PasteStroke, AWashTakesOfItsSurfaceAndLeavesItsBodyStanding) {
    const Model model = sheet();
    Document painting(model);
    PaintStroke paste = stroke_of(kWhite, {});
    paste.settings.film = FilmModel::wet;
    painting.paint(paste);
    const std::vector<double> before = heights_across(painting, 0);
    const auto white = [&] { return painting.layers().canvas().total(model.texels, 0); };
    const double all = white();
    painting.paint(wash_over(8e-3));
    const std::uint64_t hash = painting.layers().hash();
    const ink::Reservoir& brush = painting.brushes().find(kBrush)->reservoir;
    EXPECT_GT(brush.pigment(0), 0) << "it tints itself";
    EXPECT_NEAR((white() + brush.pigment(0)) / all, 1, 1e-6) << "floats";
    EXPECT_NEAR((painting.layers().canvas().total(model.texels, 1) + brush.pigment(1)) / capacity(), 1, 1e-6);
    const std::vector<double> after = heights_across(painting, 0);
    double lost = 0, n = 0;
    for (std::size_t row = 0; row < kSize; ++row) {
        if (before[row] < 60) continue;
        // 5 µm of dry white a film unit, of which less than two come loose. Ink of 2 film
        // units, 2.5 µm each, runs off the ridges and stands up to four times as deep in furrows.
        EXPECT_GT(after[row], before[row] - 10) << row;
        EXPECT_LT(after[row], before[row] + 20) << row;
        lost += before[row] - after[row], n += 1;
    }
    ASSERT_GT(n, 60);
    EXPECT_LT(std::abs(lost) / n, 3);
    painting.undo();
    EXPECT_EQ(white(), all);
    painting.redo();
    EXPECT_EQ(painting.layers().hash(), hash);
}

TEST(PasteStroke, ItReplaysAndIsTakenBackToTheBit) {
    const Model model = sheet();
    std::uint64_t hash = 0;
    for (const int threads : {1, 3}) {
        set_thread_count(threads);
        Document painting(model);
        painting.use(red_paste());
        painting.paint(stroke_of(kWhite, {}));
        const std::uint64_t first = painting.layers().hash();
        painting.paint(stroke_of("red paste", make_frame({0, 0, 0}, {0, 0, 1}, {0, 1, 0})));
        if (hash) {
            EXPECT_EQ(painting.layers().hash(), hash);
        }
        hash = painting.layers().hash();
        painting.undo();
        // The second pigment stays known, without any of it.
        painting.redo();
        EXPECT_EQ(painting.layers().hash(), hash);
        EXPECT_NE(first, hash);
    }
    set_thread_count(0);
}

}  // namespace
}  // namespace tuft::stroke
