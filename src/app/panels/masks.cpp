#include <imgui.h>

#include <algorithm>

#include "app/panels/panels.h"
#include "app/widgets/titles.h"
#include "core/text/units.h"

namespace tuft::app {
namespace {

using stroke::MaskKind;

void remove(Session& s, std::uint32_t id) {
    ChangeMasks command;
    command.edit.remove = true;
    command.edit.mask.id = id;
    s.paint_thread->post(std::move(command));
}

void list(Session& s) {
    Ui& ui = s.ui;
    if (s.reported.document.masks.masks.empty()) return;
    if (ImGui::Selectable(ui.tr("Everywhere"), s.masks.active == 0)) choose_mask(s.masks, s.paint_thread.get(), 0);
    ui.mark("mask none");
    for (const stroke::Mask& mask : s.reported.document.masks.masks) {
        ImGui::PushID(static_cast<int>(mask.id));
        if (ImGui::Selectable(mask_title(ui, mask.name).c_str(), s.masks.active == mask.id))
            choose_mask(s.masks, s.paint_thread.get(), mask.id);
        ui.mark("mask " + mask.name);
        ImGui::PopID();
    }
    if (s.masks.active == 0) return;
    const bool writes = !s.reported.file.viewing;
    if (ui.button("Invert", "A mask of what this one leaves out", 0, writes)) {
        stroke::Mask mask;
        mask.kind = MaskKind::invert;
        mask.of = {s.masks.active};
        make_mask(s, std::move(mask));
    }
    ImGui::SameLine();
    if (ui.button("Remove mask", "Strokes that keep to it stay as they are", 0, writes)) remove(s, s.masks.active);
}

}  // namespace

void make_mask(Session& s, stroke::Mask mask) {
    const stroke::MaskTable& table = s.reported.document.masks;
    for (std::size_t n = table.masks.size() + 1;; ++n) {
        mask.name = "Mask " + std::to_string(n);  // stored in English and shown by mask_title
        if (!table.find(std::string_view(mask.name))) break;
    }
    ChangeMasks command;
    command.edit.mask = std::move(mask);
    if (s.masks.choice.with > 0 && command.edit.mask.kind != MaskKind::invert) {
        command.with = s.masks.active;
        command.how = s.masks.choice.with == 1 ? MaskKind::unite : MaskKind::intersect;
    }
    s.paint_thread->post(std::move(command));
}

void mask_section(Session& s) {
    if (s.tools.active != Tool::mask) {
        if (s.masks.active == 0) return;
        const stroke::Mask* mask = s.reported.document.masks.find(s.masks.active);
        s.ui.heading("Mask");
        ImGui::AlignTextToFramePadding();
        if (mask) ImGui::TextUnformatted(mask_title(s.ui, mask->name).c_str());
        ImGui::SameLine();
        if (s.ui.button("Mask off", "Strokes leave ink everywhere again", 0))
            choose_mask(s.masks, s.paint_thread.get(), 0);
        return;
    }
    Ui& ui = s.ui;
    MaskChoice& c = s.masks.choice;
    ui.heading("Mask");
    ImGui::BeginDisabled(s.reported.file.viewing);
    const stroke::Model& model = s.paint_thread->model();
    static constexpr std::pair<MaskKind, const char*> kinds[] = {{MaskKind::angle, "Facing"},
                                                                 {MaskKind::chart, "Chart mask"},
                                                                 {MaskKind::lasso, "Lasso"},
                                                                 {MaskKind::group, "Group"}};
    const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2 / ui.settings().scale;
    for (std::size_t i = 0; i < std::size(kinds); ++i) {
        if (i % 2) ImGui::SameLine();
        if (ui.choice(kinds[i].second, c.kind == kinds[i].first, "How the mask is found", half))
            c.kind = kinds[i].first;
    }
    if (c.kind == MaskKind::angle) {
        ui.slider("Within", c.within, {0, 180 * kDegree, "%.0f\xc2\xb0", kDegree},
                  "Of the direction that the surface has where you click");
        ui.slider("Soft edge", c.soft, {0, 45 * kDegree, "%.0f\xc2\xb0", kDegree});
        ui.note(ui.tr("Click on the model: what faces as it does there."));
    } else if (c.kind == MaskKind::chart) {
        ui.note(ui.tr("Click on the model: the chart that lies there."));
    } else if (c.kind == MaskKind::lasso) {
        ui.toggle("Also what lies behind", c.through, "Else only what is seen");
        ui.note(ui.tr("Draw round a part of the model."));
    } else if (model.mesh->group_names.empty()) {
        ui.note(ui.tr("The file of this model names no groups."));
    } else {
        ui.note(ui.tr("Click on the model: the group that lies there. Or choose it:"));
        if (c.group.empty()) c.group = model.mesh->group_names.front();
        if (ui.combo("Group of the file", c.group, model.mesh->group_names)) {
            stroke::Mask mask;
            mask.kind = MaskKind::group;
            mask.groups = {c.group};
            make_mask(s, std::move(mask));
        }
    }
    if (s.masks.active != 0) {
        static const std::vector<std::string> modes{"By itself", "Added to that mask", "Only within that mask"};
        std::string mode = modes[static_cast<std::size_t>(c.with)];
        if (ui.combo("With the chosen one", mode, modes))
            c.with = static_cast<int>(std::find(modes.begin(), modes.end(), mode) - modes.begin());
    }
    ImGui::EndDisabled();
    list(s);
}

}  // namespace tuft::app
