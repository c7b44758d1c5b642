#include "ink/colour/base_colour.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/hash.h"
#include "core/random.h"
#include "core/system/parallel.h"
#include "ink/canvas/canvas.h"
#include "ink/colour/presets.h"
#include "ink/composite/composite.h"
#include "texels.h"

namespace tuft::ink {
namespace {

/// A square of two triangles that fills the page, with UVs of the file from `lo` to `hi`.
struct Square {
    mesh::TriangleMesh mesh;
    atlas::Atlas atlas;
    atlas::TexelMap map;

    explicit Square(std::uint32_t size, Vec2f lo = Vec2f(0), Vec2f hi = Vec2f(1)) {
        const Vec2f corner[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        for (const Vec2f& c : corner) mesh.positions.emplace_back(0.1f * c.x, 0.1f * c.y, 0);
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
        mesh.neighbours = {kNone, kNone, 1, 0, kNone, kNone};
        for (const auto& triangle : mesh.triangles)
            for (const std::uint32_t v : triangle) {
                mesh.corner_normals.emplace_back(0, 0, 1);
                mesh.corner_uvs.push_back(lo + corner[v] * (hi - lo));
                atlas.corner_uvs.push_back(corner[v]);
            }
        for (const Vec3f& p : mesh.positions) mesh.bounds.add(Vec3(p));
        atlas.size = size;
        atlas.texel_size = 0.1 / size;
        atlas.triangle_chart = {0, 0};
        atlas.n_charts = 1;
        map = atlas::build_texel_map(mesh, atlas);
    }

    std::array<int, 3> at(const BaseColour& base_colour, int x, int y) const {
        const atlas::TexelRef t = atlas::texel_ref(map, x, y);
        std::array<int, 3> c{};
        for (int k = 0; k < 3; ++k) c[k] = base_colour.tiles[t.slot].rgb[k][t.texel];
        return c;
    }
};

std::shared_ptr<mesh::Picture> random_picture(int width, int height, std::uint64_t seed) {
    auto picture = std::make_shared<mesh::Picture>();
    picture->width = width;
    picture->height = height;
    picture->rgb.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (std::size_t i = 0; i < picture->rgb.size(); ++i)
        picture->rgb[i] = static_cast<std::uint8_t>(256 * uniform(seed, i));
    return picture;
}

std::array<int, 3> pixel(const mesh::Picture& picture, int x, int row_from_below) {
    const std::size_t at =
        3 * (static_cast<std::size_t>(picture.height - 1 - row_from_below) * static_cast<std::size_t>(picture.width) +
             static_cast<std::size_t>(x));
    return {picture.rgb[at], picture.rgb[at + 1], picture.rgb[at + 2]};
}

TEST(BaseColour, APictureOfTheAtlasSizeIsKeptPixelByPixel) {
    Square square(96);
    const auto picture = random_picture(96, 96, 1);
    square.mesh.materials = {{.picture = picture}};
    const BaseColour base_colour = base_colour_of(square.mesh, square.atlas, square.map);
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 96; ++x) ASSERT_EQ(square.at(base_colour, x, y), pixel(*picture, x, y)) << x << " " << y;
}

TEST(BaseColour, APictureIsRepeatedBeyondItsEnds) {
    Square square(64, Vec2f(-1, 2), Vec2f(1, 4));
    const auto picture = random_picture(32, 32, 2);
    square.mesh.materials = {{.picture = picture}};
    const BaseColour base_colour = base_colour_of(square.mesh, square.atlas, square.map);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) ASSERT_EQ(square.at(base_colour, x, y), pixel(*picture, x % 32, y % 32));
}

// Black and white pixels seen from afar are half the light, which sRGB writes as 188.
TEST(BaseColour, FinerPicturesAreMeansInLinearLight) {
    Square square(32);
    auto picture = random_picture(256, 256, 3);
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 256; ++x)
            for (int c = 0; c < 3; ++c)
                picture->rgb[3 * static_cast<std::size_t>(256 * y + x) + static_cast<std::size_t>(c)] =
                    (x + y) % 2 ? 255 : 0;
    square.mesh.materials = {{.picture = picture}};
    const BaseColour base_colour = base_colour_of(square.mesh, square.atlas, square.map);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) ASSERT_EQ(square.at(base_colour, x, y), (std::array{188, 188, 188}));
}

TEST(BaseColour, ColoursOfVerticesAndMaterialsMultiplyInLinearLight) {
    Square square(64);
    square.mesh.vertex_colours.assign(4, {188, 188, 188, 255});
    square.mesh.materials = {{.colour = Vec3f(1, 188 / 255.0f, 0)}};
    const BaseColour base_colour = base_colour_of(square.mesh, square.atlas, square.map);
    const int quarter = static_cast<int>(std::lround(255 * srgb_encode(0.25f)));
    const std::array<int, 3> seen = square.at(base_colour, 20, 30);
    EXPECT_EQ(seen[0], 188);
    EXPECT_NEAR(seen[1], quarter, 1) << "188 stands for 0.503";
    EXPECT_EQ(seen[2], 0);
}

TEST(BaseColour, GroupsHaveTheirOwnColours) {
    Square square(64);
    square.mesh.triangle_groups = {0, 1};
    square.mesh.group_names = {"a", "b"};
    square.mesh.materials = {{.colour = Vec3f(1, 0, 0)}, {.colour = Vec3f(0, 0, 1)}};
    const BaseColour base_colour = base_colour_of(square.mesh, square.atlas, square.map);
    EXPECT_EQ(square.at(base_colour, 50, 10), (std::array{255, 0, 0}));
    EXPECT_EQ(square.at(base_colour, 10, 50), (std::array{0, 0, 255}));
}

TEST(BaseColour, IsEmptyForAModelWithoutColoursAndTheSameForAnyNumberOfThreads) {
    Square square(128);
    EXPECT_TRUE(base_colour_of(square.mesh, square.atlas, square.map).empty());
    square.mesh.materials = {{.picture = random_picture(300, 170, 4)}};
    std::uint64_t hash[2];
    for (int i = 0; i < 2; ++i) {
        set_thread_count(i == 0 ? 1 : 4);
        const BaseColour base_colour = base_colour_of(square.mesh, square.atlas, square.map);
        hash[i] = hash_bytes(base_colour.tiles.data(), base_colour.tiles.size() * sizeof(BaseColour::Tile));
    }
    set_thread_count(0);
    EXPECT_EQ(hash[0], hash[1]);
}

/// A canvas with one ink on the whole of some tiles.
Canvas painted(const Square& square, float film, std::uint32_t n_tiles) {
    Canvas canvas(square.map.n_slots());
    const int p = canvas.add_pigment(load_ink("indigo").parts[0].pigment);
    for (std::uint32_t slot = 0; slot < n_tiles; ++slot) canvas.touch(slot, p).fill(film);
    return canvas;
}

// Also saturated colours, which the bands alone cannot hold.
TEST(BaseColour, BareTexelsHaveItsColourInTilesWithInkAndWithout) {
    Square square(64);
    const auto picture = random_picture(64, 64, 5);
    for (std::size_t i = 0; i < 3 * 64 * 10; ++i) picture->rgb[i] = i % 3 == 2 ? 255 : 0;  // pure blue
    square.mesh.materials = {{.picture = picture}};
    const BaseColour base_colour = base_colour_of(square.mesh, square.atlas, square.map);
    const Canvas canvas = painted(square, 0, 8);  // touched, with nothing on it
    Stack stack(canvas);
    stack.base_colour = &base_colour;
    for (const char* name : {"porcelain", "clay"}) {
        const AtlasMap<std::uint8_t> seen = compose_srgb8(stack, square.map, load_substrate(name));
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x)
                for (int c = 0; c < 3; ++c)
                    ASSERT_EQ(seen.texels[3 * static_cast<std::size_t>(64 * y + x) + static_cast<std::size_t>(c)],
                              pixel(*picture, x, y)[c])
                        << name << " " << x << " " << y << " " << c;
    }
}

TEST(BaseColour, InkOverItIsThatOverASubstrateOfTheSameColour) {
    Square square(64);
    Substrate substrate = load_substrate("bisque");
    Vec3f code;
    for (int c = 0; c < 3; ++c) {
        code[c] = std::round(255 * srgb_encode(substrate.reflectance[c])) / 255;
        substrate.reflectance[c] = srgb_decode(code[c]);
    }
    square.mesh.materials = {{.colour = code}};
    const BaseColour base_colour = base_colour_of(square.mesh, square.atlas, square.map);
    const Canvas canvas = painted(square, 0.7f, 16);
    Stack on_base_colour(canvas);
    on_base_colour.base_colour = &base_colour;
    const TileAppearance a = shade_tile(on_base_colour, 3, substrate), b = shade_tile(Stack(canvas), 3, substrate);
    for (int c = 0; c < 3; ++c)
        for (int t = 0; t < kN; ++t)
            ASSERT_NEAR(a.colour[c][t], b.colour[c][t], 2e-6) << "floats of two orders of summation";
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.roughness, b.roughness);
}

}  // namespace
}  // namespace tuft::ink
