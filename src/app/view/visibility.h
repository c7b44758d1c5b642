#pragma once

#include "mesh/query/surface_query.h"
#include "render/gl/gl_camera.h"

/// \file
/// Occlusion of surface points. Any thread.
namespace tuft::app {

/// Returns true when a surface point is visible: the ray of its pixel hits nothing before it that `section` (see
/// `render::DrawOptions`) leaves. `tolerance`: metres along the ray by which the point may be deeper. Cost: one ray,
/// and one more for each surface that the section hides.
bool is_seen(const mesh::SurfaceQuery& query, const render::GlCamera& camera, const Vec4f& section, const Vec3& place,
             double tolerance);

}  // namespace tuft::app
