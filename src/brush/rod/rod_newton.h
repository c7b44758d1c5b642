#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "brush/rod/rod_energy.h"
#include "core/system/recycled.h"

/// \file
/// Newton minimisation of Π for frozen friction. Internal to the rod solver.
namespace tuft::brush::rod {

using DenseMatrix = Eigen::MatrixXd;

/// Buffers of the minimisation.
struct Workspace {
    Evaluation at, trial;
    Shape next;
    Recycled<Vec3> ahead;  ///< nodes for which friction is frozen
    Derivatives derivatives;
    Elimination elimination;
    Recycled<double> hessian, step;
    DenseMatrix matrix;
    Eigen::SelfAdjointEigenSolver<DenseMatrix> eigen;
};

/// What a minimisation may cost.
struct NewtonLimits {
    int iterations = 0;
    int stalls = 0;        ///< line searches of more than `kSmoothTrials` trials
    double tolerance = 0;  ///< of the residual, where it is more than the system's
};

/// Result of a Newton solve.
struct NewtonResult {
    bool converged = false;
    bool moved = false;  ///< a step was taken
    int iterations = 0;
    int stalls = 0;                   ///< line searches at a kink or a jump of Π
    int evaluations = 0, values = 0;  ///< of Π with its derivatives; of Π alone
};

inline constexpr double kLongestStep = 0.3;  ///< radians any segment turns in one iteration
inline constexpr int kDampedSteps = 6;       ///< of one minimisation, before a system may take its dearer step
inline constexpr int kWholeTrials = 2;       ///< of a line search; the next ones look at Π alone
inline constexpr int kSmoothTrials = 2;      ///< of a line search where Π is smooth, at most
inline constexpr int kMostTrials = 12;       ///< of a line search, by halves at least

/// Largest turn of a segment in `step`, two numbers for each segment, radians.
inline double longest_turn(std::span<const double> step) {
    double longest = 0;
    for (std::size_t j = 0; j + 1 < step.size(); j += 2)
        longest = std::max(longest, step[j] * step[j] + step[j + 1] * step[j + 1]);
    return std::sqrt(longest);
}

/// Returns the scale at which the parabola of the slope at 0 and the rise at `scale` is least, between a tenth and
/// half of `scale`.
inline double shorter(double scale, double slope, double rise) {
    const double bend = rise - scale * slope;
    const double least = bend > 0 ? -0.5 * slope * scale * scale / bend : 0.5 * scale;
    return std::clamp(least, 0.1 * scale, 0.5 * scale);
}

/// Minimises the potential Π of `system` within `limits`. Π never increases. A system gives
///
///     tolerance(), value()             of the residual; Π at its shape
///     gradient()                       after differentiate()
///     newton_step(bool by_eigenvectors)           after differentiate_twice(): fills step(), returns its cost, 0 for
///     none try_step(scale)                  Π at the shape moved by scale · step(), with what its derivatives need
///     probe_step(scale)                the same without that; complete_step() adds it
///     accept()                         takes the shape that was tried
///
/// A search shortens its step by parabolas, where Π has a kink to the end.
template <class System>
NewtonResult minimise(System& system, const NewtonLimits& limits) {
    const double tolerance = std::max(system.tolerance(), limits.tolerance);
    NewtonResult out;
    int damped = 0;
    while (true) {
        system.differentiate();
        const std::span<const double> gradient = system.gradient();
        double residual = 0;
        for (const double g : gradient) residual = std::max(residual, std::abs(g));
        if (residual < tolerance) {
            out.converged = true;
            return out;
        }
        if (out.iterations >= limits.iterations || out.stalls >= limits.stalls || !std::isfinite(residual)) return out;
        system.differentiate_twice();
        const int cost = system.newton_step(damped >= kDampedSteps);
        if (cost == 0) return out;
        damped += cost > 1;
        out.iterations += cost;
        const std::span<const double> step = system.step();
        const double longest = longest_turn(step);
        double slope = 0;
        for (std::size_t i = 0; i < step.size(); ++i) slope += gradient[i] * step[i];
        double scale = std::min(1.0, kLongestStep / longest);
        // Below this a change of Π is round-off.
        const double value = system.value(), noise = 1e-14 * (1 + std::abs(value));
        bool accepted = false;
        int trials = 0;
        for (; trials < kMostTrials && !accepted; ++trials) {
            const bool whole = trials < kWholeTrials;
            ++(whole ? out.evaluations : out.values);
            const double trial = whole ? system.try_step(scale) : system.probe_step(scale);
            accepted = trial <= value + 1e-4 * scale * slope + noise;
            if (accepted && !whole) {
                system.complete_step();
                ++out.evaluations;
            }
            if (!accepted) scale = shorter(scale, slope, trial - value);
        }
        out.stalls += trials > kSmoothTrials;
        if (!accepted) {
            out.converged = residual < 1e3 * system.tolerance() && -slope < 1e3 * noise;
            return out;
        }
        system.accept();
        out.moved = true;
    }
}

/// Minimises Π of one rod from `shape`; ws.at holds the evaluation of `shape`. On return ws.at holds that of the
/// result.
NewtonResult newton(const Frozen& frozen, Shape& shape, Workspace& ws, const NewtonLimits& limits);

}  // namespace tuft::brush::rod
