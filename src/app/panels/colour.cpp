#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "app/panels/panels.h"
#include "app/widgets/labels.h"
#include "ink/spectra/srgb.h"

/// \file
/// The window in which a person chooses a colour and sees the nearest mix of pigments.
namespace tuft::app {
namespace {

constexpr float kWidth = 276;   // pixels at a scale of 1
constexpr double kUnitUm = 10;  // micrometres of wet ink in a film unit

ink::Rgb linear_of(const std::array<float, 3>& srgb) {
    return {ink::srgb_decode(srgb[0]), ink::srgb_decode(srgb[1]), ink::srgb_decode(srgb[2])};
}

unsigned packed(const ink::Rgb& linear) {
    return IM_COL32(ink::code_of_linear(linear[0]), ink::code_of_linear(linear[1]), ink::code_of_linear(linear[2]),
                    255);
}

// A colour was chosen; with `take` the mix found for it goes into the brush.
void wish(Session& s, bool take) {
    ColourChoice& c = s.colours.choice;
    c.typed.hex = ink::to_hex(linear_of(c.wanted));
    c.take = take;
    c.finder.request({.colour = linear_of(c.wanted),
                      .substrate = s.colours.appearance.painted_on,
                      .film = c.free_film ? 0 : c.film,
                      .held = pigments_in_use(s.colours, s.journal.lines)});
}

void keep_hsv(ColourChoice& c) {
    float h = 0, sat = 0, v = 0;
    ImGui::ColorConvertRGBtoHSV(c.wanted[0], c.wanted[1], c.wanted[2], h, sat, v);
    // A grey has no hue, and black no saturation: those that there were stay.
    if (sat > 0.004f) c.hsv[0] = h;
    if (v > 0.004f) c.hsv[1] = sat;
    c.hsv[2] = v;
}

void wheel(Session& s) {
    ColourChoice& c = s.colours.choice;
    // As large as what is below leaves room for.
    const float all = ImGui::GetContentRegionAvail().x, side = std::clamp(c.wheel.room, 0.4f * all, all);
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 0.5f * (all - side));
    const float top = ImGui::GetCursorPosY();
    ImGui::SetNextItemWidth(side);
    constexpr ImGuiColorEditFlags flags = ImGuiColorEditFlags_PickerHueWheel | ImGuiColorEditFlags_NoSidePreview |
                                          ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_NoLabel |
                                          ImGuiColorEditFlags_NoAlpha | ImGuiColorEditFlags_NoOptions |
                                          ImGuiColorEditFlags_NoSmallPreview;
    if (ImGui::ColorPicker3("##wheel", c.wanted.data(), flags)) {
        keep_hsv(c);
        wish(s, true);
    }
    s.ui.mark("Colour wheel");
    c.wheel.height = ImGui::GetCursorPosY() - top;
}

void hex_field(Session& s) {
    ColourChoice& c = s.colours.choice;
    char text[16];
    std::snprintf(text, sizeof text, "%s", c.typed.hex.c_str());
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(s.ui.tr("Hex"));
    ImGui::SameLine();
    constexpr float kMode = 36, kGap = 4;  // beside a scrollbar the field gives way to them
    ImGui::SetNextItemWidth(
        std::clamp(ImGui::GetContentRegionAvail().x - 3 * s.ui.px(kMode + kGap), s.ui.px(48), s.ui.px(73)));
    const bool entered = ImGui::InputText("##hex", text, sizeof text, ImGuiInputTextFlags_EnterReturnsTrue);
    s.ui.mark("Hex");
    if (ImGui::IsItemActive() || entered) c.typed.hex = text;
    if (entered || ImGui::IsItemDeactivatedAfterEdit()) set_colour(s, c.typed.hex);
    static constexpr std::pair<ColourSliders, const char*> modes[] = {
        {ColourSliders::rgb, "RGB"}, {ColourSliders::hsv, "HSV"}, {ColourSliders::lab, "Lab"}};
    for (const auto& [mode, name] : modes) {
        ImGui::SameLine(0, s.ui.px(kGap));
        if (s.ui.choice(name, c.sliders == mode, nullptr, kMode)) c.sliders = mode;
    }
}

void sliders(Session& s) {
    ColourChoice& c = s.colours.choice;
    Ui& ui = s.ui;
    bool changed = false;
    std::array<double, 3> v;
    if (c.sliders == ColourSliders::rgb) {
        for (std::size_t i = 0; i < 3; ++i) v[i] = 255.0 * static_cast<double>(c.wanted[i]);
        changed |= ui.slider("Red", v[0], {0, 255, "%.0f"});
        changed |= ui.slider("Green", v[1], {0, 255, "%.0f"});
        changed |= ui.slider("Blue", v[2], {0, 255, "%.0f"});
        for (std::size_t i = 0; i < 3; ++i) c.wanted[i] = static_cast<float>(v[i] / 255);
        if (changed) keep_hsv(c);
    } else if (c.sliders == ColourSliders::hsv) {
        v = {360.0 * static_cast<double>(c.hsv[0]), static_cast<double>(c.hsv[1]), static_cast<double>(c.hsv[2])};
        changed |= ui.slider("Hue", v[0], {0, 360, "%.0f\xc2\xb0"});
        changed |= ui.slider("Saturation", v[1], {0, 1, "%.0f %%", 0.01});
        changed |= ui.slider("Value", v[2], {0, 1, "%.0f %%", 0.01});
        c.hsv = {static_cast<float>(v[0] / 360), static_cast<float>(v[1]), static_cast<float>(v[2])};
        if (changed) ImGui::ColorConvertHSVtoRGB(c.hsv[0], c.hsv[1], c.hsv[2], c.wanted[0], c.wanted[1], c.wanted[2]);
    } else {
        const ink::Rgb linear = linear_of(c.wanted);
        v = ink::lab_of_rgb(
            {static_cast<double>(linear[0]), static_cast<double>(linear[1]), static_cast<double>(linear[2])});
        changed |= ui.slider("Lightness", v[0], {0, 100, "%.0f"});
        changed |= ui.slider("Green - red", v[1], {-110, 110, "%.0f"});
        changed |= ui.slider("Blue - yellow", v[2], {-110, 110, "%.0f"});
        if (changed) {
            const std::array<double, 3> rgb = ink::rgb_of_lab(v);
            const ink::Rgb inside =
                ink::into_gamut({static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])});
            for (std::size_t i = 0; i < 3; ++i) c.wanted[i] = ink::srgb_encode(inside[i]);
            keep_hsv(c);
        }
    }
    if (changed) wish(s, true);
}

// Both colours side by side, how far they are apart, and the recipe.
void result(Session& s) {
    ColourChoice& c = s.colours.choice;
    Ui& ui = s.ui;
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, height = ui.px(30), middle = at.x + 0.5f * width;
    draw->AddRectFilled(at, ImVec2(middle, at.y + height), packed(linear_of(c.wanted)), ui.px(4),
                        ImDrawFlags_RoundCornersLeft);
    draw->AddRectFilled(ImVec2(middle, at.y), ImVec2(at.x + width, at.y + height),
                        packed(c.match ? c.match->reached : linear_of(c.wanted)), ui.px(4),
                        ImDrawFlags_RoundCornersRight);
    ImGui::Dummy(ImVec2(width, height));
    ImGui::TextDisabled("%s", ui.tr("Wanted"));
    ImGui::SameLine(0.5f * width + ImGui::GetStyle().WindowPadding.x);
    ImGui::TextDisabled("%s %s", ui.tr("Reached"), c.match ? ink::to_hex(c.match->reached).c_str() : "");
    if (!c.match) return;
    char text[160];
    std::snprintf(text, sizeof text,
                  "\xce\x94"
                  "E %.1f: %s",
                  c.match->delta_e, ui.tr(ink::difference_in_words(c.match->delta_e)));
    ui.wrapped(text);
    std::vector<std::string> parts;
    const auto add = [&](double fraction, const char* name) {
        if (!parts.empty()) parts.back() += ", ";
        std::snprintf(text, sizeof text, "%.3g %% %s", 100 * fraction, ui.tr(name));
        parts.emplace_back(text);
    };
    for (const ink::InkPart& part : c.match->ink.parts) add(part.fraction, pigment_key(part.pigment.name).c_str());
    if (const double water = 1 - c.match->ink.strength(); water > 5e-4) add(water, "water");
    if (!parts.empty()) parts.back() += " ";
    std::snprintf(text, sizeof text, "(%.0f \xce\xbcm, %s)", kUnitUm * c.match->ink.film,
                  ui.tr(s.colours.appearance.painted_on.c_str()));
    parts.emplace_back(text);
    ui.note(lines_of(parts, width, [](const std::string& line) { return ImGui::CalcTextSize(line.c_str()).x; }));
}

void recent(Session& s) {
    ColourChoice& c = s.colours.choice;
    if (c.recent.empty()) return;
    const float gap = s.ui.px(4), size = (ImGui::GetContentRegionAvail().x - 7 * gap) / 8;
    for (std::size_t i = 0; i < c.recent.size(); ++i) {
        if (i % 8) ImGui::SameLine(0, gap);
        const std::string hex = c.recent[i];
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const bool pressed = ImGui::InvisibleButton(("recent " + hex).c_str(), ImVec2(size, 0.7f * size));
        s.ui.mark("recent " + hex);
        ImGui::GetWindowDrawList()->AddRectFilled(at, ImVec2(at.x + size, at.y + 0.7f * size),
                                                  packed(*ink::colour_of_hex(hex)), s.ui.px(3));
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", hex.c_str());
        if (pressed) {
            set_colour(s, hex);
            break;
        }
    }
}

void save(Session& s) {
    ColourChoice& c = s.colours.choice;
    const ink::Ink* ink = find_ink(s.colours, s.brush.ink);
    char name[64];
    std::snprintf(name, sizeof name, "%s", c.typed.name.c_str());
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - s.ui.button_width("Save ink", 84) -
                            ImGui::GetStyle().ItemSpacing.x);
    if (ImGui::InputTextWithHint("##ink name", s.ui.tr("Name this ink"), name, sizeof name)) c.typed.name = name;
    s.ui.mark("Ink name");
    ImGui::SameLine();
    if (!s.ui.button("Save ink", "Keeps the ink in hand for every work, among your own", 84,
                     ink && !c.typed.name.empty()))
        return;
    try {
        ink::Ink own = *ink;
        stroke::check_name(c.typed.name, "ink");
        own.name = c.typed.name;
        save_own_ink(c, std::move(own));
        show_message(s.status, Message("Saved as {}", c.typed.name));
        c.typed.name.clear();
    } catch (const Error& error) {
        show_message(s.status, error.message());
    }
}

}  // namespace

void set_colour(Session& s, const std::string& hex) {
    const auto colour = ink::colour_of_hex(hex.starts_with('#') ? hex : "#" + hex);
    if (!colour) return show_message(s.status, "A colour is written #rrggbb, such as #c03020.");
    ColourChoice& c = s.colours.choice;
    for (std::size_t i = 0; i < 3; ++i) c.wanted[i] = ink::srgb_encode((*colour)[i]);
    keep_hsv(c);
    wish(s, true);
}

void colour_panel(Session& s) {
    ColourChoice& c = s.colours.choice;
    if (!c.shown || !s.paint_thread) return;
    Ui& ui = s.ui;
    begin_panel_over(
        ui, s.view.area,
        {.name = "colour", .across = s.preferences.ui.left_handed ? 1.0f : 0, .width = ui.px(kWidth), .moves = true});
    if (!c.match && !c.finder.busy()) wish(s, false);
    wheel(s);
    hex_field(s);
    sliders(s);
    if (ui.toggle("As thick as it needs", c.free_film,
                  "Else the film has the thickness below; a thicker one reaches more colours"))
        wish(s, true);
    if (!c.free_film && ui.slider("Film", c.film, {0.5, ink::kThickestMix, "%.0f \xce\xbcm", 1 / kUnitUm},
                                  "Thickness of the wet ink that a full brush leaves"))
        wish(s, true);
    result(s);
    const bool in_brush = c.match && s.brush.ink == c.match->ink.name;
    if (!in_brush && c.match &&
        ui.primary_button("Paint with it", ImGui::GetContentRegionAvail().x / ui.settings().scale))
        take_mix(s.colours, s.brush, c.match->ink);
    save(s);
    recent(s);
    if (ui.button("Close the wheel", nullptr, 0)) c.shown = false;
    const float below = ImGui::GetCursorPosY() + ImGui::GetStyle().WindowPadding.y - c.wheel.height;
    c.wheel.room = static_cast<float>(s.view.area.height) - 2 * ui.px(kPanelMargin) - below;
    ImGui::End();
}

}  // namespace tuft::app
