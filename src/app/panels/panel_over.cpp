#include "app/panels/panel_over.h"

#include <imgui.h>

#include <algorithm>
#include <string>

namespace tuft::app {
namespace {

// A panel that was dragged, or whose view has changed.
void keep_in_room(ImVec2 from, ImVec2 room) {
    const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    const float right = from.x + room.x - size.x, low = from.y + room.y - ImGui::GetFrameHeight();
    const ImVec2 kept(std::clamp(at.x, from.x, std::max(from.x, right)),
                      std::clamp(at.y, from.y, std::max(from.y, low)));
    if (kept.x != at.x || kept.y != at.y) ImGui::SetWindowPos(kept);
}

}  // namespace

bool begin_panel_over(const Ui& ui, const Area& area, const PanelOver& panel) {
    const float pad = ui.px(kPanelMargin);
    const ImVec2 from(static_cast<float>(area.x) + pad, static_cast<float>(area.y) + pad),
        room(static_cast<float>(area.width) - 2 * pad, static_cast<float>(area.height) - 2 * pad);
    const float width = std::min(panel.width, room.x), height = std::min(panel.height, room.y);
    // A size that is not known yet counts by the pivot, which a later move would drop.
    ImGui::SetNextWindowPos(ImVec2(from.x + panel.across * (room.x - width), from.y + panel.down * (room.y - height)),
                            panel.moves ? ImGuiCond_Appearing : ImGuiCond_Always,
                            ImVec2(panel.width > 0 ? 0 : panel.across, panel.height > 0 ? 0 : panel.down));
    ImGui::SetNextWindowSizeConstraints(ImVec2(width, height),
                                        ImVec2(panel.width > 0 ? width : room.x, panel.height > 0 ? height : room.y));
    ImGui::SetNextWindowBgAlpha(panel.alpha);
    const ImGuiWindowFlags flags =
        ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
        ImGuiWindowFlags_AlwaysAutoResize | (panel.has_bar ? 0 : ImGuiWindowFlags_NoTitleBar) |
        (panel.moves ? 0 : ImGuiWindowFlags_NoMove) | (panel.below ? ImGuiWindowFlags_NoBringToFrontOnFocus : 0) |
        (panel.takes_input ? 0 : ImGuiWindowFlags_NoInputs);
    const std::string name = (panel.has_bar ? ui.tr(panel.name) : std::string()) + "###" + panel.name;
    const bool seen = ImGui::Begin(name.c_str(), panel.shown, flags);
    if (panel.moves) keep_in_room(from, room);
    return seen;
}

}  // namespace tuft::app
