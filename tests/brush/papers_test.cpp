#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "brush/tuft/tuft.h"
#include "core/error.h"

/// Laws that every brush model of the papers keeps as the spine of a tuft.
namespace tuft::brush {
namespace {

struct Painted {
    std::vector<Vec3> nodes;  ///< of all steps
    Recycled<Section> sections;
    Vec3 force{0};
};

/// A stroke of a tuft: down, round, and up. `mirror` is −1 for its image in the plane y = 0.
Painted paint(Tuft tuft, double mirror, int steps = 120) {
    Painted out;
    const double length = tuft.preset.length;
    const ContactPlane sheet;
    for (int i = 0; i <= steps; ++i) {
        const double f = static_cast<double>(i) / steps, turn = 4 * f;
        const Quat lean =
            glm::angleAxis(0.15 * std::sin(3 * f), Vec3{0, 1, 0}) * glm::angleAxis(mirror * 0.1 * f, Vec3{1, 0, 0});
        const Pose pose{{0.02 * std::sin(turn) + 0.02 * f, mirror * 0.02 * (1 - std::cos(turn)),
                         length * (1.01 - 0.35 * std::sin(std::numbers::pi * f))},
                        lean,
                        0.01 * i};
        const TuftState state = step(tuft, pose, {&sheet, 1}, 0.01);
        const Recycled<Vec3> nodes = predicted_nodes(tuft, pose);
        out.nodes.insert(out.nodes.end(), nodes.begin(), nodes.end());
        for (const Branch& b : state.branches)
            out.sections.insert(out.sections.end(), b.sections.begin(), b.sections.end());
        out.force += state.force;
    }
    return out;
}

class Papers : public testing::TestWithParam<SpineMethod> {
  protected:
    Preset preset(const std::string& name = "mixed-medium") const {
        Preset p = load_preset(name);
        p.spine = GetParam();
        return p;
    }
};

TEST_P(Papers, PaintTheSameBitsAgainAndFromACopy) {
    const Tuft tuft = make_tuft(preset());
    ASSERT_TRUE(tuft.model);
    const Tuft copy = tuft;
    const Painted a = paint(tuft, 1), b = paint(copy, 1), c = paint(tuft, 1);
    EXPECT_EQ(a.nodes, b.nodes);
    EXPECT_EQ(a.nodes, c.nodes);
    EXPECT_EQ(a.force, b.force);
}

TEST_P(Papers, ACopyInTheMiddleOfAStrokeIsASnapshot) {
    Tuft tuft = make_tuft(preset());
    const ContactPlane sheet;
    const double length = tuft.preset.length;
    const auto at = [&](int i) { return Pose{{0.0005 * i, 0, length * (1 - 0.005 * i)}, {1, 0, 0, 0}, 0.01 * i}; };
    for (int i = 0; i < 40; ++i) step(tuft, at(i), {&sheet, 1}, 0.01);
    Tuft copy = tuft;
    for (int i = 40; i < 60; ++i) step(tuft, at(i), {&sheet, 1}, 0.01);
    for (int i = 40; i < 60; ++i) step(copy, at(i), {&sheet, 1}, 0.01);
    EXPECT_EQ(predicted_nodes(copy, at(59)), predicted_nodes(tuft, at(59)));
}

TEST_P(Papers, PaintTheMirrorImageOfAMirroredStroke) {
    const Painted a = paint(make_tuft(preset()), 1), b = paint(make_tuft(preset()), -1);
    ASSERT_EQ(a.nodes.size(), b.nodes.size());
    double worst = 0;
    for (std::size_t i = 0; i < a.nodes.size(); ++i)
        worst = std::max(worst, glm::length(a.nodes[i] - Vec3{b.nodes[i].x, -b.nodes[i].y, b.nodes[i].z}));
    // Sums in another order, grown by what a solver stops at.
    EXPECT_LT(worst, 1e-6 * 0.03);
    ASSERT_EQ(a.sections.size(), b.sections.size());
    for (std::size_t i = 0; i < a.sections.size(); ++i) ASSERT_NEAR(a.sections[i].a, b.sections[i].a, 1e-8);
}

TEST_P(Papers, GoWithTheHandOverARotatedSheet) {
    const Quat turn = glm::angleAxis(1.1, glm::normalize(Vec3{0.3, 0.5, 0.8}));
    const Vec3 shift{0.4, -0.3, 0.2};
    Tuft here = make_tuft(preset()), there = here;
    const ContactPlane sheet, turned{shift, turn * Vec3{0, 0, 1}};
    const double length = here.preset.length;
    for (int i = 0; i <= 80; ++i) {
        const Pose pose{{0.0004 * i, 0.0002 * i, length * (1 - 0.3 * std::min(1.0, i / 50.0))}, {1, 0, 0, 0}, 0.01 * i};
        const Pose other{turn * pose.position + shift, turn * pose.rotation, pose.time};
        step(here, pose, {&sheet, 1}, 0.01);
        step(there, other, {&turned, 1}, 0.01);
        const Recycled<Vec3> a = predicted_nodes(here, pose), b = predicted_nodes(there, other);
        for (std::size_t k = 0; k < a.size(); ++k)
            ASSERT_LT(glm::length(turn * a[k] + shift - b[k]), 1e-5 * length) << i;  // solvers stop at 1e-7
    }
}

TEST_P(Papers, HaveUnitFramesAndFiniteSectionsThatTouchWhereThereIsForce) {
    Tuft tuft = make_tuft(preset());
    const double length = tuft.preset.length;
    const ContactPlane sheet;
    bool touched = false;
    for (int i = 0; i <= 100; ++i) {
        const Pose pose{{0.0005 * i, 0, length * (1.02 - 0.5 * std::sin(0.03 * i))},
                        glm::angleAxis(0.3 * std::sin(0.1 * i), Vec3{0, 1, 0}),
                        0.01 * i};
        const TuftState state = step(tuft, pose, {&sheet, 1}, 0.01);
        ASSERT_TRUE(std::isfinite(glm::length(state.force) + glm::length(state.moment) + state.energy.stored()));
        ASSERT_GE(state.force.z, -1e-9);
        double deepest = 1;
        for (const Branch& branch : state.branches) {
            for (const Section& s : branch.sections) {
                ASSERT_NEAR(glm::length(s.tangent), 1, 1e-9);
                ASSERT_NEAR(glm::length(s.e), 1, 1e-9);
                ASSERT_NEAR(glm::dot(s.e, s.tangent), 0, 1e-9);
                ASSERT_LT(glm::length(s.m - glm::cross(s.e, s.tangent)), 1e-9);
                ASSERT_TRUE(std::isfinite(glm::length(s.centre) + s.a + s.b) && s.a >= 0 && s.b >= 0);
                deepest = std::min(deepest, s.centre.z - std::hypot(s.a * s.e.z, s.b * s.m.z));
            }
        }
        if (state.touching) {
            ASSERT_LT(deepest, 1e-6) << i;
            touched = true;
        }
    }
    EXPECT_TRUE(touched);
}

TEST_P(Papers, HairHeldOnTheSheetStaysInTouchWhereItsForceHasRelaxed) {
    Preset p = preset();
    p.plastic_share = 1;  // a held bend of the chain ends without force
    Tuft tuft = make_tuft(p);
    const ContactPlane sheet;
    TuftState state;
    for (int i = 0; i <= 200; ++i) {
        const double f = std::min(1.0, i / 40.0);
        const Pose pose{{0.004 * f, 0, p.length * (1 - 0.1 * f)}, {1, 0, 0, 0}, 0.01 * i};
        state = step(tuft, pose, {&sheet, 1}, 0.01);
        if (i > 40) {
            ASSERT_TRUE(state.touching) << i;
        }
    }
    EXPECT_GE(state.normal_force, 0);
}

TEST_P(Papers, ReshapeStraightensTheHairAtItsPlace) {
    Tuft tuft = make_tuft(preset());
    const ContactPlane sheet;
    const double length = tuft.preset.length;
    Pose pose{{0, 0, length}, {1, 0, 0, 0}, 0};
    for (int i = 0; i <= 50; ++i) {
        pose.position = {0.0005 * i, 0, length * (1 - 0.008 * i)};
        step(tuft, pose, {&sheet, 1}, 0.01);
    }
    reshape(tuft);
    const Recycled<Vec3> x = predicted_nodes(tuft, pose);
    for (const Vec3& p : x) EXPECT_LT(glm::length(Vec2(p - pose.position)), 1e-12);
    EXPECT_NEAR(x.front().z, pose.position.z - length, 1e-12);
}

TEST_P(Papers, EveryShippedBrushBendsAndStaysFinite) {
    for (const std::string& name : list_presets()) {
        const Preset p = load_preset(name);
        // The papers have rounds, and two of them flats and filberts, of hair: said, not bent as something else.
        const bool flat = has_broad_side(p) && p.splay == 0 && p.slant == 0 && GetParam() != SpineMethod::macro;
        if ((p.spines > 1 && !flat) || is_foam(p) || p.geometry) {
            EXPECT_THROW(make_tuft(preset(name)), Error) << name;
            continue;
        }
        const Painted out = paint(make_tuft(preset(name)), 1, 40);
        for (const Vec3& x : out.nodes) ASSERT_TRUE(std::isfinite(glm::length(x))) << name;
        EXPECT_GT(out.force.z, 0) << name;
    }
}

INSTANTIATE_TEST_SUITE_P(OfTheFive, Papers, testing::Values(SpineMethod::macro, SpineMethod::chain, SpineMethod::truss),
                         [](const auto& at) { return std::string(kSpineWords[static_cast<std::size_t>(at.param)]); });

}  // namespace
}  // namespace tuft::brush
