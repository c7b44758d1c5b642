#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "trial_model.h"

namespace tuft::haptic {
namespace {

TEST(Safety, NoForceTwentyMillisecondsAfterAnyFault) {
    const TrialModel f = load_trial_model("sheet");
    const brush::Tuft tuft = tuft_of("wolf-medium");
    const auto path = hand_path(HandMotion::rest, f.place, tuft.preset);
    for (const DeviceLimits& limits : device_presets())
        for (const TrialFault fault : kTrialFaults) {
            const int periods = periods_to_stop(tuft, *f.surface, path, {.law = {.limits = limits}}, fault, 2.2);
            EXPECT_GE(periods, 0) << limits.name << " " << static_cast<int>(fault);
            EXPECT_LT(periods, 20) << limits.name << " " << static_cast<int>(fault);
            if (fault == TrialFault::not_finite || fault == TrialFault::jump || fault == TrialFault::emergency) {
                EXPECT_EQ(periods, 0) << limits.name;
            }
        }
}

/// Periods of a check of a simulated arm in virtual time.
ArmCheck checked(SimulatedArm arm, std::uint64_t deaf_from = UINT64_MAX, std::uint64_t deaf_to = 0) {
    ArmCheck check(arm.limits());
    for (std::uint64_t tick = 1; tick < 60'000 && !check.done(); ++tick) {
        arm.advance(static_cast<double>(tick) * kPeriod);
        const DeviceState state = arm.measure();
        const bool deaf = tick >= deaf_from && tick < deaf_to;
        arm.command(check.step(tick, deaf ? nullptr : &state), static_cast<double>(tick) * kPeriod);
    }
    return check;
}

SimulatedArm nobodys(const DeviceLimits& limits) {
    return SimulatedArm(limits,
                        [](double) {
                            return HandTarget{.position = {0.01, 0.02, 0.03}};
                        },
                        {.hand = {.mass = 0, .damping = 0, .stiffness = 0}});
}

// Force comes in half a second, goes within 20 ms of any fault, and moves no arm that hangs still.
TEST(ArmCheck, AKnownArmThatNobodyHoldsIsSafe) {
    for (const DeviceLimits& limits : device_presets()) {
        const ArmCheck check = checked(nobodys(limits));
        ASSERT_TRUE(check.done());
        EXPECT_TRUE(check.finding().empty()) << limits.name << check.finding().text();
        const ArmFigures f = check.figures();
        EXPECT_EQ(f.states_per_period, 1);
        EXPECT_LT(f.noise, 1e-12) << limits.name;                  // m, rounding of the mean
        EXPECT_NEAR(f.greatest_force, 0.02, 1e-9) << limits.name;  // asked for, below the loan of every tank
        EXPECT_NEAR(f.ramp, 0.95 * 0.5, 2 * kPeriod) << limits.name;
        EXPECT_LT(f.largest_step, 1e-3) << limits.name;  // 20 mN in 500 periods, and the coupling's lag
        EXPECT_LT(f.moved, 1e-12) << limits.name;
        EXPECT_EQ(f.stop, (std::array{17, 0, 0, 10, 0})) << limits.name;
    }
}

// An arm that nobody knows, taken for a Touch: four values in turn, 5 µm apart, and a state in every other period.
TEST(ArmCheck, MeasuresNoiseAndCountOfAnUnknownArm) {
    ArmCheck check(device_preset("touch"));
    for (std::uint64_t tick = 1; tick < 20'000 && !check.done(); ++tick) {
        const DeviceState state{.position = {5e-6 * static_cast<double>(tick / 2 % 4), 0, 0.1}};
        check.step(tick, tick % 2 ? nullptr : &state);
    }
    const ArmFigures f = check.figures();
    EXPECT_EQ(f.states_per_period, 0.5);
    EXPECT_NEAR(f.count, 5e-6, 1e-9);
    EXPECT_NEAR(f.noise, 7.5e-6, 1e-7);  // of 0, 5, 10, 15 µm about their mean
    for (const int periods : f.stop) {
        EXPECT_GE(periods, 0);
        EXPECT_LT(periods, 20);
    }
    EXPECT_TRUE(check.finding().empty()) << check.finding().text();
}

TEST(ArmCheck, AnArmInAHandOrWithoutAWordIsNotCalledSafe) {
    const auto carried = [](double t) { return HandTarget{.position = {0.05 * t, 0, 0}}; };
    const ArmCheck held = checked(SimulatedArm(device_preset("touch"), carried));
    EXPECT_TRUE(held.done());
    EXPECT_FALSE(held.finding().empty());
    const ArmCheck silent = checked(nobodys(device_preset("touch")), 0, UINT64_MAX);
    EXPECT_TRUE(silent.done());
    EXPECT_FALSE(silent.finding().empty());
    EXPECT_EQ(silent.figures().greatest_force, 0);
    // It speaks when its rest has passed: nobody knows where it stood.
    const ArmCheck late = checked(nobodys(device_preset("touch")), 0, 1200);
    EXPECT_EQ(late.finding().text(), silent.finding().text());
    EXPECT_EQ(late.figures().greatest_force, 0);
    EXPECT_EQ(late.figures().moved, 0);
    // Half a second without a state while force is on: it is picked up anew.
    const ArmCheck again = checked(nobodys(device_preset("touch")), 1500, 2000);
    EXPECT_TRUE(again.finding().empty()) << again.finding().text();
}

// Carried off by 10 m/s² as soon as force comes: the coupling would give that hand 0.2 N.
TEST(ArmCheck, GivesNoMoreThanTwentyMillinewtonsWhateverTheArmDoes) {
    for (const DeviceLimits& limits : device_presets()) {
        ArmCheck check(limits);
        double x = 0, v = 0, greatest = 0;
        for (std::uint64_t tick = 1; tick < 20'000 && !check.done(); ++tick) {
            const DeviceState state{.position = {x, 0, 0}};
            const double force = glm::length(check.step(tick, &state).force);
            greatest = std::max(greatest, force);
            if (greatest > 0.019) x += kPeriod * (v += kPeriod * 10);
        }
        EXPECT_TRUE(check.done());
        EXPECT_GT(greatest, 0.019) << limits.name;
        EXPECT_LE(greatest, 0.02 + 1e-12) << limits.name;  // N, rounding of a length
    }
}

// What the servo sends is judged, not what it should send.
TEST(ArmCheck, ForceAtOnceOrTooMuchOrWithoutAnEndIsNotCalledSafe) {
    ArmFigures good{.states_per_period = 1, .greatest_force = 0.02, .ramp = 0.475, .stop = {17, 0, 0, 10, 0}};
    EXPECT_TRUE(finding_of(good).empty());
    const auto expect_found = [&](auto change) {
        ArmFigures bad = good;
        change(bad);
        EXPECT_FALSE(finding_of(bad).empty());
    };
    expect_found([](ArmFigures& f) { f.greatest_force = 0.021; });
    expect_found([](ArmFigures& f) { f.greatest_force = 0; });
    expect_found([](ArmFigures& f) { f.ramp = 0.001; });
    expect_found([](ArmFigures& f) { f.largest_step = 0.021; });
    expect_found([](ArmFigures& f) { f.moved = 0.021; });
    expect_found([](ArmFigures& f) { f.states_per_period = 0; });
    expect_found([](ArmFigures& f) { f.stop[2] = 20; });
    expect_found([](ArmFigures& f) { f.stop[4] = -1; });
}

// An arm whose places flicker by one count in each period, as all arms' do.
TEST(ArmCheck, AFlickerOfOneCountIsSafe) {
    for (const DeviceLimits& limits : device_presets()) {
        ArmCheck check(limits);
        for (std::uint64_t tick = 1; tick < 20'000 && !check.done(); ++tick) {
            const DeviceState state{.position = {limits.count * static_cast<double>(tick * tick / 3 % 2), 0, 0}};
            check.step(tick, &state);
        }
        EXPECT_TRUE(check.finding().empty()) << limits.name << " " << check.finding().text();
        EXPECT_LE(check.figures().greatest_force, 0.02 + 1e-12) << limits.name;
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
