#include "stroke/gesture/roll.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "stroke/drawing/drawing.h"
#include "stroke/gesture/hand.h"
#include "stroke/placement/holder.h"

namespace tuft::stroke {
namespace {

using std::numbers::pi;

/// A path of n pieces at even parameters, the hand's own roll `hand`.
template <class At>
StrokeSamples path(int n, double hand, const At& at) {
    StrokeSamples trace;
    for (int i = 0; i <= n; ++i)
        trace.samples.push_back(
            {.time = 0.01 * i, .position = Vec3(at(double(i) / n), 0), .pressure = 1, .roll = hand});
    return trace;
}

StrokeSamples line(int n, double hand, double length, const Vec2& ahead) {
    return path(n, hand, [&](double u) { return u * length * ahead; });
}

/// Anticlockwise as seen: y of flat samples is down.
StrokeSamples circle(int n, double radius, double turns) {
    return path(n, 0, [&](double u) {
        const double a = 2 * pi * turns * u;
        return radius * Vec2(std::sin(a), std::cos(a) - 1);
    });
}

/// The angle from a roll to that across the direction `ahead`, in (−π, π].
double left_to(double roll, const Vec2& ahead) {
    return std::remainder(std::atan2(-ahead.x, -ahead.y) - roll, 2 * pi);
}

TEST(Roll, TurnsTheFerruleAboutItsOwnAxisAnticlockwiseFromAbove) {
    const HolderOptions options;
    for (const Vec2 tilt : {Vec2(0), Vec2(0.4, -0.3)})
        for (const double roll : {-2.0, 0.3, 1.9}) {
            const brush::Pose flat = pose_holder({}, 0, {.tilt = tilt}, options);
            const brush::Pose rolled = pose_holder({}, 0, {.tilt = tilt, .roll = roll}, options);
            const Quat about = glm::normalize(flat.rotation * glm::angleAxis(roll, Vec3(0, 0, 1)));
            EXPECT_EQ(rolled.position, flat.position);
            // Rounding of two products of unit quaternions.
            EXPECT_NEAR(std::abs(glm::dot(about, rolled.rotation)), 1, 1e-14);
        }
    // Seen from above, with x to the right: the broad side goes towards −down.
    const brush::Pose quarter = pose_holder({}, 0, {.roll = pi / 2}, options);
    EXPECT_NEAR(glm::distance(quarter.rotation * Vec3(1, 0, 0), Vec3(0, 1, 0)), 0, 1e-15);
}

TEST(Roll, AStraightLineTurnsByTheClosedForm) {
    const Vec2 ahead = glm::normalize(Vec2(3, -4));
    for (const double first : {-1.8, -0.4, 0.0, 0.9, 1.5}) {
        const StrokeSamples trace = line(40, first, 0.02, ahead);
        const StrokeSamples rolled = roll_holder(trace, {.roll_follow = true});
        const double left = left_to(first, ahead);
        ASSERT_LT(std::abs(left), kOtherFace);
        for (std::size_t i = 0; i < rolled.samples.size(); ++i) {
            const double s = 0.02 * double(i) / 40;
            // Rounding, some 1e-16 for each of 40 pieces.
            EXPECT_NEAR(left_to(rolled.samples[i].roll, ahead),
                        2 * std::atan(std::tan(0.5 * left) * std::exp(-s / kRollLag)), 1e-13);
        }
        // However many samples.
        EXPECT_NEAR(roll_holder(line(1, first, 0.02, ahead), {.roll_follow = true}).samples.back().roll,
                    rolled.samples.back().roll, 1e-13);
    }
}

// dΔ/ds = κ − sin(Δ)/λ comes to rest at sin(Δ) = κλ. Chords of length l turn by h at each sample, and
// tan((Δ − h/2)/2) = e^(−l/λ) tan((Δ + h/2)/2) gives sin(Δ) = sin(h/2) coth(l/2λ).
TEST(Roll, OnACircleTheLagIsConstant) {
    for (const double radius : {0.01, 0.03, 0.1})
        for (const int n : {1024, 4096}) {
            const double turns = 0.2 / radius / (2 * pi);  // 40 λ: the start has died away by e^(−40 cos Δ)
            const StrokeSamples rolled = roll_holder(circle(n, radius, turns), {.roll_follow = true});
            const double h = 0.2 / n / radius, l = 2 * radius * std::sin(0.5 * h);
            const double rest = std::sin(0.5 * h) / std::tanh(0.5 * l / kRollLag);
            // 1 + x²/3 bounds x coth(x).
            EXPECT_NEAR(rest, kRollLag / radius, kRollLag / radius * l * l / (12 * kRollLag * kRollLag));
            for (std::size_t i = 3 * rolled.samples.size() / 4; i < rolled.samples.size(); ++i) {
                const double a = 2 * pi * turns * double(i) / n;
                // The path turns anticlockwise, ahead of the ferrule. What is left of the start: e^(−30 cos 30°).
                EXPECT_NEAR(std::sin(left_to(rolled.samples[i].roll, {std::cos(a), -std::sin(a)})), rest, 1e-11)
                    << radius;
            }
        }
}

TEST(Roll, DoesNotDependOnTheSampling) {
    const auto wave = [](double u) { return Vec2(0.08 * u, 0.01 * std::sin(9 * u)); };
    const int n = 200;
    const auto rolls = [&](int k) { return roll_holder(path(k * n, 0.2, wave), {.roll_follow = true}).samples; };
    const auto once = rolls(1), four = rolls(4), sixteen = rolls(16);
    double coarse = 0, fine = 0;
    for (std::size_t i = 0; i <= n; ++i) {
        coarse = std::max(coarse, std::abs(once[i].roll - sixteen[16 * i].roll));
        fine = std::max(fine, std::abs(four[4 * i].roll - sixteen[16 * i].roll));
    }
    // Between samples 0.4 mm apart: chords of a path of curvature 13/m at most turn by 5e-3.
    EXPECT_LT(coarse, 1e-3);
    // Second order: a sixteenth, against a truth that has 1/256 of the error itself.
    EXPECT_NEAR(fine, coarse / 17, 0.1 * coarse / 17);
}

TEST(Roll, AMirroredStrokeHasTheMirroredRoll) {
    StrokeSamples trace = path(300, 0.3, [](double u) { return Vec2(0.05 * std::sin(7 * u), 0.03 * std::cos(5 * u)); });
    StrokeSamples mirrored = trace;
    transform_samples(mirrored, {0, 0}, 1, true);
    EXPECT_EQ(mirrored.samples[5].roll, -0.3);
    const StrokeSamples a = roll_holder(trace, {.roll_follow = true}), b = roll_holder(mirrored, {.roll_follow = true});
    for (std::size_t i = 0; i < a.samples.size(); ++i)
        // Rounding of 300 pieces.
        EXPECT_NEAR(std::remainder(a.samples[i].roll + b.samples[i].roll, 2 * pi), 0, 1e-12);
}

TEST(Roll, AReversedPathDoesNotSpinTheHolder) {
    StrokeSamples trace = line(100, 0, 0.05, {0, 1});  // towards the person, broad side across
    for (const StrokeSample& s : line(100, 0, 0.05, {0, 1}).samples) {
        StrokeSample back = s;
        back.time += 2;
        back.position = Vec3(1e-4, 0.05 - s.position.y, 0);
        trace.samples.push_back(back);
    }
    for (const StrokeSample& s : roll_holder(trace, {.roll_follow = true}).samples)
        // The step aside of 0.1 mm turns by e^(−0.1/5) of a right angle: 0.02.
        EXPECT_LT(std::abs(s.roll), 0.021);
}

TEST(Roll, ATurnOfTheHandAddsAndIsLostAsTheFerruleGoesOn) {
    RollFollower f;
    follow_stroke(f, 0.2, {});
    // At rest the hand's turn is all there is, also past half a turn.
    EXPECT_NEAR(follow_stroke(f, 3.0, {}), 3.0, 1e-15);
    EXPECT_NEAR(follow_stroke(f, -3.0, {}), 2 * pi - 3.0, 1e-15);
    for (int i = 0; i < 100; ++i) follow_stroke(f, -3.0, {0, -1e-3});
    // e^(−20) of what it was to the nearer face.
    EXPECT_NEAR(std::remainder(f.roll, pi), 0, 1e-8);
}

TEST(Roll, AConstantIsAddedAndNoneLeavesEveryBit) {
    const StrokeSamples trace = circle(50, 0.02, 0.5);
    const StrokeSamples follows = steady(trace, {.roll_follow = true}),
                        both = steady(trace, {.roll = 0.7, .roll_follow = true}),
                        constant = steady(trace, {.roll = 0.7});
    for (std::size_t i = 0; i < trace.samples.size(); ++i) {
        EXPECT_EQ(both.samples[i].roll, follows.samples[i].roll + 0.7);
        EXPECT_EQ(constant.samples[i].roll, 0.7);
        EXPECT_EQ(steady(trace, {.smooth = 1, .stabilise = 1e-3}).samples[i].roll, 0);
    }
}

TEST(Roll, FilterAndStringTakeTheShortWayPastHalfATurn) {
    // A holder that turns evenly through ±π: wrapped samples give what unwrapped ones do.
    const auto turned = [](bool wrapped) {
        StrokeSamples trace = line(200, 0, 0.05, {1, 0});
        for (std::size_t i = 0; i < trace.samples.size(); ++i) {
            const double roll = 2.5 + 0.01 * double(i);
            trace.samples[i].roll = wrapped ? std::remainder(roll, 2 * pi) : roll;
        }
        return steady(trace, {.smooth = 1, .stabilise = 2e-3});
    };
    const StrokeSamples a = turned(false), b = turned(true);
    ASSERT_EQ(a.samples.size(), b.samples.size());
    for (std::size_t i = 0; i < a.samples.size(); ++i)
        EXPECT_NEAR(std::remainder(a.samples[i].roll - b.samples[i].roll, 2 * pi), 0, 1e-12);
    EXPECT_DOUBLE_EQ(mix_roll(3, -3, 0.5), pi);
}

TEST(Roll, SettingsAreReadAsWrittenAndLeftOutByDefault) {
    EXPECT_EQ(to_json({}).find("roll"), std::string::npos);
    const StrokeSettings s{.roll = 0.1 + 0.2, .roll_follow = true};
    EXPECT_EQ(settings_from_json(to_json(s)), s);
    EXPECT_THROW(settings_from_json(R"({"roll": 1e9})"), Error);
    StrokeSamples trace = line(2, 0, 0.01, {1, 0});
    trace.samples[1].roll = std::nan("");
    EXPECT_THROW(check_samples(trace), Error);
}

}  // namespace
}  // namespace tuft::stroke
