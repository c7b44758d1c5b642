#pragma once

#include "mesh/query/surface_query.h"
#include "render/gl/gl_camera.h"

namespace tuft::app {

/// Whether a place on the surface is seen in the picture: the ray of its pixel meets nothing before it that `section`
/// (see `render::DrawOptions`) leaves standing. `tolerance`: metres along the ray by which the place may lie deeper.
/// Cost: a ray, and another one for each surface that the section hides.
bool is_seen(const mesh::SurfaceQuery& query, const render::GlCamera& camera, const Vec4f& section, const Vec3& place,
             double tolerance);

}  // namespace tuft::app
