#include "brush/tuft/shape/lattice.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tuft::brush {
namespace {

/// A resting lattice of `spines` spines, its frames moved by f.
template <class F>
LatticeInput lattice_of(std::size_t spines, F f) {
    LatticeInput in{
        .at = {0, 0.3, 0.55, 0.8, 1}, .spine_x = {}, .frames = {}, .lo = {-6e-3, -2e-3}, .hi = {5e-3, 3e-3}};
    for (std::size_t s = 0; s < spines; ++s) {
        in.spine_x.push_back(spines == 1 ? 0 : -3e-3 + 6e-3 * static_cast<double>(s));
        in.frames.emplace_back();
        for (const double at : in.at) in.frames.back().push_back(f(Vec3{in.spine_x[s], 0, -0.03 * at}));
    }
    return in;
}

Vec3 image(const SpineLattice& lattice, const LatticeInput& in, const Vec3& p) {
    return lattice.at(lattice_place(in.at, in.lo, in.hi, Vec2(p), -p.z / 0.03));
}

// Bernstein polynomials reproduce linear functions: nothing but rounding is left.
TEST(Lattice, IsExactForAffineMotions) {
    const Mat3 a(Vec3{1.1, 0.2, -0.3}, Vec3{0.1, 0.9, 0.4}, Vec3{-0.2, 0.3, 1.2});
    const Vec3 shift{0.01, -0.02, 0.03};
    for (const std::size_t spines : {1u, 2u}) {
        const LatticeInput in = lattice_of(spines, [&](const Vec3& p) {
            return LatticeFrame{a * p + shift, a[0], a[1]};
        });
        const SpineLattice lattice(in);
        for (double x = -6e-3; x <= 5e-3; x += 1.1e-3)
            for (double y = -2e-3; y <= 3e-3; y += 1e-3)
                for (double z = -0.03; z <= 0; z += 2.3e-3) {
                    const Vec3 p{x, y, z};
                    EXPECT_NEAR(glm::length(image(lattice, in, p) - (a * p + shift)), 0, 1e-12);
                }
    }
}

TEST(Lattice, PassesThroughTheNodesOfABentSpineWithoutAKink) {
    const auto bent = [](const Vec3& p) {
        const double w = -p.z / 0.03;
        return LatticeFrame{{0.02 * std::sin(w), 0, -0.02 * (1 - std::cos(w)) - 0.01 * w}, {1, 0, 0}, {0, 1, 0}};
    };
    const LatticeInput in = lattice_of(1, bent);
    const SpineLattice lattice(in);
    for (std::size_t k = 0; k < in.at.size(); ++k)
        EXPECT_NEAR(glm::length(image(lattice, in, {0, 0, -0.03 * in.at[k]}) - in.frames[0][k].centre), 0, 1e-15);
    for (std::size_t k = 1; k + 1 < in.at.size(); ++k) {
        const double h = 1e-6;
        const auto at = [&](double u) { return image(lattice, in, {1e-3, 1e-3, -0.03 * u}); };
        const Vec3 before = (at(in.at[k]) - at(in.at[k] - h)) / h, after = (at(in.at[k] + h) - at(in.at[k])) / h;
        EXPECT_NEAR(glm::length(before - after), 0, 1e-6);  // curvature times h
    }
}

// Between two spines that part, what each carries outside them stays with it.
TEST(Lattice, TwoSpinesCarryTheirOwnSides) {
    const auto parted = [](const Vec3& p) {
        return LatticeFrame{p + Vec3{p.x < 0 ? -2e-3 : 2e-3, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    };
    const LatticeInput in = lattice_of(2, parted);
    const SpineLattice lattice(in);
    EXPECT_NEAR(image(lattice, in, {-6e-3, 0, -0.01}).x, -8e-3, 1e-12);
    EXPECT_NEAR(image(lattice, in, {5e-3, 0, -0.01}).x, 7e-3, 1e-12);
}

}  // namespace
}  // namespace tuft::brush
