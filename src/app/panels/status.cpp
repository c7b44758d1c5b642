#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/panels/panels.h"
#include "app/view/tuft_solid.h"
#include "ink/composite/composite.h"

namespace tuft::app {

namespace {

constexpr float kInsetWidth = 190;  // pixels at a scale of 1

// As much of it as there is room for; the rest under the cursor.
void one_line(const Session& s, const std::string& text, float room) {
    const std::string shown = s.ui.fitted(text, std::max(0.0f, room));
    ImGui::TextUnformatted(shown.c_str());
    if (shown == text || !ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(s.ui.px(420));
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

struct ToolText {
    const char *name, *hint;
};

// What the left button does now.
ToolText text_of_tool(const Session& s) {
    if (s.journal.move_on_drag) return {"Move", "Drag the chosen ink over the model    Esc: leave it"};
    switch (s.tools.active) {
        case Tool::brush:
            return {"Brush", "Drag: paint    [ and ]: pressure    Shift: size"};
        case Tool::line:
            return {"Line", "Drag: a line    Shift: steps of 15\xc2\xb0    Drag its ends: change it"};
        case Tool::curve:
            return {"Curve", "Click: set points    Enter: paint    Esc: drop them"};
        case Tool::writing:
            return {"Place", s.tools.writing.empty() ? "Choose writing or a drawing in the panel"
                             : s.tools.writing.along == BandLine::edge
                                 ? "Click beside an edge: copies along it    Wheel: size"
                             : s.tools.writing.along != BandLine::none
                                 ? "Click: copies along the line    Wheel: size"
                                 : "Click: place it    Wheel: size    Shift + wheel: turn"};
        case Tool::text:
            return {"Write", s.tools.lettering.empty() ? "Type a text in its panel"
                                                       : "Click: write it    Wheel: size    Shift + wheel: turn"};
        case Tool::eraser:
            return {"Eraser", "Drag: take ink off    [ and ]: pressure"};
        case Tool::fill:
            return {"Fill", s.tools.fill.region == stroke::Region::all    ? "Click: fill the model"
                            : s.tools.fill.region == stroke::Region::part ? "Click: fill the part there"
                                                                          : "Click: fill the chart there"};
        case Tool::pick:
            return {"Pick", "Click: the ink there becomes one of your own"};
        case Tool::mask:
            return {"Mask", s.masks.choice.kind == stroke::MaskKind::lasso ? "Draw round a part of the model"
                                                                           : "Click on the model to make a mask"};
    }
    return {"", ""};
}

// Text after what is on the line already, as far as it fits before `end`.
void put(const Session& s, const std::string& text, unsigned colour, float end) {
    ImGui::SameLine(0, s.ui.px(16));
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    one_line(s, text, end - ImGui::GetCursorScreenPos().x);
    ImGui::PopStyleColor();
}

struct Notice {
    std::string text;
    unsigned colour = 0;
};

// What went wrong, or what was just done; "": nothing.
Notice notice_of(const Session& s) {
    const Ui& ui = s.ui;
    if (!s.reported.file.trouble.empty()) {
        const std::size_t n = s.reported.file.unsaved;
        std::string waits;
        if (n > 0)
            waits = " (" + ui.sentence(Message(n == 1 ? "{} stroke waits in memory" : "{} strokes wait in memory", n)) +
                    ")";
        return {ui.tr("Not kept on disk") + waits + ": " + ui.sentence(s.reported.file.trouble), ui.wrong};
    }
    // As long as it takes to read it.
    const std::string text = ui.sentence(s.status.text);
    if (s.status.seconds > std::max(12.0, 0.12 * static_cast<double>(text.size()))) return {};
    return {text, ui.strong};
}

// A notice that is longer than the line: in a box over the view's lower edge, all of it.
void notice_box(const Session& s, const Notice& notice) {
    const Ui& ui = s.ui;
    const float room = std::min(static_cast<float>(s.view.area.width) - 2 * ui.px(kPanelMargin), ui.px(620));
    const float wrap = room - 2 * ImGui::GetStyle().WindowPadding.x;
    begin_panel_over(ui, s.view.area, {.name = "notice", .across = 0.5f, .down = 1, .takes_input = false});
    ImGui::PushStyleColor(ImGuiCol_Text, notice.colour);
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + wrap);
    ImGui::TextUnformatted(notice.text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
    ImGui::End();
}

// How the view is moved, and what the atlas is.
void put_hints(const Session& s) {
    const Ui& ui = s.ui;
    char text[160] = "";
    if (s.paint_thread) {
        const stroke::Model& m = s.paint_thread->model();
        std::snprintf(text, sizeof text, ui.tr("%u \xc3\x97 %u   %.2f mm/texel"), m.atlas.size, m.atlas.size,
                      m.atlas.texel_size * 1e3);
    }
    const float x = ImGui::GetIO().DisplaySize.x - ImGui::CalcTextSize(text).x - ui.px(14);
    // The wheel sizes a drawing or a text that is being placed.
    const bool wheel_is_taken = (s.tools.active == Tool::writing && !s.tools.writing.empty()) ||
                                (s.tools.active == Tool::text && !s.tools.lettering.empty());
    put(s,
        ui.tr(s.preferences.keymap == Keymap::blender
                  ? (wheel_is_taken ? "Middle or right: turn    Shift + middle: move    F1: keys"
                                    : "Middle or right: turn    Shift + middle: move    Wheel: nearer    F1: keys")
                  : "Alt + left: turn    Alt + middle: move    Alt + right: nearer    F1: keys"),
        ui.faint, x - ui.px(16));
    if (ImGui::GetItemRectMax().x + ui.px(12) >= x) return;
    ImGui::SameLine(x);
    ImGui::TextDisabled("%s", text);
}

}  // namespace

void status_bar(Session& s, float top) {
    const Ui& ui = s.ui;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(0, top));
    ImGui::SetNextWindowSize(ImVec2(screen.x, screen.y - top));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(ui.px(12), ui.px(6)));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::Begin("###status", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBringToFrontOnFocus);
    s.status.seconds += ImGui::GetIO().DeltaTime;
    const float end = screen.x - ui.px(12);
    const ToolText tool = text_of_tool(s);
    ImGui::TextUnformatted(ui.tr(tool.name));
    put(s, ui.tr(tool.hint), ui.faint, end);
    const Notice notice = notice_of(s);
    const float room = end - ImGui::GetItemRectMax().x - ui.px(16);
    const bool fits = ImGui::CalcTextSize(notice.text.c_str()).x <= room;
    if (notice.text.empty() || !fits)
        put_hints(s);
    else
        put(s, notice.text, notice.colour, end);
    ImGui::End();
    ImGui::PopStyleVar(3);
    if (!fits) notice_box(s, notice);
}

namespace {

// The tuft in the plane of its bend: x along it, y along the holder, metres from the mouth.
struct SideView {
    Vec3 mouth, up, along;
    ImVec2 origin;
    float scale = 1;

    ImVec2 at(const Vec3& p) const {
        const Vec3 d = p - mouth;
        return {origin.x + scale * static_cast<float>(glm::dot(d, along)),
                origin.y - scale * static_cast<float>(glm::dot(d, up))};
    }
};

// Two points across the tuft, and the colour there.
struct Cut {
    ImVec2 left, right;
    unsigned colour = 0;
};

// From one cut to the next, the colour blended between them; its sides are drawn as lines, which have smooth edges.
void draw_between(ImDrawList& draw, const Cut& from, const Cut& to) {
    const ImVec2 white = ImGui::GetFontTexUvWhitePixel();
    draw.PrimReserve(6, 4);
    const auto first = static_cast<ImDrawIdx>(draw._VtxCurrentIdx);
    for (const int corner : {0, 1, 2, 0, 2, 3}) draw.PrimWriteIdx(static_cast<ImDrawIdx>(first + corner));
    draw.PrimWriteVtx(from.left, white, from.colour);
    draw.PrimWriteVtx(to.left, white, to.colour);
    draw.PrimWriteVtx(to.right, white, to.colour);
    draw.PrimWriteVtx(from.right, white, from.colour);
    draw.AddLine(from.left, to.left, to.colour);
    draw.AddLine(from.right, to.right, to.colour);
}

void draw_side(const Session& s, ImVec2 at, ImVec2 size) {
    const brush::Branch& branch = s.view.tuft.state.branches.front();
    const brush::Section &root = branch.sections.back(), &tip = branch.sections.front();
    ImDrawList* draw = ImGui::GetWindowDrawList();
    SideView v{.mouth = root.centre, .up = -root.tangent};
    Vec3 bend = tip.centre - root.centre;
    bend -= glm::dot(bend, v.up) * v.up;
    v.along = glm::length(bend) > 1e-4 ? glm::normalize(bend) : make_frame(Vec3(0), v.up).t;
    double length = 0;
    for (std::size_t i = 1; i < branch.sections.size(); ++i)
        length += glm::distance(branch.sections[i].centre, branch.sections[i - 1].centre);
    v.scale = static_cast<float>(0.72 * size.y / length);
    v.origin = {at.x + 0.40f * size.x, at.y + 0.2f * size.y};
    // The surface below, a point for every few pixels.
    const mesh::SurfaceQuery& query = s.paint_thread->surface();
    std::vector<ImVec2> ground;
    for (float x = at.x; x <= at.x + size.x; x += s.ui.px(4)) {
        const Vec3 from = v.mouth + static_cast<double>((x - v.origin.x) / v.scale) * v.along + 0.3 * length * v.up;
        const auto hit = query.ray(from, -v.up, 0, 2.2 * length);
        if (hit) ground.push_back(v.at(hit->position));
    }
    draw->AddPolyline(ground.data(), static_cast<int>(ground.size()), s.ui.faint, 0, s.ui.px(2));
    const unsigned ink = colour_in_tuft(s.brush, s.colours, s.reported.brush);
    const auto encoded = [](float linear) { return ink::srgb_encode(linear); };
    for (const brush::Branch& b : s.view.tuft.state.branches)
        for (std::size_t i = 1; i < b.sections.size(); ++i) {
            const auto cut = [&](std::size_t k) {
                const brush::Section& c = b.sections[k];
                const Vec3 across = glm::cross(c.tangent, glm::cross(v.up, v.along));
                const double r = std::hypot(c.a * glm::dot(c.e, across), c.b * glm::dot(c.m, across));
                const Vec3f hair = hair_colour(static_cast<double>(k) / static_cast<double>(b.sections.size()), ink);
                return Cut{
                    v.at(c.centre + r * across), v.at(c.centre - r * across),
                    ImGui::ColorConvertFloat4ToU32(ImVec4(encoded(hair[0]), encoded(hair[1]), encoded(hair[2]), 1))};
            };
            const brush::Section &p = b.sections[i - 1], &q = b.sections[i];
            draw_between(*draw, cut(i - 1), cut(i));
            if (p.pressure > 0 && q.pressure > 0)
                draw->AddLine(v.at(p.centre), v.at(q.centre), s.ui.accent, s.ui.px(2.5f));
        }
    const auto r = static_cast<float>(std::max(root.a, root.b)) * v.scale * 1.1f;
    draw->AddRectFilled(ImVec2(v.origin.x - r, at.y), ImVec2(v.origin.x + r, v.origin.y), IM_COL32(150, 104, 58, 255),
                        2);
}

}  // namespace

void tuft_inset(Session& s) {
    if (!s.view.show_tuft_inset || !s.paint_thread || s.view.tuft.state.branches.empty()) return;
    Ui& ui = s.ui;
    const float width = ui.px(kInsetWidth), height = ui.px(206);
    if (static_cast<float>(s.view.area.width) < 3 * width || static_cast<float>(s.view.area.height) < 2 * height)
        return;  // the model needs the room
    begin_panel_over(ui, s.view.area,
                     {.name = "tuft",
                      .down = 1,
                      .width = width,
                      .height = height,
                      .alpha = 0.82f,
                      .below = true,
                      .takes_input = false});
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 size(ImGui::GetContentRegionAvail().x, ui.px(126));
    ImGui::PushClipRect(at, ImVec2(at.x + size.x, at.y + size.y), true);
    draw_side(s, at, size);
    ImGui::PopClipRect();
    ImGui::Dummy(size);
    const auto line = [&](const char* name, const char* format, double value) {
        char text[48] = "\xe2\x80\x93";
        if (s.view.tuft.state.touching) std::snprintf(text, sizeof text, format, value);
        ImGui::TextDisabled("%s", ui.tr(name));
        ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(text).x);
        ImGui::TextUnformatted(text);
    };
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(ui.px(8), ui.px(1)));
    line("Force", "%.0f mN", s.view.tuft.state.normal_force * 1e3);
    line("Moment", "%.2f mN m", std::abs(s.view.tuft.state.root_moment) * 1e3);
    line("Depth", "%.1f mm", s.view.tuft.depth * 1e3);
    ImGui::PopStyleVar();
    ImGui::End();
}

}  // namespace tuft::app
