#include "footprint/outline/bands.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "footprint/outline/picture.h"

namespace tuft::footprint {
namespace {

Recycled<std::uint8_t> drawn(int width, int height, bool by_columns, bool turned) {
    Bands bands(width, height, by_columns);
    const auto place = [&](double x, double y) { return turned ? Vec2{y, x} : Vec2{x, y}; };
    // Shallow ones that taper, lean and begin within cells; one that leaves the picture.
    bands.draw(place(3.3, 20.2), place(47.7, 26.9), 2.6, 0.4, place(0, 1));
    bands.draw(place(50, 9.5), place(5.25, 6.5), 0.3, 1.7, place(-0.6, 0.8));
    bands.draw(place(30.5, 2.5), place(90, -5), 1.5, 1.5, place(0, 1));
    bands.draw(place(30.5, 33), place(57, 41), 3, 3, place(0, 1));
    Recycled<std::uint8_t> level;
    bands.copy_rows(level);
    return level;
}

TEST(Bands, AreTheSameHoweverThePictureIsKept) {
    EXPECT_EQ(drawn(57, 41, false, false), drawn(57, 41, true, false));
    EXPECT_EQ(drawn(41, 57, false, true), drawn(41, 57, true, true));
}

TEST(Bands, TurnWithThePicture) {
    Recycled<std::uint8_t> turned;
    transpose(drawn(57, 41, false, false), 57, 41, turned);
    EXPECT_EQ(turned, drawn(41, 57, false, true));
}

TEST(Bands, CoverTheirArea) {
    Bands bands(64, 32, false);
    bands.draw({4.5, 10}, {54.5, 16}, 2, 4, {0, 1});
    Recycled<std::uint8_t> level;
    bands.copy_rows(level);
    const double sum = std::accumulate(level.begin(), level.end(), 0.0) / 255;
    // 50 cells of a mean width of 6; half a level of rounding in each of the border's cells, some
    // two a column.
    EXPECT_NEAR(sum, 300, 2 * 50 * 0.5 / 255);
}

TEST(Pictures, TurnedTwiceAreThemselves) {
    for (const int width : {1, 7, 16, 23, 64})
        for (const int height : {1, 15, 17, 40}) {
            Recycled<std::uint8_t> cells(static_cast<std::size_t>(width) * height), once, twice;
            for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = static_cast<std::uint8_t>(37 * i + i / 256);
            transpose(cells, width, height, once);
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) ASSERT_EQ(once[x * height + y], cells[y * width + x]);
            transpose(once, height, width, twice);
            EXPECT_EQ(twice, cells);
        }
}

}  // namespace
}  // namespace tuft::footprint
