#include "mesh/repair/exposure.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/geometry/bounds.h"

namespace tuft::mesh {
namespace {

constexpr double kNear = 1e-5;  // of the diagonal: float coordinates lie within a tenth of it

/// The fractional part of n times the generalised golden ratio's powers, an even sequence in three dimensions (Roberts
/// 2018, "The unreasonable effectiveness of quasirandom sequences"), and n / count.
struct EvenSequence {
    double a, b, c;
    explicit EvenSequence(int n)
        : a(part(n, 0.8191725133961645)), b(part(n, 0.6710436067037893)), c(part(n, 0.5497004779019703)) {}
    static double part(int n, double step) { return std::fmod(0.5 + n * step, 1.0); }
};

}  // namespace

ExposureProbe::ExposureProbe(const RawMesh& mesh) : mesh_(mesh), tree_(mesh.positions, mesh.triangles) {
    Box bounds;
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t v : triangle) bounds.add(Vec3(mesh.positions[v]));
    near_ = mesh.triangles.empty() ? 0 : kNear * bounds.diagonal();
}

bool ExposureProbe::is_ray_free(const Vec3& from, const Vec3& direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray{};
    const Vec3f o(from), d(direction);
    ray.org_x = o.x, ray.org_y = o.y, ray.org_z = o.z;
    ray.dir_x = d.x, ray.dir_y = d.y, ray.dir_z = d.z;
    ray.tnear = static_cast<float>(near_);
    ray.tfar = std::numeric_limits<float>::infinity();
    ray.mask = ~0u;
    rtcOccluded1(tree_.scene(), &context, &ray);
    return ray.tfar >= 0;  // Embree sets it to -inf where there is a hit
}

Exposure ExposureProbe::of(std::span<const std::uint32_t> faces, const std::vector<bool>& turned, int rays) const {
    std::vector<double> areas;  // running sums
    double area = 0;
    for (const std::uint32_t t : faces) {
        const std::array<Vec3, 3> p = points_of(mesh_, t);
        areas.push_back(area += 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0])));
    }
    Exposure seen;
    if (!(area > 0)) return seen;
    for (int i = 0; i < rays; ++i) {
        const EvenSequence even(i);
        const auto at = std::upper_bound(areas.begin(), areas.end(), (i + 0.5) / rays * area);
        const std::uint32_t t = faces[std::min(static_cast<std::size_t>(at - areas.begin()), faces.size() - 1)];
        const std::array<Vec3, 3> p = points_of(mesh_, t);
        const Vec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
        if (!(glm::length(across) > 0)) continue;
        const double s = std::sqrt(even.a);
        const Vec3 from = (1 - s) * p[0] + s * (1 - even.b) * p[1] + s * even.b * p[2];
        const Frame f = make_frame(Vec3(0), (turned[t] ? -1.0 : 1.0) * glm::normalize(across));
        // Malley's method: an even disk, lifted onto the hemisphere.
        const double radius = std::sqrt(even.c),
                     turn = 2 * std::numbers::pi * EvenSequence::part(i, 0.6180339887498949);
        const Vec3 flat = radius * (std::cos(turn) * f.t + std::sin(turn) * f.b);
        const Vec3 up = std::sqrt(std::max(0.0, 1 - even.c)) * f.n;
        if (is_ray_free(from, flat + up)) seen.front += 1.0 / rays;
        if (is_ray_free(from, flat - up)) seen.back += 1.0 / rays;
    }
    return seen;
}

}  // namespace tuft::mesh
