#pragma once

#include "app/view/references.h"
#include "app/view/texture.h"
#include "app/view/viewport.h"
#include "brush/tuft/tuft.h"
#include "render/gl/gl_scene.h"

/// \file
/// State of the view. Window thread.
namespace tuft::app {

enum class ModelView { glaze, clay, flat, height, wetness, texels, charts, stretch };
inline constexpr int kModelViews = 8;

/// A rectangle of the window, pixels.
struct Area {
    int x = 0, y = 0, width = 1, height = 1;
};

/// A planar section of the model.
struct SectionView {
    bool on = false;
    int axis = 1;           ///< 0 x, 1 y, 2 z
    double position = 0.5;  ///< fraction of the model's size that remains
};

/// The atlas beside the model.
struct AtlasView {
    bool shown = false;
    Vec2 centre{0.5};  ///< UV at the centre
    double zoom = 1;   ///< 1: the whole atlas is visible
    Area area;
};

/// The tuft to draw.
struct TuftView {
    brush::TuftState state;
    double depth = 0;      ///< metres of the unbent tip below the surface
    bool pressed = false;  ///< in contact; else hovering
    brush::Pose pose;      ///< of the ferrule while it hovers
    /// Outline of the ferrule's mouth, ferrule frame, metres; empty: round.
    std::vector<Vec2> mouth;
};

/// How the model is viewed.
struct ViewState {
    Orbit orbit;
    Area area;  ///< of the model's view
    ModelView shading = ModelView::glaze;
    render::LightRig rig = render::LightRig::studio;
    SectionView section;
    AtlasView atlas;
    bool see_through = false;     ///< draws the tuft transparent
    bool show_tuft_inset = true;  ///< side view of the tuft
    double max_ink_height = 0;    ///< micrometres, greatest so far
    bool model_changed = false;   ///< the scene has to load the open model
    TexelUpdate texels;           ///< for the scene
    bool keep_camera = false;     ///< the camera stays when the model changes
    TuftView tuft;
    References references;
};

/// Returns the section's plane for a model with these bounds; zero without a section.
Vec4f section_plane(const ViewState& view, const Box& bounds);

/// Returns the pixels per side of the atlas; converts a UV to pixels of the window, and back.
double pixels_per_side(const AtlasView& atlas);
Vec2 on_atlas(const AtlasView& atlas, const Vec2& uv);
Vec2 uv_at(const AtlasView& atlas, double x, double y);

}  // namespace tuft::app
