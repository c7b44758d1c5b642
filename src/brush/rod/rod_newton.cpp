#include "brush/rod/rod_newton.h"

namespace tuft::brush::rod {

namespace {

constexpr int kEigenCost = 12;  ///< iterations that a step by eigenvectors counts for

/// Solves H u = -g into ws.step by elimination. A step that turns some segment too far, or an
/// indefinite H, is damped in proportion to the joints' stiffness, so that the soft tip alone
/// does not shorten the step of the rest. With `by_eigenvectors` |λ| replaces λ where H is indefinite: it costs more,
/// and converges fast next to a saddle. Returns the cost in iterations; 0: no step.
int newton_step(const Rod& rod, const Shape& shape, Workspace& ws, bool by_eigenvectors) {
    const QuadraticModel model{rod, shape, ws.at, ws.derivatives};
    constexpr double kDamping[] = {0, 0.5, 3, 20, 200};
    int cost = 0;
    bool usable = false;
    for (const double damping : kDamping) {
        ++cost;
        if (descend(model, damping, ws.elimination, ws.step)) {
            usable = std::all_of(ws.step.begin(), ws.step.end(), [](double u) { return std::isfinite(u); });
            if (usable && longest_turn(ws.step) <= 2 * kLongestStep) return cost;
        } else if (by_eigenvectors) {
            break;
        }
    }
    if (usable) return cost;
    const auto size = static_cast<Eigen::Index>(ws.derivatives.gradient.size());
    fill_hessian(model, ws.hessian);
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

/// One rod as a system of `minimise`.
struct RodSystem {
    const Frozen& frozen;
    Shape& shape;
    Workspace& ws;

    double tolerance() const { return frozen.law->limits.tolerance; }
    double value() const { return ws.at.value; }
    std::span<const double> gradient() const { return ws.derivatives.gradient; }
    std::span<const double> step() const { return ws.step; }
    void differentiate() { rod::differentiate(frozen, shape, ws.at, ws.derivatives); }
    void differentiate_twice() { rod::differentiate_twice(frozen, shape, ws.at, ws.derivatives); }
    int newton_step(bool by_eigenvectors) { return rod::newton_step(*frozen.rod, shape, ws, by_eigenvectors); }
    double try_step(double scale) {
        advance(shape, ws.step, scale, ws.next);
        evaluate(frozen, ws.next, ws.trial);
        return ws.trial.value;
    }
    double probe_step(double scale) {
        advance(shape, ws.step, scale, ws.next);
        return value_of(frozen, ws.next, ws.trial);
    }
    void complete_step() { evaluate(frozen, ws.next, ws.trial); }
    void accept() {
        std::swap(shape, ws.next);
        std::swap(ws.at, ws.trial);
    }
};

}  // namespace

NewtonResult newton(const Frozen& frozen, Shape& shape, Workspace& ws, const NewtonLimits& limits) {
    RodSystem system{frozen, shape, ws};
    return minimise(system, limits);
}

}  // namespace tuft::brush::rod
