#include "brush/papers/chain_lateral.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace tuft::brush {

namespace {

constexpr int kIterations = 60;
constexpr double kFloor = 1e-3;     ///< of the reference: below it the curvature of |u|^m counts as constant
constexpr double kSettled = 1e-10;  ///< m

struct Derivatives {
    double value = 0;
    Eigen::VectorXd gradient;
    Eigen::MatrixXd hessian;
};

/// Coefficient of |u|^m whose slope at u = `at` is `stiffness` · at.
double coefficient(double stiffness, double at, double m) {
    return stiffness * std::pow(at, 2 - m) / m;
}

class Side {
  public:
    explicit Side(const LateralChain& side) : s_(side), count_(side.at.size()) {}

    Derivatives evaluate(const std::vector<double>& d) const {
        const Eigen::Index n = static_cast<Eigen::Index>(count_);
        Derivatives out{0, Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)};
        for (std::size_t i = 1; i < count_; ++i) {
            const double w = 0.5 * (s_.at[std::min(i + 1, count_ - 1)] - s_.at[i - 1]);
            add(out, {{i, 1.0}}, d[i] - s_.rest[i], w * coefficient(s_.stretch, s_.reference, s_.exponent),
                s_.reference);
            if (s_.drag[i] > 0) add_drag(out, i, d[i] - s_.stuck[i]);
        }
        for (std::size_t i = 1; i + 1 < count_; ++i) {
            const double a = 1 / (s_.at[i] - s_.at[i - 1]), b = 1 / (s_.at[i + 1] - s_.at[i]),
                         w = 0.5 * (1 / a + 1 / b);
            const auto slope_change = [&](const std::vector<double>& x) {
                return a * x[i - 1] - (a + b) * x[i] + b * x[i + 1];
            };
            const double squared = s_.bend_length * s_.bend_length, reference = w * s_.reference / squared;
            add(out, {{i - 1, a}, {i, -(a + b)}, {i + 1, b}}, slope_change(d) - slope_change(s_.outer),
                coefficient(s_.stretch * squared * squared / w, reference, s_.exponent), reference);
        }
        // The root is held.
        out.gradient[0] = 0;
        out.hessian.row(0).setZero();
        out.hessian.col(0).setZero();
        out.hessian(0, 0) = 1;
        return out;
    }

  private:
    struct Term {
        std::size_t node;
        double factor;
    };

    void add(Derivatives& out, std::initializer_list<Term> terms, double u, double c, double reference) const {
        const double m = s_.exponent, size = std::abs(u), floor = std::max(size, kFloor * reference);
        out.value += c * std::pow(size, m);
        const double slope = size > 0 ? c * m * std::pow(size, m - 2) * u : 0;
        const double curvature = c * m * (m - 1) * std::pow(floor, m - 2);
        for (const Term& a : terms) {
            out.gradient[static_cast<Eigen::Index>(a.node)] += a.factor * slope;
            for (const Term& b : terms)
                out.hessian(static_cast<Eigen::Index>(a.node), static_cast<Eigen::Index>(b.node)) +=
                    a.factor * b.factor * curvature;
        }
    }

    void add_drag(Derivatives& out, std::size_t i, double u) const {
        const double size = std::hypot(u, s_.smoothing);
        const Eigen::Index k = static_cast<Eigen::Index>(i);
        out.value += s_.drag[i] * (size - s_.smoothing);
        out.gradient[k] += s_.drag[i] * u / size;
        out.hessian(k, k) += s_.drag[i] * s_.smoothing * s_.smoothing / (size * size * size);
    }

    const LateralChain& s_;
    std::size_t count_;
};

}  // namespace

std::vector<double> solve_lateral_chain(const LateralChain& s) {
    const Side side(s);
    std::vector<double> d = s.rest;
    Derivatives now = side.evaluate(d);
    for (int iteration = 0; iteration < kIterations; ++iteration) {
        const Eigen::VectorXd step = -now.hessian.ldlt().solve(now.gradient);
        const double slope = now.gradient.dot(step);
        double part = 1;
        std::vector<double> tried = d;
        Derivatives next;
        for (int halving = 0; halving < 30; ++halving, part *= 0.5) {
            for (std::size_t i = 1; i < d.size(); ++i) tried[i] = d[i] + part * step[static_cast<Eigen::Index>(i)];
            next = side.evaluate(tried);
            if (next.value <= now.value + 1e-4 * part * slope) break;
        }
        if (!(next.value < now.value)) break;
        d = tried;
        now = std::move(next);
        if (step.cwiseAbs().maxCoeff() < kSettled) break;
    }
    return d;
}

LateralChainEnergy lateral_chain_energy(const LateralChain& s, const std::vector<double>& d) {
    const Derivatives at = Side(s).evaluate(d);
    return {at.value, {at.gradient.data(), at.gradient.data() + at.gradient.size()}};
}

}  // namespace tuft::brush
