#include <imgui.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "app/panels/panels.h"
#include "app/widgets/icons.h"

namespace tuft::app {
namespace {

using Names = std::vector<std::string>;

constexpr const char* kOfModel = "As the whole model";  // in place of a substrate's name
constexpr float kPartHeight = 24, kMostRows = 8;        // pixels at scale 1; rows before the list scrolls

const stroke::PartTable& table_of(const PartParts& s) {
    return s.reported.document.parts;
}

void change(const PartParts& s, stroke::PartEdit edit) {
    edit = stroke::changes_only(table_of(s), std::move(edit));
    if (!edit.parts.empty()) s.work.post(ChangeParts{std::move(edit)});
}

// The chosen parts with this one, or this one alone.
Names with_chosen(const PartParts& s, const std::string& name) {
    if (!s.parts.chosen.contains(name)) return {name};
    return {s.parts.chosen.begin(), s.parts.chosen.end()};
}

bool icon_switch(const PartParts& s, const std::string& name, Icon icon, unsigned colour, const char* hint) {
    const float side = s.ui.px(kPartHeight - 4);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::PushID(name.c_str());
    const bool pressed = ImGui::InvisibleButton("##icon", ImVec2(side, side));
    ImGui::PopID();
    s.ui.mark(name);
    if (ImGui::IsItemHovered())
        ImGui::GetWindowDrawList()->AddRectFilled(at, ImVec2(at.x + side, at.y + side),
                                                  ImGui::GetColorU32(ImGuiCol_HeaderHovered), s.ui.px(3));
    s.ui.hint(hint);
    draw_icon(ImGui::GetWindowDrawList(), icon, ImVec2(at.x + 0.1f * side, at.y + 0.1f * side), 0.8f * side, colour);
    return pressed;
}

// A click chooses one, with Ctrl one more, with Shift all from the one chosen before.
void choose(const PartParts& s, const std::string& name) {
    const Names& all = s.work.part_names();
    std::set<std::string>& chosen = s.parts.chosen;
    const auto from = std::ranges::find(all, s.parts.anchor), to = std::ranges::find(all, name);
    if (ImGui::GetIO().KeyShift && from != all.end()) {
        chosen.clear();
        chosen.insert(std::min(from, to), std::max(from, to) + 1);
        return;
    }
    s.parts.anchor = name;
    if (ImGui::GetIO().KeyCtrl) {
        if (!chosen.erase(name)) chosen.insert(name);
    } else {
        const bool alone = chosen.size() == 1 && chosen.contains(name);
        chosen.clear();
        if (!alone) chosen.insert(name);
    }
}

std::string row_text(const PartParts& s, const stroke::Part& part) {
    std::string text = part.name;
    if (part.substrate) text += "  " + s.ui.title(part.substrate->name);
    return text;
}

void row(const PartParts& s, const std::string& name) {
    Ui& ui = s.ui;
    const stroke::Part part = table_of(s).state_of(name);
    const bool writes = !s.reported.file.viewing;
    ImGui::PushID(name.c_str());
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(ui.px(3), ui.px(2)));
    ImGui::BeginDisabled(!writes);
    const Names names = with_chosen(s, name);
    if (icon_switch(s, "show part " + name, part.hidden ? Icon::closed_eye : Icon::eye,
                    part.hidden ? ui.faint : ui.strong, "Hidden parts are as if they were not there"))
        change(s, stroke::hidden_parts(table_of(s), names, !part.hidden));
    ImGui::SameLine();
    if (icon_switch(s, "lock part " + name, part.locked ? Icon::lock : Icon::open_lock,
                    part.locked ? ui.strong : ui.faint, "Locked parts are touched and get no ink"))
        change(s, stroke::locked_parts(table_of(s), names, !part.locked));
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (part.hidden) ImGui::PushStyleColor(ImGuiCol_Text, ui.faint);
    const std::string whole = row_text(s, part), text = ui.fitted(whole, ImGui::GetContentRegionAvail().x);
    if (ui.entry((text + "###row").c_str(), s.parts.chosen.contains(name), ui.px(kPartHeight - 4))) choose(s, name);
    if (part.hidden) ImGui::PopStyleColor();
    ui.mark("part " + name);
    if (text != whole) ui.hint(whole.c_str());
    ImGui::PopStyleVar();
    ImGui::PopID();
}

void actions(const PartParts& s) {
    Ui& ui = s.ui;
    const Names& all = s.work.part_names();
    const bool writes = !s.reported.file.viewing, any = !s.parts.chosen.empty();
    const Names chosen(s.parts.chosen.begin(), s.parts.chosen.end());
    const bool hides = std::ranges::any_of(table_of(s).parts, [](const stroke::Part& p) { return p.hidden; });
    const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2 / ui.settings().scale;
    if (ui.button("Isolate", "Shows the chosen parts alone", half, any && writes))
        change(s, stroke::isolated_parts(table_of(s), all, chosen));
    ImGui::SameLine();
    if (ui.button("Show all", "Shows all parts again", half, hides && writes))
        change(s, stroke::hidden_parts(table_of(s), all, false));
    if (!any) return ui.note(ui.tr("Choose parts to isolate them or to change what they are made of."));
    const std::optional<ink::Substrate> own = table_of(s).state_of(chosen.front()).substrate;
    std::string substrate = own ? own->name : kOfModel;
    Names substrates{kOfModel};
    substrates.insert(substrates.end(), s.colours.substrates.begin(), s.colours.substrates.end());
    ImGui::BeginDisabled(!writes);
    if (ui.combo("Part made of", substrate, substrates)) {
        std::optional<ink::Substrate> wanted;
        if (substrate != kOfModel) wanted = ink::load_substrate(substrate);
        change(s, stroke::parts_of_substrate(table_of(s), chosen, wanted));
    }
    ImGui::EndDisabled();
}

}  // namespace

void parts_section(const PartParts& s) {
    const Names& all = s.work.part_names();
    if (all.size() < 2) return;
    Ui& ui = s.ui;
    std::erase_if(s.parts.chosen, [&](const std::string& name) { return std::ranges::find(all, name) == all.end(); });
    if (!ui.section("Parts", !table_of(s).parts.empty(), std::to_string(all.size()).c_str())) return;
    const float rows = std::min(static_cast<float>(all.size()), kMostRows);
    ImGui::BeginChild("parts", ImVec2(0, ui.px(rows * (kPartHeight - 2) + 2)));
    for (const std::string& name : all) row(s, name);
    ImGui::EndChild();
    actions(s);
}

}  // namespace tuft::app
