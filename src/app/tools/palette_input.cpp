#include "app/tools/palette_input.h"

namespace tuft::app {
namespace {

constexpr double kHigh = 0.2;  // metres above the plate from where it is looked at

}  // namespace

bool in_palette(const PaletteState& p, const Event& e) {
    return p.shown && p.width > 0 && e.x >= p.x && e.y >= p.y && e.x < p.x + p.width && e.y < p.y + p.height;
}

Aim palette_aim(const PaletteState& p, const Event& e) {
    const double width = p.width > 0 ? p.width : 1, height = p.width > 0 ? p.height : 1;
    const Vec3 from{((e.x - p.x) / width - 0.5) * stroke::kPaletteWidth,
                    (0.5 - (e.y - p.y) / height) * stroke::kPaletteHeight, kHigh};
    Aim aim{.ray = {from, {0, 0, -1}},
            .view_right = {1, 0, 0},
            .view_up = {0, 1, 0},
            .metres_per_pixel = stroke::kPaletteWidth / width,
            .time = e.time,
            .pressure = e.pressure};
    if (e.pressure >= 0) {
        aim.tilt = Vec2(e.tilt.x, -e.tilt.y);
        aim.turn = e.turn;
    }
    return aim;
}

}  // namespace tuft::app
