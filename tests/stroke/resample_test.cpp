#include "stroke/gesture/resample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/random.h"

namespace tuft::stroke {
namespace {

using brush::Pose;
using std::numbers::pi;

// A circle of 20 mm radius at constant speed, one second.
std::vector<Pose> circle(int samples) {
    std::vector<Pose> poses;
    for (int i = 0; i < samples; ++i) {
        const double t = static_cast<double>(i) / (samples - 1);
        Pose p;
        p.position = {0.02 * std::cos(2 * pi * t), 0.02 * std::sin(2 * pi * t), 0};
        p.time = t;
        poses.push_back(p);
    }
    return poses;
}

TEST(Resample, StepsAreEvenAndEndsAreKept) {
    const std::vector<Pose> raw = circle(40);
    const ResampleOptions o{.step = 1e-4, .drift = 0};
    const std::vector<Pose> even = resample(raw, o);
    EXPECT_EQ(even.front().position, raw.front().position);
    EXPECT_EQ(even.back().position, raw.back().position);
    for (std::size_t i = 1; i + 1 < even.size(); ++i)
        // Chords of eighths of a 9° segment: the measured length is short by up to 1e-4 relative,
        // and the speed within an eighth varies by less than a percent.
        EXPECT_NEAR(glm::distance(even[i].position, even[i - 1].position), 1e-4, 1e-6);
    EXPECT_LT(glm::distance(even.back().position, even[even.size() - 2].position), 1.0001e-4);
}

TEST(Resample, SplineConvergesToTheMotionWithTheThirdPowerOfTheSampling) {
    const auto error = [](int samples) {
        double worst = 0;
        for (const Pose& p : resample(circle(samples), {.step = 1e-4, .drift = 0}))
            // The ends go on straight and are of lower order: look at the middle.
            if (p.time > 0.2 && p.time < 0.8) worst = std::max(worst, std::abs(glm::length(p.position) - 0.02));
        return worst;
    };
    EXPECT_GT(error(20) / error(40), 6.0);  // third order or better: 8, with room for the end effects
}

TEST(Resample, TimeConvergesToTheMotionWithTheThirdPowerOfTheSampling) {
    // Along a curve, faster and slower: where the hand is when.
    const auto motion = [](double t) {
        const double x = 0.05 * (t - 0.7 * std::sin(2 * pi * t) / (2 * pi));
        return Vec3{x, 0.01 * std::sin(60 * x), 0};
    };
    const auto error = [&](int samples) {
        std::vector<Pose> raw(static_cast<std::size_t>(samples));
        for (int i = 0; i < samples; ++i) {
            raw[i].time = static_cast<double>(i) / (samples - 1);
            raw[i].position = motion(raw[i].time);
        }
        double worst = 0;
        for (const Pose& p : resample(raw, {.step = 1e-4, .drift = 0}))
            if (p.time > 0.2 && p.time < 0.8) worst = std::max(worst, glm::distance(p.position, motion(p.time)));
        return worst;
    };
    EXPECT_GT(error(50) / error(100), 6.0);  // third order: 8
    // Measured: 0.035 µm at 100 Hz; even time over each span of the spline leaves 1.5 µm, and falls
    // with the second power only.
    EXPECT_LT(error(101), 1e-7);
}

TEST(Resample, TimeNeverFalls) {
    // From rest to a jump, with samples a micrometre apart and others at one time.
    std::vector<Pose> raw;
    for (const auto& [x, t] : {std::pair{0.0, 0.0},
                               {1e-6, 0.3},
                               {2e-6, 0.31},
                               {0.02, 0.311},
                               {0.021, 0.311},
                               {0.0211, 0.9},
                               {0.05, 0.91},
                               {0.0500001, 1.5},
                               {0.06, 1.6}}) {
        Pose p;
        p.position = {x, 0, 0};
        p.time = t;
        raw.push_back(p);
    }
    const std::vector<Pose> even = resample(raw);
    ASSERT_GT(even.size(), 500u);
    for (std::size_t i = 1; i < even.size(); ++i) EXPECT_GE(even[i].time, even[i - 1].time) << i;
    EXPECT_EQ(even.back().time, 1.6);
}

TEST(Resample, RotationsConvergeToTheMotionWithTheThirdPowerOfTheSampling) {
    // Turns about two axes at once, as a hand tilts and twists.
    const auto motion = [](double t) {
        Pose p;
        p.time = t;
        p.position = {0.05 * t, 0, 0};
        p.rotation =
            glm::angleAxis(0.4 * std::sin(7 * t), Vec3{0, 1, 0}) * glm::angleAxis(0.8 * std::cos(5 * t), Vec3{0, 0, 1});
        return p;
    };
    const auto error = [&](int samples) {
        std::vector<Pose> raw;
        for (int i = 0; i < samples; ++i) raw.push_back(motion(double(i) / (samples - 1)));
        double worst = 0;
        for (const Pose& p : resample(raw, {.step = 1e-4, .drift = 0})) {
            if (p.time < 0.2 || p.time > 0.8) continue;  // the ends go on at an even pace
            const Quat d = glm::conjugate(p.rotation) * motion(p.time).rotation;
            worst = std::max(worst, 2 * glm::length(Vec3{d.x, d.y, d.z}));
        }
        return worst;
    };
    EXPECT_GT(error(20) / error(40), 6.0);  // third order or better: 8
    EXPECT_LT(error(40), 2e-4);
}

TEST(Resample, ATurnAtAnEvenPaceIsKept) {
    std::vector<Pose> raw(5);
    const Vec3 axis = glm::normalize(Vec3{1, 2, 3});
    const double times[] = {0, 0.1, 0.15, 0.4, 0.5};
    for (int i = 0; i < 5; ++i) {
        raw[i].time = times[i];
        raw[i].rotation = glm::angleAxis(3 * times[i], axis);
        if (i == 2) raw[i].rotation = -raw[i].rotation;  // the same rotation
    }
    for (const Pose& p : resample(raw, {.step = 1e-3, .lever = 0.02, .drift = 0})) {
        const Quat d = glm::conjugate(p.rotation) * glm::angleAxis(3 * p.time, axis);
        EXPECT_LT(glm::length(Vec3{d.x, d.y, d.z}), 1e-12);
    }
}

TEST(Resample, ASuddenTurnDoesNotThrowTheRestAbout) {
    // A device that reports a jump within a microsecond, and holds still before and after.
    std::vector<Pose> raw(4);
    const double times[] = {0, 0.1, 0.100001, 0.2};
    for (int i = 0; i < 4; ++i) {
        raw[i].time = times[i];
        raw[i].position = {0.01 * i, 0, 0};
        raw[i].rotation = glm::angleAxis(i < 2 ? 0.0 : 0.3, Vec3{0, 1, 0});
    }
    for (const Pose& p : resample(raw, {.step = 1e-4})) {
        const double angle = 2 * std::atan2(p.rotation.y, p.rotation.w);
        EXPECT_GT(angle, -0.1);  // a third of the jump: a cubic with end rates of up to twice it
        EXPECT_LT(angle, 0.4);
    }
}

TEST(Resample, DoesNotDependOnHowSamplesArrive) {
    const std::vector<Pose> raw = circle(33);
    const ResampleOptions o{.step = 7e-5};
    std::vector<Pose> streamed;
    Resampler resampler(o);
    for (const Pose& p : raw) {
        resampler.push(p, streamed);
        resampler.push(p, streamed);  // a device that repeats itself
    }
    resampler.finish(streamed);
    const std::vector<Pose> whole = resample(raw, o);
    ASSERT_EQ(streamed.size(), whole.size());
    for (std::size_t i = 0; i < whole.size(); ++i) {
        EXPECT_EQ(streamed[i].position, whole[i].position);
        EXPECT_EQ(streamed[i].time, whole[i].time);
    }
}

TEST(Resample, RestingKeepsItsTime) {
    Pose a, b;
    b.time = 0.5;
    const std::vector<Pose> even = resample(std::vector<Pose>{a, b}, {.step = 1e-4, .drift = 2e-3});
    // 0.5 s × 2 mm/s = 1 mm = ten steps; the last may fall on the end up to rounding.
    EXPECT_NEAR(static_cast<double>(even.size()), 11, 1);
    EXPECT_DOUBLE_EQ(even.back().time, 0.5);
}

TEST(Resample, SinglesEmptyAndFallingTimesAreHarmless) {
    EXPECT_TRUE(resample(std::vector<Pose>{}).empty());
    EXPECT_EQ(resample(std::vector<Pose>{Pose{}}).size(), 1u);
    Pose a, b, c;
    a.time = 1;
    b.time = 0.5;
    b.position.x = 1e-3;
    c.time = 2;
    c.position.x = 2e-3;
    const std::vector<Pose> even = resample(std::vector<Pose>{a, b, c});
    for (std::size_t i = 1; i < even.size(); ++i) EXPECT_GE(even[i].time, even[i - 1].time);
}

TEST(Resample, RefusesAPathOfAbsurdLength) {
    Pose a, b;
    b.position.x = 1e6;
    EXPECT_THROW(resample(std::vector<Pose>{a, b}, {.step = 1e-4, .max_poses = 1000}), Error);
}

// The chords tell it beforehand: exactly where the path is straight, never too early where it is not.
TEST(Resample, ALengthIsRefusedBeforehandOnlyWhereResamplingRefusesIt) {
    const ResampleOptions options{.step = 1e-4, .max_poses = 1000};
    const auto refuses = [&](const std::vector<Pose>& poses, const auto& fn) {
        try {
            fn(poses, options);
        } catch (const Error&) {
            return true;
        }
        return false;
    };
    const auto check = [](const auto& poses, const ResampleOptions& o) { check_path_length(poses, o); };
    const auto take = [](const auto& poses, const ResampleOptions& o) { resample(poses, o); };
    Random random(7);
    std::size_t both = 0;
    for (int i = 0; i < 200; ++i) {
        std::vector<Pose> poses(20);
        const double reach = 0.0115 * random.uniform();  // 19 ways between places, at whose mean the limit is met
        for (std::size_t k = 0; k < poses.size(); ++k) {
            poses[k].position = {reach * random.uniform(), reach * random.uniform(), 0};
            poses[k].time = 0.01 * (static_cast<double>(k) - random.uniform());
        }
        const bool beforehand = refuses(poses, check);
        EXPECT_LE(beforehand, refuses(poses, take));
        both += beforehand;
    }
    EXPECT_GT(both, 10u);
    EXPECT_LT(both, 190u);
    for (const double part : {0.99, 1.01}) {
        std::vector<Pose> straight(2);
        straight[1].position.x = part * options.step * static_cast<double>(options.max_poses);
        EXPECT_EQ(refuses(straight, check), part > 1);
        EXPECT_EQ(refuses(straight, take), part > 1);
    }
}

}  // namespace
}  // namespace tuft::stroke
