#include "pictures/tried_stroke.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "core/error.h"
#include "io/image/image.h"
#include "stroke/placement/tip_lag.h"

namespace tuft::pictures {
namespace {

constexpr int kWidth = TriedStroke::kWidth, kHeight = TriedStroke::kHeight;
constexpr int kDark = 128;  // sRGB code: carbon is about 40, the paper above 200

bool is_dark(const TriedStroke& s, int x, int y) {
    return s.rgb[std::size_t(3) * (y * kWidth + x) + 1] < kDark;
}

/// Mean number of dark pixels in the columns from `x0` to `x1`.
double thickness(const TriedStroke& s, int x0, int x1) {
    int n = 0;
    for (int x = x0; x < x1; ++x)
        for (int y = 0; y < kHeight; ++y) n += is_dark(s, x, y);
    return double(n) / (x1 - x0);
}

/// For the eye: TUFT_TRIED=FOLDER writes the pictures.
void show(const TriedStroke& s, const std::string& name) {
    if (const char* folder = std::getenv("TUFT_TRIED"))
        io::write_image(std::string(folder) + "/" + name + ".png", io::view_of(kWidth, kHeight, 3, s.rgb.data()));
}

/// Broad at first, then along its edge: hair 60 mm wide and 5 mm thick, which spreads under its load.
void expect_broad_then_edge(const TriedStroke& hake) {
    const double broad = thickness(hake, 60, 110), edge = thickness(hake, 150, 180);
    EXPECT_NEAR(broad, kHeight / 1.9, 0.15 * kHeight) << "the sheet is 1.9 widths high";
    EXPECT_LT(edge, 0.5 * broad);
}

class TriedStrokeOf : public testing::TestWithParam<std::string> {};

// A picture that cuts the stroke off, or in which it is lost, does not show the brush.
TEST_P(TriedStrokeOf, EachShippedBrushLiesWholeInItsPicture) {
    const std::string& name = GetParam();
    const TriedStroke s = paint_tried_stroke(brush::load_preset(name), {}, stroke::shared_tip_lag_cache());
    show(s, name);
    int dark = 0, border = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            dark += is_dark(s, x, y);
            border += is_dark(s, x, y) && (x == 0 || y == 0 || x == kWidth - 1 || y == kHeight - 1);
        }
    EXPECT_EQ(border, 0);
    // A line of two pixels along the whole picture is 2.5 % of it.
    EXPECT_GT(dark, 0.02 * kWidth * kHeight);
    EXPECT_LT(dark, 0.6 * kWidth * kHeight);
    if (name == "hake-60") expect_broad_then_edge(s);
}
INSTANTIATE_TEST_SUITE_P(, TriedStrokeOf, testing::ValuesIn(brush::list_presets()));

// Stored by the content of the preset, it must follow from that alone.
TEST(TriedStroke, OfOnePresetIsTheSameToTheBit) {
    const brush::Preset wolf = brush::load_preset("wolf-small");
    EXPECT_EQ(paint_tried_stroke(wolf).rgb, paint_tried_stroke(wolf).rgb);
}

// The sheet is in proportion to the brush, and a scaled brush draws the same strokes at its size: what is dark differs
// by the paper's grain, which does not scale.
TEST(TriedStroke, OfABrushAtAnotherSizeCoversAsMuch) {
    const TriedStroke one = paint_tried_stroke(brush::load_preset("goat-small")),
                      two = paint_tried_stroke(brush::load_preset("goat-small*2"));
    EXPECT_NEAR(thickness(one, 0, kWidth), thickness(two, 0, kWidth), 0.1 * thickness(one, 0, kWidth));
}

TEST(TriedStroke, StopsWhenItIsAskedTo) {
    const auto stop = [](std::string_view, double) { return false; };
    EXPECT_THROW(paint_tried_stroke(brush::load_preset("goat-large"), stop), Cancelled);
}

}  // namespace
}  // namespace tuft::pictures
