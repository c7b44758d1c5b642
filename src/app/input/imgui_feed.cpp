#include "app/input/imgui_feed.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>

namespace tuft::app {

void start_imgui_feed() {
    ImGuiIO& io = ImGui::GetIO();
    io.BackendPlatformName = "tuft";
    constexpr std::pair<ImGuiKey, int> keys[] = {{ImGuiKey_Tab, GLFW_KEY_TAB},
                                                 {ImGuiKey_LeftArrow, GLFW_KEY_LEFT},
                                                 {ImGuiKey_RightArrow, GLFW_KEY_RIGHT},
                                                 {ImGuiKey_UpArrow, GLFW_KEY_UP},
                                                 {ImGuiKey_DownArrow, GLFW_KEY_DOWN},
                                                 {ImGuiKey_PageUp, GLFW_KEY_PAGE_UP},
                                                 {ImGuiKey_PageDown, GLFW_KEY_PAGE_DOWN},
                                                 {ImGuiKey_Home, GLFW_KEY_HOME},
                                                 {ImGuiKey_End, GLFW_KEY_END},
                                                 {ImGuiKey_Insert, GLFW_KEY_INSERT},
                                                 {ImGuiKey_Delete, GLFW_KEY_DELETE},
                                                 {ImGuiKey_Backspace, GLFW_KEY_BACKSPACE},
                                                 {ImGuiKey_Space, GLFW_KEY_SPACE},
                                                 {ImGuiKey_Enter, GLFW_KEY_ENTER},
                                                 {ImGuiKey_Escape, GLFW_KEY_ESCAPE},
                                                 {ImGuiKey_KeyPadEnter, GLFW_KEY_KP_ENTER},
                                                 {ImGuiKey_A, GLFW_KEY_A},
                                                 {ImGuiKey_C, GLFW_KEY_C},
                                                 {ImGuiKey_V, GLFW_KEY_V},
                                                 {ImGuiKey_X, GLFW_KEY_X},
                                                 {ImGuiKey_Y, GLFW_KEY_Y},
                                                 {ImGuiKey_Z, GLFW_KEY_Z}};
    for (const auto& [key, code] : keys) io.KeyMap[key] = code;
}

std::vector<Event> feed_imgui(EventQueue& queue, int width, int height, double dt) {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = ImVec2(static_cast<float>(width), static_cast<float>(height));
    io.DeltaTime = static_cast<float>(std::clamp(dt, 1e-4, 0.25));
    std::vector<Event> events;
    const auto modifiers = [&](unsigned m) {
        io.KeyShift = (m & kShift) != 0;
        io.KeyCtrl = (m & kControl) != 0;
        io.KeyAlt = (m & kAlt) != 0;
    };
    for (bool more = true; more && !queue.empty();) {
        Event e = std::move(queue.front());
        queue.pop_front();
        const auto button = static_cast<std::size_t>(std::clamp(e.button, 0, 4));
        const bool known_key = e.key >= 0 && e.key < static_cast<int>(std::size(io.KeysDown));
        switch (e.kind) {
            case Event::Kind::press:
            case Event::Kind::release:
                io.MousePos = ImVec2(static_cast<float>(e.x), static_cast<float>(e.y));
                io.MouseDown[button] = e.kind == Event::Kind::press;
                modifiers(e.modifiers);
                more = false;
                break;
            case Event::Kind::move:
                io.MousePos = ImVec2(static_cast<float>(e.x), static_cast<float>(e.y));
                break;
            case Event::Kind::scroll:
                io.MouseWheel += static_cast<float>(e.steps);
                break;
            case Event::Kind::key_down:
            case Event::Kind::key_up:
                if (known_key) io.KeysDown[e.key] = e.kind == Event::Kind::key_down;
                modifiers(e.modifiers);
                more = e.kind == Event::Kind::key_up;
                break;
            case Event::Kind::text:
                io.AddInputCharactersUTF8(e.text.c_str());
                break;
            case Event::Kind::hover_end:
                io.MousePos = ImVec2(-1e30f, -1e30f);
                break;
            case Event::Kind::drop:
            case Event::Kind::resize:
            case Event::Kind::fly:
            case Event::Kind::cap_button:
            case Event::Kind::focus:
            case Event::Kind::focus_lost:
                break;
        }
        events.push_back(std::move(e));
    }
    return events;
}

}  // namespace tuft::app
