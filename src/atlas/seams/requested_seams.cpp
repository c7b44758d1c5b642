#include "atlas/seams/requested_seams.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tuft::atlas {
namespace {

Vec3 unit_normal_or_zero(const mesh::TriangleMesh& mesh, std::uint32_t t) {
    const Vec3 a = mesh.position(t, 0);
    const Vec3 n = glm::cross(mesh.position(t, 1) - a, mesh.position(t, 2) - a);
    const double length = glm::length(n);
    return length > 0 ? n / length : Vec3(0);
}

}  // namespace

void cut_requested_seams(const mesh::TriangleMesh& mesh, const RequestedSeams& seams, std::span<std::uint32_t> twin) {
    const bool groups = seams.groups && !mesh.triangle_groups.empty();
    const bool sharp = seams.sharp_angle > 0;
    if (seams.groups && !groups && !sharp) throw Error("the model has no face groups for seams to follow");
    if (!groups && !sharp) return;
    const double least_cos = std::cos(std::min(seams.sharp_angle, std::numbers::pi));
    for (std::uint32_t h = 0; h < twin.size(); ++h) {
        const std::uint32_t g = twin[h];
        if (g == kNone || g < h) continue;
        const std::uint32_t s = h / 3, t = g / 3;
        bool cut = groups && mesh.triangle_groups[s] != mesh.triangle_groups[t];
        if (!cut && sharp) cut = glm::dot(unit_normal_or_zero(mesh, s), unit_normal_or_zero(mesh, t)) < least_cos;
        if (cut) twin[h] = twin[g] = kNone;
    }
}

}  // namespace tuft::atlas
