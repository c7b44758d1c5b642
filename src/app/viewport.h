#pragma once

#include "core/types.h"
#include "render/gl_scene.h"

namespace tuft::app {

/// Turntable camera as in Blender: the world's z stays up.
struct Orbit {
    Vec3 target{0};           ///< metres, looked at and turned about
    double distance = 0.5;    ///< metres
    double azimuth = 0.5;     ///< radians; 0 looks along +y
    double elevation = 0.5;   ///< radians
    double field_of_view = 0.55;

    /// Places the camera so that the whole box is seen.
    void frame(const Box& box, double aspect);
    void turn(double dx_pixels, double dy_pixels);
    /// Moves the target in the picture plane, so that what is under the cursor stays there.
    void pan(double dx_pixels, double dy_pixels, int height);
    /// Moves nearer (steps > 0) towards the target.
    void zoom(double steps);
    render::GlCamera camera(int width, int height, const Box& scene) const;
};

/// Unit direction from the eye through a pixel (origin at the top left).
Vec3 ray_through(const render::GlCamera& camera, double x, double y);

}  // namespace tuft::app
