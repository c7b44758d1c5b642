#include "core/cubic.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/geometry/types.h"
#include "core/random.h"

namespace tuft {
namespace {

// A dozen sums and products of numbers of order one to ten.
constexpr double kRounding = 1e-13;

double cubic(double x) {
    return 0.3 - 1.7 * x + 2.1 * x * x - 0.9 * x * x * x;
}

double cubic_slope(double x) {
    return -1.7 + 4.2 * x - 2.7 * x * x;
}

TEST(Cubic, IsTheCubicThatHasItsEndsAndSlopes) {
    const double x0 = -0.4, x1 = 1.1, h = x1 - x0;
    for (int i = 0; i <= 20; ++i) {
        const double t = i / 20.0, x = x0 + t * h;
        EXPECT_NEAR(hermite(cubic(x0), cubic(x1), cubic_slope(x0), cubic_slope(x1), h, t), cubic(x), kRounding);
        EXPECT_NEAR(hermite_between(cubic(x0), cubic(x1), h * cubic_slope(x0), h * cubic_slope(x1), t), cubic(x),
                    kRounding);
        EXPECT_NEAR(hermite_slope(cubic(x0), cubic(x1), cubic_slope(x0), cubic_slope(x1), h, t), cubic_slope(x),
                    kRounding);
    }
}

TEST(Cubic, MeetsValueAndSlopeOfTheNextPieceOfAnotherLength) {
    Random random(7);
    for (int i = 0; i < 100; ++i) {
        std::array<Vec3, 3> p, m;
        for (std::size_t k = 0; k < 3; ++k)
            for (int c = 0; c < 3; ++c) p[k][c] = random.uniform(-1, 1), m[k][c] = random.uniform(-3, 3);
        const double h = random.uniform(0.1, 2), next = random.uniform(0.1, 2);
        EXPECT_LT(glm::length(hermite(p[0], p[1], m[0], m[1], h, 1) - hermite(p[1], p[2], m[1], m[2], next, 0)),
                  kRounding);
        EXPECT_LT(
            glm::length(hermite_slope(p[0], p[1], m[0], m[1], h, 1) - hermite_slope(p[1], p[2], m[1], m[2], next, 0)),
            kRounding);
        EXPECT_EQ(hermite(p[0], p[1], m[0], m[1], h, 0), p[0]);
        EXPECT_EQ(hermite_slope(p[0], p[1], m[0], m[1], h, 0), m[0]);
    }
}

TEST(Cubic, OfABezierCurveHasAThirdOfItsSlopesBetweenControlPoints) {
    const double p0 = 0.3, p1 = 1.1, m0 = -2, m1 = 0.7, h = 1.5;
    const double control[] = {p0, p0 + h * m0 / 3, p1 - h * m1 / 3, p1};
    for (int i = 0; i <= 10; ++i) {
        const std::array<double, 4> b = bernstein(i / 10.0);
        double value = 0;
        for (std::size_t k = 0; k < 4; ++k) value += b[k] * control[k];
        EXPECT_NEAR(value, hermite(p0, p1, m0, m1, h, i / 10.0), kRounding);
    }
}

TEST(Cubic, HasTheSlopeOfAParabolaThroughThreeNodes) {
    const auto parabola = [](double x) { return 2 - 3 * x + 4 * x * x; };
    const double x0 = 0.2, x1 = 0.5, x2 = 1.3;
    EXPECT_NEAR(parabola_slope((parabola(x1) - parabola(x0)) / (x1 - x0), (parabola(x2) - parabola(x1)) / (x2 - x1),
                               x1 - x0, x2 - x1),
                -3 + 8 * x1, kRounding);
}

TEST(Cubic, StaysBetweenItsNodesWithMonotoneSlopes) {
    Random random(11);
    for (int i = 0; i < 200; ++i) {
        std::array<double, 4> x{}, y{};
        for (std::size_t k = 1; k < 4; ++k) x[k] = x[k - 1] + random.uniform(0.05, 1);
        for (double& v : y) v = random.uniform(-1, 1);
        std::array<double, 3> h{}, chord{};
        for (std::size_t k = 0; k < 3; ++k) h[k] = x[k + 1] - x[k], chord[k] = (y[k + 1] - y[k]) / h[k];
        const double from = monotone_slope(chord[0], chord[1], h[0], h[1]),
                     to = monotone_slope(chord[1], chord[2], h[1], h[2]);
        for (int k = 0; k <= 40; ++k) {
            const double v = hermite(y[1], y[2], from, to, h[1], k / 40.0);
            EXPECT_GE(v, std::min(y[1], y[2]) - kRounding);
            EXPECT_LE(v, std::max(y[1], y[2]) + kRounding);
        }
    }
}

}  // namespace
}  // namespace tuft
