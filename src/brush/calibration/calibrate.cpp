#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "brush/calibration/compare.h"
#include "brush/calibration/sweep.h"
#include "core/error.h"
#include "core/system/parallel.h"

namespace tuft::brush {

namespace {

/// A preset value the fit may change, searched on a logarithmic scale of `shift` + value.
struct Free {
    double Preset::*member;
    double lo, hi;  ///< SI
    double shift;   ///< makes the value positive
    double first;   ///< first step of the search, relative
};

/// Few enough for some ten measured depths. Only the ratio of side stiffness to bending
/// stiffness shows in a shape, so B0 stays.
constexpr std::array kFree = {
    Free{&Preset::radius, 0.5e-3, 30e-3, 0, 0.15},
    Free{&Preset::tip_power, 0.6, 2.5, 0, 0.2},
    Free{&Preset::alpha, -6, 1, -2, 0.3},    // of 2 - α
    Free{&Preset::beta, -0.995, 0, 1, 0.4},  // of 1 + β
    Free{&Preset::tip_stiffness, 1e-6, 1e-1, 0, 0.8},
    Free{&Preset::transverse_stiffness, 200, 2e5, 0, 0.5},
    Free{&Preset::adhesion_range, 1e-5, 2e-3, 0, 0.8},
    Free{&Preset::flatten_contact, 0.05, 10, 0, 0.4},
    Free{&Preset::friction_wet, 0.02, 1.2, 0, 0.3},
};

double to_search(const Free& f, const Preset& p) {
    const double v = p.*f.member;
    return std::log(f.shift < 0 ? -f.shift - v : f.shift + v);
}

void from_search(const Free& f, double x, Preset& p) {
    const double v = f.shift < 0 ? -f.shift - std::exp(x) : std::exp(x) - f.shift;
    p.*f.member = std::clamp(v, f.lo, f.hi);
}

constexpr double kNorm = 12;  ///< of the three columns: the worst one counts most

using Point = std::array<double, kFree.size()>;

Preset preset_at(const Preset& start, const Point& x) {
    Preset p = start;
    for (std::size_t i = 0; i < kFree.size(); ++i) from_search(kFree[i], x[i], p);
    p.radius = std::min(p.radius, 0.5 * p.length);
    return p;
}

struct Fit {
    SweepRow rms;
    double cost = 0;
    std::vector<double> misses;  ///< over the spread; rows times columns
};

Fit compare(const Preset& p, std::span<const SweepRow> measured, const SweepRow& spread) {
    const std::vector<double> depths = depths_of(measured);
    std::vector<SweepRow> swept(depths.size());
    parallel_for(depths.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            swept[i] = sweep_depth(p, std::span(&depths[i], 1)).front();
        }
    });
    Fit fit{.rms = rms_difference(swept, measured)};
    for (const SweepRow& row : measured) {
        const auto at = std::lower_bound(depths.begin(), depths.end(), row.depth) - depths.begin();
        for (double SweepRow::*column : kSweepColumns) {
            const double d = swept[static_cast<std::size_t>(at)].*column - row.*column;
            fit.misses.push_back(d / (spread.*column));
        }
    }
    for (double SweepRow::*column : kSweepColumns) {
        const double part = fit.rms.*column / (spread.*column);
        fit.cost += std::pow(part, kNorm) / 3;
    }
    fit.cost = std::pow(fit.cost, 1 / kNorm);
    return fit;
}

struct Vertex {
    Point x{};
    double cost = 0;
};

Point blend(const Point& a, const Point& b, double t) {
    Point out;
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = a[i] + t * (b[i] - a[i]);
    return out;
}

}  // namespace

namespace {

/// Least squares by Gauss and Newton with Marquardt's damping, in steps measured by `first`: far
/// quicker than the simplex where the valley is smooth. From the second step on the worse columns
/// weigh more, as they do in the cost. `fit_at` gives the Fit of a point.
template <class FitAt>
Vertex least_squares(const Point& begin, int budget, const FitAt& fit_at) {
    constexpr std::size_t kN = kFree.size();
    constexpr double kProbe = 0.05;  // of the first step, for differences
    Point x = begin;
    Fit fit = fit_at(x);
    double damping = 0.03;
    --budget;
    while (budget > static_cast<int>(kN)) {
        std::array<double, 3> weight;
        double worst = 0;
        for (int c = 0; c < 3; ++c) {
            weight[c] = 0;
            for (std::size_t k = c; k < fit.misses.size(); k += 3) weight[c] += fit.misses[k] * fit.misses[k];
            worst = std::max(worst, weight[c]);
        }
        if (worst <= 0) break;
        for (double& w : weight) w = std::max(0.05, w / worst);
        Eigen::Matrix<double, kN, kN> normal = Eigen::Matrix<double, kN, kN>::Zero();
        Eigen::Matrix<double, kN, 1> slope = Eigen::Matrix<double, kN, 1>::Zero();
        std::array<std::vector<double>, kN> column;
        for (std::size_t i = 0; i < kN; ++i) {
            Point probe = x;
            probe[i] += kProbe * kFree[i].first;
            column[i] = fit_at(probe).misses;
            for (std::size_t k = 0; k < column[i].size(); ++k) column[i][k] = (column[i][k] - fit.misses[k]) / kProbe;
        }
        budget -= static_cast<int>(kN);
        for (std::size_t k = 0; k < fit.misses.size(); ++k) {
            for (std::size_t i = 0; i < kN; ++i) {
                slope[i] += weight[k % 3] * column[i][k] * fit.misses[k];
                for (std::size_t j = 0; j < kN; ++j) normal(i, j) += weight[k % 3] * column[i][k] * column[j][k];
            }
        }
        bool better = false;
        const double before = fit.cost;
        for (int attempt = 0; attempt < 4 && !better && budget > 0; ++attempt, --budget) {
            Eigen::Matrix<double, kN, kN> damped = normal;
            const double scale = normal.trace() / static_cast<double>(kN);
            for (std::size_t i = 0; i < kN; ++i) damped(i, i) += damping * std::max(normal(i, i), 0.02 * scale);
            const Eigen::Matrix<double, kN, 1> step = -damped.llt().solve(slope);
            Point next = x;
            for (std::size_t i = 0; i < kN; ++i) next[i] += std::clamp(step[i], -3.0, 3.0) * kFree[i].first;
            Fit tried = fit_at(next);
            better = tried.cost < fit.cost;
            damping = std::clamp(damping * (better ? 0.3 : 5), 1e-4, 100.0);
            if (better) {
                x = next;
                fit = std::move(tried);
            }
        }
        if (!better || fit.cost > before * (1 - 1e-3)) break;
    }
    return {x, fit.cost};
}

/// Downhill simplex (Nelder and Mead 1965) from `begin` with first steps times `size`, for at
/// most `budget` evaluations or until the vertices agree to 1e-4.
template <class Cost>
Vertex descend(const Vertex& begin, double size, int budget, const Cost& cost) {
    std::vector<Vertex> simplex{begin};
    for (std::size_t i = 0; i < kFree.size(); ++i) {
        Point x = begin.x;
        x[i] += size * kFree[i].first;
        simplex.push_back({x, cost(x)});
    }
    budget -= static_cast<int>(kFree.size());
    const auto by_cost = [](const Vertex& a, const Vertex& b) { return a.cost < b.cost; };
    const auto at = [&](const Point& x) {
        --budget;
        return Vertex{x, cost(x)};
    };
    while (budget > 0) {
        std::stable_sort(simplex.begin(), simplex.end(), by_cost);
        Vertex& worst = simplex.back();
        if (worst.cost - simplex.front().cost < 1e-4 * simplex.front().cost) break;
        Point centre{};
        for (std::size_t v = 0; v + 1 < simplex.size(); ++v) {
            for (std::size_t i = 0; i < centre.size(); ++i) {
                centre[i] += simplex[v].x[i] / static_cast<double>(kFree.size());
            }
        }
        const Vertex reflected = at(blend(centre, worst.x, -1));
        if (reflected.cost < simplex.front().cost) {
            const Vertex further = at(blend(centre, worst.x, -2));
            worst = further.cost < reflected.cost ? further : reflected;
        } else if (reflected.cost < simplex[simplex.size() - 2].cost) {
            worst = reflected;
        } else {
            const Vertex closer = at(blend(centre, reflected.cost < worst.cost ? reflected.x : worst.x, 0.5));
            if (closer.cost < std::min(worst.cost, reflected.cost)) {
                worst = closer;
            } else {
                for (std::size_t v = 1; v < simplex.size(); ++v) {
                    simplex[v] = at(blend(simplex.front().x, simplex[v].x, 0.5));
                }
            }
        }
    }
    return *std::min_element(simplex.begin(), simplex.end(), by_cost);
}

}  // namespace

Calibration calibrate(const Preset& start, std::span<const SweepRow> measured, const CalibrateOptions& options) {
    if (measured.size() < 4) {
        throw Error(Message("calibration needs at least 4 measured depths, there are {}", measured.size()));
    }
    check_preset(start, start.name);
    Calibration out;
    const auto fit_at = [&](const Point& x) {
        ++out.evaluations;
        report(options.progress, "fitting",
               std::min(1.0, out.evaluations / static_cast<double>(options.max_evaluations)));
        return compare(preset_at(start, x), measured, options.repeatability);
    };
    const auto cost = [&](const Point& x) { return fit_at(x).cost; };
    const auto point = [&](const Preset& p) {
        Point x;
        for (std::size_t i = 0; i < kFree.size(); ++i) x[i] = to_search(kFree[i], p);
        return x;
    };
    // A wet end that lies down and one that does not, a soft point and a softer one, are
    // valleys of their own: begin in each, then follow the best.
    Vertex best{point(start), std::numeric_limits<double>::infinity()};
    const int share = options.max_evaluations / 6;
    for (const double film : {1.0, 0.1}) {
        for (const double gradient : {0.0, 1.0}) {
            Preset p = start;
            p.adhesion_range *= film;
            p.alpha -= 0.5 * gradient;
            p.tip_stiffness *= 1 - 0.9 * gradient;
            p.tip_stiffness = std::max(p.tip_stiffness, 2e-6);
            p.flatten_contact *= 1 + 0.5 * gradient;
            if (out.evaluations > share * 4) break;
            const Vertex found = least_squares(point(p), std::max(share, 30), fit_at);
            if (found.cost < best.cost) best = found;
        }
    }
    for (int round = 0; round < 6 && out.evaluations < options.max_evaluations; ++round) {
        const double size = (round % 2 == 0 ? 0.5 : -0.5) / (1 + 0.5 * round);
        const Vertex found = descend(best, size, options.max_evaluations - out.evaluations, cost);
        if (found.cost < best.cost) best = found;
    }
    out.preset = preset_at(start, best.x);
    const Fit fit = compare(out.preset, measured, options.repeatability);
    out.rms = fit.rms;
    out.cost = fit.cost;
    return out;
}

}  // namespace tuft::brush
