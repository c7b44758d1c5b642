#include <gtest/gtest.h>

#include <cmath>

#include "brush/rod/rod.h"
#include "core/random.h"

namespace tuft::brush::rod {
namespace {

const Clamp kClamp{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

double tip_error(const Profile& profile, int n, const Vec3& load, const Vec3& exact) {
    const Rod rod = make_rod(profile, n, 0.6);
    Memory memory = make_memory(rod, kClamp);
    Law law;
    law.limits.tolerance = 1e-11;
    law.limits.max_iterations = 300;
    for (int i = 1; i <= 4; ++i) solve(rod, memory, kClamp, {.law = law, .load = {(0.25 * i) * load}});
    return glm::length(memory.node.back() - exact);
}

TEST(RodLaws, TipErrorFallsFourfoldWhenSegmentsDouble) {
    const Profile profile{-1, -0.8};
    // The exact tip of this load by Richardson from the two finest rods (order 2).
    const Rod fine = make_rod(profile, 128, 0.6);
    const Vec3 load{0, 0.6, 0};
    const auto tip = [&](int n) {
        const Rod rod = make_rod(profile, n, 0.6);
        Memory memory = make_memory(rod, kClamp);
        Law law;
        law.limits.tolerance = 1e-11;
        law.limits.max_iterations = 300;
        for (int i = 1; i <= 4; ++i) solve(rod, memory, kClamp, {.law = law, .load = {(0.25 * i) * load}});
        return memory.node.back();
    };
    const Vec3 exact = (4.0 * tip(128) - tip(64)) / 3.0;
    double before = tip_error(profile, 8, load, exact);
    for (const int n : {16, 32, 64}) {
        const double error = tip_error(profile, n, load, exact);
        EXPECT_NEAR(before / error, 4, 0.6) << n;  // second order, not yet quite asymptotic at 8
        before = error;
    }
}

TEST(RodLaws, SmallLoadsReduceToLinearTheory) {
    for (const Profile& profile : {Profile{0, 0}, Profile{-1, -0.8}, Profile{-2.5, -0.9}}) {
        const double load = 1e-4;
        const Rod rod = make_rod(profile, 64, 0.6);
        Memory memory = make_memory(rod, kClamp);
        Law law;
        law.limits.tolerance = 1e-13;
        solve(rod, memory, kClamp, {.law = law, .load = {{0, load, 0}}});
        const double w = small_deflection(profile, 1).w;
        // 64 segments: error of second order, below 0.1 % for these profiles.
        EXPECT_NEAR(memory.node.back().y / load, w, 2e-3 * w);
    }
}

/// A bent, yielded rod that presses on a tilted plane, or over a crease, and sticks and slips.
struct Scene {
    Rod rod;
    Memory memory;
    Law law;
    Recycled<Obstacle> plane;
    Recycled<Wall> walls;
};

enum class Under { plane, edge, corner, rim, walled };

Scene rough_scene(bool hard, Under under = Under::plane) {
    Scene s;
    s.rod = make_rod({-1, -0.8, 0.3, -1}, 8, 0.5);
    s.rod.plastic_share = 0.6;
    const Clamp high{{0, 0, 0.95}, glm::normalize(Vec3{0.2, 0.1, -1}), {}};
    Clamp clamp = high;
    clamp.side = glm::normalize(glm::cross(clamp.tangent, Vec3{0.3, 1, 0.2}));
    s.memory = make_memory(s.rod, clamp);
    s.law.normal.hard = hard;
    s.law.normal.stiffness = hard ? 1e3 : 60;
    s.law.normal.core_stiffness = 600;
    s.law.normal.core_start = 0.5;
    s.law.normal.onset = 0.01;
    s.law.adhesion.strength = 0.2;
    s.law.adhesion.range = 0.03;
    s.law.points_per_segment = 2;
    s.law.friction.coefficient = 0.4;
    s.law.friction.grain = 0.35;
    s.law.friction.pore_grip = 0.5;
    s.law.friction.stick_stiffness = 800;
    s.law.limits.max_iterations = 200;
    s.law.normal.end_compliance = 0.06;
    s.law.joints.damping = 0.7;
    s.law.edge = 0.04;
    Obstacle o;
    o.normal = glm::normalize(Vec3{0.1, -0.05, 1});
    s.plane.assign(9, o);
    if (under != Under::plane) {
        // The outer nodes' plane slopes away, or up, from where the tip will lie.
        Obstacle other = o;
        other.normal = glm::normalize(Vec3{0.1, under == Under::edge ? -0.6 : 0.6, 1});
        other.origin = {0.05, 0.1, 0.01};
        if (under == Under::edge || under == Under::corner) std::fill(s.plane.begin() + 6, s.plane.end(), other);
    }
    if (under == Under::rim) {
        // A rim of 90° under the outer half, which its nodes know from both faces.
        const Vec3 out = glm::normalize(Vec3{1, 0.4, 0} - glm::dot(Vec3{1, 0.4, 0}, o.normal) * o.normal);
        for (int i = 4; i <= 8; ++i) {
            s.plane[i].beyond_normal = out;
            s.plane[i].beyond_origin = 0.22 * out;
            if (i % 2 == 0) {
                std::swap(s.plane[i].normal, s.plane[i].beyond_normal);
                std::swap(s.plane[i].origin, s.plane[i].beyond_origin);
            }
        }
    }
    for (int i = 0; i <= 8; ++i) s.plane[i].radius = 0.08 * (1 - i / 8.5);
    for (int i = 0; i < 30; ++i) {
        clamp.position += Vec3{0.01 * std::sin(0.4 * i), 0.012, -0.008};
        solve(s.rod, s.memory, clamp, {.obstacles = s.plane, .law = s.law});
    }
    if (under == Under::walled) {
        // Beside the outer nodes, one of them an edge.
        for (const int i : {6, 8}) {
            const Vec3 n = glm::normalize(Vec3{-1, 0.3, 0.4}), beyond = glm::normalize(Vec3{0.2, 1, 0.3});
            const Vec3 at = s.memory.node[i] - 0.5 * s.plane[i].radius * glm::normalize(n + beyond);
            s.walls.push_back({i, at, n, s.plane[i].radius, 0.7, at, i == 6 ? beyond : Vec3{0}});
        }
    }
    return s;
}

TEST(RodLaws, WhichFaceOfAnEdgeANodeCallsItsOwnDoesNotMatter) {
    // Along a thin fin it changes from step to step. The nodes before it lie on a third face.
    const auto force = [](bool swapped) {
        Scene s = rough_scene(false, Under::plane);
        s.law.points_per_segment = 6;
        const Vec3 at = s.memory.node[7];
        for (int i = 7; i <= 8; ++i) {
            Obstacle& o = s.plane[i];
            const Vec3 foot = at - glm::dot(at - o.origin, o.normal) * o.normal;
            o.normal = glm::normalize(Vec3{0.9, 0.2, 1});
            o.origin = o.beyond_origin = foot;
            o.beyond_normal = glm::normalize(Vec3{0.8, 0.3, -0.4});
            if (swapped == (i == 7)) {
                std::swap(o.normal, o.beyond_normal);
                std::swap(o.origin, o.beyond_origin);
            }
        }
        Clamp clamp = s.memory.clamp;
        Result r;
        for (int i = 0; i < 10; ++i) {
            clamp.position += Vec3{0.004, 0.003, -0.004};
            r = solve(s.rod, s.memory, clamp, {.obstacles = s.plane, .law = s.law});
        }
        EXPECT_TRUE(r.converged);
        return r.force;
    };
    const Vec3 one = force(false), other = force(true);
    EXPECT_GT(glm::length(one), 1e-3);
    // Newton stops at a residual of 1e-7; friction's passes at 1 %.
    EXPECT_LT(glm::length(one - other), 1e-3 * glm::length(one));
}

TEST(RodLaws, GradientMatchesFiniteDifferences) {
    const std::pair<bool, Under> scenes[] = {{false, Under::plane},  {true, Under::plane}, {false, Under::edge},
                                             {false, Under::corner}, {false, Under::rim},  {false, Under::walled}};
    for (const auto& [hard, under] : scenes) {
        const Scene s = rough_scene(hard, under);
        ASSERT_TRUE(under == Under::corner || under == Under::rim || s.memory.joint[2].yielded);
        const Load load{{0.01, -0.02, 0.03}, 0, {}};
        const std::size_t size = 16;
        Recycled<double> x(size, 0.0);
        const SolveInput input{.obstacles = s.plane, .law = s.law, .load = load, .walls = s.walls};
        const Probe at = probe_energy(s.rod, s.memory, input, x);
        double largest = 0;
        for (const double g : at.gradient) largest = std::max(largest, std::abs(g));
        for (std::size_t i = 0; i < size; ++i) {
            constexpr double h = 1e-6;
            x[i] = h;
            const double up = probe_energy(s.rod, s.memory, input, x).value;
            x[i] = -h;
            const double down = probe_energy(s.rod, s.memory, input, x).value;
            x[i] = 0;
            // Central difference: h² times third derivatives, h times kinks of the second, round-off 1e-16/h.
            EXPECT_NEAR((up - down) / (2 * h), at.gradient[i], 1e-6 * (1 + largest))
                << i << " hard " << hard << " under " << static_cast<int>(under);
        }
    }
}

TEST(RodLaws, GradientMatchesAtRandomShapesToo) {
    Scene s = rough_scene(false);
    const Scene creased[] = {rough_scene(false, Under::edge), rough_scene(false, Under::corner),
                             rough_scene(false, Under::rim)};
    Random random(3);
    for (int trial = 0; trial < 60; ++trial) {
        if (trial % 20 == 0 && trial > 0) s = creased[trial / 20 - 1];
        for (Vec3& t : s.memory.tangent) {
            t = glm::normalize(t + 0.3 * Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
        }
        s.memory.node = nodes(s.rod, s.memory);
        Recycled<double> x(16, 0.0);
        const Probe at = probe_energy(s.rod, s.memory, {.obstacles = s.plane, .law = s.law}, x);
        // One random direction sums all components.
        Recycled<double> d(16);
        double slope = 0, scale = 0;
        for (std::size_t i = 0; i < 16; ++i) {
            d[i] = random.uniform(-1, 1);
            slope += d[i] * at.gradient[i];
            scale += std::abs(at.gradient[i]);
        }
        constexpr double h = 1e-6;
        for (std::size_t i = 0; i < 16; ++i) x[i] = h * d[i];
        const double up = probe_energy(s.rod, s.memory, {.obstacles = s.plane, .law = s.law}, x).value;
        for (std::size_t i = 0; i < 16; ++i) x[i] = -h * d[i];
        const double down = probe_energy(s.rod, s.memory, {.obstacles = s.plane, .law = s.law}, x).value;
        EXPECT_NEAR((up - down) / (2 * h), slope, 1e-5 * (1 + scale));
    }
}

TEST(RodLaws, PointsOverOnePlaneAddUpAsEachByItself) {
    // Planes that differ by round-off are met point by point, equal ones by the segment.
    const Scene s = rough_scene(false);
    Recycled<Obstacle> apart = s.plane;
    for (int i = 0; i <= 8; ++i) apart[i].normal = glm::normalize(apart[i].normal + Vec3{1e-12 * (i % 2), 0, 0});
    Random random(11);
    for (int trial = 0; trial < 20; ++trial) {
        Recycled<double> x(16);
        for (double& u : x) u = random.uniform(-0.2, 0.2);
        const Probe one = probe_energy(s.rod, s.memory, {.obstacles = s.plane, .law = s.law}, x);
        const Probe other = probe_energy(s.rod, s.memory, {.obstacles = apart, .law = s.law}, x);
        constexpr double kClose = 1e-8;  // the planes' angle times the stiffest second derivative, 10^4
        EXPECT_NEAR(one.value, other.value, kClose);
        for (std::size_t i = 0; i < 16; ++i) EXPECT_NEAR(one.gradient[i], other.gradient[i], kClose);
        for (std::size_t i = 0; i < one.hessian.size(); ++i) {
            EXPECT_NEAR(one.hessian[i], other.hessian[i], kClose * (1 + std::abs(other.hessian[i])));
        }
    }
}

TEST(RodLaws, EliminationAlongTheRodSolvesTheFullMatrix) {
    const Scene scenes[] = {rough_scene(false), rough_scene(true), rough_scene(false, Under::edge),
                            rough_scene(false, Under::corner), rough_scene(false, Under::rim)};
    constexpr int kSize = 16;
    Random random(7);
    int solved = 0;
    for (int trial = 0; trial < 50; ++trial) {
        const Scene& s = scenes[trial % 5];
        Recycled<double> x(kSize);
        for (double& u : x) u = trial < 5 ? 0 : random.uniform(-0.2, 0.2);
        const double damping = trial % 2 == 0 ? 0 : 3;
        const Probe at = probe_energy(s.rod, s.memory, {.obstacles = s.plane, .law = s.law}, x, damping);
        if (at.step.empty()) continue;
        ++solved;
        for (int i = 0; i < kSize; ++i) {
            const double outer = i / 2 + 1 < 8 ? s.rod.stiffness[i / 2 + 1] : 0;
            double sum = at.gradient[i] + damping * (s.rod.stiffness[i / 2] + outer) * at.step[i],
                   size = std::abs(at.gradient[i]);
            for (int k = 0; k < kSize; ++k) {
                const double part = at.hessian[kSize * std::min(i, k) + std::max(i, k)] * at.step[k];
                sum += part;
                size += std::abs(part);
            }
            EXPECT_NEAR(sum, 0, 1e-9 * size) << trial << " row " << i;  // rounding, by the condition of the pivots
        }
    }
    EXPECT_GT(solved, 30);
}

TEST(RodLaws, ThePotentialNeverRisesFromStepToStep) {
    // A run stopped after k iterations is the beginning of a longer one: Π at its end never rises with
    // k. Elastic and without friction, so that nothing but the shape changes from run to run.
    Random random(41);
    const Rod rod = make_rod({-1, -0.8}, 16, 0.5);
    int steps = 0;
    for (int trial = 0; trial < 40; ++trial) {
        Clamp clamp{{0, 0, random.uniform(0.55, 0.95)},
                    glm::normalize(Vec3{random.uniform(-0.8, 0.8), random.uniform(-0.8, 0.8), -1}),
                    {}};
        clamp.side = glm::normalize(glm::cross(clamp.tangent, Vec3{0.3, 1, 0.2}));
        Memory start = make_memory(rod, clamp);
        for (Vec3& t : start.tangent)
            t = glm::normalize(t + 0.3 * Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
        start.node = nodes(rod, start);
        Recycled<Obstacle> planes(17, {{0, 0, 0}, {0, 0, 1}, 0.06});
        Law law;
        law.points_per_segment = 6;
        law.normal.stiffness = 60;
        law.normal.core_stiffness = 3000;
        law.normal.onset = 1e-3;
        law.adhesion.strength = trial % 2 == 0 ? 0.5 : 0;
        law.adhesion.range = 0.03;
        law.limits.tolerance = 1e-9;
        if (trial % 4 == 1) {  // over an edge, each node by the face that it is nearest to
            law.edge = 6e-3;
            const Vec3 left = glm::normalize(Vec3{-0.5, 0, 1}), right = glm::normalize(Vec3{0.5, 0, 1});
            for (std::size_t i = 0; i < planes.size(); ++i) planes[i].normal = start.node[i].x < 0 ? left : right;
        }
        const Recycled<double> still(2 * 16, 0.0);
        double before = probe_energy(rod, start, {.obstacles = planes, .law = law}, still).value;
        const double first = before;
        for (int k = 1; k <= 60; ++k) {
            law.limits.max_iterations = k;
            Memory memory = start;
            const Result r = solve(rod, memory, clamp, {.obstacles = planes, .law = law});
            const double now = probe_energy(rod, memory, {.obstacles = planes, .law = law}, still).value;
            EXPECT_LE(now, before + 1e-11 * (1 + std::abs(first))) << trial << " after " << k;  // round-off
            steps += now < before;
            before = now;
            if (r.converged) break;
        }
        EXPECT_LT(before, first) << trial;
    }
    EXPECT_GT(steps, 200);
}

TEST(RodLaws, EndsThatMeetTheSurfaceEndOnHaveTheirCompliance) {
    // A straight stiff rod pushed down upright: the force follows k_e s²/2, k_e = 2 P/s_e², and
    // reaches the buckling load P at s_e, less where the give fades behind the tip.
    Rod rod = make_rod({0, 0}, 16, 0.3);
    const double give = 0.03, buckling = rod.buckling;
    for (double& k : rod.stiffness) k *= 1e6;
    Law law;
    law.normal.stiffness = 1e7;
    law.points_per_segment = 24;
    law.normal.end_compliance = give;
    law.friction.coefficient = 0;
    law.limits.max_iterations = 200;
    const Recycled<Obstacle> plane(17);
    double before = 0;
    for (int i = 1; i <= 10; ++i) {
        const double s = 0.1 * i * give;
        const Clamp clamp{{0, 0, 1 - s}, {0, 0, -1}, {1, 0, 0}};
        Memory memory = make_memory(rod, clamp);
        const Result r = solve(rod, memory, clamp, {.obstacles = plane, .law = law});
        ASSERT_TRUE(r.converged);
        // ∫ k_e(a) (s - a) da with 1/k_e fading as (1 - a/4 s_e)².
        double expected = 0;
        for (int k = 0; k < 1000; ++k) {
            const double a = (k + 0.5) * s / 1000, window = 1 - a / (4 * give);
            expected += 2 * buckling / (give * give) / (window * window) * (s - a) * s / 1000;
        }
        // Points 0.8 mm of 32 apart stand for the line: a trapezoidal rule.
        EXPECT_NEAR(r.force.z, expected, 0.03 * expected + 0.005 * buckling);
        EXPECT_GT(r.force.z, before);
        before = r.force.z;
    }
}

TEST(RodLaws, BucklingLoadOfAUniformColumn) {
    // Clamped below, held above: tan x = x, P = 20.1907 B0/L².
    EXPECT_NEAR(buckling_load(make_rod({0, 0}, 128, 1)), 20.1907, 0.01);
    // Second order in the segments, as the rod.
    const double coarse = buckling_load(make_rod({0, 0}, 16, 1)) - 20.1907;
    const double fine = buckling_load(make_rod({0, 0}, 32, 1)) - 20.1907;
    EXPECT_NEAR(coarse / fine, 4, 0.4);
}

TEST(RodLaws, DampingOnlyDelays) {
    // A released rod comes back as exp(-t/τ) and loses exactly what it had stored.
    const Rod rod = make_rod({0, 0}, 16, 1);
    const Clamp clamp{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    Memory memory = make_memory(rod, clamp);
    Law law;
    law.limits.tolerance = 1e-12;
    Result r = solve(rod, memory, clamp, {.law = law, .load = {{0, 0.2, 0}}});
    const double stored = r.bend_energy, start = memory.node.back().y;
    law.joints.damping = 50;  // τ/Δt
    double lost = 0;
    for (int i = 0; i < 50; ++i) {
        r = solve(rod, memory, clamp, {.law = law});
        lost += r.dissipation;
        EXPECT_LT(memory.node.back().y, start);
    }
    // Backward Euler: (1 + 1/50)^-50 = 0.3715 in place of 1/e; shapes this small are linear.
    EXPECT_NEAR(memory.node.back().y / start, std::pow(1.02, -50), 0.01);
    for (int i = 0; i < 600; ++i) lost += solve(rod, memory, clamp, {.law = law}).dissipation;
    // ∫ η κ̇² dt in steps of τ/50 counts half a step too little.
    EXPECT_NEAR(lost, stored, 0.02 * stored);
    EXPECT_LT(memory.node.back().y, 1e-4 * start);
}

TEST(RodLaws, RootCarriesWhatTheContactsGiveAndFrictionStaysInItsCone) {
    const Rod rod = make_rod({-1, -0.8}, 16, 0.5);
    Law law;
    law.normal.stiffness = 60;
    law.normal.core_stiffness = 3000;
    law.friction.coefficient = 0.35;
    law.friction.stick_stiffness = 2000;
    law.normal.onset = 2e-3;
    law.limits.tolerance = 1e-8;
    law.limits.pass_tolerance = 1e-3;
    law.limits.max_iterations = 2000;
    Recycled<Obstacle> plane(17);
    for (int i = 0; i <= 16; ++i) plane[i].radius = 0.09 * (1 - i / 16.2);
    Clamp clamp{{0, 0, 0.98}, glm::normalize(Vec3{0.1, 0, -1}), {0, 1, 0}};
    Memory memory = make_memory(rod, clamp);
    for (int i = 0; i < 200; ++i) {
        const Vec3 v = i < 50 ? Vec3{0.002, 0, -0.006} : Vec3{0.01 * std::cos(0.02 * i), 0.01 * std::sin(0.02 * i), 0};
        clamp.position += v;
        const Recycled<Vec3> before = memory.node;
        const Result r = solve(rod, memory, clamp, {.obstacles = plane, .law = law});
        ASSERT_TRUE(r.converged) << i;
        // The clamp joint's moment balances all contact forces about the root.
        Vec3 moment{0};
        for (int k = 1; k <= 16; ++k) {
            moment += glm::cross(memory.node[k] - memory.node[0], r.contact_force[k]);
            EXPECT_GE(r.normal_force[k], 0);
            const Vec3 f = r.contact_force[k];
            const double tangential = std::hypot(f.x, f.y);
            // N̂ lags by at most the pass tolerance of the whole force.
            EXPECT_LE(tangential, law.friction.coefficient * r.normal_force[k] + 1e-3 * r.force.z);
            if (tangential > 0.99 * law.friction.coefficient * r.normal_force[k] && i > 60) {
                EXPECT_LE(f.x * (memory.node[k] - before[k]).x + f.y * (memory.node[k] - before[k]).y, 1e-9);
            }
        }
        const Vec3 bending = moment - glm::dot(moment, clamp.tangent) * clamp.tangent;
        EXPECT_NEAR(glm::length(bending), r.moment[0], 1e-6 + 1e-3 * r.moment[0]);
        EXPECT_GE(r.dissipation, 0);
    }
}

TEST(RodLaws, WorkOfTheHandEqualsStoredPlusLostEnergy) {
    // Closed press, drag and lift: everything the hand put in was lost by slip and yielding.
    Rod rod = make_rod({-1, -0.8, 0.6, -1}, 16, 0.5);
    rod.plastic_share = 0.3;
    Law law;
    law.normal.stiffness = 60;
    law.normal.core_stiffness = 3000;
    law.friction.coefficient = 0.3;
    law.friction.stick_stiffness = 4000;
    law.limits.pass_tolerance = 1e-4;
    law.limits.tolerance = 1e-9;
    law.limits.max_iterations = 300;
    law.limits.max_passes = 40;
    Recycled<Obstacle> plane(17);
    for (int i = 0; i <= 16; ++i) plane[i].radius = 0.09 * (1 - i / 16.2);
    // With all that takes energy on the way: ends that give, damped joints, a set that recovers.
    law.normal.end_compliance = 0.016;
    law.friction.end_share = 0.2;
    law.joints.damping = 2;
    law.joints.recovery = 1e-3;
    Clamp clamp{{0, 0, 1.01}, glm::normalize(Vec3{0.15, 0, -1}), {0, 1, 0}};
    Memory memory = make_memory(rod, clamp);
    double work = 0, lost = 0;
    Vec3 force{0};
    Result r;
    const auto go = [&](const Vec3& d) {
        clamp.position += d;
        r = solve(rod, memory, clamp, {.obstacles = plane, .law = law});
        // The hand holds against the contact force: work is -F·d, by the trapezoidal rule.
        work -= 0.5 * glm::dot(force + r.force, d);
        force = r.force;
        lost += r.dissipation;
    };
    for (int i = 0; i < 400; ++i) go({-0.0002, 0, -0.0008});
    for (int i = 0; i < 600; ++i) go({-0.001, 0, 0});
    for (int i = 0; i < 450; ++i) go({-0.0002, 0, 0.0008});
    EXPECT_EQ(glm::length(r.force), 0);
    EXPECT_NEAR(work, lost + r.bend_energy, 0.02 * work);
    EXPECT_GT(lost, 0);
}

TEST(RodLaws, ARecoveringSetOnlyLosesEnergyAndComesBack) {
    Rod rod = make_rod({-1, -0.8, 0.3, -1}, 16, 0.5);
    rod.plastic_share = 0.5;
    Memory memory = make_memory(rod, kClamp);
    Law law;
    law.limits.tolerance = 1e-10;
    law.limits.max_iterations = 300;
    for (int i = 1; i <= 20; ++i) solve(rod, memory, kClamp, {.law = law, .load = {{0, 0.02 * i, 0}}});
    Result r = solve(rod, memory, kClamp, {.law = law});
    const double set = memory.node.back().y;
    ASSERT_GT(set, 0.02);
    law.joints.recovery = 0.05;
    double stored = r.bend_energy, before = set;
    const double at_start = stored;
    double lost = 0;
    for (int i = 0; i < 400; ++i) {
        r = solve(rod, memory, kClamp, {.law = law});
        EXPECT_LE(r.bend_energy, stored + 1e-12);
        EXPECT_GE(r.dissipation, 0);
        EXPECT_LE(memory.node.back().y, before + 1e-9);
        stored = r.bend_energy;
        before = memory.node.back().y;
        lost += r.dissipation;
    }
    // No hand works here: what was stored is lost, to first order in the time step.
    EXPECT_NEAR(lost, at_start - stored, 0.05 * at_start);
    EXPECT_LT(before, 0.15 * set);
    // Bent hair that is held gains nothing by waiting.
    law.joints.recovery = 0;
    solve(rod, memory, kClamp, {.law = law, .load = {{0, 0.3, 0}}});
    law.joints.recovery = 0.2;
    const double held = memory.node.back().y;
    for (int i = 0; i < 20; ++i) solve(rod, memory, kClamp, {.law = law, .load = {{0, 0.3, 0}}});
    EXPECT_GE(memory.node.back().y, held - 1e-3);
}

TEST(RodLaws, ElasticFrictionlessCycleReturnsExactly) {
    const Rod rod = make_rod({-1, -0.8}, 16, 0.5);
    Law law;
    law.normal.stiffness = 60;
    law.normal.core_stiffness = 3000;
    law.limits.tolerance = 1e-11;
    law.limits.max_iterations = 2000;
    Recycled<Obstacle> plane(17);
    for (int i = 0; i <= 16; ++i) plane[i].radius = 0.09 * (1 - i / 16.2);
    Clamp clamp{{0, 0, 0.8}, glm::normalize(Vec3{0.3, 0, -1}), {0, 1, 0}};
    Memory memory = make_memory(rod, clamp);
    solve(rod, memory, clamp, {.obstacles = plane, .law = law});
    const Recycled<Vec3> start = memory.node;
    for (int i = 1; i <= 40; ++i) {
        Clamp c = clamp;
        const double a = 2 * 3.14159265358979 * i / 40;
        c.position += Vec3{0.2 * (1 - std::cos(a)), 0.15 * std::sin(a), 0.1 * std::sin(a)};
        if (i == 40) c = clamp;
        solve(rod, memory, c, {.obstacles = plane, .law = law});
    }
    for (std::size_t i = 0; i < start.size(); ++i) {
        EXPECT_LT(glm::length(memory.node[i] - start[i]), 1e-8);  // solver tolerance over the softest joint
    }
}

}  // namespace
}  // namespace tuft::brush::rod
