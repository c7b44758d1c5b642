#include "brush/lateral.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"

namespace tuft::brush {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

/// Nodes of a tuft 32 mm long, closer towards the tip.
std::vector<double> nodes(int n) {
    std::vector<double> at(n + 1);
    for (int i = 0; i <= n; ++i) {
        const double x = static_cast<double>(i) / n;
        at[i] = 0.032 * x * (1.3 - 0.3 * x);
    }
    return at;
}

LateralSide pushed(const std::vector<double>& at, double force) {
    LateralSide side;
    side.push.assign(at.size(), force);
    side.clear.assign(at.size(), kNone);
    return side;
}

TEST(Lateral, SolutionIsTheMinimumOfTheSpringsEnergy) {
    Random random(5);
    const std::vector<double> at = nodes(16);
    const LateralSprings springs{2e4, 1.5e4, 2.5e-3, 100};
    for (int trial = 0; trial < 20; ++trial) {
        LateralSide side = pushed(at, 0);
        for (double& q : side.push) q = random.uniform(-30, 60);
        if (trial % 2 == 1) {
            for (std::size_t i = 5; i < 9; ++i) side.clear[i] = random.uniform(-1e-4, 1e-3);
        }
        const std::vector<double> u = solve_lateral(at, springs, side);
        EXPECT_EQ(u[0], 0);
        const LateralEnergy best = lateral_energy(at, springs, side, u);
        for (std::size_t i = 1; i < u.size(); ++i) EXPECT_NEAR(best.gradient[i], 0, 1e-9);  // N, of 0.05
        for (int other = 0; other < 5; ++other) {
            std::vector<double> v = u;
            for (std::size_t i = 1; i < v.size(); ++i) v[i] += random.uniform(-1e-4, 1e-4);
            EXPECT_GT(lateral_energy(at, springs, side, v).value, best.value);
        }
    }
}

TEST(Lateral, GradientMatchesFiniteDifferences) {
    Random random(7);
    const std::vector<double> at = nodes(12);
    const LateralSprings springs{2e4, 1.5e4, 2.5e-3, 100};
    LateralSide side = pushed(at, 20);
    side.clear[6] = 1e-4;
    std::vector<double> u(at.size(), 0);
    for (std::size_t i = 1; i < u.size(); ++i) u[i] = random.uniform(-5e-4, 1e-3);
    const LateralEnergy here = lateral_energy(at, springs, side, u);
    for (std::size_t i = 1; i < u.size(); ++i) {
        constexpr double h = 1e-7;
        std::vector<double> v = u;
        v[i] = u[i] + h;
        const double up = lateral_energy(at, springs, side, v).value;
        v[i] = u[i] - h;
        const double down = lateral_energy(at, springs, side, v).value;
        // A quadratic: central differences are exact but for round-off, 1e-16 · 1e-4 J / h.
        EXPECT_NEAR((up - down) / (2 * h), here.gradient[i], 1e-6);
    }
}

TEST(Lateral, AnEvenPushFollowsTheBeamOnAnElasticFoundation) {
    // κ u + κ λ⁴ u'''' = q with u = u' = 0 at one end of a long beam:
    // u = q/κ (1 - e^{-s} (cos s + sin s)), s = x / (√2 λ).
    const std::vector<double> at = nodes(64);
    const LateralSprings springs{1e4, 1e4, 2e-3, 100};
    const std::vector<double> u = solve_lateral(at, springs, pushed(at, 10));
    for (std::size_t i = 1; i < u.size(); ++i) {
        const double s = at[i] / (std::sqrt(2.0) * springs.reach);
        const double exact = 1e-3 * (1 - std::exp(-s) * (std::cos(s) + std::sin(s)));
        EXPECT_NEAR(u[i], exact, 0.015e-3) << i;  // second order in steps of a third of λ
    }
}

TEST(Lateral, NeighboursSmoothAPushAtOneNode) {
    const std::vector<double> at = nodes(16);
    const LateralSprings springs{2e4, 2e4, 3e-3, 100};
    LateralSide side = pushed(at, 0);
    side.push[8] = 100;
    const std::vector<double> u = solve_lateral(at, springs, side);
    EXPECT_GT(u[7], 0.4 * u[8]);
    EXPECT_GT(u[9], 0.4 * u[8]);
    EXPECT_LT(u[8], 100 / springs.stretch);
    EXPECT_LT(std::abs(u[15]), 0.1 * u[8]);
}

TEST(Lateral, AWallHoldsTheSideThatMeetsIt) {
    const std::vector<double> at = nodes(16);
    const LateralSprings springs{2e4, 2e4, 2e-3, 100};
    LateralSide open = pushed(at, 40), walled = open;
    for (std::size_t i = 6; i < 10; ++i) walled.clear[i] = 5e-4;
    const std::vector<double> u = solve_lateral(at, springs, open), v = solve_lateral(at, springs, walled);
    for (std::size_t i = 6; i < 10; ++i) {
        EXPECT_GT(u[i], 1.5e-3);
        EXPECT_LT(v[i], 5.5e-4);  // gives by the push over 100 times the springs
    }
    EXPECT_GT(v[14], 0.8 * u[14]);
}

TEST(Lateral, HalfWidthStaysBetweenItsBounds) {
    double before = 0;
    for (int i = -200; i <= 200; ++i) {
        const double h = half_width(2e-3, 1e-4 * i, 3);
        EXPECT_GT(h, i == -200 ? 0 : before - 1e-15);
        EXPECT_LE(h, 6e-3);
        EXPECT_GE(h, 0.8e-3);
        before = h;
    }
    EXPECT_NEAR(half_width(2e-3, 1e-6, 3), 2.001e-3, 1e-9);
    EXPECT_EQ(half_width(2e-3, 0, 3), 2e-3);
}

}  // namespace
}  // namespace tuft::brush
