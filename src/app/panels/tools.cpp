#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/panels/panels.h"
#include "core/files/files.h"
#include "core/text/units.h"

namespace tuft::app {
namespace {

// The curve from a pen's pressure to the brush's depth; its ends and its middle can be dragged. The dot
// is what the pen does now.
void pen_curve(Ui& ui, ToolState& tools, int& handle) {
    PointerSettings& h = tools.pointer;
    const ImVec2 at = ImGui::GetCursorScreenPos(), size(ImGui::GetContentRegionAvail().x, ui.px(96));
    ImGui::InvisibleButton("pen curve", size);
    ui.mark("Pen curve");
    const bool held = ImGui::IsItemActive();
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const float pad = ui.px(8);
    const auto place = [&](double x, double y) {
        return ImVec2(at.x + pad + static_cast<float>(x) * (size.x - 2 * pad),
                      at.y + size.y - pad - static_cast<float>(y) * (size.y - 2 * pad));
    };
    const double x = std::clamp(static_cast<double>((mouse.x - at.x - pad) / (size.x - 2 * pad)), 0.0, 1.0);
    const double y = std::clamp(static_cast<double>((at.y + size.y - pad - mouse.y) / (size.y - 2 * pad)), 0.02, 0.98);
    const double middle = 0.5 * (h.pen_least + h.pen_full);
    if (ImGui::IsItemActivated()) {
        const double to_least = std::abs(x - h.pen_least) + y, to_full = std::abs(x - h.pen_full) + 1 - y;
        const double to_middle = std::abs(x - middle) + std::abs(y - std::pow(0.5, h.pen_gamma));
        handle = to_middle <= std::min(to_least, to_full) ? 1 : to_least < to_full ? 0 : 2;
    }
    if (held && handle == 0) h.pen_least = std::min(x, h.pen_full - 0.1);
    if (held && handle == 2) h.pen_full = std::max(x, h.pen_least + 0.1);
    if (held && handle == 1) h.pen_gamma = std::clamp(std::log(y) / std::log(0.5), 0.25, 4.0);
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0)) h.pen_least = 0, h.pen_full = 1, h.pen_gamma = 1;
    ui.hint("Drag its ends and its middle; a double click makes it straight");
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled(at, ImVec2(at.x + size.x, at.y + size.y), ImGui::GetColorU32(ImGuiCol_FrameBg), ui.px(4));
    for (int i = 1; i < 4; ++i) {
        draw->AddLine(place(0.25 * i, 0), place(0.25 * i, 1), ImGui::GetColorU32(ImGuiCol_Separator));
        draw->AddLine(place(0, 0.25 * i), place(1, 0.25 * i), ImGui::GetColorU32(ImGuiCol_Separator));
    }
    ImVec2 points[49];
    for (int i = 0; i < 49; ++i) points[i] = place(i / 48.0, pen_depth(h, i / 48.0));
    draw->AddPolyline(points, 49, ui.accent, 0, ui.px(2));
    for (const ImVec2& p : {place(h.pen_least, 0), place(middle, std::pow(0.5, h.pen_gamma)), place(h.pen_full, 1)})
        draw->AddCircleFilled(p, ui.px(4.5f), ui.strong);
    if (tools.pen_pressure >= 0) {
        const ImVec2 dot = place(std::min(1.0, tools.pen_pressure), pen_depth(h, tools.pen_pressure));
        draw->AddLine(dot, place(std::min(1.0, tools.pen_pressure), 0), IM_COL32(255, 176, 32, 160), ui.px(1));
        draw->AddCircleFilled(dot, ui.px(5), IM_COL32(255, 176, 32, 255));
    }
}

// How a wide ferrule is turned about the holder's axis.
void roll_controls(Ui& ui, PointerSettings& pointer) {
    ui.slider("Roll", pointer.roll, {-180 * kDegree, 180 * kDegree, "%.0f\xc2\xb0", kDegree},
              "Of the holder about itself: at 0 the broad side lies across the screen. Alt and wheel, Shift and arrow "
              "keys; a pen that can turn adds its own");
    ui.toggle("Follow the stroke", pointer.roll_follow, "The broad side turns across the stroke as it goes on");
}

// The roll of a wide ferrule, the pen's force, and how the holder leans.
void pointer_section(Ui& ui, ToolState& tools, PanelLayout& panels, bool wide) {
    if (wide) roll_controls(ui, tools.pointer);
    if (!ui.section("Pen and holder", false)) return;
    double right = tools.pointer.tilt.x, up = tools.pointer.tilt.y;
    ui.slider("Lean sideways", right, {-60 * kDegree, 60 * kDegree, "%.0f\xc2\xb0", kDegree},
              "Of the holder, seen on the screen. Arrow keys");
    ui.slider("Lean away", up, {-60 * kDegree, 60 * kDegree, "%.0f\xc2\xb0", kDegree},
              "Of the holder, seen on the screen. Arrow keys");
    tools.pointer.tilt = {right, up};
    ui.note(ui.tr("Pen: from its force to the brush's depth"));
    pen_curve(ui, tools, panels.pen_curve_handle);
}

void symmetry_section(Ui& ui, stroke::Symmetry& symmetry) {
    if (!ui.section("Symmetry", false)) return;
    ui.toggle("X", symmetry.mirror_x,
              "Mirror left and right; the copy is painted anew and meets the model as it is there");
    ImGui::SameLine();
    ui.toggle("Y", symmetry.mirror_y, "Mirror front and back");
    ImGui::SameLine();
    ui.toggle("Z", symmetry.mirror_z, "Mirror above and below");
    double n = symmetry.radial;
    if (ui.slider("Radial copies", n, {1, 16, "%.0f"},
                  "For plates and bowls; the axis stands upright through the middle"))
        symmetry.radial = static_cast<int>(std::lround(n));
}

void section_section(Ui& ui, SectionView& section) {
    if (!ui.section("Look inside", false)) return;
    ui.toggle("Cut open", section.on, "Hides a part of the model; the brush reaches what is behind");
    if (!section.on) return;
    static const char* axes[] = {"Across", "Along", "From above"};
    for (int k = 0; k < 3; ++k) {
        if (k) ImGui::SameLine();
        if (ui.choice(axes[k], section.axis == k)) section.axis = k;
    }
    ui.slider("What stays", section.position, {0.02, 1, "%.2f"});
}

}  // namespace

// The place in millimetres: of the drawing at the cursor, until one is typed.
void place_fields(Ui& ui, ToolState& tools) {
    const float gap = ImGui::GetStyle().ItemSpacing.x, width = (ImGui::GetContentRegionAvail().x - 2 * gap) / 3;
    static constexpr const char* kNames[] = {"Place x", "Place y", "Place z"};
    for (std::size_t k = 0; k < 3; ++k) {
        if (k > 0) ImGui::SameLine();
        ImGui::SetNextItemWidth(width);
        ImGui::InputDouble((std::string("##") + kNames[k]).c_str(), &tools.place.millimetres[k], 0, 0, "%.1f");
        ui.mark(kNames[k]);
        ui.hint("Place of its middle, millimetres");
    }
    if (ui.button("Place it there", "At the place in the fields, with width and turn as they are", 0))
        tools.place.is_typed = true;
}

namespace {

// Once, or in copies along a line of the model.
void band_choice(Ui& ui, Writing& w, float width) {
    static const std::vector<std::string> names{"Once", "Edge", "Round", "Curve"};  // as `BandLine`
    std::string chosen = names[static_cast<std::size_t>(w.along)];
    if (ui.combo("Lay along", chosen, names, width))
        w.along = static_cast<BandLine>(std::ranges::find(names, chosen) - names.begin());
    ui.hint(
        "One drawing at the cursor, or copies: along the shut line, edge or crease beside the cursor, round the model "
        "at its height, or along the curve whose points were set last with the tool Curve");
}

void writing_section(Ui& ui, ToolState& tools, FileDialog& files) {
    if (tools.active != Tool::writing) return;
    Writing& w = tools.writing;
    const ImGuiStyle& style = ImGui::GetStyle();
    // How it is laid and "In mm" beside the file: no row is left for them.
    constexpr float kBand = 68, kInMm = 46;
    const float beside = w.empty() ? 0 : 2 * style.ItemSpacing.x + ui.px(kBand + kInMm);
    const float all = ImGui::GetContentRegionAvail().x - beside, inside = all - 2 * style.FramePadding.x;
    // The button is named by what is in hand.
    const std::string name = w.file.filename().string();
    const std::string title = w.empty() ? ui.tr("Writing or drawing...") : ui.fitted(name, inside);
    if (ImGui::Button((title + "##writing").c_str(), ImVec2(all, 0)))
        files.show(FileDialog::Purpose::writing, data_folder() / "samples" / "strokes");
    ui.mark("Writing or drawing...");
    ui.hint(w.empty() ? "InkML or SVG" : "Another one, InkML or SVG");
    if (w.empty()) return;
    ImGui::SameLine();
    band_choice(ui, w, kBand);
    ImGui::SameLine();
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(ui.px(2), style.FramePadding.y));
    if (ui.choice("In mm", tools.place.has_fields, "Place in millimetres", kInMm))
        tools.place.has_fields = !tools.place.has_fields;
    ImGui::PopStyleVar();
    for (const Message& note : w.form().notes) ui.note(ui.sentence(note));
    ui.toggle("Mirrored", w.mirrored);
    ImGui::SameLine();
    ui.toggle("Snap", tools.place.snaps,
              "To the plane of symmetry and level with other drawings; Ctrl places it freely");
    if (tools.place.has_fields) place_fields(ui, tools);
    const bool names =
        std::ranges::any_of(w.lines.traces, [](const auto& t) { return !t.brush.empty() || !t.ink.empty(); });
    if (!w.areas.traces.empty() && !w.lines.traces.empty())
        ui.toggle("Its colours", w.own_ink,
                  "Each shape masked and filled; off: in the chosen ink, by lines of a brush");
    else if (names)
        ui.toggle("Its brush and ink", w.own_ink, "As the file names them; strokes scale with the drawing");
    if (has_widths(w)) ui.toggle("Its line widths", w.own_width, "The brush is taken in the size that draws them");
}

}  // namespace

void begin_side_panel(Ui& ui, const char* name, const SidePanel& panel) {
    const auto& [left, top, bottom, width, scrolls] = panel;
    const float pad = ImGui::GetStyle().WindowPadding.x, all = ui.px(width);
    ImGui::SetNextWindowPos(ImVec2(left, top));
    ImGui::SetNextWindowSize(ImVec2(all, bottom - top));
    ImGui::SetNextWindowContentSize(
        ImVec2(all - pad - std::max(pad, scrolls ? ImGui::GetStyle().ScrollbarSize + ui.px(6) : 0), 0));
    // The window is cleared to the panels' colour; to blend it over that again costs a software driver milliseconds.
    ImGui::Begin(name, nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | (scrolls ? 0 : ImGuiWindowFlags_NoScrollbar));
    ImGui::GetBackgroundDrawList()->AddRect(ImVec2(left, top), ImVec2(left + all, bottom),
                                            ImGui::GetColorU32(ImGuiCol_Border));
}

void tool_panel(Session& s, float top, float bottom, float left) {
    begin_side_panel(s.ui, "###tools", {left, top, bottom});
    const ToolDensity room = s.panels.tool_room;
    Savings saves;
    const auto add = [&saves](const Savings& more) { saves.compact += more.compact, saves.tight += more.tight; };
    writing_section(s.ui, s.tools, s.dialogs.file);
    mask_section(s);
    const bool brushes = s.tools.active != Tool::fill && s.tools.active != Tool::pick && s.tools.active != Tool::mask;
    if (brushes) add(brush_rack(s, room));
    if (s.tools.active != Tool::mask && s.tools.active != Tool::eraser)
        add(ink_section({s.ui, s.brush, s.colours, *s.paint_thread, s.reported, s.dialogs.file}, room));
    if (brushes) pointer_section(s.ui, s.tools, s.panels, brush_can_be_turned(s.brush));
    if (brushes) symmetry_section(s.ui, s.tools.symmetry);
    section_section(s.ui, s.view.section);
    const float height = ImGui::GetCursorPosY() + ImGui::GetStyle().WindowPadding.y, there = bottom - top;
    const float full = height + (room == ToolDensity::compact ? saves.compact
                                 : room == ToolDensity::tight ? saves.tight
                                                              : 0);
    s.panels.tool_room = full <= there                   ? ToolDensity::full
                         : full - saves.compact <= there ? ToolDensity::compact
                                                         : ToolDensity::tight;
    ImGui::End();
}

namespace {

// A narrow button in the middle of an edge of the view, with a triangle that points to where the panel goes or comes
// from.
void handle(Session& s, const char* name, const char* hint, float x, bool to_left, bool& shown) {
    Ui& ui = s.ui;
    const float width = ui.px(11), height = ui.px(46),
                y = static_cast<float>(s.view.area.y) + 0.5f * (static_cast<float>(s.view.area.height) - height);
    ImGui::SetNextWindowPos(ImVec2(x, y));
    ImGui::SetNextWindowSize(ImVec2(width, height));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, ui.px(3));
    ImGui::SetNextWindowBgAlpha(0.75f);
    ImGui::Begin((std::string("###handle ") + name).c_str(), nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoBringToFrontOnFocus);
    const bool pressed = ImGui::InvisibleButton("##handle", ImVec2(width, height));
    ui.mark(name);
    ui.hint(hint);
    const ImVec2 c(x + 0.5f * width, y + 0.5f * height);
    const float r = ui.px(3.5f), tip = to_left ? -r : r;
    ImGui::GetWindowDrawList()->AddTriangleFilled(ImVec2(c.x + tip, c.y), ImVec2(c.x - tip, c.y - 1.3f * r),
                                                  ImVec2(c.x - tip, c.y + 1.3f * r),
                                                  ImGui::IsItemHovered() ? ui.strong : ui.faint);
    ImGui::End();
    ImGui::PopStyleVar(4);
    if (!pressed) return;
    shown = !shown;
    store_settings(s);
}

}  // namespace

void panel_handles(Session& s) {
    const bool beside =
        !s.journal.snapshots.compared.empty() && !s.journal.snapshots.swipe && s.journal.snapshots.width > 0;
    const auto left = static_cast<float>(beside ? s.journal.snapshots.x : s.view.area.x);
    const auto right = static_cast<float>(s.view.atlas.shown ? s.view.atlas.area.x + s.view.atlas.area.width
                                                             : s.view.area.x + s.view.area.width) -
                       s.ui.px(11);
    const bool swapped = s.preferences.ui.left_handed;
    handle(s, "Fold the tools", "Puts the settings of the tools away, or brings them back (Tab: all panels)",
           swapped ? right : left, s.panels.show_tools != swapped, s.panels.show_tools);
    if (s.panels.journal_fits)
        handle(s, "Fold the journal", "Puts the journal away, or brings it back (Tab: all panels)",
               swapped ? left : right, s.panels.show_journal == swapped, s.panels.show_journal);
}

}  // namespace tuft::app
