#pragma once

#include "core/geometry/types.h"
#include "render/gl/gl_camera.h"

namespace tuft::app {

enum class StandardView { front, back, right, left, top, bottom };

/// Turntable camera: the world's z stays up, unless rolled.
struct Orbit {
    Vec3 target{0};                      ///< metres, looked at and turned about
    double distance = 0.5;               ///< metres
    double azimuth = 0.5;                ///< radians; 0 looks along +y
    double elevation = 0.5;              ///< radians
    double roll = 0;                     ///< radians, of the head to the right
    double field_of_view = 0.55;         ///< radians over the shorter side of the picture
    bool parallel = false;               ///< orthographic
    bool parallel_until_turned = false;  ///< only for one of the standard views

    /// Places the camera so that the whole box is seen.
    void frame(const Box& box);
    /// Straight along an axis, in parallel projection until it is turned, as in Blender.
    void look_from(StandardView view);
    /// Until it is set otherwise.
    void set_parallel(bool on);
    void turn(double dx_pixels, double dy_pixels);
    /// Moves the target in the picture plane, so that what is under the cursor stays there.
    void pan(double dx_pixels, double dy_pixels, int shorter_side);
    /// Moves the model as a SpaceMouse's cap is held: `push` and `twist` as in `Event`. Pushed all the way
    /// the model crosses the picture's shorter side in a second; twisted, it turns by 2 radians.
    /// `level`: the horizon stays as it is.
    void fly(const Vec3& push, const Vec3& twist, bool level);
    /// Moves nearer (steps > 0); what lies at `towards` keeps its place in the picture.
    void zoom(double steps, const Vec3& towards);
    render::GlCamera camera(int width, int height, const Box& scene) const;
};

}  // namespace tuft::app
