#include <cmath>

#include "brush/preset/preset.h"
#include "compositions.h"
#include "core/text/units.h"
#include "hand.h"

namespace tuft::samples {

namespace {

/// A line through points (x, z) of the car's side view, mm, with a width at each.
struct Point {
    double x, z, width;
    double pace = 1, rest = -1;
};

/// The flank is written from the right-hand side of the car: +x, its front, is to the right.
Stroke line(const char* name, const std::vector<Point>& points) {
    Stroke s{name, {}};
    for (const Point& p : points) s.keys.push_back({p.x, -p.z, p.width, p.pace, p.rest});
    return s;
}

}  // namespace

std::vector<stroke::Trace> car_pinstripe() {
    const char* brush = "wolf-medium";  // holds the ink of the whole stripe
    const WidthTable table(brush::load_preset(brush));
    const WriteOptions options{.size = 1.0, .centre = {0, 0}, .speed = 0.16, .tilt = {0, 0}};
    const std::vector<Stroke> strokes = {
        // From behind the front wheel along the door, below the character line, over the
        // rear arch and out. The tail lamp's end is the long one.
        line("stripe", {{262, 162, 0, 0.4},
                        {235, 167.5, 2.4, 0.6},
                        {195, 173.5, 4.8, 0.9},
                        {150, 177, 6.2},
                        {50, 179, 6.4},
                        {-50, 180.5, 6.0},
                        {-150, 185, 5.3},
                        {-250, 193.5, 4.5},
                        {-345, 200, 3.6},
                        {-420, 196, 2.6},
                        {-480, 184, 1.4, 1.2},
                        {-532, 167, 0.4, 1.2, 0},
                        {-526, 169, 0}}),
        line("companion", {{178, 186, 0, 0.4},
                           {160, 187.2, 0.8, 0.6},
                           {125, 188.5, 1.2},
                           {50, 190, 1.2},
                           {-50, 190.5, 1.2},
                           {-150, 194.5, 1.2},
                           {-250, 202.5, 1.2},
                           {-345, 208, 1.1},
                           {-415, 205, 0.9},
                           {-464, 197.5, 0.3, 1.2, 0},
                           {-460, 198.3, 0}}),
    };
    std::vector<stroke::Trace> out;
    for (const Stroke& s : strokes) {
        stroke::Trace t = write(s, table, options);
        t.placement = {{0, -0.24, 0}, {1, 0, 0}, {0, 0, -1}, stroke::SurfaceMapping::project};
        t.brush = brush;
        t.ink = "cinnabar";
        t.seed = out.size() + 1;
        out.push_back(t);
    }
    return out;
}

}  // namespace tuft::samples
