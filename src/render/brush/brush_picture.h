#pragma once

#include <cstdint>
#include <vector>

#include "brush/preset/preset.h"

namespace tuft::render {

/// 8-bit sRGB picture, row 0 on top, [height * width * 3].
struct BrushPicture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

/// The tuft on a flat sheet, hair by hair, with millimetre scale and what it touches. Three rows from
/// the side: held upright, leaning ahead and leaning back, dragged to the left at five depths and
/// lifted from the last. A fourth row from behind and above: a slanted tip, a tip turned round, a
/// split one and a dry one. `width` in pixels, 320 to 8000; the height follows.
BrushPicture draw_tuft(const brush::Preset& preset, int width = 2000);

}  // namespace tuft::render
