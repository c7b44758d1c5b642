#include "shape.h"
#include "turned.h"

namespace tuft::models {

namespace {

void append(Outline& outline, const Outline& more) {
    outline.insert(outline.end(), more.begin(), more.end());
}

struct Foot {
    double outer = 32;         ///< radius where the ring stands, mm
    double inner = 28;         ///< radius inside the ring, mm
    double height = 6;         ///< of the hollow inside the ring, mm
    double hollow_rise = 0.8;  ///< how much the hollow is domed towards the axis, mm
};

/// From the axis out through the hollow and around the ring; ends on the ring's
/// outer edge, going up. The ring stands on a flat band: what the potter wipes
/// free of glaze.
Outline draw_foot(const Foot& f) {
    const double edge = 0.7;  // rounding of the ring's edges, mm
    const double z = f.height;
    const double fillet = 2.2;
    Outline o{{0, z + f.hollow_rise}};
    add_curve(o, {f.inner * 0.4, z + f.hollow_rise}, {f.inner * 0.7, z}, {f.inner - fillet, z}, 9);
    add_curve(o, {f.inner - 0.9, z}, {f.inner - 0.15, z - 0.9}, {f.inner, z - fillet}, 5);
    add_line(o, {f.inner + 0.5, edge}, 5);
    add_curve(o, {f.inner + 0.53, 0.3}, {f.inner + 0.8, 0}, {f.inner + 0.5 + edge, 0}, 4);
    add_line(o, {f.outer - edge, 0}, 4);
    add_curve(o, {f.outer - 0.3, 0}, {f.outer, 0.3}, {f.outer + 0.03, edge}, 4);
    return o;
}

}  // namespace

Shape make_bowl() {
    Outline o = draw_foot({.outer = 32.5, .inner = 28, .height = 6.5});
    add_line(o, {32.9, 6.8}, 6);
    add_curve(o, {33.1, 8.6}, {34.2, 9.5}, {36.2, 10.2}, 7);  // hollow between foot and wall
    Outline wall{o.back()};
    const Vec2 keys[] = {{48.5, 17.0}, {60.0, 29.0}, {68.0, 43.5}, {72.6, 57.0}, {75.2, 66.0}};
    add_spline(wall, keys, {3.0, 1.05}, {0.36, 1}, 46);
    append(o, {wall.begin() + 1, wall.end()});
    const auto thickness = [](double t) { return 3.9 - 1.4 * t - 0.5 * t * t * t * t; };
    const Outline inside = inner_side(wall, thickness);
    add_half_round(o, inside.front(), 10);
    append(o, {inside.begin() + 1, inside.end()});
    const Vec2 at = o.back();  // the floor goes on as the wall arrives, and ends level
    add_curve(o, {at.x - 9, at.y - 3.15}, {at.x * 0.45, 11.6}, {0, 11.6}, 18);
    return turn(o, 120);
}

Shape make_plate() {
    Outline o = draw_foot({.outer = 79, .inner = 74.5, .height = 4.5, .hollow_rise = 0.3});
    add_line(o, {79.4, 4.0}, 4);
    add_curve(o, {79.6, 5.4}, {80.6, 6.0}, {82.2, 6.6}, 6);
    Outline wall{o.back()};
    const Vec2 keys[] = {{88.5, 11.2}, {94.0, 16.2}, {101.0, 19.3}, {115.0, 22.2}, {130.0, 25.5}};
    add_spline(wall, keys, {1, 0.55}, {1, 0.24}, 40);
    append(o, {wall.begin() + 1, wall.end()});
    const Outline inside = inner_side(wall, [](double t) { return 4.2 - 1.6 * t; });
    add_half_round(o, inside.front(), 8);
    append(o, {inside.begin() + 1, inside.end()});
    const Vec2 at = o.back();
    add_curve(o, {at.x - 3.2, at.y - 1.76}, {at.x - 6, 8.6}, {at.x - 12, 8.6}, 14);
    add_line(o, {0, 8.6}, 20);
    return turn(o, 150);
}

Shape make_vase() {
    Outline o = draw_foot({.outer = 43, .inner = 37.5, .height = 7, .hollow_rise = 1.5});
    add_line(o, {43.6, 8.0}, 5);
    add_curve(o, {43.9, 10.5}, {45.2, 12.2}, {47.0, 14.0}, 8);
    Outline wall{o.back()};
    const Vec2 keys[] = {{63.0, 32.0},  {75.0, 56.0},  {77.8, 82.0},  {70.0, 112.0}, {53.0, 142.0}, {35.0, 172.0},
                         {23.5, 202.0}, {19.6, 228.0}, {22.5, 252.0}, {31.0, 271.0}, {40.0, 281.0}};
    add_spline(wall, keys, {1, 1.0}, {1, 0.75}, 84);
    append(o, {wall.begin() + 1, wall.end()});
    const Outline inside = inner_side(wall, [](double t) { return 5.0 - 2.2 * t; });
    add_half_round(o, inside.front(), 10);
    append(o, {inside.begin() + 1, inside.end()});
    const Vec2 at = o.back();
    add_curve(o, {at.x - 7, at.y - 7}, {at.x * 0.5, 12.5}, {0, 12.5}, 12);
    return turn(o, 150);
}

}  // namespace tuft::models
