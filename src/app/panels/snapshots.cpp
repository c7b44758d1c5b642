#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/panels/panels.h"
#include "app/widgets/titles.h"

/// Named states of the journal: their list, and the comparison with the work as it is.
namespace tuft::app {
namespace {

const SnapshotLine* find_snapshot(const Session& s, const std::string& id) {
    const auto at = std::find_if(s.journal.snapshots.lines.begin(), s.journal.snapshots.lines.end(),
                                 [&](const SnapshotLine& l) { return l.id == id; });
    return at == s.journal.snapshots.lines.end() ? nullptr : &*at;
}

constexpr const char* kWord = "Snapshot";

std::string title_of(const Ui& ui, const SnapshotLine& line) {
    return numbered_title(ui, line.name, kWord);
}

std::string fresh_snapshot_name(const Session& s) {
    for (std::size_t n = s.journal.snapshots.lines.size() + 1;; ++n) {
        std::string name = "Snapshot " + std::to_string(n);  // stored in English and shown by title_of
        const std::string title = numbered_title(s.ui, name, kWord);
        if (std::none_of(s.journal.snapshots.lines.begin(), s.journal.snapshots.lines.end(),
                         [&](const SnapshotLine& l) { return title_of(s.ui, l) == title; }))
            return name;
    }
}

void snapshot_details(Session& s, const SnapshotLine& line) {
    Ui& ui = s.ui;
    char name[stroke::kMaxNameBytes + 1];
    const std::string title = title_of(ui, line);
    std::snprintf(name, sizeof name, "%s", title.c_str());
    ImGui::SetNextItemWidth(-1);
    ImGui::BeginDisabled(s.reported.file.viewing);
    if (ImGui::InputText("##name", name, sizeof name, ImGuiInputTextFlags_EnterReturnsTrue) && name[0] && title != name)
        s.paint_thread->post(RenameSnapshot{line.id, name});
    ui.mark("Snapshot name");
    ImGui::EndDisabled();
    const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2 / ui.settings().scale;
    const bool compared = s.journal.snapshots.compared == line.id, writes = !s.reported.file.viewing;
    if (ui.choice("Compare", compared, "Shows it beside the work as it is now", half))
        compare_with(s.journal.snapshots, s.view.atlas, s.paint_thread.get(), compared ? "" : line.id);
    ImGui::SameLine();
    if (ui.button("Restore", "Goes back to it; Undo brings back what is there now", half, writes)) {
        compare_with(s.journal.snapshots, s.view.atlas, s.paint_thread.get(), "");
        s.paint_thread->post(RestoreSnapshot{line.id});
    }
    if (ui.button("Delete the snapshot", "The work stays as it is", 2 * half + 8, writes)) {
        if (compared) compare_with(s.journal.snapshots, s.view.atlas, s.paint_thread.get(), "");
        s.paint_thread->post(DetachFromProject{io::kSnapshots, line.id});
    }
}

// Says at the bottom of the view which part shows what; to the left or to the right of `x`.
void draw_tag(const Session& s, const std::string& text, float x, bool to_left) {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float pad = s.ui.px(7), left = to_left ? x - size.x - 3 * pad : x + pad,
                y = static_cast<float>(s.view.area.y + s.view.area.height) - size.y - 9 * pad;  // above the scale
    ImDrawList* draw = ImGui::GetBackgroundDrawList();
    draw->AddRectFilled(ImVec2(left, y), ImVec2(left + size.x + 2 * pad, y + size.y + pad), IM_COL32(24, 24, 26, 200),
                        s.ui.px(4));
    draw->AddText(ImVec2(left + pad, y + 0.5f * pad), IM_COL32(240, 240, 240, 255), text.c_str());
}

}  // namespace

void snapshots_section(Session& s) {
    Ui& ui = s.ui;
    if (!ui.section("Snapshots", false)) return;
    SnapshotState& all = s.journal.snapshots;
    for (const SnapshotLine& line : all.lines) {
        ImGui::PushID(line.id.c_str());
        const bool chosen = all.chosen == line.id;
        const std::string title = title_of(ui, line);
        const std::string count = ui.sentence(Message(line.strokes == 1 ? "{} stroke" : "{} strokes", line.strokes));
        const float right = ImGui::CalcTextSize(count.c_str()).x, room = ImGui::GetContentRegionAvail().x,
                    x = ImGui::GetCursorPosX();
        if (ui.entry(ui.fitted(title, room - right - ui.px(10)).c_str(), chosen)) all.chosen = chosen ? "" : line.id;
        ui.mark("snapshot " + line.name);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s\n%s", title.c_str(), date_text(line.made).c_str());
        ImGui::SameLine(x + room - right);
        ImGui::TextDisabled("%s", count.c_str());
        if (chosen) snapshot_details(s, line);
        ImGui::PopID();
    }
    if (ui.button("Take a snapshot", "Keeps the work as it is now, to compare with it or to go back to it", 0,
                  !s.reported.file.viewing))
        s.paint_thread->post(TakeSnapshot{fresh_snapshot_name(s)});
}

void comparison_bar(Session& s) {
    SnapshotState& all = s.journal.snapshots;
    const SnapshotLine* line = find_snapshot(s, all.compared);
    if (!line || !s.paint_thread) return;
    Ui& ui = s.ui;
    const std::string title = ui.fitted(title_of(ui, *line), ui.px(140));
    Area over = s.view.area;  // both views, where they are side by side
    if (!all.swipe && all.width != 0) over.x = all.x, over.width += s.view.area.x - all.x;
    begin_panel_over(ui, over, {.name = "comparison", .across = 0.5f});
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(all.ready ? title.c_str() : ui.tr("Painting the snapshot"));
    ImGui::SameLine();
    if (ui.choice("Side by side", !all.swipe)) all.swipe = false;
    ImGui::SameLine();
    if (ui.choice("Swipe", all.swipe, "One over the other; drag the line between them")) all.swipe = true;
    ImGui::SameLine();
    const bool restore =
        ui.button("Restore", "Goes back to it; Undo brings back what is there now", 0, !s.reported.file.viewing);
    ImGui::SameLine();
    const bool done = ui.button("Done");
    ImGui::End();
    if (all.ready) {
        const float middle = all.swipe ? static_cast<float>(s.view.area.x + all.line_at * s.view.area.width)
                                       : static_cast<float>(s.view.area.x);
        draw_tag(s, title, middle, true);
        draw_tag(s, ui.tr("Now"), middle, false);
    }
    if (restore) s.paint_thread->post(RestoreSnapshot{all.compared});
    if (restore || done) compare_with(s.journal.snapshots, s.view.atlas, s.paint_thread.get(), "");
}

void swipe_line(Session& s) {
    SnapshotState& all = s.journal.snapshots;
    if (all.compared.empty() || !all.swipe || !all.ready) return;
    Ui& ui = s.ui;
    const auto x0 = static_cast<float>(s.view.area.x), y0 = static_cast<float>(s.view.area.y),
               width = static_cast<float>(s.view.area.width), height = static_cast<float>(s.view.area.height);
    const float at = x0 + static_cast<float>(all.line_at) * width, grip = ui.px(14);
    ImDrawList* draw = ImGui::GetBackgroundDrawList();
    draw->AddImage(reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(all.texture)), ImVec2(x0, y0),
                   ImVec2(at, y0 + height), ImVec2(0, 1), ImVec2(static_cast<float>(all.line_at), 0));
    draw->AddLine(ImVec2(at, y0), ImVec2(at, y0 + height), IM_COL32(20, 20, 22, 255), ui.px(4));
    draw->AddLine(ImVec2(at, y0), ImVec2(at, y0 + height), IM_COL32(245, 245, 245, 255), ui.px(1.6f));
    ImGui::SetNextWindowPos(ImVec2(at - grip, y0));
    ImGui::SetNextWindowSize(ImVec2(2 * grip, height));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::Begin("###swipe", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoBackground |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::InvisibleButton("##line", ImVec2(2 * grip, height));
    ui.mark("Swipe line");
    if (ImGui::IsItemHovered() || ImGui::IsItemActive()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    if (ImGui::IsItemActive())
        all.line_at = std::clamp(static_cast<double>((ImGui::GetIO().MousePos.x - x0) / width), 0.02, 0.98);
    const ImVec2 c(at, y0 + 0.5f * height);
    draw->AddCircleFilled(c, ui.px(11), IM_COL32(245, 245, 245, 255), 24);
    draw->AddTriangleFilled(ImVec2(c.x - ui.px(7), c.y), ImVec2(c.x - ui.px(2), c.y - ui.px(4)),
                            ImVec2(c.x - ui.px(2), c.y + ui.px(4)), IM_COL32(30, 30, 32, 255));
    draw->AddTriangleFilled(ImVec2(c.x + ui.px(7), c.y), ImVec2(c.x + ui.px(2), c.y - ui.px(4)),
                            ImVec2(c.x + ui.px(2), c.y + ui.px(4)), IM_COL32(30, 30, 32, 255));
    ImGui::End();
    ImGui::PopStyleVar();
}

}  // namespace tuft::app
