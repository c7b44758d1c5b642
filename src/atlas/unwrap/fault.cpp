#include "atlas/unwrap/fault.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "atlas/pack/coverage.h"
#include "atlas/pack/raster.h"

namespace tuft::atlas {
namespace {

constexpr std::uint32_t kMostTexels = 65536;  // per side
constexpr double kOverPage = 1e-6;            // of a page: roundings of floats

using Corners = std::array<Vec2, 3>;

Corners corners(const Atlas& atlas, std::size_t t) {
    return {Vec2(atlas.corner_uvs[3 * t]), Vec2(atlas.corner_uvs[3 * t + 1]), Vec2(atlas.corner_uvs[3 * t + 2])};
}

/// Whether a triangle of an atlas of k × k pages lies on one that is used.
bool on_a_page(const Corners& uv, const Atlas& atlas, double k) {
    const Vec2 lo = k * glm::min(glm::min(uv[0], uv[1]), uv[2]), hi = k * glm::max(glm::max(uv[0], uv[1]), uv[2]);
    const Vec2 page = glm::floor(0.5 * (lo + hi)), over = glm::max(page - lo, hi - page - 1.0);
    return std::max(over.x, over.y) <= kOverPage && page.x + k * page.y < atlas.pages;
}

}  // namespace

Message fault_of(const Atlas& atlas) {
    if (atlas.size == 0 || atlas.size > kMostTexels || !(atlas.texel_size > 0) || !std::isfinite(atlas.texel_size))
        return "the atlas has no valid size";
    if (atlas.pages < 1 || atlas.pages > 100 || atlas.size % atlas.pages_per_side() != 0)
        return "the atlas has no valid pages";
    for (const std::uint32_t udim : atlas.udims)
        if (udim < 1001 || udim > 2000) return "a page of the atlas has no valid number";
    if (atlas.triangle_chart.empty() || atlas.corner_uvs.size() != 3 * atlas.triangle_chart.size())
        return "a part of the model is missing";
    for (const std::uint32_t chart : atlas.triangle_chart)
        if (chart >= atlas.n_charts) return "a triangle is in a chart that does not exist";
    for (const Vec2f& uv : atlas.corner_uvs) {
        if (!is_finite(uv)) return "some UVs are not finite";
        if (std::min(uv.x, uv.y) < 0 || std::max(uv.x, uv.y) > 1) return "some UVs lie off the page";
    }
    const std::uint32_t k = atlas.pages_per_side();
    std::size_t mirrored = 0;
    for (std::size_t t = 0; t < atlas.corner_uvs.size() / 3; ++t) {
        const Corners uv = corners(atlas, t);
        if (k > 1 && !on_a_page(uv, atlas, k)) return "a triangle lies on no page";
        const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
        mirrored += a.x * b.y - a.y * b.x < 0;
    }
    if (mirrored > 0) return Message("{} triangles lie mirrored in it", mirrored);
    const Coverage coverage = cover(atlas.corner_uvs, {}, atlas.size);
    if (coverage.covered == 0) return "no triangle has room in it";
    if (coverage.twice > 0) return Message("triangles overlap in {} of its texels", coverage.twice);
    return {};
}

}  // namespace tuft::atlas
