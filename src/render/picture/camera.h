#pragma once

#include <optional>
#include <span>

#include "core/geometry/types.h"

/// \file
/// Pinhole camera of a product picture, over the model frame, z up.
namespace tuft::render {

/// Viewpoint. Azimuth rotates about z: at 0 the camera is on the −y side and looks towards +y, at π/2 it is on the
/// +x side. Elevation raises it above the ground.
struct View {
    double azimuth = 0.6;          ///< radians
    double elevation = 0.45;       ///< radians, within ±π/2
    double field_of_view = 0.42;   ///< radians, over the picture's height, in (0, 3)
    double margin = 0.1;           ///< part of the picture kept free on each side when fitting
    std::optional<Vec3> target;    ///< metres; looks here instead of fitting the whole object
    double distance = 0;           ///< metres from eye to target; 0: such that `width_at_target` fits
    double width_at_target = 0.1;  ///< metres seen across the picture at the target

    bool operator==(const View&) const = default;
};

/// Camera of a picture, without lens: a point and a plane.
struct Camera {
    Vec3 eye{0};                                         ///< metres
    Vec3 right{1, 0, 0}, up{0, 0, 1}, forward{0, 1, 0};  ///< unit, orthogonal
    double tan_half_height = 0.2;                        ///< of half the field of view over the height
    int width = 1280, height = 720;                      ///< pixels
};

/// Returns the camera for a picture of `width` × `height` pixels. Without a target the eye is as near as possible
/// with all `points` (the object's vertices, metres) inside the margins, exactly centred. Without points it looks
/// at the origin from 1 m. Throws `Error` for a picture size outside 1 … 16384 or a view out of range.
Camera make_camera(const View& view, int width, int height, std::span<const Vec3f> points);

/// Unit direction through picture position (x, y) in pixels; pixel (0, 0) is the top
/// left one and has its centre at (0.5, 0.5).
Vec3 ray_direction(const Camera& camera, double x, double y);

/// Picture position and depth along `forward` in metres of a point before the eye.
std::optional<Vec3> project(const Camera& camera, const Vec3& p);

}  // namespace tuft::render
