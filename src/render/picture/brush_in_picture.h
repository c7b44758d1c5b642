#pragma once

#include "brush/tuft/tuft.h"
#include "mesh/query/surface_query.h"
#include "render/picture/camera.h"
#include "render/picture/picture.h"

/// \file
/// The bent tuft and its holder over a product picture. Called by `tuft film`.
namespace tuft::render {

/// Draws the tuft hair by hair, with a holder of `length` metres, where no nearer part of the model hides it.
/// Projection: that of the camera to first order about the tip of the tuft. A point of the brush counts as nearer than
/// the model where it is in front of it by more than −0.7 of the brush's half-width there, so that hair pressed onto
/// the surface is seen. A brush behind the camera is not drawn. Cost: about 50 ms for a tuft 300 pixels long.
void draw_brush_in_picture(Image& image, const Camera& camera, const mesh::SurfaceQuery& query, const brush::Tuft& tuft,
                           const brush::TuftState& state, double length);

}  // namespace tuft::render
