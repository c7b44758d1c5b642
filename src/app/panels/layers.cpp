#include <imgui.h>

#include <algorithm>
#include <cstring>

#include "app/panels/panels.h"

namespace tuft::app {
namespace {

using stroke::Layer;

void change(Session& s, const stroke::LayerEdit& edit) { s.painter->post(ChangeLayers{edit}); }

// A name that no layer has yet.
std::string fresh_name(const Session& s) {
    for (std::size_t n = s.last.layers.layers.size() + 1;; ++n) {
        const std::string name = std::string(s.ui.tr("Layer")) + " " + std::to_string(n);
        if (!s.last.layers.find(std::string_view(name))) return name;
    }
}

// What can be done with the chosen layer.
void details(Session& s, const Layer& layer, std::size_t place) {
    Ui& ui = s.ui;
    const auto& all = s.last.layers.layers;
    char name[stroke::kMaxNameBytes + 1];
    std::snprintf(name, sizeof name, "%s", layer.name.c_str());
    ImGui::SetNextItemWidth(-1);
    if (ImGui::InputText("##name", name, sizeof name, ImGuiInputTextFlags_EnterReturnsTrue) && layer.name != name) {
        Layer renamed = layer;
        renamed.name = name;
        change(s, stroke::changed(s.last.layers, renamed));
    }
    ui.mark("Layer name");
    if (s.layer_opacity < 0) s.layer_opacity = layer.opacity;
    ui.slider("Opacity", s.layer_opacity, 0, 1, "%.0f %%", "Of the whole layer over those below", 0.01);
    if (ImGui::IsItemDeactivatedAfterEdit() && s.layer_opacity != layer.opacity) {
        Layer faded = layer;
        faded.opacity = s.layer_opacity;
        change(s, stroke::changed(s.last.layers, faded));
    }
    if (!ImGui::IsItemActive()) s.layer_opacity = -1;
    const float third = (ImGui::GetContentRegionAvail().x / ui.settings().scale - 16) / 3;
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(ui.px(2), ImGui::GetStyle().FramePadding.y));  // the words fill the buttons
    if (ui.button("Higher", nullptr, third, place + 1 < all.size())) change(s, stroke::moved(s.last.layers, layer.id, static_cast<std::uint32_t>(place + 1)));
    ImGui::SameLine();
    if (ui.button("Lower", nullptr, third, place > 0)) change(s, stroke::moved(s.last.layers, layer.id, static_cast<std::uint32_t>(place - 1)));
    ImGui::SameLine();
    if (ui.button("Remove", "With its strokes; Undo brings them back", third, all.size() > 1)) change(s, stroke::removed(layer.id));
    ImGui::PopStyleVar();
    bool locked = layer.locked;
    if (ui.toggle("Locked", locked, "Takes no strokes")) {
        Layer other = layer;
        other.locked = locked;
        change(s, stroke::changed(s.last.layers, other));
    }
}

}  // namespace

void layers_section(Session& s) {
    Ui& ui = s.ui;
    const auto& all = s.last.layers.layers;
    if (all.empty()) return;
    ui.heading("Layers");
    for (std::size_t i = all.size(); i-- > 0;) {
        const Layer& layer = all[i];
        ImGui::PushID(static_cast<int>(layer.id));
        bool visible = layer.visible;
        if (ImGui::Checkbox("##visible", &visible)) {
            Layer other = layer;
            other.visible = visible;
            change(s, stroke::changed(s.last.layers, other));
        }
        ui.mark("show " + layer.name);
        ui.hint("Seen or not");
        ImGui::SameLine();
        const bool chosen = layer.id == s.layer;
        const std::string text = ui.tr_sentence(layer.name) + (layer.locked ? std::string("  (") + ui.tr("locked") + ")" : "");
        if (ImGui::Selectable(text.c_str(), chosen, 0, ImVec2(0, ImGui::GetFrameHeight() - ui.px(4)))) {
            s.layer_details = chosen ? !s.layer_details : true;
            s.layer = layer.id;
            s.layer_opacity = -1;
        }
        ui.mark("layer " + layer.name);
        if (chosen && s.layer_details) details(s, layer, i);
        ImGui::PopID();
    }
    if (ui.button("Add a layer", "Strokes on it can be shown, faded and moved apart from the others", 0, all.size() < stroke::kMaxLayers))
        add_layer(s, fresh_name(s));
}

}  // namespace tuft::app
