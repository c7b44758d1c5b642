#include <cmath>

#include "brush/preset.h"
#include "compositions.h"
#include "core/units.h"
#include "hand.h"

namespace tuft::samples {

namespace {

/// A line through points (x, z) of the car's side view, mm, with a width at each.
struct Point {
    double x, z, width;
    double pace = 1;
};

/// The flank is written from the right-hand side of the car: +x, its front, is to the right.
Stroke line(const char* name, const std::vector<Point>& points) {
    Stroke s{name, {}};
    for (const Point& p : points) s.keys.push_back({p.x, -p.z, p.width, p.pace});
    return s;
}

}  // namespace

std::vector<stroke::Trace> car_pinstripe() {
    const char* brush = "wolf-small";
    const WidthTable table(brush::load_preset(brush));
    const WriteOptions options{.size = 1.0, .centre = {0, 0}, .speed = 0.16, .tilt = {0, 0}};
    const std::vector<Stroke> strokes = {
        // From behind the rear wheel over its arch, along the flank, over the front arch and out.
        line("stripe", {{-520, 172, 0, 0.5}, {-500, 176, 1.2}, {-455, 184, 2.2}, {-400, 196, 2.8},
                        {-345, 200, 3.0}, {-290, 197, 3.2}, {-220, 188, 3.4}, {-100, 181, 3.6},
                        {30, 178, 3.6}, {150, 175, 3.4}, {240, 178, 3.2}, {300, 189, 3.0},
                        {369, 196, 2.8}, {430, 188, 2.2}, {470, 174, 1.4}, {500, 156, 0, 1.3},
                        {506, 151, 0}}),
        line("companion", {{-470, 174, 0, 0.5}, {-440, 180, 0.9}, {-395, 188, 1.2}, {-345, 191.5, 1.2},
                           {-285, 188.5, 1.2}, {-218, 180, 1.2}, {-100, 173, 1.2}, {30, 170, 1.2},
                           {150, 167, 1.2}, {236, 169.5, 1.2}, {298, 180, 1.2}, {369, 187, 1.1},
                           {425, 179, 0.9}, {456, 168, 0, 1.2}, {462, 164, 0}}),
    };
    std::vector<stroke::Trace> out;
    for (const Stroke& s : strokes) {
        stroke::Trace t = write(s, table, options);
        t.placement = {{0, -0.24, 0}, {1, 0, 0}, {0, 0, -1}, stroke::Laying::project};
        t.brush = brush;
        t.ink = "cinnabar";
        t.seed = out.size() + 1;
        out.push_back(t);
    }
    return out;
}

}  // namespace tuft::samples
