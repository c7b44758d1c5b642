#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "brush/papers/macro_model.h"
#include "brush/papers/truss_model.h"
#include "papers_strokes.h"

namespace tuft::brush::papers {
namespace {

using Maker = std::function<std::unique_ptr<SpineModel>(const Preset&)>;

/// Laws that both models keep. Those of all spine models are in papers_test.cpp.
class MacroAndTruss : public testing::TestWithParam<const char*> {
  protected:
    std::unique_ptr<SpineModel> make(const Preset& p) const {
        const std::string name = GetParam();
        if (name == "macro") return make_macro_model(p);
        if (name == "truss") return make_truss_model(p);
        return make_truss_model(p, name == "flat" ? truss::Kind::flat : truss::Kind::filbert, 12e-3, 4e-3);
    }
};

TEST_P(MacroAndTruss, AMirrorImageOfTheHandBendsTheMirrorImage) {
    for (const double wetness : {1.0, 0.0})
        for (const Vec3& direction : {Vec3{1, 0, 0}, Vec3{0.6, 0.8, 0}}) {
            Stroke stroke;
            stroke.direction = direction;
            stroke.roll = 0.4;
            stroke.lean = 0.3;
            stroke.depth = 0.35;
            stroke.wetness = wetness;
            const Preset p = plain_preset();
            const auto one = make(p), other = make(p);
            const TuftState a = draw(*one, p, stroke);
            stroke.mirrored = true;
            const TuftState b = draw(*other, p, stroke);
            const Recycled<Vec3> there = other->nodes();
            // 70 steps of rounding, and thresholds that they move.
            for (std::size_t i = 0; i < there.size(); ++i)
                EXPECT_LT(glm::length(mirrored(one->nodes()[i]) - there[i]), 1e-6 * p.length);
            EXPECT_LT(glm::length(mirrored(a.force) - b.force), 1e-6);
            ASSERT_EQ(a.branches.size(), b.branches.size());
            EXPECT_EQ(a.branches.size() > 1, std::string(GetParam()) == "macro" && wetness == 0);
            double width_a = 0, width_b = 0;
            for (const Branch& branch : a.branches)
                for (const Section& s : branch.sections) width_a += s.a;
            for (const Branch& branch : b.branches)
                for (const Section& s : branch.sections) width_b += s.a;
            EXPECT_NEAR(width_a, width_b, 1e-6 * width_a);
        }
}

TEST_P(MacroAndTruss, TheSameStrokeHasTheSameBitsAndAClonesToo) {
    const Preset p = plain_preset();
    const auto one = make(p), other = make(p);
    Stroke stroke;
    stroke.wetness = 0;
    stroke.depth = 0.5;
    draw(*one, p, stroke);
    draw(*other, p, stroke);
    EXPECT_EQ(one->nodes(), other->nodes());
    const auto copy = one->clone();
    const ContactPlane plane;
    const SpineModelInput next{pose_at(stroke, p, 75), {&plane, 1}, 0.013, 0.5};
    one->step(next);
    EXPECT_NE(one->nodes(), copy->nodes());
    copy->step(next);
    EXPECT_EQ(one->nodes(), copy->nodes());
}

TEST_P(MacroAndTruss, InTheAirTheHairIsStraightAndTouchesNothing) {
    const Preset p = plain_preset();
    const auto model = make(p);
    const ContactPlane far{{0, 0, -1}, {0, 0, 1}};
    Pose pose{{0.1, 0.2, 0.3}, glm::angleAxis(0.7, glm::normalize(Vec3{1, 2, 0.5}))};
    model->straighten(pose);
    for (const std::span<const ContactPlane> planes : {std::span<const ContactPlane>{}, std::span(&far, 1)}) {
        const TuftState state = model->step({pose, planes, 0.01, 1});
        EXPECT_EQ(state.normal_force, 0);
        const Recycled<Vec3> nodes = model->nodes();
        ASSERT_EQ(static_cast<int>(nodes.size()), p.segments + 1);
        for (const Vec3& x : nodes) EXPECT_LT(glm::length(glm::cross(x - pose.position, pose.axis())), 1e-12);
        EXPECT_LT(glm::length(nodes.front() - pose.position - p.length * pose.axis()), 1e-12);
        EXPECT_EQ(nodes.back(), pose.position);
    }
}

TEST_P(MacroAndTruss, WhereHairTouchesItPressesAndASectionMeetsTheSurface) {
    const Preset p = plain_preset();
    for (const double depth : {0.02, 0.1, 0.3, 0.6}) {
        Stroke stroke;
        stroke.depth = depth;
        const auto model = make(p);
        const TuftState state = draw(*model, p, stroke);
        EXPECT_GT(state.normal_force, 0);
        double carried = 0;
        bool cut = false;
        for (const Branch& branch : state.branches)
            for (const Section& s : branch.sections) {
                carried += s.pressure;
                cut = cut || std::hypot(s.a * s.e.z, s.b * s.m.z) >= s.centre.z;
            }
        EXPECT_GT(carried, 0);
        EXPECT_TRUE(cut);
    }
}

TEST_P(MacroAndTruss, IsFiniteForAbsurdPoses) {
    const Preset p = plain_preset();
    const auto model = make(p);
    const ContactPlane plane{{0, 0, 0}, {0, 0, 1}};
    int k = 0;
    for (const double height : {0.03, -0.5, 1e3, 0.01, 0.0, -1e-9, 0.02})
        for (const double tilt : {0.0, 1.5708, 3.1, 0.4})
            for (const double dt : {0.0, 1e-9, 0.01, 1e4}) {
                const Pose pose{{0.01 * k, 1e2 * std::sin(3.0 * k), height},
                                glm::angleAxis(tilt, glm::normalize(Vec3{std::cos(k), std::sin(k), 0.1}))};
                const TuftState state = model->step({pose, {&plane, 1}, dt, 0.5});
                expect_sound(state, plane);
                ++k;
            }
}

TEST_P(MacroAndTruss, EachNodeKeepsOffItsOwnPlane) {
    const Preset p = plain_preset();
    const auto model = make(p);
    // A round bar of 20 mm radius along y under the hair.
    for (int i = 0; i < 60; ++i) {
        const Pose pose{{2e-4 * i, 0, 0.03 - 2e-4 * i}, {1, 0, 0, 0}};
        Recycled<ContactPlane> planes;
        for (const Vec3& x : model->nodes()) {
            const Vec3 n = glm::normalize(Vec3{x.x, 0, x.z + 0.02});
            planes.push_back({0.02 * n - Vec3{0, 0, 0.02}, n});
        }
        const TuftState state = model->step({pose, planes, 0.01, 1});
        for (std::size_t k = 0; k + 1 < planes.size(); ++k)
            for (const Branch& branch : state.branches)
                EXPECT_GE(height_over(planes[k], branch.sections[k].centre), -1e-12);
    }
}

INSTANTIATE_TEST_SUITE_P(Models, MacroAndTruss, testing::Values("macro", "truss", "flat", "filbert"));

}  // namespace
}  // namespace tuft::brush::papers
