#pragma once

#include "app/view/references.h"
#include "app/view/texture.h"
#include "app/view/viewport.h"
#include "brush/tuft/tuft.h"
#include "render/gl/gl_scene.h"

namespace tuft::app {

enum class ModelView { glaze, clay, flat, height, wetness, texels, charts, stretch };
inline constexpr int kModelViews = 8;

/// A part of the window, pixels.
struct Area {
    int x = 0, y = 0, width = 1, height = 1;
};

/// The model cut open along an axis.
struct SectionView {
    bool on = false;
    int axis = 1;           ///< 0 x, 1 y, 2 z
    double position = 0.5;  ///< part of the model's size that stays
};

/// The atlas beside the model.
struct AtlasView {
    bool shown = false;
    Vec2 centre{0.5};  ///< uv in the middle of it
    double zoom = 1;   ///< 1: all of it is seen
    Area area;
};

/// The tuft as it is drawn.
struct TuftView {
    brush::TuftState state;
    double depth = 0;      ///< metres of the unbent tip below the surface
    bool pressed = false;  ///< else it hovers
    brush::Pose pose;      ///< of its ferrule while it hovers
    /// Of the ferrule's mouth, in its frame, metres; empty: round.
    std::vector<Vec2> mouth;
};

/// How the model is looked at.
struct ViewState {
    Orbit orbit;
    Area area;  ///< that the model has
    ModelView shading = ModelView::glaze;
    render::LightRig rig = render::LightRig::studio;
    SectionView section;
    AtlasView atlas;
    bool see_through = false;     ///< tuft
    bool show_tuft_inset = true;  ///< side view of the tuft
    double max_ink_height = 0;    ///< micrometres, of the ink seen so far
    bool model_changed = false;   ///< the scene has to take the open model over
    TexelUpdate texels;           ///< for the scene
    bool keep_camera = false;     ///< and looks at it as at the one before
    TuftView tuft;
    References references;
};

/// The plane where a model with these bounds is cut; zero when it is not cut.
Vec4f section_plane(const ViewState& view, const Box& bounds);

/// Pixels of the window per side of the atlas; the pixel of a uv, and back.
double pixels_per_side(const AtlasView& atlas);
Vec2 on_atlas(const AtlasView& atlas, const Vec2& uv);
Vec2 uv_at(const AtlasView& atlas, double x, double y);

}  // namespace tuft::app
