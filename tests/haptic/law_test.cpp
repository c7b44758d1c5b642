#include "haptic/law.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/ease.h"
#include "core/random.h"
#include "haptic/servo.h"

namespace tuft::haptic {
namespace {

/// A hair that is a spring of `stiffness` N/m against z below 0.
HairAnswer spring(double z, double stiffness) {
    const double depth = std::max(0.0, -z);
    return {.force = {0, 0, stiffness * depth}, .stored = 0.5 * stiffness * depth * depth, .touching = depth > 0};
}

// However stiff the hair is, the arm shows at most the coupling's K.
TEST(Law, TheArmNeverShowsMoreThanTheCoupling) {
    for (const DeviceLimits& limits : device_presets()) {
        const LawOptions options{.limits = limits, .gain = 15};
        LawState state;
        double x = 0, force = 0;
        const double depth = 0.5 * limits.max_force / coupling_of(options);
        HairAnswer hair = spring(0, 367);  // N/m, wolf hair end on
        for (int i = 0; i < 4000; ++i) {
            x = -depth * std::min(1.0, i / 2000.0);
            force = step_law(options, state, {.arm = {0, 0, x}, .hair = &hair}).force.z;
            hair = spring(state.root.position.z, 367);
        }
        EXPECT_LT(force / depth, coupling_of(options)) << limits.name;
        // Two springs in series.
        const double series = 1 / (1 / coupling_of(options) + 1 / (15 * 367.0));
        // The arm is known to half a count.
        EXPECT_NEAR(force / depth, series, (0.01 + 0.5 * limits.count / depth) * series) << limits.name;
    }
}

// With restore only the hair's own stiffness is left.
TEST(Law, RestoreTakesTheSoftnessAway) {
    const LawOptions options{.limits = device_preset("omega.6"), .gain = 15, .restore = true};
    LawState state;
    HairAnswer hair = spring(0, 20);
    double force = 0;
    for (int i = 0; i < 4000; ++i) {
        force = step_law(options, state, {.arm = {0, 0, -2e-3 * std::min(1.0, i / 1000.0)}, .hair = &hair}).force.z;
        hair = spring(state.root.position.z, 20);
    }
    EXPECT_NEAR(force, 15 * 20 * 2e-3, 0.01 * 15 * 20 * 2e-3);
}

Vec3 in_counts(const DeviceLimits& limits, const Vec3& x) {
    return limits.count * glm::round(x / limits.count);
}

// A hand that goes on evenly in the air feels the inertia of the root at its start and then nothing, however coarse the
// counts of the arm are and however seldom they come: a saw of 0.1 N on Falcon before.
TEST(Law, CountsOfAnEvenMotionAreNotFelt) {
    for (const DeviceLimits& limits : device_presets())
        for (const double speed : {2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 0.01, 0.017, 0.03, 0.1}) {
            const LawOptions options{.limits = limits};
            const double between = limits.count / (speed * kPeriod);  // periods
            LawState state;
            double most = 0;
            for (int i = 0; i < 1000 + 10 * between; ++i) {
                const Vec3 measured = in_counts(limits, {0, 0, speed * kPeriod * i});
                const double f = glm::length(step_law(options, state, {.arm = measured}).force);
                if (i > 200 + 5 * between) most = std::max(most, f);
            }
            EXPECT_LT(most, 0.02) << limits.name << " " << speed;  // N, about what a finger feels
        }
}

// Where a hand rests between two counts is unknown. x is what is measured, never a whole count off.
TEST(Law, AnArmThatStandsIsKnownToHalfACount) {
    for (const DeviceLimits& limits : device_presets())
        for (int part = 0; part < 20; ++part) {
            const LawOptions options{.limits = limits};
            const Vec3 to = (1e-3 + limits.count * part / 20.0) * Vec3{1, 0, 0};
            LawState state;
            for (int i = 0; i < 1500; ++i)
                step_law(options, state, {.arm = in_counts(limits, smooth_step(i / 500.0) * to)});
            // Half a count, and a hundredth that x has left of its way.
            EXPECT_LT(glm::distance(state.arm.position, to), 0.51 * limits.count) << limits.name << " " << part;
        }
}

// A root that a hand presses slowly onto a stiff spring comes to rest on it. A fade that looked at the motion of the
// arm alone let the force come late, and the root swung.
TEST(Law, ARootComesToRestOnAStiffSpring) {
    for (const DeviceLimits& limits : device_presets())
        for (const double stiffness : {5e3, 2e4, 4e4}) {  // N/m at the hand; 4e4 is 2 m/T²
            const LawOptions options{.limits = limits, .gain = 1};
            LawState state;
            HairAnswer hair;
            double least = 1e9, most = -1e9;
            for (int i = 0; i < 2000; ++i) {
                const double x = 1e-3 - 3e-3 * smooth_step(i / 1000.0);
                const double root = step_law(options, state, {.arm = {0, 0, x}, .hair = &hair}).root.z;
                hair = spring(root, stiffness);
                hair.pose.position = {0, 0, root};
                if (i < 1500) continue;
                least = std::min(least, root);
                most = std::max(most, root);
            }
            EXPECT_LT(most - least, 1e-6) << limits.name << " " << stiffness;
        }
}

TEST(Law, AJumpOfTheHairComesAsARamp) {
    const LawOptions options{.limits = device_preset("omega.6"), .gain = 15};
    LawState state;
    HairAnswer hair{.force = {0, 0, 0}, .stored = 1, .touching = true};
    Vec3 before{0};
    for (int i = 0; i < 400; ++i) {
        if (i == 100) hair.force = {0, 0, 0.1};
        if (i == 200) hair.force = {0, 0, 0};
        const Vec3 f = step_law(options, state, {.hair = &hair}).force;
        // 0.06 N of the fade and 0.01 N free, through a critically damped coupling.
        EXPECT_LE(glm::distance(f, before), 0.075) << i;
        before = f;
    }
}

// Hair that snaps over while the hand drags it along, with an answer in each period and in every second and third. The
// fade once let pass 40 kN/m of any way that the root went.
TEST(Law, AJumpOfTheHairInADragComesAsARamp) {
    const LawOptions options{.limits = device_preset("omega.6"), .gain = 1};
    const double way = kPeriod * 0.05;  // m a period
    for (const int every : {1, 2, 3})
        for (const Vec3& jump : {Vec3{-1.5, 0, 0}, Vec3{1.5, 0, 0}, Vec3{0, 0, 1.5}}) {
            LawState state;
            HairAnswer hair{.stored = 1, .touching = true};
            Vec3 before{0};
            for (int i = 0; i < 500; ++i) {
                if (i % every == 0) {
                    hair.force = Vec3{-2 * smooth_step(i / 200.0), 0, 0} + (i < 300 ? Vec3{0} : jump);
                    hair.pose.position = state.root.position;
                }
                const Vec3 f = step_law(options, state, {.arm = {way * i, 0, 0}, .hair = &hair}).force;
                if (i > 200) {
                    // 0.06 N of the fade, 0.01 N free and 1000 N/m of the arm's way since the answer before, through a
                    // critically damped coupling.
                    EXPECT_LE(glm::distance(f, before), 0.07 + 1000 * way * every) << every << " " << i;
                }
                before = f;
            }
            EXPECT_LT(glm::distance(before, hair.force), 0.02) << every;
        }
}

TEST(Law, ForcesKeepToTheDeviceAndToThePapersLimit) {
    for (const DeviceLimits& limits : device_presets()) {
        const LawOptions options{.limits = limits, .gain = 15};
        LawState state;
        HairAnswer hair{.force = {30, 0, 40}, .moment = {0, 1, 0}, .stored = 100, .touching = true};
        for (int i = 0; i < 1000; ++i)
            EXPECT_LE(glm::length(step_law(options, state, {.hair = &hair}).force),
                      std::min(limits.max_force, kForceLimit) + 1e-12);
        // A moment is scaled with its force.
        EXPECT_LT(glm::length(state.moment), 15 * 1.0 * std::min(limits.max_force, kForceLimit) / 100);
    }
}

/// What the tank lends a contact, J: ½ K b² for a landing, with b = 60 m/s² T² (1 + delay / T) + 1.5 counts, 0.8 µJ
/// where it is empty; and what an empty tank lets out over the half of a count that it has not seen, less than 0.2 µJ.
double most_lent(const LawOptions& options) {
    const double b = 60 * kPeriod * (kPeriod + options.delay) + 1.5 * options.limits.count;
    return 0.5 * coupling_of(options) * b * b + 1e-6;
}

// The hand is drawn back while the hair goes on pushing. What the tank has left at the end comes as the force of a
// spring that springs back, also where forces on their way take from it, and where the arm reads counts.
TEST(Law, AForceWhoseEnergyEndsFallsEvenly) {
    for (const DeviceLimits& limits : device_presets())
        for (const double delay : {0.0, 1e-3, 3e-3})
            for (const double v : {0.15, 0.3, 0.6}) {
                SCOPED_TRACE(std::string(limits.name) + " " + std::to_string(delay) + " " + std::to_string(v));
                const LawOptions options{.limits = limits, .gain = 1, .delay = delay};
                LawState state;
                double x = 0, speed = 0, force = 0, most = 0;
                for (int i = 0; i < 2000; ++i) {
                    const HairAnswer hair{.force = {0, 0, 0.5 * limits.max_force * std::min(1.0, i / 500.0)},
                                          .stored = 1,
                                          .touching = true};
                    if (i < 1000) x = -0.02 * smooth_step(i / 500.0);
                    if (i >= 1000) speed = std::min(v, speed + 40 * kPeriod);  // a hand that is let go
                    x += speed * kPeriod;
                    const Vec3 measured{0, 0, limits.count * std::round(x / limits.count)};
                    const double after = step_law(options, state, {.arm = measured, .hair = &hair}).force.z;
                    // 0.15 N is what a hand may feel as a step, 0.35 N on the counts of Falcon.
                    EXPECT_LE(force - after,
                              limits.max_stiffness * speed * kPeriod + (limits.name == "falcon" ? 0.35 : 0.15))
                        << i;
                    force = after;
                    most = std::max(most, after);
                }
                EXPECT_GT(most, 0.1 * limits.max_force) << "there is a force that can end";
                EXPECT_LT(force, 0.05 * limits.max_force);
            }
}

// A light root does not follow a hand that turns round at 55 m/s²: the damper's force would change by B 55 m/s² T,
// 0.28 N on Touch. Wolf hair end on.
TEST(Law, AHandThatTurnsRoundFeelsNoStep) {
    for (const DeviceLimits& limits : device_presets())
        for (const double rate : {60.0, 83.0, 120.0}) {  // rad/s
            const LawOptions options{.limits = limits, .gain = 15};
            const double size = 55 / (rate * rate);  // m
            LawState state;
            Vec3 before{0}, at{0};
            for (int i = 0; i < 1000; ++i) {
                const Vec3 x{0, 0, size * (std::cos(rate * kPeriod * i) - 0.3)};
                const HairAnswer hair = spring(state.root.position.z, 367);
                const Vec3 measured = limits.count * glm::round(x / limits.count);
                const Vec3 f = step_law(options, state, {.arm = measured, .hair = &hair}).force;
                if (i > 20) {  // the motion begins at once
                    EXPECT_LE(glm::distance(f, before),
                              limits.max_stiffness * glm::distance(x, at) + (limits.name == "falcon" ? 0.35 : 0.15))
                        << limits.name << " " << rate << " " << i;
                }
                before = f;
                at = x;
            }
        }
}

// A force that pushes whichever way the hand goes would be a motor; the tank ends it.
TEST(Law, AForceThatWorksOnItsOwnRunsOutOfEnergy) {
    for (const DeviceLimits& limits : device_presets()) {
        const LawOptions options{.limits = limits, .gain = 1};
        LawState state;
        double x = 0, given = 0;
        for (int i = 0; i < 20000; ++i) {
            const double speed = 0.05 * std::cos(0.01 * i);  // m/s
            const HairAnswer hair{.force = {speed > 0 ? 1.0 : -1.0, 0, 0}, .touching = true};
            const double f = step_law(options, state, {.arm = {x, 0, 0}, .hair = &hair}).force.x;
            x += speed * kPeriod;
            given += f * speed * kPeriod;
        }
        EXPECT_LT(given, most_lent(options)) << limits.name;
    }
}

// Whatever the hair does, and however coarse the counts are: the work of the force over the true path stays above what
// the tank lends. The path is a hand's, of less than 60 m/s².
TEST(Law, NoHairTakesMoreThanTheTankLends) {
    constexpr double kLent = 1e-6;  // J, see `most_lent`
    for (const DeviceLimits& limits : device_presets())
        for (std::uint64_t seed = 1; seed <= 20; ++seed) {
            Random random(seed);
            const LawOptions options{.limits = limits, .gain = 15};
            const double rate = random.uniform(2, 30), size = std::min(0.02, 40 / (rate * rate * 3));
            LawState state;
            HairAnswer hair{.touching = true};
            double energy = 0, least = 0, base = 0;
            Vec3 force{0}, before{0};
            for (int i = 0; i < 4000; ++i) {
                const double t = 1e-3 * i;
                const Vec3 x{0, size * std::sin(0.6 * rate * t), size * std::sin(rate * t)};
                if (i > 0) energy -= glm::dot(force, x - before);
                least = std::min(least, energy - base);
                if (random.uniform() < 0.1) hair.force = random.uniform(0, 1) * Vec3{random.uniform(-1, 1), 0, 1};
                hair.stored = random.uniform(0, 0.01);
                const Vec3 measured = limits.count * glm::round(x / limits.count);
                force = step_law(options, state, {.arm = measured, .hair = &hair}).force;
                before = x;
            }
            EXPECT_GE(least, -kLent) << limits.name << " " << seed;
        }
}

// A force that rises and falls with a quick hand: x lags by up to a count, always to the side on which that gives.
// Along an axis of the arm, and askew to all three, where counts hide more.
TEST(Law, ForcesThatComeWithTheMotionTakeNoMoreThanTheTankLends) {
    for (const DeviceLimits& limits : device_presets())
        for (const Vec3& along : {Vec3{0, 0, 1}, glm::normalize(Vec3{1, 1, 1})})
            for (std::uint64_t seed = 1; seed <= 60; ++seed) {
                Random random(seed);
                const int delay = seed <= 30 ? 0 : seed <= 50 ? 1 : 3;  // periods
                const LawOptions options{.limits = limits, .gain = 1, .delay = delay * kPeriod};
                const double rate = random.uniform(20, 100), size = std::min(0.02, 55 / (rate * rate));
                const double phase = random.uniform(0, 6.28);
                LawState state;
                HairAnswer hair{.stored = 1, .touching = true};
                double energy = 0, least = 0;
                std::array<Vec3, 4> sent{};  // the newest first
                Vec3 before{0};
                for (int i = 0; i < 3000; ++i) {
                    const double t = kPeriod * i;
                    const Vec3 x = size * smooth_step(t / 0.5) * std::sin(rate * t) * along;
                    energy -= glm::dot(sent[static_cast<std::size_t>(delay)], x - before);
                    least = std::min(least, energy);
                    const double push = 0.5 + 0.5 * smooth_step((t - 0.2) / 0.5) * std::sin(rate * t + phase);
                    hair.force = 0.8 * limits.max_force * push * along;
                    hair.pose.position = state.root.position;
                    std::shift_right(sent.begin(), sent.end(), 1);
                    sent[0] = step_law(options, state, {.arm = in_counts(limits, x), .hair = &hair}).force;
                    before = x;
                }
                EXPECT_GE(least, -most_lent(options)) << limits.name << " " << seed;
            }
}

// Counts are along the arm's axes, however these stand in the world.
TEST(Law, AnArmThatIsTurnedFeelsTheSame) {
    const DeviceLimits& limits = device_preset("falcon");
    const LawOptions options{.limits = limits, .gain = 15};
    const Quat turn = glm::angleAxis(0.7, glm::normalize(Vec3{1, 2, 3}));
    LawState straight, turned;
    for (int i = 0; i < 2000; ++i) {
        const double t = kPeriod * i;
        const Vec3 x =
            in_counts(limits, {3e-3 * std::sin(9 * t), 2e-3 * std::sin(7 * t), 2e-3 * std::cos(5 * t) - 1e-3});
        const HairAnswer hair = spring(straight.root.position.z, 20);
        HairAnswer other = hair;
        other.force = turn * hair.force;
        const Vec3 f = step_law(options, straight, {.arm = x, .hair = &hair}).force;
        const Vec3 g = step_law(options, turned, {.arm = turn * x, .axes = turn, .hair = &other}).force;
        EXPECT_LT(glm::distance(turn * f, g), 1e-6) << i;  // N: round-off of the turn, through 2,000 periods
    }
}

/// omega.6 with motors in its wrist.
DeviceLimits with_torque(double most) {
    DeviceLimits limits = device_preset("omega.6");
    limits.max_torque = most;
    return limits;
}

// The wrist turns hair that is a spring of 0.15 N·m/rad to the hand, there and back.
TEST(Law, AnArmWithTorqueGivesTheMomentOfTheHairUpToItsLimit) {
    constexpr double kSpring = 0.01, kMost = 0.05, kTurn = 0.4;  // N·m/rad of the hair, N·m, rad
    for (const double most : {kMost, 0.0}) {
        const LawOptions options{.limits = with_torque(most), .gain = 15};
        LawState state;
        HairAnswer hair{.force = {0, 0, 1e-3}, .touching = true};
        double greatest = 0, port = 0, least = 0;  // N·m; J
        Vec3 torque{0};
        for (int i = 0; i <= 1000; ++i) {
            const double before = kTurn * smooth_step(1 - std::abs(i - 501) / 500.0);
            const double turn = kTurn * smooth_step(1 - std::abs(i - 500) / 500.0);
            port -= torque.y * (turn - before);
            least = std::min(least, port);
            hair.moment = {0, -kSpring * turn, 0};
            hair.stored = 0.5 * kSpring * turn * turn;
            torque = step_law(options, state, {.rotation = glm::angleAxis(turn, Vec3{0, 1, 0}), .hair = &hair}).torque;
            greatest = std::max(greatest, glm::length(torque));
            if (i == 250) {  // half the turn in: the moment of the hair, unclamped
                EXPECT_NEAR(torque.y, most > 0 ? -15 * kSpring * turn : 0, 1e-9);
            }
        }
        EXPECT_NEAR(greatest, most, 1e-12);  // none without motors; at the whole turn the hair would give 0.06 N·m
        EXPECT_GE(least, -1e-6);
    }
}

// A moment that keeps turning the wrist has what the tank begins with and lends, and no more.
TEST(Law, ATorqueThatWorksOnItsOwnRunsOutOfEnergy) {
    const LawOptions options{.limits = with_torque(0.05), .gain = 15};
    LawState state;
    const HairAnswer hair{.force = {0, 0, 1e-3}, .moment = {0, 2e-3, 0}, .stored = 1, .touching = true};
    double given = 0, turn = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3 torque =
            step_law(options, state, {.rotation = glm::angleAxis(turn, Vec3{0, 1, 0}), .hair = &hair}).torque;
        const double next = turn + 2e-3 * std::min(1.0, i / 200.0);  // rad, 2 rad/s in the end
        given += torque.y * (next - turn);
        turn = next;
    }
    EXPECT_GT(given, 0);
    EXPECT_LT(given, 40e-6);  // J: e_0, and 7 µJ that a landing on omega.6 lends; the hair would give 120 mJ
}

TEST(Servo, TorqueLeavesInTheFrameOfTheArm) {
    Servo servo({.limits = with_torque(0.05), .gain = 15});
    ServoControl control;
    control.workspace.rotation = glm::angleAxis(std::acos(-1.0) / 2, Vec3{0, 0, 1});
    const DeviceState still;
    ServoOutput out;
    for (std::uint64_t tick = 1; tick < 700; ++tick) {
        HairAnswer hair{.pose = servo.begin(tick, &still, control), .touching = true};
        hair.force = {0, 0, 1e-3};
        hair.moment = {1e-4, 0, 0};
        out = servo.finish(&hair);
    }
    // World x is minus y of an arm that is turned by a quarter.
    EXPECT_LT(glm::distance(out.command.torque, Vec3{0, -15e-4, 0}), 1e-9);
}

TEST(Law, TheRootKeepsToTheFreeSideOfItsBounds) {
    const LawOptions options{.limits = device_preset("inverse3")};
    LawState state;
    HairAnswer hair;
    hair.n_bounds = 2;
    hair.bounds[0] = {.normal = {0, 0, 1}, .height = 0};
    hair.bounds[1] = {.normal = {1, 0, 0}, .height = -0.01};
    for (int i = 0; i < 1000; ++i) {
        const double t = i / 1000.0;
        const LawOutput out = step_law(options, state, {.arm = {-0.03 * t, 0, 0.01 - 0.02 * t}, .hair = &hair});
        EXPECT_GE(out.root.z, -1e-9);
        EXPECT_GE(out.root.x, -0.01 - 1e-9);
        if (i > 900) {
            EXPECT_TRUE(out.hard);
        }
    }
    EXPECT_GT(state.force.z, 1);
    EXPECT_GT(state.force.x, 1);
}

TEST(Law, ALongerDelayLowersTheCoupling) {
    const DeviceLimits& limits = device_preset("omega.6");
    EXPECT_EQ(coupling_for_delay(limits, 0), limits.coupling);
    EXPECT_EQ(coupling_for_delay(limits, 1e-3), limits.coupling);
    EXPECT_NEAR(coupling_for_delay(limits, 3e-3), limits.coupling / 4, 1e-9);
}

TEST(Limits, AnUnknownDeviceIsAnErrorThatNamesTheNearest) {
    try {
        device_preset("omega");
        FAIL();
    } catch (const std::exception& e) {
        EXPECT_NE(std::string(e.what()).find("omega.6"), std::string::npos) << e.what();
    }
}

TEST(Turn, IsTheRotationVector) {
    const Quat q = glm::angleAxis(0.3, glm::normalize(Vec3{1, 2, 3}));
    const Vec3 v{0.02, -0.01, 0.03};
    const Quat after = glm::angleAxis(glm::length(v), glm::normalize(v)) * q;
    EXPECT_LT(glm::distance(turn_between(q, after), v), 1e-12);
    EXPECT_LT(glm::distance(turn_between(q, -after), v), 1e-12);
}

}  // namespace
}  // namespace tuft::haptic
