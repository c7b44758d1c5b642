#include "brush/calibration/calibrate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "brush/calibration/compare.h"
#include "core/error.h"
#include "core/system/parallel.h"
#include "core/text/units.h"

namespace tuft::brush {

namespace {

/// What a constant is in proportion to, so that one prior serves brushes of all sizes.
enum class Scale { none, length, side, film };

/// A preset value that the fit changes. v = value over its scale; the search is in log(shift + sign v).
struct Free {
    const char* key;
    double unit;  ///< of preset files, SI
    double Preset::*member;
    Scale scale;
    double shift, sign;
    double mean;    ///< v of the prior's middle
    double spread;  ///< standard deviation of the logarithm
    double lo, hi;  ///< v
};

/// Few enough for some ten measured depths. Only the ratio of side stiffness to bending stiffness shows in a shape, so
/// B0 stays. Means and spreads are those of the shipped round brushes, the spreads doubled. The point of a hair is as
/// thin as a few µm, so its stiffness is known to a factor only. Friction: wet hair has 0.1–0.3 on glaze and 0.3–0.6 on
/// paper, two deviations to both sides.
constexpr std::array kFree = {
    Free{"radius_mm", kMillimetre, &Preset::radius, Scale::length, 0, 1, 0.11, 0.35, 0.02, 0.4},
    Free{"tip_power", 1, &Preset::tip_power, Scale::none, 0, 1, 1.05, 0.2, 0.6, 2.5},
    Free{"alpha", 1, &Preset::alpha, Scale::none, 2, -1, -2, 0.5, -6, 1},
    Free{"beta", 1, &Preset::beta, Scale::none, 1, 1, -0.975, 0.8, -0.995, 0},
    Free{"tip_stiffness", 1, &Preset::tip_stiffness, Scale::none, 0, 1, 5e-6, 1.5, 1e-7, 1e-2},
    Free{"transverse_stiffness_n_m2", 1, &Preset::transverse_stiffness, Scale::side, 0, 1, 80, 0.8, 5, 2000},
    Free{"adhesion_range_mm", kMillimetre, &Preset::adhesion_range, Scale::length, 0, 1, 0.02, 1, 5e-4, 0.06},
    Free{"flatten_contact", 1, &Preset::flatten_contact, Scale::none, 0, 1, 3, 0.5, 0.2, 10},
    Free{"friction_wet", 1, &Preset::friction_wet, Scale::none, 0, 1, 0.25, 0.45, 0.1, 0.6},
};
constexpr std::size_t kN = kFree.size();
constexpr double kFilm = 0.06;  ///< adhesion of the wet film in B0/L³, of the shipped brushes

using Point = std::array<double, kN>;  ///< z
/// A place of the search. With a wet film the free end comes down onto the sheet or stays off it, and the contact
/// length leaps: a brush that draws its film along and one that does not are fitted apart.
struct Place {
    Point z{};
    bool film = true;
};
using Matrix = Eigen::Matrix<double, kN, kN>;
using Vector = Eigen::Matrix<double, kN, 1>;

double scale_of(Scale scale, const Preset& p) {
    switch (scale) {
        case Scale::length:
            return p.length;
        case Scale::side:
            return p.stiffness / std::pow(p.length, 4);
        case Scale::film:
            return p.stiffness / std::pow(p.length, 3);
        case Scale::none:
            break;
    }
    return 1;
}

double search_of(const Free& f, double v) {
    return (std::log(f.shift + f.sign * v) - std::log(f.shift + f.sign * f.mean)) / f.spread;
}

double value_at(const Free& f, double z) {
    const double v = f.sign * (std::exp(f.spread * z) * (f.shift + f.sign * f.mean) - f.shift);
    return std::clamp(v, f.lo, f.hi);
}

struct Bounds {
    double lo, hi;
};
Bounds bounds_of(const Free& f) {
    const double a = search_of(f, f.lo), b = search_of(f, f.hi);
    return {std::min(a, b), std::max(a, b)};
}

Preset preset_at(const Preset& start, const Place& at) {
    Preset p = start;
    for (std::size_t i = 0; i < kN; ++i) p.*kFree[i].member = value_at(kFree[i], at.z[i]) * scale_of(kFree[i].scale, p);
    p.adhesion = at.film ? kFilm * scale_of(Scale::film, p) : 0;
    return p;
}

struct Fit {
    std::vector<double> residual;  ///< over the repeatability, of the measured cells by row
    SweepRow rms;
    double cost = 0, objective = 0;
};

struct Candidate {
    Place at;
    Fit fit;
};

/// The measured table beside the sweeps of a start's relatives.
class Problem {
  public:
    Problem(const Preset& start, std::span<const SweepRow> measured, const CalibrateOptions& options)
        : start_(start),
          measured_(measured),
          options_(options),
          depths_(depths_of(measured)),
          spread_(options.repeatability.value_or(ruler_repeatability(start.length))) {}

    int evaluations() const { return evaluations_; }
    int left() const { return options_.max_evaluations - evaluations_; }
    Preset preset(const Place& at) const { return preset_at(start_, at); }
    std::size_t cells() const {
        std::size_t count = 0;
        for (const SweepRow& row : measured_)
            for (double SweepRow::*column : kSweepColumns) count += !std::isnan(row.*column);
        return count;
    }

    std::vector<Candidate> evaluate(std::span<const Place> points) {
        const std::size_t count = depths_.size();
        std::vector<SweepRow> swept(points.size() * count);
        parallel_for(swept.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k)
                swept[k] = sweep_at(preset(points[k / count]), depths_[k % count]).row;
        });
        evaluations_ += static_cast<int>(points.size());
        report(options_.progress, "fitting",
               std::min(1.0, evaluations_ / static_cast<double>(options_.max_evaluations)));
        std::vector<Candidate> out;
        for (std::size_t i = 0; i < points.size(); ++i)
            out.push_back({points[i], fit_of(points[i].z, std::span(swept).subspan(i * count, count))});
        return out;
    }
    Candidate evaluate(const Place& at) { return std::move(evaluate(std::span(&at, 1)).front()); }

  private:
    Fit fit_of(const Point& z, std::span<const SweepRow> swept) const {
        Fit fit{.rms = rms_difference(swept, measured_)};
        for (const SweepRow& row : measured_) {
            const auto at = std::lower_bound(depths_.begin(), depths_.end(), row.depth) - depths_.begin();
            for (double SweepRow::*column : kSweepColumns) {
                if (std::isnan(row.*column)) continue;
                const double miss = swept[static_cast<std::size_t>(at)].*column - row.*column;
                fit.residual.push_back(miss / (spread_.*column));
            }
        }
        for (double SweepRow::*column : kSweepColumns)
            if (!std::isnan(fit.rms.*column)) fit.cost = std::max(fit.cost, fit.rms.*column / (spread_.*column));
        for (const double r : fit.residual) fit.objective += r * r;
        for (const double x : z) fit.objective += x * x;
        return fit;
    }

    const Preset& start_;
    std::span<const SweepRow> measured_;
    const CalibrateOptions& options_;
    std::vector<double> depths_;
    SweepRow spread_;
    int evaluations_ = 0;
};

/// Point n of an even sequence in the unit cube of kN dimensions, spread over the prior: fractions of n φ^{-i}, φ the
/// root of φ^{N+1} = φ + 1 (Roberts).
Point spread_point(int n, double reach) {
    double root = 1.5;
    for (int i = 0; i < 60; ++i) root = std::pow(1 + root, 1.0 / (kN + 1));
    Point z;
    double step = 1;
    for (std::size_t i = 0; i < kN; ++i) {
        step /= root;
        const double u = std::fmod(0.5 + n * step, 1.0);
        const Bounds b = bounds_of(kFree[i]);
        z[i] = std::clamp(reach * (2 * u - 1), b.lo, b.hi);
    }
    return z;
}

/// Jacobian of the residuals by z, by differences away from the nearer bound.
Eigen::MatrixXd jacobian(Problem& problem, const Candidate& at) {
    constexpr double kProbe = 0.03;
    std::vector<Place> probes(kN, at.at);
    std::array<double, kN> step;
    for (std::size_t i = 0; i < kN; ++i) {
        const Bounds b = bounds_of(kFree[i]);
        step[i] = at.at.z[i] > 0.5 * (b.lo + b.hi) ? -kProbe : kProbe;
        probes[i].z[i] += step[i];
    }
    const std::vector<Candidate> probed = problem.evaluate(probes);
    Eigen::MatrixXd j(at.fit.residual.size(), kN);
    for (std::size_t i = 0; i < kN; ++i)
        for (std::size_t k = 0; k < at.fit.residual.size(); ++k)
            j(k, i) = (probed[i].fit.residual[k] - at.fit.residual[k]) / step[i];
    return j;
}

/// Least squares from `at` for at most `steps` steps. A constant at its bound that would pass it is fixed there for the
/// step.
Candidate descend(Problem& problem, Candidate at, int steps) {
    double damping = 0.1;
    for (int s = 0; s < steps && problem.left() > static_cast<int>(kN); ++s) {
        const Eigen::MatrixXd j = jacobian(problem, at);
        const Eigen::Map<const Eigen::VectorXd> r(at.fit.residual.data(), j.rows());
        const Eigen::Map<const Vector> z(at.at.z.data());
        Matrix normal = j.transpose() * j + Matrix::Identity();
        Vector slope = j.transpose() * r + z;
        for (std::size_t i = 0; i < kN; ++i) {
            const Bounds b = bounds_of(kFree[i]);
            if ((at.at.z[i] <= b.lo && slope[i] > 0) || (at.at.z[i] >= b.hi && slope[i] < 0)) {
                normal.row(i).setZero();
                normal.col(i).setZero();
                normal(i, i) = 1;
                slope[i] = 0;
            }
        }
        const double before = at.fit.objective;
        bool better = false;
        for (int attempt = 0; attempt < 4 && !better && problem.left() > 0; ++attempt) {
            Matrix damped = normal;
            damped.diagonal() *= 1 + damping;
            const Vector step = -damped.llt().solve(slope);
            Place next = at.at;
            for (std::size_t i = 0; i < kN; ++i) {
                const Bounds b = bounds_of(kFree[i]);
                next.z[i] = std::clamp(at.at.z[i] + std::clamp(step[i], -1.5, 1.5), b.lo, b.hi);
            }
            Candidate tried = problem.evaluate(next);
            better = tried.fit.objective < before;
            damping = std::clamp(damping * (better ? 0.3 : 6), 1e-3, 1e3);
            if (better) at = std::move(tried);
        }
        if (!better || at.fit.objective > before * (1 - 1e-3)) break;
    }
    return at;
}

bool is_better(const Candidate& a, const Candidate& b) {
    return a.fit.objective < b.fit.objective;
}

/// The best of many places, then of their valleys: a third of the budget looks round, a third follows the best few for
/// two steps, the rest follows the three best to the end.
Candidate search(Problem& problem, int budget) {
    constexpr std::size_t kKept = 6, kFollowed = 3;
    constexpr int kFirstSteps = 2, kSteps = 20;
    std::vector<Place> points;
    const int looks = std::max(24, budget / 3) / 2;
    for (int n = 0; n < looks; ++n)
        for (const bool film : {false, true}) points.push_back({n > 0 ? spread_point(n, 1.7) : Point{}, film});
    std::vector<Candidate> found = problem.evaluate(points);
    const auto keep = [&](std::size_t count) {
        std::stable_sort(found.begin(), found.end(), is_better);
        found.resize(std::min(count, found.size()));
    };
    keep(kKept);
    for (Candidate& c : found) c = descend(problem, std::move(c), kFirstSteps);
    keep(kFollowed);
    for (Candidate& c : found) c = descend(problem, std::move(c), kSteps);
    keep(1);
    return std::move(found.front());
}

void add_uncertainty(Problem& problem, const Preset& start, const Candidate& best, Calibration& out) {
    const Eigen::MatrixXd j = jacobian(problem, best);
    const Eigen::VectorXd values = j.jacobiSvd().singularValues();
    out.singular.assign(values.data(), values.data() + values.size());
    double squares = 0;
    for (const double r : best.fit.residual) squares += r * r;
    const double known = static_cast<double>((values.array() > 1).count());
    const double free = std::max(1.0, static_cast<double>(problem.cells()) - known);
    const double noise = std::max(1.0, squares / free);
    const Matrix covariance = (j.transpose() * j / noise + Matrix::Identity()).inverse();
    constexpr double kNinetyFive = 1.96;
    for (std::size_t i = 0; i < kN; ++i) {
        const Free& f = kFree[i];
        const double sigma = std::sqrt(covariance(i, i)), scale = scale_of(f.scale, start) / f.unit;
        const double a = value_at(f, best.at.z[i] - kNinetyFive * sigma),
                     b = value_at(f, best.at.z[i] + kNinetyFive * sigma);
        out.constants.push_back({f.key, value_at(f, best.at.z[i]) * scale, std::min(a, b) * scale,
                                 std::max(a, b) * scale, std::clamp(1 - sigma, 0.0, 1.0)});
    }
}

}  // namespace

SweepRow ruler_repeatability(double length) {
    const double size = length / 30e-3;
    return {0, size * 1.4e-3, size * 0.5e-3, size * 0.7e-3};
}

Calibration calibrate(const Preset& start, std::span<const SweepRow> measured, const CalibrateOptions& options) {
    if (measured.size() < 4)
        throw Error(Message("calibration needs at least 4 measured depths, there are {}", measured.size()));
    check_preset(start, start.name);
    if (is_foam(start) || has_broad_side(start) || start.spines > 1 || start.geometry)
        throw Error(start.name, "is not a round tuft of hair, the only kind that can be fitted");
    Problem problem(start, measured, options);
    const Candidate best = search(problem, std::max(options.max_evaluations, 60));
    Calibration out{
        .preset = problem.preset(best.at), .rms = best.fit.rms, .cost = best.fit.cost, .objective = best.fit.objective};
    add_uncertainty(problem, start, best, out);
    out.evaluations = problem.evaluations();
    return out;
}

}  // namespace tuft::brush
