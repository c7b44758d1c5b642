#include "brush/rod/coupled/coupled_rods.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace tuft::brush::rod {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// K straight rods side by side, `pitch` apart along x, of stiffness 1/K each, hanging along −z.
struct Row {
    Recycled<Rod> rods;
    Recycled<Memory> memories;
    Recycled<Clamp> clamps;
    Recycled<PairMemory> pair_memories;
    Recycled<Recycled<double>> touching;
    Recycled<Obstacle> obstacles;
    Law law;
    CouplingLaw coupling;
    Load load;

    Row(int count, double pitch, int n = 12, const Profile& profile = {.alpha = 0, .beta = 0}) {
        law.limits.tolerance = 1e-9;
        for (int k = 0; k < count; ++k) {
            Rod rod = make_rod(profile, n, 1);
            for (double& s : rod.stiffness) s /= count;
            rods.push_back(rod);
            clamps.push_back({.position = {(k - 0.5 * (count - 1)) * pitch, 0, 0}});
            memories.push_back(make_memory(rod, clamps.back()));
        }
        pair_memories.resize(count - 1);
        touching.assign(count - 1, Recycled<double>(n + 1, pitch));
    }
    Recycled<CoupledRod> problem() {
        Recycled<CoupledRod> out;
        for (std::size_t k = 0; k < rods.size(); ++k) {
            Load own = load;
            own.tip_force /= static_cast<double>(rods.size());
            out.push_back({&rods[k], &memories[k], clamps[k], obstacles, &law, own, {}});
        }
        return out;
    }
    Recycled<CoupledPair> pairs() {
        Recycled<CoupledPair> out;
        for (std::size_t k = 0; k + 1 < rods.size(); ++k)
            out.push_back(
                {static_cast<int>(k), static_cast<int>(k + 1), {1, 0}, touching[k], {}, {}, {}, {}, &pair_memories[k]});
        return out;
    }
    CoupledResult solve() { return solve_coupled(problem(), pairs(), coupling); }
};

Law soft_contact() {
    Law law;
    law.points_per_segment = 6;
    law.normal.stiffness = 2000;
    law.friction.coefficient = 0.3;
    law.normal.onset = 0.002;
    law.limits.tolerance = 1e-9;
    law.limits.pass_tolerance = 1e-8;
    law.limits.max_passes = 200;
    law.limits.max_iterations = 2000;
    return law;
}

/// The film's potential and its derivatives: force and stiffness are the differences of the value.
TEST(CoupledRods, PairForceIsTheDerivativeOfItsEnergy) {
    const CouplingLaw law{.contact = 400, .spread = 30, .film = 0.02, .film_range = 0.05};
    const double step = 1e-5;
    for (const double d : {0.17, 0.199, 0.201, 0.23, 0.249, 0.3}) {
        const PairEnergy at = pair_energy(law, 0.2, 0.22, d);
        const PairEnergy lo = pair_energy(law, 0.2, 0.22, d - step), hi = pair_energy(law, 0.2, 0.22, d + step);
        // Central differences: error of the order step² f''' and of rounding over step.
        EXPECT_NEAR(at.force, -(hi.value - lo.value) / (2 * step), 1e-6) << d;
        EXPECT_NEAR(at.stiffness, -(hi.force - lo.force) / (2 * step), 1e-3) << d;
    }
    EXPECT_NEAR(pair_energy(law, 0.2, 0.2, 0.2).force, 0, 1e-12) << "wet rest is at gap 0";
}

/// Uncoupled rods: K rods of stiffness 1/K bear the load of one.
TEST(CoupledRods, UncoupledRodsBearWhatOneBears) {
    Row row(5, 0.1);
    row.law = soft_contact();
    row.obstacles.assign(13, {{0, 0, -0.9}, {0, 0, 1}, 0.02});
    Rod one = make_rod({.alpha = 0, .beta = 0}, 12, 1);
    Memory memory = make_memory(one, {});
    Law law = row.law;
    row.law.normal.stiffness /= 5;
    row.law.friction.stick_stiffness /= 5;
    for (int i = 0; i < 8; ++i) {
        const double down = -0.01 * i;
        // Leaning, so that no hair stands upright and could fall to either side.
        const Vec3 tangent = glm::normalize(Vec3{0, 0.3, -1});
        for (Clamp& c : row.clamps) c = {{c.position.x, -0.01 * i, down}, tangent, {1, 0, 0}};
        const Clamp clamp{{0, -0.01 * i, down}, tangent, {1, 0, 0}};
        Recycled<Obstacle> obstacles = row.obstacles;
        const Result alone = solve(one, memory, clamp, {.obstacles = obstacles, .law = law});
        const CoupledResult all = row.solve();
        Vec3 force{0};
        for (const Result& r : all.rods) force += r.force;
        // Both stop at the same residual, 1e-9 of B0/L, over forces of the order 1.
        EXPECT_NEAR(glm::distance(force, alone.force), 0, 1e-6 * (1 + glm::length(alone.force))) << i;
    }
}

/// The step found by elimination in blocks solves the dense system.
TEST(CoupledRods, EliminationSolvesTheDenseSystem) {
    Row row(4, 0.08);
    row.law = soft_contact();
    row.law.normal.stiffness /= 4;
    row.obstacles.assign(13, {{0, 0, -0.85}, {0, 0.1, std::sqrt(1 - 0.01)}, 0.03});
    row.coupling = {.contact = 500, .spread = 20, .film = 0.01, .film_range = 0.02, .shear = 200, .friction = 0.3};
    for (int i = 0; i < 5; ++i) {
        for (Clamp& c : row.clamps) c.position = {c.position.x + 0.005, 0.01 * i, -0.01 * i};
        row.solve();
    }
    EXPECT_LT(elimination_residual(row.problem(), row.pairs(), row.coupling), 1e-9);
}

/// Rods that stick to each other bend across their row as a beam with shear layers:
///     w(L) = P L³/ΣB (1 − tanh x / x) / x²,  x² = (K − 1) k_s p² L² / ΣB.
TEST(CoupledRods, StickingRowIsStifferAcrossItsBroadSide) {
    for (const double x2 : {0.25, 4.0, 25.0}) {
        const int count = 5;
        const double pitch = 0.05;
        Row row(count, pitch, 24);
        // A film that holds the rods together under any pull of this load, so that all bend alike.
        row.coupling = {.contact = 1e7, .film = 1, .film_range = 1};
        row.coupling.friction = kInfinite;
        row.coupling.shear = x2 / ((count - 1) * pitch * pitch);
        const double load = 0.01;  // small slopes: w below 0.4 %
        row.load.tip_force = {load, 0, 0};
        row.solve();
        const CoupledResult r = row.solve();
        double w = 0;
        for (const Memory& m : row.memories) w += (m.node.back().x - m.node.front().x) / count;
        const double x = std::sqrt(x2), expected = load * (1 - std::tanh(x) / x) / x2;
        // Segments of 1/24, second order: 0.4 % at x² = 25.
        EXPECT_NEAR(w / expected, 1, 0.01) << "x² " << x2;
        // Never softer than rods that slide freely, nor stiffer than with the whole shear besides.
        const double stiffness = load / (3 * w);
        EXPECT_GT(stiffness, 0.999);
        EXPECT_LT(stiffness, 1 + x2);
    }
}

/// A wet film of work W zips two rods of stiffness B each from the gap d of their roots. Their curvature at the root is
/// κ = √(W'/B), W' the work less that of the contact, and they stay dry over √(3d/κ) = (9 B d²/W')^(1/4) [Bico2004,
/// Py2007].
TEST(CoupledRods, WetFilmZipsTwoRodsFromAGap) {
    constexpr int kSegments = 120, kFine = 96;
    constexpr double kFineLength = 0.42, stiffness = 0.5, film = 0.2, touching = 0.02;
    for (const double gap : {0.014, 0.02, 0.028}) {
        // Short segments where the film opens.
        Recycled<double> lengths(kFine, kFineLength / kFine);
        lengths.insert(lengths.end(), kSegments - kFine, (1 - kFineLength) / (kSegments - kFine));
        Row row(2, touching + gap, kSegments);
        row.touching[0].assign(kSegments + 1, touching);
        row.law.limits.max_iterations = 4000;
        row.law.limits.max_passes = 60;
        // A film thin beside the gap, and contact so stiff that the film's bond is stable.
        row.coupling = {.contact = 24 * film / 4e-6, .film = film, .film_range = 2e-3};
        const double overlap = row.coupling.rest_gap(), work = film - 0.5 * row.coupling.contact * overlap * overlap;
        const double curvature = std::sqrt(work / stiffness), dry = std::sqrt(3 * gap / curvature);
        for (int k = 0; k < 2; ++k) {
            row.rods[k] = make_rod({.alpha = 0, .beta = 0}, lengths);
            for (double& b : row.rods[k].stiffness) b *= stiffness;
            Memory& m = row.memories[k] = make_memory(row.rods[k], row.clamps[k]);
            // Drawn together first, so that the film has formed from the tip on.
            double s = 0;
            for (int j = 0; j < kSegments; s += lengths[j++]) {
                const double at = (s + 0.5 * lengths[j]) / dry, slope = at < 1 ? curvature * dry * at * (1 - at) : 0;
                m.tangent[j] = glm::normalize(Vec3{k == 0 ? slope : -slope, 0, -1});
            }
            m.node = nodes(row.rods[k], m);
        }
        CoupledResult r;
        for (int i = 0; i < 10; ++i) r = row.solve();
        // The moment falls evenly from B κ at the root to −B κ at the dry end: no force acts between.
        const int far = static_cast<int>(0.4 * dry / lengths[0]);
        const double near_root = r.rods[0].moment[1], further = r.rods[0].moment[far];
        const double fall = (near_root - further) / ((far - 1) * lengths[0]), root = near_root + fall * lengths[0];
        // The front stands between two nodes, 1.5 % of the dry length apart; a quarter of that at most was seen.
        EXPECT_NEAR(root / stiffness / curvature, 1, 0.01) << "gap " << gap;
        EXPECT_NEAR(2 * root / fall / dry, 1, 0.01) << "gap " << gap;
    }
}

/// Torque per radian of uncoupled rods whose tips are held, when their clamps turn about the middle, over that of as
/// many cantilevers: 3/L³ Σ B_k (x_k² + y_k²).
double roll_stiffness_ratio(Row row, std::span<const CoupledPair> pairs) {
    constexpr double kTurn = 1e-3;
    const std::size_t segments = row.rods.front().length.size();
    // Only the tips touch, so lightly that no rod buckles, and hold by friction.
    row.obstacles.assign(segments + 1, {{0, 0, -5}, {0, 0, 1}, 0});
    row.obstacles.back() = {{0, 0, -1}, {0, 0, 1}, 1e-4};
    row.law.normal.stiffness = 1e3;
    row.law.friction.stick_stiffness = 1e7;
    row.law.friction.coefficient = 1e3;
    row.law.limits.pass_tolerance = 1e-9;
    row.law.limits.max_passes = 300;
    row.law.limits.max_iterations = 4000;
    const auto count = static_cast<double>(row.rods.size());
    solve_coupled(row.problem(), pairs, row.coupling);
    double stiffness = 0, torque = 0;
    for (Clamp& c : row.clamps) {
        const Vec3 at = c.position;
        stiffness += 3 * (at.x * at.x + at.y * at.y) / count;
        c.position = {at.x * std::cos(kTurn) - at.y * std::sin(kTurn), at.x * std::sin(kTurn) + at.y * std::cos(kTurn),
                      0};
        c.side = {std::cos(kTurn), std::sin(kTurn), 0};
    }
    const CoupledResult r = solve_coupled(row.problem(), pairs, row.coupling);
    for (std::size_t k = 0; k < row.rods.size(); ++k) {
        const Vec3 &at = row.clamps[k].position, &force = r.rods[k].force;
        torque -= at.x * force.y - at.y * force.x;
    }
    return torque / kTurn / stiffness;
}

// Segments of 1/24, second order: 0.1 %.
TEST(CoupledRods, RollStiffnessIsThatOfItsCantilevers) {
    Row row(5, 0.1, 24);
    EXPECT_NEAR(roll_stiffness_ratio(row, row.pairs()), 1, 0.01);
}

/// The same of a ring of six round one in the middle.
TEST(CoupledRods, RollStiffnessOfARingIsThatOfItsCantilevers) {
    constexpr int kAround = 6;
    constexpr double kRadius = 0.15;
    Row row(kAround + 1, 0.1, 24);
    for (std::size_t k = 0; k < row.clamps.size(); ++k) {
        const double turn = 2 * std::numbers::pi * static_cast<double>(k) / kAround;
        row.clamps[k].position = k == 0 ? Vec3{0} : kRadius * Vec3{std::cos(turn), std::sin(turn), 0};
        row.memories[k] = make_memory(row.rods[k], row.clamps[k]);
    }
    EXPECT_NEAR(roll_stiffness_ratio(row, {}), 1, 0.01);
}

}  // namespace
}  // namespace tuft::brush::rod
