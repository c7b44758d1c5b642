#include <imgui.h>

#include <algorithm>

#include "app/dialogs/dialogs.h"

namespace tuft::app {
namespace {

void mouse_rows(Ui& ui, Keymap keymap) {
    const bool maya = keymap == Keymap::maya;
    const std::pair<const char*, const char*> rows[] = {
        {"Left button", "Paint"},
        {maya ? "Alt + left" : "Middle, right, Alt + left", "Turn the view"},
        {maya ? "Alt + middle" : "Shift + middle", "Move the view"},
        {maya ? "Alt + right, wheel" : "Ctrl + middle, wheel", "Nearer and further"},
        {"Ctrl + wheel", "Roll the view"},
        {"Enter   Backspace   Esc", "Curve: paint it, remove a point, drop it"},
        {"Esc while painting", "Take the stroke in hand back"},
    };
    for (const auto& [key, what] : rows) {
        ImGui::TextUnformatted(ui.tr(what));
        ImGui::SameLine(ui.px(300));
        ImGui::TextDisabled("%s", ui.tr(key));
    }
}

void key_rows(Ui& ui, const KeyTable& keys, std::optional<Action>& to_assign) {
    for (int i = 0; i < static_cast<int>(Action::count); ++i) {
        const auto action = static_cast<Action>(i);
        ImGui::PushID(i);
        ImGui::AlignTextToFramePadding();
        ImGui::TextUnformatted(ui.tr(title_of(action)));
        ImGui::SameLine(ui.px(300));
        const bool assigning = to_assign == action;
        const std::string name = assigning                             ? ui.tr("press a key...")
                                 : name_of(keys.chord(action)).empty() ? "\xe2\x80\x93"
                                                                       : name_of(keys.chord(action));
        if (assigning) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_Header));
        if (ImGui::Button((name + "##chord").c_str(), ImVec2(ui.px(150), 0)))
            to_assign = assigning ? std::nullopt : std::optional(action);
        if (assigning) ImGui::PopStyleColor();
        ui.mark(std::string("key ") + word_of(action));
        ImGui::PopID();
    }
}

}  // namespace

void keys_dialog(Session& s) {
    if (!s.dialogs.show_keys) return;
    if (!begin_dialog(s.ui, "Keys and mouse", 520)) return end_dialog(s.ui);
    Ui& ui = s.ui;
    const float screen = ImGui::GetIO().DisplaySize.y;
    ImGui::BeginChild("keys", ImVec2(0, std::min(ui.px(460), screen - ui.px(150))));
    ui.heading("Mouse");
    mouse_rows(ui, s.preferences.keymap);
    ui.heading("Keys");
    ui.note(ui.tr("Click a key to change it."));
    key_rows(ui, s.preferences.keys, s.dialogs.key_to_assign);
    ImGui::EndChild();
    ImGui::Dummy(ImVec2(0, ui.px(4)));
    ui.buttons_at_right({{"Reset", 130}, {"Close", 110}});
    if (ui.button("Reset", nullptr, 130, !s.preferences.keys.shipped())) {
        s.preferences.keys = {};
        store_settings(s);
    }
    ImGui::SameLine();
    const bool close = ui.button("Close", nullptr, 110);
    end_dialog(s.ui);
    if (close) s.dialogs.show_keys = false, s.dialogs.key_to_assign.reset();
}

}  // namespace tuft::app
