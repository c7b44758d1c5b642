#include <imgui.h>

#include <cmath>
#include <iterator>

#include "app/panels/panels.h"

/// The guided first minute: what to do first, a step at a time. A step is over when it was done.
namespace tuft::app {
namespace {

struct Step {
    const char *title, *text, *maya_text;
    bool (*done)(const Session& s);
};

bool turned(const Session& s) {
    const Orbit& o = s.view.orbit;
    return std::abs(o.azimuth - s.panels.help.azimuth) + std::abs(o.elevation - s.panels.help.elevation) >
           0.15;  // radians
}
bool nearer(const Session& s) {
    return std::abs(s.view.orbit.distance / s.panels.help.distance - 1) > 0.05;
}
bool another_brush(const Session& s) {
    return s.brush.preset != s.panels.help.brush;
}
bool painted(const Session& s) {
    return s.journal.lines.size() > s.panels.help.strokes;
}
bool taken_back(const Session& s) {
    return s.reported.document.can_redo && s.journal.lines.size() < s.panels.help.strokes;
}
bool named(const Session& s) {
    return !s.reported.file.project.empty() && !is_unnamed(s.reported.file.project);
}

constexpr Step kSteps[] = {
    {"Turn the model", "Drag with the middle or the right mouse button.",
     "Hold Alt and drag with the left mouse button.", turned},
    {"Come nearer", "Turn the mouse wheel over the model.", nullptr, nearer},
    {"Choose a brush", "Click another brush on the rack. \"Tuft size\" over the model makes it larger or smaller.",
     nullptr, another_brush},
    {"Paint", "Drag over the model with the left mouse button. The brush bends where it touches.", nullptr, painted},
    {"Take it back", "Press Ctrl and Z, or the Undo button. Redo brings it again.", nullptr, taken_back},
    {"Give it a name", "Press Ctrl and S. Every stroke is on disk already; now you decide where.", nullptr, named},
};
constexpr int kCount = static_cast<int>(std::size(kSteps));

void go_to_step(Session& s, int step) {
    HelpState& h = s.panels.help;
    h.step = step < kCount ? step : -1;
    h.fresh = true;
    if (h.step >= 0) return;
    h.seen = true;
    store_settings(s);
}

}  // namespace

void start_guide(Session& s) {
    go_to_step(s, 0);
}

void guide(Session& s) {
    HelpState& h = s.panels.help;
    if (h.step < 0 || h.step >= kCount || !s.paint_thread) return;
    const Step& step = kSteps[h.step];
    if (h.fresh) {
        h.fresh = false;
        h.azimuth = s.view.orbit.azimuth;
        h.elevation = s.view.orbit.elevation;
        h.distance = s.view.orbit.distance;
        h.strokes = s.journal.lines.size();
        h.brush = s.brush.preset;
    }
    if (!s.tools.pointer_down && step.done(s)) return go_to_step(s, h.step + 1);
    Ui& ui = s.ui;
    begin_panel_over(ui, s.view.area, {.name = "guide", .across = 0.5f, .width = ui.px(400)});
    char count[16];
    std::snprintf(count, sizeof count, "%d / %d", h.step + 1, kCount);
    ImGui::PushFont(ui.large);
    // The large font has Latin letters only.
    if (ui.settings().language == Language::english) ImGui::TextUnformatted(step.title);
    ImGui::PopFont();
    if (ui.settings().language != Language::english) ImGui::TextUnformatted(ui.tr(step.title));
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(count).x);
    ImGui::TextDisabled("%s", count);
    ui.wrapped(ui.tr(s.preferences.keymap == Keymap::maya && step.maya_text ? step.maya_text : step.text));
    const bool skip = ui.button("Skip the guide", "It is in the Help menu", 0);
    ImGui::SameLine();
    const bool last = h.step + 1 == kCount;
    const char* on = last ? "Done" : "Next";
    ui.buttons_at_right({{on, 90}});
    const bool next = ui.button(on, nullptr, 90);
    ImGui::End();
    if (skip)
        go_to_step(s, kCount);
    else if (next)
        go_to_step(s, h.step + 1);
}

}  // namespace tuft::app
