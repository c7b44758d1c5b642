#pragma once

#include "core/geometry/ray.h"

/// \file
/// Camera of the window and its rays. `app` uses it for view, picking and pointer input.
namespace tuft::render {

/// Camera of the window: a pinhole, or a parallel projection.
struct GlCamera {
    Vec3 eye{0};  ///< metres, world
    Vec3 right{1, 0, 0}, up{0, 0, 1}, forward{0, 1, 0};
    double field_of_view = 0.6;      ///< radians over the height
    double parallel_height = 0;      ///< metres seen over the height; 0: pinhole
    double near = 0.01, far = 10;    ///< metres
    int width = 1280, height = 720;  ///< pixels

    bool operator==(const GlCamera&) const = default;
};

/// The ray seen at a place of the picture (pixels, origin at the top left).
Ray ray_at(const GlCamera& camera, double x, double y);

/// Place in the picture (pixels) and depth along `forward` (metres) of a point; a point
/// behind a pinhole has a depth that is not positive.
Vec3 picture_point(const GlCamera& camera, const Vec3& p);

/// Metres that one pixel spans at point p.
double metres_per_pixel(const GlCamera& camera, const Vec3& p);

}  // namespace tuft::render
