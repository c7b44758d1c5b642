#include "brush/tuft/shape/lateral.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random.h"

namespace tuft::brush {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

/// Nodes of a tuft 32 mm long, closer towards the tip.
Recycled<double> nodes(int n) {
    Recycled<double> at(n + 1);
    for (int i = 0; i <= n; ++i) {
        const double x = static_cast<double>(i) / n;
        at[i] = 0.032 * x * (1.3 - 0.3 * x);
    }
    return at;
}

LateralSide pushed(const Recycled<double>& at, double force) {
    LateralSide side;
    side.push.assign(at.size(), force);
    side.clear.assign(at.size(), kNone);
    return side;
}

/// Radii of a tuft that ends in a point.
Recycled<double> pointed(const Recycled<double>& at) {
    Recycled<double> r;
    for (const double x : at) r.push_back(3.5e-3 * std::max(0.02, 1 - x / at.back()));
    return r;
}

TEST(Lateral, SolutionIsTheMinimumOfTheSpringsEnergy) {
    Random random(5);
    const Recycled<double> at = nodes(16);
    LateralSprings springs{2e4, 1.5e4, 2.5e-3, 100, {}};
    for (int trial = 0; trial < 20; ++trial) {
        if (trial == 10) springs.taper = pointed(at);
        LateralSide side = pushed(at, 0);
        for (double& q : side.push) q = random.uniform(-30, 60);
        if (trial % 2 == 1) {
            for (std::size_t i = 5; i < 9; ++i) side.clear[i] = random.uniform(-1e-4, 1e-3);
        }
        if (trial % 3 == 2) side.root = random.uniform(-1e-3, 3e-3);
        const Recycled<double> u = solve_lateral(at, springs, side);
        EXPECT_EQ(u[0], side.root);
        const LateralEnergy best = lateral_energy(at, springs, side, u);
        for (std::size_t i = 1; i < u.size(); ++i) EXPECT_NEAR(best.gradient[i], 0, 1e-9);  // N, of 0.05
        for (int other = 0; other < 5; ++other) {
            Recycled<double> v = u;
            for (std::size_t i = 1; i < v.size(); ++i) v[i] += random.uniform(-1e-4, 1e-4);
            EXPECT_GT(lateral_energy(at, springs, side, v).value, best.value);
        }
    }
}

TEST(Lateral, GradientMatchesFiniteDifferences) {
    Random random(7);
    const Recycled<double> at = nodes(12);
    const LateralSprings springs{2e4, 1.5e4, 2.5e-3, 100, pointed(at)};
    LateralSide side = pushed(at, 20);
    side.clear[6] = 1e-4;
    Recycled<double> u(at.size(), 0);
    for (std::size_t i = 1; i < u.size(); ++i) u[i] = random.uniform(-5e-4, 1e-3);
    const LateralEnergy here = lateral_energy(at, springs, side, u);
    for (std::size_t i = 1; i < u.size(); ++i) {
        constexpr double h = 1e-7;
        Recycled<double> v = u;
        v[i] = u[i] + h;
        const double up = lateral_energy(at, springs, side, v).value;
        v[i] = u[i] - h;
        const double down = lateral_energy(at, springs, side, v).value;
        // A quadratic: central differences are exact but for round-off, 1e-16 · 1e-4 J / h.
        EXPECT_NEAR((up - down) / (2 * h), here.gradient[i], 1e-6);
    }
}

TEST(Lateral, AnEvenPushFollowsTheClosedForm) {
    // κ (1 - λ² d²/dx²)² u = q with u = u' = 0 at one end of a long row: u = q/κ (1 - (1 + s) e^{-s}), s = x / λ.
    const Recycled<double> at = nodes(64);
    const LateralSprings springs{1e4, 1e4, 2e-3, 100, {}};
    const Recycled<double> u = solve_lateral(at, springs, pushed(at, 10));
    for (std::size_t i = 1; i < u.size(); ++i) {
        const double s = at[i] / springs.reach;
        EXPECT_NEAR(u[i], 1e-3 * (1 - (1 + s) * std::exp(-s)), 0.015e-3) << i;  // second order in steps of a third of λ
    }
}

TEST(Lateral, APushOutwardsDrawsNothingIn) {
    const Recycled<double> at = nodes(24);
    LateralSprings springs{1e4, 1e4, 2e-3, 100, {}};
    for (const bool taper : {false, true}) {
        if (taper) springs.taper = pointed(at);
        for (std::size_t node = 1; node < at.size(); ++node) {
            LateralSide side = pushed(at, 0);
            side.push[node] = 50;
            const Recycled<double> u = solve_lateral(at, springs, side);
            // Up to the error of second differences where nodes lie a third of λ apart.
            for (std::size_t i = 1; i < u.size(); ++i)
                EXPECT_GT(u[i], -1e-3 * u[node]) << taper << " " << node << " " << i;
        }
    }
}

TEST(Lateral, NeighboursSmoothAPushAtOneNode) {
    const Recycled<double> at = nodes(16);
    const LateralSprings springs{2e4, 2e4, 3e-3, 100, {}};
    LateralSide side = pushed(at, 0);
    side.push[8] = 100;
    const Recycled<double> u = solve_lateral(at, springs, side);
    EXPECT_GT(u[7], 0.4 * u[8]);
    EXPECT_GT(u[9], 0.4 * u[8]);
    EXPECT_LT(u[8], 100 / springs.stretch);
    // (1 + s) e^{-s} at s = 4.2, and twice that at a free end.
    EXPECT_NEAR(u[15], 0.15 * u[8], 0.06 * u[8]);
}

TEST(Lateral, AnEndBeyondThePushIsNoThickerThanTheHairBeforeIt) {
    // Its height is r²/a with a = r + u, for a tuft pressed up to 5 mm from its point.
    const Recycled<double> at = nodes(32);
    const Recycled<double> r = pointed(at);
    LateralSide side = pushed(at, 0);
    for (std::size_t i = 8; at[i] < 0.027; ++i) side.push[i] = 1e4 * 1.8 * r[i];
    const LateralSprings springs{1e4, 1e4, 2.1e-3, 100, r};
    const Recycled<double> u = solve_lateral(at, springs, side);
    for (std::size_t i = 20; i < u.size(); ++i) {
        EXPECT_GT(u[i], -0.05 * r[i]) << i;
        EXPECT_LT(r[i] * r[i] / (r[i] + u[i]), r[i - 1] * r[i - 1] / (r[i - 1] + u[i - 1]) + 1e-5) << i;
    }
}

TEST(Lateral, AWallHoldsTheSideThatMeetsIt) {
    const Recycled<double> at = nodes(16);
    const LateralSprings springs{2e4, 2e4, 2e-3, 100, {}};
    LateralSide open = pushed(at, 40), walled = open;
    for (std::size_t i = 6; i < 10; ++i) walled.clear[i] = 5e-4;
    const Recycled<double> u = solve_lateral(at, springs, open), v = solve_lateral(at, springs, walled);
    for (std::size_t i = 6; i < 10; ++i) {
        EXPECT_GT(u[i], 1.5e-3);
        EXPECT_LT(v[i], 5.5e-4);  // gives by the push over 100 times the springs
    }
    EXPECT_GT(v[14], 0.8 * u[14]);
}

double tributary(const Recycled<double>& at, std::size_t i) {
    return 0.5 * (at[std::min(i + 1, at.size() - 1)] - at[i > 0 ? i - 1 : 0]);
}

TEST(Lateral, WhatTheSpringsStoreIsTheWorkOfThePushLessE) {
    Random random(11);
    const Recycled<double> at = nodes(16);
    const LateralSprings springs{2e4, 1.5e4, 2.5e-3, 100, pointed(at)};
    for (int trial = 0; trial < 10; ++trial) {
        LateralSide side = pushed(at, 0);
        for (double& q : side.push) q = random.uniform(0, 60);
        if (trial > 4) {
            for (std::size_t i = 5; i < 9; ++i) side.clear[i] = random.uniform(-1e-4, 4e-4);
        }
        const Recycled<double> u = solve_lateral(at, springs, side);
        double work = 0;
        for (std::size_t i = 1; i < u.size(); ++i) work += tributary(at, i) * side.push[i] * u[i];
        const double stored = lateral_energy(at, springs, side, u).value + work;
        EXPECT_NEAR(stored_at_rest(at, springs, side, u), stored, 1e-9 * stored);  // rounding
        EXPECT_GT(stored, 0);
    }
}

/// S(δ) + Σ w T |δ - d|.
double dragged(const Recycled<double>& at, const LateralSprings& springs, const LateralFriction& f,
               const Recycled<double>& shift) {
    double sum = 2 * lateral_energy(at, springs, pushed(at, 0), shift).value;
    for (std::size_t i = 1; i < shift.size(); ++i)
        sum += tributary(at, i) * f.most[i] * std::abs(shift[i] - f.stuck[i]);
    return sum;
}

TEST(Lateral, DraggedNodesStickOrSlipWithTheLeastOfStoredAndLost) {
    Random random(13);
    const Recycled<double> at = nodes(16);
    const LateralSprings springs{400, 400, 1.4e-3, 100, pointed(at)};
    int sticking = 0, slipping = 0;
    for (int trial = 0; trial < 40; ++trial) {
        LateralFriction f{Recycled<double>(at.size(), 0), Recycled<double>(at.size(), 0)};
        for (std::size_t i = 6; i < at.size(); ++i) {
            f.most[i] = random.uniform(0, 0.1);
            f.stuck[i] = random.uniform(-1e-4, 2e-4);
        }
        const LateralShift out = drag_lateral(at, springs, f);
        const double least = dragged(at, springs, f, out.shift);
        EXPECT_NEAR(out.stored, 2 * lateral_energy(at, springs, pushed(at, 0), out.shift).value, 1e-9 * least);
        for (std::size_t i = 6; i < at.size(); ++i)
            (std::abs(out.shift[i] - f.stuck[i]) < 1e-9 ? sticking : slipping)++;
        for (int other = 0; other < 20; ++other) {
            Recycled<double> v = out.shift;
            for (std::size_t i = 1; i < v.size(); ++i) v[i] += random.uniform(-1, 1) * std::pow(10.0, -5 - other % 3);
            // Fixed nodes are held by springs 1e8 times as stiff.
            EXPECT_GT(dragged(at, springs, f, v), least * (1 - 1e-7)) << trial;
        }
    }
    EXPECT_GT(sticking, 20);
    EXPECT_GT(slipping, 20);
}

TEST(Lateral, ADragShiftsTheSidesUntilTheirSpringsPullAsFrictionDoesAndLosesTheRest) {
    const Recycled<double> at = nodes(16);
    const LateralSprings springs{400, 400, 1.4e-3, 100, pointed(at)};
    LateralFriction f{Recycled<double>(at.size(), 0), Recycled<double>(at.size(), 0)};
    for (std::size_t i = 6; i < at.size(); ++i) f.most[i] = 0.05;
    LateralShift now;
    now.shift.assign(at.size(), 0);
    double brought = 0, lost = 0;
    const auto slide = [&](double travel) {  // of the tuft over the surface
        f.stuck = now.shift;
        for (std::size_t i = 6; i < at.size(); ++i) f.stuck[i] -= travel;
        const LateralShift next = drag_lateral(at, springs, f);
        double slipped = 0;
        for (std::size_t i = 6; i < at.size(); ++i)
            slipped += tributary(at, i) * f.most[i] * std::abs(next.shift[i] - f.stuck[i]);
        for (std::size_t i = 6; i < at.size(); ++i) brought += tributary(at, i) * f.most[i] * std::abs(travel);
        lost += slipped;
        // What is stored more was brought by friction on the way; the rest is lost.
        EXPECT_LE(next.stored + lost, brought + 1e-15);
        now = next;
    };
    slide(-1e-6);
    for (std::size_t i = 8; i < 14; ++i) EXPECT_NEAR(now.shift[i], 1e-6, 1e-12);  // sticks
    for (int k = 0; k < 500; ++k) slide(-2e-6);
    LateralSide side = pushed(at, 0);
    for (std::size_t i = 6; i < at.size(); ++i) side.push[i] = 0.025;  // each side's half
    const Recycled<double> whole = solve_lateral(at, springs, side);
    for (std::size_t i = 6; i < at.size(); ++i) EXPECT_NEAR(now.shift[i], whole[i], 1e-9);  // slips everywhere
    for (int k = 0; k < 500; ++k) slide(2e-6);
    for (std::size_t i = 6; i < at.size(); ++i) EXPECT_NEAR(now.shift[i], -whole[i], 1e-9);
    // Air holds nothing.
    f.most.assign(at.size(), 0);
    f.stuck = now.shift;
    EXPECT_LT(drag_lateral(at, springs, f).stored, 1e-9 * now.stored);
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
