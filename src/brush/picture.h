#pragma once

#include <cstdint>
#include <vector>

#include "brush/preset.h"

namespace tuft::brush {

/// 8-bit sRGB picture, row 0 on top, [height * width * 3].
struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

struct PictureOptions {
    int width = 1600, height = 900;
    double tilt = 0;          ///< radians of the holder from upright, leaning against the drag
};

/// Side view of the tuft pressed to five depths and dragged to the left on a flat sheet,
/// with hair, ground line and millimetre scale.
Picture draw_tuft(const Preset& preset, const PictureOptions& options = {});

}  // namespace tuft::brush
