#include "haptic/trial.h"

#include <algorithm>
#include <cmath>

#include "core/hash.h"
#include "core/system/interrupt.h"

namespace tuft::haptic {
namespace {

constexpr double kNoticeable = 0.02;      // N
constexpr std::uint64_t kAfterHard = 10;  // periods in which a blow of the ferrule dies away

/// Energies of one contact after the other.
struct Judge {
    double wrist = 0;  // J since the beginning
    bool contact = false;
    double base = 0, base_with_arm = 0;

    // What is in the coupling when the contact begins came from the hand.
    void see(bool touches, double coupled, const ArmEnergy& arm, TrialReport& report) {
        const double energy = arm.port + wrist, with_arm = energy + arm.losses;
        if (touches && !contact) {
            base = energy - coupled;
            base_with_arm = with_arm - coupled;
            ++report.contacts;
        }
        if (contact || touches) {
            report.least_energy = std::min(report.least_energy, energy - base);
            report.least_with_arm = std::min(report.least_with_arm, with_arm - base_with_arm);
        }
        contact = touches;
    }
};

}  // namespace

TrialReport run_trial(const brush::Tuft& tuft, const mesh::SurfaceQuery& surface, const HandPath& path,
                      const TrialOptions& options) {
    SimulatedArm arm(options.law.limits, path,
                     {.hand = options.hand, .delay = options.delay, .jitter = options.jitter, .seed = options.seed});
    HairSolver solver(tuft, surface, options.solver);
    Servo servo(options.law);
    TrialReport report;
    Judge judge;
    const double k_max = options.law.limits.max_stiffness;
    const auto periods = static_cast<std::uint64_t>(options.seconds / kPeriod);
    HairAnswer answer;
    bool answered = false;
    Vec3 force{0}, at{0};
    Quat rotation{1, 0, 0, 0};
    std::uint64_t last_hard = 0;
    for (std::uint64_t tick = 1; tick <= periods; ++tick) {
        if (tick % 64 == 0) check_interrupt();
        const double time = static_cast<double>(tick) * kPeriod;
        arm.advance(time);
        const DeviceState state = arm.measure();
        if (tick > 1) judge.wrist -= glm::dot(servo.law().moment, turn_between(rotation, arm.rotation()));
        rotation = arm.rotation();
        const RootPose pose = servo.begin(tick, &state, {});
        if (servo.engaged()) {
            answer = solver.solve(pose);
            answered = true;
            ++report.solves.count;
            report.solves.unconverged += !answer.converged;
            const brush::SolverWork& work = solver.state().work;
            report.solves.most_evaluations = std::max(report.solves.most_evaluations, work.evaluations + work.values);
            report.solves.evaluations += static_cast<std::uint64_t>(work.evaluations + work.values);
            report.solves.seconds.push_back(static_cast<float>(answer.seconds));
            if (options.record) {
                report.roots.push_back({pose, answer.touching});
                report.arms.push_back(arm.position());
            }
        }
        const ServoOutput out = servo.finish(answered ? &answer : nullptr);
        arm.command(out.command, time);
        if (out.hard) last_hard = tick;
        const bool hard = last_hard > 0 && tick - last_hard < kAfterHard;
        const double moved = tick > 1 ? glm::distance(arm.position(), at) : 0;
        const double step = glm::distance(out.force, force) - k_max * moved;
        double& largest = hard ? report.largest_step_hard : report.largest_step;
        largest = std::max(largest, step);
        report.largest_force = std::max(report.largest_force, glm::length(out.force));
        if (out.hard) report.deepest = std::max(report.deepest, glm::distance(out.root, state.position));
        report.limited += out.limited;
        report.hash = hash_bytes(&out.force, sizeof out.force, report.hash);
        if (options.record) report.forces.push_back(out.force);
        judge.see(!servo.law().free, servo.law().coupled, arm.energy(), report);
        force = out.force;
        at = arm.position();
        ++report.periods;
    }
    report.last_hair = answer.force;
    return report;
}

int periods_to_stop(const brush::Tuft& tuft, const mesh::SurfaceQuery& surface, const HandPath& path,
                    const TrialOptions& options, TrialFault fault, double from) {
    constexpr int kLongest = 100;
    SimulatedArm arm(options.law.limits, path, {.hand = options.hand, .seed = options.seed});
    HairSolver solver(tuft, surface, options.solver);
    Servo servo(options.law);
    const auto begin = static_cast<std::uint64_t>(from / kPeriod);
    bool had_force = false;
    for (std::uint64_t tick = 1; tick < begin + kLongest; ++tick) {
        const double time = static_cast<double>(tick) * kPeriod;
        arm.advance(time);
        DeviceState state = arm.measure();
        const bool wrong = tick >= begin;
        ServoControl control;
        const bool heard = !wrong || make_fault(fault, state, control);
        const RootPose pose = servo.begin(tick, heard ? &state : nullptr, control);
        HairAnswer answer;
        if (servo.engaged()) answer = solver.solve(pose);
        const ServoOutput out = servo.finish(servo.engaged() ? &answer : nullptr);
        arm.command(out.command, time);
        if (!wrong) had_force = glm::length(out.force) > kNoticeable;
        if (wrong && out.force == Vec3{0}) return had_force ? static_cast<int>(tick - begin) : -1;
    }
    return -1;
}

void merge(TrialReport& into, const TrialReport& from) {
    into.least_energy = std::min(into.least_energy, from.least_energy);
    into.least_with_arm = std::min(into.least_with_arm, from.least_with_arm);
    into.largest_step = std::max(into.largest_step, from.largest_step);
    into.largest_step_hard = std::max(into.largest_step_hard, from.largest_step_hard);
    into.largest_force = std::max(into.largest_force, from.largest_force);
    into.deepest = std::max(into.deepest, from.deepest);
    into.periods += from.periods;
    into.solves.count += from.solves.count;
    into.solves.unconverged += from.solves.unconverged;
    into.solves.most_evaluations = std::max(into.solves.most_evaluations, from.solves.most_evaluations);
    into.solves.evaluations += from.solves.evaluations;
    into.limited += from.limited;
    into.contacts += from.contacts;
    into.solves.seconds.insert(into.solves.seconds.end(), from.solves.seconds.begin(), from.solves.seconds.end());
    into.hash = hash_bytes(&from.hash, sizeof from.hash, into.hash);
}

}  // namespace tuft::haptic
