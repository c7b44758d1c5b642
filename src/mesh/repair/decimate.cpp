#include "mesh/repair/decimate.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <span>
#include <tuple>
#include <vector>

#include "core/error.h"

namespace tuft::mesh {
namespace {

/// Triangles over wedges: a vertex in a group and with a UV.
struct Wedges {
    std::vector<std::uint32_t> corners;  ///< [3 n_triangles]
    std::vector<std::uint32_t> vertex;   ///< by wedge
    std::vector<std::uint32_t> group;    ///< by wedge, or empty
    std::vector<Vec2f> uv;               ///< by wedge, or empty
};

/// One wedge for each vertex, and more where a vertex has several groups or UVs; these are linked in a list.
Wedges wedges_of(const TriangleMesh& mesh) {
    const bool has_groups = !mesh.triangle_groups.empty(), has_uvs = !mesh.corner_uvs.empty();
    Wedges out;
    out.corners.resize(3 * mesh.n_triangles());
    std::vector<std::uint32_t> first(mesh.n_vertices(), kNone), next;
    const auto add = [&](std::uint32_t vertex, std::uint32_t group, const Vec2f& uv) {
        const auto wedge = static_cast<std::uint32_t>(out.vertex.size());
        out.vertex.push_back(vertex);
        if (has_groups) out.group.push_back(group);
        if (has_uvs) out.uv.push_back(uv);
        next.push_back(first[vertex]);
        return first[vertex] = wedge;
    };
    for (std::size_t c = 0; c < out.corners.size(); ++c) {
        const std::uint32_t vertex = mesh.triangles[c / 3][c % 3];
        const std::uint32_t group = has_groups ? mesh.triangle_groups[c / 3] : 0;
        const Vec2f uv = has_uvs ? mesh.corner_uvs[c] : Vec2f(0);
        std::uint32_t wedge = first[vertex];
        while (wedge != kNone && ((has_groups && out.group[wedge] != group) || (has_uvs && out.uv[wedge] != uv)))
            wedge = next[wedge];
        out.corners[c] = wedge == kNone ? add(vertex, group, uv) : wedge;
    }
    return out;
}

PolygonSoup soup_of(const TriangleMesh& mesh, const Wedges& wedges, std::span<const std::uint32_t> corners) {
    PolygonSoup soup;
    std::vector<std::uint32_t> point(mesh.n_vertices(), kNone);
    soup.polygon_start.push_back(0);
    for (std::size_t c = 0; c < corners.size(); ++c) {
        const std::uint32_t vertex = wedges.vertex[corners[c]];
        if (point[vertex] == kNone) {
            point[vertex] = static_cast<std::uint32_t>(soup.points.size());
            soup.points.emplace_back(mesh.positions[vertex]);
            if (!mesh.vertex_colours.empty()) soup.point_colours.push_back(mesh.vertex_colours[vertex]);
        }
        soup.corners.push_back(point[vertex]);
        if (!wedges.uv.empty()) soup.corner_uvs.push_back(wedges.uv[corners[c]]);
        if (c % 3 != 2) continue;
        soup.polygon_start.push_back(static_cast<std::uint32_t>(c + 1));
        if (!wedges.group.empty()) soup.polygon_groups.push_back(wedges.group[corners[c]]);
    }
    if (!soup.polygon_groups.empty()) soup.group_names = mesh.group_names;
    return soup;
}

/// Takes out fins: pairs of triangles on the same vertices, back to back, which collapses leave on closed surfaces.
void drop_fins(const Wedges& wedges, std::vector<std::uint32_t>& corners) {
    struct Side {
        std::array<std::uint32_t, 3> vertices;
        bool turned;
        std::size_t triangle;
    };
    std::vector<Side> sides;
    sides.reserve(corners.size() / 3);
    for (std::size_t t = 0; t < corners.size() / 3; ++t) {
        std::array<std::uint32_t, 3> v;
        for (std::size_t k = 0; k < 3; ++k) v[k] = wedges.vertex[corners[3 * t + k]];
        std::rotate(v.begin(), std::min_element(v.begin(), v.end()), v.end());
        const bool turned = v[1] > v[2];
        if (turned) std::swap(v[1], v[2]);
        sides.push_back({v, turned, t});
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.vertices, a.turned, a.triangle) < std::tie(b.vertices, b.turned, b.triangle);
    });
    std::vector<std::uint8_t> fin(sides.size(), 0);
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t turn = i, end = i;
        while (end < sides.size() && sides[end].vertices == sides[i].vertices) turn += !sides[end++].turned;
        for (std::size_t k = 0; k < std::min(turn - i, end - turn); ++k)
            fin[sides[i + k].triangle] = fin[sides[turn + k].triangle] = 1;
        i = end;
    }
    std::size_t kept = 0;
    for (std::size_t c = 0; c < corners.size(); ++c)
        if (!fin[c / 3]) corners[kept++] = corners[c];
    corners.resize(kept);
}

}  // namespace

PolygonSoup decimate(const TriangleMesh& mesh, const DecimateOptions& options) {
    if (options.n_triangles == 0 && !(options.error > 0))
        throw Error("a number of triangles or a distance must say how far to decimate");
    const Wedges wedges = wedges_of(mesh);
    std::vector<Vec3f> positions;
    positions.reserve(wedges.vertex.size());
    for (const std::uint32_t vertex : wedges.vertex) positions.push_back(mesh.positions[vertex]);
    const float scale = meshopt_simplifyScale(&positions[0].x, positions.size(), sizeof(Vec3f));
    const float error = options.error > 0 ? static_cast<float>(options.error) / scale : FLT_MAX;
    const std::size_t most = 3 * std::min(options.n_triangles, mesh.n_triangles());
    std::vector<std::uint32_t> corners(wedges.corners.size());
    const std::size_t left =
        meshopt_simplify(corners.data(), wedges.corners.data(), wedges.corners.size(), &positions[0].x,
                         positions.size(), sizeof(Vec3f), most, error, 0, nullptr);
    corners.resize(left);
    drop_fins(wedges, corners);
    if (corners.empty()) throw Error("nothing is left of the mesh at this distance");
    return soup_of(mesh, wedges, corners);
}

}  // namespace tuft::mesh
