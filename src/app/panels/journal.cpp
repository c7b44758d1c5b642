#include <imgui.h>

#include <algorithm>

#include "app/panels/panels.h"

namespace tuft::app {
namespace {

void draw_way(const Session& s, const StrokeLine& line, ImVec2 at, float size) {
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const ImVec2 middle(at.x + 0.5f * size, at.y + 0.5f * size);
    if (line.action != stroke::Action::stroke) {
        const bool inked = line.action == stroke::Action::dip || line.action == stroke::Action::fill;
        if (inked) draw->AddCircleFilled(middle, 0.24f * size, ink_colour(s, line.ink), 32);
        draw->AddCircle(middle, 0.24f * size, s.ui.faint, 32);
        return;
    }
    draw->AddRectFilled(at, ImVec2(at.x + size, at.y + size), IM_COL32(238, 236, 230, line.hidden ? 70 : 255), 3);
    draw->AddRect(at, ImVec2(at.x + size, at.y + size), IM_COL32(128, 128, 128, 110), 3);
    const float pad = 0.16f * size, inner = size - 2 * pad;
    const unsigned colour = (ink_colour(s, line.ink) & 0x00ffffffu) | (line.hidden ? 0x60000000u : 0xff000000u);
    if (line.length < 1e-3) draw->AddCircleFilled(middle, 0.07f * size, colour, 16);  // a touch, no way
    else for (std::size_t i = 1; i < line.way.size(); ++i) {
        const Vec3f &a = line.way[i - 1], &b = line.way[i];
        const ImVec2 to(at.x + pad + b.x * inner, at.y + pad + b.y * inner);
        const float width = 1.0f + 0.055f * size * (a.z + b.z);
        draw->AddLine(ImVec2(at.x + pad + a.x * inner, at.y + pad + a.y * inner), to, colour, width);
        if (!line.hidden) draw->AddCircleFilled(to, 0.5f * width, colour, 8);  // no notch at the bend
    }
}

void edit_row(Session& s, const StrokeLine& line) {
    Ui& ui = s.ui;
    const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2 / ui.settings().scale;
    if (ui.button(line.hidden ? "Show" : "Hide", line.hidden ? "Paints it again in its place" : "The other strokes are painted again without it", half))
        s.painter->post(EditStroke{.id = line.id, .hidden = !line.hidden});
    ImGui::SameLine();
    if (ui.button("Delete", "Takes the stroke away and paints the others again", half))
        s.painter->post(EditStroke{.id = line.id, .remove = true});
    if (line.action != stroke::Action::stroke) return;
    if (!line.on_palette && ui.choice("Move", s.shift_stroke, "Then drag it over the model with the left button", 2 * half + 8)) s.shift_stroke = !s.shift_stroke;
    std::string brush = line.brush, ink = line.ink;
    if (ui.combo("Change brush", brush, s.brushes)) s.painter->post(EditStroke{.id = line.id, .brush = brush});
    std::vector<std::string> inks = s.inks;
    for (const ink::Ink& own : s.own_inks) inks.push_back(own.name);
    if (ui.combo("Change ink", ink, inks)) s.painter->post(EditStroke{.id = line.id, .ink = ink});
}

void stroke_row(Session& s, const StrokeLine& line, std::size_t number) {
    const float size = s.ui.px(42);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::PushID(static_cast<int>(line.id));
    const bool chosen = s.selected == line.id;
    if (ImGui::Selectable("##row", chosen, 0, ImVec2(0, size))) {
        s.selected = chosen ? 0 : line.id;
        s.shift_stroke = false;
    }
    s.ui.mark("stroke " + std::to_string(number));
    draw_way(s, line, ImVec2(at.x, at.y), size);
    char text[96];
    static const char* actions[] = {"", "Dip", "Rinse", "Comb", "Dry", "Layer", "Mask", "Fill", "Wipe", "Wash"};
    if (line.action != stroke::Action::stroke) std::snprintf(text, sizeof text, "%zu   %s", number, s.ui.tr(actions[static_cast<int>(line.action)]));
    else std::snprintf(text, sizeof text, "%zu   %.0f mm%s%s", number, line.length * 1e3, line.erases ? "   " : "", line.erases ? s.ui.tr("erased") : "");
    if (line.on_palette) std::snprintf(text, sizeof text, "%zu   %s", number, s.ui.tr("Palette"));
    const float x = at.x + size + s.ui.px(10), line_height = ImGui::GetTextLineHeight();
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddText(ImVec2(x, at.y + 0.5f * size - line_height - 1), line.hidden ? s.ui.faint : s.ui.strong, text);
    const std::string what = stroke::keeps_texels(line.action) ? line.label : s.ui.title(line.brush) + (line.ink.empty() || line.brush.empty() ? "" : " \xc2\xb7 ") + s.ui.tr(line.ink.c_str());
    const std::string shown = s.ui.fitted(what, at.x + ImGui::GetContentRegionAvail().x - x);
    draw->AddText(ImVec2(x, at.y + 0.5f * size + 1), chosen ? s.ui.strong : s.ui.faint, shown.c_str());
    if (ImGui::IsItemHovered() && !line.label.empty()) ImGui::SetTooltip("%s", line.label.c_str());
    else if (ImGui::IsItemHovered() && shown != what) ImGui::SetTooltip("%s", what.c_str());
    if (chosen) edit_row(s, line);
    ImGui::PopID();
}

}  // namespace

void journal_panel(Session& s, float top, float bottom, float left) {
    Ui& ui = s.ui;
    begin_side_panel(s, "###journal", left, top, kJournalWidth, bottom);
    if (!s.journal_fits && ui.primary_button("Back to the tools", ImGui::GetContentRegionAvail().x / ui.settings().scale)) s.show_journal = false;
    const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2 / ui.settings().scale;
    if (ui.button("Undo", name_of(s.keys.chord(Act::undo)).c_str(), half, s.last.can_undo)) s.painter->post(UndoStroke{});
    ImGui::SameLine();
    if (ui.button("Redo", name_of(s.keys.chord(Act::redo)).c_str(), half, s.last.can_redo)) s.painter->post(RedoStroke{});
    if (!s.last.busy.empty()) {
        ImGui::TextUnformatted(ui.tr(s.last.busy.c_str()));
        ImGui::ProgressBar(static_cast<float>(s.last.fraction), ImVec2(-1, ui.px(16)), "");
        if (ui.button("Stop")) s.painter->stop_long_work();
    }
    layers_section(s);
    ui.heading("Journal");
    if (s.strokes.empty()) ui.note(ui.tr("Every stroke you paint is listed here, and can be hidden, changed or taken out later."));
    ImGui::BeginChild("strokes");
    const float row = ui.px(42) + ImGui::GetStyle().ItemSpacing.y;
    ImGuiListClipper clipper;
    // Rows are of one height but for the chosen one, so only long lists are clipped, unchosen.
    const bool clip = s.strokes.size() > 200 && s.selected == 0;
    if (clip) {
        clipper.Begin(static_cast<int>(s.strokes.size()), row);
        while (clipper.Step())
            for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
                const std::size_t k = s.strokes.size() - 1 - static_cast<std::size_t>(i);
                stroke_row(s, s.strokes[k], k + 1);
            }
    } else {
        for (std::size_t k = s.strokes.size(); k-- > 0;) stroke_row(s, s.strokes[k], k + 1);
    }
    ImGui::EndChild();
    ImGui::End();
}

}  // namespace tuft::app
