#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "brush/papers/spine_model.h"

/// Short strokes for the tests of the papers' brush models.
namespace tuft::brush::papers {

inline Preset plain_preset() {
    Preset p;
    p.length = 0.03;
    return p;
}

/// Presses while the hand moves, then drags, over the plane z = 0, with an axis that leans towards -x.
struct Stroke {
    Vec3 direction{1, 0, 0};
    double depth = 0.25;  ///< of the length
    double lean = 0.12;   ///< radians
    double roll = 0;      ///< radians, of the lean about z
    double wetness = 1;
    int press = 30, drag = 40;
    bool mirrored = false;  ///< in y = 0
};

inline Quat mirrored(const Quat& q) {
    return {q.w, -q.x, q.y, -q.z};
}
inline Vec3 mirrored(const Vec3& v) {
    return {v.x, -v.y, v.z};
}

inline Pose pose_at(const Stroke& s, const Preset& p, int i) {
    Pose pose;
    const double depth = s.depth * std::min(1.0, static_cast<double>(i) / s.press);
    pose.position = 0.01 * i * p.length * s.direction + Vec3{0, 0, p.length * (std::cos(s.lean) - depth)};
    pose.rotation = glm::angleAxis(s.roll, Vec3{0, 0, 1}) * glm::angleAxis(s.lean, Vec3{0, 1, 0});
    if (!s.mirrored) return pose;
    return {mirrored(pose.position), mirrored(pose.rotation), pose.time};
}

inline void expect_sound(const TuftState& state, const ContactPlane& plane) {
    EXPECT_TRUE(std::isfinite(glm::length(state.force) + glm::length(state.moment) + state.normal_force));
    for (const Branch& branch : state.branches)
        for (std::size_t i = 0; i < branch.sections.size(); ++i) {
            const Section& s = branch.sections[i];
            ASSERT_TRUE(
                std::isfinite(glm::length(s.centre) + glm::length(s.tangent) + s.a + s.b + s.moment + s.pressure));
            EXPECT_NEAR(glm::length(s.tangent), 1, 1e-9);
            EXPECT_NEAR(glm::length(s.e), 1, 1e-9);
            EXPECT_NEAR(glm::dot(s.e, s.tangent), 0, 1e-9);
            EXPECT_LT(glm::length(glm::cross(s.e, s.tangent) - s.m), 1e-9);
            // The root is where the hand is; a rounding of centimetres.
            if (i + 1 == branch.sections.size()) continue;
            EXPECT_GE(glm::dot(s.centre - plane.origin, plane.normal), -1e-12);
        }
}

inline TuftState draw(SpineModel& model, const Preset& p, const Stroke& s) {
    const ContactPlane plane;
    model.straighten(pose_at(s, p, 0));
    TuftState state;
    for (int i = 0; i <= s.press + s.drag; ++i) {
        state = model.step({pose_at(s, p, i), {&plane, 1}, 0.01, s.wetness});
        expect_sound(state, plane);
    }
    return state;
}

}  // namespace tuft::brush::papers
