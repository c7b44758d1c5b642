#include <imgui.h>

#include <algorithm>

#include "app/dialogs/dialogs.h"

namespace tuft::app {

void mismatch_dialog(Session& s) {
    if (!s.dialogs.show_mismatches || !s.paint_thread) return;
    if (!begin_dialog(s.ui, "What no longer fits", 640)) return end_dialog(s.ui);
    Ui& ui = s.ui;
    ui.wrapped(ui.tr("These strokes and areas do not lie on the revised model as they did. They stay in the journal."));
    for (const Message& line : s.project.revision.fit) ui.note(ui.sentence(line));
    const float rows = std::min(8.0f, static_cast<float>(s.project.revision.mismatches.size()));
    ImGui::BeginChild("mismatches", ImVec2(0, rows * ImGui::GetTextLineHeightWithSpacing() + ui.px(6)));
    for (const stroke::StrokeMismatch& mismatch : s.project.revision.mismatches) {
        const auto line = std::find_if(s.journal.lines.begin(), s.journal.lines.end(),
                                       [&](const StrokeLine& l) { return l.id == mismatch.stroke; });
        if (line == s.journal.lines.end()) continue;
        char text[160];
        const std::string brush = line->brush.empty() ? "" : ui.title(line->brush) + " \xc2\xb7 ";  // none of an area
        std::snprintf(text, sizeof text, "%td   %s%s", line - s.journal.lines.begin() + 1, brush.c_str(),
                      ui.tr(line->ink.c_str()));
        const float room = ImGui::GetContentRegionAvail().x;
        const std::string all = ui.sentence(mismatch.reason), why = ui.fitted(all, room - ui.px(170));
        const float right = ImGui::CalcTextSize(why.c_str()).x + ui.px(6);
        ImGui::PushID(static_cast<int>(mismatch.stroke));
        if (ImGui::Selectable(ui.fitted(text, room - right - ui.px(12)).c_str(),
                              s.journal.is_selected(mismatch.stroke)))
            select_entries(s.journal, s.paint_thread.get(), {mismatch.stroke});
        ImGui::PopID();
        ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - right);
        ImGui::TextDisabled("%s", why.c_str());
        if (why != all && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", all.c_str());
    }
    ImGui::EndChild();
    ui.buttons_at_right({{"Back to the former model", 120}, {"Hide them", 120}, {"Keep them", 120}});
    const bool back = ui.button("Back to the former model", "The revised one is among the recent projects then", 120);
    ImGui::SameLine();
    const bool hide = ui.button("Hide them", nullptr, 120);
    ImGui::SameLine();
    const bool keep = ui.primary_button("Keep them", 120);
    end_dialog(s.ui);
    if (back) return open_previous(s);
    if (hide) {
        EditStrokes edit{.hidden = true};
        for (const stroke::StrokeMismatch& mismatch : s.project.revision.mismatches)
            edit.ids.push_back(mismatch.stroke);
        s.paint_thread->post(std::move(edit));
    }
    if (hide || keep) s.dialogs.show_mismatches = false;
}

}  // namespace tuft::app
