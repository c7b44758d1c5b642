#include "render/brush/brush_picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/text/units.h"
#include "render/brush/tuft_drawing.h"

namespace tuft::render {
namespace {

TEST(BrushPicture, HasPaperHairAndInkWhereTheyBelong) {
    const BrushPicture picture = draw_tuft(brush::load_preset("goat-small"), 640);
    ASSERT_EQ(picture.width, 640);
    ASSERT_EQ(picture.rgb.size(), std::size_t(3) * picture.width * picture.height);
    const auto at = [&](int x, int y) { return picture.rgb[(static_cast<std::size_t>(y) * 640 + x) * 3]; };
    EXPECT_GT(at(2, 100), 230);  // paper at the side
    // Each of the three rows: the deepest press leaves a mark below its ground line, wider than the
    // lightest; the lifted tuft leaves none.
    for (int row = 0; row < 3; ++row) {
        const double unit = 640 / 2000.0, top = (54 + 535 * row) * unit;
        const auto ink = [&](int column) {
            int sum = 0;
            for (int y = static_cast<int>(top + 410 * unit); y < static_cast<int>(top + 500 * unit); ++y)
                for (int x = column * 640 / 6; x < (column + 1) * 640 / 6; ++x) sum += at(x, y) < 60;
            return sum;
        };
        EXPECT_GT(ink(4), 150) << row;
        EXPECT_GT(ink(4), 2 * ink(1)) << row;
        EXPECT_EQ(ink(5), 0) << row;
    }
}

// Each spine's hair ended in one straight line, so that a toe was a flight of five steps.
TEST(BrushPicture, AFilbertEndsInARoundToe) {
    brush::Tuft tuft = brush::make_tuft(brush::load_preset("filbert-12"));
    const brush::Preset& p = tuft.preset;
    const brush::Pose pose{{0, 0, 0.05}, {1, 0, 0, 0}, 0};
    const brush::TuftState state = brush::step(tuft, pose, {}, 0);
    constexpr int kSize = 800;
    constexpr double kScale = 25e3;  // pixels a metre
    BrushCanvas canvas(kSize, kSize, Vec3(1));
    BrushView view;
    view.origin = pose.position, view.foot = {0.5 * kSize, 50}, view.scale = kScale;
    draw_brush(canvas, {tuft, state, pose}, view, 0.01);
    const std::vector<std::uint8_t> rgb = to_srgb(canvas);
    double sum = 0;
    int columns = 0;
    for (double x = -0.85; x <= 0.85; x += 0.05, ++columns) {
        const int column = static_cast<int>(0.5 * kSize + 0.5 * x * p.width * kScale);
        int end = kSize - 1;
        while (end > 0 && rgb[3 * static_cast<std::size_t>(end * kSize + column) + 2] > 200) --end;
        const double drawn = (end - 50) / kScale, law = p.length - p.toe * (1 - std::sqrt(1 - x * x));
        sum += std::abs(drawn - law);
    }
    RecordProperty("mean_mm", std::to_string(sum / columns / kMillimetre));
    // Hairs are 0.4 mm apart, and end unevenly: 0.36 mm, with the steps 0.58 mm.
    EXPECT_LT(sum / columns, 0.45e-3);
}

}  // namespace
}  // namespace tuft::render
