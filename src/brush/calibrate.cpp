#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "brush/sweep.h"
#include "core/error.h"
#include "core/parallel.h"

namespace tuft::brush {

namespace {

/// A preset value the fit may change, searched on a logarithmic scale of `shift` + value.
struct Free {
    double Preset::*member;
    double lo, hi;       ///< SI
    double shift;        ///< makes the value positive
    double first;        ///< first step of the search, relative
};

/// Few enough for some ten measured depths. Only the ratio of side stiffness to bending
/// stiffness shows in a shape, so B0 stays.
constexpr std::array kFree = {
    Free{&Preset::radius, 0.5e-3, 30e-3, 0, 0.15},
    Free{&Preset::tip_power, 0.6, 2.5, 0, 0.2},
    Free{&Preset::alpha, -6, 1, -2, 0.3},         // of 2 - α
    Free{&Preset::beta, -0.995, 0, 1, 0.4},      // of 1 + β
    Free{&Preset::transverse_stiffness, 200, 2e5, 0, 0.5},
    Free{&Preset::friction_wet, 0.05, 0.8, 0, 0.4},
    Free{&Preset::flatten_contact, 0.05, 6, 0, 0.4},
};

double to_search(const Free& f, const Preset& p) {
    const double v = p.*f.member;
    return std::log(f.shift < 0 ? -f.shift - v : f.shift + v);
}

void from_search(const Free& f, double x, Preset& p) {
    const double v = f.shift < 0 ? -f.shift - std::exp(x) : std::exp(x) - f.shift;
    p.*f.member = std::clamp(v, f.lo, f.hi);
}

constexpr double kNorm = 12; ///< of the three columns: the worst one counts most

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
};

Fit compare(const Preset& p, std::span<const SweepRow> measured, const SweepRow& spread) {
    std::vector<double> depths;
    for (const SweepRow& row : measured) depths.push_back(row.depth);
    std::sort(depths.begin(), depths.end());
    depths.erase(std::unique(depths.begin(), depths.end()), depths.end());
    std::vector<SweepRow> swept(depths.size());
    parallel_for(depths.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            swept[i] = sweep_depth(p, std::span(&depths[i], 1)).front();
        }
    });
    Fit fit;
    double SweepRow::* const columns[] = {&SweepRow::width, &SweepRow::drag, &SweepRow::offset};
    for (const SweepRow& row : measured) {
        const auto at = std::lower_bound(depths.begin(), depths.end(), row.depth) - depths.begin();
        for (double SweepRow::*column : columns) {
            const double d = swept[static_cast<std::size_t>(at)].*column - row.*column;
            fit.rms.*column += d * d;
        }
    }
    const double n = static_cast<double>(measured.size());
    for (double SweepRow::*column : columns) {
        fit.rms.*column = std::sqrt(fit.rms.*column / n);
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

Calibration calibrate(const Preset& start, std::span<const SweepRow> measured,
                      const CalibrateOptions& options) {
    if (measured.size() < 4) {
        throw Error("calibration needs at least 4 measured depths, there are " +
                    std::to_string(measured.size()));
    }
    check_preset(start, start.name);
    Calibration out;
    const auto cost = [&](const Point& x) {
        ++out.evaluations;
        return compare(preset_at(start, x), measured, options.repeatability).cost;
    };

    // Downhill simplex (Nelder and Mead 1965), begun anew from its best vertex when it stalls.
    Point best;
    for (std::size_t i = 0; i < kFree.size(); ++i) best[i] = to_search(kFree[i], start);
    double best_cost = cost(best);
    for (int round = 0; round < 4 && out.evaluations < options.max_evaluations; ++round) {
        std::vector<Vertex> simplex{{best, best_cost}};
        for (std::size_t i = 0; i < kFree.size(); ++i) {
            Point x = best;
            x[i] += (round % 2 == 0 ? 1 : -1) * kFree[i].first / (1 + round);
            simplex.push_back({x, cost(x)});
        }
        while (out.evaluations < options.max_evaluations) {
            std::stable_sort(simplex.begin(), simplex.end(),
                             [](const Vertex& a, const Vertex& b) { return a.cost < b.cost; });
            Vertex& worst = simplex.back();
            if (worst.cost - simplex.front().cost < 1e-4 * simplex.front().cost) break;
            Point centre{};
            for (std::size_t v = 0; v + 1 < simplex.size(); ++v) {
                for (std::size_t i = 0; i < centre.size(); ++i) {
                    centre[i] += simplex[v].x[i] / static_cast<double>(kFree.size());
                }
            }
            Vertex reflected{blend(centre, worst.x, -1), 0};
            reflected.cost = cost(reflected.x);
            if (reflected.cost < simplex.front().cost) {
                Vertex further{blend(centre, worst.x, -2), 0};
                further.cost = cost(further.x);
                worst = further.cost < reflected.cost ? further : reflected;
            } else if (reflected.cost < simplex[simplex.size() - 2].cost) {
                worst = reflected;
            } else {
                Vertex closer{blend(centre, reflected.cost < worst.cost ? reflected.x : worst.x, 0.5), 0};
                closer.cost = cost(closer.x);
                if (closer.cost < std::min(worst.cost, reflected.cost)) {
                    worst = closer;
                } else {
                    for (std::size_t v = 1; v < simplex.size(); ++v) {
                        simplex[v].x = blend(simplex.front().x, simplex[v].x, 0.5);
                        simplex[v].cost = cost(simplex[v].x);
                    }
                }
            }
        }
        const auto low = std::min_element(simplex.begin(), simplex.end(),
                                          [](const Vertex& a, const Vertex& b) { return a.cost < b.cost; });
        best = low->x;
        best_cost = low->cost;
    }
    out.preset = preset_at(start, best);
    const Fit fit = compare(out.preset, measured, options.repeatability);
    out.rms = fit.rms;
    out.cost = fit.cost;
    return out;
}

}  // namespace tuft::brush
