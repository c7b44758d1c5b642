#include "mesh/repair/decimate.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "core/error.h"

namespace tuft::mesh {
namespace {

constexpr int kRounds = 6;  // of collapses in which further parts may go

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

/// Which connected part a vertex is in, by the smallest of its vertices.
std::vector<std::uint32_t> parts_of(const Wedges& wedges, std::size_t n_vertices) {
    std::vector<std::uint32_t> parent(n_vertices);
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (std::size_t c = 0; c < wedges.corners.size(); ++c) {
        const std::uint32_t a = root(wedges.vertex[wedges.corners[c]]),
                            b = root(wedges.vertex[wedges.corners[c - c % 3]]);
        parent[std::max(a, b)] = std::min(a, b);
    }
    for (std::uint32_t v = 0; v < n_vertices; ++v) parent[v] = root(v);
    return parent;
}

/// Collapses edges of some triangles of a mesh.
class Simplifier {
  public:
    Simplifier(const TriangleMesh& mesh, const Wedges& wedges) : wedges_(wedges) {
        positions_.reserve(wedges.vertex.size());
        for (const std::uint32_t vertex : wedges.vertex) positions_.push_back(mesh.positions[vertex]);
    }

    /// The corners that are left: of at most `n_triangles`, or where the next collapse moves the surface by more than
    /// `error` metres.
    std::vector<std::uint32_t> operator()(const std::vector<std::uint32_t>& corners, std::size_t n_triangles,
                                          double error) const {
        std::vector<std::uint32_t> left = collapse(corners, positions_, n_triangles, error);
        drop_fins(wedges_, left);
        return left;
    }

    /// The same of a small part, in the time of its own vertices: the library looks at all that it is given.
    std::vector<std::uint32_t> of_part(const std::vector<std::uint32_t>& corners, std::size_t n_triangles,
                                       double error) const {
        std::vector<std::uint32_t> used = corners;
        std::sort(used.begin(), used.end());
        used.erase(std::unique(used.begin(), used.end()), used.end());
        std::vector<Vec3f> positions;
        for (const std::uint32_t wedge : used) positions.push_back(positions_[wedge]);
        std::vector<std::uint32_t> own;
        for (const std::uint32_t wedge : corners)
            own.push_back(static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), wedge) - used.begin()));
        std::vector<std::uint32_t> left = collapse(own, positions, n_triangles, error);
        for (std::uint32_t& corner : left) corner = used[corner];
        drop_fins(wedges_, left);
        return left;
    }

    Box box_of(const std::vector<std::uint32_t>& corners) const {
        Box box;
        for (const std::uint32_t corner : corners) box.add(Vec3(positions_[corner]));
        return box;
    }

  private:
    static std::vector<std::uint32_t> collapse(const std::vector<std::uint32_t>& corners,
                                               const std::vector<Vec3f>& positions, std::size_t n_triangles,
                                               double error) {
        const float scale = meshopt_simplifyScale(&positions[0].x, positions.size(), sizeof(Vec3f));
        const float most = error > 0 ? static_cast<float>(error) / scale : FLT_MAX;
        std::vector<std::uint32_t> left(corners.size());
        left.resize(meshopt_simplify(left.data(), corners.data(), corners.size(), &positions[0].x, positions.size(),
                                     sizeof(Vec3f), 3 * std::min(n_triangles, corners.size() / 3), most, 0, nullptr));
        return left;
    }

    const Wedges& wedges_;
    std::vector<Vec3f> positions_;  // of wedges
};

/// A connected part of which nothing is left when it is collapsed with the others.
struct LostPart {
    std::uint32_t part = 0;  ///< by the smallest of its vertices
    double size = 0;         ///< metres, of the box round it
    std::vector<std::uint32_t> corners;
    std::map<int, std::vector<std::uint32_t>> reduced;  ///< by level, see `reduced_to`
};

/// The parts of which nothing is in `left` nor in `known` though they are larger than `least`.
std::vector<LostPart> lost_parts(const Wedges& wedges, const Simplifier& simplify,
                                 const std::vector<std::uint32_t>& part, const std::vector<std::uint32_t>& left,
                                 const std::vector<LostPart>& known, double least) {
    std::vector<std::uint8_t> there(part.size(), 0);
    for (const std::uint32_t corner : left) there[part[wedges.vertex[corner]]] = 1;
    for (const LostPart& one : known) there[one.part] = 1;
    std::map<std::uint32_t, std::vector<std::uint32_t>> lost;
    for (const std::uint32_t corner : wedges.corners)
        if (const std::uint32_t p = part[wedges.vertex[corner]]; !there[p]) lost[p].push_back(corner);
    std::vector<LostPart> parts;
    for (auto& [first, corners] : lost)
        if (const double size = simplify.box_of(corners).diagonal(); size > 2 * least)
            parts.push_back({first, size, std::move(corners)});
    return parts;
}

constexpr int kLevels = 3, kTries = 8;  // of errors, each a quarter of the one before

/// A part by itself, with fewer triangles where it has any then: a thin plate becomes two sides back to back when its
/// walls collapse, and these go as fins. `coarsest`: error of level 0, metres.
const std::vector<std::uint32_t>& reduced_to(int level, LostPart& part, const Simplifier& simplify, double coarsest) {
    const auto [at, is_new] = part.reduced.try_emplace(level);
    if (!is_new) return at->second;
    double error = coarsest * std::pow(0.25, level);
    for (int i = 0; i < kTries && at->second.empty(); ++i, error *= 0.25)
        at->second = simplify.of_part(part.corners, 1, error);
    if (at->second.empty()) at->second = part.corners;
    return at->second;
}

/// What lost parts keep of at most `n_triangles` (0: of any number): all of them, as fine as that allows, else the
/// largest. `error`: metres, 0: as fits each part's size. Sorts the parts; empty ones keep nothing.
std::vector<std::vector<std::uint32_t>> kept_of(std::vector<LostPart>& parts, const Simplifier& simplify,
                                                std::size_t n_triangles, double error) {
    constexpr double kOfSize = 0.16;  // of a part: what may move of it at level 0 where no distance is given
    std::sort(parts.begin(), parts.end(),
              [](const LostPart& a, const LostPart& b) { return std::tie(b.size, a.part) < std::tie(a.size, b.part); });
    const auto coarsest = [&](const LostPart& part) { return error > 0 ? error : kOfSize * part.size; };
    // Two triangles are the least that a part can have: of very many only the largest are looked at.
    const std::size_t n = n_triangles > 0 ? std::min(parts.size(), n_triangles / 2 + 1) : parts.size();
    const std::size_t room = n_triangles > 0 ? 3 * n_triangles : static_cast<std::size_t>(-1);
    std::vector<std::vector<std::uint32_t>> kept(parts.size());
    int level = error > 0 ? 1 : kLevels - 1;
    for (; level > 0; --level) {
        std::size_t n_corners = 0;
        for (std::size_t i = 0; i < n && n_corners <= room; ++i)
            n_corners += reduced_to(level, parts[i], simplify, coarsest(parts[i])).size();
        if (n == parts.size() && n_corners <= room) break;
    }
    std::size_t n_corners = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const std::vector<std::uint32_t>& corners = reduced_to(level, parts[i], simplify, coarsest(parts[i]));
        if (corners.size() > room) continue;  // it alone
        if (n_corners + corners.size() > room) break;
        n_corners += corners.size();
        kept[i] = corners;
    }
    return kept;
}

}  // namespace

PolygonSoup decimate(const TriangleMesh& mesh, const DecimateOptions& options) {
    if (options.n_triangles == 0 && !(options.error > 0))
        throw Error("a number of triangles or a distance must say how far to decimate");
    const Wedges wedges = wedges_of(mesh);
    const Simplifier simplify(mesh, wedges);
    const std::size_t most = std::min(options.n_triangles, mesh.n_triangles());
    const std::vector<std::uint32_t> part = parts_of(wedges, mesh.n_vertices());
    std::vector<std::uint32_t> corners = simplify(wedges.corners, most, options.error), back;
    // What lost parts take, at most half of the triangles, is taken from the others, of which more may go then: all
    // that ever went are looked at again.
    std::vector<LostPart> lost;
    for (int round = 0; round < kRounds; ++round) {
        std::vector<LostPart> more = lost_parts(wedges, simplify, part, corners, lost, options.error);
        if (more.empty()) break;
        std::move(more.begin(), more.end(), std::back_inserter(lost));
        back.clear();
        std::vector<std::uint8_t> is_kept(mesh.n_vertices(), 0);
        const std::vector<std::vector<std::uint32_t>> kept =
            kept_of(lost, simplify, most > 0 ? std::max<std::size_t>(most / 2, 1) : 0, options.error);
        for (std::size_t i = 0; i < kept.size(); ++i) {
            is_kept[lost[i].part] = !kept[i].empty();
            back.insert(back.end(), kept[i].begin(), kept[i].end());
        }
        const auto goes_by_itself = [&](std::uint32_t corner) { return is_kept[part[wedges.vertex[corner]]] != 0; };
        std::erase_if(corners, goes_by_itself);
        if (most == 0 || corners.size() + back.size() <= 3 * most) continue;
        corners = wedges.corners;
        std::erase_if(corners, goes_by_itself);
        corners = simplify(corners, most - back.size() / 3, options.error);
    }
    corners.insert(corners.end(), back.begin(), back.end());
    if (corners.empty()) throw Error("nothing is left of the mesh at this distance");
    return soup_of(mesh, wedges, corners);
}

}  // namespace tuft::mesh
