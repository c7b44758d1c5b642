#include "app/view/texture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
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

// Beside a bright ground an eye sees differences of light, and little of those near black.
TEST(Texture, MarksBlackInkByAsMuchLightAsABareSubstrate) {
    const stroke::Model model = test::shipped_model("bowl.ply", 256);
    std::uint32_t t = 0;
    while (!atlas::texel_ref(model.texels, t % 256, t / 256).valid()) ++t;
    const atlas::TexelRef ref = atlas::texel_ref(model.texels, t % 256, t / 256);
    const atlas::TexelPlace place = atlas::texel_place(model.texels, ref.slot, ref.texel);
    const auto marked_by = [&](const char* ink) {
        stroke::Document painting(model);
        if (ink) {
            stroke::Fill fill;
            fill.ink = ink;
            painting.paint(fill);
        }
        Texture texture(painting);
        const auto luminance = [&] {
            const render::MapPixels map = texture.pixels();
            const auto& rgba = map.levels[0][static_cast<std::size_t>(place.y * map.size + place.x)];
            const auto light = [&](std::size_t c) { return double{ink::linear_of_code()[rgba[c]]}; };
            return 0.2126 * light(0) + 0.7152 * light(1) + 0.0722 * light(2);  // Y of linear sRGB
        };
        const double plain = luminance();
        Texture::Marks marks;
        marks[ref.slot].fill(Texture::kInked);
        texture.show_marks(marks, painting);
        return std::abs(luminance() - plain);
    };
    const double ground = marked_by(nullptr);
    EXPECT_GT(ground, 0.05);  // of white's; a twentieth is seen at a glance
    EXPECT_GT(marked_by("carbon"), ground);
}

// Light of the first channel as a graphics card looks it up at the centre of texel (x, y) of the first level.
float looked_up(const render::MapPixels& map, std::size_t level, std::size_t x, std::size_t y) {
    const auto side = static_cast<int>(map.size >> level);
    const double scale = 1.0 / (1 << level);
    const double u = (static_cast<double>(x) + 0.5) * scale - 0.5, v = (static_cast<double>(y) + 0.5) * scale - 0.5;
    double light = 0;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const double column = std::floor(u) + i, row = std::floor(v) + j;
            const double weight = (1 - std::abs(u - column)) * (1 - std::abs(v - row));
            const int cx = std::clamp(static_cast<int>(column), 0, side - 1),
                      cy = std::clamp(static_cast<int>(row), 0, side - 1);
            light += weight * ink::linear_of_code()[map.levels[level][static_cast<std::size_t>(cy * side + cx)][0]];
        }
    return static_cast<float>(light);
}

TEST(Texture, ShowsNoLineAtSeamsAtCoarseLevels) {
    // Where all of a model is dark, a lookup on it is dark at each level: it takes nothing of what is bare between
    // charts.
    const stroke::Model model = test::shipped_model("bowl.ply", 512);
    stroke::Document painting(model);
    painting.paint(stroke::Fill{.ink = "carbon"});
    const render::MapPixels map = Texture(painting).pixels();
    const atlas::TexelMap& texels = model.texels;
    std::array<float, 4> lightest{};
    for (std::uint32_t slot = 0; slot < texels.n_slots(); ++slot)
        for (std::size_t t = 0; t < atlas::kTileTexels; ++t) {
            if (texels.tiles[slot].cluster[t] == atlas::kNoCluster) continue;
            const std::size_t tile = texels.tile_of_slot[slot], per_side = texels.tiles_per_side;
            for (std::size_t level = 0; level < lightest.size(); ++level)
                lightest[level] =
                    std::max(lightest[level], looked_up(map, level, tile % per_side * atlas::kTile + t % atlas::kTile,
                                                        tile / per_side * atlas::kTile + t / atlas::kTile));
        }
    ASSERT_LT(lightest[0], 0.1f);
    // Two steps of code of a dark colour: a gutter's fit is rounded, and so is a mean.
    constexpr float kRounding = 2 * 0.0008f;
    EXPECT_NEAR(lightest[1], lightest[0], kRounding);
    EXPECT_NEAR(lightest[2], lightest[0], kRounding);
    // A texel of the third level without a gutter of 4 texels begins 2.5 texels from a texel of a chart in both
    // directions at least: its weight is (1/2 − 2.5/8)² at most, and its light below 1.
    EXPECT_NEAR(lightest[3], lightest[0], 9.0f / 256);
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
