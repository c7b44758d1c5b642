#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "atlas/texels/gutter.h"
#include "core/system/parallel.h"

namespace tuft::atlas {
namespace {

constexpr std::uint32_t kLeastGap = 2;  // texels between charts
constexpr double kLeastLength = 4;      // texels of a chart
constexpr double kLostArea = 0.01;      // of the atlas, in charts shorter than that

/// Length of each chart's box and its area in the atlas, both with the atlas as unit.
struct ChartSizes {
    std::vector<double> length, area;
    double total = 0;
};

ChartSizes chart_sizes(const Atlas& atlas) {
    std::uint32_t n = 0;
    for (const std::uint32_t c : atlas.triangle_chart) n = std::max(n, c + 1);
    std::vector<Vec2> lo(n, Vec2{2}), hi(n, Vec2{-2});
    ChartSizes sizes{std::vector<double>(n, 0), std::vector<double>(n, 0)};
    for (std::size_t t = 0; t < atlas.triangle_chart.size(); ++t) {
        const std::uint32_t c = atlas.triangle_chart[t];
        std::array<Vec2, 3> p;
        for (int k = 0; k < 3; ++k) {
            p[k] = Vec2(atlas.corner_uvs[3 * t + k]);
            lo[c] = glm::min(lo[c], p[k]);
            hi[c] = glm::max(hi[c], p[k]);
        }
        const Vec2 d = p[1] - p[0], e = p[2] - p[0];
        const double area = 0.5 * std::abs(d.x * e.y - d.y * e.x);
        if (!std::isfinite(area)) continue;
        sizes.area[c] += area;
        sizes.total += area;
    }
    for (std::uint32_t c = 0; c < n; ++c) sizes.length[c] = std::max({hi[c].x - lo[c].x, hi[c].y - lo[c].y, 0.0});
    return sizes;
}

bool worth_a_level(const ChartSizes& sizes, std::uint32_t size) {
    double lost = 0;
    for (std::size_t c = 0; c < sizes.length.size(); ++c)
        if (sizes.length[c] * size < kLeastLength) lost += sizes.area[c];
    return lost < kLostArea * sizes.total;
}

std::uint32_t chart_of(const TexelMap& map, const TexelRef& ref) {
    if (!ref.valid()) return kNone;
    return map.cluster_chart[map.cluster_start[ref.slot] + map.tiles[ref.slot].cluster[ref.texel]];
}

/// Means of the four texels below each covered texel of `map`.
void shrink(const TexelMap& below, std::span<const float> from, const TexelMap& map, int channels,
            std::vector<float>& to) {
    parallel_for(map.n_slots(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin * kTileTexels; i < end * kTileTexels; ++i) {
            const auto slot = static_cast<std::uint32_t>(i / kTileTexels);
            const int texel = static_cast<int>(i % kTileTexels);
            if (map.tiles[slot].cluster[texel] == kNoCluster) continue;
            const auto [x, y] = texel_place(map, slot, static_cast<std::uint32_t>(texel));
            const std::uint32_t chart = map.cluster_chart[map.cluster_start[slot] + map.tiles[slot].cluster[texel]];
            std::array<bool, 4> own{};
            for (int k = 0; k < 4; ++k) {
                const std::uint32_t c = chart_of(below, texel_ref(below, 2 * x + k % 2, 2 * y + k / 2));
                own[k] = c == chart || c == kNone;
            }
            if (own == std::array<bool, 4>{}) own.fill(true);
            const auto n = static_cast<float>(std::count(own.begin(), own.end(), true));
            float* out = to.data() + (y * map.size + x) * channels;
            for (int k = 0; k < 4; ++k) {
                if (!own[k]) continue;
                const float* in = from.data() + ((2 * y + k / 2) * below.size + 2 * x + k % 2) * channels;
                for (int c = 0; c < channels; ++c) out[c] += in[c] / n;
            }
        }
    });
}

}  // namespace

std::vector<MipLevel> mip_levels(const mesh::TriangleMesh& mesh, const Atlas& atlas, const TexelMap& map, int channels,
                                 std::span<const float> image) {
    assert(image.size() == std::size_t{map.size} * map.size * channels);
    std::vector<MipLevel> levels;
    const ChartSizes sizes = chart_sizes(atlas);
    Atlas small = atlas;
    TexelMap before;
    const TexelMap* below = &map;
    while (small.size % 2 == 0 && small.gutter / 2 >= kLeastGap && worth_a_level(sizes, small.size / 2)) {
        small.size /= 2;
        small.gutter /= 2;
        small.texel_size *= 2;
        TexelMap level_map = build_texel_map(mesh, small);
        MipLevel level{small.size, std::vector<float>(std::size_t{small.size} * small.size * channels, 0)};
        shrink(*below, levels.empty() ? image : std::span<const float>(levels.back().image), level_map, channels,
               level.image);
        fill_gutter(build_gutter(mesh, small, level_map, small.gutter), level_map, channels, level.image);
        levels.push_back(std::move(level));
        before = std::move(level_map);
        below = &before;
    }
    return levels;
}

}  // namespace tuft::atlas
