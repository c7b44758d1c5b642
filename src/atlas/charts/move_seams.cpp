#include "atlas/charts/move_seams.h"

#include <algorithm>
#include <array>

#include "atlas/charts/meter.h"
#include "atlas/charts/seam_paths.h"
#include "atlas/charts/tasks.h"
#include "atlas/flatten/carry_uvs.h"
#include "atlas/flatten/hull.h"

namespace tuft::atlas {
namespace {

constexpr int kReaches = 2;
constexpr float kReach[kReaches] = {0.25f, 0.08f};  // tried one after the other
constexpr double kLeastSaved = 0.02;  // of a seam's length, for which charts are laid anew
constexpr int kIterations = 8;         // from where a chart lies, most of it well
constexpr double kLeastValue = 0.05;  // saved, over the unit, for laying all of the mesh anew
constexpr double kLeastValueDear = 0.1;  // the same where that takes many seconds
constexpr double kMostWork = 8;       // triangles laid flat, over those of the mesh

struct Trial {
    SeamMove move;
    std::array<std::uint32_t, 2> chart{};               // left and right of the chain
    std::array<std::vector<std::uint32_t>, 2> swept;    // triangles that left each
    std::array<FlatChart, 2> flat;
    Refusals::Change change{};
    bool good = false;

    int n_charts() const { return chart[0] == chart[1] ? 1 : 2; }
};

class Mover {
  public:
    Mover(const mesh::TriangleMesh& mesh, CutMesh& cut, const ChartOptions& options)
        : mesh_(mesh),
          cut_(cut),
          options_(options),
          least_value_(mesh.n_triangles() < kDearMesh ? kLeastValue : kLeastValueDear),
          budget_(cut, options.l2_all),
          patch_(whole_patch(mesh, cut)),
          paths_(patch_, seam_flags(cut), chart_of(mesh, cut)) {
        number_charts(cut);
    }

    bool run(const ProgressFn& progress) {
        Meter meter(progress, "move seams", kMostWork * double(mesh_.n_triangles()));
        bool moved = false;
        for (double work = 0; work < kMostWork * double(mesh_.n_triangles());) {
            std::vector<Trial> trials = next_trials();
            if (trials.empty()) break;
            for (Trial& t : trials) apply(t);
            std::stable_sort(trials.begin(), trials.end(), [&](const Trial& a, const Trial& b) {
                return n_triangles(a) > n_triangles(b);
            });
            run_tasks(trials.size(), [&](std::size_t i) {
                Trial& t = trials[i];
                MeterPart part(meter, double(n_triangles(t)));
                t.good = true;
                // The chart that grows is the one that may not lie flat.
                const int first = t.swept[0].size() > t.swept[1].size();
                for (int k = 0; k < t.n_charts() && t.good; ++k) t.good = lay(t, first ^ k);
                part.finish();
            });
            for (Trial& t : trials) {
                work += double(n_triangles(t));
                conclude(t);
                moved = moved || t.good;
            }
        }
        return moved;
    }

  private:
    static std::vector<std::uint32_t> chart_of(const mesh::TriangleMesh& mesh,
                                               const CutMesh& cut) {
        std::vector<std::uint32_t> chart(mesh.n_triangles());
        for (std::uint32_t c = 0; c < cut.charts.size(); ++c)
            for (const std::uint32_t t : cut.charts[c].mesh.triangles) chart[t] = c;
        return chart;
    }

    std::size_t n_triangles(const Trial& t) const {
        return cut_.charts[t.chart[0]].mesh.faces.size() +
               cut_.charts[t.chart[1]].mesh.faces.size();
    }

    /// Moves of disjoint pairs of charts, those that save most first.
    std::vector<Trial> next_trials() {
        std::vector<Trial> all;
        std::vector<std::uint8_t> seen(paths_.seams().size(), 0);
        for (std::uint32_t h = 0; h < seen.size(); ++h) {
            if (seen[h] || !paths_.starts_chain(h)) continue;
            std::vector<std::uint32_t> chain = paths_.chain_from(h);
            for (const std::uint32_t g : chain) seen[g] = seen[patch_.twin[g]] = 1;
            Trial t;
            t.chart = {paths_.charts()[h / 3], paths_.charts()[patch_.twin[h] / 3]};
            double length = 0;
            for (const std::uint32_t g : chain) length += patch_.length[g];
            const double work = double(n_triangles(t)) / double(mesh_.n_triangles());
            const double least = std::max(kLeastSaved * length, least_value_ * work);
            t.change = {h, cut_.charts[t.chart[0]].version, cut_.charts[t.chart[1]].version};
            int& refused = cut_.refused.moved[t.change];
            for (; refused < kReaches; ++refused) {
                t.move = paths_.shorten(chain, kReach[refused], Corners::move);
                if (t.move.saved > least) break;
            }
            if (refused < kReaches) all.push_back(std::move(t));
        }
        std::stable_sort(all.begin(), all.end(), [](const Trial& a, const Trial& b) {
            return a.move.saved > b.move.saved;
        });
        std::vector<std::uint8_t> used(cut_.charts.size(), 0);
        std::vector<Trial> chosen;
        for (Trial& t : all) {
            if (used[t.chart[0]] || used[t.chart[1]]) continue;
            used[t.chart[0]] = used[t.chart[1]] = 1;
            chosen.push_back(std::move(t));
        }
        return chosen;
    }

    void apply(Trial& t) {
        paths_.move(t.move, t.swept.data());
        glue(t.move.chain, true);
        glue(t.move.path, false);
    }

    void glue(const std::vector<std::uint32_t>& halves, bool glued) {
        for (const std::uint32_t h : halves) {
            const std::uint32_t g = cut_.twin[h];
            cut_.glued[h] = glued ? g : kNone;
            cut_.glued[g] = glued ? h : kNone;
        }
    }

    /// The triangles of one of the charts after the move.
    std::vector<std::uint32_t> triangles_after(const Trial& t, int side) const {
        std::vector<std::uint32_t> kept, gone = t.swept[side], come = t.swept[1 - side];
        if (t.n_charts() == 1) return cut_.charts[t.chart[0]].mesh.triangles;
        std::sort(gone.begin(), gone.end());
        std::sort(come.begin(), come.end());
        const std::vector<std::uint32_t>& own = cut_.charts[t.chart[side]].mesh.triangles;
        std::set_difference(own.begin(), own.end(), gone.begin(), gone.end(),
                            std::back_inserter(kept));
        std::vector<std::uint32_t> after(kept.size() + come.size());
        std::merge(kept.begin(), kept.end(), come.begin(), come.end(), after.begin());
        return kept.empty() ? kept : after;
    }

    /// Lays one of the charts flat as it would be from where it lies.
    bool lay(Trial& t, int side) {
        const FlatChart& old = cut_.charts[t.chart[side]];
        FlatChart& flat = t.flat[side];
        std::vector<std::uint32_t> triangles = triangles_after(t, side);
        if (triangles.empty() || triangles.size() > options_.triangles) return false;
        flat.mesh = make_chart(mesh_, cut_.glued, std::move(triangles), cut_.unit, cut_.place);
        if (!flat.mesh.disk) return false;
        flat.uv = carry_uvs(old, flat.mesh);
        ArapOptions trial = trial_arap(options_);
        trial.iterations = kIterations;
        arap(flat.mesh, flat.uv, trial);
        scale_to_area(flat.mesh, flat.uv);
        const FlatCheck check = check_flat(flat.mesh, flat.uv, options_.gap);
        if (!check.sound() || check.l2 > options_.l2 || check.stretch_999 > options_.largest ||
            check.linf > std::max(options_.worst, old.worst))
            return false;
        flat.worst = check.linf;
        flat.l2 = check.l2;
        if (flat.mesh.area > old.mesh.area && flat.mesh.area > options_.grown) return false;
        const double length = smallest_rectangle(chart_hull(flat)).length;
        return length <= options_.longest ||
               length <= smallest_rectangle(chart_hull(old)).length;
    }

    void conclude(Trial& t) {
        std::vector<const FlatChart*> before, now;
        for (int side = 0; side < t.n_charts(); ++side) {
            before.push_back(&cut_.charts[t.chart[side]]);
            now.push_back(&t.flat[side]);
        }
        t.good = t.good && budget_.allows(before, now);
        if (t.good) {
            budget_.spend(before, now);
            for (int side = 0; side < t.n_charts(); ++side) {
                cut_.charts[t.chart[side]] = std::move(t.flat[side]);
                cut_.charts[t.chart[side]].version = ++cut_.versions;
            }
            return;
        }
        std::swap(t.move.chain, t.move.path);
        paths_.move(t.move);
        glue(t.move.chain, true);
        glue(t.move.path, false);
        ++cut_.refused.moved[t.change];
    }

    const mesh::TriangleMesh& mesh_;
    CutMesh& cut_;
    const ChartOptions& options_;
    double least_value_;
    StretchBudget budget_;
    Patch patch_;
    SeamPaths paths_;
};

}  // namespace

bool move_seams(const mesh::TriangleMesh& mesh, CutMesh& cut, const ChartOptions& options,
                const ProgressFn& progress) {
    return Mover(mesh, cut, options).run(progress);
}

}  // namespace tuft::atlas
