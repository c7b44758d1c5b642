#pragma once

#include "brush/tuft/tuft.h"
#include "render/gl/gl_scene.h"

/// \file
/// The drawn tuft. Any thread.
namespace tuft::app {

/// Returns triangles of hair and ferrule. `ink`: sRGB colour (ImU32) that the hair was dipped into.
render::GlSolid solid_of(const brush::TuftState& tuft, unsigned ink);
/// Returns the linear colour of hair dipped into `ink` at a fraction from the tip (0) to the root (1).
Vec3f hair_colour(double from_tip, unsigned ink);

}  // namespace tuft::app
