#include "atlas/charts/merge.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "atlas/charts/phase_progress.h"
#include "atlas/charts/tasks.h"
#include "atlas/charts/transfer_uvs.h"
#include "atlas/flatten/hull.h"
#include "atlas/flatten/rigid_motion.h"
#include "atlas/seams/seam_graph.h"

namespace tuft::atlas {
namespace {

constexpr std::size_t kManyTriangles = 4096;  // from which crossings are looked for in each step
constexpr double kNearEnds = 1.0 / 32;        // of the border's length
constexpr double kAsLong = 1.05;              // as another
constexpr double kAtFirst = 1.1;              // beyond limits of form, before a chart is flattened
constexpr double kUnderway = 1.01;            // the same after a step of it
constexpr double kNearEndsUnderway = 1.0 / 64;
constexpr int kSettled = 4;       // steps after which the rest of a crossing stays
constexpr double kUsualWork = 5;  // triangles in all trials, over those of the mesh

/// One pair of charts to be tried along one chain.
struct Trial {
    std::uint32_t chain = kNone, a = kNone, b = kNone;  // chain and charts of the graph
    double rank = 0;
    std::vector<std::uint32_t> halves;  // seams to be glued, half-edges of the mesh
    std::size_t n_chain = 0;            // how many of them are the chain's own
    bool merged = false;
    FlatChart flat;
};

Vec2 corner_uv(const FlatChart& chart, std::uint32_t h) {
    const std::uint32_t l = local_half(chart.mesh.triangles, h);
    return chart.uv[chart.mesh.faces[l / 3][l % 3]];
}

/// The motion of b's UVs that brings the two sides of the chain together best, and the
/// root mean square distance that is left.
std::pair<RigidMotion, double> fit_sides(const FlatChart& a, const FlatChart& b, std::span<const std::uint32_t> twin,
                                         const Trial& trial) {
    std::vector<std::array<Vec2, 2>> pairs;
    for (std::size_t i = 0; i < trial.n_chain; ++i) {
        std::uint32_t h = trial.halves[i], g = twin[h];
        if (local_half(a.mesh.triangles, h) == kNone) std::swap(h, g);
        pairs.push_back({corner_uv(a, h), corner_uv(b, next_half(g))});
        pairs.push_back({corner_uv(a, next_half(h)), corner_uv(b, g)});
    }
    const RigidMotion m = fit_motion(pairs);
    double fit_error = 0;
    for (const auto& [p, q] : pairs) fit_error += glm::dot(p - m(q), p - m(q));
    return {m, std::sqrt(fit_error / double(pairs.size()))};
}

/// Both charts where they lie, b moved, and the corners that they share in the middle.
std::vector<Vec2> side_by_side(const FlatChart& a, const FlatChart& b, const RigidMotion& motion,
                               const ChartMesh& both) {
    std::vector<Vec2> uv(both.n_vertices(), Vec2(0));
    std::vector<std::uint32_t> count(both.n_vertices(), 0);
    std::size_t ia = 0, ib = 0;
    for (std::size_t f = 0; f < both.faces.size(); ++f) {
        const bool in_a = ia < a.mesh.triangles.size() && a.mesh.triangles[ia] == both.triangles[f];
        const FlatChart& from = in_a ? a : b;
        const auto& face = from.mesh.faces[in_a ? ia++ : ib++];
        for (int k = 0; k < 3; ++k) {
            const Vec2& p = from.uv[face[k]];
            uv[both.faces[f][k]] += in_a ? p : motion(p);
            ++count[both.faces[f][k]];
        }
    }
    for (std::size_t v = 0; v < count.size(); ++v) uv[v] /= double(count[v]);
    return uv;
}

/// How compact a chart is.
struct Form {
    double fill = 1;    // its area over that of its hull
    double length = 0;  // of its smallest rectangle
};

Form form_of(const FlatChart& chart) {
    const std::vector<Vec2> hull = chart_hull(chart);
    double area = 0;
    for (std::size_t i = 1; i + 1 < hull.size(); ++i) {
        const Vec2 p = hull[i] - hull[0], q = hull[i + 1] - hull[0];
        area += 0.5 * (p.x * q.y - p.y * q.x);
    }
    return {area > 0 ? chart.mesh.area / area : 1, smallest_rectangle(hull).length};
}

class Merger {
  public:
    Merger(const mesh::TriangleMesh& mesh, CutMesh& cut, const ChartOptions& options, const MergeOptions& merge)
        : mesh_(mesh),
          cut_(cut),
          options_(options),
          merge_(merge),
          budget_(cut, options.l2_all),
          patch_(whole_patch(mesh, cut)),
          graph_(patch_, seam_flags(cut)),
          chart_at_(graph_.n_charts_at_first(), kNone),
          refused_(graph_.n_edges(), 0) {
        for (std::uint32_t c = 0; c < cut.charts.size(); ++c)
            chart_at_[graph_.chart_of(cut.charts[c].mesh.triangles[0])] = c;
        number_charts(cut);
    }

    void run(const ProgressFn& progress) {
        PhaseProgress phase(progress, "merge", kUsualWork * double(mesh_.n_triangles()));
        for (int round = 0; round < 200; ++round) {
            std::vector<Trial> trials = next_trials();
            if (trials.empty()) break;
            for (const Trial& t : trials) set_glued(t, true);
            const std::vector<std::uint32_t> order = largest_first(trials);
            const auto size = [&](std::size_t i) { return double(n_triangles(trials[order[i]])); };
            run_tasks_within(order.size(), flattened_at_once(mesh_.n_triangles()), size, [&](std::size_t i) {
                Trial& t = trials[order[i]];
                TaskProgress part(phase, double(n_triangles(t)));
                attempt(t, part);
                part.finish();
            });
            for (Trial& t : trials) conclude(t);
        }
        std::erase_if(cut_.charts, [](const FlatChart& c) { return c.mesh.faces.empty(); });
    }

  private:
    void set_glued(const Trial& t, bool glued) {
        for (const std::uint32_t h : t.halves) {
            const std::uint32_t g = cut_.twin[h];
            cut_.glued[h] = glued ? g : kNone;
            cut_.glued[g] = glued ? h : kNone;
        }
    }

    /// Disjoint pairs in the order of rank.
    std::vector<Trial> next_trials() {
        const std::vector<SeamGraph::Chain> chains = graph_.chains();
        std::vector<double> perimeter(cut_.charts.size(), 0);
        for (const SeamGraph::Chain& c : chains) {
            perimeter[chart_at_[c.chart_a]] += c.length;
            perimeter[chart_at_[c.chart_b]] += c.length;
        }
        std::vector<Trial> all;
        for (const SeamGraph::Chain& c : chains) {
            if (c.chart_a == c.chart_b || c.closed || refused_[c.id]) continue;
            if (RejectedChanges::count(cut_.rejected.merged, change(c.id, c.chart_a, c.chart_b)) > 0) {
                refused_[c.id] = 1;
                continue;
            }
            const double area_a = graph_.moments(c.chart_a).area;
            const double area_b = graph_.moments(c.chart_b).area;
            if (area_a + area_b > merge_.largest_chart) continue;
            if (graph_.n_triangles(c.chart_a) + graph_.n_triangles(c.chart_b) > options_.triangles) continue;
            Trial t;
            t.chain = c.id;
            t.a = c.chart_a;
            t.b = c.chart_b;
            t.rank = c.length / std::max(1e-300, std::min(perimeter[chart_at_[t.a]], perimeter[chart_at_[t.b]]));
            all.push_back(std::move(t));
        }
        std::stable_sort(all.begin(), all.end(), [](const Trial& x, const Trial& y) { return x.rank > y.rank; });
        std::vector<std::uint8_t> used(cut_.charts.size(), 0);
        std::vector<Trial> chosen;
        for (Trial& t : all) {
            if (used[chart_at_[t.a]] || used[chart_at_[t.b]]) continue;
            used[chart_at_[t.a]] = used[chart_at_[t.b]] = 1;
            t.halves = graph_.half_edges(t.chain);
            t.n_chain = t.halves.size();
            const std::vector<std::uint32_t> slit = graph_.glued_with(t.chain);
            t.halves.insert(t.halves.end(), slit.begin(), slit.end());
            chosen.push_back(std::move(t));
        }
        return chosen;
    }

    std::size_t n_triangles(const Trial& t) const {
        return cut_.charts[chart_at_[t.a]].mesh.faces.size() + cut_.charts[chart_at_[t.b]].mesh.faces.size();
    }

    std::vector<std::uint32_t> largest_first(const std::vector<Trial>& trials) const {
        std::vector<std::uint32_t> order(trials.size());
        std::iota(order.begin(), order.end(), 0u);
        std::stable_sort(order.begin(), order.end(), [&](std::uint32_t x, std::uint32_t y) {
            return n_triangles(trials[x]) > n_triangles(trials[y]);
        });
        return order;
    }

    bool lies_flat(const FlatCheck& check, double worst) const {
        return check.sound() && check.l2 <= options_.l2 && check.stretch_999 <= options_.largest && check.linf <= worst;
    }

    /// Flattens the two charts as one from where they lie now.
    void attempt(Trial& t, TaskProgress& part) {
        const FlatChart& a = cut_.charts[chart_at_[t.a]];
        const FlatChart& b = cut_.charts[chart_at_[t.b]];
        const auto [motion, fit_error] = fit_sides(a, b, cut_.twin, t);
        double length = 0;
        for (std::size_t i = 0; i < t.n_chain; ++i) length += patch_.length[t.halves[i]];
        if (fit_error > merge_.largest_gap * length) return;

        std::vector<std::uint32_t> triangles(a.mesh.triangles.size() + b.mesh.triangles.size());
        std::merge(a.mesh.triangles.begin(), a.mesh.triangles.end(), b.mesh.triangles.begin(), b.mesh.triangles.end(),
                   triangles.begin());
        t.flat.mesh = make_chart(mesh_, cut_.glued, std::move(triangles), cut_.unit, cut_.place);
        ChartMesh& mesh = t.flat.mesh;
        if (!mesh.disk) return;
        std::vector<std::uint32_t> anew;        // faces that are flattened anew; none: all
        if (mesh.faces.size() > kLargeChart) {  // a start from which few steps lead on
            const bool grows = a.mesh.triangles.size() < b.mesh.triangles.size();  // b, by a
            const FlatChart &kept = grows ? b : a, &taken = grows ? a : b;
            t.flat.uv = transfer_uvs(kept, taken, taken.mesh.triangles, mesh);
            anew = faces_around(mesh, taken.mesh.triangles);
        } else {
            t.flat.uv = side_by_side(a, b, motion, mesh);
        }

        // Charts that lie one over the other stay so; only near the ends of the chain do small
        // crossings go away. That is worth a search where flattening is costly.
        if (mesh.faces.size() > kManyTriangles && crosses_itself(mesh, t.flat.uv, 0, kNearEnds)) return;
        // Nor does flattening change much of the shape.
        const std::array<Form, 2> parts{form_of(a), form_of(b)};
        scale_to_area(mesh, t.flat.uv);
        if (misshapen(form_of(t.flat), parts, kAtFirst)) return;
        const double flat_enough = 1 + 0.1 * (options_.l2 - 1);
        FlatCheck check = check_flat(mesh, t.flat.uv, options_.gap);
        if (!check.sound() || check.l2 > flat_enough) {
            ArapOptions trial = trial_arap(options_);
            trial.on_step = [&] { part.advance(double(mesh.faces.size()) / trial.iterations); };
            bool vain = false;
            trial.should_stop = [&](int steps) { return vain = should_stop(t.flat, parts, steps); };
            arap(mesh, t.flat.uv, trial, anew);
            if (vain) return;
            scale_to_area(mesh, t.flat.uv);
            check = check_flat(mesh, t.flat.uv, options_.gap);
        }
        if (!lies_flat(check, std::max({options_.worst, a.worst, b.worst}))) return;
        t.flat.worst = check.linf;
        t.flat.l2 = check.l2;
        t.flat.copies = a.copies;
        t.merged = !misshapen(form_of(t.flat), parts, 1);
    }

    /// Whether a chart of two parts that is being flattened will have to be rejected: nearly all its
    /// motion is in the first steps.
    bool should_stop(const FlatChart& chart, const std::array<Form, 2>& parts, int steps) const {
        if (chart.mesh.faces.size() <= kManyTriangles) return false;
        if (misshapen(form_of(chart), parts, kUnderway)) return true;
        if (chart.mesh.faces.size() <= kLargeChart) return false;
        return crosses_itself(chart.mesh, chart.uv, 0, steps < kSettled ? kNearEndsUnderway : 0);
    }

    /// Whether a chart of two parts is too ragged or too long, by more than `slack`.
    bool misshapen(const Form& whole, const std::array<Form, 2>& parts, double slack) const {
        if (slack * whole.fill < std::min({merge_.least_fill, parts[0].fill, parts[1].fill})) return true;
        // Two that lie beside each other may be as long as the longer of them.
        const double longer = std::max(parts[0].length, parts[1].length);
        return whole.length > slack * std::max(merge_.longest, kAsLong * longer);
    }

    RejectedChanges::Change change(std::uint32_t chain, std::uint32_t a, std::uint32_t b) const {
        std::uint32_t first = kNone;
        for (const std::uint32_t h : graph_.half_edges(chain)) first = std::min(first, h);
        const auto [v, w] = std::minmax(cut_.charts[chart_at_[a]].version, cut_.charts[chart_at_[b]].version);
        return {first, v, w};
    }

    void conclude(Trial& t) {
        const std::array<const FlatChart*, 2> before{&cut_.charts[chart_at_[t.a]], &cut_.charts[chart_at_[t.b]]};
        const std::array<const FlatChart*, 1> now{&t.flat};
        if (!t.merged || !budget_.allows(before, now)) {
            set_glued(t, false);
            refused_[t.chain] = 1;
            ++cut_.rejected.merged[change(t.chain, t.a, t.b)];
            return;
        }
        const std::uint32_t ca = chart_at_[t.a], cb = chart_at_[t.b];
        budget_.spend(before, now);
        graph_.glue(t.chain);
        cut_.charts[ca] = std::move(t.flat);
        cut_.charts[ca].version = ++cut_.versions;
        cut_.charts[cb] = {};
        chart_at_[t.a] = chart_at_[t.b] = kNone;
        chart_at_[graph_.chart_of(cut_.charts[ca].mesh.triangles[0])] = ca;
    }

    const mesh::TriangleMesh& mesh_;
    CutMesh& cut_;
    const ChartOptions& options_;
    const MergeOptions& merge_;
    StretchBudget budget_;
    Patch patch_;
    SeamGraph graph_;
    std::vector<std::uint32_t> chart_at_;  // by the graph's number
    std::vector<std::uint8_t> refused_;    // by chain
};

}  // namespace

void merge_charts(const mesh::TriangleMesh& mesh, CutMesh& cut, const ChartOptions& options, const MergeOptions& merge,
                  const ProgressFn& progress) {
    Merger(mesh, cut, options, merge).run(progress);
}

}  // namespace tuft::atlas
