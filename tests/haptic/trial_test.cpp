#include <gtest/gtest.h>

#include <cmath>

#include "../brush/reference.h"
#include "brush/preset/preset.h"
#include "core/text/units.h"
#include "trial_model.h"

namespace tuft::haptic {
namespace {

constexpr double kMicrojoule = 1e-6;

TrialOptions options_for(const DeviceLimits& limits, double delay = 0) {
    return {.law = {.limits = limits, .delay = delay}, .delay = delay, .jitter = delay > 0 ? 5e-4 : 0, .seconds = 2.5};
}

/// |Δf| in a period beyond k_max |Δx|, N: what a hand may feel as a step. What a count of noise makes in spring and
/// damper, with the fade, is 0.13 on Touch, 0.14 on Inverse3, 0.33 on Falcon, 0.11 on omega.6.
double allowed_step(const DeviceLimits& limits) {
    return limits.name == "falcon" ? 0.35 : 0.15;
}

/// `device`: one in turn for each motion, the first motion on the device of this number; negative: all for each.
void expect_passive(const std::string& place, const std::string& brush, double delay, int device = -1) {
    const TrialModel f = load_trial_model(place);
    const brush::Tuft tuft = tuft_of(brush);
    const int devices = static_cast<int>(device_presets().size());
    for (int d = 0; d < devices; ++d)
        for (int m = 0; m < static_cast<int>(std::size(kPaintingMotions)); ++m) {
            if (device >= 0 && (device + m) % devices != d) continue;
            const DeviceLimits& limits = device_presets()[static_cast<std::size_t>(d)];
            const HandMotion motion = kPaintingMotions[m];
            SCOPED_TRACE(place + " " + brush + " " + std::string(limits.name) + " " + std::string(name_of(motion)));
            const TrialReport r =
                run_trial(tuft, *f.surface, hand_path(motion, f.place, tuft.preset), options_for(limits, delay));
            // A contact gives back no more than it took: 1 µJ is a hundredth of what a light touch stores.
            EXPECT_GE(r.least_energy, -kMicrojoule);
            EXPECT_GE(r.least_with_arm, -kMicrojoule);
            EXPECT_LE(r.largest_step, allowed_step(limits));
            EXPECT_LE(r.largest_force, std::min(limits.max_force, kForceLimit) + 1e-9);
            EXPECT_GT(r.contacts, 0u);
        }
}

// A root that jumped by the lean of its holder, 8 mm, threw a light hand at 1.4 m/s and made steps of 0.36 N in the
// air.
TEST(HandPath, AHandSpeedsUpByNoMoreThanTheLawStandsFor) {
    const brush::Preset preset = brush::load_preset("wolf-large*4");  // long hair leans furthest
    const TrialPlace place{"plane", make_frame({0, 0, 0}, {0, 0, 1}, {1, 0, 0})};
    for (int m = 0; m <= static_cast<int>(HandMotion::slide); ++m)
        for (std::uint64_t seed = 0; seed < 12; ++seed) {
            const HandPath path = hand_path(static_cast<HandMotion>(m), place, preset, seed);
            double fastest = 0, turned = 0;
            HandTarget before = path(0.9), at = path(0.9 + kPeriod);
            for (double t = 0.9 + 2 * kPeriod; t < 3; t += kPeriod) {
                const HandTarget next = path(t);
                fastest = std::max(fastest, glm::length(next.position - 2.0 * at.position + before.position));
                turned = std::max(turned, glm::distance(turn_between(at.rotation, next.rotation),
                                                        turn_between(before.rotation, at.rotation)));
                before = at;
                at = next;
            }
            EXPECT_LT(fastest, 60 * kPeriod * kPeriod) << name_of(static_cast<HandMotion>(m)) << " " << seed;
            EXPECT_LT(turned, 500 * kPeriod * kPeriod) << name_of(static_cast<HandMotion>(m)) << " " << seed;
        }
}

TEST(Trial, PortAndWristGiveBackNothingOnASheet) {
    expect_passive("sheet", "wolf-medium", 0);
}

TEST(Trial, PortAndWristGiveBackNothingInABowlWithAMillisecondOfDelay) {
    expect_passive("bowl", "robot-2020", 1e-3, 0);
}

TEST(Trial, PortAndWristGiveBackNothingWithThreeMillisecondsAndALowerCoupling) {
    expect_passive("sheet", "wolf-medium", 3e-3, 1);
}

// Each motion with each brush and place, and each device with each of the three; the sheet above takes all together.
TEST(Trial, RoundBrushesGiveBackNothing) {
    int device = 0;
    for (const char* brush : {"goat-small", "mixed-medium", "liner-3"})
        for (const char* place : {"sheet", "bowl"}) expect_passive(place, brush, 0, device++);
}

constexpr double kRestoreStart = 30 * kMicrojoule;  ///< what the tank of a restored force begins with, e_0 of law.h

/// Energy alone, with delays of none and of a millisecond in turn: a device that has the one with a motion has the
/// other with the next, and other devices at another `turn`. `both`: each with both.
void expect_no_energy(const TrialModel& f, const std::string& brush, std::initializer_list<HandMotion> motions,
                      int turn = 0, bool both = false) {
    const brush::Tuft tuft = tuft_of(brush);
    for (const DeviceLimits& limits : device_presets()) {
        for (const HandMotion motion : motions) {
            const double turns = turn++ % 2 ? 1e-3 : 0.0;
            for (const double delay : {0.0, 1e-3}) {
                if (!both && delay != turns) continue;
                const TrialReport r =
                    run_trial(tuft, *f.surface, hand_path(motion, f.place, tuft.preset), options_for(limits, delay));
                EXPECT_GE(r.least_energy, -kMicrojoule)
                    << f.place.name << " " << brush << " " << limits.name << " " << name_of(motion) << " " << delay;
            }
        }
        turn += motions.size() % 2 == 0;
    }
}

// Five spines of hog hair on a ferrule 13 mm wide: the arm stands at its greatest force when the hand turns round.
TEST(Trial, AStiffFlatBrushGivesBackNothing) {
    expect_no_energy(load_trial_model("sheet"), "bright-12", {HandMotion::taps});
}

// Taps in the bowl press and let go within 60 ms: the tank took x for the place of the arm, which it was behind by up
// to a count, and gave back 17 µJ.
TEST(Trial, AStiffFlatBrushTappedIntoABowlGivesBackNothing) {
    const TrialModel f = load_trial_model("bowl");
    const brush::Tuft tuft = tuft_of("bright-12");
    TrialOptions options = options_for(device_preset("touch"));
    options.law.gain = tuft.preset.force_gain;
    options.seconds = 4;
    const TrialReport r = run_trial(tuft, *f.surface, hand_path(HandMotion::taps, f.place, tuft.preset), options);
    EXPECT_GE(r.least_energy, -kMicrojoule);
    EXPECT_LE(r.largest_step, allowed_step(options.law.limits));
}

// Hair that snaps over the car's edge while the hand moves along it: 0.13 N on omega.6 while the fade let pass what
// hair did in any motion of the root, whichever way it went.
TEST(Trial, HairThatSnapsOverAnEdgeComesAsARamp) {
    const TrialModel f = load_trial_model("edge");
    const brush::Tuft tuft = tuft_of("wolf-medium");
    const DeviceLimits& omega = device_preset("omega.6");
    for (const HandMotion motion : {HandMotion::press_fast, HandMotion::circles, HandMotion::rocking}) {
        const TrialReport r = run_trial(tuft, *f.surface, hand_path(motion, f.place, tuft.preset), options_for(omega));
        EXPECT_LE(r.largest_step, 0.08) << name_of(motion);  // N: 0.06 of the fade, and a count of 10 µm on 2,000 N/m
    }
}

/// Extent along the normal of the roots of the last 0.3 s of a slow press that stands still, m, after `report`.
double swing_of(const TrialReport& report, const TrialModel& f) {
    double least = 1e9, most = -1e9;
    for (std::size_t i = report.roots.size() - 300; i < report.roots.size(); ++i) {
        const double height = glm::dot(report.roots[i].pose.position, f.place.frame.n);
        least = std::min(least, height);
        most = std::max(most, height);
    }
    return most - least;
}

// Hair that stands on its ends, and a sponge on an edge, push back with 10,000 N/m and more at the hand. While the fade
// let their force come late, the root swung on them by 1.3 mm, up to 14 N, in a slow press: the hand got back
// 163 and 472 µJ, and the stroke was painted from such a root.
TEST(Trial, ARootOnStiffHairStandsStillAndGivesNothingBack) {
    for (const auto& [place, brush] : {std::pair("sheet", "bright-12"), std::pair("rim", "sponge-30")}) {
        SCOPED_TRACE(place);
        const TrialModel f = load_trial_model(place);
        const brush::Tuft tuft = tuft_of(brush);
        TrialOptions options = options_for(device_preset("touch"));
        options.law.gain = tuft.preset.force_gain;
        options.record = true;
        const auto path = hand_path(HandMotion::press, f.place, tuft.preset);
        options.seconds = 2.4;                                                     // the hand stands from 2.0 s on
        EXPECT_LT(swing_of(run_trial(tuft, *f.surface, path, options), f), 5e-5);  // a count of the arm
        options.seconds = 4;                                                       // and is up again
        const TrialReport r = run_trial(tuft, *f.surface, path, options);
        EXPECT_GE(r.least_energy, -kMicrojoule);
        EXPECT_LE(r.largest_step, allowed_step(options.law.limits));
    }
}

// Falcon's counts of 60 µm made a saw of 0.1 N in spring and damper, which with a delay pushed the hand on: 2.0, 1.3
// and 1.0 µJ before the hair had any force. Its tank came to know of two counts at once, a step of 0.50 N.
TEST(Trial, ASlowPressOnCoarseCountsGivesNothingBack) {
    const TrialModel f = load_trial_model("sheet");
    for (const char* brush : {"filbert-12", "bright-12", "rigger-3"}) {
        const brush::Tuft tuft = tuft_of(brush);
        TrialOptions options = options_for(device_preset("falcon"), 1e-3);
        options.seconds = 4;
        const TrialReport r = run_trial(tuft, *f.surface, hand_path(HandMotion::press, f.place, tuft.preset), options);
        EXPECT_GE(r.least_energy, -kMicrojoule) << brush;
        EXPECT_LE(r.largest_step, allowed_step(options.law.limits)) << brush;
    }
}

// Beside a shut line the planes of nodes change from one period to the next, and the hair's force works by itself.
TEST(Trial, EdgesGiveBackNothing) {
    int turn = 0;
    for (const char* place : {"edge", "rim", "plate"})
        expect_no_energy(load_trial_model(place), "wolf-medium", {HandMotion::taps}, turn++);
}

TEST(Trial, HairTrappedInAShutLineGivesBackNothing) {
    TrialModel f = load_trial_model("edge");
    f.place = place_at_edge(*f.surface, "shut line", true);
    expect_no_energy(f, "wolf-small", {HandMotion::drag, HandMotion::taps});
}

// Thin hair that snaps over between the planes there turns the holder, which an arm without torque does not brake: its
// moment once gave the wrist 2.8 mJ that the tank did not have.
TEST(Trial, HairThatTurnsTheWristGivesNothingBack) {
    TrialModel f = load_trial_model("edge");
    f.place = place_at_edge(*f.surface, "shut line", true);
    expect_no_energy(f, "liner-3", {HandMotion::rocking}, 0, true);
}

// Restore leaks like any lag; the arm's friction pays.
TEST(Trial, RestoreIsPaidForByTheArm) {
    const TrialModel f = load_trial_model("sheet");
    const brush::Tuft tuft = tuft_of("wolf-medium");
    for (const DeviceLimits& limits : device_presets())
        for (const HandMotion motion : kPaintingMotions) {
            TrialOptions options = options_for(limits);
            options.law.restore = true;
            const TrialReport r = run_trial(tuft, *f.surface, hand_path(motion, f.place, tuft.preset), options);
            EXPECT_GE(r.least_with_arm, -kRestoreStart) << limits.name << " " << name_of(motion);
            EXPECT_LE(r.largest_step, allowed_step(limits)) << limits.name << " " << name_of(motion);
        }
}

// With restore the tank runs out while the force is still great. It comes to know of a motion by two counts at once,
// 0.12 mm on Falcon, and once cut the force by 0.49 N on the sheet and by 0.67 N where the ferrule slides at the rim.
TEST(Trial, ARestoredForceThatEndsFallsWithoutSteps) {
    const DeviceLimits& falcon = device_preset("falcon");
    for (const auto& [place, motion] : {std::pair("sheet", HandMotion::hit), std::pair("rim", HandMotion::slide)}) {
        const TrialModel f = load_trial_model(place);
        const brush::Tuft tuft = tuft_of("wolf-medium");
        TrialOptions options = options_for(falcon, 1e-3);
        options.law.restore = true;
        options.seconds = 4;
        const TrialReport r = run_trial(tuft, *f.surface, hand_path(motion, f.place, tuft.preset), options);
        EXPECT_GT(r.limited, 100u) << place;
        EXPECT_LE(r.largest_step, allowed_step(falcon)) << place;
        EXPECT_GE(r.least_with_arm, -kRestoreStart) << place;
    }
}

TEST(Trial, RandomHandsGetNothingBack) {
    const TrialModel f = load_trial_model("sheet");
    const brush::Tuft tuft = tuft_of("wolf-medium");
    for (int hand = 0; hand < 40; ++hand) {
        Random random(static_cast<std::uint64_t>(hand) + 1);
        TrialOptions options = options_for(device_presets()[random.bits() % device_presets().size()]);
        options.hand = {.mass = 0.02 * std::pow(25.0, random.uniform()),
                        .damping = random.uniform(1, 12),
                        .stiffness = 50 * std::pow(20.0, random.uniform())};
        const HandMotion motion = kPaintingMotions[random.bits() % std::size(kPaintingMotions)];
        const TrialReport r =
            run_trial(tuft, *f.surface, hand_path(motion, f.place, tuft.preset, random.bits() | 1), options);
        EXPECT_GE(r.least_energy, -kMicrojoule) << hand << " " << options.law.limits.name << " " << name_of(motion);
    }
}

/// A hand of `tuft device test --hands` on Touch: 20 g of a finger to half a kilogram of an arm.
struct RandomHand {
    TrialOptions options;
    std::uint64_t path = 0;

    RandomHand(std::uint64_t number, const brush::Preset& preset) {
        Random random(number + 1);
        options = {.law = {.limits = device_preset("touch"), .gain = preset.force_gain}, .seconds = 2};
        options.hand = {.mass = 0.02 * std::pow(25.0, random.uniform()),
                        .damping = random.uniform(1, 12),
                        .stiffness = 50 * std::pow(20.0, random.uniform())};
        random.bits(), random.bits();  // place and motion
        path = random.bits() | 1;
    }
};

/// Random hand `number` with wolf-medium on Touch, at the car's edge.
TrialReport run_random_hand(std::uint64_t number, HandMotion motion, const TrialModel& edge) {
    const brush::Tuft tuft = brush::make_tuft(brush::load_preset("wolf-medium"));
    const RandomHand hand(number, tuft.preset);
    return run_trial(tuft, *edge.surface, hand_path(motion, edge.place, tuft.preset, hand.path), hand.options);
}

// The root moves at 0.9 m/s when the hair comes to the shut line: what the hand gave in the period before is in its
// motion already, and once stayed in the tank besides.
TEST(Trial, WhatCameInBeforeAContactGivesNothingBack) {
    TrialModel f = load_trial_model("edge");
    f.place = place_at_edge(*f.surface, "shut line", true);
    const TrialReport r = run_random_hand(120, HandMotion::taps, f);
    EXPECT_GE(r.least_energy, -kMicrojoule);
    EXPECT_GT(r.contacts, 2u);
}

// Hair that bursts off the bowl leaves the spring of the coupling stretched by what was faded: a contact's end once
// filled the tank with it, and gave back 2 mJ in steps of 2 N.
TEST(Trial, ASpringThatTheFadeStretchedGivesNothingBack) {
    const TrialModel f = load_trial_model("bowl");
    const brush::Tuft tuft = tuft_of("wolf-medium");
    const RandomHand hand(707, tuft.preset);
    const TrialReport r =
        run_trial(tuft, *f.surface, hand_path(HandMotion::taps, f.place, tuft.preset, hand.path), hand.options);
    EXPECT_GE(r.least_energy, -kMicrojoule);
    EXPECT_LE(r.largest_step, allowed_step(device_preset("touch")));
    EXPECT_GT(r.contacts, 5u);
}

// The root never passes the surface; the arm does by what its motors cannot hold.
TEST(Trial, FerruleAtHalfAMetrePerSecondStopsAndGivesNothingBack) {
    for (const char* place : {"sheet", "rim"}) {
        const TrialModel f = load_trial_model(place);
        const brush::Tuft tuft = tuft_of("wolf-small");
        for (const DeviceLimits& limits : device_presets())
            for (const HandMotion motion : {HandMotion::hit, HandMotion::slide}) {
                TrialOptions options = options_for(limits);
                options.hand = {.mass = 0.3, .damping = 8, .stiffness = 800};
                options.record = true;
                const TrialReport r = run_trial(tuft, *f.surface, hand_path(motion, f.place, tuft.preset), options);
                EXPECT_GE(r.least_energy, -kMicrojoule) << place << " " << limits.name << " " << name_of(motion);
                if (std::string(place) != "sheet") continue;
                for (const SolvedPose& p : r.roots)
                    ASSERT_GT(glm::dot(p.pose.position - f.place.frame.origin, f.place.frame.n), -1e-4)
                        << limits.name << " " << name_of(motion);
            }
    }
}

/// Four recorded seconds of a press that stands still at its end.
TrialReport rest_on(const TrialModel& f, const brush::Tuft& tuft, TrialOptions options) {
    options.record = true;
    options.seconds = 4;
    return run_trial(tuft, *f.surface, hand_path(HandMotion::rest, f.place, tuft.preset), options);
}

// What a sample may cost, in counts that do not depend on the machine. At 0.5 m/s hair lands on an edge in up to six
// parts, each with the passes of its friction; at a jump of the potential eight searches end the solve. Measured 155 at
// most; a pass that crawled along a jump took 485.
TEST(Trial, NoSampleCostsMoreThanAFewHundredEvaluations) {
    for (const char* place : {"rim", "edge", "plate"})
        for (const HandMotion motion : {HandMotion::taps, HandMotion::circles, HandMotion::rocking}) {
            SCOPED_TRACE(std::string(place) + " " + std::string(name_of(motion)));
            const TrialModel f = load_trial_model(place);
            const brush::Tuft tuft = tuft_of("wolf-medium");
            const TrialReport r = run_trial(tuft, *f.surface, hand_path(motion, f.place, tuft.preset),
                                            options_for(device_preset("touch")));
            EXPECT_GT(r.solves.most_evaluations, 0);
            EXPECT_LE(r.solves.most_evaluations, 200);
        }
}

// Hair at rest keeps its planes: a sample starts where the last one ended and needs one evaluation, or two.
// Measured 3.7 with the landing; 9.8 where the planes of one face of the edge led to the other and back in each sample.
TEST(Trial, RestAtAnEdgeTakesFewEvaluations) {
    const TrialModel f = load_trial_model("edge");
    const brush::Tuft tuft = tuft_of("wolf-medium");
    const TrialReport r = run_trial(tuft, *f.surface, hand_path(HandMotion::rest, f.place, tuft.preset),
                                    options_for(device_preset("touch")));
    EXPECT_GT(r.solves.count, 1000u);
    EXPECT_LT(static_cast<double>(r.solves.evaluations), 5.0 * static_cast<double>(r.solves.count));
}

TEST(Trial, RestIsSteady) {
    const TrialModel f = load_trial_model("sheet");
    const brush::Tuft tuft = tuft_of("wolf-medium");
    for (const DeviceLimits& limits : device_presets()) {
        const TrialReport r = rest_on(f, tuft, options_for(limits));
        double least = 1e9, most = 0;
        for (std::size_t i = r.forces.size() - 1000; i < r.forces.size(); ++i) {
            least = std::min(least, glm::length(r.forces[i]));
            most = std::max(most, glm::length(r.forces[i]));
        }
        EXPECT_GT(least, 0.1) << limits.name;
        EXPECT_LT(most - least, 2e-3) << limits.name;  // N, below what a finger feels
    }
}

// At rest spring and hair balance: f = G F(y), whatever the device.
TEST(Trial, SteadyForceIsTheHairsAtTheVirtualRoot) {
    const TrialModel f = load_trial_model("sheet");
    const brush::Tuft tuft = tuft_of("wolf-medium");
    for (const DeviceLimits& limits : device_presets()) {
        const TrialOptions options = options_for(limits);
        const TrialReport r = rest_on(f, tuft, options);
        const Vec3 device_force = r.forces.back(), hair = options.law.gain * r.last_hair;
        EXPECT_LT(glm::distance(device_force, hair), 0.02 * glm::length(hair)) << limits.name;
        HairSolver again(tuft, *f.surface);
        HairAnswer answer;
        for (const SolvedPose& p : r.roots) answer = again.solve(p.pose);
        EXPECT_EQ(answer.force, r.last_hair);
    }
}

/// Normal force of the reference, N, of a straight rod at 85° to a plane without friction, whose root stands at
/// `height`.
double rod_on_plane(const brush::Preset& p, double height) {
    const double depth = std::sin(85 * kDegree) - height / p.length;
    std::vector<Vec2> known;  // depth over length, N L² / B0
    for (const Row& row : read_rows("rod_on_plane.csv"))
        if (row["alpha"] == p.alpha && row["beta"] == p.beta && row["tilt_deg"] == 85 && row.text("drag") == "none")
            known.emplace_back(row["depth_over_L"], row["N_L2_E0I0"]);
    for (std::size_t i = 1; i < known.size(); ++i)
        if (known[i - 1].x <= depth && depth < known[i].x) {
            const double u = std::log(depth / known[i - 1].x) / std::log(known[i].x / known[i - 1].x);
            return std::pow(known[i - 1].y, 1 - u) * std::pow(known[i].y, u) * p.stiffness / (p.length * p.length);
        }
    ADD_FAILURE() << "no reference at depth " << depth;
    return 0;
}

// An ideal rod for hair, through arm, coupling, law and solver: what the hand holds is what the reference says of a rod
// whose root is where the virtual root has come to rest.
TEST(Trial, SteadyForceOfAnUprightPressIsThatOfARodOnAPlane) {
    const TrialModel f = load_trial_model("sheet");
    brush::Preset p = brush::load_preset("wolf-medium");
    p.alpha = p.beta = -0.5;
    p.stiffness = 5e-5;
    p.tip_stiffness = p.yield = p.plastic_share = p.recovery = p.end_compliance = p.adhesion = 0;
    p.friction_wet = p.friction_dry = p.with_hair = p.pore_grip = 0;
    p.radius = p.tip_radius = 1e-4;
    p.transverse_stiffness = 1e6;
    const brush::Tuft tuft = brush::make_tuft(p, 1);
    const Quat lean = glm::angleAxis(5 * kDegree, Vec3{0, 1, 0});
    for (const DeviceLimits& limits : device_presets()) {
        TrialOptions options = options_for(limits);
        options.law.gain = 4;
        options.record = true;
        const auto path = [&](double t) {
            const double up = 1.1 - 0.3 * std::clamp((t - 1) / 0.5, 0.0, 1.0);
            return HandTarget{.position = f.place.frame.origin + Vec3{0, 0, up * p.length}, .rotation = lean};
        };
        const TrialReport r = run_trial(tuft, *f.surface, path, options);
        const double height = r.roots.back().pose.position.z - f.place.frame.origin.z;
        const double expected = options.law.gain * rod_on_plane(p, height);
        EXPECT_NEAR(r.forces.back().z, expected, 0.02 * expected) << limits.name << " " << height / p.length;
    }
}

// With the softness of the coupling taken away the hand has what the hair gives that has come the same way and goes on
// to where the hand itself is. Hair sticks: its force there after the shorter way of the hand alone is up to a sixth
// less.
TEST(Trial, WithRestoreAHandAtRestHasTheForceOfTheHairAtTheArm) {
    const brush::Tuft tuft = tuft_of("wolf-medium");
    for (const auto& [place, device] :
         {std::pair("sheet", "touch"), std::pair("sheet", "omega.6"), std::pair("bowl", "touch"),
          std::pair("bowl", "inverse3"), std::pair("roof", "touch"), std::pair("roof", "falcon")}) {
        const TrialModel f = load_trial_model(place);
        const DeviceLimits& limits = device_preset(device);
        TrialOptions options = options_for(limits);
        options.law.restore = true;
        const TrialReport r = rest_on(f, tuft, options);
        HairSolver there(tuft, *f.surface);
        HairAnswer answer;
        for (const SolvedPose& p : r.roots) answer = there.solve(p.pose);
        RootPose pose = r.roots.back().pose;
        const Vec3 from = pose.position;
        constexpr int kSteps = 20;
        for (int i = 1; i <= kSteps; ++i) {
            pose.position = glm::mix(from, r.arms.back(), double(i) / kSteps);
            ++pose.tick;
            answer = there.solve(pose);
        }
        const Vec3 hair = options.law.gain * answer.force;
        EXPECT_GT(glm::length(hair), 0.1) << place;
        // The arm is known to half a count along each axis: 0.87 askew, and what the hand's last creeping has left.
        EXPECT_LT(glm::distance(from, r.arms.back()), limits.count) << place << " " << limits.name;
        EXPECT_LT(glm::distance(r.forces.back(), hair), 0.03 * glm::length(hair)) << place << " " << limits.name;
    }
}

// The wire may take half a millisecond longer for one force than for another.
TEST(Trial, JitterOfTheWireGivesNothingBack) {
    const TrialModel f = load_trial_model("sheet");
    const brush::Tuft tuft = tuft_of("wolf-medium");
    for (const DeviceLimits& limits : device_presets())
        for (const HandMotion motion : {HandMotion::taps, HandMotion::rocking}) {
            TrialOptions options = options_for(limits);
            options.jitter = 5e-4;
            const TrialReport r = run_trial(tuft, *f.surface, hand_path(motion, f.place, tuft.preset), options);
            EXPECT_GE(r.least_energy, -kMicrojoule) << limits.name << " " << name_of(motion);
        }
}

TEST(Trial, SameOptionsGiveTheSameBits) {
    const TrialModel f = load_trial_model("bowl");
    const brush::Tuft tuft = tuft_of("goat-small");
    const auto path = hand_path(HandMotion::rocking, f.place, tuft.preset);
    const TrialOptions options = options_for(device_preset("inverse3"), 1e-3);
    EXPECT_EQ(run_trial(tuft, *f.surface, path, options).hash, run_trial(tuft, *f.surface, path, options).hash);
}

TEST(Trial, PasteDragsAgainstTheMotionAndStaysPassive) {
    const TrialModel f = load_trial_model("sheet");
    const brush::Tuft tuft = tuft_of("wolf-medium");
    TrialOptions options = options_for(device_preset("omega.6"));
    const auto path = hand_path(HandMotion::circles, f.place, tuft.preset);
    const double without = run_trial(tuft, *f.surface, path, options).largest_force;
    options.solver.added.yield_stress = 300;  // Pa, of stiff oil paint
    const TrialReport paste = run_trial(tuft, *f.surface, path, options);
    EXPECT_GT(paste.largest_force, without);
    EXPECT_GE(paste.least_energy, -kMicrojoule);
}

// A tenth of a newton on the hand over the last millimetre, and heavy body colour under the hair.
TEST(Trial, ProximityAndPasteTogetherGiveBackNothing) {
    const TrialModel f = load_trial_model("sheet");
    const brush::Tuft tuft = tuft_of("wolf-medium");
    for (const DeviceLimits& limits : device_presets())
        for (const HandMotion motion : {HandMotion::taps, HandMotion::circles, HandMotion::press}) {
            TrialOptions options = options_for(limits);
            options.solver.added = {.proximity = 0.1 / options.law.gain, .yield_stress = 400};
            const TrialReport r = run_trial(tuft, *f.surface, hand_path(motion, f.place, tuft.preset), options);
            EXPECT_GE(r.least_energy, -kMicrojoule) << limits.name << " " << name_of(motion);
            EXPECT_LE(r.largest_step, allowed_step(limits)) << limits.name << " " << name_of(motion);
        }
}

TEST(Trial, ProximityIsFeltBeforeTheHairTouches) {
    const TrialModel f = load_trial_model("sheet");
    const brush::Tuft tuft = tuft_of("wolf-medium");
    HairSolver solver(tuft, *f.surface, {.added = {.proximity = 0.01}});
    solver.set_ink(0, 0);  // no film that pulls at it
    RootPose pose{.position = f.place.frame.origin + (tuft.preset.length + 2e-3) * f.place.frame.n};
    EXPECT_EQ(solver.solve(pose).force, Vec3{0});
    pose.position -= 1.5e-3 * f.place.frame.n;
    pose.tick = 1;
    const HairAnswer near = solver.solve(pose);
    EXPECT_FALSE(near.touching);
    EXPECT_NEAR(glm::dot(near.force, f.place.frame.n), 0.005, 1.5e-3);  // halfway, but for the point's radius
}

}  // namespace
}  // namespace tuft::haptic
