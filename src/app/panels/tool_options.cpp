#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "app/panels/panels.h"
#include "brush/preset/preset.h"
#include "core/text/units.h"

/// Two rows over the view: above what every stroke is made with, below what the chosen tool has. Nothing in them
/// scrolls.
namespace tuft::app {
namespace {

// Places of a row: three of one width, whatever stands in them, so that a hand finds them again.
constexpr int kPlaces = 3;
constexpr float kRoomForName = 175;  // pixels at a scale of 1, that a place needs for letters of the usual size

struct Row {
    float width = 0;  ///< pixels, of a place
    float gap = 0;

    float of(int places) const { return static_cast<float>(places) * (width + gap) - gap; }
};

void brush_row(const OptionParts& s, const Row& row) {
    Ui& ui = s.ui;
    const brush::SizedName sized = brush::sized_name(s.brush.preset);
    const double whole = brush::tuft_width(s.brush.shelf.at(sized.base).preset);
    double now = whole * sized.factor;
    if (ui.named_slider("Tuft size", now, {whole * brush::kLeastSize, whole * brush::kMostSize, "%.1f mm", kMillimetre},
                        "How wide it is; its length goes with it", row.width))
        size_brush(s.brush, s.status, now / whole);
    ImGui::SameLine(0, row.gap);
    ui.named_slider("Pressure", s.tools.pointer.pressure, {0.02, 1, "%.2f"},
                    "How deep the brush is pressed in slow motion: part of half the hair's length. Keys [ and ]",
                    row.width);
    ImGui::SameLine(0, row.gap);
    ui.named_slider("Stabiliser", s.tools.pointer.string, {0, 0.03, "%.1f mm", kMillimetre},
                    "The brush follows on a string of this length", row.width);
}

// What a mouse has in place of a pen's pressure.
void hand_row(Ui& ui, PointerSettings& pointer, const Row& row) {
    ui.named_slider("Speed lightens", pointer.speed_effect, {0, 1, "%.2f"},
                    "As a hand does. Only for a mouse; a pen says its own pressure", row.width);
    ImGui::SameLine(0, row.gap);
    ui.named_slider("Rest deepens", pointer.dwell_effect, {0, 1, "%.2f"},
                    "A mouse that stays where it is sinks in slowly", row.width);
    ImGui::SameLine(0, row.gap);
    ui.toggle(
        "Clean ends", pointer.clean_ends,
        "Strokes of a mouse begin where the button goes down and end where it comes up: the brush is set down in the "
        "stroke's direction and runs ahead of the cursor by what its tip lags behind. A pen has its pressure for that");
}

// How the hand goes along lines and curves.
void curve_row(const OptionParts& s, const Row& row) {
    Ui& ui = s.ui;
    CurveSettings& c = s.tools.curve_settings;
    bool changed =
        ui.named_slider("Press down in", c.taper_in, {0, 0.9, "%.0f %%", 0.01}, "Part of its length", row.width);
    ImGui::SameLine(0, row.gap);
    changed |= ui.named_slider("Lift in", c.taper_out, {0, 0.9, "%.0f %%", 0.01}, "Part of its length", row.width);
    ImGui::SameLine(0, row.gap);
    changed |= ui.named_slider("Pace", c.speed, {0.01, 0.4, "%.0f mm/s", kMillimetre}, "Of the hand", row.width);
    if (changed) s.tools.curve.changed = true;
}

// Buttons of which one is chosen, as wide as `room` together.
template <class Value, std::size_t N>
void choices(Ui& ui, const std::array<std::tuple<Value, const char*, const char*>, N>& all, Value& value, float room,
             float gap) {
    const float each = (room - static_cast<float>(N - 1) * gap) / static_cast<float>(N) / ui.settings().scale;
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(ui.px(2), ImGui::GetStyle().FramePadding.y));
    bool first = true;
    for (const auto& [choice, name, hint] : all) {
        if (!std::exchange(first, false)) ImGui::SameLine(0, gap);
        if (ui.choice(name, value == choice, hint, each)) value = choice;
    }
    ImGui::PopStyleVar();
}

// How many copies lie along a line, in the place of the turn.
void band_options(Ui& ui, Writing& w, const DrawingPlace& place, const Row& row) {
    const float left = ImGui::GetCursorPosX();
    bool meet = w.repeats == 0;
    if (ui.toggle("Meet", meet,
                  "As many copies as the line has room for, made to meet; off: a number of them, as wide as they are"))
        w.repeats = meet ? 0 : std::max(1, place.copies);
    ImGui::SameLine(0, row.gap);
    const float room = left + row.width - ImGui::GetCursorPosX();
    if (w.repeats > 0) {
        double n = w.repeats;
        if (ui.named_slider("Copies", n, {1, 100, "%.0f"}, "Along the line, evenly spaced", room))
            w.repeats = static_cast<int>(std::lround(n));
        return;
    }
    const std::string text = !place.fault.empty() ? ui.tr("No line is near")
                             : place.copies > 0
                                 ? ui.sentence(Message("{} copies of {} mm", place.copies,
                                                       fmt::format("{:.1f}", place.copy_width / kMillimetre)))
                                 : std::string();
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(ui.fitted(text, room).c_str());
    ui.mark("Copies along the line");
    if (!place.fault.empty()) ui.hint(ui.sentence(place.fault).c_str());
}

void writing_row(Ui& ui, Writing& w, const DrawingPlace& place, const Row& row) {
    static constexpr std::array<std::tuple<stroke::SurfaceMapping, const char*, const char*>, 3> kMappings{
        {{stroke::SurfaceMapping::drape, "Drape",
          "Bent round the surface; bridges small grooves, panel gaps and scan noise"},
         {stroke::SurfaceMapping::wrap, "Wrap", "Bent round the surface, into each of its grooves"},
         {stroke::SurfaceMapping::project, "Project##mapping", "Straight, as seen from before the place"}}};
    if (w.empty()) return;
    const double own = w.form().width;
    double width = own * w.scale;
    if (own > 0 && ui.named_slider("Width", width, {0.05 * own, std::max(4 * own, 0.3), "%.1f mm", kMillimetre},
                                   "Wheel over the model", row.width))
        w.scale = width / own;
    ImGui::SameLine(0, row.gap);
    if (w.along == BandLine::none)
        ui.named_slider("Turn", w.turn, {-180 * kDegree, 180 * kDegree, "%.0f\xc2\xb0", kDegree},
                        "Shift and wheel over the model", row.width);
    else
        band_options(ui, w, place, row);
    ImGui::SameLine(0, row.gap);
    choices(ui, kMappings, w.mapping, row.width, ui.px(2));
}

void lettering_row(Ui& ui, Lettering& l, const Row& row) {
    const bool along = l.direction == writer::Direction::rim || l.direction == writer::Direction::curve;
    ui.named_slider("Size", l.side, {1e-3, 0.2, "%.1f mm", kMillimetre}, "Of a character. Wheel over the model",
                    row.width);
    ImGui::SameLine(0, row.gap);
    if (l.empty()) return;
    const writer::Style& style = l.text->style;
    double spacing = l.spacing.characters > 0 ? l.spacing.characters : style.spacing;
    if (ui.named_slider("Spacing", spacing, {0.5, 3, "%.2f"}, "Between characters, part of their width", row.width))
        l.spacing.characters = spacing;
    ImGui::SameLine(0, row.gap);
    double lines = l.spacing.lines > 0 ? l.spacing.lines : style.line_spacing;
    if (l.text->lines.size() > 1) {
        if (ui.named_slider("Line spacing", lines, {0.5, 4, "%.2f"}, "Between lines, part of the size", row.width))
            l.spacing.lines = lines;
    } else if (!along) {
        ui.named_slider("Turn", l.turn, {-180 * kDegree, 180 * kDegree, "%.0f\xc2\xb0", kDegree},
                        "Shift and wheel over the model", row.width);
    }
}

void fill_row(Ui& ui, stroke::Fill& fill, const Row& row) {
    static constexpr const char* kHint = "What the ink covers where you click";
    static constexpr std::array<std::tuple<stroke::Region, const char*, const char*>, 3> kRegions{
        {{stroke::Region::all, "All", kHint},
         {stroke::Region::part, "Part", kHint},
         {stroke::Region::chart, "Chart", kHint}}};
    choices(ui, kRegions, fill.region, row.of(2), row.gap);
    ImGui::SameLine(0, row.gap);
    if (ui.named_slider("Thickness", fill.film, {0.05, 5, "%.1f \xce\xbcm", 0.1}, "Of the wet coat", row.width))
        fill.to_film = fill.film;
}

}  // namespace

void tool_options(const OptionParts& s, float left, float top, float width) {
    Ui& ui = s.ui;
    ImGui::SetNextWindowPos(ImVec2(left, top));
    ImGui::SetNextWindowSize(ImVec2(width, ui.px(kOptionsHeight)));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(ui.px(8), ui.px(5)));
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(ui.px(6), ui.px(4)));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
    ImGui::Begin("###options", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::GetBackgroundDrawList()->AddRect(ImVec2(left, top), ImVec2(left + width, top + ui.px(kOptionsHeight)),
                                            ImGui::GetColorU32(ImGuiCol_Border));
    Row row{.gap = ui.px(6)};
    row.width = std::floor((std::min(ImGui::GetContentRegionAvail().x, ui.px(960)) + row.gap) / kPlaces - row.gap);
    // In a narrow view the letters are smaller, so that name and number stand side by side.
    ImGui::SetWindowFontScale(std::clamp(row.width / ui.px(kRoomForName), 0.75f, 1.0f));
    const Tool tool = s.tools.active;
    if (tool == Tool::fill) {
        fill_row(ui, s.tools.fill, row);
    } else if (tool != Tool::pick && tool != Tool::mask) {
        brush_row(s, row);
        if (tool == Tool::brush || tool == Tool::eraser) hand_row(ui, s.tools.pointer, row);
        if (tool == Tool::line || tool == Tool::curve) curve_row(s, row);
        if (tool == Tool::writing) writing_row(ui, s.tools.writing, s.tools.place, row);
        if (tool == Tool::text) lettering_row(ui, s.tools.lettering, row);
    }
    ImGui::End();
    ImGui::PopStyleVar(4);
}

}  // namespace tuft::app
