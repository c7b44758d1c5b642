#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "trial_model.h"

namespace tuft::haptic {
namespace {

TEST(Safety, NoForceTwentyMillisecondsAfterAnyTrouble) {
    const TrialModel f = load_trial_model("sheet");
    const brush::Tuft tuft = tuft_of("wolf-medium");
    const auto path = hand_path(HandMotion::rest, f.place, tuft.preset);
    for (const DeviceLimits& limits : device_presets())
        for (const TrialFault trouble : kTrialFaults) {
            const int periods = periods_to_stop(tuft, *f.surface, path, {.law = {.limits = limits}}, trouble, 2.2);
            EXPECT_GE(periods, 0) << limits.name << " " << static_cast<int>(trouble);
            EXPECT_LT(periods, 20) << limits.name << " " << static_cast<int>(trouble);
            if (trouble == TrialFault::not_finite || trouble == TrialFault::jump || trouble == TrialFault::emergency) {
                EXPECT_EQ(periods, 0) << limits.name;
            }
        }
}

DeviceState at(double x) {
    return {.position = {x, 0, 0}};
}

/// Ticks with good states from `tick` on; returns the last verdict.
Verdict run(Safety& safety, std::uint64_t& tick, int periods) {
    Verdict v;
    const DeviceState state = at(0);
    for (int i = 0; i < periods; ++i) v = safety.check(++tick, &state, false, false);
    return v;
}

TEST(Safety, ForceRisesOverHalfASecond) {
    Safety safety;
    std::uint64_t tick = 0;
    EXPECT_EQ(run(safety, tick, 50).pass, 0);
    EXPECT_NEAR(run(safety, tick, 250).pass, 0.5, 0.01);
    EXPECT_EQ(run(safety, tick, 260).pass, 1);
}

TEST(Safety, AnEmergencyLastsUntilItIsReleased) {
    Safety safety;
    std::uint64_t tick = 0;
    run(safety, tick, 700);
    const DeviceState state = at(0);
    EXPECT_EQ(safety.check(++tick, &state, false, true).pass, 0);
    const Verdict later = run(safety, tick, 2000);
    EXPECT_EQ(later.pass, 0);
    EXPECT_EQ(later.fault, Fault::emergency);
    safety.release();
    EXPECT_EQ(run(safety, tick, 700).pass, 1);
}

TEST(Safety, StatesOfAnyKindNeverLetANumberThroughThatIsNone) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    Servo servo({.limits = device_preset("touch")});
    Random random(7);
    const double odd[] = {nan, inf, -inf, 1e308, -1e300, 0, 1e-320, 0.05};
    for (std::uint64_t tick = 1; tick < 20000; ++tick) {
        DeviceState state = at(0);
        if (random.uniform() < 0.02) state.position[static_cast<int>(random.bits() % 3)] = odd[random.bits() % 8];
        if (random.uniform() < 0.01) state.rotation.w = odd[random.bits() % 8];
        const bool fresh = random.uniform() < 0.95;
        const RootPose pose = servo.begin(tick, fresh ? &state : nullptr, {});
        HairAnswer answer{.pose = pose, .force = {0, 0, 0.2}, .touching = true};
        const ServoOutput out = servo.finish(servo.engaged() ? &answer : nullptr);
        ASSERT_TRUE(std::isfinite(glm::length(out.command.force))) << tick;
        ASSERT_LE(glm::length(out.command.force), 3.3 + 1e-9) << tick;
        ASSERT_TRUE(std::isfinite(glm::length(pose.position)) && std::isfinite(glm::length(pose.rotation))) << tick;
    }
}

TEST(Safety, ALateAnswerIsHeldAndThenFaded) {
    EXPECT_EQ(trust_at_age(0), 1);
    EXPECT_EQ(trust_at_age(5), 1);
    for (std::uint64_t age = 5; age < 25; ++age) EXPECT_LE(trust_at_age(age + 1), trust_at_age(age));
    EXPECT_EQ(trust_at_age(19), 0);
}

TEST(Clutch, TheBrushWaitsWhileTheArmMovesAndGoesOnFromThere) {
    Servo servo({.limits = device_preset("inverse3")});
    std::uint64_t tick = 0;
    Vec3 root{0};
    const auto go = [&](double from, double to, int periods, bool clutched) {
        for (int i = 1; i <= periods; ++i) {
            const DeviceState state = at(from + (to - from) * i / periods);
            servo.begin(++tick, &state, {.clutched = clutched});
            root = servo.finish(nullptr).root;
        }
    };
    go(0, 0, 700, false);
    go(0, 0.05, 500, false);
    EXPECT_NEAR(root.x, 0.05, 2e-3);
    go(0.05, -0.05, 500, true);
    go(-0.05, -0.05, 700, false);
    EXPECT_NEAR(root.x, 0.05, 2e-3);
    go(-0.05, 0, 500, false);
    EXPECT_NEAR(root.x, 0.10, 2e-3);
}

TEST(Clutch, TheGripsButtonDoesTheSame) {
    Servo servo({.limits = device_preset("inverse3")});
    Vec3 root{0};
    for (std::uint64_t tick = 1; tick <= 2000; ++tick) {
        DeviceState state = at(tick <= 700 ? 0 : 0.05);
        state.position.x = 0.05 * std::clamp((static_cast<double>(tick) - 700) / 500, 0.0, 1.0);
        state.buttons = tick > 690 && tick < 1300 ? 2 : 0;
        servo.begin(tick, &state, {.clutch_buttons = 2});
        root = servo.finish(nullptr).root;
        EXPECT_EQ(servo.clutched(), state.buttons == 2) << tick;
    }
    EXPECT_NEAR(root.x, 0, 1e-3);
}

// The view turns 60 times a second: the brush goes with it, by steps that a coupling can follow.
TEST(Workspace, CarriesTheBrushSteadily) {
    Servo servo({.limits = device_preset("inverse3")});
    ServoControl control{.carried = true};
    Vec3 before{0}, arm{0};
    for (std::uint64_t tick = 1; tick <= 3000; ++tick) {
        const DeviceState state = at(0.05);
        if (tick >= 1000 && tick % 16 == 0 && tick < 2000) {
            const double turn = 1e-3 * (static_cast<double>(tick) - 1000);  // 1 rad/s
            control.workspace.rotation = glm::angleAxis(turn, Vec3{0, 0, 1});
            control.workspace.offset = {0, 0, 1e-5 * (static_cast<double>(tick) - 1000)};
        }
        servo.begin(tick, &state, control);
        arm = servo.finish(nullptr).arm;
        // 0.5 mm of the offset and 4 mrad at 50 mm.
        if (tick > 1) {
            EXPECT_LE(glm::distance(arm, before), 5e-4 + 4e-3 * 0.05 + 1e-9) << tick;
        }
        before = arm;
    }
    EXPECT_LT(glm::distance(arm, control.workspace.to_world(at(0.05).position)), 1e-9);
    // Not carried, it stays.
    control.carried = false;
    control.workspace.rotation = Quat{1, 0, 0, 0};
    const DeviceState state = at(0.05);
    servo.begin(3001, &state, control);
    EXPECT_LT(glm::distance(servo.finish(nullptr).arm, arm), 1e-9);
}

TEST(Workspace, GripsAnewWithoutAStep) {
    const Workspace w{.offset = {1, 2, 3}, .rotation = glm::angleAxis(0.7, Vec3{0, 0, 1}), .scale = 2};
    const Vec3 device{0.1, 0.02, -0.03}, world{4, 5, 6};
    EXPECT_LT(glm::distance(w.regripped(device, world).to_world(device), world), 1e-12);
    EXPECT_LT(glm::distance(w.place_in_device(w.to_world(device)), device), 1e-12);
}

}  // namespace
}  // namespace tuft::haptic
