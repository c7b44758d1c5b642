#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "app/panels/panels.h"
#include "app/widgets/file_list.h"
#include "brush/tuft/tuft.h"
#include "pictures/tried_stroke.h"

/// \file
/// The rack of brushes, and the window with all of them, each with its silhouette and a tried stroke.
namespace tuft::app {
namespace {

using pictures::TriedStroke;

constexpr float kTriedHeights[] = {30, 26, 22};  // pixels at a scale of 1, by the room that there is
constexpr float kAspect = static_cast<float>(TriedStroke::kWidth) / TriedStroke::kHeight;
constexpr float kCardHeight = 70, kCardIcon = 28;  // pixels at a scale of 1
constexpr float kBrowserWidth = 580, kLeastCard = 160;

// Pixels of a brush at a scale of 1, by the room that there is.
constexpr float kRackHeights[] = {50, 40, 30};

// Sorts of hair as they look, sRGB; a brush of another sort is grey.
unsigned hair_colour(const std::string& sort) {
    if (sort == "goat") return IM_COL32(240, 236, 226, 255);
    if (sort == "wolf") return IM_COL32(196, 128, 62, 255);
    if (sort == "sponge" || sort == "leaf") return IM_COL32(226, 190, 112, 255);
    if (sort == "mixed") return IM_COL32(222, 184, 138, 255);
    return IM_COL32(170, 172, 178, 255);
}

// A wide tuft from its broad side: from edge to edge of the ferrule the end of its hair, which leans in a fan.
void draw_wide_tuft_icon(const Ui& ui, const brush::Preset& preset, unsigned hair, ImVec2 at, float width,
                         float height) {
    ImDrawList* draw = ImGui::GetWindowDrawList();
    constexpr double longest = 0.052;
    const double widest = preset.width + 2 * preset.length * std::sin(preset.splay);
    const auto scale = static_cast<float>(std::min(height * 0.74 / longest, (width - ui.px(3)) / widest));
    const float x = at.x + 0.5f * width, top = at.y + 0.19f * height;
    constexpr int n = 24;
    std::vector<ImVec2> roots, ends;
    for (int i = 0; i <= n; ++i) {
        const double s = 2.0 * i / n - 1, lean = preset.splay * s;
        const double toe = preset.toe * (1 - std::sqrt(std::max(0.0, 1 - s * s)));
        const double length = preset.length - toe - 0.5 * preset.slant * (1 - s);
        const auto root = x + static_cast<float>(0.5 * preset.width * s) * scale;
        roots.emplace_back(root, top);
        ends.emplace_back(root + static_cast<float>(length * std::sin(lean)) * scale,
                          top + static_cast<float>(length * std::cos(lean)) * scale);
    }
    const ImDrawListFlags flags = draw->Flags;
    draw->Flags &= ~ImDrawListFlags_AntiAliasedFill;
    for (std::size_t i = 0; i < n; ++i) draw->AddQuadFilled(roots[i], roots[i + 1], ends[i + 1], ends[i], hair);
    draw->Flags = flags;
    std::vector<ImVec2> outline = roots;
    outline.insert(outline.end(), ends.rbegin(), ends.rend());
    draw->AddPolyline(outline.data(), static_cast<int>(outline.size()), IM_COL32(70, 52, 36, 255), ImDrawFlags_Closed,
                      1.0f);
    const float half = static_cast<float>(0.5 * preset.width) * scale + ui.px(0.8f);
    draw->AddRectFilled(ImVec2(x - half, at.y + 0.11f * height), ImVec2(x + half, top), IM_COL32(150, 152, 160, 255),
                        1.5f);
    draw->AddRectFilled(ImVec2(x - 0.4f * half, at.y + 0.02f * height), ImVec2(x + 0.4f * half, at.y + 0.11f * height),
                        IM_COL32(122, 78, 38, 255), 1.5f);
}

// The tuft's outline, ferrule above, tip below.
void draw_tuft_icon(const Ui& ui, const brush::Preset& preset, unsigned hair, ImVec2 at, float width, float height) {
    if (brush::has_broad_side(preset)) return draw_wide_tuft_icon(ui, preset, hair, at, width, height);
    ImDrawList* draw = ImGui::GetWindowDrawList();
    constexpr double longest = 0.048;  // metres that fill the icon
    const bool foam = brush::is_foam(preset);
    const auto most = foam ? (width - ui.px(3)) / static_cast<float>(2.7 * preset.radius) : 1e9f;
    const auto scale = std::min(static_cast<float>(height * 0.74f / longest), most);
    const float x = at.x + 0.5f * width, top = at.y + 0.19f * height;
    constexpr int n = 24;
    std::vector<ImVec2> outline;
    for (int side = 0; side < 2; ++side)
        for (int i = 0; i <= n; ++i) {
            const double u = static_cast<double>(side ? n - i : i) / n;
            // A little wider than to scale, so that small ones are seen.
            const auto r =
                (static_cast<float>(brush::rest_radius(preset, u)) * 1.35f * scale + (u < 0.97 ? ui.px(0.8f) : 0)) *
                (side ? -1.0f : 1.0f);
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
    draw->AddPolyline(outline.data(), static_cast<int>(outline.size()), IM_COL32(70, 52, 36, 255), ImDrawFlags_Closed,
                      1.0f);
    const auto r = static_cast<float>(brush::rest_radius(preset, 0)) * scale * (foam ? 0.35f : 1.5f) + ui.px(0.8f);
    if (foam) {
        // Its pores, on a spiral.
        for (int i = 1; i < 22; ++i) {
            const float turn = 2.4f * static_cast<float>(i), out = 0.19f * std::sqrt(static_cast<float>(i));
            const auto half = 1.35f * static_cast<float>(preset.radius) * scale,
                       tall = 0.5f * static_cast<float>(preset.length) * scale;
            draw->AddCircleFilled(ImVec2(x + out * half * std::cos(turn), top + tall + out * tall * std::sin(turn)),
                                  ui.px(0.6f + 0.4f * static_cast<float>(i % 3)), IM_COL32(122, 84, 36, 255), 6);
        }
    }
    draw->AddRectFilled(ImVec2(x - r, at.y + 0.05f * height), ImVec2(x + r, top), IM_COL32(122, 78, 38, 255), 1.5f);
}

std::string size_text(const Ui& ui, const brush::Preset& preset) {
    char text[256];
    if (brush::has_broad_side(preset))
        std::snprintf(text, sizeof text, ui.tr("%.0f mm long, %.0f mm wide, %.1f mm thick"), preset.length * 1e3,
                      preset.width * 1e3, 2 * preset.radius * 1e3);
    else
        std::snprintf(text, sizeof text, ui.tr("%.0f mm long, %.1f mm thick"), preset.length * 1e3,
                      2 * preset.radius * 1e3);
    return text;
}

/// Length, width and thickness as short as they fit on a card.
std::string card_size(const brush::Preset& preset) {
    char text[64];
    if (brush::has_broad_side(preset))
        std::snprintf(text, sizeof text, "%.0f \xc3\x97 %.0f \xc3\x97 %.1f mm", preset.length * 1e3, preset.width * 1e3,
                      2 * preset.radius * 1e3);
    else
        std::snprintf(text, sizeof text, "%.0f \xc3\x97 \xc3\x98 %.1f mm", preset.length * 1e3,
                      2 * preset.radius * 1e3);
    return text;
}

std::string sort_of(const std::string& name) {
    return name.substr(0, name.find('-'));
}

/// A tried stroke, or the empty sheet until it is painted.
void draw_tried(const Ui& ui, BrushSettings& brush, const std::string& name, ImVec2 at, float width) {
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const ImVec2 end(at.x + width, at.y + width / kAspect);
    if (const unsigned texture = brush.tried.texture(name, brush.shelf.at(name).reading))
        draw->AddImageRounded(reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(texture)), at, end, ImVec2(0, 0),
                              ImVec2(1, 1), IM_COL32_WHITE, ui.px(3));
    else
        draw->AddRectFilled(at, end, IM_COL32(241, 238, 230, 60), ui.px(3));
}

/// Name, size and tried stroke of the brush under the cursor; or why it cannot be taken.
void brush_tooltip(const Ui& ui, BrushSettings& brush, const std::string& name) {
    const ShelfBrush& there = brush.shelf.at(name);
    const float width = ui.px(224);
    ImGui::BeginTooltip();
    ImGui::TextUnformatted(ui.title(name).c_str());
    if (!there.fault.empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, ui.wrong);
        ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + width);
        ImGui::TextUnformatted(ui.sentence(there.fault).c_str());
        ImGui::PopTextWrapPos();
        ImGui::PopStyleColor();
        ImGui::EndTooltip();
        return;
    }
    ImGui::PushStyleColor(ImGuiCol_Text, ui.faint);
    ImGui::TextUnformatted(size_text(ui, there.preset).c_str());
    ImGui::PopStyleColor();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::Dummy(ImVec2(width, width / kAspect));
    draw_tried(ui, brush, name, at, width);
    ImGui::EndTooltip();
}

void choose(Session& s, const std::string& name) {
    try {
        take_brush(s.brush, name);
    } catch (const Error& error) {
        show_message(s.status, error.message());
    }
}

/// The tuft as it hangs there: pale where it cannot be taken.
void draw_hanging(Session& s, const std::string& name, ImVec2 at, float width, float height) {
    const ShelfBrush& there = s.brush.shelf.at(name);
    draw_tuft_icon(s.ui, there.preset, hair_colour(sort_of(name)), at, width, height);
    if (!there.fault.empty())
        ImGui::GetWindowDrawList()->AddRectFilled(at, ImVec2(at.x + width, at.y + height),
                                                  ImGui::GetColorU32(ImGuiCol_WindowBg, 0.75f));
}

/// Marks what is chosen or under the cursor. Returns whether the cursor is on it.
bool draw_choice(const Ui& ui, ImVec2 at, ImVec2 end, bool chosen) {
    const bool over = ImGui::IsItemHovered();
    ImDrawList* draw = ImGui::GetWindowDrawList();
    if (chosen || over)
        draw->AddRectFilled(at, end, ImGui::GetColorU32(chosen ? ImGuiCol_Header : ImGuiCol_FrameBgHovered), ui.px(4));
    if (chosen) draw->AddRect(at, end, ui.accent, ui.px(4), 0, ui.px(2));
    return over;
}

bool is_chosen(const BrushSettings& brush, const std::string& name) {
    return name == brush::sized_name(brush.preset).base;
}

void brush_cell(Session& s, const std::string& name, ImVec2 size) {
    Ui& ui = s.ui;
    const ImVec2 at = ImGui::GetCursorScreenPos(), end(at.x + size.x, at.y + size.y);
    if (ImGui::InvisibleButton(name.c_str(), size)) choose(s, name);
    ui.mark(name);
    const bool over = draw_choice(ui, at, end, is_chosen(s.brush, name));
    draw_hanging(s, name, at, size.x, size.y);
    if (over) brush_tooltip(ui, s.brush, name);
}

/// All brushes in rows, a group for each family, its name under it. Where there is little room, they stand group by
/// group without a gap. Returns the number of rows; without `draws` nothing else.
float rack_rows(Session& s, const std::vector<BrushFamily>& families, ToolDensity room, bool draws) {
    const Ui& ui = s.ui;
    const bool named = room != ToolDensity::tight;
    const float all = ImGui::GetContentRegionAvail().x, left = ImGui::GetCursorPosX(), gap = named ? ui.px(8) : 0,
                letters = 0.8f * ImGui::GetFontSize();
    // Tufts are thin: as many fit in a row as have room for one each.
    const float cell = std::min(ui.px(26), (all - 3 * gap) / (named ? 10.0f : 12.0f)),
                height = ui.px(kRackHeights[static_cast<int>(room)]);
    const float row = height + (named ? 1.2f * letters : 0);
    float x = 0, y = ImGui::GetCursorPosY(), rows = 1;
    for (const BrushFamily& family : families) {
        const char* title = ui.tr(family.title.c_str());
        const float text = ImGui::GetFont()->CalcTextSizeA(letters, 1e9f, 0, title).x;
        const float width = cell * static_cast<float>(family.names.size()), taken = std::max(width, text);
        if (named && x > 0 && x + taken > all + 1) x = 0, y += row, ++rows;
        const float here = x, indent = named ? 0.5f * (taken - width) : 0;
        x += std::max(0.0f, indent);
        for (const std::string& name : family.names) {
            if (x + cell > all + 1) x = 0, y += row, ++rows;
            if (draws) {
                ImGui::SetCursorPos(ImVec2(left + x, y));
                brush_cell(s, name, {cell, height});
            }
            x += cell;
        }
        if (!named) continue;
        x = here + taken + gap;
        if (!draws) continue;
        ImGui::SetCursorPos(ImVec2(left + here, y + height));
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImGui::GetWindowDrawList()->AddText(ImGui::GetFont(), letters, ImVec2(at.x + 0.5f * (taken - text), at.y),
                                            ui.faint, title);
    }
    if (!draws) return rows;
    ImGui::SetCursorPos(ImVec2(left, y + row));
    ImGui::Dummy(ImVec2(0, 0));
    return rows;
}

/// The tried stroke of the brush in hand, and the button that opens the window with all of them.
void tried_row(Session& s, float height) {
    Ui& ui = s.ui;
    const std::string name = brush::sized_name(s.brush.preset).base;
    const float width = height * kAspect, all = ImGui::GetContentRegionAvail().x, gap = ImGui::GetStyle().ItemSpacing.x;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (ImGui::InvisibleButton("##tried", ImVec2(width, height))) s.panels.show_brushes = !s.panels.show_brushes;
    draw_tried(ui, s.brush, name, at, width);
    if (ImGui::IsItemHovered()) brush_tooltip(ui, s.brush, name);
    ImGui::SameLine();
    const ImVec2 button(all - width - gap, height);
    if (ImGui::Button((std::string(ui.tr("All...")) + "##brushes").c_str(), button))
        s.panels.show_brushes = !s.panels.show_brushes;
    ui.mark("All brushes");
    ui.hint("All brushes with a stroke of each; own ones from a file");
}

/// A small button in a card's corner. Returns true where the brush is to go.
bool forget_button(Ui& ui, const std::string& name, ImVec2 corner) {
    const float side = ui.px(18);
    const ImVec2 after = ImGui::GetCursorScreenPos();
    ImGui::SetCursorScreenPos(ImVec2(corner.x - side, corner.y));
    const bool pressed = ImGui::InvisibleButton(("forget " + name).c_str(), ImVec2(side, side));
    ui.mark("forget " + name);
    ui.hint("Takes the brush off the list; its file stays where it is");
    const ImVec2 c(corner.x - 0.5f * side, corner.y + 0.5f * side);
    const float r = ui.px(3.5f);
    const unsigned colour = ImGui::IsItemHovered() ? ui.strong : ui.faint;
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddLine(ImVec2(c.x - r, c.y - r), ImVec2(c.x + r, c.y + r), colour, ui.px(1.5f));
    draw->AddLine(ImVec2(c.x - r, c.y + r), ImVec2(c.x + r, c.y - r), colour, ui.px(1.5f));
    ImGui::SetCursorScreenPos(after);
    return pressed;
}

/// A brush with name, size and tried stroke.
void brush_card(Session& s, const std::string& name, float width) {
    Ui& ui = s.ui;
    const ShelfBrush& there = s.brush.shelf.at(name);
    const bool own = is_own_brush(name), faulty = !there.fault.empty();
    const float height = ui.px(kCardHeight), pad = ui.px(4), icon = ui.px(kCardIcon);
    const ImVec2 at = ImGui::GetCursorScreenPos(), end(at.x + width, at.y + height);
    if (ImGui::InvisibleButton(("card " + name).c_str(), ImVec2(width, height))) choose(s, name);
    if (own) ImGui::SetItemAllowOverlap();
    ui.mark("card " + name);
    if (draw_choice(ui, at, end, is_chosen(s.brush, name)) && !ui.modal)
        ImGui::SetTooltip("%s", faulty ? ui.sentence(there.fault).c_str() : size_text(ui, there.preset).c_str());
    draw_hanging(s, name, ImVec2(at.x + pad, at.y + pad), icon, height - 2 * pad);
    const float x = at.x + icon + 2 * pad, letters = 0.8f * ImGui::GetFontSize(), room = width - icon - 3 * pad;
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->PushClipRect(at, end, true);
    draw->AddText(ImVec2(x, at.y + ui.px(1)), faulty ? ui.faint : ui.strong,
                  ui.fitted(ui.title(name), own ? room - ui.px(16) : room).c_str());
    const float stroke = std::min(room, (height - ImGui::GetTextLineHeight() - letters - ui.px(5)) * kAspect);
    if (!faulty) draw_tried(ui, s.brush, name, ImVec2(x, at.y + ImGui::GetTextLineHeight() + ui.px(2)), stroke);
    const ImVec2 last(x, end.y - letters - ui.px(3));
    if (faulty) {
        const bool gone = own && !there.written;
        draw->AddText(ImGui::GetFont(), letters, last, ui.wrong,
                      ui.tr(gone ? "The file is missing" : "Cannot be read"));
        ui.mark_at((gone ? "missing " : "damaged ") + name, last.x, last.y);
    } else {
        draw->AddText(ImGui::GetFont(), letters, last, is_chosen(s.brush, name) ? ui.strong : ui.faint,
                      card_size(there.preset).c_str());
    }
    draw->PopClipRect();
    if (own && forget_button(ui, name, ImVec2(end.x, at.y))) forget_own_brush(s.brush, std::string(name));
}

/// Whether a brush is looked for by these letters: in its name, or in its name in the language of the interface.
bool is_wanted(const Ui& ui, const std::string& name, const std::string& letters) {
    return lower(name).find(letters) != std::string::npos || lower(ui.title(name)).find(letters) != std::string::npos;
}

void family_cards(Session& s, const BrushFamily& family, const std::string& letters) {
    std::vector<std::string> names;
    for (const std::string& name : family.names)
        if (is_wanted(s.ui, name, letters) || lower(s.ui.tr(family.title.c_str())).find(letters) != std::string::npos)
            names.push_back(name);
    if (names.empty()) return;
    s.ui.heading(family.title.c_str());
    const float all = ImGui::GetContentRegionAvail().x, gap = s.ui.px(6);
    const int columns = std::max(1, static_cast<int>((all + gap) / (s.ui.px(kLeastCard) + gap)));
    const float width = (all - gap * static_cast<float>(columns - 1)) / static_cast<float>(columns);
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i % static_cast<std::size_t>(columns) != 0) ImGui::SameLine(0, gap);
        brush_card(s, names[i], width);
    }
}

void browser_top(Session& s) {
    Ui& ui = s.ui;
    const float button = ui.button_width("From a file...", 96);
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - button - ImGui::GetStyle().ItemSpacing.x);
    ImGui::InputTextWithHint("##brush filter", ui.tr("Name"), s.panels.brush_filter, sizeof s.panels.brush_filter);
    ui.mark("Brush filter");
    ImGui::SameLine();
    if (ui.button("From a file...", "A brush of your own: a TOML file, as tuft brush calibrate writes it"))
        s.dialogs.file.show(FileDialog::Purpose::brush, "");
}

}  // namespace

Savings brush_rack(Session& s, ToolDensity room) {
    Ui& ui = s.ui;
    const std::string chosen = ui.title(brush::sized_name(s.brush.preset).base);
    if (!ui.section("Brush", true, chosen.c_str())) return {};
    // By the rows of each way, or the panel would go to and fro between two that each seem to have room for the other.
    const std::vector<BrushFamily> families = s.brush.shelf.families(s.brush.presets);
    const float named = rack_rows(s, families, ToolDensity::full, false),
                tight = rack_rows(s, families, ToolDensity::tight, false);
    rack_rows(s, families, room, true);
    tried_row(s, ui.px(kTriedHeights[static_cast<int>(room)]));
    const float letters = 0.8f * ImGui::GetFontSize();
    return {named * ui.px(kRackHeights[0] - kRackHeights[1]) + ui.px(kTriedHeights[0] - kTriedHeights[1]),
            named * (ui.px(kRackHeights[0]) + 1.2f * letters) - tight * ui.px(kRackHeights[2]) +
                ui.px(kTriedHeights[0] - kTriedHeights[2])};
}

void brush_browser(Session& s) {
    if (!s.panels.show_brushes) return;
    Ui& ui = s.ui;
    if (begin_panel_over(ui, s.view.area,
                         {.name = "Brushes",
                          .width = ui.px(kBrowserWidth),
                          .height = static_cast<float>(s.view.area.height),
                          .has_bar = true,
                          .moves = true,
                          .shown = &s.panels.show_brushes})) {
        browser_top(s);
        const std::string letters = lower(s.panels.brush_filter);
        ImGui::BeginChild("##cards");
        for (const BrushFamily& family : s.brush.shelf.families(s.brush.presets)) family_cards(s, family, letters);
        ImGui::EndChild();
    }
    ImGui::End();
}

}  // namespace tuft::app
