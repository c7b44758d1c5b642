#pragma once

#include <optional>

#include "core/geometry/types.h"
#include "render/gl/gl_camera.h"
#include "stroke/placement/model_motion.h"

/// \file
/// The camera's orbit. Window thread.
namespace tuft::app {

enum class StandardView { front, back, right, left, top, bottom };

/// Turntable camera: the world's z is up, unless rolled.
struct Orbit {
    Vec3 target{0};                      ///< metres, centre of view and of rotation
    double distance = 0.5;               ///< metres
    double azimuth = 0.5;                ///< radians; 0 looks along +y
    double elevation = 0.5;              ///< radians
    double roll = 0;                     ///< radians, of the head to the right
    double field_of_view = 0.55;         ///< radians over the shorter side of the picture
    bool parallel = false;               ///< orthographic projection
    bool parallel_until_turned = false;  ///< `parallel` ends with the next rotation

    /// Places the camera so that the whole box is visible.
    void frame(const Box& box);
    /// Retains the picture of a revised model: the target moves with it, and the distance scales. Frames the model
    /// where the target is then outside `box`, that of the revised model.
    void follow(const std::optional<stroke::ModelMotion>& motion, const Box& box);
    /// Looks along an axis, in parallel projection until the next rotation, as in Blender.
    void look_from(StandardView view);
    /// Sets the projection permanently.
    void set_parallel(bool on);
    /// Rotates about the target by 0.007 rad a pixel; upwards at most to the zenith.
    void turn(double dx_pixels, double dy_pixels);
    /// Moves the target in the picture plane, so that the point under the cursor stays there.
    void pan(double dx_pixels, double dy_pixels, int shorter_side);
    /// Moves the model as a SpaceMouse's cap is deflected. `push` and `twist` as in `Event`: at full push the model
    /// crosses the picture's shorter side in one second; at full twist it rotates by 2 radians. `level` retains the
    /// horizon.
    void fly(const Vec3& push, const Vec3& twist, bool level);
    /// Moves nearer (steps > 0). The point `towards` keeps its position in the picture.
    void zoom(double steps, const Vec3& towards);
    render::GlCamera camera(int width, int height, const Box& scene) const;
};

}  // namespace tuft::app
