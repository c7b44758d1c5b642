#pragma once

#include "render/brush/tuft_drawing.h"

/// \file
/// Drawing of carried shapes, meshes, hairs and foam, and of their contact patches. Called by tuft_drawing.h.
namespace tuft::render {

/// Draws the shape: of a mesh the triangles that face the viewer, the nearest last; pores of foam as dark spots.
void draw_shape(BrushCanvas& canvas, const brush::TuftShape& shape, const BrushView& view);

/// Draws the contact patch as it is painted, seen from above; as `draw_patch`.
void draw_shape_patch(BrushCanvas& canvas, const brush::Tuft& tuft, const brush::TuftShape& shape,
                      const BrushView& view, double y);

}  // namespace tuft::render
