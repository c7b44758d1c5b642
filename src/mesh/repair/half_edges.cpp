#include "mesh/repair/half_edges.h"

#include <algorithm>
#include <cmath>

#include "mesh/repair/edge_groups.h"

namespace tuft::mesh {
namespace {

/// One triangle at an edge: the direction in which it leaves the edge, its normal, and whether
/// it runs along the edge in the direction of the first one.
struct Wing {
    std::uint32_t half_edge;
    Vec3 away;    ///< unit, in the triangle, normal to the edge; zero without an area
    Vec3 normal;  ///< unit
    bool forward;
};

Wing make_wing(const RawMesh& mesh, std::uint32_t h, std::uint32_t reference_start) {
    const Vec3 a(mesh.positions[mesh.start(h)]), b(mesh.positions[mesh.end(h)]);
    const Vec3 c(mesh.positions[mesh.end(next_half(h))]);
    const Vec3 normal = glm::cross(b - a, c - a);
    const Vec3 away = glm::cross(normal, b - a);
    const double ln = glm::length(normal), la = glm::length(away);
    return {h, la > 0 ? away / la : Vec3(0), ln > 0 ? normal / ln : Vec3(0), mesh.start(h) == reference_start};
}

/// How well two wings continue each other: 1 flat, -1 folded back; convex edges win ties, so
/// that solids that touch in an edge come apart.
double continuation(const Wing& a, const Wing& b, bool trust_direction) {
    const bool agree = a.forward != b.forward;
    double score = -glm::dot(a.away, b.away);
    if (trust_direction && !agree) score -= 4;
    if (agree && glm::dot(a.normal, b.away) < -1e-6) score += 0.01;
    return score;
}

void pair(RawMesh& mesh, std::uint32_t g, std::uint32_t h) {
    mesh.opposite[g] = h;
    mesh.opposite[h] = g;
}

void pair_best(RawMesh& mesh, std::span<const std::uint32_t> half_edges, bool trust_direction) {
    // More triangles than this at one edge are not a surface; they all get borders.
    constexpr std::size_t kMaxWings = 64;
    if (half_edges.size() > kMaxWings) return;
    std::vector<Wing> wings;
    for (const std::uint32_t h : half_edges) wings.push_back(make_wing(mesh, h, mesh.start(half_edges[0])));
    struct Candidate {
        double score;
        std::size_t i, j;
    };
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < wings.size(); ++i)
        for (std::size_t j = i + 1; j < wings.size(); ++j) {
            const double score = continuation(wings[i], wings[j], trust_direction);
            if (score > -1.5) candidates.push_back({score, i, j});
        }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
    std::vector<bool> taken(wings.size(), false);
    for (const Candidate& c : candidates) {
        if (taken[c.i] || taken[c.j]) continue;
        taken[c.i] = taken[c.j] = true;
        pair(mesh, wings[c.i].half_edge, wings[c.j].half_edge);
    }
}

/// Notes the triangles at one edge that repeat an earlier one. Triangles with the same vertices
/// meet at each of their edges with the same third vertex, so every edge gives the same.
class DuplicateFinder {
  public:
    void look(const RawMesh& mesh, std::span<const std::uint32_t> half_edges) {
        thirds_.clear();
        for (const std::uint32_t h : half_edges) thirds_.emplace_back(mesh.end(next_half(h)), h / 3);
        std::sort(thirds_.begin(), thirds_.end());
        for (std::size_t i = 1; i < thirds_.size(); ++i) {
            if (thirds_[i].first != thirds_[i - 1].first) continue;
            keep.resize(mesh.triangles.size(), true);
            if (keep[thirds_[i].second]) ++count;
            keep[thirds_[i].second] = false;
        }
    }

    std::vector<bool> keep;  ///< empty as long as there is no duplicate
    std::size_t count = 0;

  private:
    std::vector<std::pair<std::uint32_t, std::uint32_t>> thirds_;  // third vertex, triangle
};

}  // namespace

Shape shape_of(const std::array<Vec3, 3>& p) {
    Shape s;
    for (int k = 0; k < 3; ++k) {
        const double length = glm::distance(p[k], p[(k + 1) % 3]);
        if (length > s.longest) {
            s.longest = length;
            s.longest_side = k;
        }
    }
    if (s.longest > 0) s.height = glm::length(glm::cross(p[1] - p[0], p[2] - p[0])) / s.longest;
    return s;
}

std::array<Vec3, 3> points_of(const RawMesh& mesh, std::size_t triangle) {
    const auto& v = mesh.triangles[triangle];
    return {Vec3(mesh.positions[v[0]]), Vec3(mesh.positions[v[1]]), Vec3(mesh.positions[v[2]])};
}

bool is_flat(const RawMesh& mesh, std::size_t triangle) {
    const Shape s = shape_of(points_of(mesh, triangle));
    return s.height <= kFlat * s.longest;
}

void keep_triangles(RawMesh& mesh, const std::vector<bool>& keep) {
    std::size_t out = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (!keep[t]) continue;
        mesh.triangles[out] = mesh.triangles[t];
        if (!mesh.groups.empty()) mesh.groups[out] = mesh.groups[t];
        for (std::size_t k = 0; k < 3 && !mesh.uvs.empty(); ++k) mesh.uvs[3 * out + k] = mesh.uvs[3 * t + k];
        for (std::size_t k = 0; k < 3 && !mesh.normals.empty(); ++k)
            mesh.normals[3 * out + k] = mesh.normals[3 * t + k];
        ++out;
    }
    mesh.triangles.resize(out);
    if (!mesh.groups.empty()) mesh.groups.resize(out);
    if (!mesh.uvs.empty()) mesh.uvs.resize(3 * out);
    if (!mesh.normals.empty()) mesh.normals.resize(3 * out);
    mesh.opposite.clear();
}

PairingReport pair_half_edges(RawMesh& mesh) {
    PairingReport report;
    std::vector<std::vector<std::uint32_t>> crowded;
    std::size_t agreeing = 0, disagreeing = 0;
    DuplicateFinder duplicates;
    mesh.opposite.assign(3 * mesh.triangles.size(), kNone);
    for_each_edge(mesh, [&](std::span<const std::uint32_t> group) {
        if (group.size() == 2) {
            pair(mesh, group[0], group[1]);
            ++(mesh.start(group[0]) != mesh.start(group[1]) ? agreeing : disagreeing);
        } else if (group.size() > 2) {
            crowded.emplace_back(group.begin(), group.end());
        }
        if (group.size() > 1) duplicates.look(mesh, group);
    });
    if (duplicates.count) {
        keep_triangles(mesh, duplicates.keep);
        report = pair_half_edges(mesh);
        report.duplicates_dropped = duplicates.count;
        return report;
    }
    report.needs_settling = !crowded.empty();
    const bool trust_direction = 20 * disagreeing < agreeing;
    for (std::vector<std::uint32_t>& group : crowded) {
        // Triangles without an area have no say where others meet.
        std::vector<std::uint32_t> solid;
        for (const std::uint32_t h : group)
            if (!is_flat(mesh, h / 3)) solid.push_back(h);
        if (solid.size() >= 2) group = std::move(solid);
        if (group.size() > 2) {
            mark_opened(mesh, group[0]);
            ++report.edges_split;
        }
        pair_best(mesh, group, trust_direction && group.size() != 2);
    }
    return report;
}

void mark_opened(RawMesh& mesh, std::uint32_t h) {
    mesh.at_split_edge.resize(mesh.positions.size(), false);
    mesh.at_split_edge[mesh.start(h)] = true;
    mesh.at_split_edge[mesh.end(h)] = true;
}

std::size_t split_vertices(RawMesh& mesh) {
    const std::size_t n_corners = 3 * mesh.triangles.size(), n_before = mesh.positions.size();
    std::vector<bool> done(n_corners, false), used(n_before, false), counted(n_before, false);
    std::size_t split = 0;
    for (std::uint32_t c = 0; c < n_corners; ++c) {
        if (done[c]) continue;
        // Back to the border, if the fan has one; then once through.
        std::uint32_t first = c;
        while (mesh.opposite[first] != kNone) {
            first = next_half(mesh.opposite[first]);
            if (first == c) break;
        }
        const std::uint32_t old_vertex = mesh.start(c);
        std::uint32_t vertex = old_vertex;
        if (used[old_vertex]) {
            vertex = static_cast<std::uint32_t>(mesh.positions.size());
            mesh.positions.push_back(mesh.positions[old_vertex]);
            if (!mesh.colours.empty()) mesh.colours.push_back(mesh.colours[old_vertex]);
            const bool expected = old_vertex < mesh.at_split_edge.size() && mesh.at_split_edge[old_vertex];
            if (!expected && !counted[old_vertex]) ++split;
            counted[old_vertex] = true;
        }
        used[old_vertex] = true;
        for (std::uint32_t at = first; at != kNone && !done[at];) {
            done[at] = true;
            mesh.triangles[at / 3][at % 3] = vertex;
            at = mesh.opposite[prev_half(at)];
        }
    }
    return split;
}

void settle(RawMesh& mesh) {
    constexpr int kRounds = 8;
    for (int round = 0;; ++round) {
        bool changed = false;
        std::vector<std::uint32_t> loose;  // triangles to set apart when nothing else helps
        for_each_edge(mesh, [&](std::span<const std::uint32_t> group) {
            const bool sound = group.size() == 1 || (group.size() == 2 && mesh.start(group[0]) != mesh.start(group[1]));
            if (sound) {
                if (group.size() == 2) pair(mesh, group[0], group[1]);
                return;
            }
            changed = true;
            for (const std::uint32_t h : group) {
                if (mesh.opposite[h] != kNone) mesh.opposite[mesh.opposite[h]] = kNone;
                mesh.opposite[h] = kNone;
                if (round >= kRounds && h != group[0]) loose.push_back(h / 3);
            }
        });
        if (!changed) return;
        for (const std::uint32_t t : loose)
            for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
                if (mesh.opposite[h] != kNone) mesh.opposite[mesh.opposite[h]] = kNone;
                mesh.opposite[h] = kNone;
            }
        split_vertices(mesh);
    }
}

}  // namespace tuft::mesh
