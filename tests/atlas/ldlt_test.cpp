#include "atlas/flatten/ldlt.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>

#include "core/random.h"

namespace tuft::atlas {
namespace {

using Matrix = LdltFactor::Matrix;
using Eigens = Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<int>>;

/// Laplacian of a grid of n × n vertices, each square with one diagonal, under random weights; only edges that `has`
/// lets in. `grounded` is added to the diagonal.
Matrix laplacian(int n, double grounded, Random& random, const std::function<bool(int, int)>& has) {
    std::vector<Eigen::Triplet<double>> entries;
    std::vector<double> diagonal(static_cast<std::size_t>(n) * n, grounded);
    const auto connect = [&](int a, int b) {
        if (!has(a, b)) return;
        const double w = random.uniform(0.1, 2);
        entries.emplace_back(std::max(a, b), std::min(a, b), -w);
        diagonal[a] += w;
        diagonal[b] += w;
    };
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const int at = y * n + x;
            if (x + 1 < n) connect(at, at + 1);
            if (y + 1 < n) connect(at, at + n);
            if (x + 1 < n && y + 1 < n) connect(at, at + n + 1);
        }
    for (int i = 0; i < n * n; ++i) entries.emplace_back(i, i, diagonal[i]);
    Matrix matrix(n * n, n * n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

std::vector<Vec2> random_numbers(std::size_t n, Random& random) {
    std::vector<Vec2> b(n);
    for (Vec2& v : b) v = {random.uniform(-1, 1), random.uniform(-1, 1)};
    return b;
}

// Supernodes of one column and of dozens, in one component and in thousands.
TEST(LdltFactor, SolvesToTheBitAsEigenDoes) {
    Random random(11);
    LdltFactor factor;  // its memory serves all
    for (const int n : {1, 2, 7, 40, 90})
        for (const double share : {0.0, 0.5, 1.0}) {
            const Matrix matrix =
                laplacian(n, 0.01, random, [&](int, int) { return share == 1 || random.uniform(0, 1) < share; });
            const std::vector<Vec2> b = random_numbers(static_cast<std::size_t>(n) * n, random);
            std::vector<Vec2> x = b;
            ASSERT_TRUE(factor.compute(matrix));
            factor.solve(x);
            const Eigens eigens(matrix);
            for (int c = 0; c < 2; ++c) {
                Eigen::VectorXd right(n * n);
                for (int i = 0; i < n * n; ++i) right[i] = b[i][c];
                const Eigen::VectorXd expected = eigens.solve(right);
                for (int i = 0; i < n * n; ++i)
                    ASSERT_EQ(std::memcmp(&expected[i], &x[i][c], sizeof(double)), 0) << n << ", row " << i;
            }
        }
}

TEST(LdltFactor, RefusesWhatIsSingular) {
    Random random(12);
    LdltFactor factor;
    Matrix zero(4, 4);
    for (int i = 0; i < 4; ++i) zero.insert(i, i) = i == 2 ? 0.0 : 1.0;
    EXPECT_FALSE(factor.compute(zero));
    zero.coeffRef(2, 2) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(factor.compute(zero));
    zero.coeffRef(2, 2) = 3;
    ASSERT_TRUE(factor.compute(zero));
    std::vector<Vec2> x{{1, 2}, {3, 4}, {6, 9}, {7, 8}};
    factor.solve(x);
    EXPECT_EQ(x[2], (Vec2{2, 3}));
}

}  // namespace
}  // namespace tuft::atlas
