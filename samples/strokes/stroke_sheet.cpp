#include <cmath>

#include "brush/preset/preset.h"
#include "compositions.h"
#include "core/text/units.h"
#include "kaishu.h"

namespace tuft::samples {

namespace {

constexpr double kCell = 31.0;  // mm, from stroke to stroke
constexpr double kSquare = 30;  // mm of the character square

/// Writes a stroke on its place of the sheet, seen from above.
struct Writer {
    std::vector<stroke::RecordedStroke> out;

    void add(const Stroke& s, const char* brush, double column, double row, const WriteOptions& how = {},
             std::vector<stroke::Preparation> before = {}) {
        const WidthTable table(brush::load_preset(brush));
        WriteOptions options = how;
        options.size = kSquare * kMillimetre;
        stroke::RecordedStroke t = write(s, table, options);
        t.placement = {{(column - 2.5) * kCell * kMillimetre, (2.5 - row) * kCell * kMillimetre, 0},
                       {1, 0, 0},
                       {0, -1, 0},
                       stroke::SurfaceMapping::wrap};
        t.brush = brush;
        t.ink = "carbon";
        t.seed = out.size() + 1;
        t.label = std::string(brush) + " " + s.name;
        t.before = std::move(before);
        out.push_back(std::move(t));
    }
};

Stroke sweep(const char* name, Vec2 from, Vec2 to, double width, double pace = 1) {
    const Vec2 chord = to - from;
    const auto at = [&](double f, double w, double p) { return Key{from.x + f * chord.x, from.y + f * chord.y, w, p}; };
    return {name,
            {at(0, 0, 0.6), at(0.01, 0.25 * width, 0.4), at(0.07, width, pace), at(0.5, width, pace),
             at(0.93, width, pace), at(1, 0, pace)}};
}

}  // namespace

std::vector<stroke::RecordedStroke> stroke_sheet() {
    Writer w;
    int row = 0;
    for (const char* brush : {"wolf-medium", "goat-medium", "mixed-medium"}) {
        w.add(dian({330, 330}, {620, 620}, 210), brush, 0, row);
        w.add(heng({60, 540}, {940, 480}, 150), brush, 1, row);
        w.add(shu_drop({480, 60}, {500, 950}, 165), brush, 2, row);
        w.add(shu_gou({560, 60}, {570, 900}, {300, 760}, 150), brush, 3, row);
        w.add(pie({820, 80}, {120, 930}, 160, 0.1), brush, 4, row);
        w.add(na({90, 110}, {690, 800}, {990, 830}, 210), brush, 5, row);
        ++row;
    }
    const auto wiped = [](double amount) {
        return std::vector<stroke::Preparation>{stroke::BrushAction{.what = stroke::Wipe{.amount = amount}}};
    };
    const char* brush = "mixed-medium";
    // The holder leans across the stroke, so that the tip runs along one side of it.
    w.add(sweep("slanted tip", {60, 300}, {940, 300}, 200), brush, 0, row, {.tilt = {0, 0.7}});
    w.add(sweep("slanted tip, dry", {60, 740}, {940, 740}, 200), brush, 0, row, {.tilt = {0, 0.7}}, wiped(0.72));
    // The holder leans ahead: the tip is pushed against its hair.
    w.add(sweep("reversed tip", {60, 300}, {800, 300}, 150, 0.6), brush, 1.05, row, {.tilt = {-0.6, 0}});
    w.add(sweep("reversed tip, dry", {60, 740}, {800, 740}, 150, 0.6), brush, 1.05, row, {.tilt = {-0.6, 0}},
          wiped(0.72));
    for (int k = 0; k < 2; ++k)
        w.add(sweep("split tip", {60, 300.0 + 440 * k}, {940, 300.0 + 440 * k}, 330), brush, 2.1, row, {},
              wiped(0.86 + 0.06 * k));
    // One after the other drier.
    const double amounts[] = {0.5, 0.64, 0.74, 0.82};
    for (int k = 0; k < 4; ++k)
        w.add(sweep("dry tip", {60, 140.0 + 250 * k}, {3000, 140.0 + 250 * k}, 215), brush, 3.15, row, {.speed = 0.1},
              wiped(amounts[k]));
    ++row;
    w.add(sweep("fast and half dry", {60, 200}, {5900, 160}, 260), "goat-medium", 0, row + 0.15,
          {.speed = 0.35, .acceleration = 6}, wiped(0.55));
    w.add(sweep("runs dry", {60, 560}, {5900, 600}, 260), "wolf-medium", 0, row + 0.15, {.speed = 0.15}, wiped(0.7));
    w.add(na({4200, 820}, {5200, 1430}, {5900, 1450}, 260), "goat-medium", 0, row + 0.15, {.speed = 0.12}, wiped(0.6));
    w.add(pie({3900, 880}, {2400, 1500}, 240, 0.1), "goat-medium", 0, row + 0.15, {.speed = 0.15}, wiped(0.62));
    w.add(heng({100, 1100}, {2000, 1030}, 230), "goat-medium", 0, row + 0.15, {.speed = 0.12}, wiped(0.6));
    return std::move(w.out);
}

}  // namespace tuft::samples
