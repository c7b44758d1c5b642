#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "app/panels/panels.h"
#include "app/widgets/titles.h"

namespace tuft::app {
namespace {

using stroke::Layer;

constexpr float kLayerHeight = 36;

void change(const LayerParts& s, const stroke::LayerEdit& edit) {
    s.work.post(ChangeLayers{edit});
}

// A name that no layer has yet, stored in English and shown by layer_title.
std::string fresh_name(const LayerParts& s) {
    for (std::size_t n = s.table.layers.size() + 1;; ++n) {
        std::string name = "Layer " + std::to_string(n);
        // An older project may store names in the language of its time.
        const std::string title = layer_title(s.ui, name);
        if (std::none_of(s.table.layers.begin(), s.table.layers.end(),
                         [&](const Layer& l) { return layer_title(s.ui, l.name) == title; }))
            return name;
    }
}

// The layer as it is, changed in one respect.
template <class Fn>
void change(const LayerParts& s, Layer layer, Fn&& how) {
    how(layer);
    if (const Layer* now = s.table.find(layer.id); now && !(*now == layer)) change(s, stroke::changed(s.table, layer));
}

constexpr std::pair<ink::Blend, const char*> kBlends[] = {
    {ink::Blend::normal, "Normal"}, {ink::Blend::glaze, "Glazing"}, {ink::Blend::multiply, "Multiply"}};
constexpr const char* kBlendHint =
    "Normal: paint that covers and lets through. Glazing: only absorbs, as colour in clear varnish. Multiply: a filter "
    "of its colour";

void duplicate(const LayerParts& s, const Layer& layer) {
    change(s, stroke::duplicated(s.table, layer.id, stroke::free_name(s.table, layer.name + " copy")));
}

void merge(const LayerParts& s, const Layer& layer) {
    try {
        const stroke::LayerEdit edit = stroke::merged_down(s.table, layer.id);
        change(s, edit);
        s.layers.active = edit.other;
    } catch (const Error& error) {
        show_message(s.status, error.message());
    }
}

void begin_renaming(const LayerParts& s, const Layer& layer) {
    s.layers.list.renamed = layer.id;
    s.layers.list.focus = true;
}

void name_field(const LayerParts& s, const Layer& layer) {
    char name[stroke::kMaxNameBytes + 1];
    const std::string title = layer_title(s.ui, layer.name);
    std::snprintf(name, sizeof name, "%s", title.c_str());
    ImGui::SetNextItemWidth(-1);
    const bool appeared = s.layers.list.focus;
    if (appeared) ImGui::SetKeyboardFocusHere();
    const bool entered = ImGui::InputText("##name", name, sizeof name,
                                          ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    s.ui.mark("Layer name");
    // Out of sight it takes no focus: it is scrolled to first.
    if (appeared && !ImGui::IsItemVisible()) return ImGui::SetScrollHereY();
    s.layers.list.focus = false;
    if (!entered && (appeared || !ImGui::IsItemDeactivated())) return;
    s.layers.list.renamed = 0;
    // Escape leaves the text as it was.
    if (title != name && name[0]) change(s, layer, [&](Layer& l) { l.name = name; });
}

void context_menu(const LayerParts& s, const Layer& layer, std::size_t place) {
    Ui& ui = s.ui;
    const auto& all = s.table.layers;
    if (!ImGui::BeginPopupContextItem("menu")) return;
    ui.in_menu = true;
    s.layers.active = layer.id;
    if (ui.menu_item("Rename", "F2")) begin_renaming(s, layer);
    if (ui.menu_item("Duplicate", nullptr, false, all.size() < stroke::kMaxLayers)) duplicate(s, layer);
    if (ui.menu_item("Merge down", nullptr, false, place > 0)) merge(s, layer);
    if (ui.begin_menu("Blend")) {
        for (const auto& [blend, name] : kBlends)
            if (ui.menu_item(name, nullptr, layer.blend == blend))
                change(s, layer, [b = blend](Layer& l) { l.blend = b; });
        ImGui::EndMenu();
    }
    if (ui.menu_item("Locked", nullptr, layer.locked)) change(s, layer, [](Layer& l) { l.locked = !l.locked; });
    ImGui::Separator();
    if (ui.menu_item("Higher", nullptr, false, place + 1 < all.size()))
        change(s, stroke::moved(s.table, layer.id, static_cast<std::uint32_t>(place + 1)));
    if (ui.menu_item("Lower", nullptr, false, place > 0))
        change(s, stroke::moved(s.table, layer.id, static_cast<std::uint32_t>(place - 1)));
    ImGui::Separator();
    if (ui.menu_item("Remove layer", nullptr, false, all.size() > 1)) change(s, stroke::removed(layer.id));
    ui.in_menu = false;
    ImGui::EndPopup();
}

// A row is dragged onto another one and takes its place; the others make room.
void drag(const LayerParts& s, const Layer& layer, std::size_t place) {
    if (ImGui::BeginDragDropSource(ImGuiDragDropFlags_SourceNoHoldToOpenOthers)) {
        ImGui::SetDragDropPayload("layer", &layer.id, sizeof layer.id);
        ImGui::TextUnformatted(layer_title(s.ui, layer.name).c_str());
        ImGui::EndDragDropSource();
    }
    if (!ImGui::BeginDragDropTarget()) return;
    constexpr ImGuiDragDropFlags kOwnMark =
        ImGuiDragDropFlags_AcceptBeforeDelivery | ImGuiDragDropFlags_AcceptNoDrawDefaultRect;
    if (const ImGuiPayload* payload = ImGui::AcceptDragDropPayload("layer", kOwnMark)) {
        std::uint32_t id = 0;
        std::memcpy(&id, payload->Data, sizeof id);
        const auto& all = s.table.layers;
        const auto dragged = std::find_if(all.begin(), all.end(), [id](const Layer& l) { return l.id == id; });
        if (id != layer.id && dragged != all.end()) {
            // A line where the layer will be: over this row when it comes from below, else under it.
            const bool from_below = dragged - all.begin() < static_cast<std::ptrdiff_t>(place);
            const ImVec2 lo = ImGui::GetItemRectMin(), hi = ImGui::GetItemRectMax();
            const float y = from_below ? lo.y : hi.y;
            ImGui::GetWindowDrawList()->AddLine(ImVec2(lo.x, y), ImVec2(hi.x, y),
                                                ImGui::GetColorU32(ImGuiCol_CheckMark), s.ui.px(3));
            if (payload->IsDelivery()) change(s, stroke::moved(s.table, id, static_cast<std::uint32_t>(place)));
        }
    }
    ImGui::EndDragDropTarget();
}

// Opacity and blend of the chosen layer, and what is done with it most.
void details(const LayerParts& s, const Layer& layer, std::size_t place) {
    Ui& ui = s.ui;
    const auto& all = s.table.layers;
    if (s.layers.opacity < 0) s.layers.opacity = layer.opacity;
    ui.slider("Opacity", s.layers.opacity, {0, 1, "%.0f %%", 0.01}, "Of the whole layer over those below");
    if (ImGui::IsItemDeactivatedAfterEdit() && s.layers.opacity != layer.opacity)
        change(s, layer, [&](Layer& l) { l.opacity = s.layers.opacity; });
    if (!ImGui::IsItemActive()) s.layers.opacity = -1;
    const float third = (ImGui::GetContentRegionAvail().x / ui.settings().scale - 16) / 3;
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                        ImVec2(ui.px(2), ImGui::GetStyle().FramePadding.y));  // the words fill the buttons
    for (const auto& [blend, name] : kBlends) {
        if (blend != ink::Blend::normal) ImGui::SameLine();
        if (ui.choice(name, layer.blend == blend, kBlendHint, third))
            change(s, layer, [b = blend](Layer& l) { l.blend = b; });
    }
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(ui.px(4), ImGui::GetStyle().ItemSpacing.y));
    if (ui.button("Duplicate", "A copy right above it", 0, all.size() < stroke::kMaxLayers)) duplicate(s, layer);
    ImGui::SameLine();
    if (ui.button("Merge down", "Puts its films on the layer below; the appearance stays", 0, place > 0))
        merge(s, layer);
    ImGui::SameLine();
    const float rest = ImGui::GetContentRegionAvail().x / ui.settings().scale;
    if (ui.button("Remove", "With its strokes; Undo brings them back", rest, all.size() > 1))
        change(s, stroke::removed(layer.id));
    ImGui::PopStyleVar(2);
    bool locked = layer.locked;
    if (ui.toggle("Locked", locked, "Takes no strokes")) change(s, layer, [locked](Layer& l) { l.locked = locked; });
}

std::string row_text(const LayerParts& s, const Layer& layer) {
    std::string text = layer_title(s.ui, layer.name), more;
    const auto add = [&](const std::string& word) { more += (more.empty() ? "" : ", ") + word; };
    if (layer.blend != ink::Blend::normal) add(s.ui.tr(layer.blend == ink::Blend::glaze ? "Glazing" : "Multiply"));
    if (layer.opacity < 1) add(std::to_string(std::lround(100 * layer.opacity)) + " %");
    if (layer.locked) add(s.ui.tr("locked"));
    return more.empty() ? text : text + "\n" + more;
}

void row(const LayerParts& s, const Layer& layer, std::size_t place) {
    Ui& ui = s.ui;
    const float height = ui.px(kLayerHeight), middle = 0.5f * (height - ImGui::GetFrameHeight());
    const float top = ImGui::GetCursorPosY();
    ImGui::SetCursorPosY(top + middle);
    bool visible = layer.visible;
    if (ImGui::Checkbox("##visible", &visible)) change(s, layer, [visible](Layer& l) { l.visible = visible; });
    ui.mark("show " + layer.name);
    ui.hint("Seen or not");
    ImGui::SameLine();
    ImGui::SetCursorPosY(top);
    const bool chosen = layer.id == s.layers.active;
    if (s.layers.list.renamed == layer.id) {
        ImGui::SetCursorPosY(top + middle);
        name_field(s, layer);
        ImGui::SetCursorPosY(top + height + ImGui::GetStyle().ItemSpacing.y);
        return;
    }
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (ui.entry("##row", chosen, height)) {
        if (ImGui::IsMouseDoubleClicked(0))
            begin_renaming(s, layer);
        else {
            s.layers.show_details = chosen ? !s.layers.show_details : true;
            s.layers.active = layer.id;
            s.layers.opacity = -1;
        }
    }
    ui.mark("layer " + layer.name);
    context_menu(s, layer, place);
    drag(s, layer, place);
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const float width = height * 4 / 3;
    if (const auto texture = s.layers.list.textures.find(layer.id);
        texture != s.layers.list.textures.end() && s.layers.list.pictures.contains(layer.id))
        draw->AddImage(reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(texture->second)), at,
                       ImVec2(at.x + width, at.y + height));
    const std::string text = row_text(s, layer);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    draw->AddText(ImVec2(at.x + width + ui.px(8), at.y + 0.5f * (height - size.y)),
                  layer.visible ? ui.strong : ui.faint, text.c_str());
}

constexpr const char* kLayersHeight = "height of the rows";

// Rows take half of the panel at most, so that the journal below stays in reach; more of them scroll. Returns whether
// any of it is in sight.
bool begin_list(const LayerParts& s) {
    const float row = s.ui.px(kLayerHeight) + ImGui::GetStyle().ItemSpacing.y;
    const float whole = ImGui::GetStateStorage()->GetFloat(ImGui::GetID(kLayersHeight),
                                                           row * static_cast<float>(s.table.layers.size()));
    const float most = 0.5f * ImGui::GetWindowHeight(), width = ImGui::GetContentRegionAvail().x;
    ImGui::SetNextWindowContentSize(ImVec2(width, 0));  // the scrollbar has room beside the rows
    return ImGui::BeginChild("rows",
                             ImVec2(width + ImGui::GetStyle().ScrollbarSize + s.ui.px(2), std::min(whole, most)));
}

void end_list(bool seen) {
    const float whole = ImGui::GetCursorPosY() - ImGui::GetStyle().ItemSpacing.y;
    ImGui::EndChild();
    // Out of sight no row takes a height.
    if (seen) ImGui::GetStateStorage()->SetFloat(ImGui::GetID(kLayersHeight), whole);
}

// Brings the row just drawn into sight where its layer has become the active one. `key`: of the list's state.
void show_active(const Layer& layer, ImGuiID key) {
    ImGuiStorage* kept = ImGui::GetStateStorage();
    if (kept->GetInt(key, 0) == static_cast<int>(layer.id)) return;
    kept->SetInt(key, static_cast<int>(layer.id));
    if (!ImGui::IsItemVisible()) ImGui::SetScrollHereY();
}

}  // namespace

void layers_section(const LayerParts& s) {
    Ui& ui = s.ui;
    const auto& all = s.table.layers;
    if (all.empty()) return;
    ui.heading("Layers");
    ImGui::BeginDisabled(s.viewing);
    const bool seen = begin_list(s);
    const ImGuiID shown = ImGui::GetID("active layer that was shown");
    for (std::size_t i = seen ? all.size() : 0; i-- > 0;) {
        const Layer layer = all[i];
        ImGui::PushID(static_cast<int>(layer.id));
        row(s, layer, i);
        if (layer.id == s.layers.active) show_active(layer, shown);
        if (layer.id == s.layers.active && s.layers.show_details) details(s, layer, i);
        ImGui::PopID();
    }
    end_list(seen);
    if (ui.button("Add a layer", "Strokes on it can be shown, faded and moved apart from the others", 0,
                  all.size() < stroke::kMaxLayers))
        add_layer(s.layers, s.work, s.table, fresh_name(s));
    ImGui::EndDisabled();
}

}  // namespace tuft::app
