#pragma once

#include <cstdint>
#include <vector>

#include "brush/preset/preset.h"

/// \file
/// Picture of a brush preset for `tuft brush`.
namespace tuft::render {

/// 8-bit sRGB picture, row 0 on top, [height * width * 3].
struct BrushPicture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

/// Draws the tuft on a flat sheet, hair by hair, with a millimetre scale and its contact patch. Three rows show it
/// from the side: upright, tilted forward and tilted back; dragged to the left at five depths and lifted from the
/// last. A fourth row shows it from behind and above: a slanted tip, a rotated tip, a split one and a dry one.
/// `width` in pixels, 320 to 8000; the height follows.
BrushPicture draw_tuft(const brush::Preset& preset, int width = 2000);

}  // namespace tuft::render
