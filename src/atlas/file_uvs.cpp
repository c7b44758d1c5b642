#include "atlas/file_uvs.h"

#include <algorithm>
#include <cmath>

#include "atlas/chart_mesh.h"
#include "atlas/coverage.h"
#include "atlas/half_edges.h"

namespace tuft::atlas {
namespace {

double signed_area(const Atlas& atlas, std::size_t t) {
    const Vec2 a = Vec2(atlas.corner_uvs[3 * t + 1]) - Vec2(atlas.corner_uvs[3 * t]);
    const Vec2 b = Vec2(atlas.corner_uvs[3 * t + 2]) - Vec2(atlas.corner_uvs[3 * t]);
    return 0.5 * (a.x * b.y - a.y * b.x);
}

/// Turns over charts whose triangles are all mirrored; false when some are and some are not.
bool turn_mirrored(Atlas& atlas, const std::vector<std::vector<std::uint32_t>>& charts) {
    for (const auto& chart : charts) {
        std::size_t mirrored = 0;
        Vec2f lo(1e30f), hi(-1e30f);
        for (const std::uint32_t t : chart) {
            mirrored += signed_area(atlas, t) < 0;
            for (std::size_t c = 3 * std::size_t{t}; c < 3 * std::size_t{t} + 3; ++c) {
                lo = glm::min(lo, atlas.corner_uvs[c]);
                hi = glm::max(hi, atlas.corner_uvs[c]);
            }
        }
        if (mirrored == 0) continue;
        if (mirrored < chart.size()) return false;
        for (const std::uint32_t t : chart)
            for (std::size_t c = 3 * std::size_t{t}; c < 3 * std::size_t{t} + 3; ++c)
                atlas.corner_uvs[c].x = std::clamp(lo.x + hi.x - atlas.corner_uvs[c].x, 0.f, 1.f);
    }
    return true;
}

}  // namespace

FileUvs read_file_uvs(const mesh::TriangleMesh& mesh, const UnwrapOptions& options) {
    FileUvs found;
    Atlas& atlas = found.atlas;
    const std::size_t n = mesh.n_triangles();
    const auto fault = [&](std::string what) {
        found.fault = std::move(what);
        found.atlas = {};
        return found;
    };
    if (mesh.corner_uvs.size() != 3 * n) return fault("there are none");
    constexpr float kBeyond = 1e-6f;  // what writers with six digits round past the edge
    atlas.corner_uvs = mesh.corner_uvs;
    for (Vec2f& uv : atlas.corner_uvs) {
        if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return fault("some are not finite");
        if (std::min(uv.x, uv.y) < -kBeyond || std::max(uv.x, uv.y) > 1 + kBeyond)
            return fault("some lie outside [0, 1]");
        uv = glm::clamp(uv, Vec2f(0), Vec2f(1));
    }
    double area_uv = 0;
    std::size_t roomless = 0;
    for (std::size_t t = 0; t < n; ++t) {
        const double area = signed_area(atlas, t);
        roomless += area == 0;
        area_uv += std::abs(area);
    }
    if (roomless > 0) return fault(std::to_string(roomless) + " triangles have no room in them");

    std::vector<std::uint32_t> glued = twin_half_edges(mesh);
    const std::vector<std::uint8_t> seam = uv_seams(glued, atlas.corner_uvs);
    for (std::size_t h = 0; h < glued.size(); ++h)
        if (seam[h]) glued[h] = kNone;
    const auto charts = connected_charts(glued);
    atlas.triangle_chart.resize(n);
    atlas.n_charts = static_cast<std::uint32_t>(charts.size());
    for (std::uint32_t c = 0; c < charts.size(); ++c)
        for (const std::uint32_t t : charts[c]) atlas.triangle_chart[t] = c;
    if (!turn_mirrored(atlas, charts)) return fault("some triangles are flipped");

    const double side = std::sqrt(mesh::surface_area(mesh) / area_uv);  // metres along the page
    if (options.size > 0) {
        atlas.size = options.size;
    } else {
        const double size = std::ceil(side / options.texel_size);
        if (size > options.max_size)
            return fault("a texel of " + std::to_string(options.texel_size * 1e3) +
                         " mm needs an atlas of " +
                         std::to_string(static_cast<long long>(std::min(size, 1e15))) +
                         " texels with them, more than the " + std::to_string(options.max_size) +
                         " allowed");
        atlas.size = std::max(1u, static_cast<std::uint32_t>(size));
    }
    atlas.texel_size = side / atlas.size;
    atlas.gutter = options.gutter;
    atlas.from_file = true;

    const Coverage coverage = cover(atlas.corner_uvs, {}, atlas.size);
    if (coverage.twice > 0)
        return fault("they overlap in " + std::to_string(coverage.twice) + " texels");
    const int gap = smallest_gap(seam, atlas.corner_uvs, atlas.triangle_chart, atlas.size);
    const int least = std::min<int>(options.uvs == UvPolicy::keep ? 1 : 2, int(options.gutter));
    if (gap < least)
        return fault("charts are less than " + std::to_string(least) +
                     " texels apart at a size of " + std::to_string(atlas.size));
    return found;
}

}  // namespace tuft::atlas
