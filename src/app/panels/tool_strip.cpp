#include <imgui.h>

#include "app/panels/panels.h"
#include "app/widgets/icons.h"

/// The column of tools: an icon each, its name under it.
namespace tuft::app {
namespace {

struct Entry {
    Tool tool;
    Icon icon;
    const char *name, *hint;
};
constexpr Entry kEntries[] = {
    {Tool::brush, Icon::brush, "Brush", "Paint freely (B)"},
    {Tool::line, Icon::line, "Line",
     "Straight as you see it, from press to release; Shift for steps of 15 degrees. Its ends can be moved afterwards "
     "(L)"},
    {Tool::curve, Icon::curve, "Curve",
     "Click to set points, drag to move them, the wheel over one changes its pressure, Enter paints (C)"},
    {Tool::writing, Icon::place, "Place", "Places writing or a drawing from a file where you click (T)"},
    {Tool::text, Icon::write, "Write", "Writes a text that you type where you click (W)"},
    {Tool::eraser, Icon::eraser, "Eraser",
     "Takes ink off with the brush, as deep as it is pressed; a pen's other end does so too (E)"},
    {Tool::fill, Icon::fill, "Fill", "Lays the chosen ink over the whole model, a part or a chart where you click (G)"},
    {Tool::pick, Icon::pick, "Pick",
     "Click: the pigments that lie there become an ink of their own, in the proportions they have (I)"},
    {Tool::mask, Icon::mask, "Mask", "Says where strokes and fills may leave ink (M)"}};

// An icon over a name; true when it was pressed.
bool cell(Ui& ui, Icon icon, const char* name, const char* hint, bool chosen, float height) {
    const float width = ImGui::GetContentRegionAvail().x;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool pressed = ImGui::InvisibleButton(name, ImVec2(width, height));
    ui.mark(name);
    ui.hint(hint);
    const bool over = ImGui::IsItemHovered();
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const ImVec2 end(at.x + width, at.y + height);
    if (chosen || over)
        draw->AddRectFilled(at, end, ImGui::GetColorU32(chosen ? ImGuiCol_Header : ImGuiCol_FrameBgHovered), ui.px(5));
    // Names shrink with the cell before icons do.
    const float letters = 0.8f * ImGui::GetFontSize(), line = 1.1f * letters;
    const bool named = height >= line + ui.px(20);
    const float picture = std::min(ui.px(24), height - (named ? line : 0) - ui.px(4));
    const float gap = 0.5f * (height - picture - (named ? line : 0));
    draw_icon(draw, icon, ImVec2(at.x + 0.5f * (width - picture), at.y + gap), picture, ui.strong);
    if (!named) return pressed;
    const char* text = ui.tr(name);
    const ImVec2 size = ImGui::GetFont()->CalcTextSizeA(letters, 1e9f, 0, text);
    draw->AddText(ImGui::GetFont(), letters, ImVec2(at.x + 0.5f * (width - size.x), at.y + gap + picture), ui.strong,
                  text);
    return pressed;
}

}  // namespace

void tool_strip(Session& s, float top, float bottom, float left) {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(s.ui.px(4), s.ui.px(4)));
    begin_side_panel(s.ui, "###strip", {left, top, bottom, kStripWidth, false});
    const float gap = s.ui.px(2), room = bottom - top - s.ui.px(8);
    const float height = std::min(s.ui.px(50), (room - 10 * gap) / 10 - s.ui.px(1));
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0, gap));
    for (const Entry& e : kEntries)
        if (cell(s.ui, e.icon, e.name, e.hint, s.tools.active == e.tool, height)) s.tools.active = e.tool;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddLine(ImVec2(at.x + s.ui.px(6), at.y),
                                        ImVec2(at.x + ImGui::GetContentRegionAvail().x - s.ui.px(6), at.y),
                                        ImGui::GetColorU32(ImGuiCol_Separator));
    ImGui::Dummy(ImVec2(0, gap));
    if (cell(s.ui, Icon::palette, "Palette", "A plate on which brushes mix inks (P)", s.colours.palette.shown, height))
        show_palette(s.colours.palette, s.brush, s.status, !s.colours.palette.shown);
    ImGui::PopStyleVar();
    ImGui::End();
    ImGui::PopStyleVar();
}

}  // namespace tuft::app
