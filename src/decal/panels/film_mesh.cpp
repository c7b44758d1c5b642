#include "decal/panels/film_mesh.h"

#include <algorithm>

namespace tuft::decal {
namespace {

constexpr Snap kPlaneSnap{0.05, 0.05};

Weights mix(const Weights& a, const Weights& b, double t) {
    return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}

/// Signs of the vertices of a label's triangles against a plane; 0 where a vertex lies on it or an edge is crossed
/// close to it.
std::vector<std::int8_t> sides_of(const FilmMesh& film, std::uint32_t label, const std::vector<double>& height,
                                  const Snap& snap) {
    std::vector<std::uint8_t> on(film.mesh.n_vertices(), 0);
    for (std::size_t t = 0; t < film.mesh.n_triangles(); ++t) {
        if (film.label[t] != label) continue;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = film.mesh.triangles[t][k], b = film.mesh.triangles[t][(k + 1) % 3];
            if (height[a] == 0) on[a] = 1;
            if (height[a] * height[b] >= 0) continue;
            const double s = height[a] / (height[a] - height[b]);
            if (s < (height[a] < 0 ? snap.below : snap.above)) on[a] = 1;
            if (1 - s < (height[b] < 0 ? snap.below : snap.above)) on[b] = 1;
        }
    }
    std::vector<std::int8_t> side(film.mesh.n_vertices(), 0);
    for (std::size_t v = 0; v < side.size(); ++v)
        if (!on[v]) side[v] = height[v] > 0 ? 1 : -1;
    return side;
}

/// Divides triangles at new vertices on their edges.
class Divider {
  public:
    Divider(FilmMesh& film, const EdgePoints& middle) : film_(film), middle_(middle) {}

    /// Replaces triangle t by its parts; the first takes its place, the others are appended.
    void divide(std::uint32_t t) {
        const std::array<std::uint32_t, 3> v = film_.mesh.triangles[t];
        std::array<std::uint32_t, 3> m;
        int n = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto it = middle_.find(edge_key(v[k], v[(k + 1) % 3]));
            m[k] = it == middle_.end() ? kNone : it->second;
            n += m[k] != kNone;
        }
        if (n == 0) return;
        place_ = t;
        first_ = true;
        corners_ = v;
        own_ = film_.weights[t];
        if (n == 3) {
            add({v[0], m[0], m[2]}), add({m[0], v[1], m[1]}), add({m[2], m[1], v[2]}), add({m[0], m[1], m[2]});
            return;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t l = (k + 1) % 3, o = (k + 2) % 3;
            if (n == 1 && m[k] != kNone) {
                add({v[k], m[k], v[o]}), add({m[k], v[l], v[o]});
                return;
            }
            if (n == 2 && m[k] != kNone && m[l] != kNone) {  // both edges at corner l
                add({m[k], v[l], m[l]});
                if (length(v[k], m[l]) <= length(m[k], v[o]))
                    add({v[k], m[k], m[l]}), add({v[k], m[l], v[o]});
                else
                    add({v[k], m[k], v[o]}), add({m[k], m[l], v[o]});
                return;
            }
        }
    }

  private:
    double length(std::uint32_t a, std::uint32_t b) const {
        return glm::length(Vec3(film_.mesh.positions[b]) - Vec3(film_.mesh.positions[a]));
    }

    Weights weights_of(std::uint32_t vertex) const {
        for (std::size_t k = 0; k < 3; ++k)
            if (corners_[k] == vertex) return own_[k];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = corners_[k], b = corners_[(k + 1) % 3];
            const auto it = middle_.find(edge_key(a, b));
            if (it == middle_.end() || it->second != vertex) continue;
            const Vec3 pa(film_.mesh.positions[a]), pb(film_.mesh.positions[b]), p(film_.mesh.positions[vertex]);
            return mix(own_[k], own_[(k + 1) % 3], glm::length(p - pa) / glm::length(pb - pa));
        }
        return own_[0];
    }

    void add(const std::array<std::uint32_t, 3>& f) {
        const std::array<Weights, 3> w{weights_of(f[0]), weights_of(f[1]), weights_of(f[2])};
        if (first_) {
            film_.mesh.triangles[place_] = f;
            film_.weights[place_] = w;
            first_ = false;
            return;
        }
        film_.mesh.triangles.push_back(f);
        film_.weights.push_back(w);
        film_.source.push_back(film_.source[place_]);
        film_.label.push_back(film_.label[place_]);
    }

    FilmMesh& film_;
    const EdgePoints& middle_;
    std::uint32_t place_ = 0;
    bool first_ = true;
    std::array<std::uint32_t, 3> corners_{};
    std::array<Weights, 3> own_{};
};

}  // namespace

void find_neighbours(FilmMesh& film) {
    mesh::TriangleMesh& m = film.mesh;
    std::unordered_map<std::uint64_t, std::uint32_t> half;  // directed edge -> half-edge
    half.reserve(3 * m.n_triangles());
    const auto directed = [&](std::uint32_t h) {
        return (std::uint64_t{m.triangles[h / 3][h % 3]} << 32) | m.triangles[h / 3][(h % 3 + 1) % 3];
    };
    const auto n = static_cast<std::uint32_t>(3 * m.n_triangles());
    for (std::uint32_t h = 0; h < n; ++h) half.emplace(directed(h), h);
    m.neighbours.assign(n, kNone);
    for (std::uint32_t h = 0; h < n; ++h) {
        const std::uint64_t key = directed(h);
        const auto other = half.find((key << 32) | (key >> 32));
        if (other != half.end()) m.neighbours[h] = other->second / 3;
    }
}

std::vector<std::uint32_t> label_parts(FilmMesh& film, std::uint32_t label) {
    const auto n = static_cast<std::uint32_t>(film.mesh.n_triangles());
    std::vector<std::uint8_t> seen(n, 0);
    std::vector<std::uint32_t> labels, stack;
    for (std::uint32_t t = 0; t < n; ++t) {
        if (film.label[t] != label || seen[t]) continue;
        const std::uint32_t own = labels.empty() ? label : film.n_labels++;
        std::vector<std::uint32_t> part{t};
        seen[t] = 1;
        for (std::size_t i = 0; i < part.size(); ++i)
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t o = film.mesh.neighbours[3 * part[i] + static_cast<std::uint32_t>(k)];
                if (o == kNone || seen[o] || film.label[o] != label) continue;
                seen[o] = 1;
                part.push_back(o);
            }
        for (const std::uint32_t p : part) stack.push_back(p), stack.push_back(own);
        labels.push_back(own);
    }
    for (std::size_t i = 0; i < stack.size(); i += 2) film.label[stack[i]] = stack[i + 1];
    return labels;
}

void divide(FilmMesh& film, const EdgePoints& points) {
    Divider divider(film, points);
    const auto n = static_cast<std::uint32_t>(film.mesh.n_triangles());
    for (std::uint32_t t = 0; t < n; ++t) divider.divide(t);
    find_neighbours(film);
}

std::vector<std::uint8_t> divide_at_level(FilmMesh& film, std::uint32_t label, std::vector<double> height,
                                          const Snap& snap) {
    std::vector<std::int8_t> side = sides_of(film, label, height, snap);
    EdgePoints points;
    for (std::uint32_t t = 0; t < film.mesh.n_triangles(); ++t) {
        if (film.label[t] != label) continue;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = film.mesh.triangles[t][k], b = film.mesh.triangles[t][(k + 1) % 3];
            if (side[a] * side[b] >= 0) continue;
            const auto [it, fresh] =
                points.emplace(edge_key(a, b), static_cast<std::uint32_t>(film.mesh.positions.size()));
            if (!fresh) continue;
            const std::uint32_t lo = std::min(a, b), hi = std::max(a, b);
            const Vec3 p(film.mesh.positions[lo]), q(film.mesh.positions[hi]);
            film.mesh.positions.push_back(Vec3f(p + (height[lo] / (height[lo] - height[hi])) * (q - p)));
            side.push_back(0);
            height.push_back(0);
        }
    }
    divide(film, points);
    std::vector<std::uint8_t> above(film.mesh.n_triangles(), 0);
    for (std::size_t t = 0; t < above.size(); ++t) {
        int sum = 0;
        double heights = 0;
        for (const std::uint32_t v : film.mesh.triangles[t]) sum += side[v], heights += height[v];
        above[t] = film.label[t] == label && (sum > 0 || (sum == 0 && heights > 0));
    }
    return above;
}

std::vector<std::uint32_t> cut(FilmMesh& film, std::uint32_t label, const Plane& plane) {
    std::vector<double> height(film.mesh.n_vertices());
    for (std::size_t v = 0; v < height.size(); ++v)
        height[v] = glm::dot(plane.normal, Vec3(film.mesh.positions[v])) - plane.offset;
    const std::vector<std::uint8_t> above = divide_at_level(film, label, std::move(height), kPlaneSnap);
    std::size_t n = 0, n_above = 0;
    for (std::size_t t = 0; t < above.size(); ++t) n += film.label[t] == label, n_above += above[t];
    if (n_above == 0 || n_above == n) return label_parts(film, label);
    const std::uint32_t other = film.n_labels++;
    for (std::size_t t = 0; t < above.size(); ++t)
        if (above[t]) film.label[t] = other;
    std::vector<std::uint32_t> labels = label_parts(film, label);
    const std::vector<std::uint32_t> more = label_parts(film, other);
    labels.insert(labels.end(), more.begin(), more.end());
    return labels;
}

Vec3 point_at(const mesh::TriangleMesh& model, std::uint32_t triangle, const Weights& weights) {
    Vec3 p(0);
    for (int k = 0; k < 3; ++k) p += weights[static_cast<std::size_t>(k)] * model.position(triangle, k);
    return p;
}

}  // namespace tuft::decal
