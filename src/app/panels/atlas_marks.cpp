#include <imgui.h>

#include <cstdio>

#include "app/panels/panels.h"

namespace tuft::app {

void atlas_marks(const Ui& ui, const AtlasView& atlas, PaintThread& work, const std::optional<Vec2>& cursor) {
    if (!atlas.shown) return;
    ImDrawList* draw = ImGui::GetBackgroundDrawList();
    const auto at = [&](const Vec2& uv) {
        return ImVec2(static_cast<float>(on_atlas(atlas, uv).x), static_cast<float>(on_atlas(atlas, uv).y));
    };
    const ImVec2 a(static_cast<float>(atlas.area.x), static_cast<float>(atlas.area.y));
    const ImVec2 b(a.x + static_cast<float>(atlas.area.width), a.y + static_cast<float>(atlas.area.height));
    draw->PushClipRect(a, b, true);
    draw->AddRect(at({0, 1}), at({1, 0}), IM_COL32(150, 150, 155, 160));
    if (cursor) {
        draw->AddCircle(at(*cursor), ui.px(7), IM_COL32(20, 20, 24, 255), 24, ui.px(3.5f));
        draw->AddCircle(at(*cursor), ui.px(7), IM_COL32(255, 196, 64, 255), 24, ui.px(1.8f));
    }
    const stroke::Model& m = work.model();
    const auto print = [&](const char* between) {
        char text[160];
        const int n =
            std::snprintf(text, sizeof text, ui.tr(m.atlas.n_charts == 1 ? "%u chart" : "%u charts"), m.atlas.n_charts);
        if (const atlas::AtlasReport* report = work.atlas_report())
            std::snprintf(text + n, sizeof text - static_cast<std::size_t>(n), "%s%s %.3f%s%s %.0f %%", between,
                          ui.tr("stretch"), report->l2_stretch, between, ui.tr("used"), 100 * report->utilisation);
        return std::string(text);
    };
    std::string text = print("    ");
    if (ImGui::CalcTextSize(text.c_str()).x + ui.px(32) > b.x - a.x) text = print("\n");
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    draw->AddRectFilled(ImVec2(a.x + ui.px(8), a.y + ui.px(8)),
                        ImVec2(a.x + ui.px(24) + size.x, a.y + ui.px(16) + size.y), IM_COL32(24, 24, 26, 190),
                        ui.px(5));
    draw->AddText(ImVec2(a.x + ui.px(16), a.y + ui.px(12)), IM_COL32(240, 240, 240, 255), text.c_str());
    draw->PopClipRect();
    draw->AddLine(ImVec2(a.x - 1, a.y), ImVec2(a.x - 1, b.y), ImGui::GetColorU32(ImGuiCol_Border));
}

}  // namespace tuft::app
