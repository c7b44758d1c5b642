#include <imgui.h>

#include <algorithm>

#include "app/panels.h"

namespace tuft::app {

void misfit_dialog(Session& s) {
    if (!s.show_misfits || !s.painter) return;
    if (!begin_dialog(s, "Strokes that no longer fit", 460)) return end_dialog(s);
    Ui& ui = s.ui;
    ui.wrapped(ui.tr("These strokes do not touch the revised model anywhere. They stay in the journal."));
    const float rows = std::min(8.0f, static_cast<float>(s.misfits.size()));
    ImGui::BeginChild("misfits", ImVec2(0, rows * ImGui::GetTextLineHeightWithSpacing() + ui.px(6)));
    for (const Misfit& misfit : s.misfits) {
        const auto line = std::find_if(s.strokes.begin(), s.strokes.end(), [&](const StrokeLine& l) { return l.id == misfit.stroke; });
        if (line == s.strokes.end()) continue;
        char text[160];
        std::snprintf(text, sizeof text, "%td   %s \xc2\xb7 %s", line - s.strokes.begin() + 1, ui.title(line->brush).c_str(), ui.tr(line->ink.c_str()));
        if (ImGui::Selectable(text, s.selected == misfit.stroke)) s.selected = misfit.stroke;
        std::snprintf(text, sizeof text, "%.1f mm away", misfit.distance * 1e3);
        const std::string away = ui.tr_sentence(text);
        ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(away.c_str()).x - ui.px(6));
        ImGui::TextDisabled("%s", away.c_str());
    }
    ImGui::EndChild();
    const bool hide = ui.button("Hide them", nullptr, 120);
    ImGui::SameLine();
    const bool keep = ui.primary_button("Keep them", 120);
    end_dialog(s);
    if (hide)
        for (const Misfit& misfit : s.misfits) s.painter->post(EditStroke{.id = misfit.stroke, .hidden = true});
    if (hide || keep) s.show_misfits = false;
}

}  // namespace tuft::app
