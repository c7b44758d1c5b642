#include "render/brush/comparison_picture.h"

#include <gtest/gtest.h>

#include <array>

namespace tuft::render {
namespace {

TEST(ComparisonPicture, HasAColourForEachMethodAndTheMeasuredDots) {
    using brush::SpineMethod;
    const brush::SweepRow measured[] = {{}, {2e-3, 2e-3, 2e-3, 1e-3}, {4e-3, 4e-3, 3e-3, 2e-3}};
    std::vector<brush::ModelSweep> models;
    for (std::size_t m = 0; m < std::size(brush::kSpineWords); ++m) {
        // Lines apart from each other: each method draws its own slope.
        const double f = 1 + 0.3 * static_cast<double>(m);
        models.push_back({static_cast<SpineMethod>(m),
                          {{}, {2e-3, f * 1e-3, f * 1e-3, f * 1e-3}, {4e-3, f * 2e-3, f * 2e-3, f * 2e-3}},
                          {},
                          {{-f * 5e-3, 0}, {-f * 2e-3, 5e-3}, {0, 10e-3}}});
    }
    const BrushPicture picture = draw_comparison(models, measured, 2000);
    ASSERT_EQ(picture.rgb.size(), std::size_t(3) * picture.width * picture.height);
    // Colours of the methods as in the legend; the dots are red.
    const std::array<std::array<int, 3>, 6> colours = {
        {{20, 20, 24}, {150, 150, 156}, {214, 120, 20}, {28, 110, 190}, {30, 140, 80}, {176, 30, 40}}};
    for (const auto& colour : colours) {
        int seen[2] = {0, 0};  // in the upper and the lower row
        for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
            const auto off = [&](std::size_t c) { return std::abs(picture.rgb[i + c] - colour[c]); };
            if (off(0) < 3 && off(1) < 3 && off(2) < 3)
                ++seen[i / 3 / static_cast<std::size_t>(picture.width) > static_cast<std::size_t>(picture.height) / 2];
        }
        EXPECT_GT(seen[0], 40);  // a line of 4 pixels over a part of a plot of 870
        EXPECT_GT(seen[1], 20);
    }
}

}  // namespace
}  // namespace tuft::render
