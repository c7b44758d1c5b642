#include <cmath>

#include "brush/preset/preset.h"
#include "compositions.h"
#include "core/text/units.h"
#include "kaishu.h"

namespace tuft::samples {

namespace {

constexpr const char* kBrush = "mixed-small";

void write_glyph(std::vector<stroke::Trace>& out, const Glyph& g, const WidthTable& table, const WriteOptions& options,
                 const stroke::Placement& place, const char* ink) {
    for (const Stroke& s : g.strokes) {
        stroke::Trace t = write(s, table, options);
        t.placement = place;
        t.brush = kBrush;
        t.ink = ink;
        t.seed = out.size() + 1;
        t.label = g.name + " " + s.name;
        out.push_back(t);
    }
}

}  // namespace

std::vector<stroke::Trace> bowl_inside() {
    const WidthTable table(brush::load_preset(kBrush));
    const double pitch = 43, back = 20;  // mm; on the wall that faces the reader
    std::vector<stroke::Trace> out;
    const char* characters[] = {"七", "上", "八", "下"};
    for (int k = 0; k < 4; ++k) {
        // All four share one wrap, so they stay square to each other.
        WriteOptions options{.size = 39 * kMillimetre};
        const Vec2 middle{(k % 2 - 0.5) * pitch, (k / 2 - 0.5) * pitch};
        options.centre = Vec2(500, 500) - middle * kMillimetre / (0.001 * options.size);
        write_glyph(out, glyph(characters[k]), table, options,
                    {{0, back * kMillimetre, 11.6 * kMillimetre}, {1, 0, 0}, {0, -1, 0}, stroke::SurfaceMapping::wrap},
                    "carbon");
    }
    return out;
}

std::vector<stroke::Trace> bowl_outside() {
    const WidthTable table(brush::load_preset(kBrush));
    const double radius = 68.4 * kMillimetre, height = 44.5 * kMillimetre, step = 31.5 * kDegree;
    std::vector<stroke::Trace> out;
    const char* characters[] = {"漫", "步", "人", "生"};
    for (int k = 0; k < 4; ++k) {
        const double a = (k - 1.5) * step;  // from the front (-y) to the right
        const stroke::Placement place{{radius * std::sin(a), -radius * std::cos(a), height},
                                      {std::cos(a), std::sin(a), 0},
                                      {0, 0, -1},
                                      stroke::SurfaceMapping::wrap};
        write_glyph(out, glyph(characters[k]), table, {.size = 36 * kMillimetre}, place, "carbon");
    }
    return out;
}

}  // namespace tuft::samples
