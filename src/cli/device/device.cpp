#include "cli/device/device.h"

#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "brush/preset/preset.h"
#include "cli/steps/commands.h"
#include "cli/steps/steps.h"
#include "core/files/files.h"
#include "core/system/interrupt.h"
#include "haptic/device/haply.h"
#include "haptic/followed_path.h"
#include "haptic/loop.h"
#include "io/model/read_model.h"
#include "mesh/repair/repair.h"

namespace tuft::cli {
namespace {

using namespace std::chrono_literals;
using haptic::DeviceLimits;

constexpr auto kStopPatience = 3000ms, kLook = 10ms;

haptic::ServerFault fault_named(const std::string& name) {
    using haptic::ServerFault;
    if (name == "dies") return ServerFault::dies;
    if (name == "nan") return ServerFault::not_a_number;
    if (name == "jumps") return ServerFault::jumps;
    if (name == "silent") return ServerFault::silent;
    return name == "floods" ? ServerFault::floods : ServerFault::none;
}

int list_devices(const DeviceWork& a) {
    haptic::HaplyDevice device(haptic::device_preset(a.arm.preset), {a.arm.host, a.arm.port});
    haptic::DeviceState state;
    bool answers = false;
    for (auto waited = 0ms; waited < 500ms && !answers; waited += kLook) {
        check_interrupt();
        std::this_thread::sleep_for(kLook);
        answers = device.read(state) && device.connected();
    }
    nlohmann::json arms = nlohmann::json::array();
    for (const DeviceLimits& d : haptic::device_presets()) {
        arms.push_back({{"preset", d.name},
                        {"title", d.title},
                        {"max_force_n", d.max_force},
                        {"max_stiffness_n_per_m", d.max_stiffness},
                        {"coupling_n_per_m", d.coupling},
                        {"workspace_mm", {1e3 * d.workspace.x, 1e3 * d.workspace.y, 1e3 * d.workspace.z}}});
    }
    const std::string where = fmt::format("{}:{}", a.arm.host, a.arm.port);
    if (a.common.json) {
        nlohmann::json out{{"presets", arms}, {"service", where}, {"answers", answers}};
        if (answers) out["device_id"] = device.device_id();
        print_json(out);
        return 0;
    }
    for (const DeviceLimits& d : haptic::device_presets())
        fmt::print("{:10}{:26}{:4.1f} N  {:3.1f} N/mm  {:.0f} x {:.0f} x {:.0f} mm\n", d.name, d.title, d.max_force,
                   1e-3 * d.max_stiffness, 1e3 * d.workspace.x, 1e3 * d.workspace.y, 1e3 * d.workspace.z);
    if (answers)
        fmt::print("{}: arm {} at {:.1f}, {:.1f}, {:.1f} mm\n", where, device.device_id(), 1e3 * state.position.x,
                   1e3 * state.position.y, 1e3 * state.position.z);
    else
        fmt::print("{}: no arm answers\n", where);
    return 0;
}

int simulate_device(const DeviceWork& a) {
    const ContactModel model = load_contact_model(a.model);
    const haptic::TrialPlace place = haptic::place_above(*model.surface, "");
    haptic::HandPath path = hand_of(a, motion_named(a.simulation.motion), place, brush_in_hand(a, a.brush));
    haptic::SimulationOptions options{.delay = 1e-3 * a.simulation.delay_ms, .jitter = jitter_of(a)};
    if (a.simulation.hands_off) {
        path = [at = path(0)](double) { return at; };
        options.hand = {.mass = 0, .damping = 0, .stiffness = 0};
    }
    haptic::SimulatedArm arm(haptic::device_preset(a.arm.preset), std::move(path), options);
    haptic::serve_simulated(
        std::move(arm),
        {.port = a.arm.port, .fault = fault_named(a.simulation.fault), .fault_after = a.simulation.fault_after},
        [] { return !interrupted(); },
        [&](int port) {
            fmt::print("{} on 127.0.0.1:{}\n", a.arm.preset, port);
            std::cout.flush();
        });
    return 0;
}

std::vector<haptic::RecordedPeriod> live_recording(const DeviceWork& a, const ContactModel& model,
                                                   const haptic::TrialPlace& place, const haptic::LawOptions& law,
                                                   haptic::Fault& fault) {
    const brush::Preset preset = brush_in_hand(a, a.brush);
    haptic::DeviceState state;
    const haptic::HandPath path = hand_of(a, motion_named(a.simulation.motion), place, preset);
    const std::unique_ptr<haptic::Device> device = open_device(a, path, state);
    haptic::Loop loop(*device, haptic::HairSolver(brush::make_tuft(preset), *model.surface, solver_options(a, preset)),
                      {.law = law, .record = true});
    haptic::ServoControl control;
    const Vec3 above = place.frame.origin + (preset.length + 0.01) * place.frame.n;
    if (a.arm.simulate.empty()) control.workspace = workspace_at(state, above);
    loop.set_control(control);
    fault = run_for(loop, a.seconds);
    return loop.take_recording();
}

/// Of a recording: that of its first period.
haptic::Workspace workspace_of(const std::vector<haptic::RecordedPeriod>& periods, const DeviceWork& a,
                               const Vec3& above) {
    if (!a.arm.simulate.empty()) return {};
    for (const haptic::RecordedPeriod& p : periods)
        if (p.fresh) return workspace_at(p.state, above);
    return {};
}

int record_device(const DeviceWork& a) {
    check_extension(a.output, {".csv"});
    check_output(a.output);
    const ContactModel model = load_contact_model(a.model);
    const haptic::TrialPlace place = haptic::place_above(*model.surface, "");
    const brush::Preset preset = brush_in_hand(a, a.brush);
    const haptic::LawOptions law{
        .limits = haptic::device_preset(a.arm.simulate.empty() ? a.arm.preset : a.arm.simulate),
        .gain = preset.force_gain,
        .restore = a.restore};
    const bool replays = !a.replay.empty();
    haptic::Fault fault = haptic::Fault::none;
    std::vector<haptic::RecordedPeriod> periods =
        replays ? haptic::read_recording(a.replay) : live_recording(a, model, place, law, fault);
    const Vec3 above = place.frame.origin + (preset.length + 0.01) * place.frame.n;
    std::size_t different = 0;
    double greatest = 0;
    if (replays) {
        const std::vector<Vec3> forces =
            haptic::replay_forces(periods, haptic::HairSolver(brush::make_tuft(preset), *model.surface), law,
                                  workspace_of(periods, a, above));
        for (std::size_t i = 0; i < forces.size(); ++i) {
            different += forces[i] != periods[i].force;
            periods[i].force = forces[i];
        }
    }
    for (const haptic::RecordedPeriod& p : periods) greatest = std::max(greatest, glm::length(p.force));
    std::ostringstream table;
    haptic::write_recording(table, periods);
    write_file(a.output, table.str().data(), table.str().size());
    nlohmann::json out{{"wrote", a.output.string()}, {"periods", periods.size()}, {"greatest_force_n", greatest}};
    if (replays) out["different"] = different;
    if (a.common.json)
        print_json(out);
    else
        fmt::print("wrote {}: {} periods, up to {:.2f} N{}\n", a.output.string(), periods.size(), greatest,
                   replays ? fmt::format("; {} other than recorded", different) : "");
    if (fault != haptic::Fault::none) throw Error(haptic::describe(fault));
    return 0;
}

}  // namespace

ContactModel load_contact_model(const std::filesystem::path& file) {
    std::filesystem::path path = file.empty() ? "bowl" : file;
    if (!path.has_extension() && !path.has_parent_path()) path = data_folder() / "models" / (path.string() + ".ply");
    mesh::RepairOptions options;
    mesh::PolygonSoup soup = io::read_model(path);
    options.metres_per_unit = io::metres_per_unit(soup).value_or(kMillimetre);
    ContactModel model;
    model.mesh = std::make_unique<mesh::TriangleMesh>(mesh::build_surface(std::move(soup), options).mesh);
    model.surface = std::make_unique<mesh::SurfaceQuery>(*model.mesh);
    return model;
}

haptic::HandPath hand_of(const DeviceWork& a, haptic::HandMotion motion, const haptic::TrialPlace& place,
                         const brush::Preset& preset) {
    if (!a.simulation.follow.empty()) return haptic::followed_path(haptic::read_followed_path(a.simulation.follow));
    return haptic::hand_path(motion, place, preset);
}

haptic::Fault run_for(haptic::Loop& loop, double seconds) {
    using Clock = std::chrono::steady_clock;
    constexpr auto kPatience = 500ms, kGlitch = 100ms;
    loop.start();
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    auto well = Clock::now();
    haptic::Fault fault = haptic::Fault::none;
    haptic::SolvedPose pose;
    for (auto now = well; now < end && !interrupted(); now = Clock::now()) {
        while (loop.pop(pose)) {
        }
        const haptic::Fault seen = loop.status().fault;
        if (seen == haptic::Fault::none) well = now;
        fault = now - well > kGlitch ? seen : haptic::Fault::none;
        if (now - well > kPatience) break;
        std::this_thread::sleep_for(kLook);
    }
    loop.stop();
    return fault;
}

brush::Preset brush_in_hand(const DeviceWork& a, const std::string& name) {
    brush::Preset preset = brush::load_preset(name);
    if (a.spine == "table") {
        preset.spine = brush::SpineMethod::table;
        brush::check_preset(preset, name);
    }
    return preset;
}

double jitter_of(const DeviceWork& a) {
    return 1e-3 * a.simulation.jitter_ms.value_or(a.simulation.delay_ms > 0 ? 0.5 : 0);
}

haptic::SolverOptions solver_options(const DeviceWork& a, const brush::Preset& preset) {
    haptic::SolverOptions options;
    const double gain = preset.force_gain > 0 ? preset.force_gain : 1;
    options.added = {.proximity = a.added.proximity / gain, .yield_stress = a.added.paste};
    return options;
}

haptic::HandMotion motion_named(const std::string& name) {
    for (int i = 0; i <= static_cast<int>(haptic::HandMotion::slide); ++i)
        if (haptic::name_of(static_cast<haptic::HandMotion>(i)) == name) return static_cast<haptic::HandMotion>(i);
    throw UsageError(Message("unknown motion '{}'", name));
}

std::unique_ptr<haptic::Device> open_device(const DeviceWork& a, const haptic::HandPath& path,
                                            haptic::DeviceState& state) {
    if (!a.arm.simulate.empty())
        return std::make_unique<haptic::SimulatedDevice>(
            haptic::SimulatedArm(haptic::device_preset(a.arm.simulate), path,
                                 {.delay = 1e-3 * a.simulation.delay_ms, .jitter = jitter_of(a)}));
    auto device = std::make_unique<haptic::HaplyDevice>(haptic::device_preset(a.arm.preset),
                                                        haptic::HaplyAddress{a.arm.host, a.arm.port});
    for (auto waited = 0ms; waited < kStopPatience; waited += kLook) {
        check_interrupt();
        if (device->read(state)) return device;
        std::this_thread::sleep_for(kLook);
    }
    throw Error(Message("{}:{}: no arm answers; start its service, or 'tuft device simulate'", a.arm.host, a.arm.port));
}

haptic::Workspace workspace_at(const haptic::DeviceState& state, const Vec3& root) {
    return haptic::Workspace{}.regripped(state.position, root);
}

int run(const DeviceWork& a) {
    if (a.what == "list") return list_devices(a);
    if (a.what == "simulate") return simulate_device(a);
    if (a.what == "record") return record_device(a);
    return test_device(a);
}

}  // namespace tuft::cli
