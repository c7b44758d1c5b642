#include "decal/panels/select_film.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

#include "core/system/interrupt.h"
#include "core/system/parallel.h"

namespace tuft::decal {
namespace {

constexpr double kWidestTurn = 0.61;  // radians, 35°: beyond, a margin would wrap round an edge
// Of an edge: small triangles at the border would bear strain of their own.
constexpr Snap kBorderSnap{0.15, 0.15};
constexpr double kPainted = 0.5;        // coverage
constexpr int kMostSamples = 512;       // along an edge
constexpr double kSlack = 5e-4;         // metres beyond the bleed: the cut line lies on the film
constexpr double kLongest = 0.5;        // of the bleed: edges of what is not painted all over
constexpr double kMostTriangles = 3e4;  // of that, that are made by halving
constexpr double kPathOverLine = 1.5;   // of paths over edges to straight lines, at most
constexpr int kMostRounds = 60;         // of halving
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// How much of a triangle is painted. `unknown`: it is too large for that to be found at once.
enum Paint : std::uint32_t { none, some, all, unknown };

double longest_edge(const mesh::TriangleMesh& mesh, std::uint32_t t) {
    double longest = 0;
    for (int k = 0; k < 3; ++k)
        longest = std::max(longest, glm::length(mesh.position(t, (k + 1) % 3) - mesh.position(t, k)));
    return longest;
}

/// Calls `use(weights)` for samples every `texel` metres of a triangle until it returns false.
template <class Use>
void each_sample(double longest, double texel, const Use& use) {
    const int n = std::clamp(static_cast<int>(std::ceil(longest / texel)), 1, kMostSamples);
    for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j) {
            const double b = static_cast<double>(i) / n, c = static_cast<double>(j) / n;
            if (!use(Weights{1 - b - c, b, c})) return;
        }
}

/// Weights in the triangle of the model.
Weights in_model(const FilmMesh& film, std::uint32_t t, const Weights& in_film) {
    Weights weights{};
    for (std::size_t corner = 0; corner < 3; ++corner)
        for (std::size_t k = 0; k < 3; ++k) weights[k] += in_film[corner] * film.weights[t][corner][k];
    return weights;
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

/// The place that a vertex is reached from.
struct Origin {
    Vec3 place{0};
    double offset = 0;               // metres, added to the distance from it
    std::uint32_t triangle = kNone;  // whose normal bounds how far the surface may turn; kNone: it may turn
    double distance_to(const Vec3& p) const { return offset + glm::length(p - place); }
};

/// Straight distances of the vertices to the nearest of many places, found along edges.
struct Distances {
    std::vector<double> distance;       // [n_vertices]
    std::vector<std::uint8_t> reached;  // [n_triangles]

    Distances(const mesh::TriangleMesh& m, const Fans& fans, const std::vector<std::pair<std::uint32_t, Origin>>& seeds,
              double margin)
        : distance(m.n_vertices(), kInfinite), reached(m.n_triangles(), 0) {
        struct Entry {
            double distance;
            std::uint32_t vertex;
            bool operator>(const Entry& o) const {
                return distance != o.distance ? distance > o.distance : vertex > o.vertex;
            }
        };
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        std::vector<Origin> origin(m.n_vertices());
        const auto reach = [&](std::uint32_t v, const Origin& from) {
            const double d = from.distance_to(Vec3(m.positions[v]));
            if (d >= distance[v]) return;
            distance[v] = d;
            origin[v] = from;
            if (d < margin) queue.push({d, v});
        };
        for (const auto& [v, from] : seeds) reach(v, from);
        const double least_cos = std::cos(kWidestTurn);
        while (!queue.empty()) {
            const Entry e = queue.top();
            queue.pop();
            if (e.distance > distance[e.vertex]) continue;
            const Origin from = origin[e.vertex];
            const Vec3 normal = from.triangle == kNone ? Vec3(0) : mesh::face_normal(m, from.triangle);
            for (std::uint32_t i = fans.start[e.vertex]; i < fans.start[e.vertex + 1]; ++i) {
                const std::uint32_t t = fans.triangle[i];
                if (from.triangle != kNone && glm::dot(normal, mesh::face_normal(m, t)) < least_cos) continue;
                reached[t] = 1;
                for (const std::uint32_t v : m.triangles[t]) reach(v, from);
            }
        }
    }
};

/// Selects and divides the film. While it does, `label` of a triangle is its `Paint`.
class Selection {
  public:
    Selection(const mesh::TriangleMesh& model, const CoverageFn& coverage, const FilmReach& reach, double texel)
        : coverage_(coverage),
          bleed_(reach.bleed + kSlack),
          around_(std::max(reach.around, bleed_)),
          hole_(reach.hole),
          texel_(texel) {
        film_.mesh.positions = model.positions;
        film_.mesh.triangles = model.triangles;
        film_.source.resize(model.n_triangles());
        for (std::uint32_t t = 0; t < film_.source.size(); ++t) film_.source[t] = t;
        film_.weights.assign(film_.source.size(), {Weights{1, 0, 0}, Weights{0, 1, 0}, Weights{0, 0, 1}});
        film_.label.assign(film_.source.size(), unknown);
        find_paint(std::vector<std::uint8_t>(film_.source.size(), 1));
    }

    FilmMesh run() {
        take_near();
        for (int round = 0; round < kMostRounds && halve(); ++round) take_near();
        end_at_bleed();
        std::ranges::fill(film_.label, 0u);
        film_.n_labels = film_.source.empty() ? 0 : 1;
        label_parts(film_, 0);
        return std::move(film_);
    }

  private:
    double reach() const { return std::max({around_, hole_, bleed_}) + 2 * longest_; }

    /// Finds how much of the triangles is painted.
    void find_paint(const std::vector<std::uint8_t>& which) {
        parallel_for(which.size(), 64, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                if (which[i]) film_.label[i] = paint_of(static_cast<std::uint32_t>(i));
        });
    }

    Paint paint_of(std::uint32_t t) const {
        const double longest = longest_edge(film_.mesh, t);
        if (longest > kMostSamples * texel_) return unknown;
        bool any = false, bare = false;
        each_sample(longest, texel_, [&](const Weights& w) {
            (is_painted_at(t, w) ? any : bare) = true;
            return !(any && bare);
        });
        return !any ? none : bare ? some : all;
    }

    bool is_painted_at(std::uint32_t t, const Weights& in_film) const {
        return coverage_(film_.source[t], in_model(film_, t, in_film)) > kPainted;
    }

    /// Leaves out what is too far from all paint to matter.
    void take_near() {
        const Fans fans(film_.mesh);
        std::vector<std::pair<std::uint32_t, Origin>> seeds;
        for (std::uint32_t t = 0; t < film_.source.size(); ++t)
            if (film_.label[t] != none)
                for (const std::uint32_t v : film_.mesh.triangles[t])
                    seeds.push_back({v, {Vec3(film_.mesh.positions[v]), 0, film_.label[t] == unknown ? kNone : t}});
        std::vector<std::uint8_t> near = Distances(film_.mesh, fans, seeds, kPathOverLine * reach()).reached;
        for (std::uint32_t t = 0; t < film_.source.size(); ++t) near[t] |= film_.label[t] != none;
        keep(near);
    }

    void keep(const std::vector<std::uint8_t>& which) {
        FilmMesh kept;
        std::vector<std::uint32_t> number(film_.mesh.n_vertices(), kNone);
        for (std::uint32_t t = 0; t < which.size(); ++t) {
            if (!which[t]) continue;
            std::array<std::uint32_t, 3> f = film_.mesh.triangles[t];
            for (std::uint32_t& v : f) {
                if (number[v] == kNone) {
                    number[v] = static_cast<std::uint32_t>(kept.mesh.positions.size());
                    kept.mesh.positions.push_back(film_.mesh.positions[v]);
                }
                v = number[v];
            }
            kept.mesh.triangles.push_back(f);
            kept.source.push_back(film_.source[t]);
            kept.weights.push_back(film_.weights[t]);
            kept.label.push_back(film_.label[t]);
        }
        film_ = std::move(kept);
        find_neighbours(film_);
    }

    /// Halves the edges that are too long and, so that no triangle gets slender, the longest edges of the triangles
    /// that are divided by that. Returns whether there were any.
    bool halve() {
        check_interrupt();
        double area = 0;
        for (std::uint32_t t = 0; t < film_.source.size(); ++t)
            if (film_.label[t] != all)
                area += 0.5 * glm::length(glm::cross(film_.mesh.position(t, 1) - film_.mesh.position(t, 0),
                                                     film_.mesh.position(t, 2) - film_.mesh.position(t, 0)));
        longest_ = std::max(kLongest * bleed_, std::sqrt(area / kMostTriangles));
        EdgePoints points;
        std::vector<std::uint32_t> ahead;
        const auto halve_edge = [&](std::uint32_t t, std::size_t k) {
            const std::uint32_t a = film_.mesh.triangles[t][k], b = film_.mesh.triangles[t][(k + 1) % 3];
            const Vec3f &from = film_.mesh.positions[a], &to = film_.mesh.positions[b];
            const Vec3f middle(0.5 * (Vec3(from) + Vec3(to)));
            if (middle == from || middle == to) return;  // far from the origin floats lie so far apart
            const auto [it, fresh] =
                points.emplace(edge_key(a, b), static_cast<std::uint32_t>(film_.mesh.positions.size()));
            if (!fresh) return;
            film_.mesh.positions.push_back(middle);
            ahead.push_back(t);
            if (const std::uint32_t other = film_.mesh.neighbours[3 * t + k]; other != kNone) ahead.push_back(other);
        };
        for (std::uint32_t t = 0; t < film_.source.size(); ++t) {
            const double most = film_.label[t] == unknown ? std::min(longest_, kMostSamples * texel_) : longest_;
            if (film_.label[t] == all) continue;
            for (std::size_t k = 0; k < 3; ++k)
                if (edge_length(t, k) > most) halve_edge(t, k);
        }
        while (!ahead.empty()) {
            const std::uint32_t t = ahead.back();
            ahead.pop_back();
            std::size_t longest = 0;
            for (std::size_t k = 1; k < 3; ++k)
                if (edge_length(t, k) > edge_length(t, longest)) longest = k;
            halve_edge(t, longest);
        }
        if (points.empty()) return false;
        divide_at(points);
        return true;
    }

    double edge_length(std::uint32_t t, std::size_t k) const {
        return glm::length(film_.mesh.position(t, static_cast<int>((k + 1) % 3)) -
                           film_.mesh.position(t, static_cast<int>(k)));
    }

    void divide_at(const EdgePoints& points) {
        std::vector<std::uint8_t> changed(film_.source.size(), 0);
        for (std::uint32_t t = 0; t < changed.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k)
                changed[t] |=
                    points.contains(edge_key(film_.mesh.triangles[t][k], film_.mesh.triangles[t][(k + 1) % 3]));
        divide(film_, points);
        changed.resize(film_.source.size(), 1);
        for (std::size_t t = 0; t < changed.size(); ++t)
            changed[t] = changed[t] && film_.label[t] != none && film_.label[t] != all;
        find_paint(changed);
    }

    /// Divides the film along the line where it ends, and leaves out what lies beyond.
    void end_at_bleed() {
        const Fans fans(film_.mesh);
        const Distances to_paint(film_.mesh, fans, paint_seeds(), reach());
        std::vector<std::uint8_t> near = to_paint.reached;
        for (std::uint32_t t = 0; t < near.size(); ++t) near[t] |= film_.label[t] != none;
        std::vector<double> height(film_.mesh.n_vertices());
        for (std::size_t v = 0; v < height.size(); ++v)
            height[v] = std::min(to_paint.distance[v], 2 * reach()) - bleed_;
        if (around_ > bleed_) {
            const std::vector<double> inward = to_outside(fans, to_paint);
            for (std::size_t v = 0; v < height.size(); ++v)
                height[v] = std::min(height[v], std::max(around_ - bleed_ - inward[v], -bleed_));
        }
        for (std::uint32_t t = 0; t < near.size(); ++t) film_.label[t] = near[t] ? 0 : 1;
        std::vector<std::uint8_t> out = divide_at_level(film_, 0, std::move(height), kBorderSnap);
        for (std::size_t t = 0; t < out.size(); ++t) out[t] |= film_.label[t] != 0;
        fill_holes(out);
        for (std::uint8_t& o : out) o = !o;
        keep(out);
    }

    /// The nearest paint in its triangle, from each corner.
    std::vector<std::pair<std::uint32_t, Origin>> paint_seeds() const {
        std::vector<std::array<Origin, 3>> nearest(film_.source.size());
        parallel_for(nearest.size(), 64, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const auto t = static_cast<std::uint32_t>(i);
                if (film_.label[t] == none) continue;
                std::array<double, 3> least{kInfinite, kInfinite, kInfinite};
                for (std::size_t k = 0; k < 3; ++k) nearest[i][k] = {film_.mesh.position(t, static_cast<int>(k)), 0, t};
                if (film_.label[t] == all) continue;
                each_sample(longest_edge(film_.mesh, t), texel_, [&](const Weights& w) {
                    if (!is_painted_at(t, w)) return true;
                    const Vec3 p = point_at(film_.mesh, t, w);
                    for (std::size_t k = 0; k < 3; ++k) {
                        const double d = glm::length(p - film_.mesh.position(t, static_cast<int>(k)));
                        if (d < least[k]) least[k] = d, nearest[i][k].place = p;
                    }
                    return true;
                });
            }
        });
        std::vector<std::pair<std::uint32_t, Origin>> seeds;
        for (std::uint32_t t = 0; t < nearest.size(); ++t)
            for (std::size_t k = 0; k < 3 && film_.label[t] != none; ++k)
                seeds.emplace_back(film_.mesh.triangles[t][k], nearest[t][k]);
        return seeds;
    }

    /// Distances to what is more than `around_` from the paint.
    std::vector<double> to_outside(const Fans& fans, const Distances& to_paint) const {
        std::vector<std::pair<std::uint32_t, Origin>> seeds;
        for (std::uint32_t v = 0; v < to_paint.distance.size(); ++v)
            if (const double beyond = to_paint.distance[v] - around_; beyond >= 0 && std::isfinite(beyond))
                seeds.push_back({v, {Vec3(film_.mesh.positions[v]), -beyond, kNone}});
        return Distances(film_.mesh, fans, seeds, around_).distance;
    }

    /// Takes back connected parts of what is left out that are small and do not reach the border.
    void fill_holes(std::vector<std::uint8_t>& out) const {
        std::vector<std::uint8_t> seen(out.size(), 0);
        for (std::uint32_t first = 0; first < out.size(); ++first) {
            if (!out[first] || seen[first]) continue;
            std::vector<std::uint32_t> part{first};
            seen[first] = 1;
            bool inner = true;
            double area = 0;
            for (std::size_t i = 0; i < part.size(); ++i) {
                const std::uint32_t t = part[i];
                area += 0.5 * glm::length(glm::cross(film_.mesh.position(t, 1) - film_.mesh.position(t, 0),
                                                     film_.mesh.position(t, 2) - film_.mesh.position(t, 0)));
                for (std::uint32_t k = 0; k < 3; ++k) {
                    const std::uint32_t other = film_.mesh.neighbours[3 * t + k];
                    if (other == kNone) inner = false;
                    if (other == kNone || seen[other] || !out[other]) continue;
                    seen[other] = 1;
                    part.push_back(other);
                }
            }
            if (!inner || area > std::numbers::pi * hole_ * hole_) continue;
            for (const std::uint32_t t : part) out[t] = 0;
        }
    }

    const CoverageFn& coverage_;
    double bleed_, around_, hole_, texel_;
    double longest_ = 0;  // metres, edges of what is not painted all over
    FilmMesh film_;
};

}  // namespace

FilmMesh select_film(const mesh::TriangleMesh& model, const CoverageFn& coverage, const FilmReach& reach,
                     double texel) {
    return Selection(model, coverage, reach, texel).run();
}

bool is_painted(const FilmMesh& film, std::uint32_t triangle, const CoverageFn& coverage, double texel) {
    bool any = false;
    each_sample(longest_edge(film.mesh, triangle), texel, [&](const Weights& weights) {
        any = coverage(film.source[triangle], in_model(film, triangle, weights)) > kPainted;
        return !any;
    });
    return any;
}

}  // namespace tuft::decal
