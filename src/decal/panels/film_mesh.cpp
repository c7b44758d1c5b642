#include "decal/panels/film_mesh.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <unordered_map>

#include "core/system/parallel.h"

namespace tuft::decal {
namespace {

constexpr double kWidestTurn = 0.61;  // radians, 35°: beyond, a margin would wrap round an edge
constexpr double kSnap = 0.05;        // of an edge
constexpr double kPainted = 0.5;      // coverage
constexpr int kMostSamples = 512;     // along an edge

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
    return (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
}

Weights mix(const Weights& a, const Weights& b, double t) {
    return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}

/// Whether `covered` of the weights is more than half anywhere in a triangle of a mesh.
template <class Covered>
bool is_painted_in(const mesh::TriangleMesh& mesh, std::uint32_t triangle, double texel, const Covered& covered) {
    double longest = 0;
    for (int k = 0; k < 3; ++k)
        longest = std::max(longest, glm::length(mesh.position(triangle, (k + 1) % 3) - mesh.position(triangle, k)));
    const int n = std::clamp(static_cast<int>(std::ceil(longest / texel)), 1, kMostSamples);
    for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j) {
            const double b = static_cast<double>(i) / n, c = static_cast<double>(j) / n;
            if (covered(Weights{1 - b - c, b, c}) > kPainted) return true;
        }
    return false;
}

/// Triangles round each vertex.
struct Fans {
    std::vector<std::uint32_t> start, triangle;

    explicit Fans(const mesh::TriangleMesh& m) : start(m.n_vertices() + 1, 0), triangle(3 * m.n_triangles()) {
        for (const auto& f : m.triangles)
            for (const std::uint32_t v : f) ++start[v + 1];
        for (std::size_t v = 0; v + 1 < start.size(); ++v) start[v + 1] += start[v];
        std::vector<std::uint32_t> fill(start.begin(), start.end() - 1);
        for (std::uint32_t t = 0; t < m.n_triangles(); ++t)
            for (const std::uint32_t v : m.triangles[t]) triangle[fill[v]++] = t;
    }
};

/// Adds the triangles within `margin` of the chosen ones, by Dijkstra's algorithm over edges.
void grow(const mesh::TriangleMesh& m, double margin, std::vector<std::uint8_t>& chosen) {
    struct Reached {
        double distance;
        std::uint32_t vertex, from;  // the painted triangle that it is reached from
        bool operator>(const Reached& o) const {
            return distance != o.distance ? distance > o.distance : vertex > o.vertex;
        }
    };
    const Fans fans(m);
    std::vector<double> distance(m.n_vertices(), std::numeric_limits<double>::infinity());
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
    for (std::uint32_t t = 0; t < m.n_triangles(); ++t)
        if (chosen[t])
            for (const std::uint32_t v : m.triangles[t])
                if (distance[v] > 0) {
                    distance[v] = 0;
                    queue.push({0, v, t});
                }
    const double least_cos = std::cos(kWidestTurn);
    while (!queue.empty()) {
        const Reached r = queue.top();
        queue.pop();
        if (r.distance > distance[r.vertex]) continue;
        const Vec3 normal = mesh::face_normal(m, r.from);
        for (std::uint32_t i = fans.start[r.vertex]; i < fans.start[r.vertex + 1]; ++i) {
            const std::uint32_t t = fans.triangle[i];
            if (glm::dot(normal, mesh::face_normal(m, t)) < least_cos) continue;
            chosen[t] = 1;
            for (const std::uint32_t v : m.triangles[t]) {
                const double d = r.distance + glm::length(Vec3(m.positions[v]) - Vec3(m.positions[r.vertex]));
                if (d < distance[v] && d < margin) {
                    distance[v] = d;
                    queue.push({d, v, r.from});
                }
            }
        }
    }
}

void find_neighbours(mesh::TriangleMesh& m) {
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

/// Gives each connected part of the triangles labelled `label` a label of its own, the first one `label`.
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

/// Signs of the vertices of a label's triangles against a plane; 0 where a vertex lies on it or an edge is crossed
/// close to it.
std::vector<std::int8_t> sides_of(const FilmMesh& film, std::uint32_t label, const std::vector<double>& height) {
    std::vector<std::uint8_t> on(film.mesh.n_vertices(), 0);
    for (std::size_t t = 0; t < film.mesh.n_triangles(); ++t) {
        if (film.label[t] != label) continue;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = film.mesh.triangles[t][k], b = film.mesh.triangles[t][(k + 1) % 3];
            if (height[a] == 0) on[a] = 1;
            if (height[a] * height[b] >= 0) continue;
            const double s = height[a] / (height[a] - height[b]);
            if (s < kSnap) on[a] = 1;
            if (s > 1 - kSnap) on[b] = 1;
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
    Divider(FilmMesh& film, const std::unordered_map<std::uint64_t, std::uint32_t>& middle)
        : film_(film), middle_(middle) {}

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
                add({m[k], v[l], m[l]}), add({v[k], m[k], m[l]}), add({v[k], m[l], v[o]});
                return;
            }
        }
    }

  private:
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
    const std::unordered_map<std::uint64_t, std::uint32_t>& middle_;
    std::uint32_t place_ = 0;
    bool first_ = true;
    std::array<std::uint32_t, 3> corners_{};
    std::array<Weights, 3> own_{};
};

}  // namespace

FilmMesh select_film(const mesh::TriangleMesh& model, const CoverageFn& coverage, double margin, double texel) {
    const std::size_t n = model.n_triangles();
    std::vector<std::uint8_t> chosen(n, 0);
    parallel_for(n, 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t)
            chosen[t] = is_painted_in(model, static_cast<std::uint32_t>(t), texel, [&](const Weights& weights) {
                return coverage(static_cast<std::uint32_t>(t), weights);
            });
    });
    grow(model, margin, chosen);
    FilmMesh film;
    std::vector<std::uint32_t> number(model.n_vertices(), kNone);
    for (std::uint32_t t = 0; t < n; ++t) {
        if (!chosen[t]) continue;
        std::array<std::uint32_t, 3> f = model.triangles[t];
        for (std::uint32_t& v : f) {
            if (number[v] == kNone) {
                number[v] = static_cast<std::uint32_t>(film.mesh.positions.size());
                film.mesh.positions.push_back(model.positions[v]);
            }
            v = number[v];
        }
        film.mesh.triangles.push_back(f);
        film.source.push_back(t);
        film.weights.push_back({Weights{1, 0, 0}, Weights{0, 1, 0}, Weights{0, 0, 1}});
    }
    film.label.assign(film.source.size(), 0);
    find_neighbours(film.mesh);
    film.n_labels = film.source.empty() ? 0 : 1;
    label_parts(film, 0);
    return film;
}

bool is_painted(const FilmMesh& film, std::uint32_t triangle, const CoverageFn& coverage, double texel) {
    return is_painted_in(film.mesh, triangle, texel, [&](const Weights& in_film) {
        Weights weights{};
        for (std::size_t corner = 0; corner < 3; ++corner)
            for (std::size_t k = 0; k < 3; ++k) weights[k] += in_film[corner] * film.weights[triangle][corner][k];
        return coverage(film.source[triangle], weights);
    });
}

std::vector<std::uint32_t> cut(FilmMesh& film, std::uint32_t label, const Plane& plane) {
    std::vector<double> height(film.mesh.n_vertices());
    for (std::size_t v = 0; v < height.size(); ++v)
        height[v] = glm::dot(plane.normal, Vec3(film.mesh.positions[v])) - plane.offset;
    std::vector<std::int8_t> side = sides_of(film, label, height);
    std::unordered_map<std::uint64_t, std::uint32_t> middle;
    const auto n = static_cast<std::uint32_t>(film.mesh.n_triangles());
    for (std::uint32_t t = 0; t < n; ++t) {
        if (film.label[t] != label) continue;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = film.mesh.triangles[t][k], b = film.mesh.triangles[t][(k + 1) % 3];
            if (side[a] * side[b] >= 0) continue;
            const auto [it, fresh] =
                middle.emplace(edge_key(a, b), static_cast<std::uint32_t>(film.mesh.positions.size()));
            if (!fresh) continue;
            const std::uint32_t lo = std::min(a, b), hi = std::max(a, b);
            const Vec3 p(film.mesh.positions[lo]), q(film.mesh.positions[hi]);
            film.mesh.positions.push_back(Vec3f(p + (height[lo] / (height[lo] - height[hi])) * (q - p)));
            side.push_back(0);
            height.push_back(0);
        }
    }
    Divider divider(film, middle);
    for (std::uint32_t t = 0; t < n; ++t) divider.divide(t);
    std::vector<std::size_t> below, above;
    for (std::size_t t = 0; t < film.mesh.n_triangles(); ++t) {
        if (film.label[t] != label) continue;
        int sum = 0;
        double heights = 0;
        for (const std::uint32_t v : film.mesh.triangles[t]) sum += side[v], heights += height[v];
        (sum > 0 || (sum == 0 && heights > 0) ? above : below).push_back(t);
    }
    find_neighbours(film.mesh);
    if (below.empty() || above.empty()) return label_parts(film, label);
    const std::uint32_t other = film.n_labels++;
    for (const std::size_t t : above) film.label[t] = other;
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
