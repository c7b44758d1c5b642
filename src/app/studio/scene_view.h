#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/input/events.h"
#include "app/session/session.h"
#include "app/studio/comparison.h"
#include "brush/tuft/tuft.h"
#include "render/gl/gl_view.h"

/// \file
/// The model's view. Window thread, with the OpenGL context current.
namespace tuft::app {

/// Draws the model, the tuft over it and the atlas beside it.
class SceneView {
  public:
    explicit SceneView(Session& session);

    Comparison& comparison() { return comparison_; }
    const Comparison& comparison() const { return comparison_; }
    /// Loads a newly opened model, and changed texels.
    void take_model();
    void take_texels();
    /// Updates the tuft: in contact, in the air where an arm guides it, or hovering over the cursor (null: not over the
    /// model). `now`: seconds.
    void update_tuft(const Event* cursor, const std::optional<brush::Pose>& guided, double now);
    /// Draws into a framebuffer of that height. `moving`: a coarser picture suffices.
    void draw(unsigned framebuffer, int height, bool moving);
    /// Frees all graphics objects before the OpenGL context is lost; creates them in the new one.
    void drop_graphics();
    void make_graphics();

  private:
    void choose_preview();
    void hover(const brush::Pose& pose);
    void take_parts();
    void show_triangle_colours();
    void draw_atlas(const render::DrawOptions& options, unsigned framebuffer, int height);

    /// Parts as the scene shows them.
    struct PartLook {
        stroke::PartTable parts;
        float transmission = 0;   ///< of the document's substrate
        bool is_preview = false;  ///< which is seen everywhere

        bool operator==(const PartLook&) const = default;
    };

    Session& session_;
    Comparison comparison_;
    std::unique_ptr<render::GlScene> scene_;
    std::unique_ptr<render::GlView> view_;
    PartLook parts_;
    ModelView shading_ = ModelView::glaze;  ///< of the scene's present colours
    std::optional<brush::Tuft> preview_;    ///< hovering tuft
    std::string preview_brush_;             ///< its name; empty: to be read again
};

}  // namespace tuft::app
