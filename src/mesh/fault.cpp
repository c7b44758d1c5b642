#include "mesh/fault.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/bounds.h"

namespace tuft::mesh {
namespace {

template <class V>
bool all_finite(const std::vector<V>& values) {
    for (const V& v : values)
        for (int i = 0; i < V::length(); ++i)
            if (!std::isfinite(v[i])) return false;
    return true;
}

bool all_below(const std::vector<std::uint32_t>& values, std::size_t limit) {
    return std::all_of(values.begin(), values.end(), [&](std::uint32_t v) { return v < limit; });
}

}  // namespace

Message fault_of(const TriangleMesh& m) {
    const std::size_t n = m.n_triangles();
    const auto none_or = [](const auto& values, std::size_t size) { return values.empty() || values.size() == size; };
    if (n == 0 || m.n_vertices() == 0 || m.corner_normals.size() != 3 * n || m.neighbours.size() != 3 * n ||
        !none_or(m.corner_uvs, 3 * n) || !none_or(m.vertex_colours, m.n_vertices()) || !none_or(m.triangle_groups, n) ||
        !none_or(m.triangle_parts, n))
        return "a part of the model is missing";
    for (const auto& triangle : m.triangles)
        for (const std::uint32_t v : triangle)
            if (v >= m.n_vertices()) return "a triangle has a vertex that does not exist";
    for (const std::uint32_t t : m.neighbours)
        if (t != kNone && t >= n) return "a triangle has a neighbour that does not exist";
    if (!all_below(m.triangle_groups, m.group_names.size())) return "a triangle is in a group that does not exist";
    if (m.scene && !all_below(m.triangle_parts, m.scene->parts.size()))
        return "a triangle is in a part that does not exist";
    for (const Vec3f& p : m.positions)
        if (!within(Vec3(p))) return "the model has points that are no numbers or lie more than 10 km away";
    if (!(m.bounds.diagonal() >= kSmallestModel)) return "the model is smaller than a micrometre";
    if (!all_finite(m.corner_normals) || !all_finite(m.corner_uvs)) return "the model has numbers that are not finite";
    return {};
}

}  // namespace tuft::mesh
