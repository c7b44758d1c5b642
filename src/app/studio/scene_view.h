#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/input/events.h"
#include "app/session/session.h"
#include "app/studio/comparison.h"
#include "brush/tuft/tuft.h"
#include "render/gl/gl_view.h"

namespace tuft::app {

/// Draws the model, the tuft over it and the atlas beside it.
class SceneView {
  public:
    explicit SceneView(Session& session);

    Comparison& comparison() { return comparison_; }
    const Comparison& comparison() const { return comparison_; }
    /// Takes a model over that was just opened, and texels that changed.
    void take_model();
    void take_texels();
    /// Places the tuft as it is pressed, or as it would hover over the cursor; null: over nothing.
    void update_tuft(const Event* cursor, double now);
    /// `moving`: the picture may be coarser.
    void draw(unsigned framebuffer, int height, bool moving);
    /// The OpenGL context is gone, or goes; then there is a new one.
    void drop_graphics();
    void make_graphics();

  private:
    void show_triangle_colours();
    void draw_atlas(const render::DrawOptions& options, unsigned framebuffer, int height);

    Session& session_;
    Comparison comparison_;
    std::unique_ptr<render::GlScene> scene_;
    std::unique_ptr<render::GlView> view_;
    ModelView shading_ = ModelView::glaze;  ///< that the scene has the colours of
    std::optional<brush::Tuft> preview_;    ///< hovers
    std::string preview_brush_;
};

}  // namespace tuft::app
