#include "brush/papers/chain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "brush/papers/active_set.h"
#include "brush/papers/chain_lateral.h"
#include "brush/papers/chain_solver.h"
#include "brush/papers/space/lattice.h"
#include "brush/preset/rest_shape.h"

namespace tuft::brush {
namespace {

/// Third column along −z, as the ferrule's axis of a brush that stands upright.
const Mat3 kUpright{Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, -1}};

/// A chain over the sheet z = 0 whose root is at `height`, its axis tilted by `lean` towards +x, without friction.
struct OnSheet {
    ChainSpine spine;
    std::vector<Vec2> rest;
    std::vector<ChainContact> contact;
    ChainProblem problem;

    OnSheet(int n, double exponent, double lean, const Profile& profile = {.alpha = 0, .beta = 0})
        : spine(make_chain_spine(profile, spine_segments(n, 1), exponent)),
          rest(static_cast<std::size_t>(n), Vec2{0}),
          contact(static_cast<std::size_t>(n)) {
        const double c = std::cos(lean), s = std::sin(lean);
        problem.frame = Mat3{Vec3{c, 0, s}, Vec3{0, -1, 0}, Vec3{s, 0, -c}};
        problem.rest = rest;
        problem.contact = contact;
    }

    ChainSolution press(double height, std::vector<Vec2>& bend) {
        problem.root = {0, 0, height};
        problem.before = bend;
        ChainSolution s = solve_chain(spine, bend, problem);
        bend = s.bend;
        return s;
    }
};

TEST(ActiveSet, FindsTheConditionsOfKarushKuhnAndTucker) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    for (int run = 0; run < 200; ++run) {
        const std::size_t n = 1 + static_cast<std::size_t>(run) % 12;
        std::vector<double> a(n * n), q(n * n, 0), b(n), start(n);
        for (double& v : a) v = normal(random);
        for (double& v : b) v = normal(random);
        for (double& v : start) v = std::max(0.0, normal(random));
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j) {
                for (std::size_t k = 0; k < n; ++k) q[i * n + j] += a[i * n + k] * a[j * n + k];
            }
            q[i * n + i] += 0.01;
        }
        const std::vector<double> x = minimise_nonnegative(q, b, start);
        for (std::size_t i = 0; i < n; ++i) {
            double slope = b[i];
            for (std::size_t j = 0; j < n; ++j) slope += q[i * n + j] * x[j];
            // Condition up to 1e4 times rounding.
            EXPECT_GE(x[i], 0);
            EXPECT_GE(slope, -1e-9);
            EXPECT_NEAR(x[i] * slope, 0, 1e-9 * (1 + x[i]));
        }
    }
}

TEST(Chain, OfExponentTwoHasTheRodsJoints) {
    const Profile profile{.alpha = -1.5, .beta = -0.8, .floor = 1e-3};
    const std::vector<double> lengths = spine_segments(16, 0.5);
    const ChainSpine spine = make_chain_spine(profile, lengths, 2);
    for (std::size_t j = 0; j < lengths.size(); ++j) {
        double from = 0;
        for (std::size_t k = 0; k + 1 < j; ++k) from += lengths[k];
        const double begin = j > 0 ? from + 0.5 * lengths[j - 1] : 0;
        const double end = (j > 0 ? from + lengths[j - 1] : 0) + 0.5 * lengths[j];
        // ½ k β² with k = 1/∫ds/B; both by 8-point Gauss.
        EXPECT_NEAR(2 * spine.coefficient[j] * compliance(profile, begin, end), 1, 1e-12);
    }
}

TEST(Chain, CoefficientTimesLengthToThePowerIsKeptByRefinement) {
    for (const double m : {2.0, 3.0, 4.0}) {
        const Profile uniform{.alpha = 0, .beta = 0};
        const ChainSpine coarse = make_chain_spine(uniform, spine_segments(8, 1), m);
        const ChainSpine fine = make_chain_spine(uniform, spine_segments(32, 1), m);
        EXPECT_NEAR(coarse.coefficient[4] * std::pow(coarse.length[4], m - 1),
                    fine.coefficient[4] * std::pow(fine.length[4], m - 1), 1e-12);
    }
}

TEST(Chain, SmallTipForceGrowsWithDepthToThePowerOfMLessOne) {
    for (const double m : {2.0, 3.0, 4.0}) {
        OnSheet s(16, m, 0.6);
        double force[2];
        for (int k = 0; k < 2; ++k) {
            std::vector<Vec2> bend(16, Vec2{1e-4});
            s.problem.max_iterations = 400;  // |w|^4 is met by halves
            const ChainSolution at = s.press(std::cos(0.6) - 5e-4 * (k + 1), bend);
            ASSERT_TRUE(at.converged);
            force[k] = at.pressure.back();
        }
        // The lever changes by a part of the depth over the length, 1e-3.
        EXPECT_NEAR(std::log2(force[1] / force[0]), m - 1, 0.01) << m;
    }
}

/// J(p) = ∫ cos^p over a quarter turn, p > −1: √π Γ((p+1)/2) / (2 Γ(p/2+1)).
double quarter_integral(double p) {
    return 0.5 * std::sqrt(std::numbers::pi) * std::tgamma(0.5 * (p + 1)) / std::tgamma(0.5 * p + 1);
}

TEST(Chain, UprightUniformChainLiesFlatFromItsClosedForm) {
    for (const double m : {2.0, 3.0}) {
        const double exact = 1 - quarter_integral(1 - 1 / m) / quarter_integral(-1 / m);
        const auto flat_from = [&](int n) {
            OnSheet s(n, m, 0);
            std::vector<Vec2> bend(static_cast<std::size_t>(n), Vec2{0, -0.02});
            double height = 0.999;
            // Flat: the tip's neighbour lies too.
            const auto lies = [&](double at, std::vector<Vec2>& state) {
                return s.press(at, state).pressure[static_cast<std::size_t>(n) - 1] > 0;
            };
            for (;; height -= 0.005) {
                std::vector<Vec2> next = bend;
                if (lies(height - 0.005, next)) break;
                bend = next;
            }
            double low = height - 0.005;
            for (int k = 0; k < 20; ++k) {
                std::vector<Vec2> next = bend;
                (lies(0.5 * (low + height), next) ? low : height) = 0.5 * (low + height);
            }
            return 1 - height;
        };
        const double coarse = flat_from(24), fine = flat_from(48);
        // The last segment lies flat a segment's length early: first order in 1/n, so twice the finer less the coarser.
        EXPECT_NEAR(2 * fine - coarse, exact, 0.004) << m;
        EXPECT_LT(std::abs(fine - exact), 0.6 * std::abs(coarse - exact)) << m;
    }
    EXPECT_NEAR(1 - quarter_integral(0.5) / quarter_integral(-0.5), 0.543, 5e-4);
}

TEST(Chain, JointMomentsBalanceTheForcesOutboard) {
    OnSheet s(16, 3, 0.3, {.alpha = -1, .beta = -0.8, .floor = 1e-3});
    for (ChainContact& c : s.contact) c.normal_force = 0.2;
    s.problem.contact = s.contact;
    s.problem.friction = {.coefficient = 0.3, .grain = 0.4, .with_hair = 0.3, .along = {1, 0, 0}, .smoothing = 1e-3};
    s.problem.max_iterations = 200;
    std::vector<Vec2> bend(16, Vec2{0.01, -0.05});
    const ChainSolution at = s.press(0.6, bend);
    ASSERT_TRUE(at.converged);
    Mat3 frame = s.problem.frame;
    for (std::size_t j = 0; j < 16; ++j) {
        Vec3 moment{0};
        for (std::size_t i = j + 1; i <= 16; ++i) moment += glm::cross(at.node[i] - at.node[j], at.force[i]);
        // The spring turns about w, which lies in the frame of the segment inside and turns with neither.
        const double size = glm::length(bend[j]);
        const Vec3 about = (bend[j].x * frame[0] + bend[j].y * frame[1]) / size;
        const double spring = 3 * s.spine.coefficient[j] * size * size;
        // Nodes are settled to 1e-7 lengths; the stiffest contact is a constraint.
        EXPECT_NEAR(glm::dot(moment, about), spring, 1e-4) << j;
        const Vec3 axis = about;
        frame = Mat3(glm::angleAxis(size, axis) * frame[0], glm::angleAxis(size, axis) * frame[1],
                     glm::angleAxis(size, axis) * frame[2]);
    }
}

TEST(Chain, FrictionAlongTheDragOverAgainstItIsOneLessTheCone) {
    OnSheet s(8, 3, 0.5);
    const std::vector<Vec2> straight(8, Vec2{0});
    s.contact.back().normal_force = 1;
    s.problem.root = {0, 0, 2};
    s.problem.before = straight;
    s.problem.friction = {.coefficient = 0.3, .grain = 0.4, .with_hair = 0.35, .along = {1, 0, 0}, .smoothing = 1e-7};
    s.problem.max_iterations = 0;
    const Vec3 tip = chain_nodes(s.spine, s.problem.root, s.problem.frame, straight).back();
    const auto energy = [&](const Vec3& motion) {
        s.contact.back().touched = tip - motion;
        s.problem.contact = s.contact;
        return solve_chain(s.spine, straight, s.problem).dissipation;
    };
    const double last = energy({-0.1, 0, 0}), first = energy({0.1, 0, 0});
    // ε/d = 1e-6.
    EXPECT_NEAR(last / first, 1 - 0.35, 1e-5);
    EXPECT_NEAR(first, 0.3 * 2 * 0.4 * 0.1, 1e-6);
    EXPECT_NEAR(energy({0, 0.1, 0}), 0.3 * 2 * 0.6 * 0.1, 1e-6);
}

TEST(ChainLateral, LiesAtRestAndBalancesItsPushes) {
    LateralChain side;
    for (int i = 0; i < 9; ++i) {
        side.at.push_back(0.004 * i);
        side.outer.push_back(0.004 - 0.0004 * i);
        side.rest.push_back(0.5 * side.outer.back());
        side.drag.push_back(0);
        side.stuck.push_back(0);
    }
    for (double& r : side.outer) r *= 0.5;
    const std::vector<double> still = solve_lateral_chain(side);
    for (std::size_t i = 0; i < still.size(); ++i) EXPECT_EQ(still[i], side.rest[i]);
    side.rest[4] += 0.002;
    side.drag[6] = 0.05;
    side.stuck[6] = 0.003;
    const std::vector<double> pushed = solve_lateral_chain(side);
    const LateralChainEnergy at = lateral_chain_energy(side, pushed);
    for (const double g : at.gradient) EXPECT_NEAR(g, 0, 1e-6 * 0.05);  // of the friction's force
    for (const double step : {-1e-6, 1e-6}) {
        for (std::size_t i = 1; i < pushed.size(); ++i) {
            std::vector<double> other = pushed;
            other[i] += step;
            EXPECT_GE(lateral_chain_energy(side, other).value, at.value);
        }
    }
}

TEST(Lattice, IsExactForAffineMotion) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> any(-1, 1);
    const auto vec = [&] { return Vec3{any(random), any(random), any(random)}; };
    const Mat3 linear{vec(), vec(), vec()};
    const Vec3 shift = vec();
    const std::vector<double> at{0, 0.1, 0.3, 0.45, 0.7, 0.9, 1};
    std::vector<Vec3> node[2], outward[2], across[2];
    for (const double u : at) {
        for (int i = 0; i < 2; ++i) {
            const double x = i == 0 ? -0.4 : 0.4;
            node[i].push_back(linear * Vec3{x, 0, -u} + shift);
            outward[i].push_back(linear * Vec3{i == 0 ? -0.6 : 0.6, 0, 0});
            across[i].push_back(linear * Vec3{0, 1, 0});
        }
    }
    const Lattice lattice = span_lattice({at, {node[0], node[1]}, {outward[0], outward[1]}, {across[0], across[1]}}, 8);
    for (int k = 0; k < 50; ++k) {
        const double s = 0.5 + 0.5 * any(random), t = 0.5 + 0.5 * any(random), u = 0.5 + 0.5 * any(random);
        const Vec3 there = linear * Vec3{2 * s - 1, 2 * t - 1, -u} + shift;
        EXPECT_LT(glm::length(lattice_point(lattice, s, t, u) - there), 1e-13);  // rounding
    }
}

Preset wolf() {
    return load_preset("wolf-medium");
}

/// Presses to `depth` while moving by `motion` in all, upright over z = 0, in `steps` steps.
Pose press_and_drag(SpineModel& model, const Preset& p, double depth, const Vec3& motion, int steps) {
    const ContactPlane sheet;
    Pose pose{{0, 0, p.length}, {1, 0, 0, 0}, 0};
    model.straighten(pose);
    for (int i = 1; i <= steps; ++i) {
        pose.position =
            motion * (static_cast<double>(i) / steps) + Vec3{0, 0, p.length - depth * std::min(1.0, 2.0 * i / steps)};
        pose.time += 0.01;
        model.step({pose, {&sheet, 1}, 0.01, 1});
    }
    return pose;
}

std::vector<double> bends_of(const Recycled<Vec3>& nodes, const Vec3& axis) {
    std::vector<double> bend;
    Vec3 inner = axis;
    for (std::size_t k = nodes.size() - 1; k-- > 0;) {
        const Vec3 t = glm::normalize(nodes[k] - nodes[k + 1]);
        bend.push_back(2 * std::asin(0.5 * glm::length(t - inner)));
        inner = t;
    }
    return bend;
}

TEST(Chain, ReleasedItKeepsTheSmallerOfItsBendAndAlpha) {
    Preset p = wolf();
    p.plastic_share = 0.05;
    const auto model = make_chain_model(p, {.change_weight = 0});
    const Pose pose = press_and_drag(*model, p, 0.4 * p.length, {0.03, 0, 0}, 80);
    const std::vector<double> held = bends_of(model->nodes(), pose.axis());
    model->step({pose, {}, 0.01, 1});
    const std::vector<double> left = bends_of(model->nodes(), pose.axis());
    const std::vector<double> length = spine_segments(p.segments, 0.25 + 0.75 * p.hardness);
    int limited = 0;
    for (std::size_t j = 0; j < length.size(); ++j) {
        const double part = j > 0 ? 0.5 * (length[j - 1] + length[j]) : 0.5 * length[0];
        const double alpha = 0.05 * part * std::numbers::pi / 2;
        // A cubic spring is met by halves until nodes move less than 1e-7 lengths.
        EXPECT_NEAR(left[j], std::min(held[j], alpha), 2e-6) << j;
        limited += held[j] > alpha ? 1 : 0;
    }
    EXPECT_GT(limited, 3);
    EXPECT_LT(limited, p.segments);
}

TEST(Chain, NoNodeLiesBelowTheSurface) {
    const Preset p = wolf();
    const auto model = make_chain_model(p);
    const ContactPlane sheet, edge{{0, 0, 0}, {0, 0, 1}, {0.02, 0, 0}, {1, 0, 0}};
    for (const ContactPlane& plane : {sheet, edge}) {
        Pose pose{{0, 0, p.length}, {1, 0, 0, 0}, 0};
        model->straighten(pose);
        for (int i = 1; i <= 150; ++i) {
            pose.position = {0.0004 * i, 0.001 * std::sin(0.2 * i), p.length * (1 - 0.5 * std::sin(0.02 * i))};
            model->step({pose, {&plane, 1}, 0.01, 1});
            // Relaxed constraints give way by 1e-9 lengths; the solver stops when nodes move 1e-7 lengths.
            for (const Vec3& x : model->nodes()) ASSERT_GT(height_over(plane, x), -1e-6 * p.length) << i;
        }
    }
}

TEST(Chain, SegmentsKeepTheirLengths) {
    const Preset p = wolf();
    const auto model = make_chain_model(p);
    press_and_drag(*model, p, 0.4 * p.length, {0.03, 0.01, 0}, 60);
    const std::vector<double> length = spine_segments(p.segments, 0.25 + 0.75 * p.hardness);
    const Recycled<Vec3> x = model->nodes();
    for (std::size_t j = 0; j < length.size(); ++j)
        EXPECT_NEAR(glm::length(x[x.size() - 2 - j] - x[x.size() - 1 - j]), length[j] * p.length, 1e-14);
}

TEST(Chain, PoresHoldATipThatIsPushedAhead) {
    const Preset p = wolf();
    const double lean = 0.7;  // the tip points to +x
    const ContactPlane sheet;
    for (const bool pores : {true, false}) {
        const auto model = make_chain_model(p, {.pores = pores});
        Pose pose{{0, 0, p.length * std::cos(lean)}, glm::angleAxis(-lean, Vec3{0, 1, 0}), 0};
        model->straighten(pose);
        int pushed = 0;
        double most = 0;
        for (int i = 1; i <= 30; ++i) {
            const Vec3 tip = model->nodes()[0], inner = model->nodes()[1];
            const Vec3 t = glm::normalize(tip - inner);
            pose.position += Vec3{0.0004, 0, i <= 10 ? -0.0002 : 0};
            model->step({pose, {&sheet, 1}, 0.01, 1});
            if (i <= 10 || t.x < 0.1) continue;
            ++pushed;
            most = std::max(most, model->nodes()[0].x - tip.x);
        }
        EXPECT_GT(pushed, 0);
        // l_0 = 0.05 mm, and z cot α: the tip rests on the sheet to a micrometre. Without pores it goes with the hand.
        if (pores)
            EXPECT_LT(most, 0.055e-3);
        else
            EXPECT_GT(most, 0.35e-3);
    }
}

TEST(Chain, HangsInTheAirStraightAndRound) {
    const Preset p = wolf();
    for (const int spines : {1, 2}) {
        const auto model = make_chain_model(p, {.spines = spines});
        const Pose pose{{0.1, -0.2, 0.3}, glm::angleAxis(0.7, glm::normalize(Vec3{1, 2, 3})), 0};
        model->straighten(pose);
        const TuftState state = model->step({pose, {}, 0.01, 1});
        const std::vector<double> length = spine_segments(p.segments, 0.25 + 0.75 * p.hardness);
        double s = 1;
        for (std::size_t k = 0; k < state.branches[0].sections.size(); ++k) {
            const Section& at = state.branches[0].sections[k];
            // Sums of lengths, rounding.
            EXPECT_LT(glm::length(at.centre - pose.position - s * p.length * pose.axis()), 1e-12);
            EXPECT_NEAR(at.a, rest_radius(p, s), 1e-12);
            EXPECT_NEAR(at.b, rest_radius(p, s), 1e-12);
            if (k < length.size()) s -= length[length.size() - 1 - k];
        }
        EXPECT_EQ(state.normal_force, 0);
    }
}

TEST(Chain, TwoSpinesKeepTheAreaAndTheMiddle) {
    const Preset p = wolf();
    const auto model = make_chain_model(p, {.spines = 2});
    const ContactPlane sheet;
    Pose pose{{0, 0, p.length}, {1, 0, 0, 0}, 0};
    model->straighten(pose);
    TuftState state;
    for (int i = 1; i <= 60; ++i) {
        pose.position = {0, 0.0005 * i, p.length * (1 - 0.4 * std::min(1.0, i / 30.0))};
        state = model->step({pose, {&sheet, 1}, 0.01, 1});
    }
    const std::vector<double> length = spine_segments(p.segments, 0.25 + 0.75 * p.hardness);
    double xi = 1;
    for (std::size_t k = 0; k < state.branches[0].sections.size(); ++k) {
        const Section& at = state.branches[0].sections[k];
        EXPECT_NEAR(at.a * at.b, rest_radius(p, xi) * rest_radius(p, xi), 1e-12 * p.radius * p.radius);
        if (k < length.size()) xi -= length[length.size() - 1 - k];
    }
    EXPECT_TRUE(state.converged);
    // Symmetric: the brush goes along y, its spines stand to both sides of x = 0.
    for (const Vec3& x : model->nodes()) EXPECT_NEAR(x.x, 0, 1e-9);
}

}  // namespace
}  // namespace tuft::brush
