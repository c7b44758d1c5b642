#include "decal/panels/panels.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>

#include "atlas/seams/half_edges.h"
#include "core/error.h"
#include "core/system/parallel.h"

namespace tuft::decal {
namespace {

constexpr double kBareCut = 0.15;  // visibility of a cut through bare film, against 1 through paint
constexpr int kDirections = 24;
constexpr int kPositions = 7;
constexpr double kFirstPosition = 0.35, kLastPosition = 0.65;  // parts of the area
constexpr double kOffCentre = 1.0;  // growth of the cost from the middle to half the area away from it
constexpr double kSharp = 0.3;      // radians
constexpr std::uint32_t kMostPanels = 2000;

std::vector<std::uint32_t> triangles_of(const FilmMesh& film, std::uint32_t label) {
    std::vector<std::uint32_t> triangles;
    for (std::uint32_t t = 0; t < film.label.size(); ++t)
        if (film.label[t] == label) triangles.push_back(t);
    return triangles;
}

/// The half-edges over which triangles of one label meet; kNone elsewhere.
std::vector<std::uint32_t> glue_labels(const FilmMesh& film) {
    std::vector<std::uint32_t> glued = atlas::twin_half_edges(film.mesh);
    for (std::uint32_t h = 0; h < glued.size(); ++h)
        if (glued[h] != kNone && film.label[h / 3] != film.label[glued[h] / 3]) glued[h] = kNone;
    return glued;
}

double area_of(const FilmMesh& film, std::uint32_t t) {
    const Vec3 a = film.mesh.position(t, 0);
    return 0.5 * glm::length(glm::cross(film.mesh.position(t, 1) - a, film.mesh.position(t, 2) - a));
}

/// A triangle of a part that is to be cut.
struct Facet {
    std::uint32_t triangle;
    Vec3 centre;
    double area;
};

/// The two longer axes of a part, its facets weighted by area.
std::array<Vec3, 2> long_axes(const std::vector<Facet>& facets) {
    double area = 0;
    Vec3 mean(0);
    for (const Facet& f : facets) area += f.area, mean += f.area * f.centre;
    mean /= area;
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    for (const Facet& f : facets) {
        const Eigen::Vector3d d(f.centre.x - mean.x, f.centre.y - mean.y, f.centre.z - mean.z);
        moments += f.area * d * d.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(moments);
    const auto axis = [&](int i) {
        const Eigen::Vector3d v = axes.eigenvectors().col(i);
        return Vec3(v.x(), v.y(), v.z());
    };
    return {axis(2), axis(1)};
}

/// Visibility of the cut of a part by a plane, ∫ (kBareCut + coverage) ds, metres.
double cut_cost(const FilmMesh& film, const std::vector<Facet>& facets, const CoverageFn& coverage,
                const Plane& plane) {
    double cost = 0;
    for (const Facet& f : facets) {
        std::array<double, 3> h;
        for (std::size_t k = 0; k < 3; ++k)
            h[k] = glm::dot(plane.normal, film.mesh.position(f.triangle, static_cast<int>(k))) - plane.offset;
        std::array<Vec3, 2> end;
        std::array<Weights, 2> weights{};
        int n = 0;
        for (std::size_t k = 0; k < 3 && n < 2; ++k) {
            const std::size_t l = (k + 1) % 3;
            if ((h[k] > 0) == (h[l] > 0)) continue;
            const double s = h[k] / (h[k] - h[l]);
            const Vec3 p = film.mesh.position(f.triangle, static_cast<int>(k));
            end[static_cast<std::size_t>(n)] = p + s * (film.mesh.position(f.triangle, static_cast<int>(l)) - p);
            for (std::size_t i = 0; i < 3; ++i)
                weights[static_cast<std::size_t>(n)][i] =
                    film.weights[f.triangle][k][i] +
                    s * (film.weights[f.triangle][l][i] - film.weights[f.triangle][k][i]);
            ++n;
        }
        if (n < 2) continue;
        double paint = 0;
        for (const double s : {0.17, 0.5, 0.83}) {
            Weights w;
            for (std::size_t i = 0; i < 3; ++i) w[i] = weights[0][i] + s * (weights[1][i] - weights[0][i]);
            paint += coverage(film.source[f.triangle], w) / 3;
        }
        cost += (kBareCut + paint) * glm::length(end[1] - end[0]);
    }
    return cost;
}

/// The vertex inside a part whose angles miss 2π by most, where that is more than `kSharp`. Cuts beside it do not help.
std::optional<Vec3> sharpest_point(const FilmMesh& film, std::uint32_t label) {
    std::map<std::uint32_t, double> angles;  // by vertex
    std::set<std::uint32_t> border;
    for (const std::uint32_t t : triangles_of(film, label))
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t v = film.mesh.triangles[t][k], next = film.mesh.triangles[t][(k + 1) % 3];
            const Vec3 p(film.mesh.positions[v]);
            const Vec3 a = Vec3(film.mesh.positions[next]) - p;
            const Vec3 b = Vec3(film.mesh.positions[film.mesh.triangles[t][(k + 2) % 3]]) - p;
            angles[v] += std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
            const std::uint32_t other = film.mesh.neighbours[3 * t + k];
            if (other == kNone || film.label[other] != label) border.insert({v, next});
        }
    double most = kSharp;
    std::optional<Vec3> sharpest;
    for (const auto& [v, angle] : angles) {
        const double defect = std::abs(2 * std::numbers::pi - angle);
        if (border.contains(v) || defect <= most) continue;
        most = defect;
        sharpest = Vec3(film.mesh.positions[v]);
    }
    return sharpest;
}

/// The planes that may cut a part, the best first.
std::vector<Plane> cutting_planes(const FilmMesh& film, std::uint32_t label, const CoverageFn& coverage) {
    std::vector<Facet> facets;
    double area = 0;
    for (const std::uint32_t t : triangles_of(film, label)) {
        const Vec3 sum = film.mesh.position(t, 0) + film.mesh.position(t, 1) + film.mesh.position(t, 2);
        facets.push_back({t, sum / 3.0, area_of(film, t)});
        area += facets.back().area;
    }
    const auto [long_axis, other_axis] = long_axes(facets);
    const std::optional<Vec3> sharpest = sharpest_point(film, label);
    struct Candidate {
        Plane plane;
        double away = 0, cost = 0;
        bool sharp = false;  // through the sharpest point
    };
    std::vector<Candidate> candidates;
    for (int d = 0; d < kDirections; ++d) {
        const double angle = std::numbers::pi * d / kDirections;
        const Vec3 normal = std::cos(angle) * long_axis + std::sin(angle) * other_axis;
        if (sharpest) candidates.push_back({{normal, glm::dot(normal, *sharpest)}, 0, 0, true});
        std::vector<std::pair<double, double>> along;  // position, area
        along.reserve(facets.size());
        for (const Facet& f : facets) along.emplace_back(glm::dot(normal, f.centre), f.area);
        std::sort(along.begin(), along.end());
        double passed = 0;
        int next = 0;
        for (const auto& [position, a] : along) {
            passed += a;
            for (; next < kPositions; ++next) {
                const double part = kFirstPosition + (kLastPosition - kFirstPosition) * next / (kPositions - 1);
                if (passed < part * area) break;
                candidates.push_back({{normal, position}, std::abs(part - 0.5), 0});
            }
        }
    }
    parallel_for(candidates.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            candidates[i].cost =
                (1 + 2 * kOffCentre * candidates[i].away) * cut_cost(film, facets, coverage, candidates[i].plane);
    });
    std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return a.sharp != b.sharp ? a.sharp : a.cost < b.cost;
    });
    std::vector<Plane> planes;
    planes.reserve(candidates.size());
    for (const Candidate& c : candidates) planes.push_back(c.plane);
    return planes;
}

/// Panels while they are cut and joined.
class Cutting {
  public:
    Cutting(FilmMesh& film, const CoverageFn& coverage, const PanelOptions& options)
        : film_(film), coverage_(coverage), options_(options) {}

    std::vector<Panel> run() {
        twin_ = {};
        lay_all();
        twin_ = atlas::twin_half_edges(film_.mesh);
        while (join_one()) {
        }
        take_nearest_sizes();
        return in_order();
    }

  private:
    struct Chain {
        std::vector<std::uint32_t> half_edges;
        std::uint32_t a = 0, b = 0;  // panels
        double visibility = 0;
    };

    std::optional<Panel> make_panel(std::vector<std::uint32_t> triangles,
                                    const std::vector<std::uint32_t>& glued) const {
        Panel panel;
        panel.chart = atlas::make_chart(film_.mesh, glued, std::move(triangles), 1.0);
        FlatPanel flat = lay_flat(panel.chart, options_.max_strain, SheetSize::balanced);
        if (!flat.within(options_.max_strain)) return std::nullopt;
        if (options_.fits && !options_.fits(panel.chart, flat.flat)) return std::nullopt;
        panel.strain = flat.strain;
        panel.flat = std::move(flat.flat);
        return panel;
    }

    /// Lays every part flat; parts beyond the limits are cut until none is left. A part that a cut beside it has
    /// divided is laid flat again.
    void lay_all() {
        std::vector<std::size_t> laid;  // by label: number of triangles when it was laid flat
        for (double done = 0;; done = 0.5 * (1 + done)) {
            report(options_.progress, "panels", done);
            glued_ = glue_labels(film_);
            std::vector<std::vector<std::uint32_t>> parts(film_.n_labels);
            for (std::uint32_t t = 0; t < film_.label.size(); ++t) parts[film_.label[t]].push_back(t);
            panels_.resize(parts.size());
            laid.resize(parts.size(), 0);
            parallel_for(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i)
                    if (laid[i] != parts[i].size()) panels_[i] = make_panel(parts[i], glued_);
            });
            for (std::size_t i = 0; i < parts.size(); ++i) laid[i] = parts[i].size();
            bool good = true;
            for (std::uint32_t i = 0; i < parts.size(); ++i) {
                if (panels_[i]) continue;
                good = false;
                for (const std::uint32_t part : split(i))
                    if (part < laid.size()) laid[part] = 0;
            }
            if (good) return;
        }
    }

    std::vector<std::uint32_t> split(std::uint32_t label) {
        if (film_.n_labels < kMostPanels)
            for (const Plane& plane : cutting_planes(film_, label, coverage_))
                if (std::vector<std::uint32_t> parts = cut(film_, label, plane); parts.size() > 1) return parts;
        // No plane parts a few folded triangles: the first of them goes alone.
        const std::vector<std::uint32_t> triangles = triangles_of(film_, label);
        if (triangles.size() < 2 || film_.n_labels >= kMostPanels)
            throw Error("a part of the film cannot be laid flat within this strain and page; allow more of either");
        film_.label[triangles[0]] = film_.n_labels;
        return {label, film_.n_labels++};
    }

    std::vector<Chain> chains() const {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> seams;
        for (std::uint32_t h = 0; h < twin_.size(); ++h) {
            if (twin_[h] == kNone || glued_[h] != kNone) continue;
            const std::uint32_t a = film_.label[h / 3], b = film_.label[twin_[h] / 3];
            if (a < b) seams[{a, b}].push_back(h);
        }
        std::vector<Chain> all;
        for (const auto& [pair, half_edges] : seams)
            for (std::vector<std::uint32_t>& run : connected_runs(half_edges)) {
                Chain chain{std::move(run), pair.first, pair.second, 0};
                for (const std::uint32_t h : chain.half_edges) chain.visibility += visibility(h);
                all.push_back(std::move(chain));
            }
        std::stable_sort(all.begin(), all.end(),
                         [](const Chain& x, const Chain& y) { return x.visibility > y.visibility; });
        return all;
    }

    /// Half-edges in groups that hang together at their ends.
    std::vector<std::vector<std::uint32_t>> connected_runs(const std::vector<std::uint32_t>& half_edges) const {
        std::map<std::uint32_t, std::vector<std::size_t>> at;
        for (std::size_t i = 0; i < half_edges.size(); ++i) {
            at[from(half_edges[i])].push_back(i);
            at[to(half_edges[i])].push_back(i);
        }
        std::vector<std::vector<std::uint32_t>> runs;
        std::vector<std::uint8_t> seen(half_edges.size(), 0);
        for (std::size_t i = 0; i < half_edges.size(); ++i) {
            if (seen[i]) continue;
            std::vector<std::size_t> run{i};
            seen[i] = 1;
            for (std::size_t j = 0; j < run.size(); ++j)
                for (const std::uint32_t v : {from(half_edges[run[j]]), to(half_edges[run[j]])})
                    for (const std::size_t o : at[v])
                        if (!seen[o]) seen[o] = 1, run.push_back(o);
            runs.emplace_back();
            for (const std::size_t j : run) runs.back().push_back(half_edges[j]);
        }
        return runs;
    }

    std::uint32_t from(std::uint32_t h) const { return film_.mesh.triangles[h / 3][h % 3]; }
    std::uint32_t to(std::uint32_t h) const { return film_.mesh.triangles[h / 3][(h % 3 + 1) % 3]; }

    double visibility(std::uint32_t h) const {
        const auto& w = film_.weights[h / 3];
        Weights middle;
        for (std::size_t i = 0; i < 3; ++i) middle[i] = 0.5 * (w[h % 3][i] + w[(h % 3 + 1) % 3][i]);
        const double length = glm::length(Vec3(film_.mesh.positions[to(h)]) - Vec3(film_.mesh.positions[from(h)]));
        return (kBareCut + coverage_(film_.source[h / 3], middle)) * length;
    }

    bool join_one() {
        for (const Chain& chain : chains()) {
            const auto key = std::make_pair(chain.half_edges.front(), version_of(chain));
            if (rejected_.contains(key)) continue;
            report(options_.progress, "joining", 1.0 - 1.0 / (1.0 + static_cast<double>(rejected_.size())));
            std::vector<std::uint32_t> triangles;
            for (const std::uint32_t label : {chain.a, chain.b})
                triangles.insert(triangles.end(), panels_[label]->chart.triangles.begin(),
                                 panels_[label]->chart.triangles.end());
            std::sort(triangles.begin(), triangles.end());
            std::vector<std::uint32_t> glued = glued_;
            for (const std::uint32_t h : chain.half_edges) glued[h] = twin_[h], glued[twin_[h]] = h;
            std::optional<Panel> joined = make_panel(std::move(triangles), glued);
            if (!joined) {
                rejected_.insert(key);
                continue;
            }
            for (const std::uint32_t t : joined->chart.triangles) film_.label[t] = chain.a;
            panels_[chain.a] = std::move(joined);
            panels_[chain.b].reset();
            glued_ = std::move(glued);
            return true;
        }
        return false;
    }

    /// Sizes of both panels: joining changes them, and what was tried before is tried again.
    std::pair<std::size_t, std::size_t> version_of(const Chain& chain) const {
        return {panels_[chain.a]->chart.faces.size(), panels_[chain.b]->chart.faces.size()};
    }

    /// Lays the panels out again at the size nearest to the true one.
    void take_nearest_sizes() {
        // In batches, so that progress is reported and a stop is heard.
        const auto batch = static_cast<std::size_t>(thread_count());
        for (std::size_t first = 0; first < panels_.size(); first += batch) {
            report(options_.progress, "sizes", static_cast<double>(first) / static_cast<double>(panels_.size()));
            parallel_for(std::min(batch, panels_.size() - first), 1, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = first + begin; i < first + end; ++i)
                    if (panels_[i]) take_nearest_size(*panels_[i]);
            });
        }
    }
    void take_nearest_size(Panel& panel) const {
        FlatPanel flat = lay_flat(panel.chart, options_.max_strain, SheetSize::nearest);
        if (!flat.within(options_.max_strain)) return;
        if (options_.fits && !options_.fits(panel.chart, flat.flat)) return;
        panel.strain = flat.strain;
        panel.flat = std::move(flat.flat);
    }

    std::vector<Panel> in_order() {
        Vec3 middle(0);
        for (const Vec3f& p : film_.mesh.positions) middle += Vec3(p) / static_cast<double>(film_.mesh.n_vertices());
        struct Place {
            double azimuth, height;
            Panel* panel;
        };
        std::vector<Place> places;
        for (std::optional<Panel>& panel : panels_) {
            if (!panel) continue;
            mark_seams(*panel);
            Vec3 centre(0);
            double area = 0;
            for (const std::uint32_t t : panel->chart.triangles) {
                const double a = area_of(film_, t);
                area += a;
                centre += a * (film_.mesh.position(t, 0) + film_.mesh.position(t, 1) + film_.mesh.position(t, 2)) / 3.0;
            }
            const Vec3 d = centre / area - middle;
            double azimuth = std::atan2(d.x, -d.y);
            if (azimuth < -1e-9) azimuth += 2 * std::numbers::pi;
            places.push_back({azimuth, d.z, &*panel});
        }
        std::stable_sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
            return a.azimuth != b.azimuth ? a.azimuth < b.azimuth : a.height > b.height;
        });
        std::vector<Panel> ordered;
        ordered.reserve(places.size());
        for (const Place& p : places) ordered.push_back(std::move(*p.panel));
        return ordered;
    }

    void mark_seams(Panel& panel) const {
        panel.is_seam.assign(3 * panel.chart.faces.size(), 0);
        for (std::uint32_t h = 0; h < panel.is_seam.size(); ++h) {
            const std::uint32_t own = 3 * panel.chart.triangles[h / 3] + h % 3;
            panel.is_seam[h] = panel.chart.twin[h] == kNone && twin_[own] != kNone;
        }
    }

    FilmMesh& film_;
    const CoverageFn& coverage_;
    const PanelOptions& options_;
    std::vector<std::uint32_t> glued_, twin_;   // of the film mesh; `glued_` is kNone at seams
    std::vector<std::optional<Panel>> panels_;  // by label
    std::set<std::pair<std::uint32_t, std::pair<std::size_t, std::size_t>>> rejected_;
};

}  // namespace

std::vector<Panel> cut_into_panels(FilmMesh& film, const CoverageFn& coverage, const PanelOptions& options) {
    if (film.source.empty()) return {};
    return Cutting(film, coverage, options).run();
}

}  // namespace tuft::decal
