#include "atlas/flatten/planar_factor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "atlas/flatten/dissection.h"

namespace tuft::atlas {
namespace {

using Faces = std::vector<std::array<std::uint32_t, 3>>;

struct Piece {
    std::vector<Vec2> at;
    Faces faces;
};

/// A grid of n × m squares, halved, with places that are shaken.
Piece grid(std::uint32_t n, std::uint32_t m, unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> shake(-0.3, 0.3);
    Piece p;
    for (std::uint32_t j = 0; j <= m; ++j)
        for (std::uint32_t i = 0; i <= n; ++i)
            p.at.push_back({i + shake(random), j + shake(random)});
    for (std::uint32_t j = 0; j < m; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
            p.faces.push_back({a, b, d});
            p.faces.push_back({a, d, c});
        }
    return p;
}

/// Σ w (x_i − x_j)² over the edges, w between 0.5 and 1.5, in the dissection's order; one vertex
/// more, which stays, holds the first.
std::vector<LowerMatrix::Entry> stiffness(const Piece& p, const Dissection& d, unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> weight(0.5, 1.5);
    std::vector<std::uint32_t> slot(p.at.size());
    for (std::uint32_t i = 0; i < d.order.size(); ++i) slot[d.order[i]] = i;
    std::vector<LowerMatrix::Entry> entries{{slot[0], slot[0], 1.0}};
    for (const auto& f : p.faces)
        for (int k = 0; k < 3; ++k) {
            const auto [i, j] = std::minmax(slot[f[k]], slot[f[(k + 1) % 3]]);
            const double w = weight(random);
            entries.push_back({i, i, w});
            entries.push_back({j, j, w});
            entries.push_back({j, i, -w});
        }
    return entries;
}

/// The matrix times x.
std::vector<Vec2> times(const std::vector<LowerMatrix::Entry>& lower, const std::vector<Vec2>& x) {
    std::vector<Vec2> y(x.size(), Vec2(0));
    for (const auto& [row, column, value] : lower) {
        y[row] += value * x[column];
        if (row != column) y[column] += value * x[row];
    }
    return y;
}

std::vector<Vec2> right_hand_sides(std::size_t n) {
    std::mt19937_64 random(9);
    std::normal_distribution<double> normal;
    std::vector<Vec2> b(n);
    for (Vec2& v : b) v = {normal(random), normal(random)};
    return b;
}

TEST(Dissection, PartsMeetInTheirCutsOnly) {
    for (Piece p : {grid(60, 45, 1), grid(300, 7, 2), grid(2, 2, 3)}) {
        for (const bool on_itself : {false, true}) {
            if (on_itself)
                for (Vec2& at : p.at) at = Vec2(0);
            const Dissection d = dissect(p.at, p.faces);
            ASSERT_EQ(d.order.size(), p.at.size());
            std::vector<std::uint32_t> node_of(p.at.size(), Dissection::kNoParent);
            std::uint32_t end = 0;
            for (std::uint32_t i = 0; i < d.nodes.size(); ++i) {
                EXPECT_EQ(d.nodes[i].begin, end) << "one after the other";
                end = d.nodes[i].end;
                EXPECT_GT(d.nodes[i].parent, i) << "or none, which is the highest number";
                for (std::uint32_t k = d.nodes[i].begin; k < end; ++k) {
                    EXPECT_EQ(node_of[d.order[k]], Dissection::kNoParent) << "in one only";
                    node_of[d.order[k]] = i;
                }
            }
            EXPECT_EQ(end, p.at.size());
            const auto above = [&](std::uint32_t node, std::uint32_t of) {
                while (of != Dissection::kNoParent && of != node) of = d.nodes[of].parent;
                return of == node;
            };
            for (const auto& f : p.faces)
                for (int k = 0; k < 3; ++k) {
                    const std::uint32_t a = node_of[f[k]], b = node_of[f[(k + 1) % 3]];
                    EXPECT_TRUE(above(a, b) || above(b, a)) << "an edge past a cut";
                }
        }
    }
}

// A cut straight across a square takes one row of its vertices, or two where they are shaken.
TEST(Dissection, CutsAreShortAlsoWhereTheMeshLiesOnItself) {
    const std::uint32_t n = 70;
    Piece square = grid(n, n, 4);
    const Dissection flat = dissect(square.at, square.faces);
    EXPECT_LE(flat.nodes.back().end - flat.nodes.back().begin, 2 * (n + 1));
    // Without places to go by it follows the edges from a corner: a front of them is the diagonal
    // at most.
    for (Vec2& at : square.at) at = Vec2(0);
    const Dissection steps = dissect(square.at, square.faces);
    EXPECT_LE(steps.nodes.back().end - steps.nodes.back().begin, 2 * (n + 1));
}

TEST(PlanarFactor, SolvesForTwoRightHandSides) {
    for (Piece p : {grid(1, 1, 5), grid(17, 23, 6), grid(3, 400, 7), grid(150, 110, 10)}) {
        for (const bool on_itself : {false, true}) {
            if (on_itself)
                for (Vec2& at : p.at) at.x = 0;
            const Dissection d = dissect(p.at, p.faces);
            const auto entries = stiffness(p, d, 8);
            PlanarFactor factor;
            ASSERT_TRUE(factor.compute(LowerMatrix(p.at.size(), entries), d));
            const std::vector<Vec2> b = right_hand_sides(p.at.size());
            std::vector<Vec2> x = b;
            factor.solve(x);
            const std::vector<Vec2> back = times(entries, x);
            double largest = 0, residual = 0;
            for (std::size_t i = 0; i < x.size(); ++i) {
                largest = std::max({largest, std::abs(x[i].x), std::abs(x[i].y)});
                residual = std::max(
                    {residual, std::abs(back[i].x - b[i].x), std::abs(back[i].y - b[i].y)});
            }
            // Backward stable: 2^-53 of the solution times rows that sum to 18, times some hundred
            // steps of elimination.
            EXPECT_LT(residual, 100 * 18 * std::ldexp(largest, -53));
        }
    }
}

// Of the path 0 - 1 - 2 with springs of 1 and 2, held at 0 by one of 4: from A x = b by hand.
TEST(PlanarFactor, SolvesThreeSpringsAsByHand) {
    const Dissection d = dissect(std::vector<Vec2>(3, Vec2(0)), {});
    const std::vector<LowerMatrix::Entry> entries{
        {0, 0, 5}, {1, 0, -1}, {1, 1, 3}, {2, 1, -2}, {2, 2, 2}};
    PlanarFactor factor;
    ASSERT_TRUE(factor.compute(LowerMatrix(3, entries), d));
    std::vector<Vec2> x{{0, 4}, {0, 0}, {2, 0}};  // pulled by 2 at the end; by 4 at the beginning
    factor.solve(x);
    const std::vector<Vec2> exact{{0.5, 1}, {2.5, 1}, {3.5, 1}};
    // A few roundings of numbers up to 5.
    for (int i = 0; i < 3; ++i) EXPECT_LT(glm::distance(x[i], exact[i]), 1e-14) << i;
}

TEST(PlanarFactor, RefusesWhatHasNoPivot) {
    const Piece p = grid(5, 5, 12);
    const Dissection d = dissect(p.at, p.faces);
    const auto entries = stiffness(p, d, 13);
    PlanarFactor factor;
    for (const double bad : {0.0, std::nan(""), HUGE_VAL}) {
        auto spoilt = entries;
        for (auto& e : spoilt)
            if (bad == 0 || e.column == 7) e.value = bad;
        EXPECT_FALSE(factor.compute(LowerMatrix(p.at.size(), spoilt), d)) << bad;
    }
    EXPECT_TRUE(factor.compute(LowerMatrix(p.at.size(), entries), d)) << "and goes on";
}

}  // namespace
}  // namespace tuft::atlas
