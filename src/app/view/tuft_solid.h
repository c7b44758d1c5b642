#pragma once

#include "brush/tuft/tuft.h"
#include "render/gl/gl_scene.h"

namespace tuft::app {

/// Hair, as it is dipped into an ink of that colour (sRGB), and ferrule as triangles for drawing.
render::GlSolid solid_of(const brush::TuftState& tuft, unsigned ink);
/// Linear colour of hair at a place between the tip (0) and the root (1) of a tuft dipped into `ink`.
Vec3f hair_colour(double from_tip, unsigned ink);

}  // namespace tuft::app
