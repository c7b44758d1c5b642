#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "app/panels/panels.h"
#include "brush/preset/preset.h"

/// \file
/// The panel of the force-feedback arm, and its reach in the view.
namespace tuft::app {
namespace {

constexpr float kArmWidth = 292;  // pixels at a scale of 1
constexpr unsigned kGood = IM_COL32(96, 176, 92, 255), kWaits = IM_COL32(222, 160, 52, 255),
                   kBad = IM_COL32(214, 72, 56, 255);

struct StateText {
    std::string text;
    unsigned colour = 0;
};

StateText state_of(const Session& s) {
    const ArmState& a = s.arm;
    const Ui& ui = s.ui;
    if (!a.arm) return {ui.tr("No arm is connected"), ui.faint};
    const haptic::LoopStatus& now = a.arm->status();
    if (a.emergency) return {ui.tr("Stopped: no force until it is released"), kBad};
    if (!a.arm->feels()) return {ui.tr("Waiting for the arm"), kWaits};
    if (a.paused || !a.focused) return {ui.tr("Paused: no force"), kWaits};
    if (a.clutched) return {ui.tr("The arm moves without the brush"), kWaits};
    if (now.fault != haptic::Fault::none && now.fault != haptic::Fault::paused)
        return {ui.sentence(haptic::describe(now.fault)), kBad};
    if (!now.engaged) return {ui.tr("Waiting for the arm"), kWaits};
    if (now.pass < 1) return {ui.tr("The force comes in"), kWaits};
    if (a.in_stroke()) return {ui.tr("Painting"), kGood};
    return {ui.tr(now.hard ? "The ferrule is on the surface" : "Ready to paint"), kGood};
}

void state_line(Session& s) {
    const StateText state = state_of(s);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float line = ImGui::GetTextLineHeight();
    ImGui::GetWindowDrawList()->AddCircleFilled(ImVec2(at.x + s.ui.px(6), at.y + 0.5f * line), s.ui.px(5), state.colour,
                                                20);
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + s.ui.px(18));
    s.ui.wrapped(state.text);
}

struct Named {
    const char *name, *word;
};
constexpr Named kHands[] = {
    {"The pointer", "pointer"}, {"Press", "press"},     {"Drag", "drag"}, {"Circles", "circles"},
    {"Taps", "taps"},           {"Rocking", "rocking"}, {"Rest", "rest"}};
constexpr const char* kSources[] = {"Simulated", "Service", "Recording"};

void choose_preset(Ui& ui, ArmSettings& a) {
    std::vector<std::string> titles;
    std::string title;
    for (const haptic::DeviceLimits& preset : haptic::device_presets()) {
        titles.emplace_back(preset.title);
        if (preset.name == a.preset) title = preset.title;
    }
    if (!ui.combo("Make", title, titles)) return;
    for (const haptic::DeviceLimits& preset : haptic::device_presets())
        if (preset.title == title) a.preset = preset.name;
}

void choose_source(Session& s, float width) {
    ArmSettings& a = s.arm.settings;
    static const std::vector<std::string> names(std::begin(kSources), std::end(kSources));
    std::string name = kSources[static_cast<std::size_t>(a.source)];
    if (s.ui.combo("Source", name, names, width))
        a.source = static_cast<ArmSource>(std::find(names.begin(), names.end(), name) - names.begin());
    s.ui.hint("A simulated arm in a simulated hand, the service of a real one, or what an arm did before");
}

void choose_hand(Session& s) {
    ArmSettings& a = s.arm.settings;
    std::vector<std::string> names;
    std::string name;
    for (const Named& hand : kHands) {
        names.emplace_back(hand.name);
        if (a.hand == hand.word) name = hand.name;
    }
    if (s.ui.combo("Hand", name, names))
        for (const Named& hand : kHands)
            if (name == hand.name) a.hand = hand.word;
    s.ui.hint("What the simulated hand does: it follows the pointer, or moves by itself in the middle of the view");
}

void choose_address(Session& s) {
    ArmSettings& a = s.arm.settings;
    char text[128];
    std::snprintf(text, sizeof text, "%s:%d", a.host.c_str(), a.port);
    ImGui::SetNextItemWidth(-1);
    if (ImGui::InputText("##address", text, sizeof text)) {
        const std::string address = text;
        const std::size_t colon = address.rfind(':');
        a.host = address.substr(0, colon);
        if (colon != std::string::npos) a.port = std::clamp(std::atoi(address.c_str() + colon + 1), 0, 65535);
    }
    s.ui.mark("Address");
    s.ui.hint("Address and port of the service that speaks with the arm");
}

void choose_recording(Session& s) {
    ArmSettings& a = s.arm.settings;
    if (s.ui.button("Recording...", "A table that 'tuft device record' wrote", 110))
        s.dialogs.file.show(FileDialog::Purpose::arm_recording, a.recording);
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", s.ui.fitted(a.recording.filename().string(), ImGui::GetContentRegionAvail().x).c_str());
}

// What can be chosen while no arm is connected.
void choose_device(Session& s) {
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    choose_source(s, 0.42f * (ImGui::GetContentRegionAvail().x - gap) / s.ui.settings().scale);
    ImGui::SameLine();
    choose_preset(s.ui, s.arm.settings);
    switch (s.arm.settings.source) {
        case ArmSource::simulated:
            return choose_hand(s);
        case ArmSource::service:
            return choose_address(s);
        case ArmSource::recording:
            return choose_recording(s);
    }
}

void connect_buttons(Session& s) {
    ArmState& a = s.arm;
    const float half =
        0.5f * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / s.ui.settings().scale;
    if (!a.arm) {
        if (s.ui.primary_button("Connect", half)) connect_arm(a, s.status);
        ImGui::SameLine();
        s.ui.button("Stop", nullptr, half, false);
        return;
    }
    if (s.ui.button("Disconnect", "Ends the stroke in work; no force leaves any more", half))
        return disconnect_arm(a, s.paint_thread.get());
    ImGui::SameLine();
    if (a.emergency) {
        if (s.ui.button("Release", "The force comes back within half a second, where the arm is then", half))
            release_forces(a);
        return;
    }
    ImGui::PushStyleColor(ImGuiCol_Button, kBad);
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, IM_COL32(228, 92, 74, 255));
    ImGui::PushStyleColor(ImGuiCol_Text, IM_COL32(255, 255, 255, 255));
    const bool stop = s.ui.button("Stop", nullptr, half);
    ImGui::PopStyleColor(3);
    const std::string key = name_of(s.preferences.keys.chord(Action::stop_arm));
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s", s.ui.sentence(Message("No force at once (key: {})", key)).c_str());
    if (stop) stop_forces(a);
}

struct Plot {
    ImVec2 at, size;
    ImDrawList* draw = nullptr;
};

Plot begin_plot(Ui& ui, float height) {
    const Plot plot{
        ImGui::GetCursorScreenPos(), {ImGui::GetContentRegionAvail().x, ui.px(height)}, ImGui::GetWindowDrawList()};
    plot.draw->AddRectFilled(plot.at, ImVec2(plot.at.x + plot.size.x, plot.at.y + plot.size.y),
                             ImGui::GetColorU32(ImGuiCol_FrameBg), ui.px(4));
    ImGui::Dummy(plot.size);
    return plot;
}

// The force of the last 3 s, at most the arm's own or the limit.
void force_plot(Session& s) {
    Ui& ui = s.ui;
    const ArmState& a = s.arm;
    const std::vector<float> forces = a.arm ? a.arm->recent_forces() : std::vector<float>{};
    float most = 0;
    for (const float f : forces) most = std::max(most, f);
    const Plot plot = begin_plot(ui, 64);
    const float top = std::max(0.5f, 1.15f * most);
    constexpr std::size_t kAll = 3000;  // periods of the plot
    std::vector<ImVec2> line;
    const auto columns = static_cast<std::size_t>(plot.size.x);
    // The most of each column: a blow of one millisecond is seen.
    for (std::size_t c = 0; c < columns; ++c) {
        const std::size_t end = (c + 1) * kAll / columns, begin = c * kAll / columns, missing = kAll - forces.size();
        float high = -1;
        for (std::size_t i = std::max(begin, missing); i < end; ++i) high = std::max(high, forces[i - missing]);
        if (high >= 0)
            line.emplace_back(plot.at.x + static_cast<float>(c),
                              plot.at.y + plot.size.y - 2 - high / top * (plot.size.y - 4));
    }
    plot.draw->AddPolyline(line.data(), static_cast<int>(line.size()), ui.accent, 0, ui.px(1.4f));
    ui.mark("Force plot");
    const double now = a.arm ? glm::length(a.arm->status().force) : 0;
    char text[96];
    std::snprintf(text, sizeof text, ui.tr("%.2f N now, %.2f N in the last 3 s"), now, static_cast<double>(most));
    ui.note(text);
}

// How long after its time each force left, counts by their logarithm; 1 ms, where a period is late, is marked.
void lateness_plot(Session& s) {
    Ui& ui = s.ui;
    const haptic::LoopStatus now = s.arm.arm ? s.arm.arm->status() : haptic::LoopStatus{};
    const haptic::LatenessHistogram& cycle = now.counts.cycle;
    constexpr std::size_t kShown = 30;  // bins, 3 ms
    const Plot plot = begin_plot(ui, 44);
    std::uint64_t most = 1;
    for (const std::uint64_t n : cycle.bins) most = std::max(most, n);
    const float width = plot.size.x / kShown;
    for (std::size_t i = 0; i < kShown; ++i) {
        std::uint64_t n = cycle.bins[i];
        for (std::size_t j = kShown; i + 1 == kShown && j < cycle.bins.size(); ++j) n += cycle.bins[j];
        if (n == 0) continue;
        const double part = std::log1p(static_cast<double>(n)) / std::log1p(static_cast<double>(most));
        const float x = plot.at.x + width * static_cast<float>(i), bottom = plot.at.y + plot.size.y - 2;
        plot.draw->AddRectFilled(ImVec2(x + 1, bottom - static_cast<float>(part) * (plot.size.y - 6)),
                                 ImVec2(x + width - 1, bottom), i < 10 ? ui.accent : kBad);
    }
    const float x = plot.at.x + 10 * width;
    plot.draw->AddLine(ImVec2(x, plot.at.y), ImVec2(x, plot.at.y + plot.size.y), kWaits, ui.px(1));
    ui.mark("Lateness plot");
    ui.hint("How long after its time each force left, from 0 to 3 ms; right of the line it was late");
    char text[128];
    const double late =
        cycle.count > 0 ? 100.0 * static_cast<double>(cycle.late) / static_cast<double>(cycle.count) : 0;
    std::snprintf(text, sizeof text, ui.tr("%.0f Hz, %.2f %% late, worst %.1f ms"), s.arm.rate, late,
                  1e3 * cycle.worst);
    ui.note(text);
    if (now.running && !now.realtime) ui.note(ui.tr("No real-time priority: the force may be rough (ulimit -r)"));
}

void force_section(Session& s) {
    Ui& ui = s.ui;
    ArmSettings& a = s.arm.settings;
    if (!ui.section("Force", true)) return;
    const double own = s.brush.shelf.at(brush::sized_name(s.brush.preset).base).preset.force_gain;
    double gain = a.gain > 0 ? a.gain : own;
    bool changed = false;
    if (ui.slider("Gain", gain, {1, kMostArmGain, "%.0f\xc3\x97"}, "Force on the hand over the force of the hair"))
        a.gain = gain, changed = true;
    changed |= ui.slider("Limit", a.most_force, {0.5, haptic::kForceLimit, "%.1f N"},
                         "The hand feels no more than this, nor more than the arm can give");
    changed |= ui.slider("Proximity", a.proximity, {0, kMostArmProximity, "%.2f N"},
                         "Felt over the last millimetre before the hair touches; 0: not at all");
    changed |= ui.toggle("Firm at rest", a.restore,
                         "A hand at rest feels the whole force, not softened by the coupling; the arm's friction pays");
    if (changed) store_settings(s);
}

void space_section(Session& s) {
    Ui& ui = s.ui;
    ArmState& a = s.arm;
    if (!ui.section("Space", true)) return;
    bool changed = ui.slider("Scale", a.settings.scale, {kLeastArmScale, kMostArmScale, "%.2f"},
                             "Millimetres of the brush for each millimetre of the arm");
    changed |= ui.toggle("Turn with the view", a.settings.with_view,
                         "Right of the arm is right in the view, and the model turns under the brush; else its axes "
                         "are the model's");
    ui.toggle("Clutch", a.clutched,
              "The arm moves without the brush, to grip it elsewhere; the grip's first button does so too");
    ImGui::SameLine();
    ui.toggle("Pause", a.paused, "No force, and the brush waits");
    if (s.colours.palette.shown) {
        ImGui::SameLine();
        ui.toggle("On the palette", a.on_palette, "The brush stirs on the palette, not on the model");
    }
    const bool felt = a.arm && a.arm->feels();
    const float half =
        0.5f * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / ui.settings().scale;
    if (ui.button("Middle here", "Calibrates: where the arm is now is the middle of its reach", half, felt))
        a.settings.centre = a.arm->status().device, changed = true;
    ImGui::SameLine();
    if (ui.button("Upright now", "Calibrates: as the grip is now, the brush is upright on the surface", half, felt)) {
        a.arm->set_upright();
        a.regrips_until = kRegripsSoon;
    }
    if (changed) store_settings(s);
}

}  // namespace

void arm_panel(Session& s) {
    if (!s.arm.shown || !s.paint_thread) return;
    Ui& ui = s.ui;
    begin_panel_over(ui, s.view.area, {.name = "arm", .across = 1, .width = ui.px(kArmWidth)});
    ui.heading("Force-feedback arm");
    state_line(s);
    if (!s.arm.arm) choose_device(s);
    connect_buttons(s);
    if (s.arm.arm) {
        force_plot(s);
        lateness_plot(s);
    }
    force_section(s);
    space_section(s);
    if (ui.button("Close the arm's panel", nullptr, 0)) s.arm.shown = false;
    ImGui::End();
}

void arm_marks(const Session& s, const render::GlCamera& camera) {
    const ArmState& a = s.arm;
    if (!a.arm || !a.arm->feels() || a.on_palette || a.arm->status().counts.periods == 0) return;
    const std::array<Vec3, 8> corners = a.arm->reach();
    const unsigned colour = a.arm->at_limit() ? kBad : IM_COL32(255, 176, 32, 110);
    ImDrawList* draw = ImGui::GetBackgroundDrawList();
    const ImVec2 from(static_cast<float>(s.view.area.x), static_cast<float>(s.view.area.y));
    draw->PushClipRect(
        from, ImVec2(from.x + static_cast<float>(s.view.area.width), from.y + static_cast<float>(s.view.area.height)),
        true);
    const auto behind = [&](const Vec3& p) {
        return camera.parallel_height <= 0 && glm::dot(p - camera.eye, camera.forward) < camera.near;
    };
    for (std::size_t i = 0; i < corners.size(); ++i)
        for (const std::size_t bit : {1, 2, 4}) {
            if (i & bit || behind(corners[i]) || behind(corners[i | bit])) continue;
            const Vec3 p = render::picture_point(camera, corners[i]),
                       q = render::picture_point(camera, corners[i | bit]);
            draw->AddLine(ImVec2(static_cast<float>(p.x) + from.x, static_cast<float>(p.y) + from.y),
                          ImVec2(static_cast<float>(q.x) + from.x, static_cast<float>(q.y) + from.y), colour,
                          s.ui.px(1.2f));
        }
    draw->PopClipRect();
}

}  // namespace tuft::app
