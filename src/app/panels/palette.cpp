#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/panels/panels.h"
#include "core/text/units.h"

namespace tuft::app {
namespace {

ImVec2 on_picture(const PaletteState& p, const Vec3& at) {
    return {static_cast<float>(p.x + (at.x / stroke::kPaletteWidth + 0.5) * p.width),
            static_cast<float>(p.y + (0.5 - at.y / stroke::kPaletteHeight) * p.height)};
}

// The pressed tuft from above, or where a pool would be poured.
void marks(const Ui& ui, const PaletteState& p, unsigned ink, ImDrawList* draw) {
    for (const brush::Branch& branch : p.tuft.branches) {
        std::vector<ImVec2> left, right;
        for (const brush::Section& section : branch.sections) {
            const Vec3 across =
                std::abs(section.a) > std::abs(section.b) ? section.a * section.e : section.b * section.m;
            left.push_back(on_picture(p, section.centre + across));
            right.push_back(on_picture(p, section.centre - across));
        }
        if (left.size() < 2) continue;
        left.insert(left.end(), right.rbegin(), right.rend());
        draw->AddPolyline(left.data(), static_cast<int>(left.size()), IM_COL32(255, 255, 255, 200), ImDrawFlags_Closed,
                          ui.px(3));
        draw->AddPolyline(left.data(), static_cast<int>(left.size()), IM_COL32(40, 36, 32, 230), ImDrawFlags_Closed,
                          ui.px(1.5f));
    }
    if (!p.tuft.branches.empty() || !ImGui::IsItemHovered()) return;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const double radius = p.tool == PaletteTool::pour ? p.radius : p.tool == PaletteTool::brush ? 1e-3 : 0.5e-3;
    const auto pixels = static_cast<float>(radius / stroke::kPaletteWidth * p.width);
    draw->AddCircle(mouse, pixels, IM_COL32(255, 255, 255, 200), 32, ui.px(3));
    draw->AddCircle(mouse, pixels, p.tool == PaletteTool::pour ? ink : IM_COL32(40, 36, 32, 230), 32, ui.px(1.5f));
}

}  // namespace

void palette_panel(Session& s) {
    PaletteState& p = s.colours.palette;
    p.width = 0;
    if (!p.shown || !s.paint_thread) return;
    Ui& ui = s.ui;
    const float room = static_cast<float>(s.view.area.width) - 2 * ui.px(kPanelMargin);
    begin_panel_over(
        ui, s.view.area,
        {.name = "palette", .width = std::min(ui.px(330), std::max(ui.px(256), 0.55f * room)), .below = true});
    const float third =
        (ImGui::GetContentRegionAvail().x - 3 * ImGui::GetStyle().ItemSpacing.x) / 4 / ui.settings().scale;
    const auto tool = [&](PaletteTool which, const char* name, const char* hint) {
        if (ui.choice(name, p.tool == which, hint, third)) p.tool = which;
        ImGui::SameLine();
    };
    tool(PaletteTool::brush, "Stir",
         "With the brush, as on the model: it takes up what lies there and leaves what is in it");
    tool(PaletteTool::pour, "Pour", "Click: a pool of the chosen ink");
    tool(PaletteTool::pick, "Take", "Click: the mixture there becomes an ink of its own");
    const bool writes = !s.reported.file.viewing;
    if (ui.button("Wash", "Cleans the palette; Undo brings it back", third, writes))
        s.paint_thread->post(TendInk{stroke::WashPalette{}});
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float picture = ImGui::GetContentRegionAvail().x;
    p.x = static_cast<double>(at.x);
    p.y = static_cast<double>(at.y);
    p.width = static_cast<double>(picture);
    p.height = p.width * stroke::kPaletteHeight / stroke::kPaletteWidth;
    const ImVec2 size(picture, static_cast<float>(p.height));
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddImageRounded(reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(p.texture)), at,
                          ImVec2(at.x + size.x, at.y + size.y), ImVec2(0, 0), ImVec2(1, 1), IM_COL32_WHITE, ui.px(8));
    ImGui::InvisibleButton("plate", size);
    ui.mark("Plate");
    draw->PushClipRect(at, ImVec2(at.x + size.x, at.y + size.y), true);
    marks(ui, p, ink_colour(s.colours, s.brush.ink), draw);
    draw->PopClipRect();
    draw->AddRect(at, ImVec2(at.x + size.x, at.y + size.y), IM_COL32(128, 128, 128, 160), ui.px(8));
    if (p.tool == PaletteTool::pour)
        ui.slider("Pool", p.radius, {0.003, 0.02, "%.0f mm", kMillimetre}, "How wide, to each side");
    else if (ui.button("Rinse the brush", "No ink left in it, hair straight and together", 0, writes))
        s.paint_thread->post(ActOnBrush{.what = stroke::Rinse{}, .brush = s.brush.preset, .ink = s.brush.ink});
    ImGui::End();
}

}  // namespace tuft::app
