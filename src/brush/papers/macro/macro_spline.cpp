#include "brush/papers/macro/macro_spline.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "core/cubic.h"

namespace tuft::brush::macro {

double value(const Spline& spline, double t) {
    const std::array<double, 4> b = bernstein(t);
    return b[0] * spline[0] + b[1] * spline[1] + b[2] * spline[2] + b[3] * spline[3];
}

Vec3 value(const CurveSpline& spline, double t) {
    const std::array<double, 4> b = bernstein(t);
    return b[0] * spline[0] + b[1] * spline[1] + b[2] * spline[2] + b[3] * spline[3];
}

double curvature(const CurveSpline& k, double t) {
    const double s = 1 - t;
    const Vec3 u = k[1] - k[0], v = k[2] - k[1], w = k[3] - k[2];
    const Vec3 first = 3.0 * (s * s * u + 2 * s * t * v + t * t * w), second = 6.0 * (s * (v - u) + t * (w - v));
    const double speed = glm::length(first);
    const double scale = glm::length(u) + glm::length(v) + glm::length(w);
    return speed > 1e-6 * scale ? glm::length(glm::cross(first, second)) / (speed * speed * speed) : 0;
}

namespace {

constexpr int kSweeps = 600;           ///< of the multipliers, at most
constexpr double kSatisfied = 1e-13;   ///< largest change of a constraint in the last sweep
constexpr double kLeastHandle = 0.02;  ///< lengths, from the root to the control point next to it

/// min ½ xᵀHx − gᵀx with A x ≥ b, by coordinate ascent over the multipliers (Hildreth).
struct Quadratic {
    Eigen::MatrixXd h, a;
    Eigen::VectorXd g, b;
};

Eigen::VectorXd minimise(const Quadratic& q) {
    const Eigen::LDLT<Eigen::MatrixXd> factor(q.h);
    Eigen::VectorXd x = factor.solve(q.g);
    if (q.a.rows() == 0) return x;
    const Eigen::MatrixXd inverse_at = factor.solve(q.a.transpose());
    const Eigen::MatrixXd dual = q.a * inverse_at;
    Eigen::VectorXd miss = q.a * x - q.b, multiplier = Eigen::VectorXd::Zero(q.b.size());
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        double change = 0;
        for (Eigen::Index i = 0; i < miss.size(); ++i) {
            if (!(dual(i, i) > 0)) continue;
            const double step = std::max(-multiplier(i), -miss(i) / dual(i, i));
            if (step == 0) continue;
            multiplier(i) += step;
            miss += step * dual.col(i);
            change = std::max(change, std::abs(step) * dual(i, i));
        }
        if (change < kSatisfied) break;
    }
    return x + inverse_at * multiplier;
}

Eigen::Vector3d eigen(const Vec3& v) {
    return {v.x, v.y, v.z};
}

/// Rows of one node: its place is B x, with x = (K0, K1, handle), relative to the root and over the length.
Eigen::Matrix<double, 3, 7> place_rows(double t, const Vec3& direction) {
    const std::array<double, 4> b = bernstein(t);
    Eigen::Matrix<double, 3, 7> rows = Eigen::Matrix<double, 3, 7>::Zero();
    rows.block<3, 3>(0, 0).diagonal().setConstant(b[0]);
    rows.block<3, 3>(0, 3).diagonal().setConstant(b[1]);
    rows.col(6) = b[2] * eigen(direction);
    return rows;
}

/// Half spaces that bind: those of all nodes but the root, if the root is above its own.
std::size_t bound_count(const CurveFit& f) {
    if (f.above.empty() || f.above.back().height(f.root) <= 0) return 0;
    return f.nodes.size() - 1;
}

}  // namespace

Spline fit_spline(const ValueFit& f) {
    // A held root leaves three unknowns.
    const Eigen::Index count = f.root ? 3 : 4, bounded = static_cast<Eigen::Index>(f.lower.size());
    const Eigen::Index rows = bounded + (f.falling ? 3 : 0);
    const double root = f.root.value_or(0);
    Quadratic q{Eigen::MatrixXd::Zero(count, count), Eigen::MatrixXd::Zero(rows, count), Eigen::VectorXd::Zero(count),
                Eigen::VectorXd::Zero(rows)};
    for (std::size_t i = 0; i < f.t.size(); ++i) {
        const std::array<double, 4> b = bernstein(f.t[i]);
        const Eigen::Map<const Eigen::VectorXd> v(b.data(), count);
        const double held = root * b[3];
        q.h += f.weight[i] * v * v.transpose();
        q.g += f.weight[i] * (f.target[i] - held) * v;
        if (bounded == 0) continue;
        q.a.row(static_cast<Eigen::Index>(i)) = v.transpose();
        q.b(static_cast<Eigen::Index>(i)) = f.lower[i] - held;
    }
    for (Eigen::Index k = 0; bounded + k < rows; ++k) {
        q.a(bounded + k, k) = 1;
        if (k + 1 < count)
            q.a(bounded + k, k + 1) = -1;
        else
            q.b(bounded + k) = root;
    }
    const Eigen::VectorXd x = minimise(q);
    return {x(0), x(1), x(2), f.root ? root : x(3)};
}

CurveSpline fit_curve(const CurveFit& f) {
    const auto bounded = static_cast<Eigen::Index>(bound_count(f));
    Quadratic q{Eigen::MatrixXd::Zero(7, 7), Eigen::MatrixXd::Zero(bounded + 1, 7), Eigen::VectorXd::Zero(7),
                Eigen::VectorXd(bounded + 1)};
    for (std::size_t i = 0; i < f.nodes.size(); ++i) {
        const Eigen::Matrix<double, 3, 7> rows = place_rows(f.t[i], f.direction);
        q.h += f.weight[i] * rows.transpose() * rows;
        q.g += f.weight[i] * rows.transpose() * eigen((f.nodes[i] - f.root) / f.length);
        const auto k = static_cast<Eigen::Index>(i);
        if (k >= bounded) continue;
        q.a.row(k) = eigen(f.above[i].normal).transpose() * rows;
        q.b(k) = -f.above[i].height(f.root) / f.length;
    }
    q.a(bounded, 6) = 1;
    q.b(bounded) = kLeastHandle;
    const Eigen::VectorXd x = minimise(q);
    const auto point = [&](Eigen::Index k) { return f.root + f.length * Vec3{x(k), x(k + 1), x(k + 2)}; };
    return {point(0), point(3), f.root + f.length * x(6) * f.direction, f.root};
}

}  // namespace tuft::brush::macro
