#include "brush/papers/active_set.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <vector>

namespace tuft::brush {

namespace {

using Eigen::Index;

/// The minimum over the free unknowns alone; the others are 0.
Eigen::VectorXd solve_free(const Eigen::Ref<const Eigen::MatrixXd>& q, const Eigen::Ref<const Eigen::VectorXd>& b,
                           const std::vector<char>& free) {
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

std::vector<double> minimise_nonnegative(std::span<const double> q_rows, std::span<const double> b_elements,
                                         std::span<const double> start) {
    const Index n = static_cast<Index>(b_elements.size());
    if (n == 0) return {};
    const Eigen::Map<const Eigen::MatrixXd> q(q_rows.data(), n, n);  // symmetric: rows are columns
    const Eigen::Map<const Eigen::VectorXd> b(b_elements.data(), n);
    std::vector<char> free(static_cast<std::size_t>(n), 0);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    for (Index i = 0; i < n; ++i) {
        const double first = start[static_cast<std::size_t>(i)];
        free[static_cast<std::size_t>(i)] = first > 0;
        x[i] = std::max(first, 0.0);
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
    std::vector<double> out(x.begin(), x.end());
    for (double& v : out) v = std::max(v, 0.0);
    return out;
}

}  // namespace tuft::brush
