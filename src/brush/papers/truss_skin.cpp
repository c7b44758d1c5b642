#include "brush/papers/truss_skin.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace tuft::brush::truss {

namespace {

using Edge = std::pair<int, int>;

Edge edge_of(int a, int b) {
    return {std::min(a, b), std::max(a, b)};
}

/// Vertices opposite to each edge: one on a boundary, else two.
std::map<Edge, std::vector<int>> opposite_vertices(const ButterflyMesh& skin) {
    std::map<Edge, std::vector<int>> out;
    for (const auto& t : skin.triangles)
        for (int k = 0; k < 3; ++k) out[edge_of(t[k], t[(k + 1) % 3])].push_back(t[(k + 2) % 3]);
    return out;
}

/// Boundary neighbours of each boundary vertex.
std::map<int, std::vector<int>> boundary_neighbours(const std::map<Edge, std::vector<int>>& opposite) {
    std::map<int, std::vector<int>> out;
    for (const auto& [edge, across] : opposite) {
        if (across.size() != 1) continue;
        out[edge.first].push_back(edge.second);
        out[edge.second].push_back(edge.first);
    }
    return out;
}

/// Rows of weights of one mesh.
class Rows {
  public:
    explicit Rows(const ButterflyMesh& skin) : skin_(skin), sum_(static_cast<std::size_t>(skin.particles), 0) {}

    void add(int vertex, double factor) {
        const std::span<const double> row = skin_.row(vertex);
        for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += factor * row[i];
    }
    const std::vector<double>& sum() const { return sum_; }

  private:
    const ButterflyMesh& skin_;
    std::vector<double> sum_;
};

/// Adds the wing across edge (a, b) from `inner`; where there is no triangle, the parallelogram's fourth vertex.
void add_wing(const std::map<Edge, std::vector<int>>& opposite, int a, int b, int inner, double factor, Rows& rows) {
    for (const int v : opposite.at(edge_of(a, b))) {
        if (v == inner) continue;
        rows.add(v, factor);
        return;
    }
    rows.add(a, factor);
    rows.add(b, factor);
    rows.add(inner, -factor);
}

std::vector<double> edge_vertex(const ButterflyMesh& skin, const std::map<Edge, std::vector<int>>& opposite,
                                const std::map<int, std::vector<int>>& boundary, const Edge& edge) {
    Rows rows(skin);
    const auto [a, b] = edge;
    const std::vector<int>& across = opposite.at(edge);
    if (across.size() == 1) {
        for (const int v : {a, b}) {
            rows.add(v, 9.0 / 16);
            for (const int next : boundary.at(v))
                if (next != a && next != b) rows.add(next, -1.0 / 16);
        }
        return rows.sum();
    }
    rows.add(a, 0.5);
    rows.add(b, 0.5);
    for (const int c : across) {
        rows.add(c, 0.125);
        add_wing(opposite, a, c, b, -1.0 / 16, rows);
        add_wing(opposite, b, c, a, -1.0 / 16, rows);
    }
    return rows.sum();
}

/// Weights of the points at x: linear between the two nearest trusses, and beyond.
std::vector<double> point_weights(const Truss& truss, double x) {
    std::vector<double> w(static_cast<std::size_t>(truss.count), 0);
    if (truss.count == 1) return {1};
    const auto at = [&](int j) { return truss.rest[truss.base_count() + j].x; };
    int j = 0;
    while (j + 2 < truss.count && x > at(j + 1)) ++j;
    const double f = (x - at(j)) / (at(j + 1) - at(j));
    w[j] = 1 - f;
    w[j + 1] = f;
    return w;
}

/// Adds the vector (x, y) of the base plane, from the first base: its particles are corners of a rectangle.
void add_across(const Truss& truss, double x, double y, std::vector<double>& w) {
    const double fx = x / (truss.rest[0].x - truss.rest[1].x), fy = y / (truss.rest[0].y - truss.rest[3].y);
    w[0] += fx;
    w[1] -= fx;
    w[0] += fy;
    w[3] -= fy;
}

std::vector<double> control_weights(const Truss& truss, double x, double y, double u) {
    std::vector<double> w(truss.rest.size(), 0);
    const std::vector<double> point = point_weights(truss, x);
    double point_x = 0;
    for (int j = 0; j < truss.count; ++j) {
        w[truss.base_count() + j] = u * point[j];
        point_x += point[j] * truss.rest[truss.base_count() + j].x;
    }
    for (int i = 0; i < truss.base_count(); ++i) w[i] = (1 - u) / truss.base_count();
    // All bases together are centred on the axis.
    add_across(truss, (1 - u) * x + u * (x - point_x), y, w);
    return w;
}

}  // namespace

Vec3 place(std::span<const double> weights, std::span<const Vec3> particles) {
    Vec3 sum{0};
    for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * particles[i];
    return sum;
}

ButterflyMesh make_control_skin(const Truss& truss, std::span<const RingShape> rings) {
    ButterflyMesh skin{static_cast<int>(truss.rest.size()), {}, {}};
    const auto add = [&](double x, double y, double u) {
        const std::vector<double> w = control_weights(truss, x, y, u);
        skin.weight.insert(skin.weight.end(), w.begin(), w.end());
    };
    for (const RingShape& ring : rings)
        for (int k = 0; k < kRingPoints; ++k) {
            const double angle = 2 * std::numbers::pi * k / kRingPoints;
            add(ring.half_width * std::cos(angle), ring.half_thickness * std::sin(angle), ring.u);
        }
    const bool closed = truss.count == 1;
    if (closed) add(0, 0, 1);
    const int count = static_cast<int>(rings.size());
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < kRingPoints; ++k) {
            const int next = (k + 1) % kRingPoints, a = i * kRingPoints + k, b = i * kRingPoints + next;
            if (i + 1 == count) {
                if (closed) skin.triangles.push_back({a, count * kRingPoints, b});
                continue;
            }
            const int c = a + kRingPoints, d = b + kRingPoints;
            // A round is the same all round. The diagonals of others alternate from quarter to quarter, so that the
            // mesh is its own mirror image.
            if (closed || 4 * k / kRingPoints % 2 == 0)
                skin.triangles.insert(skin.triangles.end(), {{a, c, b}, {b, c, d}});
            else
                skin.triangles.insert(skin.triangles.end(), {{a, c, d}, {a, d, b}});
        }
    return skin;
}

ButterflyMesh subdivide(const ButterflyMesh& skin) {
    const auto opposite = opposite_vertices(skin);
    const auto boundary = boundary_neighbours(opposite);
    ButterflyMesh out{skin.particles, skin.weight, {}};
    std::map<Edge, int> middle;
    for (const auto& entry : opposite) {
        middle[entry.first] = out.vertices();
        const std::vector<double> row = edge_vertex(skin, opposite, boundary, entry.first);
        out.weight.insert(out.weight.end(), row.begin(), row.end());
    }
    for (const auto& [a, b, c] : skin.triangles) {
        const int ab = middle[edge_of(a, b)], bc = middle[edge_of(b, c)], ca = middle[edge_of(c, a)];
        out.triangles.insert(out.triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    return out;
}

namespace {

/// The ring round the root: the boundary in order.
std::vector<int> boundary_ring(const ButterflyMesh& skin) {
    const auto neighbours = boundary_neighbours(opposite_vertices(skin));
    std::vector<int> ring{0};
    int before = -1;
    while (true) {
        const std::vector<int>& next = neighbours.at(ring.back());
        const int step = next[0] != before && (ring.size() > 1 || next[0] < next[1]) ? next[0] : next[1];
        before = ring.back();
        if (step == ring.front()) return ring;
        ring.push_back(step);
    }
}

/// Distance of each vertex from the root's ring in edges.
std::vector<int> levels_from(const ButterflyMesh& skin, const std::vector<int>& ring) {
    std::vector<int> level(static_cast<std::size_t>(skin.vertices()), -1);
    std::vector<int> front = ring;
    for (const int v : ring) level[v] = 0;
    std::vector<std::vector<int>> around(level.size());
    for (const auto& t : skin.triangles)
        for (int k = 0; k < 3; ++k) {
            around[t[k]].push_back(t[(k + 1) % 3]);
            around[t[k]].push_back(t[(k + 2) % 3]);
        }
    while (!front.empty()) {
        std::vector<int> next;
        for (const int v : front)
            for (const int w : around[v])
                if (level[w] < 0) {
                    level[w] = level[v] + 1;
                    next.push_back(w);
                }
        front = std::move(next);
    }
    return level;
}

}  // namespace

double SkinSection::semi_axis(std::span<const Vec3> particles, const Vec3& d) const {
    const std::size_t count = particles.size();
    // Relative to one particle: the weights of a variance sum to 0, far from the origin only roughly.
    std::vector<double> along;
    for (const Vec3& x : particles) along.push_back(glm::dot(x - particles[0], d));
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = 0; j < count; ++j) sum += spread[i * count + j] * along[i] * along[j];
    return std::sqrt(2 * std::max(0.0, sum));
}

std::vector<SkinSection> skin_sections(const Truss& truss, std::span<const RingShape> shapes, int refinements) {
    ButterflyMesh skin = make_control_skin(truss, shapes);
    for (int k = 0; k < refinements; ++k) skin = subdivide(skin);
    const std::vector<int> level = levels_from(skin, boundary_ring(skin));
    const auto count = static_cast<std::size_t>(skin.particles);
    std::vector<SkinSection> sections(1 + static_cast<std::size_t>(*std::max_element(level.begin(), level.end())));
    for (SkinSection& s : sections) {
        s.mean.assign(count, 0);
        s.spread.assign(count * count, 0);
    }
    std::vector<double> members(sections.size(), 0);
    for (const int l : level) members[l] += 1;
    for (int v = 0; v < skin.vertices(); ++v)
        for (std::size_t i = 0; i < count; ++i) sections[level[v]].mean[i] += skin.row(v)[i] / members[level[v]];
    for (int v = 0; v < skin.vertices(); ++v) {
        SkinSection& s = sections[level[v]];
        const std::span<const double> row = skin.row(v);
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t j = 0; j < count; ++j)
                s.spread[i * count + j] += (row[i] - s.mean[i]) * (row[j] - s.mean[j]) / members[level[v]];
    }
    const double length = sections.back().centre(truss.rest).z;
    for (SkinSection& s : sections) s.u = s.centre(truss.rest).z / length;
    return sections;
}

SkinSection section_at(std::span<const SkinSection> sections, double u) {
    std::size_t k = 0;
    while (k + 2 < sections.size() && sections[k + 1].u < u) ++k;
    const SkinSection &a = sections[k], &b = sections[k + 1];
    const double f = b.u > a.u ? std::clamp((u - a.u) / (b.u - a.u), 0.0, 1.0) : 0;
    SkinSection out{u, a.mean, a.spread};
    for (std::size_t i = 0; i < out.mean.size(); ++i) out.mean[i] = std::lerp(a.mean[i], b.mean[i], f);
    for (std::size_t i = 0; i < out.spread.size(); ++i) out.spread[i] = std::lerp(a.spread[i], b.spread[i], f);
    return out;
}

}  // namespace tuft::brush::truss
