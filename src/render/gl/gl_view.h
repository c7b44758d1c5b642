#pragma once

#include <memory>
#include <vector>

#include "render/gl/gl_scene.h"

/// \file
/// The view of a scene, redrawn only where it changed. `app` draws every frame through it.
namespace tuft::render {

/// Appearance of the model, without the camera.
struct GlAppearance {
    DrawOptions options;
    GlLight light;
    Vec3f low{0.25f}, high{0.4f};  ///< backdrop, sRGB-encoded

    bool operator==(const GlAppearance&) const = default;
};

/// An antialiased view of a scene. The picture of the model is cached while the camera does not move. New ink is
/// drawn into the part of it that it covers; the tuft is drawn over a copy. A frame during painting is therefore
/// cheap even with a software driver.
class GlView {
  public:
    GlView();
    ~GlView();
    GlView(const GlView&) = delete;
    GlView& operator=(const GlView&) = delete;

    /// The texture changed on the surface inside boxes.
    void texture_changed(std::span<const GlBox> boxes);
    /// The mesh, the whole texture or the triangle colours changed.
    void scene_changed();

    struct Frame {
        GlCamera camera;
        GlAppearance appearance;
        const GlSolid* solid = nullptr;  ///< drawn over the model, or nullptr
        float opacity = 1;               ///< of the solid
        bool moving = false;             ///< camera changes follow: fast, without smooth edges
        unsigned framebuffer = 0;        ///< where it goes, with its lower left corner at
        int x = 0, y = 0;
    };
    /// Draws a frame. While camera, light and options stay, only the part with new ink is drawn anew.
    void draw(GlScene& scene, const Frame& frame);

  private:
    void warm_up(GlScene& scene, const Frame& frame);

    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tuft::render
