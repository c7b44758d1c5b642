#include "writer/layout/feature_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/text/units.h"

namespace tuft::writer {
namespace {

constexpr double kSharpEdge = 30 * kDegree;
constexpr double kLeastOn = 0.5;     // cosine of the turn from edge to edge
constexpr double kBeside = 1e-3;     // of the reach: how far beside an edge its line lies
constexpr double kPreferEdge = 0.1;  // of the reach, by which a crease must be nearer

}  // namespace

/// Feature edges of one model.
namespace edges {

/// An edge that is a feature, as its first triangle has it: that lies to its left.
struct Edge {
    std::array<std::uint32_t, 2> ends;
    std::array<std::uint32_t, 2> triangles;  ///< to the left, to the right; kNone: a border
    LineKind kind;
    double angle;  ///< radians between the triangles
};

/// Which groups of its mesh a query has: parts of a model are hidden as wholes. Empty: all.
static std::vector<char> groups_of(const mesh::SurfaceQuery& query) {
    constexpr double kThere = 1e-6;  // of the diagonal
    const mesh::TriangleMesh& mesh = query.mesh();
    std::vector<char> known, there;
    for (std::uint32_t i = 0; i < mesh.triangle_groups.size(); ++i) {
        const std::size_t group = mesh.triangle_groups[i];
        if (group >= there.size()) there.resize(group + 1), known.resize(group + 1);
        if (std::exchange(known[group], 1)) continue;
        Vec3 middle(0);
        for (const std::uint32_t v : mesh.triangles[i]) middle += Vec3(mesh.positions[v]) / 3.0;
        there[group] = query.closest_point(middle, kThere * mesh.bounds.diagonal()).has_value();
    }
    return there;
}

static std::vector<Edge> feature_edges(const mesh::SurfaceQuery& query) {
    const mesh::TriangleMesh& mesh = query.mesh();
    const std::vector<char> groups = groups_of(query);
    const auto is_there = [&](std::uint32_t i) { return groups.empty() || groups[mesh.triangle_groups[i]]; };
    std::vector<Edge> edges;
    for (std::uint32_t i = 0; i < mesh.n_triangles(); ++i) {
        if (!is_there(i)) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t other = mesh.neighbours[3 * std::size_t{i} + k];
            const std::array ends{mesh.triangles[i][k], mesh.triangles[i][(k + 1) % 3]};
            if (other == kNone || !is_there(other)) {
                edges.push_back({ends, {i, kNone}, LineKind::border, 0});
                continue;
            }
            if (other < i) continue;
            const Vec3 n = mesh::face_normal(mesh, i), m = mesh::face_normal(mesh, other);
            const double angle = std::atan2(glm::length(glm::cross(n, m)), glm::dot(n, m));
            const bool between =
                !mesh.triangle_groups.empty() && mesh.triangle_groups[i] != mesh.triangle_groups[other];
            if (angle > kSharpEdge)
                edges.push_back({ends, {i, other}, LineKind::sharp_edge, angle});
            else if (between)
                edges.push_back({ends, {i, other}, LineKind::group_border, angle});
        }
    }
    return edges;
}

/// Feature edges by their ends.
class Walk {
  public:
    Walk(const mesh::TriangleMesh& mesh, std::vector<Edge> edges)
        : mesh_(mesh), edges_(std::move(edges)), used_(edges_.size(), 0) {
        for (std::size_t e = 0; e < edges_.size(); ++e)
            for (const std::uint32_t v : edges_[e].ends) at_.emplace(v, e);
    }

    bool empty() const { return edges_.empty(); }
    const Edge& edge(std::size_t e) const { return edges_[e]; }

    /// The nearest edge and its distance, metres.
    std::pair<std::size_t, double> nearest(const Vec3& p) const {
        std::size_t best = 0;
        double least2 = HUGE_VAL;
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            const Vec3 off = p - nearest_on(e, p);
            if (const double d2 = glm::dot(off, off); d2 < least2) least2 = d2, best = e;
        }
        return {best, std::sqrt(least2)};
    }

    /// The line through an edge, with the normals of the faces on the side of `p`.
    ModelPath line(std::size_t first, const Vec3& p, double beside) {
        std::ranges::fill(used_, 0);
        used_[first] = 1;
        const auto [a, b] = edges_[first].ends;
        std::vector<Step> steps = follow(a, {first, b});
        ModelPath path;
        path.closed = steps.back().to == a;
        std::vector<std::uint32_t> vertices{a};
        if (!path.closed) {
            std::vector<Step> back = follow(b, {first, a});
            vertices = {back.back().to};
            std::vector<Step> all;
            for (std::size_t i = back.size(); i-- > 1;) all.push_back({back[i].edge, back[i - 1].to});
            all.insert(all.end(), steps.begin(), steps.end());
            steps = std::move(all);
        }
        const int side = side_of(first, p);
        std::vector<Vec3> normals, inwards;
        for (const Step& step : steps) {
            const std::uint32_t from = vertices.back();
            vertices.push_back(step.to);
            const Edge& e = edges_[step.edge];
            const int own = e.ends[0] == from ? side : 1 - side;
            const std::uint32_t triangle = e.triangles[own] != kNone ? e.triangles[own] : e.triangles[1 - own];
            normals.push_back(mesh::face_normal(mesh_, triangle));
            inwards.push_back(inwards_of(step.edge, triangle));
        }
        if (path.closed) vertices.pop_back();
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const std::size_t after = std::min(i, steps.size() - 1);
            const std::size_t before = i > 0 ? i - 1 : path.closed ? steps.size() - 1 : after;
            path.normals.push_back(glm::normalize(normals[before] + normals[after]));
            path.points.push_back(point(vertices[i]) + beside * 0.5 * (inwards[before] + inwards[after]));
        }
        return path;
    }

  private:
    struct Step {
        std::size_t edge;
        std::uint32_t to;
    };

    /// From the edge `first`, which begins at `from`, on; ends at `from` where the line is closed.
    std::vector<Step> follow(std::uint32_t from, Step first) {
        std::vector<Step> line{first};
        std::uint32_t before = from;
        while (line.back().to != from) {
            const std::uint32_t v = line.back().to;
            const Vec3 along = glm::normalize(point(v) - point(before));
            double most = kLeastOn;
            std::size_t next = edges_.size();
            const auto [begin, end] = at_.equal_range(v);
            for (auto at = begin; at != end; ++at) {
                const Vec3 on = point(other(at->second, v)) - point(v);
                if (used_[at->second] || !(glm::length(on) > 0)) continue;
                const double turn = glm::dot(along, glm::normalize(on));
                if (turn > most || (turn == most && at->second < next)) most = turn, next = at->second;
            }
            if (next == edges_.size()) break;
            used_[next] = 1;
            before = v;
            line.push_back({next, other(next, v)});
        }
        return line;
    }

    /// 0: the triangle to the left of the edge is on the side of `p`; 1: that to the right.
    int side_of(std::size_t e, const Vec3& p) const {
        const Edge& edge = edges_[e];
        if (edge.triangles[1] == kNone) return 0;
        const Vec3 off = p - nearest_on(e, p);
        return glm::dot(off, inwards_of(e, edge.triangles[1])) > glm::dot(off, inwards_of(e, edge.triangles[0]));
    }
    /// In the plane of the triangle, at right angles to the edge, unit.
    Vec3 inwards_of(std::size_t e, std::uint32_t triangle) const {
        const Vec3 a = point(edges_[e].ends[0]), along = glm::normalize(point(edges_[e].ends[1]) - a);
        Vec3 in{0};
        for (const std::uint32_t v : mesh_.triangles[triangle]) in += point(v) - a;
        in -= glm::dot(in, along) * along;
        const double size = glm::length(in);
        return size > 0 ? in / size : Vec3(0);
    }
    Vec3 nearest_on(std::size_t e, const Vec3& p) const {
        const Vec3 a = point(edges_[e].ends[0]), d = point(edges_[e].ends[1]) - a;
        return a + std::clamp(glm::dot(p - a, d) / std::max(glm::dot(d, d), 1e-300), 0.0, 1.0) * d;
    }
    Vec3 point(std::uint32_t v) const { return Vec3(mesh_.positions[v]); }
    std::uint32_t other(std::size_t e, std::uint32_t v) const {
        const auto& ends = edges_[e].ends;
        return ends[0] == v ? ends[1] : ends[0];
    }

    const mesh::TriangleMesh& mesh_;
    std::vector<Edge> edges_;
    std::vector<char> used_;
    std::multimap<std::uint32_t, std::size_t> at_;
};

}  // namespace edges

namespace {

/// Turns a path so that a reader outside sees it run to the right.
void run_to_right(ModelPath& path) {
    constexpr double kFlat = 0.05;  // of the path's length
    const std::size_t n = path.points.size();
    double to_right = 0, length = 0;
    Vec3 along{0};
    for (std::size_t i = 0; i + (path.closed ? 0 : 1) < n; ++i) {
        const Vec3 step = path.points[(i + 1) % n] - path.points[i];
        to_right += glm::dot(step, glm::cross(Vec3(0, 0, 1), path.normals[i]));
        length += glm::length(step);
        if (!path.closed || i == 0) along += step;  // a closed path begins at the place
    }
    if (std::abs(to_right) < kFlat * length) to_right = std::abs(along.x) > std::abs(along.y) ? along.x : along.y;
    if (to_right >= 0) return;
    std::ranges::reverse(path.points);
    std::ranges::reverse(path.normals);
}

}  // namespace

class FeatureLines::Edges : public edges::Walk {
    using Walk::Walk;
};

FeatureLines::FeatureLines(const mesh::SurfaceQuery& query)
    : query_(query), edges_(std::make_unique<Edges>(query.mesh(), edges::feature_edges(query))) {}

FeatureLines::~FeatureLines() = default;

double feature_reach(const Box& model) {
    constexpr double kReach = 0.05, kReachOfModel = 0.1;  // metres; of the diagonal
    return std::min(kReach, kReachOfModel * model.diagonal());
}

FeatureLine feature_line(const mesh::SurfaceQuery& query, const Vec3& through, double reach) {
    return FeatureLines(query).nearest(through, reach);
}

FeatureLine FeatureLines::nearest(const Vec3& through, double reach) {
    edges::Walk& walk = *edges_;
    const auto [first, away] = walk.empty() ? std::pair(std::size_t{0}, HUGE_VAL) : walk.nearest(through);
    FeatureLine line{.away = away};
    // A sharp edge is a crease as well, whose middle may seem nearer by a fraction of the sections' spacing.
    if (const double nearer = std::min(reach, away - kPreferEdge * reach); nearer > 0)
        if (auto crease = crease_line(query_, through, nearer); crease && crease->away <= nearer)
            line = std::move(*crease);
    if (line.path.points.empty()) {
        if (away == HUGE_VAL)
            throw Error(Message("no edge and no crease of the model lies within {} mm of the place",
                                fmt::format("{:.3g}", reach / kMillimetre)));
        if (away > reach)
            throw Error(
                Message("no edge and no crease of the model lies within {} mm of the place; the nearest edge is "
                        "{} mm away",
                        fmt::format("{:.3g}", reach / kMillimetre), fmt::format("{:.3g}", away / kMillimetre)));
        line.kind = walk.edge(first).kind;
        line.angle = walk.edge(first).angle;
        line.path = walk.line(first, through, kBeside * reach);
    }
    run_to_right(line.path);
    return line;
}

}  // namespace tuft::writer
