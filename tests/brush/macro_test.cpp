#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "brush/papers/macro/macro_cluster.h"
#include "brush/papers/macro/macro_skeleton.h"
#include "brush/papers/macro/macro_stress.h"
#include "brush/papers/macro_model.h"
#include "papers_strokes.h"

namespace tuft::brush::macro {
namespace {

constexpr double kLength = 0.03;

/// Parameters of n + 1 nodes, uneven, tip first.
std::vector<double> parameters(int n) {
    std::vector<double> t;
    for (int i = 0; i <= n; ++i) t.push_back(std::pow(static_cast<double>(i) / n, 1.3));
    return t;
}

/// Straight hair that leans α towards -x, with its tip `depth` below z = 0.
std::vector<Vec3> leaning_hair(const std::vector<double>& t, double alpha, double depth) {
    std::vector<Vec3> nodes;
    for (const double s : t) nodes.push_back({kLength * s * std::sin(alpha), 0, kLength * s * std::cos(alpha) - depth});
    return nodes;
}

TEST(MacroSkeleton, IsNowhereBelowBeforeTheFit) {
    const std::vector<double> t = parameters(24);
    for (const double wave : {0.0, 0.2, 0.6})
        for (const double depth : {0.1, 0.4, 0.9})
            for (const double r : {0.0, 0.3, 1.0}) {
                // An arc or a hook, part of which is below the plane.
                std::vector<Vec3> nodes = leaning_hair(t, 0.3, depth * kLength);
                for (std::size_t i = 0; i < nodes.size(); ++i)
                    nodes[i] += wave * kLength * Vec3{std::sin(5 * t[i]), 0.4 * std::sin(3 * t[i]), std::sin(4 * t[i])};
                const ContactPlane plane{{0, 0, 0}, glm::normalize(Vec3{0.2, -0.1, 1})};
                const BentSkeleton bent = deform_skeleton(nodes, t, half_spaces({&plane, 1}, nodes), {r});
                EXPECT_TRUE(bent.touching);
                // A rounding of lengths of centimetres.
                for (const Vec3& p : bent.nodes) EXPECT_GE(glm::dot(p, plane.normal), -1e-12);
            }
}

TEST(MacroSkeleton, StraightHairLiesOverTheLengthOfTheBlend) {
    const std::vector<double> t = parameters(24);
    const ContactPlane plane;
    for (const double alpha : {0.1, 0.4, 0.9})
        for (const double depth : {1e-3, 6e-3, 1.2e-2})
            for (const double r : {0.0, 0.2, 0.5, 1.0}) {
                const std::vector<Vec3> nodes = leaning_hair(t, alpha, depth);
                const BentSkeleton bent = deform_skeleton(nodes, t, half_spaces({&plane, 1}, nodes), {r});
                const double expected = depth * ((1 - r) * std::tan(alpha) + r / std::cos(alpha));
                // Closed form; rounding only.
                EXPECT_NEAR(glm::length(bent.nodes.front() - bent.pivot), expected, 1e-12);
                EXPECT_NEAR(bent.nodes.front().z, 0, 1e-12);
                EXPECT_NEAR(bent.turn, 0.5 * std::numbers::pi - alpha, 1e-9);
            }
}

TEST(MacroSkeleton, AKinkKeepsTheArcOverItsChord) {
    for (const double ratio : {0.999, 0.9, 0.5, 0.1, 0.0}) {
        const double alpha = arc_half_angle(ratio);
        // Bisection of [0, π] to rounding.
        EXPECT_NEAR(std::sin(alpha), ratio * alpha, 1e-12);
    }
    const std::vector<double> t = parameters(400);
    const std::vector<Vec3> nodes = leaning_hair(t, 0.5, 8e-3);
    const ContactPlane plane;
    const std::vector<HalfSpace> above = half_spaces({&plane, 1}, nodes);
    BentSkeleton bent = deform_skeleton(nodes, t, above, {0});
    const Vec3 tip = bent.nodes.front();
    add_kink(bent, t, above, kLength, 1);
    double arc = 0;
    for (std::size_t i = 0; t[i] < bent.touch; ++i)
        arc += glm::length((t[i + 1] < bent.touch ? bent.nodes[i + 1] : bent.pivot) - bent.nodes[i]);
    // The polygon of some 170 pieces is short by about (α/170)²/6.
    EXPECT_NEAR(arc, kLength * bent.touch, 1e-5 * kLength);
    EXPECT_LT(glm::length(bent.nodes.front() - tip), 1e-12);
}

TEST(MacroSpline, AFitReturnsItsOwnSplineAndStaysAbove) {
    const std::vector<double> t = parameters(16);
    std::vector<double> weight(t.size(), 1.0 / t.size());
    const CurveSpline own{Vec3{9e-3, 1e-3, 1e-4}, Vec3{3e-3, 0, 2e-3}, Vec3{0, 0, 1.4e-2}, Vec3{0, 0, 2.4e-2}};
    std::vector<Vec3> nodes;
    for (const double s : t) nodes.push_back(value(own, s));
    const ContactPlane plane;
    const std::vector<HalfSpace> above = half_spaces({&plane, 1}, nodes);
    const CurveSpline same = fit_curve({t, weight, nodes, above, own[3], {0, 0, -1}, kLength});
    // Normal equations with a condition number of about 1e3.
    for (int k = 0; k < 4; ++k) EXPECT_LT(glm::length(same[k] - own[k]), 1e-12);
    for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i].z = std::max(0.0, nodes[i].z - 6e-3);
    const CurveSpline bent = fit_curve({t, weight, nodes, above, own[3], {0, 0, -1}, kLength});
    for (const double s : t) EXPECT_GE(value(bent, s).z, -1e-12 * kLength);
}

TEST(MacroEllipse, FlatteningLeavesTheLeastAreaBelowAtConstantArea) {
    // Area of a profile of semi-axes l (level) and s below a plane z under its centre (5.4).
    const auto below = [](double l, double s, double z) {
        if (z >= s) return 0.0;
        const double phi = std::acos(z / s);
        return l * s * (phi - std::sin(phi) * std::cos(phi));
    };
    for (const double z : {0.05, 0.3, 0.7, 1.2}) {
        const double pressed = pressed_axis(1, z, 1.0 / 3);
        for (double s = 1.0 / 3; s <= 1; s += 0.01)
            EXPECT_LE(below(1 / pressed, pressed, z), below(1 / s, s, z) + 1e-12);
        EXPECT_LE(pressed, 1);
        EXPECT_GE(pressed, 1.0 / 3);
    }
}

TEST(MacroStress, OfAFlattenedCircleIsAQuarterOfItsSquare) {
    for (const double k : {0.5, 1.0}) {
        const StressLaw law{.compressed = k, .stretched = k};
        for (const double e : {0.02, 0.01, 0.005}) {
            const double stress = least_stress({1, 1}, {1 + e, 1 / (1 + e)}, law).stress;
            // The next term is of order ε³; its factor is below 1.
            EXPECT_NEAR(stress, 0.25 * k * e * e, e * e * e);
        }
    }
    EXPECT_EQ(least_stress({1, 1}, {1, 1}, {}).stress, 0);
}

TEST(MacroStress, TheTurnMakesItLeast) {
    // With the same ellipse before and after, τ = 0 and no stress; with a turned copy, the quarter turn undoes it.
    EXPECT_EQ(least_stress({1.4, 0.7}, {1.4, 0.7}, {}).stress, 0);
    const TurnedStress turned = least_stress({1.4, 0.7}, {0.7, 1.4}, {});
    EXPECT_EQ(turned.turn, kTurns / 2);
    EXPECT_NEAR(turned.stress, 0, 1e-12);
    EXPECT_GT(std::abs(mean_stress({1.4, 0.7}, {0.7, 1.4}, 0, {})), 0.01);
}

TEST(MacroStress, FromRestTheWidthGrowsByLessThanTwice) {
    const StressLaw law;
    for (const double stress : {-1e9, -10.0, -0.1, 0.0, 0.1, 10.0, 1e9}) {
        const double growth = distensibility(stress, law) / distensibility(0, law);
        EXPECT_GT(growth, 0);
        EXPECT_LT(growth, 2);
    }
    EXPECT_EQ(distensibility(0, law), 0.5);
}

TEST(MacroStress, GrowthAndStressAreInBalance) {
    Preset p;
    const HairRow row = make_hair_row(p);
    const MacroLaw law = make_macro_law(p);
    HairMacro m = make_macro(row, {});
    distend(m, row, law);
    EXPECT_NEAR(m.growth, 1, 1e-12);
    m.widening = {3, 3, 2, 1};
    distend(m, row, law);
    EXPECT_NEAR(m.growth, 2 * distensibility(macro_stress(m, row, law, m.growth), law.stress), 1e-9);
    EXPECT_NE(m.growth, 1);
    for (const double widest : {1.5, 2.0, 3.0}) {
        // Growth relieves the stress of a whole tuft, however flat: it stays elastic.
        m.widening.fill(widest);
        distend(m, row, law);
        EXPECT_LT(std::abs(m.stress), law.recovery.elastic);
    }
}

TEST(MacroRecovery, TwoStepsRecoverWhatOneDoes) {
    const RecoveryLaw law;
    EXPECT_EQ(recovery_extent(0.1, law), 1);
    EXPECT_EQ(recovery_extent(2.5, law), 0);
    EXPECT_NEAR(recovery_extent(1.1, law), 0.5, 1e-12);
    const double once = 1 - recovery_extent(1.3, law, 0.03);
    const double first = 1 - recovery_extent(1.3, law, 0.01), second = 1 - recovery_extent(1.3, law, 0.02);
    EXPECT_NEAR(first * second, once, 1e-12);
}

TEST(MacroSplit, KeepsAreaAndCentre) {
    for (const Ellipse& e : {Ellipse{1, 1}, Ellipse{3, 1.0 / 3}, Ellipse{1.2, 1.9}})
        for (const int first : {0, 5, 20}) {
            Rays group{}, rest{};
            for (int k = 0; k < kRays; ++k) group[(first + k) % kRays] = k < 14;
            for (int k = 0; k < kRays; ++k) rest[k] = !group[k];
            const GroupEllipse a = group_ellipse(group, e), b = group_ellipse(rest, e);
            EXPECT_NEAR(a.axes.l * a.axes.s + b.axes.l * b.axes.s, e.l * e.s, 1e-12);
            EXPECT_LT(glm::length(a.share * a.centre + b.share * b.centre), 1e-12);
        }
}

TEST(MacroSplit, DryFlatHairSplitsAndKeepsItsHair) {
    papers::Stroke stroke;
    stroke.wetness = 0;
    stroke.depth = 0.5;
    const Preset p = papers::plain_preset();
    const auto model = make_macro_model(p);
    const TuftState state = papers::draw(*model, p, stroke);
    ASSERT_GE(state.branches.size(), 3u);
    double share = 0;
    for (std::size_t k = 0; k < state.branches.size(); ++k) {
        share += state.branches[k].ink_share;
        EXPECT_GE(state.branches[k].ink_share, 0.1 - 1e-12);
        EXPECT_EQ(state.branches[k].sections.size(), model->nodes().size());
    }
    EXPECT_NEAR(share, 1, 1e-12);
    model->straighten({});
    const TuftState rest = model->step({{}, {}, 0.01, 1});
    EXPECT_EQ(rest.branches.size(), 1u);
}

TEST(MacroCluster, CopiesAreWhatTheyWouldBeAlone) {
    papers::Stroke stroke;
    stroke.wetness = 0;
    stroke.depth = 0.5;
    const Preset p = papers::plain_preset();
    // A motion off the mirror plane by 1e-7 releases every copy; the shapes differ by no more than that does.
    const auto clustered = make_macro_model(p), alone = make_macro_model(p);
    const TuftState a = papers::draw(*clustered, p, stroke);
    stroke.direction = glm::normalize(Vec3{1, 1e-7, 0});
    const TuftState b = papers::draw(*alone, p, stroke);
    EXPECT_LT(a.work.iterations, b.work.iterations);
    ASSERT_EQ(a.branches.size(), b.branches.size());
    for (std::size_t k = 0; k < a.branches.size(); ++k)
        for (std::size_t i = 0; i < a.branches[k].sections.size(); ++i) {
            EXPECT_LT(glm::length(a.branches[k].sections[i].centre - b.branches[k].sections[i].centre), 1e-7);
            EXPECT_NEAR(a.branches[k].sections[i].a, b.branches[k].sections[i].a, 1e-7);
        }
}

TEST(MacroModel, UprightHairLiesOverRTimesTheDepth) {
    // With full recovery the shape depends on the pose alone, and the tip lies where K_n has it: r d from the foot.
    for (const double r : {0.5, 1.0})
        for (const double depth : {2e-3, 6e-3, 1.2e-2}) {
            Preset p = papers::plain_preset();
            p.hardness = r;
            const auto model = make_macro_model(p);
            papers::Stroke stroke;
            stroke.depth = depth / p.length;
            stroke.lean = 0;
            papers::draw(*model, p, stroke);
            const Vec3 tip = model->nodes().front(), root = model->nodes().back();
            // The fit of four control points leaves the tip within 2 % of the hair's length.
            EXPECT_NEAR(std::hypot(tip.x - root.x, tip.y - root.y), r * depth, 0.02 * p.length) << r << " " << depth;
        }
}

TEST(MacroModel, HeldHairComesToRest) {
    for (const double wetness : {1.0, 0.0}) {
        const Preset p = papers::plain_preset();
        const auto model = make_macro_model(p);
        papers::Stroke stroke;
        stroke.depth = 0.5;
        stroke.wetness = wetness;
        papers::draw(*model, p, stroke);
        const ContactPlane plane;
        const SpineModelInput held{papers::pose_at(stroke, p, stroke.press + stroke.drag), {&plane, 1}, 0.01, wetness};
        for (int i = 0; i < 200; ++i) model->step(held);
        const Recycled<Vec3> before = model->nodes();
        for (int i = 0; i < 100; ++i) model->step(held);
        // 2 s are fifty times that of the recovery; what is left is where the solvers stop.
        for (std::size_t i = 0; i < before.size(); ++i)
            EXPECT_LT(glm::length(model->nodes()[i] - before[i]), 1e-6 * p.length) << wetness;
    }
}

/// A macro of straight hair that leans by 0.6 towards -x, half of it below the plane z = 0.
struct LeaningMacro {
    Preset preset = papers::plain_preset();
    HairRow row = make_hair_row(preset);
    MacroLaw law = make_macro_law(preset);
    Pose pose{{0, 0, 0.5 * preset.length* std::cos(0.6)}, glm::angleAxis(0.6, Vec3{0, 1, 0})};
    HairMacro macro = make_macro(row, pose);
    ContactPlane plane;
};

TEST(HairMacro, OnlyStressedHairThatIsPushedTipFirstKinksUp) {
    const auto highest = [](double stress, const Vec3& push) {
        LeaningMacro m;
        m.macro.stress = stress;
        collide(m.macro, m.row, m.law, {.pose = m.pose, .planes = {&m.plane, 1}, .push = push});
        double most = 0;
        for (std::size_t i = 0; m.row.t[i] < 0.3; ++i) most = std::max(most, value(m.macro.skeleton, m.row.t[i]).z);
        return most;
    };
    const double flat = highest(0, {-1, 0, 0});
    EXPECT_EQ(highest(3, {1, 0, 0}), flat);
    EXPECT_EQ(highest(3, {0, 0, 0}), flat);
    // Squeezed to 0.78 of its length, the lying half bulges by more than a tenth of it.
    EXPECT_GT(highest(3, {-1, 0, 0}), flat + 0.05 * papers::plain_preset().length);
}

TEST(HairMacro, RigidHairKeepsItsShapeAndElasticHairDoesNot) {
    LeaningMacro m;
    collide(m.macro, m.row, m.law, {.pose = m.pose, .planes = {&m.plane, 1}});
    const Pose lifted{m.pose.position + Vec3{0, 0, 0.05}, m.pose.rotation};
    move_rigidly(m.macro, m.pose, lifted);
    for (const double stress : {0.1, 3.0}) {
        HairMacro macro = m.macro;
        macro.stress = stress;
        recover(macro, lifted, m.law, 0.01);
        const HairMacro expected = stress < 1 ? at_rest(macro, lifted) : m.macro;
        for (int k = 0; k < 4; ++k) {
            EXPECT_EQ(macro.skeleton[k], expected.skeleton[k]);
            EXPECT_EQ(macro.widening[k], expected.widening[k]);
        }
    }
}

}  // namespace
}  // namespace tuft::brush::macro
