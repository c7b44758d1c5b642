#include "brush/papers/active_set.h"

#include <Eigen/Cholesky>
#include <vector>

namespace tuft::brush {

namespace {

using Eigen::Index;

/// The minimum over the free unknowns alone; the others are 0.
Eigen::VectorXd solve_free(const Eigen::MatrixXd& q, const Eigen::VectorXd& b, const std::vector<char>& free) {
    std::vector<Index> index;
    for (Index i = 0; i < b.size(); ++i)
        if (free[static_cast<std::size_t>(i)]) index.push_back(i);
    const Index n = static_cast<Index>(index.size());
    Eigen::MatrixXd part(n, n);
    Eigen::VectorXd right(n);
    for (Index i = 0; i < n; ++i) {
        right[i] = -b[index[static_cast<std::size_t>(i)]];
        for (Index j = 0; j < n; ++j)
            part(i, j) = q(index[static_cast<std::size_t>(i)], index[static_cast<std::size_t>(j)]);
    }
    Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
    if (n == 0) return x;
    const Eigen::VectorXd found = part.ldlt().solve(right);
    for (Index i = 0; i < n; ++i) x[index[static_cast<std::size_t>(i)]] = found[i];
    return x;
}

}  // namespace

Eigen::VectorXd minimise_nonnegative(const Eigen::MatrixXd& q, const Eigen::VectorXd& b, const Eigen::VectorXd& start) {
    const Index n = b.size();
    std::vector<char> free(static_cast<std::size_t>(n), 0);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    for (Index i = 0; i < n; ++i) {
        free[static_cast<std::size_t>(i)] = start[i] > 0;
        x[i] = std::max(start[i], 0.0);
    }
    const double tolerance = 1e-13 * (1 + b.cwiseAbs().maxCoeff());
    for (int change = 0; change < 4 * n + 10; ++change) {
        const Eigen::VectorXd goal = solve_free(q, b, free);
        // As far as no free unknown turns negative; the first that would is held at 0.
        double part = 1;
        Index held = -1;
        for (Index i = 0; i < n; ++i) {
            if (!free[static_cast<std::size_t>(i)] || goal[i] > 0) continue;
            const double reach = x[i] > goal[i] ? x[i] / (x[i] - goal[i]) : 0;
            if (reach < part) {
                part = reach;
                held = i;
            }
        }
        x += part * (goal - x);
        if (held >= 0) {
            free[static_cast<std::size_t>(held)] = 0;
            x[held] = 0;
            continue;
        }
        const Eigen::VectorXd slope = q * x + b;
        Index worst = -1;
        double least = -tolerance;
        for (Index i = 0; i < n; ++i) {
            if (!free[static_cast<std::size_t>(i)] && slope[i] < least) {
                least = slope[i];
                worst = i;
            }
        }
        if (worst < 0) break;
        free[static_cast<std::size_t>(worst)] = 1;
    }
    return x.cwiseMax(0.0);
}

}  // namespace tuft::brush
