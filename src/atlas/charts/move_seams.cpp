#include "atlas/charts/move_seams.h"

#include <algorithm>
#include <array>
#include <map>
#include <mutex>
#include <numeric>
#include <set>
#include <utility>

#include "atlas/charts/phase_progress.h"
#include "atlas/charts/tasks.h"
#include "atlas/charts/transfer_uvs.h"
#include "atlas/flatten/hull.h"
#include "atlas/seams/seam_paths.h"

namespace tuft::atlas {
namespace {

constexpr int kReaches = 2;
constexpr float kReach[kReaches] = {0.25f, 0.08f};  // tried one after the other
constexpr double kLeastSaved = 0.02;                // of a seam's length, for which charts are laid anew
constexpr int kIterations = 8;                      // from where a chart lies, most of it well
constexpr double kLeastValue = 0.05;                // saved, over the unit, for flattening all of the mesh anew
constexpr double kLeastValueLarge = 0.1;            // the same where that takes many seconds
constexpr double kMostWork = 8;                     // triangles laid flat, over those of the mesh

struct Trial {
    SeamMove move;
    std::array<std::uint32_t, 2> chart{};             // left and right of the chain
    std::array<std::vector<std::uint32_t>, 2> swept;  // triangles that left each
    std::array<FlatChart, 2> flat;
    RejectedChanges::Change change{};
    bool good = false;

    int n_charts() const { return chart[0] == chart[1] ? 1 : 2; }
};

class Mover {
  public:
    Mover(const mesh::TriangleMesh& mesh, CutMesh& cut, const ChartOptions& options)
        : mesh_(mesh),
          cut_(cut),
          options_(options),
          least_value_(mesh.n_triangles() < kBlockwiseThreshold ? kLeastValue : kLeastValueLarge),
          n_represented_(n_represented(mesh, cut)),
          budget_(cut, options.l2_all),
          paths_(whole_patch(mesh, cut), seam_flags(cut), chart_of(mesh, cut)) {
        number_charts(cut);
    }

    bool run(const ProgressFn& progress) {
        PhaseProgress phase(progress, "move seams", kMostWork * double(mesh_.n_triangles()));
        bool moved = false;
        for (double work = 0; work < kMostWork * double(mesh_.n_triangles());) {
            std::vector<Trial> trials = next_trials();
            if (trials.empty()) break;
            for (Trial& t : trials) apply(t);
            std::stable_sort(trials.begin(), trials.end(),
                             [&](const Trial& a, const Trial& b) { return n_triangles(a) > n_triangles(b); });
            std::vector<double> size(trials.size());
            for (std::size_t i = 0; i < size.size(); ++i) {
                work += double(n_triangles(trials[i]));
                size[i] = flattened(trials[i]);
            }
            // Each is concluded as soon as those before it are, so that few are in memory.
            std::mutex mutex;
            std::vector<std::uint8_t> done(trials.size(), 0);
            std::size_t next = 0;
            const auto weight = [&](std::size_t i) { return size[i]; };
            run_tasks_within(trials.size(), flattened_at_once(mesh_.n_triangles()), weight, [&](std::size_t i) {
                Trial& t = trials[i];
                TaskProgress part(phase, double(n_triangles(t)));
                t.good = true;
                // The chart that grows is the one that may not lie flat.
                const int first = t.swept[0].size() > t.swept[1].size();
                for (int k = 0; k < t.n_charts() && t.good; ++k) t.good = flatten_side(t, first ^ k);
                part.finish();
                const std::scoped_lock lock(mutex);
                for (done[i] = 1; next < trials.size() && done[next]; ++next) {
                    conclude(trials[next]);
                    moved = moved || trials[next].good;
                    trials[next] = {};
                }
            });
        }
        return moved;
    }

  private:
    static double n_represented(const mesh::TriangleMesh& mesh, const CutMesh& cut) {
        return cut.copies.empty() ? double(mesh.n_triangles())
                                  : std::accumulate(cut.copies.begin(), cut.copies.end(), 0.0);
    }

    static std::vector<std::uint32_t> chart_of(const mesh::TriangleMesh& mesh, const CutMesh& cut) {
        std::vector<std::uint32_t> chart(mesh.n_triangles());
        for (std::uint32_t c = 0; c < cut.charts.size(); ++c)
            for (const std::uint32_t t : cut.charts[c].mesh.triangles) chart[t] = c;
        return chart;
    }

    std::size_t n_triangles(const Trial& t) const {
        return cut_.charts[t.chart[0]].mesh.faces.size() + cut_.charts[t.chart[1]].mesh.faces.size();
    }

    /// Triangles that a trial lays flat at once: one chart after the other, of a large one a part.
    double flattened(const Trial& t) const {
        double most = 0;
        for (int side = 0; side < t.n_charts(); ++side) {
            const std::size_t n = cut_.charts[t.chart[side]].mesh.faces.size();
            const std::size_t come = t.n_charts() == 1 ? n : t.swept[1 - side].size();
            most = std::max(most,
                            n > kLargeChart ? double(n) / 4 + double(count_faces_around(n, come)) : double(n + come));
        }
        return most;
    }

    /// The newest version of each chart and those next to it.
    std::vector<std::uint32_t> newest_versions() const {
        std::vector<std::uint32_t> newest(cut_.charts.size());
        for (std::size_t c = 0; c < newest.size(); ++c) newest[c] = cut_.charts[c].version;
        for (std::uint32_t h = 0; h < paths_.seams().size(); ++h) {
            if (!paths_.seams()[h] || paths_.twin(h) == kNone) continue;
            std::uint32_t& own = newest[paths_.charts()[h / 3]];
            own = std::max(own, cut_.charts[paths_.charts()[paths_.twin(h) / 3]].version);
        }
        return newest;
    }

    /// Where a seam is and shall be.
    static std::vector<std::uint32_t> places(const SeamMove& move) {
        std::vector<std::uint32_t> places(move.chain);
        places.insert(places.end(), move.path.begin(), move.path.end());
        return places;
    }

    /// A chain and where it may move to.
    struct Candidate {
        Trial trial;
        std::vector<std::uint32_t> chain;
        int* rejected = nullptr;  // reaches that were tried in vain
        RejectedChanges::Change around;
    };

    void search(Candidate& c, PathSearch& search) const {
        if (const auto known = found_.find(c.around); known != found_.end() && known->second.rejected == *c.rejected) {
            c.trial.move = known->second.move;
            return;
        }
        double length = 0;
        for (const std::uint32_t g : c.chain) length += paths_.length(g);
        const double work = double(n_triangles(c.trial)) / n_represented_;
        const double least = std::max(kLeastSaved * length, least_value_ * work);
        for (; *c.rejected < kReaches; ++*c.rejected) {
            c.trial.move = paths_.shorten(c.chain, kReach[*c.rejected], Corners::move, search);
            if (c.trial.move.saved > least && !refused_.contains(places(c.trial.move))) break;
        }
    }

    /// Moves of disjoint pairs of charts, those that save most first.
    std::vector<Trial> next_trials() {
        // A path found before is still the shortest while the charts beside it and all around them
        // are as they were.
        const std::vector<std::uint32_t> newest = newest_versions();
        std::vector<Candidate> candidates;
        std::vector<std::uint8_t> seen(paths_.seams().size(), 0);
        for (std::uint32_t h = 0; h < seen.size(); ++h) {
            if (seen[h] || !paths_.starts_chain(h)) continue;
            Candidate c;
            c.chain = paths_.chain_from(h);
            for (const std::uint32_t g : c.chain) seen[g] = seen[paths_.twin(g)] = 1;
            c.trial.chart = {paths_.charts()[h / 3], paths_.charts()[paths_.twin(h) / 3]};
            c.trial.change = {h, cut_.charts[c.trial.chart[0]].version, cut_.charts[c.trial.chart[1]].version};
            c.rejected = &cut_.rejected.moved[c.trial.change];
            c.around = {h, newest[c.trial.chart[0]], newest[c.trial.chart[1]]};
            candidates.push_back(std::move(c));
        }
        while (searches_.size() < static_cast<std::size_t>(thread_count())) searches_.push_back(paths_.make_search());
        run_tasks_by_worker(candidates.size(),
                            [&](std::size_t i, std::size_t worker) { search(candidates[i], searches_[worker]); });
        std::map<RejectedChanges::Change, Found> found;
        std::vector<Trial> all;
        for (Candidate& c : candidates) {
            if (*c.rejected == kReaches) continue;
            found[c.around] = {*c.rejected, c.trial.move};
            all.push_back(std::move(c.trial));
        }
        found_ = std::move(found);
        std::stable_sort(all.begin(), all.end(),
                         [](const Trial& a, const Trial& b) { return a.move.saved > b.move.saved; });
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

    /// Triangles that one of the charts takes over, ascending.
    std::vector<std::uint32_t> taken(const Trial& t, int side) const {
        if (t.n_charts() == 1) return change_sides(t);
        std::vector<std::uint32_t> come = t.swept[1 - side];
        std::sort(come.begin(), come.end());
        return come;
    }

    /// Where both sides of the chain are one chart: the triangles between where the seam was and
    /// where it is, which are all but the largest of the parts that the two leave.
    std::vector<std::uint32_t> change_sides(const Trial& t) const {
        const std::vector<std::uint32_t>& own = cut_.charts[t.chart[0]].mesh.triangles;
        std::vector<std::uint32_t> chain(t.move.chain);
        for (const std::uint32_t h : t.move.chain) chain.push_back(cut_.twin[h]);
        std::sort(chain.begin(), chain.end());
        std::vector<std::uint8_t> seen(own.size(), 0);
        std::vector<std::uint32_t> largest, others;
        for (std::size_t i = 0; i < own.size(); ++i) {
            if (seen[i]) continue;
            seen[i] = 1;
            std::vector<std::uint32_t> part{own[i]};
            for (std::size_t k = 0; k < part.size(); ++k)
                for (std::uint32_t h = 3 * part[k]; h < 3 * part[k] + 3; ++h) {
                    const std::uint32_t g = cut_.glued[h];
                    if (g == kNone || std::binary_search(chain.begin(), chain.end(), h)) continue;
                    const auto at = std::lower_bound(own.begin(), own.end(), g / 3) - own.begin();
                    if (std::exchange(seen[static_cast<std::size_t>(at)], 1)) continue;
                    part.push_back(g / 3);
                }
            if (part.size() > largest.size()) std::swap(part, largest);
            others.insert(others.end(), part.begin(), part.end());
        }
        std::sort(others.begin(), others.end());
        return others;
    }

    /// The triangles of one of the charts after the move, of which it has taken some over.
    std::vector<std::uint32_t> triangles_after(const Trial& t, int side, const std::vector<std::uint32_t>& come) const {
        const std::vector<std::uint32_t>& own = cut_.charts[t.chart[side]].mesh.triangles;
        if (t.n_charts() == 1) return own;
        std::vector<std::uint32_t> kept, gone = t.swept[side];
        std::sort(gone.begin(), gone.end());
        std::set_difference(own.begin(), own.end(), gone.begin(), gone.end(), std::back_inserter(kept));
        std::vector<std::uint32_t> after(kept.size() + come.size());
        std::merge(kept.begin(), kept.end(), come.begin(), come.end(), after.begin());
        return kept.empty() ? kept : after;
    }

    /// Lays one of the charts flat as it would be from where it lies.
    bool flatten_side(Trial& t, int side) {
        const FlatChart& old = cut_.charts[t.chart[side]];
        FlatChart& flat = t.flat[side];
        const std::vector<std::uint32_t> come = taken(t, side);
        std::vector<std::uint32_t> triangles = triangles_after(t, side, come);
        if (triangles.empty() || triangles.size() > options_.triangles) return false;
        flat.mesh = make_chart(mesh_, cut_.glued, std::move(triangles), cut_.unit, cut_.place);
        if (!flat.mesh.disk) return false;
        if (flat.mesh.area > old.mesh.area && flat.mesh.area > options_.grown) return false;
        const bool large = flat.mesh.faces.size() > kLargeChart;
        flat.uv =
            large ? transfer_uvs(old, cut_.charts[t.chart[1 - side]], come, flat.mesh) : unfold_uvs(old, flat.mesh);
        // A large chart that only gave triangles away is left as it lies, no less flat than before.
        if (!large || !come.empty()) {
            ArapOptions trial = trial_arap(options_);
            trial.iterations = kIterations;
            arap(flat.mesh, flat.uv, trial, large ? faces_around(flat.mesh, come) : std::vector<std::uint32_t>{});
        }
        scale_to_area(flat.mesh, flat.uv);
        const FlatCheck check = check_flat(flat.mesh, flat.uv, options_.gap);
        if (!check.sound() || check.l2 > options_.l2 || check.stretch_999 > options_.largest ||
            check.linf > std::max(options_.worst, old.worst))
            return false;
        flat.worst = check.linf;
        flat.l2 = check.l2;
        flat.copies = old.copies;
        const double length = smallest_rectangle(chart_hull(flat)).length;
        return length <= options_.longest || length <= smallest_rectangle(chart_hull(old)).length;
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
        // A large chart is laid anew around the move only, which fails there again whatever changes
        // elsewhere.
        if (std::max(t.flat[0].mesh.faces.size(), t.flat[1].mesh.faces.size()) > kLargeChart)
            refused_.insert(places(t.move));
        std::swap(t.move.chain, t.move.path);
        paths_.move(t.move);
        glue(t.move.chain, true);
        glue(t.move.path, false);
        ++cut_.rejected.moved[t.change];
    }

    const mesh::TriangleMesh& mesh_;
    CutMesh& cut_;
    const ChartOptions& options_;
    double least_value_;
    double n_represented_;  // triangles of the mesh and of what equals its parts
    StretchBudget budget_;
    SeamPaths paths_;
    std::vector<PathSearch> searches_;  // of each thread

    struct Found {
        int rejected = 0;  // how often before
        SeamMove move;
    };
    std::map<RejectedChanges::Change, Found> found_;  // in the last round
    std::set<std::vector<std::uint32_t>> refused_;    // moves of large charts
};

}  // namespace

bool move_seams(const mesh::TriangleMesh& mesh, CutMesh& cut, const ChartOptions& options, const ProgressFn& progress) {
    return Mover(mesh, cut, options).run(progress);
}

}  // namespace tuft::atlas
