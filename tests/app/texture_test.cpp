#include "app/view/texture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "models.h"

namespace tuft::app {
namespace {

TEST(Texture, RefreshedTilesAreWhatTheWholeWouldBe) {
    // 520 is no multiple of the tile: the last row and column are padded.
    const stroke::Model model = test::shipped_model("bowl.ply", 520);
    stroke::Document painting(model);
    Texture texture(painting);
    render::MapPixels map = texture.pixels();
    const std::size_t per_side = map.size / 16;
    for (int i = 0; i < 3; ++i) {
        stroke::PaintStroke stroke;
        stroke.trace.flat = false;
        stroke.brush = "wolf-medium";
        stroke.ink = i == 1 ? "cinnabar" : "carbon";
        painting.begin(std::move(stroke));
        painting.extend(test::poses_above(model, painting.materials().brush("wolf-medium"), 0.1, 0.01 * i));
        painting.end();
        if (i == 2) painting.undo();
        const auto slots = painting.appearance().take_dirty();
        for (const render::TilePixels& tile : texture.refresh(slots, painting)) {
            const std::size_t column = tile.tile % per_side, row = tile.tile / per_side;
            for (std::size_t level = 0; level < render::kTextureLevels; ++level) {
                const std::size_t side = 16u >> level, stride = map.size >> level;
                for (std::size_t k = 0; k < side * side; ++k)
                    map.levels[level][(row * side + k / side) * stride + column * side + k % side] =
                        tile.rgba[static_cast<std::size_t>(render::TilePixels::kStart[level]) + k];
            }
        }
    }
    ASSERT_FALSE(painting.layers().canvas().touched_slots().empty());
    const render::MapPixels whole = Texture(painting).pixels();
    for (std::size_t level = 0; level < render::kTextureLevels; ++level)
        EXPECT_EQ(map.levels[level], whole.levels[level]) << level;
}

TEST(HeightCode, IsFineForThinInkAndReachesThickPaint) {
    EXPECT_EQ(render::code_of_height(0), 0);
    EXPECT_GT(render::height_of_code(255), 900);
    for (double height = 0.01; height < 950; height *= 1.07) {
        const double back = render::height_of_code(std::round(render::code_of_height(height)));
        // Half a step of code: half of dh/dcode = (4.8 + h) / 48, and the next order of it.
        EXPECT_NEAR(back, height, 0.5 * (4.8 + height) / 48 * 1.02) << height;
    }
}

}  // namespace
}  // namespace tuft::app
