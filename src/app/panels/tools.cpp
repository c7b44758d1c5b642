#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "app/panels/panels.h"
#include "brush/tuft/tuft.h"
#include "core/system/files.h"
#include "core/text/units.h"

namespace tuft::app {
namespace {

// Pixels of a brush at a scale of 1, by the room that there is.
constexpr float kRackHeights[] = {54, 40, 30};

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

void brush_cell(Ui& ui, BrushSettings& brush, const std::string& name, const std::string& sort, ImVec2 size) {
    const auto [width, height] = size;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool chosen = name == brush::sized_name(brush.preset).base;
    if (ImGui::InvisibleButton(name.c_str(), ImVec2(width, height))) brush.preset = name;
    ui.mark(name);
    const bool over = ImGui::IsItemHovered();
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const ImVec2 end(at.x + width, at.y + height);
    if (chosen || over)
        draw->AddRectFilled(at, end, ImGui::GetColorU32(chosen ? ImGuiCol_Header : ImGuiCol_FrameBgHovered), ui.px(4));
    if (chosen) draw->AddRect(at, end, ui.accent, ui.px(4), 0, ui.px(2));
    const brush::Preset& preset = shipped_brush(name);
    draw_tuft_icon(ui, preset, hair_colour(sort), at, width, height);
    if (!over) return;
    char text[256];
    if (brush::has_broad_side(preset))
        std::snprintf(text, sizeof text, ui.tr("%.0f mm long, %.0f mm wide, %.1f mm thick"), preset.length * 1e3,
                      preset.width * 1e3, 2 * preset.radius * 1e3);
    else
        std::snprintf(text, sizeof text, ui.tr("%.0f mm long, %.1f mm thick"), preset.length * 1e3,
                      2 * preset.radius * 1e3);
    ImGui::SetTooltip("%s\n%s", ui.tr(name.c_str()), text);
}

// All brushes hang in rows, a group for each sort of hair from small to large, its name under it; sorts with a single
// brush are a group together.
Savings brush_rack(Ui& ui, BrushSettings& brush, ToolRoom room) {
    if (!ui.section("Brush", true, ui.tr(brush::sized_name(brush.preset).base.c_str()))) return {};
    std::map<std::string, std::vector<std::string>> by_sort;
    for (const std::string& name : brush.presets) by_sort[name.substr(0, name.find('-'))].push_back(name);
    std::vector<std::pair<std::string, std::vector<std::string>>> groups;
    std::vector<std::string> single, wide;
    for (auto& [sort, names] : by_sort) {
        if (names.size() == 1)
            (brush::has_broad_side(shipped_brush(names.front())) ? wide : single).push_back(names.front());
        else
            groups.emplace_back(sort, names);
    }
    if (!wide.empty()) groups.emplace_back("flat", wide);
    if (!single.empty()) groups.emplace_back("other", single);
    const bool named = room != ToolRoom::tight;
    const float all = ImGui::GetContentRegionAvail().x, left = ImGui::GetCursorPosX(), gap = named ? ui.px(8) : 0,
                letters = 0.8f * ImGui::GetFontSize();
    // Tufts are thin: as many fit in a row as have room for one each. Where there is little, they stand group by group
    // without a gap.
    const float cell = std::min(ui.px(26), (all - 3 * gap) / (named ? 10.0f : 11.0f)),
                height = ui.px(kRackHeights[static_cast<int>(room)]);
    const float row = height + (named ? 1.2f * letters : 0);
    float x = 0, y = ImGui::GetCursorPosY(), rows = 1;
    for (auto& [sort, names] : groups) {
        std::sort(names.begin(), names.end(), [](const std::string& a, const std::string& b) {
            return shipped_brush(a).length < shipped_brush(b).length;
        });
        const char* title = ui.tr(sort.c_str());
        const float text = ImGui::GetFont()->CalcTextSizeA(letters, 1e9f, 0, title).x;
        const float width = cell * static_cast<float>(names.size()), taken = std::max(width, text);
        if (named && x > 0 && x + width > all + 1) x = 0, y += row, ++rows;
        const float here = x;
        for (const std::string& name : names) {
            if (x + cell > all + 1) x = 0, y += row, ++rows;
            ImGui::SetCursorPos(ImVec2(left + x, y));
            brush_cell(ui, brush, name, name.substr(0, name.find('-')), {cell, height});
            x += cell;
        }
        if (!named) continue;
        x = here + taken + gap;
        ImGui::SetCursorPos(ImVec2(left + here, y + height));
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float middle = std::min(at.x + 0.5f * (width - text), at.x + all - here - text);
        ImGui::GetWindowDrawList()->AddText(ImGui::GetFont(), letters, ImVec2(middle, at.y), ui.faint, title);
    }
    ImGui::SetCursorPos(ImVec2(left, y + row));
    ImGui::Dummy(ImVec2(0, 0));
    return {rows * ui.px(kRackHeights[0] - kRackHeights[1]),
            rows * (ui.px(kRackHeights[0] - kRackHeights[2]) + 1.2f * letters)};
}

// The curve from a pen's pressure to the brush's depth; its ends and its middle can be dragged. The dot
// is what the pen does now.
void pen_curve(Ui& ui, ToolState& tools, int& handle) {
    PointerSettings& h = tools.pointer;
    const ImVec2 at = ImGui::GetCursorScreenPos(), size(ImGui::GetContentRegionAvail().x, ui.px(96));
    ImGui::InvisibleButton("pen curve", size);
    ui.mark("Pen curve");
    const bool held = ImGui::IsItemActive();
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const float pad = ui.px(8);
    const auto place = [&](double x, double y) {
        return ImVec2(at.x + pad + static_cast<float>(x) * (size.x - 2 * pad),
                      at.y + size.y - pad - static_cast<float>(y) * (size.y - 2 * pad));
    };
    const double x = std::clamp(static_cast<double>((mouse.x - at.x - pad) / (size.x - 2 * pad)), 0.0, 1.0);
    const double y = std::clamp(static_cast<double>((at.y + size.y - pad - mouse.y) / (size.y - 2 * pad)), 0.02, 0.98);
    const double middle = 0.5 * (h.pen_least + h.pen_full);
    if (ImGui::IsItemActivated()) {
        const double to_least = std::abs(x - h.pen_least) + y, to_full = std::abs(x - h.pen_full) + 1 - y;
        const double to_middle = std::abs(x - middle) + std::abs(y - std::pow(0.5, h.pen_gamma));
        handle = to_middle <= std::min(to_least, to_full) ? 1 : to_least < to_full ? 0 : 2;
    }
    if (held && handle == 0) h.pen_least = std::min(x, h.pen_full - 0.1);
    if (held && handle == 2) h.pen_full = std::max(x, h.pen_least + 0.1);
    if (held && handle == 1) h.pen_gamma = std::clamp(std::log(y) / std::log(0.5), 0.25, 4.0);
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0)) h.pen_least = 0, h.pen_full = 1, h.pen_gamma = 1;
    ui.hint("Drag its ends and its middle; a double click makes it straight");
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled(at, ImVec2(at.x + size.x, at.y + size.y), ImGui::GetColorU32(ImGuiCol_FrameBg), ui.px(4));
    for (int i = 1; i < 4; ++i) {
        draw->AddLine(place(0.25 * i, 0), place(0.25 * i, 1), ImGui::GetColorU32(ImGuiCol_Separator));
        draw->AddLine(place(0, 0.25 * i), place(1, 0.25 * i), ImGui::GetColorU32(ImGuiCol_Separator));
    }
    ImVec2 points[49];
    for (int i = 0; i < 49; ++i) points[i] = place(i / 48.0, pen_depth(h, i / 48.0));
    draw->AddPolyline(points, 49, ui.accent, 0, ui.px(2));
    for (const ImVec2& p : {place(h.pen_least, 0), place(middle, std::pow(0.5, h.pen_gamma)), place(h.pen_full, 1)})
        draw->AddCircleFilled(p, ui.px(4.5f), ui.strong);
    if (tools.pen_pressure >= 0) {
        const ImVec2 dot = place(std::min(1.0, tools.pen_pressure), pen_depth(h, tools.pen_pressure));
        draw->AddLine(dot, place(std::min(1.0, tools.pen_pressure), 0), IM_COL32(255, 176, 32, 160), ui.px(1));
        draw->AddCircleFilled(dot, ui.px(5), IM_COL32(255, 176, 32, 255));
    }
}

// How a wide ferrule is turned about the holder's axis.
void roll_controls(Ui& ui, PointerSettings& pointer) {
    ui.slider("Roll", pointer.roll, {-180 * kDegree, 180 * kDegree, "%.0f\xc2\xb0", kDegree},
              "Of the holder about itself: at 0 the broad side lies across the screen. Alt and wheel, Shift and arrow "
              "keys; a pen that can turn adds its own");
    ui.toggle("Follow the stroke", pointer.roll_follow, "The broad side turns across the stroke as it goes on");
}

// The roll of a wide ferrule, the pen's force, and how the holder leans.
void pointer_section(Ui& ui, ToolState& tools, PanelLayout& panels, bool wide) {
    if (wide) roll_controls(ui, tools.pointer);
    if (!ui.section("Pen and holder", false)) return;
    double right = tools.pointer.tilt.x, up = tools.pointer.tilt.y;
    ui.slider("Lean sideways", right, {-60 * kDegree, 60 * kDegree, "%.0f\xc2\xb0", kDegree},
              "Of the holder, seen on the screen. Arrow keys");
    ui.slider("Lean away", up, {-60 * kDegree, 60 * kDegree, "%.0f\xc2\xb0", kDegree},
              "Of the holder, seen on the screen. Arrow keys");
    tools.pointer.tilt = {right, up};
    ui.note(ui.tr("Pen: from its force to the brush's depth"));
    pen_curve(ui, tools, panels.pen_curve_handle);
}

void symmetry_section(Ui& ui, stroke::Symmetry& symmetry) {
    if (!ui.section("Symmetry", false)) return;
    ui.toggle("X", symmetry.mirror_x,
              "Mirror left and right; the copy is painted anew and meets the model as it is there");
    ImGui::SameLine();
    ui.toggle("Y", symmetry.mirror_y, "Mirror front and back");
    ImGui::SameLine();
    ui.toggle("Z", symmetry.mirror_z, "Mirror above and below");
    double n = symmetry.radial;
    if (ui.slider("Radial copies", n, {1, 16, "%.0f"},
                  "For plates and bowls; the axis stands upright through the middle"))
        symmetry.radial = static_cast<int>(std::lround(n));
}

void section_section(Ui& ui, SectionView& section) {
    if (!ui.section("Look inside", false)) return;
    ui.toggle("Cut open", section.on, "Hides a part of the model; the brush reaches what is behind");
    if (!section.on) return;
    static const char* axes[] = {"Across", "Along", "From above"};
    for (int k = 0; k < 3; ++k) {
        if (k) ImGui::SameLine();
        if (ui.choice(axes[k], section.axis == k)) section.axis = k;
    }
    ui.slider("What stays", section.position, {0.02, 1, "%.2f"});
}

}  // namespace

// The place in millimetres: of the drawing at the cursor, until one is typed.
void place_fields(Ui& ui, ToolState& tools) {
    const float gap = ImGui::GetStyle().ItemSpacing.x, width = (ImGui::GetContentRegionAvail().x - 2 * gap) / 3;
    static constexpr const char* kNames[] = {"Place x", "Place y", "Place z"};
    for (std::size_t k = 0; k < 3; ++k) {
        if (k > 0) ImGui::SameLine();
        ImGui::SetNextItemWidth(width);
        ImGui::InputDouble((std::string("##") + kNames[k]).c_str(), &tools.place_mm[k], 0, 0, "%.1f");
        ui.mark(kNames[k]);
        ui.hint("Place of its middle, millimetres");
    }
    if (ui.button("Place it there", "At the place in the fields, with width and turn as they are", 0))
        tools.place_typed = true;
}

namespace {

void writing_section(Ui& ui, ToolState& tools, FileDialog& files) {
    if (tools.active != Tool::writing) return;
    Writing& w = tools.writing;
    const float all = ImGui::GetContentRegionAvail().x, inside = all - 2 * ImGui::GetStyle().FramePadding.x;
    // The button is named by what is in hand.
    const std::string name = w.file.filename().string();
    const std::string title = w.empty() ? ui.tr("Writing or drawing...") : ui.fitted(name, inside);
    if (ImGui::Button((title + "##writing").c_str(), ImVec2(all, 0)))
        files.show(FileDialog::Purpose::writing, data_folder() / "samples" / "strokes");
    ui.mark("Writing or drawing...");
    ui.hint(w.empty() ? "InkML or SVG" : "Another one, InkML or SVG");
    if (w.empty()) return;
    for (const Message& note : w.notes) ui.note(ui.sentence(note));
    ui.toggle("Mirrored", w.mirrored);
    ImGui::SameLine();
    ui.toggle("Snap", tools.snap, "To the plane of symmetry and level with other drawings; Ctrl places it freely");
    ImGui::SameLine();
    ui.toggle("mm", tools.shows_place, "Place in millimetres");
    if (tools.shows_place) place_fields(ui, tools);
    const bool names =
        std::any_of(w.traces.begin(), w.traces.end(), [](const auto& t) { return !t.brush.empty() || !t.ink.empty(); });
    if (names) ui.toggle("Its brush and ink", w.own_ink, "As the file names them; strokes scale with the drawing");
    if (has_widths(w)) ui.toggle("Its line widths", w.own_width, "The brush is taken in the size that draws them");
}

}  // namespace

void begin_side_panel(Ui& ui, const char* name, const SidePanel& panel) {
    const auto& [left, top, bottom, width, scrolls] = panel;
    const float pad = ImGui::GetStyle().WindowPadding.x, all = ui.px(width);
    ImGui::SetNextWindowPos(ImVec2(left, top));
    ImGui::SetNextWindowSize(ImVec2(all, bottom - top));
    ImGui::SetNextWindowContentSize(
        ImVec2(all - pad - std::max(pad, scrolls ? ImGui::GetStyle().ScrollbarSize + ui.px(6) : 0), 0));
    // The window is cleared to the panels' colour; to blend it over that again costs a software driver milliseconds.
    ImGui::Begin(name, nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | (scrolls ? 0 : ImGuiWindowFlags_NoScrollbar));
    ImGui::GetBackgroundDrawList()->AddRect(ImVec2(left, top), ImVec2(left + all, bottom),
                                            ImGui::GetColorU32(ImGuiCol_Border));
}

void tool_panel(Session& s, float top, float bottom, float left) {
    begin_side_panel(s.ui, "###tools", {left, top, bottom});
    const ToolRoom room = s.panels.tool_room;
    Savings saves;
    const auto add = [&saves](const Savings& more) { saves.compact += more.compact, saves.tight += more.tight; };
    writing_section(s.ui, s.tools, s.dialogs.file);
    mask_section(s);
    const bool brushes = s.tools.active != Tool::fill && s.tools.active != Tool::pick && s.tools.active != Tool::mask;
    if (brushes) add(brush_rack(s.ui, s.brush, room));
    if (s.tools.active != Tool::mask && s.tools.active != Tool::eraser)
        add(ink_section({s.ui, s.brush, s.colours, *s.paint_thread, s.reported, s.dialogs.file}, room));
    if (brushes) pointer_section(s.ui, s.tools, s.panels, brush_can_be_turned(s.brush));
    if (brushes) symmetry_section(s.ui, s.tools.symmetry);
    section_section(s.ui, s.view.section);
    const float height = ImGui::GetCursorPosY() + ImGui::GetStyle().WindowPadding.y, there = bottom - top;
    const float full = height + (room == ToolRoom::compact ? saves.compact : room == ToolRoom::tight ? saves.tight : 0);
    s.panels.tool_room = full <= there                   ? ToolRoom::full
                         : full - saves.compact <= there ? ToolRoom::compact
                                                         : ToolRoom::tight;
    ImGui::End();
}

namespace {

// A narrow button in the middle of an edge of the view, with a triangle that points to where the panel goes or comes
// from.
void handle(Session& s, const char* name, const char* hint, float x, bool to_left, bool& shown) {
    Ui& ui = s.ui;
    const float width = ui.px(11), height = ui.px(46),
                y = static_cast<float>(s.view.area.y) + 0.5f * (static_cast<float>(s.view.area.height) - height);
    ImGui::SetNextWindowPos(ImVec2(x, y));
    ImGui::SetNextWindowSize(ImVec2(width, height));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, ui.px(3));
    ImGui::SetNextWindowBgAlpha(0.75f);
    ImGui::Begin((std::string("###handle ") + name).c_str(), nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoBringToFrontOnFocus);
    const bool pressed = ImGui::InvisibleButton("##handle", ImVec2(width, height));
    ui.mark(name);
    ui.hint(hint);
    const ImVec2 c(x + 0.5f * width, y + 0.5f * height);
    const float r = ui.px(3.5f), tip = to_left ? -r : r;
    ImGui::GetWindowDrawList()->AddTriangleFilled(ImVec2(c.x + tip, c.y), ImVec2(c.x - tip, c.y - 1.3f * r),
                                                  ImVec2(c.x - tip, c.y + 1.3f * r),
                                                  ImGui::IsItemHovered() ? ui.strong : ui.faint);
    ImGui::End();
    ImGui::PopStyleVar(4);
    if (!pressed) return;
    shown = !shown;
    store_settings(s);
}

}  // namespace

void panel_handles(Session& s) {
    const bool beside =
        !s.journal.snapshots.compared.empty() && !s.journal.snapshots.swipe && s.journal.snapshots.width > 0;
    const auto left = static_cast<float>(beside ? s.journal.snapshots.x : s.view.area.x);
    const auto right = static_cast<float>(s.view.atlas.shown ? s.view.atlas.area.x + s.view.atlas.area.width
                                                             : s.view.area.x + s.view.area.width) -
                       s.ui.px(11);
    const bool swapped = s.preferences.ui.left_handed;
    handle(s, "Fold the tools", "Puts the settings of the tools away, or brings them back (Tab: all panels)",
           swapped ? right : left, s.panels.show_tools != swapped, s.panels.show_tools);
    if (s.panels.journal_fits)
        handle(s, "Fold the journal", "Puts the journal away, or brings it back (Tab: all panels)",
               swapped ? left : right, s.panels.show_journal == swapped, s.panels.show_journal);
}

}  // namespace tuft::app
