#include "atlas/texels/gutter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "analytic_surfaces.h"
#include "atlas/texels/seams.h"
#include "core/hash.h"
#include "core/system/parallel.h"

namespace tuft::atlas {
namespace {

using testing::Unwrapped;

/// A field on the surface written into a picture of the atlas.
template <class Field>
std::vector<float> picture(const TexelMap& map, Field&& field) {
    std::vector<float> image(std::size_t{map.size} * map.size, -100.0f);
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot) {
        const std::uint32_t tile = map.tile_of_slot[slot];
        for (int t = 0; t < kTileTexels; ++t) {
            if (map.tiles[slot].cluster[t] == kNoCluster) continue;
            const std::size_t x = std::size_t{tile % map.tiles_per_side} * kTile + t % kTile;
            const std::size_t y = std::size_t{tile / map.tiles_per_side} * kTile + t / kTile;
            image[y * map.size + x] = static_cast<float>(field(Vec3(map.position(slot, t))));
        }
    }
    return image;
}

double bilinear(const std::vector<float>& image, std::uint32_t size, const Vec2& uv) {
    const double x = uv.x - 0.5, y = uv.y - 0.5;
    const auto i = static_cast<std::size_t>(x), j = static_cast<std::size_t>(y);
    const double fx = x - double(i), fy = y - double(j);
    const float* p = image.data() + j * size + i;
    return (1 - fy) * ((1 - fx) * p[0] + fx * p[1]) + fy * ((1 - fx) * p[size] + fx * p[size + 1]);
}

struct Mismatch {
    double rms = 0, max = 0;
};

/// Difference of the filtered picture between both sides of every seam, `inset` metres inside
/// the box of the mesh: where the surface ends, so does what could be interpolated.
Mismatch mismatch(const Unwrapped& u, const std::vector<float>& image, double inset = -1) {
    std::vector<SeamSample> samples;
    for (const SeamEdge& e : find_seams(u.mesh, u.atlas)) sample_seam(u.mesh, u.atlas, e, 0.3, samples);
    Mismatch m;
    const Vec3 lo = u.mesh.bounds.lo + inset, hi = u.mesh.bounds.hi - inset;
    for (const SeamSample& s : samples) {
        if (inset > 0 && (s.position.x < lo.x || s.position.y < lo.y || s.position.x > hi.x || s.position.y > hi.y))
            continue;
        const double d = bilinear(image, u.atlas.size, s.a.uv) - bilinear(image, u.atlas.size, s.b.uv);
        m.rms += d * d;
        m.max = std::max(m.max, std::abs(d));
    }
    m.rms = std::sqrt(m.rms / double(std::max<std::size_t>(samples.size(), 1)));
    return m;
}

TEST(Gutter, HidesTheSeamsOfASheet) {
    const Unwrapped u = testing::sheet(0.2, 3, 100);
    const TexelMap map = build_texel_map(u.mesh, u.atlas);
    const Gutter gutter = build_gutter(u.mesh, u.atlas, map, 4);
    const double k = 2 * std::numbers::pi / (16 * 0.2 / 300);  // waves of 16 texels
    auto image = picture(map, [&](const Vec3& p) { return std::sin(k * (0.8 * p.x + 0.6 * p.y)); });
    fill_gutter(gutter, map, 1, image);
    const Mismatch m = mismatch(u, image, 2 * 0.2 / 300);
    // Target (dilation gives 20 % and 50 %); also where four charts meet.
    EXPECT_LT(m.rms, 0.01);
    EXPECT_LT(m.max, 0.035);
}

TEST(Gutter, HidesTheSeamsOfASphere) {
    const Unwrapped u = testing::sphere(0.02, 200);
    const TexelMap map = build_texel_map(u.mesh, u.atlas);
    const Gutter gutter = build_gutter(u.mesh, u.atlas, map, 4);
    const double k = 2 * std::numbers::pi / (16 * map.texel_size);
    auto image = picture(map, [&](const Vec3& p) { return std::sin(k * (0.48 * p.x + 0.6 * p.y + 0.64 * p.z)); });
    fill_gutter(gutter, map, 1, image);
    const Mismatch m = mismatch(u, image);
    // Texels of 0.7 to 1.3 of the mean, sheared by up to 30° where three charts meet.
    EXPECT_LT(m.rms, 0.01);
    EXPECT_LT(m.max, 0.035);
}

TEST(Gutter, KeepsConstantsAndLinearFunctionsAndStaysOutsideCharts) {
    const Unwrapped u = testing::sheet(0.2, 2, 60);
    const TexelMap map = build_texel_map(u.mesh, u.atlas);
    const Gutter gutter = build_gutter(u.mesh, u.atlas, map, 3);
    ASSERT_EQ(gutter.start.size(), gutter.texels.size() + 1);
    ASSERT_GT(gutter.texels.size(), 4u * 4 * 60 * 3 * 9 / 10);
    std::set<std::uint32_t> seen;
    for (std::size_t i = 0; i < gutter.texels.size(); ++i) {
        EXPECT_TRUE(seen.insert(gutter.texels[i]).second);
        EXPECT_FALSE(texel_ref(map, gutter.texels[i] % map.size, gutter.texels[i] / map.size).valid());
        double sum = 0;
        for (std::uint32_t k = gutter.start[i]; k < gutter.start[i + 1]; ++k) sum += gutter.taps[k].weight;
        EXPECT_NEAR(sum, 1, 1e-5);
        EXPECT_LE(gutter.start[i + 1] - gutter.start[i], 10u);
    }
    auto image = picture(map, [](const Vec3& p) { return 10 * p.x - 7 * p.y; });
    fill_gutter(gutter, map, 1, image);
    EXPECT_LT(mismatch(u, image, 2 * 0.2 / 120).max,
              1e-4);  // a linear fit reproduces it: float rounding only
}

TEST(Gutter, ShowsNoLineInTheLevelsOfAMipMap) {
    Unwrapped u = testing::sphere(0.02, 256);
    u.atlas.size = (u.atlas.size + 7) / 8 * 8;
    const double grow = double(testing::sphere(0.02, 256).atlas.size) / u.atlas.size;
    for (Vec2f& uv : u.atlas.corner_uvs) uv *= float(grow);
    u.atlas.gutter = 8;
    const TexelMap map = build_texel_map(u.mesh, u.atlas);
    const double texel = map.texel_size;
    for (const int level : {1, 2}) {
        const double k = 2 * std::numbers::pi / (16 * (1 << level) * texel);
        auto image = picture(map, [&](const Vec3& p) { return std::sin(k * (0.48 * p.x + 0.6 * p.y + 0.64 * p.z)); });
        fill_gutter(build_gutter(u.mesh, u.atlas, map, 8), map, 1, image);
        const std::vector<MipLevel> levels = mip_levels(u.mesh, u.atlas, map, 1, image);
        ASSERT_EQ(levels.size(), 2u);  // gaps of 8, 4, 2 texels
        Unwrapped small = u;
        small.atlas.size = levels[level - 1].size;
        ASSERT_EQ(small.atlas.size, u.atlas.size >> level);
        const Mismatch m = mismatch(small, levels[level - 1].image);
        // As the picture itself.
        EXPECT_LT(m.rms, 0.01) << level;
        EXPECT_LT(m.max, 0.035) << level;
    }
}

TEST(Gutter, SameBitsForAnyNumberOfThreads) {
    const Unwrapped u = testing::sphere(0.02, 90);
    const TexelMap map = build_texel_map(u.mesh, u.atlas);
    std::set<std::uint64_t> hashes;
    for (const int n : {1, 2, 8}) {
        set_thread_count(n);
        const Gutter g = build_gutter(u.mesh, u.atlas, map, 4);
        hashes.insert(
            hash_span(std::span<const GutterTap>(g.taps), hash_span(std::span<const std::uint32_t>(g.texels))));
    }
    set_thread_count(0);
    EXPECT_EQ(hashes.size(), 1u);
}

}  // namespace
}  // namespace tuft::atlas
