#include "brush/rod/rod_newton.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tuft::brush::rod {

namespace {

constexpr int kDampedSteps = 6;  ///< of one solve, before eigenvectors are asked
constexpr int kEigenCost = 12;   ///< iterations that a step by eigenvectors counts for

constexpr double kLongestStep = 0.3;  ///< radians any segment turns in one iteration

/// Largest turn of a segment in ws.step.
double longest_turn(const Workspace& ws) {
    double longest = 0;
    for (std::size_t j = 0; 2 * j < ws.step.size(); ++j) {
        longest = std::max(longest, ws.step[2 * j] * ws.step[2 * j] + ws.step[2 * j + 1] * ws.step[2 * j + 1]);
    }
    return std::sqrt(longest);
}

/// Solves H u = -g into ws.step by elimination. A step that turns some segment too far, or an
/// indefinite H, is damped in proportion to the joints' stiffness, so that the soft tip alone
/// does not hold up the rest. With `by_eigenvectors` an indefinite H is taken with |λ| in
/// place of λ instead: dear, but it converges fast next to a saddle. Returns the cost.
int newton_step(const Rod& rod, const Shape& shape, Workspace& ws, bool by_eigenvectors) {
    constexpr double kDamping[] = {0, 0.5, 3, 20, 200};
    int cost = 0;
    bool usable = false;
    for (const double damping : kDamping) {
        ++cost;
        if (descend(rod, shape, ws.at, ws.derivatives, damping, ws.elimination, ws.step)) {
            usable = std::all_of(ws.step.begin(), ws.step.end(), [](double u) { return std::isfinite(u); });
            if (usable && longest_turn(ws) <= 2 * kLongestStep) return cost;
        } else if (by_eigenvectors) {
            break;
        }
    }
    if (usable) return cost;
    const auto size = static_cast<Eigen::Index>(ws.derivatives.gradient.size());
    fill_hessian(rod, shape, ws.at, ws.derivatives, ws.hessian);
    ws.matrix = Eigen::Map<const DenseMatrix>(ws.hessian.data(), size, size);
    if (!ws.matrix.allFinite()) return 0;
    ws.eigen.compute(ws.matrix);
    if (ws.eigen.info() != Eigen::Success) return 0;
    const Eigen::Map<const Eigen::VectorXd> g(ws.derivatives.gradient.data(), size);
    Eigen::Map<Eigen::VectorXd> u(ws.step.data(), size);
    const Eigen::ArrayXd lambda = ws.eigen.eigenvalues().array().abs();
    const double least = 1e-8 * lambda.maxCoeff();
    const Eigen::VectorXd along = ws.eigen.eigenvectors().transpose() * g;
    u = -(ws.eigen.eigenvectors() * (along.array() / lambda.max(least)).matrix());
    return u.allFinite() ? cost + kEigenCost : 0;
}

}  // namespace

NewtonResult newton(const Frozen& frozen, Shape& shape, Workspace& ws, int limit) {
    const double tolerance = frozen.law->tolerance;
    NewtonResult out;
    int damped = 0;
    while (true) {
        differentiate(frozen, shape, ws.at, ws.derivatives);
        double residual = 0;
        for (const double g : ws.derivatives.gradient) residual = std::max(residual, std::abs(g));
        if (residual < tolerance) {
            out.converged = true;
            return out;
        }
        if (out.iterations >= limit || !std::isfinite(residual)) return out;
        differentiate_twice(frozen, shape, ws.at, ws.derivatives);
        const int cost = newton_step(*frozen.rod, shape, ws, damped >= kDampedSteps);
        if (cost == 0) return out;
        damped += cost > 1;
        out.iterations += cost;
        const double longest = longest_turn(ws);
        double slope = 0;
        for (std::size_t i = 0; i < ws.step.size(); ++i) slope += ws.derivatives.gradient[i] * ws.step[i];
        double scale = std::min(1.0, kLongestStep / longest);
        // Below this a change of Π is round-off.
        const double noise = 1e-14 * (1 + std::abs(ws.at.value));
        bool accepted = false;
        for (int halving = 0; halving < 20 && !accepted; ++halving, scale *= 0.5) {
            advance(shape, ws.step, scale, ws.next);
            evaluate(frozen, ws.next, ws.trial);
            accepted = ws.trial.value <= ws.at.value + 1e-4 * scale * slope + noise;
        }
        if (!accepted) {
            out.converged = residual < 1e3 * tolerance && -slope < 1e3 * noise;
            return out;
        }
        std::swap(shape, ws.next);
        std::swap(ws.at, ws.trial);
    }
}

}  // namespace tuft::brush::rod
