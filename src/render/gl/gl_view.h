#pragma once

#include <memory>
#include <vector>

#include "render/gl/gl_scene.h"

namespace tuft::render {

/// What the model looks like besides the camera.
struct GlLook {
    DrawOptions options;
    GlLight light;
    Vec3f low{0.25f}, high{0.4f};  ///< backdrop, sRGB-encoded

    bool operator==(const GlLook&) const = default;
};

/// The view of a scene, antialiased, drawn anew only where something changed: the picture of
/// the model is kept while the camera stands still, and ink that arrives is drawn into
/// the part of it that it covers; the tuft is drawn over a copy. So a frame while painting costs
/// little even where the driver draws in software.
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
        GlLook look;
        const GlSolid* solid = nullptr;  ///< drawn over the model, or nullptr
        float opacity = 1;               ///< of the solid
        bool moving = false;             ///< more camera changes follow at once: speed before smooth edges
        unsigned framebuffer = 0;        ///< where it goes, with its lower left corner at
        int x = 0, y = 0;
    };
    void draw(GlScene& scene, const Frame& frame);

  private:
    void warm_up(GlScene& scene, const Frame& frame);

    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tuft::render
