#include "atlas/flatten/flatten.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "atlas/flatten/reference.h"

namespace tuft::atlas {
namespace {

// The height, over its longest edge, that a triangle is given at least which is a chart of its own.
constexpr double kMinHeightAlone = 1.0 / 64;
// Normals further apart than this make a chart that is not plane.
constexpr double kPlaneCos = 1 - 1e-10;

bool all_positive(const ChartMesh& chart, const std::vector<Vec2>& uv) {
    return std::all_of(chart.faces.begin(), chart.faces.end(), [&](const auto& f) { return signed_area(f, uv) > 0; });
}

bool all_finite(const std::vector<Vec2>& uv) {
    return std::all_of(uv.begin(), uv.end(), [](const Vec2& p) { return std::isfinite(p.x) && std::isfinite(p.y); });
}

/// UVs of a plane chart, seen from its normal; empty when it is not plane.
std::vector<Vec2> project_plane(const ChartMesh& chart, bool only_if_plane) {
    Vec3 sum(0);
    std::vector<Vec3> normal(chart.faces.size());
    for (std::size_t t = 0; t < normal.size(); ++t) {
        const auto& f = chart.faces[t];
        normal[t] =
            glm::cross(chart.position[f[1]] - chart.position[f[0]], chart.position[f[2]] - chart.position[f[0]]);
        sum += normal[t];
    }
    const double length = glm::length(sum);
    if (!(length > 0)) return {};
    const Vec3 n = sum / length;
    if (only_if_plane)
        for (const Vec3& m : normal)
            if (!(glm::dot(m, n) > kPlaneCos * glm::length(m))) return {};
    const Frame frame = make_frame(Vec3(0), n);
    std::vector<Vec2> uv(chart.n_vertices());
    for (std::size_t v = 0; v < uv.size(); ++v)
        uv[v] = {glm::dot(chart.position[v], frame.t), glm::dot(chart.position[v], frame.b)};
    return uv;
}

}  // namespace

bool untangle(const ChartMesh& chart, std::vector<Vec2>& uv) {
    const std::size_t n = chart.n_vertices();
    std::vector<std::uint32_t> start(n + 1, 0), around(3 * chart.faces.size());
    for (const auto& f : chart.faces)
        for (const std::uint32_t v : f) ++start[v + 1];
    for (std::size_t v = 0; v < n; ++v) start[v + 1] += start[v];
    std::vector<std::uint32_t> fill(start.begin(), start.end() - 1);
    for (std::size_t t = 0; t < chart.faces.size(); ++t)
        for (const std::uint32_t v : chart.faces[t]) around[fill[v]++] = static_cast<std::uint32_t>(t);

    std::vector<double> area(chart.faces.size());
    for (std::size_t t = 0; t < area.size(); ++t) area[t] = reference_triangle(chart, t).area;
    // The worst triangle around a vertex, its area over the area it should have.
    const auto worst = [&](std::uint32_t v) {
        double least = 1e300;
        for (std::uint32_t i = start[v]; i < start[v + 1]; ++i)
            least = std::min(least, signed_area(chart.faces[around[i]], uv) / area[around[i]]);
        return least;
    };
    constexpr double kEnough = 0.05;
    for (int sweep = 0; sweep < 20; ++sweep) {
        bool bad = false;
        for (const auto& f : chart.faces) {
            if (signed_area(f, uv) > 0) continue;
            bad = true;
            for (const std::uint32_t v : f) {
                double size = 0;
                for (std::uint32_t i = start[v]; i < start[v + 1]; ++i)
                    for (const std::uint32_t w : chart.faces[around[i]])
                        size = std::max(size, glm::length(uv[w] - uv[v]));
                double best = worst(v);
                for (double step = 0.5 * size; step > 1e-6 * size && best < kEnough;) {
                    const Vec2 here = uv[v];
                    Vec2 better = here;
                    for (int d = 0; d < 8; ++d) {
                        const double angle = d * 0.78539816339744831;
                        uv[v] = here + step * Vec2(std::cos(angle), std::sin(angle));
                        const double w = worst(v);
                        if (w > best) {
                            best = w;
                            better = uv[v];
                        }
                    }
                    uv[v] = better;
                    if (better == here) step *= 0.5;
                }
            }
        }
        if (!bad) return true;
    }
    return all_positive(chart, uv);
}

void scale_to_area(const ChartMesh& chart, std::vector<Vec2>& uv) {
    double area = 0;
    for (const auto& f : chart.faces) area += signed_area(f, uv);
    if (!(std::abs(area) > 0) || !(chart.area > 0)) return;
    const double scale = std::sqrt(chart.area / std::abs(area));
    for (Vec2& p : uv) p *= scale;
}

std::vector<Vec2> flatten(const ChartMesh& chart, const ArapOptions& options) {
    if (!chart.disk) return {};
    if (chart.faces.size() == 1) {
        const Reference r = reference_triangle(chart, 0, kMinHeightAlone);
        std::vector<Vec2> uv(3);
        for (int k = 0; k < 3; ++k) uv[chart.faces[0][k]] = r.corner[k];
        return uv;
    }
    std::vector<Vec2> uv = project_plane(chart, true);
    if (!uv.empty() && all_positive(chart, uv)) return uv;
    uv.clear();
    // Where the projection does not shrink much it is as good a start as any.
    constexpr double kGoodStart = 0.15;
    std::vector<std::vector<Vec2>> starts{project_plane(chart, false)};
    if (starts[0].empty() || arap_energy(chart, starts[0]) > kGoodStart)
        starts.emplace(starts.begin());
    else
        starts.emplace_back();
    for (std::vector<Vec2>& start : starts) {
        if (start.empty())
            if (auto conformal = lscm(chart)) start = std::move(*conformal);
        if (start.empty()) continue;
        arap(chart, start, options);
        if (!all_finite(start)) continue;
        uv = std::move(start);
        if (all_positive(chart, uv)) break;
    }
    if (uv.empty()) return {};
    if (!all_positive(chart, uv)) untangle(chart, uv);
    scale_to_area(chart, uv);
    return uv;
}

}  // namespace tuft::atlas
