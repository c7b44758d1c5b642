#pragma once

#include <span>

#include "brush/calibration/compare.h"
#include "render/brush/brush_picture.h"

/// \file
/// Picture of the spine methods beside a measured brush, for `tuft brush --compare`.
namespace tuft::render {

/// Draws width, contact length and offset of every model over depth, the measured ones as dots, and the spines at the
/// greatest depth from the side. Each method has its colour, named above. `width` in pixels, 320 to 8000; the height
/// follows.
BrushPicture draw_comparison(std::span<const brush::ModelSweep> models, std::span<const brush::SweepRow> measured,
                             int width = 2000);

}  // namespace tuft::render
