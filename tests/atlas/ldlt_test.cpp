#include "atlas/flatten/ldlt.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "atlas/flatten/dissection.h"
#include "core/random.h"
#include "core/system/parallel.h"

namespace tuft::atlas {
namespace {

/// A matrix, and where its rows lie.
struct Grid {
    SymmetricMatrix matrix;
    std::vector<Vec2> at;
};

/// Laplacian of n × n vertices, each square with one diagonal, under random weights; only edges that `has` lets in,
/// each stored in two halves as the two triangles beside it give them. `grounded` is added to the diagonal.
Grid laplacian(std::uint32_t n, double grounded, Random& random, const std::function<bool()>& has) {
    Grid grid;
    grid.matrix.diagonal.assign(std::size_t{n} * n, grounded);
    const auto connect = [&](std::uint32_t a, std::uint32_t b) {
        if (!has()) return;
        const double w = random.uniform(0.1, 2);
        grid.matrix.entries.push_back({a, b, -0.25 * w});
        grid.matrix.entries.push_back({b, a, -0.75 * w});
        grid.matrix.diagonal[a] += w;
        grid.matrix.diagonal[b] += w;
    };
    for (std::uint32_t y = 0; y < n; ++y)
        for (std::uint32_t x = 0; x < n; ++x) {
            const std::uint32_t i = y * n + x;
            grid.at.push_back({x, y});
            if (x + 1 < n) connect(i, i + 1);
            if (y + 1 < n) connect(i, i + n);
            if (x + 1 < n && y + 1 < n) connect(i, i + n + 1);
        }
    return grid;
}

/// Largest |A x − b| over the largest sum of magnitudes that it is the rounded rest of.
double residual(const SymmetricMatrix& a, const std::vector<Vec2>& x, const std::vector<Vec2>& b) {
    std::vector<Vec2> rest(b);
    double largest = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        rest[i] -= a.diagonal[i] * x[i];
        largest = std::max(largest, std::abs(a.diagonal[i]) * glm::length(x[i]));
    }
    for (const SymmetricMatrix::Entry& e : a.entries) {
        rest[e.row] -= e.value * x[e.column];
        rest[e.column] -= e.value * x[e.row];
    }
    double most = 0;
    for (const Vec2& r : rest) most = std::max(most, glm::length(r));
    return most / largest;
}

std::vector<Vec2> random_numbers(std::size_t n, Random& random) {
    std::vector<Vec2> b(n);
    for (Vec2& v : b) v = {random.uniform(-1, 1), random.uniform(-1, 1)};
    return b;
}

// Fronts of one pivot and of more than a panel, in one component and in thousands, also where the places of rows say
// nothing about them. Elimination of a diagonally dominant matrix is backward stable: a residual of some roundings,
// which grow like the square root of the 20 or so numbers in a row of L.
TEST(LdltFactor, SolvesToRounding) {
    Random random(11);
    LdltFactor factor;  // its memory serves all
    for (const std::uint32_t n : {1, 2, 7, 40, 90})
        for (const double share : {0.0, 0.5, 1.0})
            for (const bool scattered : {false, true}) {
                if (scattered && n > 40) continue;
                Grid grid = laplacian(n, 0.01, random, [&] { return share == 1 || random.uniform() < share; });
                if (scattered) {
                    grid.at = random_numbers(grid.at.size(), random);
                    grid.at[0].x = std::numeric_limits<double>::quiet_NaN();
                }
                const std::vector<Vec2> b = random_numbers(grid.at.size(), random);
                std::vector<Vec2> x = b;
                ASSERT_TRUE(factor.compute(grid.matrix, grid.at));
                factor.solve(x);
                EXPECT_LT(residual(grid.matrix, x, b), 1e-14) << n << ", " << share << ", " << scattered;
            }
}

// Large enough that threads share its subtrees, in one component and in several.
TEST(LdltFactor, HasTheSameBitsForAnyNumberOfThreads) {
    for (const double share : {0.45, 1.0}) {
        std::vector<std::vector<Vec2>> solutions;
        for (const int threads : {1, 2, 5}) {
            set_thread_count(threads);
            Random random(3);
            const Grid grid =
                laplacian(share < 1 ? 160 : 110, 0.01, random, [&] { return share == 1 || random.uniform() < share; });
            LdltFactor factor;
            ASSERT_TRUE(factor.compute(grid.matrix, grid.at));
            solutions.push_back(random_numbers(grid.at.size(), random));
            factor.solve(solutions.back());
        }
        set_thread_count(0);
        EXPECT_EQ(solutions[0], solutions[1]);
        EXPECT_EQ(solutions[0], solutions[2]);
    }
}

// A chart of two parts: what pulls at one moves nothing of the other, and it goes where it would go alone. The grids
// lie beside each other and on each other, where only their edges tell them apart; rows of both take turns.
TEST(LdltFactor, TwoSeparateGridsDoNotKnowOfEachOther) {
    constexpr std::uint32_t kSide = 110, kRows = kSide * kSide;
    Random random(21);
    const auto every = [] { return true; };
    const Grid one = laplacian(kSide, 0.01, random, every), other = laplacian(kSide, 0.01, random, every);
    Grid both;
    for (std::uint32_t i = 0; i < kRows; ++i)
        both.matrix.diagonal.insert(both.matrix.diagonal.end(), {one.matrix.diagonal[i], other.matrix.diagonal[i]});
    for (const auto& e : one.matrix.entries) both.matrix.entries.push_back({2 * e.row, 2 * e.column, e.value});
    for (const auto& e : other.matrix.entries)
        both.matrix.entries.push_back({2 * e.row + 1, 2 * e.column + 1, e.value});
    std::vector<Vec2> alone = random_numbers(kRows, random), pulled(2 * kRows, Vec2(0));
    for (std::uint32_t i = 0; i < kRows; ++i) pulled[2 * i] = alone[i];
    LdltFactor factor;
    ASSERT_TRUE(factor.compute(one.matrix, one.at));
    factor.solve(alone);
    for (const double apart : {0.0, 0.5, 2.0 * kSide}) {
        both.at.clear();
        for (const Vec2& p : one.at) both.at.insert(both.at.end(), {p, p + Vec2(apart, 0)});
        std::vector<Vec2> x = pulled;
        ASSERT_TRUE(factor.compute(both.matrix, both.at));
        factor.solve(x);
        EXPECT_LT(residual(both.matrix, x, pulled), 1e-14) << apart;
        double most = 0, off = 0;
        for (std::uint32_t i = 0; i < kRows; ++i) {
            ASSERT_EQ(x[2 * i + 1], Vec2(0)) << apart << ", row " << i;
            most = std::max(most, glm::length(alone[i]));
            off = std::max(off, glm::distance(x[2 * i], alone[i]));
        }
        // Rounding, 1e-16 in each of both, times how much larger than 0.01 the largest eigenvalue is, some 12.
        EXPECT_LT(off, 1e-12 * most) << apart;
    }
}

TEST(LdltFactor, RefusesWhatIsSingular) {
    LdltFactor factor;
    const std::vector<Vec2> at(4, Vec2(0));
    SymmetricMatrix matrix{.diagonal = {1, 1, 0, 1}, .entries = {}};
    EXPECT_FALSE(factor.compute(matrix, at));
    matrix.diagonal[2] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(factor.compute(matrix, at));
    matrix.diagonal[2] = 3;
    ASSERT_TRUE(factor.compute(matrix, at));
    std::vector<Vec2> x{{1, 2}, {3, 4}, {6, 9}, {7, 8}};
    factor.solve(x);
    EXPECT_EQ(x[2], (Vec2{2, 3}));
}

Neighbours neighbours_of(const SymmetricMatrix& matrix) {
    std::vector<std::vector<std::uint32_t>> next_to(matrix.diagonal.size());
    for (const SymmetricMatrix::Entry& e : matrix.entries) {
        next_to[e.row].push_back(e.column);
        next_to[e.column].push_back(e.row);
    }
    Neighbours graph{.start = {0}, .neighbours = {}};
    for (const std::vector<std::uint32_t>& all : next_to) {
        graph.neighbours.insert(graph.neighbours.end(), all.begin(), all.end());
        graph.start.push_back(static_cast<std::uint32_t>(graph.neighbours.size()));
    }
    return graph;
}

TEST(Dissection, JoinsNoTwoPartsButDescendantAndAncestor) {
    Random random(12);
    const Grid grid = laplacian(24, 0.01, random, [] { return true; });
    const Neighbours graph = neighbours_of(grid.matrix);
    const Dissection dissection = dissect(graph, grid.at);
    std::vector<std::uint32_t> sorted(dissection.order), all(grid.at.size());
    std::sort(sorted.begin(), sorted.end());
    std::iota(all.begin(), all.end(), 0u);
    ASSERT_EQ(sorted, all);
    std::vector<std::uint32_t> parent(dissection.parts.size()), roots, part_of(grid.at.size());
    std::uint32_t next = 0, largest = 0;
    for (std::uint32_t p = 0; p < parent.size(); ++p) {
        const Dissection::Part& part = dissection.parts[p];
        ASSERT_EQ(part.first, next);
        next += part.n;
        largest = std::max(largest, part.n);
        for (std::uint32_t i = 0; i < part.n; ++i) part_of[dissection.order[part.first + i]] = p;
        for (std::uint32_t c = 0; c < part.n_children; ++c, roots.pop_back()) parent[roots.back()] = p;
        parent[p] = p;
        roots.push_back(p);
    }
    for (std::uint32_t v = 0; v < grid.at.size(); ++v)
        for (std::uint32_t i = graph.start[v]; i < graph.start[v + 1]; ++i) {
            std::uint32_t low = std::min(part_of[v], part_of[graph.neighbours[i]]);
            const std::uint32_t high = std::max(part_of[v], part_of[graph.neighbours[i]]);
            while (low < high && parent[low] != low) low = parent[low];
            ASSERT_EQ(low, high) << v;
        }
    EXPECT_EQ(largest, 24u);  // a line across the middle of the grid
}

// The flat start of a long tube draws its tip together to one place, to rounding. Numbers of a scan's vertices say
// nothing: by them nearly all would be next to the other half.
TEST(Dissection, TellsVerticesAtOnePlaceApartByTheirNeighbours) {
    constexpr std::uint32_t kSide = 60;
    Random random(5);
    const Grid grid = laplacian(kSide, 0, random, [] { return true; });
    std::vector<std::uint32_t> number(grid.at.size());
    std::iota(number.begin(), number.end(), 0u);
    for (std::size_t i = number.size(); i-- > 1;)
        std::swap(number[i], number[static_cast<std::size_t>(random.uniform() * static_cast<double>(i + 1))]);
    SymmetricMatrix shuffled = grid.matrix;
    for (SymmetricMatrix::Entry& e : shuffled.entries) e.row = number[e.row], e.column = number[e.column];
    const Dissection dissection = dissect(neighbours_of(shuffled), std::vector<Vec2>(grid.at.size(), Vec2(0)));
    std::uint32_t largest = 0;
    for (const Dissection::Part& part : dissection.parts) largest = std::max(largest, part.n);
    // A front of a breadth-first search has up to 2 · 60 vertices of a grid with diagonals, two of them border a half.
    EXPECT_LE(largest, 4 * kSide);
}

}  // namespace
}  // namespace tuft::atlas
