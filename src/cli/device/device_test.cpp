#include <fmt/format.h>
#include <pthread.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <thread>

#include "brush/preset/preset.h"
#include "cli/device/device_trials.h"
#include "cli/steps/steps.h"
#include "core/system/allocations.h"
#include "core/system/interrupt.h"
#include "haptic/arm_check.h"
#include "haptic/loop.h"

/// `tuft device test`: the figures of stability, safety and loop.
namespace tuft::cli {
namespace {

int slowest_stop(const DeviceWork& a, const Places& places) {
    const brush::Tuft tuft = brush::make_tuft(brush_in_hand(a, a.brush));
    const auto path = haptic::hand_path(haptic::HandMotion::rest, places.place[0], tuft.preset);
    int slowest = 0;
    for (const haptic::TrialFault fault : haptic::kTrialFaults) {
        const int periods =
            haptic::periods_to_stop(tuft, *places.surface[0], path, trial_options(a, tuft.preset), fault, 2.5);
        if (periods < 0) throw Error("the force of the simulated arm does not end");
        slowest = std::max(slowest, periods);
    }
    return slowest;
}

/// The loop by the wall clock; with a real arm in the air, far from the model.
haptic::LoopStatus run_loop(const DeviceWork& a, const Places& places, haptic::Fault& fault) {
    const brush::Preset preset = brush_in_hand(a, a.brush);
    const haptic::HandPath path = haptic::hand_path(haptic::HandMotion::circles, places.place[0], preset);
    haptic::DeviceState state;
    const std::unique_ptr<haptic::Device> device = open_device(a, path, state);
    const haptic::LawOptions law{.limits = device->limits(), .gain = preset.force_gain, .restore = a.restore};
    haptic::Loop loop(*device,
                      haptic::HairSolver(brush::make_tuft(preset), *places.surface[0], solver_options(a, preset)),
                      {.law = law, .count_allocations = allocations_of_this_thread});
    haptic::ServoControl control;
    if (a.arm.simulate.empty()) {
        const Frame& f = places.place[0].frame;
        control.workspace = workspace_at(state, f.origin + 1.0 * f.n);
    }
    loop.set_control(control);
    fault = run_for(loop, a.seconds);
    check_interrupt();
    return loop.status();
}

constexpr const char* kFaultNames[] = {"silence", "not_a_number", "jump", "pause", "emergency"};
static_assert(std::size(kFaultNames) == std::size(haptic::kTrialFaults));

/// The safety of a real arm that nobody holds, by the wall clock.
haptic::ArmCheck check_arm(const DeviceWork& a) {
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::milliseconds kTick{1};
    haptic::DeviceState state;
    const std::unique_ptr<haptic::Device> device = open_device(a, {}, state);
    haptic::ArmCheck check(device->limits());
    std::thread servo([&] {
        const sched_param priority{.sched_priority = haptic::LoopOptions{}.servo_priority};
        ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &priority);  // where the system allows it
        const Clock::time_point begin = Clock::now();
        for (std::uint64_t tick = 1; !check.done() && !interrupted();) {
            std::this_thread::sleep_until(begin + tick * kTick);
            const bool fresh = device->read(state);
            device->send(check.step(tick, fresh ? &state : nullptr));
            tick = std::max<std::uint64_t>(tick + 1, static_cast<std::uint64_t>((Clock::now() - begin) / kTick));
        }
        device->send({});
    });
    servo.join();
    check_interrupt();
    return check;
}

nlohmann::json to_json(const haptic::ArmCheck& check) {
    const haptic::ArmFigures f = check.figures();
    nlohmann::json stops;
    int slowest = -1;
    for (std::size_t i = 0; i < f.stop.size(); ++i) {
        slowest = std::max(slowest, f.stop[i]);
        stops[kFaultNames[i]] = f.stop[i] < 0 ? nlohmann::json() : nlohmann::json(f.stop[i]);
    }
    return {{"safe", check.finding().empty()}, {"states_per_s", f.states_per_period / haptic::kPeriod},
            {"count_um", 1e6 * f.count},       {"noise_um", 1e6 * f.noise},
            {"moved_mm", 1e3 * f.moved},       {"check_force_n", f.greatest_force},
            {"check_step_n", f.largest_step},  {"ramp_ms", 1e3 * f.ramp},
            {"stop_after_ms", stops},          {"stop_ms", slowest}};
}

double percent(std::uint64_t part, std::uint64_t whole) {
    return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0;
}

double quantile(std::vector<float> values, double q) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    return static_cast<double>(values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))]);
}

nlohmann::json to_json(const Trials& trials) {
    const haptic::TrialReport& worst = trials.worst;
    const std::vector<float>& solves = worst.solves.seconds;
    const TrialsDone &hands = trials.hands, &hours = trials.hours;
    return {{"complete", trials.complete},
            {"hands", hands.count},
            {"hand_cpu_ms", 1e3 * hands.cpu_seconds / static_cast<double>(std::max<std::size_t>(hands.count, 1))},
            {"minutes", hours.count},
            {"least_energy_uj", 1e6 * worst.least_energy},
            {"least_energy_at", trials.least_energy_at},
            {"least_energy_with_arm_uj", 1e6 * worst.least_with_arm},
            {"largest_step_n", worst.largest_step},
            {"largest_step_at", trials.largest_step_at},
            {"largest_step_hard_n", worst.largest_step_hard},
            {"largest_force_n", worst.largest_force},
            {"trials", trials.motions.count + hands.count + hours.count},
            {"simulated_s", static_cast<double>(worst.periods) * haptic::kPeriod},
            {"contacts", worst.contacts},
            {"most_evaluations", worst.solves.most_evaluations},
            {"mean_evaluations", static_cast<double>(worst.solves.evaluations) /
                                     static_cast<double>(std::max<std::size_t>(worst.solves.count, 1))},
            {"unconverged_percent", percent(worst.solves.unconverged, worst.solves.count)},
            {"solve_us",
             {{"p50", 1e6 * quantile(solves, 0.5)},
              {"p999", 1e6 * quantile(solves, 0.999)},
              {"worst", 1e6 * quantile(solves, 1)}}}};
}

void add_loop(nlohmann::json& out, const haptic::LoopStatus& loop) {
    out["late_percent"] = percent(loop.counts.cycle.late, loop.counts.cycle.count);
    out["worst_cycle_ms"] = 1e3 * loop.counts.cycle.worst;
    out["p999_cycle_ms"] = 1e3 * loop.counts.cycle.quantile(0.999);
    out["allocations"] = loop.counts.allocations;
    out["late_solves_percent"] = percent(loop.counts.late_solves, loop.counts.solves);
    out["lost_poses"] = loop.counts.lost_poses;
    out["realtime"] = loop.realtime;
    out["memory_locked"] = loop.locked;
}

void print(const nlohmann::json& out, bool as_json) {
    if (as_json)
        print_json(out);
    else
        for (const auto& [key, value] : out.items()) fmt::print("{:26}{}\n", key, value.dump());
    std::fflush(stdout);
}

}  // namespace

int test_device(const DeviceWork& a) {
    Console console(a.common.quiet);
    const Places places = places_of(a);
    nlohmann::json out;
    const LastWords figures;
    haptic::LoopStatus loop;
    haptic::Fault fault = haptic::Fault::none;
    Message finding;
    try {
        if (!a.arm.simulate.empty()) {
            haptic::device_preset(a.arm.simulate);
            const Trials trials = run_trials(a, places, console);
            out = to_json(trials);
            if (!trials.complete) throw Cancelled();
            out["stop_ms"] = slowest_stop(a, places);
        } else {
            const haptic::ArmCheck check = check_arm(a);
            out = to_json(check);
            finding = check.finding();
        }
        // An arm that is not safe gets no force of hair.
        if (finding.empty()) loop = run_loop(a, places, fault);
    } catch (const Cancelled&) {  // what there is, is printed
        console.clear();
        if (!out.empty()) print(out, a.common.json);
        throw;
    }
    console.clear();
    if (finding.empty()) add_loop(out, loop);
    if (finding.empty() && !loop.realtime)
        console.note("the system allows no real-time priority: cycles will be late (ulimit -r, or CAP_SYS_NICE)");
    print(out, a.common.json);
    if (!finding.empty()) throw Error(finding);
    if (fault != haptic::Fault::none) throw Error(haptic::describe(fault));
    return 0;
}

}  // namespace tuft::cli
