#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "app/panels.h"
#include "brush/tuft.h"
#include "core/units.h"
#include "ink/composite.h"
#include "ink/kubelka_munk.h"

namespace tuft::app {
namespace {

constexpr float kRackHeight = 76;

// The tuft's outline, ferrule above, tip below.
void draw_tuft_icon(Session& s, const brush::Preset& preset, ImVec2 at, float width, float height, bool chosen) {
    ImDrawList* draw = ImGui::GetWindowDrawList();
    constexpr double longest = 0.048;  // metres that fill the icon
    const auto scale = static_cast<float>(height * 0.78f / longest);
    const float x = at.x + 0.5f * width, top = at.y + 0.17f * height;
    const unsigned hair = chosen ? s.ui.accent : s.ui.strong;
    constexpr int n = 24;
    std::vector<ImVec2> outline;
    for (int side = 0; side < 2; ++side)
        for (int i = 0; i <= n; ++i) {
            const double u = static_cast<double>(side ? n - i : i) / n;
            const auto r = static_cast<float>(brush::rest_radius(preset, u)) * scale * (side ? -1.0f : 1.0f);
            outline.emplace_back(x + r, top + static_cast<float>(u * preset.length) * scale);
        }
    // Smoothed edges of the pieces would show between them: the outline smooths the whole.
    const ImDrawListFlags flags = draw->Flags;
    draw->Flags &= ~ImDrawListFlags_AntiAliasedFill;
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t j = outline.size() - 1 - i;
        draw->AddQuadFilled(outline[i], outline[i + 1], outline[j - 1], outline[j], hair);
    }
    draw->Flags = flags;
    draw->AddPolyline(outline.data(), static_cast<int>(outline.size()), hair, ImDrawFlags_Closed, 1.0f);
    const auto r = static_cast<float>(brush::rest_radius(preset, 0)) * scale * 1.15f;
    draw->AddRectFilled(ImVec2(x - r, at.y + 0.03f * height), ImVec2(x + r, top), IM_COL32(150, 104, 58, 255), 1.5f);
}

const brush::Preset& preset_of(const std::string& name) {
    static std::map<std::string, brush::Preset> known;
    auto at = known.find(name);
    if (at == known.end()) at = known.emplace(name, brush::load_preset(name)).first;
    return at->second;
}

void brush_rack(Session& s) {
    s.ui.heading("Brush");
    const float width = (ImGui::GetContentRegionAvail().x - 2 * ImGui::GetStyle().ItemSpacing.x) / 3;
    std::vector<std::string> names = s.brushes;
    std::stable_sort(names.begin(), names.end(), [](const std::string& a, const std::string& b) {
        const auto kind = [](const std::string& name) { return name.substr(0, name.find('-')); };
        return kind(a) != kind(b) ? kind(a) < kind(b) : preset_of(a).length < preset_of(b).length;
    });
    for (std::size_t i = 0; i < names.size(); ++i) {
        const std::string& name = names[i];
        if (i % 3) ImGui::SameLine();
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const bool chosen = name == s.brush;
        const float height = s.ui.px(kRackHeight);
        if (ImGui::InvisibleButton(name.c_str(), ImVec2(width, height))) s.brush = name;
        s.ui.mark(name);
        const bool over = ImGui::IsItemHovered();
        if (chosen || over)
            ImGui::GetWindowDrawList()->AddRectFilled(
                at, ImVec2(at.x + width, at.y + height),
                ImGui::GetColorU32(chosen ? ImGuiCol_FrameBgActive : ImGuiCol_FrameBg), s.ui.px(4));
        const brush::Preset& preset = preset_of(name);
        draw_tuft_icon(s, preset, at, width, height, chosen);
        if (over) {
            char text[256];
            std::snprintf(text, sizeof text, "%s\n%.0f mm long, %.1f mm thick", s.ui.tr(name.c_str()), preset.length * 1e3,
                          2 * preset.radius * 1e3);
            ImGui::SetTooltip("%s", text);
        }
    }
    ImGui::TextUnformatted(s.ui.tr(s.brush.c_str()));
}

void ink_palette(Session& s) {
    s.ui.heading("Ink");
    const float size = s.ui.px(30);
    const auto columns = static_cast<std::size_t>(std::max(1.0f, ImGui::GetContentRegionAvail().x / (size + ImGui::GetStyle().ItemSpacing.x)));
    for (std::size_t i = 0; i < s.inks.size(); ++i) {
        const std::string& name = s.inks[i];
        if (i % columns) ImGui::SameLine();
        const ImVec2 at = ImGui::GetCursorScreenPos();
        if (ImGui::InvisibleButton(("ink " + name).c_str(), ImVec2(size, size))) s.ink = name;
        s.ui.mark(name);
        ImDrawList* draw = ImGui::GetWindowDrawList();
        const ImVec2 centre(at.x + 0.5f * size, at.y + 0.5f * size);
        draw->AddCircleFilled(centre, 0.42f * size, ink_colour(name), 32);
        draw->AddCircle(centre, 0.42f * size, IM_COL32(128, 128, 128, 160), 32);
        if (name == s.ink) draw->AddCircle(centre, 0.5f * size, s.ui.accent, 32, s.ui.px(2));
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", s.ui.tr(name.c_str()));
    }
    ImGui::TextUnformatted(s.ui.tr(s.ink.c_str()));
}

// What is done with a brush between strokes.
void care_section(Session& s) {
    Ui& ui = s.ui;
    ui.toggle("Carry ink over", s.carry, "The brush runs dry as it paints, until it is dipped again; else every stroke begins with a full brush");
    if (!s.carry) return;
    const float third = (ImGui::GetContentRegionAvail().x / ui.settings().scale - 16) / 3;
    const auto act = [&](stroke::Action action) { s.painter->post(CareForBrush{action, s.brush, s.ink}); };
    if (ui.button("Dip", "Fills the brush with the chosen ink; what is in it stays and mixes", third)) act(stroke::Action::dip);
    ImGui::SameLine();
    if (ui.button("Rinse", "Washes it: no ink left, hair straight and together", third)) act(stroke::Action::rinse);
    ImGui::SameLine();
    if (ui.button("Comb", "Hair straight and together, the ink stays", third)) act(stroke::Action::reshape);
    ImGui::ProgressBar(static_cast<float>(s.last.fullness), ImVec2(-1, ui.px(6)), "");
    ui.hint("Ink left in the brush");
}

void hand_section(Session& s) {
    Ui& ui = s.ui;
    ui.heading("Hand");
    ui.slider("Pressure", s.hand.pressure, 0.02, 1, "%.2f", "How deep the brush is pressed at rest: part of half the hair's length. Keys [ and ]");
    ui.slider("Speed lightens", s.hand.speed_effect, 0, 1, "%.2f", "As a hand does. Only for a mouse; a pen says its own pressure");
    ui.slider("Rest deepens", s.hand.dwell_effect, 0, 1, "%.2f", "A mouse that stays where it is sinks in slowly");
    ui.slider("Stabiliser", s.hand.string, 0, 0.03, "%.1f mm", "The brush follows on a string of this length", kMillimetre);
    ui.slider("Pen softness", s.hand.pen_gamma, 0.4, 2.5, "%.2f", "Curve from the pen's force to the brush's depth");
    double right = s.hand.tilt.x, up = s.hand.tilt.y;
    ui.slider("Lean sideways", right, -60 * kDegree, 60 * kDegree, "%.0f\xc2\xb0", "Of the holder, seen on the screen. Arrow keys", kDegree);
    ui.slider("Lean away", up, -60 * kDegree, 60 * kDegree, "%.0f\xc2\xb0", "Of the holder, seen on the screen. Arrow keys", kDegree);
    s.hand.tilt = {right, up};
}

void symmetry_section(Session& s) {
    Ui& ui = s.ui;
    ui.heading("Symmetry");
    ui.toggle("X", s.symmetry.mirror_x, "Mirror left and right; the copy is painted anew and meets the model as it is there");
    ImGui::SameLine();
    ui.toggle("Y", s.symmetry.mirror_y, "Mirror front and back");
    ImGui::SameLine();
    ui.toggle("Z", s.symmetry.mirror_z, "Mirror above and below");
    double n = s.symmetry.radial;
    if (ui.slider("Copies round", n, 1, 16, "%.0f", "For plates and bowls; the axis stands upright through the middle"))
        s.symmetry.radial = static_cast<int>(std::lround(n));
}

void section_section(Session& s) {
    Ui& ui = s.ui;
    ui.heading("Look inside");
    ui.toggle("Cut open", s.view.section, "Hides a part of the model; the brush reaches what is behind");
    if (!s.view.section) return;
    static const char* axes[] = {"Across", "Along", "From above"};
    for (int k = 0; k < 3; ++k) {
        if (k) ImGui::SameLine();
        if (ui.choice(axes[k], s.view.section_axis == k)) s.view.section_axis = k;
    }
    ui.slider("What stays", s.view.section_at, 0.02, 1, "%.2f");
}

}  // namespace

unsigned ink_colour(const std::string& name) {
    static std::map<std::string, unsigned> known;
    if (const auto at = known.find(name); at != known.end()) return at->second;
    unsigned colour = IM_COL32(40, 40, 40, 255);
    try {
        const ink::Ink ink = ink::load_ink(name);
        int rgb[3];
        for (std::size_t band = 0; band < 3; ++band) {
            double k = 0, scatter = 0;
            for (const ink::InkPart& part : ink.parts) {
                k += part.fraction * part.pigment.k[band];
                scatter += part.fraction * part.pigment.s[band];
            }
            const double r = ink::over(ink::layer(k, scatter, ink.film), 0.88);
            rgb[band] = static_cast<int>(std::lround(255 * ink::srgb_encode(static_cast<float>(r))));
        }
        colour = IM_COL32(rgb[0], rgb[1], rgb[2], 255);
    } catch (const Error&) {
        // An unreadable preset is dark here and says why when it is painted with.
    }
    known[name] = colour;
    return colour;
}

void tool_panel(Session& s, float top, float bottom, float left) {
    ImGui::SetNextWindowPos(ImVec2(left, top));
    ImGui::SetNextWindowSize(ImVec2(s.ui.px(kToolWidth), bottom - top));
    ImGui::Begin("###tools", nullptr, ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                          ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
    const float half = (kToolWidth - 24 - 8) / 2 - (ImGui::GetScrollMaxY() > 0 ? 6.0f : 0.0f);
    if (s.ui.choice("Brush", s.tool == Tool::brush, "Paint freely (B)", half)) s.tool = Tool::brush;
    ImGui::SameLine();
    if (s.ui.choice("Line", s.tool == Tool::line, "Straight on the screen, from press to release (L)", half)) s.tool = Tool::line;
    brush_rack(s);
    ink_palette(s);
    care_section(s);
    hand_section(s);
    symmetry_section(s);
    section_section(s);
    ImGui::End();
}

}  // namespace tuft::app
