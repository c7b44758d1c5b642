#include "render/brush/brush_picture.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace tuft::render
