#include "cli/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <thread>

#include "brush/preset/preset.h"
#include "cli/steps.h"
#include "core/random.h"
#include "core/system/allocations.h"
#include "core/system/interrupt.h"
#include "haptic/loop.h"

/// `tuft device test`: the figures of stability, safety and loop.
namespace tuft::cli {
namespace {

using namespace std::chrono_literals;
using haptic::TrialOptions;
using haptic::TrialReport;

/// Where hands try.
struct Places {
    std::vector<ContactModel> models;
    std::vector<const mesh::SurfaceQuery*> surface;
    std::vector<haptic::TrialPlace> place;

    enum class Where { above, edge, groove };
    void add(ContactModel model, const std::string& name, Where where) {
        surface.push_back(model.surface.get());
        place.push_back(where == Where::above ? haptic::place_above(*surface.back(), name)
                                              : haptic::place_at_edge(*surface.back(), name, where == Where::groove));
        models.push_back(std::move(model));
    }
};

Places places_of(const DeviceWork& a) {
    Places places;
    if (!a.model.empty()) {
        places.add(load_contact_model(a.model), "model", Places::Where::above);
        places.add(load_contact_model(a.model), "edge", Places::Where::edge);
        return places;
    }
    places.add(load_contact_model("sheet"), "sheet", Places::Where::above);
    places.add(load_contact_model("bowl"), "bowl", Places::Where::above);
    places.add(load_contact_model("bowl"), "rim", Places::Where::edge);
    places.add(load_contact_model("car"), "roof", Places::Where::above);
    places.add(load_contact_model("car"), "car's edge", Places::Where::edge);
    places.add(load_contact_model("car"), "shut line", Places::Where::groove);
    places.add(load_contact_model("plate"), "plate's edge", Places::Where::edge);
    return places;
}

TrialOptions trial_options(const DeviceWork& a, const brush::Preset& preset) {
    TrialOptions options;
    options.law = {.limits = haptic::device_preset(a.simulate),
                   .gain = preset.force_gain,
                   .delay = 1e-3 * a.delay_ms,
                   .restore = a.restore};
    options.delay = 1e-3 * a.delay_ms;
    options.jitter = a.delay_ms > 0 ? 5e-4 : 0;
    return options;
}

/// All motions at all places with each brush.
TrialReport try_motions(const DeviceWork& a, const Places& places, Console& console) {
    const std::vector<std::string> brushes = a.all_brushes ? brush::list_presets() : std::vector{a.brush};
    const ProgressFn progress = console.progress();
    TrialReport worst;
    std::size_t done = 0;
    for (const std::string& name : brushes) {
        const brush::Tuft tuft = brush::make_tuft(brush::load_preset(name));
        for (std::size_t p = 0; p < places.place.size(); ++p, ++done) {
            report(progress, "motions",
                   static_cast<double>(done) / static_cast<double>(brushes.size() * places.place.size()));
            for (int motion = 0; motion <= static_cast<int>(haptic::HandMotion::slide); ++motion) {
                check_interrupt();
                const auto path =
                    haptic::hand_path(static_cast<haptic::HandMotion>(motion), places.place[p], tuft.preset);
                merge(worst, run_trial(tuft, *places.surface[p], path, trial_options(a, tuft.preset)));
            }
        }
    }
    return worst;
}

/// Hands of any weight and grip, one second each with a motion of its own.
TrialReport try_hands(const DeviceWork& a, const Places& places, Console& console) {
    const brush::Tuft tuft = brush::make_tuft(brush::load_preset(a.brush));
    const ProgressFn progress = console.progress();
    TrialReport worst;
    for (int hand = 0; hand < a.hands; ++hand) {
        if (hand % 16 == 0) report(progress, "hands", static_cast<double>(hand) / a.hands);
        Random random(static_cast<std::uint64_t>(hand) + 1);
        TrialOptions options = trial_options(a, tuft.preset);
        options.seconds = 2;
        options.hand = {.mass = 0.02 * std::pow(25.0, random.uniform()),  // a finger … an arm
                        .damping = random.uniform(1, 12),
                        .stiffness = 50 * std::pow(20.0, random.uniform())};
        const std::size_t p = random.bits() % places.place.size();
        const auto motion =
            static_cast<haptic::HandMotion>(random.bits() % (static_cast<int>(haptic::HandMotion::slide) + 1));
        merge(worst, run_trial(tuft, *places.surface[p],
                               haptic::hand_path(motion, places.place[p], tuft.preset, random.bits() | 1), options));
        worst.seconds.clear();
    }
    return worst;
}

TrialReport try_hours(const DeviceWork& a, const Places& places, Console& console) {
    const brush::Tuft tuft = brush::make_tuft(brush::load_preset(a.brush));
    const ProgressFn progress = console.progress();
    constexpr double kPart = 60;  // s of one motion
    const int parts = static_cast<int>(std::ceil(a.hours * 3600 / kPart));
    TrialReport worst;
    for (int part = 0; part < parts; ++part) {
        report(progress, "hours", static_cast<double>(part) / parts);
        TrialOptions options = trial_options(a, tuft.preset);
        options.seconds = kPart;
        const std::size_t p = static_cast<std::size_t>(part) % places.place.size();
        const haptic::HandMotion motion =
            haptic::kPaintingMotions[static_cast<std::size_t>(part) / places.place.size() %
                                     std::size(haptic::kPaintingMotions)];
        merge(worst,
              run_trial(tuft, *places.surface[p],
                        haptic::hand_path(motion, places.place[p], tuft.preset, static_cast<std::uint64_t>(part) + 1),
                        options));
        worst.seconds.clear();
    }
    return worst;
}

int slowest_stop(const DeviceWork& a, const Places& places) {
    const brush::Tuft tuft = brush::make_tuft(brush::load_preset(a.brush));
    const auto path = haptic::hand_path(haptic::HandMotion::rest, places.place[0], tuft.preset);
    int slowest = 0;
    for (const haptic::Trouble trouble : haptic::kTroubles) {
        const int periods =
            haptic::periods_to_stop(tuft, *places.surface[0], path, trial_options(a, tuft.preset), trouble, 2.5);
        if (periods < 0) throw Error("the force of the simulated arm does not end");
        slowest = std::max(slowest, periods);
    }
    return slowest;
}

/// The loop by the wall clock; with a real arm in the air, far from the model.
haptic::LoopStatus run_loop(const DeviceWork& a, const Places& places) {
    const brush::Preset preset = brush::load_preset(a.brush);
    const haptic::HandPath path = haptic::hand_path(haptic::HandMotion::circles, places.place[0], preset);
    haptic::DeviceState state;
    const std::unique_ptr<haptic::Device> device = open_device(a, path, state);
    const haptic::LawOptions law{.limits = device->limits(), .gain = preset.force_gain, .restore = a.restore};
    haptic::Loop loop(*device, haptic::HairSolver(brush::make_tuft(preset), *places.surface[0]),
                      {.law = law, .count_allocations = allocations_of_this_thread});
    haptic::ServoControl control;
    if (a.simulate.empty()) {
        const Frame& f = places.place[0].frame;
        control.workspace = workspace_at(state, f.origin + 1.0 * f.n);
    }
    loop.set_control(control);
    loop.start();
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(a.seconds);
    haptic::SolvedPose pose;
    while (std::chrono::steady_clock::now() < end && !interrupted()) {
        while (loop.pop(pose)) {
        }
        std::this_thread::sleep_for(20ms);
    }
    loop.stop();
    check_interrupt();
    return loop.status();
}

double percent(std::uint64_t part, std::uint64_t whole) {
    return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0;
}

double quantile(std::vector<float> values, double q) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    return static_cast<double>(values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))]);
}

}  // namespace

int test_device(const DeviceWork& a) {
    Console console(a.common.quiet);
    const Places places = places_of(a);
    nlohmann::json out;
    if (!a.simulate.empty()) {
        haptic::device_preset(a.simulate);
        TrialReport worst = try_motions(a, places, console);
        const std::vector<float> solves = worst.seconds;
        merge(worst, try_hands(a, places, console));
        merge(worst, try_hours(a, places, console));
        out = {{"least_energy_uj", 1e6 * worst.least_energy},
               {"least_energy_with_arm_uj", 1e6 * worst.least_with_arm},
               {"largest_step_n", worst.largest_step},
               {"largest_step_hard_n", worst.largest_step_hard},
               {"largest_force_n", worst.largest_force},
               {"simulated_s", static_cast<double>(worst.periods) * haptic::kPeriod},
               {"contacts", worst.contacts},
               {"unconverged_percent", percent(worst.unconverged, worst.solves)},
               {"solve_us",
                {{"p50", 1e6 * quantile(solves, 0.5)},
                 {"p999", 1e6 * quantile(solves, 0.999)},
                 {"worst", 1e6 * quantile(solves, 1)}}},
               {"stop_ms", slowest_stop(a, places)}};
    }
    const haptic::LoopStatus loop = run_loop(a, places);
    console.clear();
    out["late_percent"] = percent(loop.cycle.late, loop.cycle.count);
    out["worst_cycle_ms"] = 1e3 * loop.cycle.worst;
    out["p999_cycle_ms"] = 1e3 * loop.cycle.quantile(0.999);
    out["allocations"] = loop.allocations;
    out["late_solves_percent"] = percent(loop.late_solves, loop.solves);
    out["lost_poses"] = loop.lost_poses;
    out["realtime"] = loop.realtime;
    out["memory_locked"] = loop.locked;
    if (!loop.realtime)
        console.note("the system allows no real-time priority: cycles will be late (ulimit -r, or CAP_SYS_NICE)");
    if (a.common.json)
        print_json(out);
    else
        for (const auto& [key, value] : out.items()) fmt::print("{:26}{}\n", key, value.dump());
    return 0;
}

}  // namespace tuft::cli
