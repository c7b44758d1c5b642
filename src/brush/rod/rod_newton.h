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

/// Result of a Newton solve.
struct NewtonResult {
    bool converged = false;
    bool moved = false;  ///< a step was taken
    int iterations = 0;
};

inline constexpr double kLongestStep = 0.3;  ///< radians any segment turns in one iteration
inline constexpr int kDampedSteps = 6;       ///< of one minimisation, before a system may take its dearer step
inline constexpr int kWholeTrials = 2;       ///< of a line search; the next ones look at Π alone

/// Largest turn of a segment in `step`, two numbers for each segment, radians.
inline double longest_turn(std::span<const double> step) {
    double longest = 0;
    for (std::size_t j = 0; j + 1 < step.size(); j += 2)
        longest = std::max(longest, step[j] * step[j] + step[j + 1] * step[j + 1]);
    return std::sqrt(longest);
}

/// Minimises the potential Π of `system` in at most `limit` iterations. Π never increases. A system gives
///
///     tolerance(), value()             of the residual; Π at its shape
///     gradient()                       after differentiate()
///     newton_step(bool by_eigenvectors)           after differentiate_twice(): fills step(), returns its cost, 0 for
///     none try_step(scale)                  Π at the shape moved by scale · step(), with what its derivatives need
///     probe_step(scale)                the same without that; complete_step() adds it
///     accept()                         takes the shape that was tried
///
/// Where Π has a kink a search may halve its step to the end.
template <class System>
NewtonResult minimise(System& system, int limit) {
    const double tolerance = system.tolerance();
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
        if (out.iterations >= limit || !std::isfinite(residual)) return out;
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
        for (int halving = 0; halving < 20 && !accepted; ++halving, scale *= 0.5) {
            const bool whole = halving < kWholeTrials;
            const double trial = whole ? system.try_step(scale) : system.probe_step(scale);
            accepted = trial <= value + 1e-4 * scale * slope + noise;
            if (accepted && !whole) system.complete_step();
        }
        if (!accepted) {
            out.converged = residual < 1e3 * tolerance && -slope < 1e3 * noise;
            return out;
        }
        system.accept();
        out.moved = true;
    }
}

/// Minimises Π of one rod from `shape`; ws.at holds the evaluation of `shape`. On return ws.at holds that of the
/// result.
NewtonResult newton(const Frozen& frozen, Shape& shape, Workspace& ws, int limit);

}  // namespace tuft::brush::rod
