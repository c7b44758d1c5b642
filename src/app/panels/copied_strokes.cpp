#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "app/panels/panels.h"
#include "writer/copy/copied_glyph.h"

/// \file
/// The strokes of a character that is copied from a picture: numbered in the order of writing over the picture, and
/// corrected by clicks.
namespace tuft::app {
namespace {

constexpr float kSide = 320, kLeastSide = 150;  // pixels at a scale of 1, of the picture
constexpr float kRest = 250;                    // the same, of what is above and below it
constexpr float kChip = 26;

unsigned colour_of(std::size_t stroke) {
    const std::uint32_t c = writer::kStrokeColours[stroke % writer::kStrokeColours.size()];
    return IM_COL32(c >> 16, c >> 8 & 0xff, c & 0xff, 255);
}

/// The square of the character on the screen.
struct Canvas {
    ImVec2 at{0, 0};  ///< upper left corner, pixels
    float side = 1;   ///< pixels

    ImVec2 pixel(const Vec2& p) const {
        const float unit = side / static_cast<float>(writer::kSide);
        return {at.x + unit * static_cast<float>(p.x), at.y + side - unit * static_cast<float>(p.y)};
    }
    Vec2 unit(ImVec2 p) const {
        const double scale = writer::kSide / static_cast<double>(side);
        return {scale * static_cast<double>(p.x - at.x), scale * static_cast<double>(at.y + side - p.y)};
    }
};

/// The points of a stroke as it is written, pixels.
std::vector<ImVec2> line_of(const writer::CopiedPicture& copy, std::size_t stroke, const Canvas& canvas) {
    std::vector<ImVec2> line;
    for (const writer::PieceUse& use : copy.order[stroke]) {
        std::vector<Vec2> points = copy.skeleton.pieces[use.piece].line;
        if (use.reversed) std::reverse(points.begin(), points.end());
        for (const Vec2& p : points) line.push_back(canvas.pixel(p));
    }
    return line;
}

void draw_picture(CopyInWork& copy, const Canvas& canvas) {
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const ImVec2 end(canvas.at.x + canvas.side, canvas.at.y + canvas.side);
    draw->AddRectFilled(canvas.at, end, IM_COL32(238, 236, 230, 255));
    if (copy.fresh && !copy.picture.rgb.empty()) upload(copy.texture, copy.picture), copy.fresh = false;
    if (!copy.texture || !copy.shown) return;
    // The picture's corners on the square: the inverse of `PictureInk::pixel_at`.
    const writer::PictureInk& ink = copy.shown->ink;
    const Vec2 size = copy.picture.reduced * Vec2(copy.picture.width, copy.picture.height);
    const auto square = [&](const Vec2& pixel) {
        const Vec2 d = ink.units * (pixel - ink.middle);
        return canvas.pixel({0.5 * writer::kSide + d.x, 0.5 * writer::kSide - d.y});
    };
    draw->AddImage(reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(copy.texture)), square(Vec2(0)),
                   square(size));
    draw->AddRectFilled(canvas.at, end, IM_COL32(255, 255, 255, 110));  // so that lines stand out from the ink
}

void draw_arrow(ImVec2 from, ImVec2 tip, float size, unsigned colour) {
    const float dx = tip.x - from.x, dy = tip.y - from.y, length = std::max(1e-3f, std::hypot(dx, dy));
    const float x = size * dx / length, y = size * dy / length;
    const ImVec2 end(tip.x + 0.4f * x, tip.y + 0.4f * y), root(tip.x - x, tip.y - y);
    ImGui::GetWindowDrawList()->AddTriangleFilled(end, ImVec2(root.x - 0.7f * y, root.y + 0.7f * x),
                                                  ImVec2(root.x + 0.7f * y, root.y - 0.7f * x), colour);
}

void draw_number(const Ui& ui, ImVec2 at, std::size_t number, unsigned colour) {
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const std::string text = std::to_string(number);
    const float letters = 0.8f * ImGui::GetFontSize();
    const ImVec2 size = ImGui::GetFont()->CalcTextSizeA(letters, 1e9f, 0, text.c_str());
    draw->AddCircleFilled(at, ui.px(8.5f), IM_COL32_WHITE);
    draw->AddCircleFilled(at, ui.px(7.5f), colour);
    draw->AddText(ImGui::GetFont(), letters, ImVec2(at.x - 0.5f * size.x, at.y - 0.5f * size.y), IM_COL32_WHITE,
                  text.c_str());
}

/// Where the numbers stand: at the begins of the strokes, turned about them and away where one would hide another.
/// `apart`: pixels.
std::vector<ImVec2> number_places(const std::vector<std::vector<ImVec2>>& lines, float apart) {
    std::vector<ImVec2> places;
    for (const std::vector<ImVec2>& line : lines) {
        const ImVec2 begin = line.front();
        ImVec2 place = begin;
        const auto is_free = [&] {
            return std::none_of(places.begin(), places.end(), [&](const ImVec2& p) {
                return std::hypot(p.x - place.x, p.y - place.y) < 0.95f * apart;
            });
        };
        for (int k = 0; k < 16 && !is_free(); ++k) {
            const float angle = 2.4f * static_cast<float>(k), far = apart * (1 + 0.1f * static_cast<float>(k));
            place = ImVec2(begin.x + far * std::cos(angle), begin.y + far * std::sin(angle));
        }
        places.push_back(place);
    }
    return places;
}

void draw_strokes(Ui& ui, const CopyInWork& copy, const Canvas& canvas) {
    ImDrawList* draw = ImGui::GetWindowDrawList();
    std::vector<std::vector<ImVec2>> lines;
    for (std::size_t s = 0; s < copy.shown->order.size(); ++s) lines.push_back(line_of(*copy.shown, s, canvas));
    for (std::size_t s = 0; s < lines.size(); ++s) {
        const std::vector<ImVec2>& line = lines[s];
        const bool chosen = copy.joined == s;
        const int n = static_cast<int>(line.size());
        draw->AddPolyline(line.data(), n, IM_COL32(255, 255, 255, 200), 0, ui.px(chosen ? 9.0f : 5.0f));
        draw->AddPolyline(line.data(), n, colour_of(s), 0, ui.px(chosen ? 5.0f : 2.5f));
        draw_arrow(line[line.size() - std::min<std::size_t>(line.size(), 5)], line.back(), ui.px(8), colour_of(s));
        const ImVec2 place = line[line.size() / 3];  // strokes cross in their middles
        ui.mark_at("Stroke " + std::to_string(s + 1), place.x, place.y);
    }
    const std::vector<ImVec2> places = number_places(lines, ui.px(17));
    for (std::size_t s = 0; s < lines.size(); ++s) draw_number(ui, places[s], s + 1, colour_of(s));
}

/// The picture with its strokes; a click edits one.
void canvas_part(Ui& ui, const CopyToEdit& c, float side) {
    const Canvas canvas{ImGui::GetCursorScreenPos(), side};
    const bool pressed = ImGui::InvisibleButton("##canvas", ImVec2(side, side));
    ui.mark("Copied picture");
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->PushClipRect(canvas.at, ImVec2(canvas.at.x + side, canvas.at.y + side), true);
    draw_picture(c.copy, canvas);
    if (c.copy.shown) draw_strokes(ui, c.copy, canvas);
    draw->PopClipRect();
    if (pressed) edit_stroke(c, canvas.unit(ImGui::GetIO().MousePos));
}

void edit_row(Ui& ui, CopyInWork& copy) {
    struct Choice {
        CopyEdit edit;
        const char *name, *hint;
    };
    static constexpr Choice kChoices[] = {
        {CopyEdit::reverse, "Reverse", "A click turns a stroke round: it is written the other way"},
        {CopyEdit::join, "Join", "A click on a stroke, then one on the stroke that goes on from its end"},
        {CopyEdit::split, "Split", "A click cuts a stroke into two where it is"},
        {CopyEdit::remove, "Remove", "A click takes out what is no stroke"}};
    const float gap = ui.px(2), all = ImGui::GetContentRegionAvail().x;
    const float each = (all - 3 * gap) / 4 / ui.settings().scale;
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(ui.px(2), ImGui::GetStyle().FramePadding.y));
    for (const Choice& choice : kChoices) {
        if (choice.edit != CopyEdit::reverse) ImGui::SameLine(0, gap);
        if (!ui.choice(choice.name, copy.edit == choice.edit, choice.hint, each)) continue;
        copy.edit = choice.edit;
        copy.joined.reset();
    }
    ImGui::PopStyleVar();
}

/// Numbers in the order of writing, each in its stroke's colour; they are dragged to other places.
void order_row(Ui& ui, const CopyToEdit& c) {
    ui.note(ui.tr("Order of writing: drag the numbers"));
    const float chip = ui.px(kChip), gap = ui.px(4), all = ImGui::GetContentRegionAvail().x;
    const auto columns = static_cast<std::size_t>(std::max(1.0f, std::floor((all + gap) / (chip + gap))));
    const ImVec2 start = ImGui::GetCursorScreenPos(), mouse = ImGui::GetIO().MousePos;
    const std::size_t n = c.copy.shown->order.size();
    bool held = false;
    for (std::size_t s = 0; s < n; ++s) {
        const ImVec2 at(start.x + static_cast<float>(s % columns) * (chip + gap),
                        start.y + static_cast<float>(s / columns) * (chip + gap));
        ImGui::SetCursorScreenPos(at);
        ImGui::InvisibleButton(("order " + std::to_string(s)).c_str(), ImVec2(chip, chip));
        ui.mark("Order " + std::to_string(s + 1));
        if (ImGui::IsItemActivated()) c.copy.dragged = StrokeDrag{s};
        held = held || ImGui::IsItemActive();
        const ImVec2 end(at.x + chip, at.y + chip);
        ImDrawList* draw = ImGui::GetWindowDrawList();
        draw->AddRectFilled(at, end, colour_of(s), ui.px(4));
        if (c.copy.dragged && c.copy.dragged->stroke == s) draw->AddRect(at, end, ui.strong, ui.px(4), 0, ui.px(2));
        const std::string text = std::to_string(s + 1);
        const ImVec2 size = ImGui::CalcTextSize(text.c_str());
        draw->AddText(ImVec2(at.x + 0.5f * (chip - size.x), at.y + 0.5f * (chip - size.y)), IM_COL32_WHITE,
                      text.c_str());
    }
    if (!held || !c.ready()) return c.copy.dragged.reset();
    // The button that was pressed stays the active one; what moves is the stroke.
    const float column = std::floor((mouse.x - start.x) / (chip + gap)),
                row = std::floor((mouse.y - start.y) / (chip + gap));
    if (column < 0 || row < 0 || column >= static_cast<float>(columns)) return;
    drag_stroke(c, static_cast<std::size_t>(row) * columns + static_cast<std::size_t>(column));
}

void buttons(Session& s, const CopyToEdit& c) {
    Ui& ui = s.ui;
    if (ui.button("Step back", "Takes the last correction back", 0, !c.copy.earlier.empty())) step_back(c);
    ImGui::SameLine();
    if (ui.button("By rules", "Drops all corrections: the order as rules find it", 0,
                  c.request.correction != writer::CopyCorrection{}))
        correct(c, {});
    ImGui::SameLine();
    if (ui.button("Save...", "As a file that Characters from... and --glyphs read", 0,
                  s.tools.lettering.text.has_value())) {
        const std::string name = c.request.text.empty() ? c.request.like.stem().string() : c.request.text;
        s.dialogs.file.show(FileDialog::Purpose::save_copy, name + ".json");
    }
}

}  // namespace

void copied_strokes_panel(Session& s) {
    Lettering& l = s.tools.lettering;
    if (s.tools.active != Tool::text || !s.paint_thread || l.wanted.like.empty()) return;
    Ui& ui = s.ui;
    const float room = static_cast<float>(s.view.area.height) - 2 * ui.px(kPanelMargin);
    const float side = std::clamp(room - ui.px(kRest), ui.px(kLeastSide), ui.px(kSide));
    const float width = std::max(side, ui.px(250)) + 2 * ImGui::GetStyle().WindowPadding.x;
    begin_panel_over(ui, s.view.area,
                     {.name = "Copied strokes", .across = 1, .width = width, .has_bar = true, .moves = true});
    ImGui::BeginDisabled(s.reported.file.viewing);
    const CopyToEdit c = copy_to_edit(l);
    canvas_part(ui, c, side);
    edit_row(ui, l.copy);
    if (l.copy.shown) order_row(ui, c);
    double threshold = l.wanted.correction.threshold;
    if (ui.slider("Threshold", threshold, {-writer::kMostThreshold, writer::kMostThreshold, "%.2f"},
                  "What counts as ink: more makes lines thicker. The strokes are found anew"))
        slide_threshold(c, threshold);
    if (!ImGui::IsAnyItemActive()) l.copy.slides = false;
    buttons(s, c);
    ImGui::EndDisabled();
    ImGui::End();
}

}  // namespace tuft::app
