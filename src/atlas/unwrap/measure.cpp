#include <algorithm>
#include <chrono>
#include <cmath>

#include "atlas/atlas.h"
#include "atlas/pack/coverage.h"
#include "atlas/pack/raster.h"
#include "atlas/seams/half_edges.h"
#include "core/system/parallel.h"

namespace tuft::atlas {
namespace {

/// Sums over triangles, made per block and added in block order.
struct Sums {
    double area3 = 0, area_uv = 0, square = 0, angle = 0, ratio = 0, measured = 0, largest = 0;
    std::size_t flips = 0, zero_area = 0;

    void add(const Sums& s) {
        area3 += s.area3;
        area_uv += s.area_uv;
        square += s.square;
        angle += s.angle;
        ratio += s.ratio;
        measured += s.measured;
        largest = std::max(largest, s.largest);
        flips += s.flips;
        zero_area += s.zero_area;
    }
};

constexpr std::size_t kBlock = 8192;

template <class Body>
Sums sum_triangles(std::size_t n, Body&& body) {
    std::vector<Sums> parts((n + kBlock - 1) / kBlock);
    parallel_for(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b)
            for (std::size_t t = b * kBlock; t < std::min(n, (b + 1) * kBlock); ++t) body(t, parts[b]);
    });
    Sums all;
    for (const Sums& s : parts) all.add(s);
    return all;
}

struct UvTriangle {
    double area3 = 0, area_uv = 0;  // m², UV units²
    Vec3 e1{0}, e2{0};
    Vec2 d1{0}, d2{0};
};

UvTriangle uv_triangle(const mesh::TriangleMesh& mesh, const Atlas& atlas, std::size_t t) {
    UvTriangle u;
    u.e1 = mesh.position(t, 1) - mesh.position(t, 0);
    u.e2 = mesh.position(t, 2) - mesh.position(t, 0);
    u.d1 = Vec2(atlas.corner_uvs[3 * t + 1]) - Vec2(atlas.corner_uvs[3 * t]);
    u.d2 = Vec2(atlas.corner_uvs[3 * t + 2]) - Vec2(atlas.corner_uvs[3 * t]);
    u.area3 = 0.5 * glm::length(glm::cross(u.e1, u.e2));
    u.area_uv = 0.5 * (u.d1.x * u.d2.y - u.d1.y * u.d2.x);
    return u;
}

void measure_stretch(const mesh::TriangleMesh& mesh, const Atlas& atlas, AtlasReport& report) {
    const std::size_t n = mesh.n_triangles();
    const double diagonal = mesh.bounds.diagonal();
    const Sums sizes = sum_triangles(n, [&](std::size_t t, Sums& s) {
        const UvTriangle u = uv_triangle(mesh, atlas, t);
        if (!std::isfinite(u.area_uv) || u.area_uv == 0)
            ++s.zero_area;
        else if (u.area_uv < 0)
            ++s.flips;
        s.area3 += u.area3;
        if (std::isfinite(u.area_uv)) s.area_uv += std::abs(u.area_uv);
    });
    report.zero_area_triangles = sizes.zero_area;
    report.flips = sizes.flips;
    if (!(sizes.area_uv > 0) || !(sizes.area3 > 0)) return;
    const double scale = std::sqrt(sizes.area_uv / sizes.area3);  // UV units per metre
    const Sums all = sum_triangles(n, [&](std::size_t t, Sums& s) {
        const UvTriangle u = uv_triangle(mesh, atlas, t);
        // Slivers without a measurable area, on the surface or in the atlas, say nothing.
        if (u.area3 <= 1e-12 * diagonal * diagonal) return;
        if (!std::isfinite(u.area_uv) || !(std::abs(u.area_uv) > 1e-9 * u.area3 / sizes.area3)) return;
        const Vec2 d1 = u.d1 / scale, d2 = u.d2 / scale;
        const double det = d1.x * d2.y - d1.y * d2.x;
        const Vec3 su = (u.e1 * d2.y - u.e2 * d1.y) / det, sv = (u.e2 * d1.x - u.e1 * d2.x) / det;
        const double a = glm::dot(su, su), b = glm::dot(su, sv), c = glm::dot(sv, sv);
        const double s1 = std::sqrt(0.5 * (a + c + std::sqrt((a - c) * (a - c) + 4 * b * b)));
        const double s2 = u.area3 / (0.5 * std::abs(det)) / s1;
        const double ratio = s1 * s2;
        s.measured += u.area3;
        s.square += u.area3 * 0.5 * (a + c);
        s.largest = std::max(s.largest, s1);
        s.angle += u.area3 * std::min(100.0, s1 / s2);
        s.ratio += u.area3 * std::min(1e4, std::max(ratio, 1 / ratio));
    });
    if (!(all.measured > 0)) return;
    report.l2_stretch = std::sqrt(all.square / all.measured);
    report.linf_stretch = all.largest;
    report.angle_distortion = all.angle / all.measured;
    report.area_distortion = all.ratio / all.measured;
}

}  // namespace

AtlasReport measure(const mesh::TriangleMesh& mesh, const Atlas& atlas) {
    const auto start = std::chrono::steady_clock::now();
    AtlasReport report;
    report.charts = atlas.n_charts;
    measure_stretch(mesh, atlas, report);

    const std::vector<std::uint32_t> twin = twin_half_edges(mesh);
    const std::vector<std::uint8_t> seam = uv_seams(twin, atlas.corner_uvs);
    double length = 0;
    for (std::uint32_t h = 0; h < twin.size(); ++h)
        if (seam[h] && twin[h] != kNone && twin[h] > h)
            length += glm::length(mesh.position(h / 3, static_cast<int>(h % 3)) -
                                  mesh.position(h / 3, static_cast<int>(next_half(h) % 3)));
    const double diagonal = mesh.bounds.diagonal();
    report.seam_length = diagonal > 0 ? length / diagonal : 0;

    const Coverage coverage = cover(atlas.corner_uvs, {}, atlas.size);
    report.overlapping_texels = coverage.twice;
    const double page = atlas.page_size();
    const double texels = atlas.pages * page * page;
    report.utilisation = texels > 0 ? static_cast<double>(coverage.covered) / texels : 0;
    report.smallest_gap = report.overlapping_texels > 0 ? 0 : smallest_gap(seam, atlas);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    report.seconds = {{"measure", time.count()}};
    return report;
}

}  // namespace tuft::atlas
