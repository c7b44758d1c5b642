#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/document/pictures/small_picture.h"
#include "app/panels/panels.h"
#include "app/widgets/icons.h"
#include "io/image/image.h"

/// Reference images over the view, and their list.
namespace tuft::app {
namespace {

constexpr int kMostAcross = 2048;  // pixels of a texture
constexpr float kCorner = 16;      // pixels of the corner that changes the size

void keep_reference(Session& s, const ReferenceImage& r) {
    if (s.reported.file.viewing) return;  // it is moved and hidden in this window alone
    s.paint_thread->post(AttachToProject{io::kReferences, to_attachment(r)});
}

unsigned reference_texture(Session& s, ReferenceImage& r) {
    if (r.texture || r.broken) return r.texture;
    try {
        const io::Image8 image = io::decode_image8(r.bytes, r.name, std::size_t{1} << 26);
        r.pixels_across = image.width;
        r.pixels_down = image.height;
        upload(r.texture, small_picture(image, kMostAcross));
    } catch (const std::exception& error) {
        r.broken = true;
        show_message(s.status, message_of(error));
    }
    return r.texture;
}

void remove_reference(Session& s, std::size_t i) {
    ReferenceImage& r = s.view.references.images[i];
    release(r.texture);
    s.paint_thread->post(DetachFromProject{io::kReferences, r.id});
    s.view.references.images.erase(s.view.references.images.begin() + static_cast<std::ptrdiff_t>(i));
}

bool remove_button(const Session& s) {
    ImGui::BeginDisabled(s.reported.file.viewing);
    const bool pressed = ImGui::Button("\xc3\x97", ImVec2(ImGui::GetFrameHeight(), 0));
    ImGui::EndDisabled();
    return pressed;
}

// A part of it stays in the view, wherever it is dragged.
void keep_in_view(ReferenceImage& r, double aspect) {
    r.width = std::clamp(r.width, kLeastReference, kMostReference);
    r.at.x = std::clamp(r.at.x, 0.04 - r.width, 0.96);
    r.at.y = std::clamp(r.at.y, 0.04 - r.width * aspect, 0.94);
}

// The bar over an image that the cursor is on.
bool image_bar(Session& s, ReferenceImage& r, float width) {
    Ui& ui = s.ui;
    bool removed = false;
    ImGui::SetCursorPos(ImVec2(ui.px(6), ui.px(6)));
    ImGui::BeginGroup();
    ImGui::PushStyleColor(ImGuiCol_FrameBg, IM_COL32(30, 30, 32, 210));
    ImGui::SetNextItemWidth(std::max(ui.px(40), std::min(ui.px(120), width - ui.px(90))));
    auto opacity = static_cast<float>(100 * r.opacity);
    if (ImGui::SliderFloat("##opacity", &opacity, 5, 100, "%.0f %%", ImGuiSliderFlags_AlwaysClamp))
        r.opacity = static_cast<double>(opacity) / 100;
    if (ImGui::IsItemDeactivatedAfterEdit()) keep_reference(s, r);
    ui.mark("Opacity of " + r.name);
    ImGui::PopStyleColor();
    ImGui::SameLine(0, ui.px(4));
    removed = remove_button(s);
    ui.mark("Unpin " + r.name);
    ui.hint("Takes the image off; the file stays where it is");
    ImGui::EndGroup();
    return removed;
}

/// Moves or resizes the image of the current item with the mouse. `end`: its lower right corner, pixels.
void drag_reference(Session& s, ReferenceImage& r, std::size_t index, const ImVec2& end) {
    References& all = s.view.references;
    const ImVec2 mouse = ImGui::GetIO().MousePos, delta = ImGui::GetIO().MouseDelta;
    const float corner = s.ui.px(kCorner);
    const bool grabbed = ImGui::IsItemActivated();
    if (grabbed) {
        all.held = index;
        all.sizing = mouse.x > end.x - corner && mouse.y > end.y - corner;
    }
    if (all.held == index && ImGui::IsItemActive() && !grabbed) {
        const double across = static_cast<double>(delta.x) / static_cast<double>(s.view.area.width),
                     down = static_cast<double>(delta.y) / static_cast<double>(s.view.area.height);
        if (all.sizing)
            r.width += across;
        else
            r.at += Vec2(across, down);
    }
    if (ImGui::IsItemDeactivated() && all.held == index) {
        all.held.reset();
        keep_reference(s, r);
    }
}

// One image as a window of its own; true when it is to go.
bool draw_reference(Session& s, ReferenceImage& r, std::size_t index) {
    Ui& ui = s.ui;
    const unsigned texture = reference_texture(s, r);
    if (!r.shown || !texture || r.pixels_across <= 0) return false;
    const auto across = static_cast<double>(s.view.area.width), down = static_cast<double>(s.view.area.height);
    const double aspect =
        across * r.pixels_down / r.pixels_across / down;  // its height in parts of the view's, for a width of 1
    keep_in_view(r, aspect);
    const ImVec2 at(static_cast<float>(s.view.area.x + r.at.x * across),
                    static_cast<float>(s.view.area.y + r.at.y * down));
    const ImVec2 size(static_cast<float>(r.width * across), static_cast<float>(r.width * aspect * down));
    ImGui::SetNextWindowPos(at);
    ImGui::SetNextWindowSize(size);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(4, 4));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
    ImGui::Begin(("###reference " + r.id).c_str(), nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoBackground |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoScrollWithMouse);
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const ImVec2 end(at.x + size.x, at.y + size.y);
    draw->AddImage(reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(texture)), at, end, ImVec2(0, 0),
                   ImVec2(1, 1), IM_COL32(255, 255, 255, static_cast<int>(std::lround(255 * r.opacity))));
    const bool over = ImGui::IsWindowHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem);
    const float corner = ui.px(kCorner);
    ImGui::SetCursorPos(ImVec2(0, 0));
    ImGui::InvisibleButton("##move", size);
    ImGui::SetItemAllowOverlap();
    ui.mark("reference " + r.name);
    drag_reference(s, r, index, end);
    bool removed = false;
    if (over) {
        draw->AddRect(at, end, ui.accent, 0, 0, ui.px(1.5f));
        draw->AddTriangleFilled(ImVec2(end.x, end.y - corner), end, ImVec2(end.x - corner, end.y), ui.accent);
        if (size.x > ui.px(110) && size.y > ui.px(60)) removed = image_bar(s, r, size.x);
        if (const float wheel = ImGui::GetIO().MouseWheel; wheel != 0) {
            r.width = std::clamp(r.width * std::pow(1.06, static_cast<double>(wheel)), kLeastReference, kMostReference);
            keep_reference(s, r);
        }
    }
    ImGui::End();
    ImGui::PopStyleVar(3);
    return removed;
}

}  // namespace

void references_over_view(Session& s) {
    References& all = s.view.references;
    if (all.hidden || !s.paint_thread) return;
    for (std::size_t i = 0; i < all.images.size(); ++i)
        if (draw_reference(s, all.images[i], i)) {
            remove_reference(s, i);
            break;
        }
}

void references_section(Session& s) {
    Ui& ui = s.ui;
    if (!ui.section("References", false)) return;
    References& all = s.view.references;
    for (std::size_t i = 0; i < all.images.size(); ++i) {
        ReferenceImage& r = all.images[i];
        ImGui::PushID(r.id.c_str());
        if (ImGui::Checkbox("##shown", &r.shown)) keep_reference(s, r);
        ui.mark("show " + r.name);
        ImGui::SameLine();
        ImGui::AlignTextToFramePadding();
        const float right = ImGui::GetFrameHeight() + ui.px(6), room = ImGui::GetContentRegionAvail().x - right;
        const float x = ImGui::GetCursorPosX();
        ImGui::TextUnformatted(ui.fitted(r.name, room).c_str());
        ImGui::SameLine(x + room + ui.px(6));
        const bool gone = remove_button(s);
        ui.mark("remove " + r.name);
        ui.hint("Takes the image off; the file stays where it is");
        ImGui::PopID();
        if (gone) return remove_reference(s, i);
    }
    if (ui.button("Add an image...", "Pins it over the view, to paint after. It is kept in the project", 0,
                  !s.reported.file.viewing))
        s.dialogs.file.show(FileDialog::Purpose::reference, {});
    if (all.images.empty()) return;
    ImGui::SameLine();
    ui.toggle("Hide all", all.hidden);
}

}  // namespace tuft::app
