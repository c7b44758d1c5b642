#pragma once

#include "brush/tuft/tuft.h"
#include "render/brush/brush_canvas.h"

/// \file
/// Drawing of one tuft into a picture. Called by brush_picture.h.
namespace tuft::render {

/// From metres to pixels: parallel projection.
struct BrushView {
    Vec2 foot{0};                      ///< pixel of `origin`
    Vec3 origin{0};                    ///< metres
    double scale = 1;                  ///< pixels per metre
    Vec3 right{1, 0, 0}, up{0, 0, 1};  ///< unit, of the picture

    Vec2 operator()(const Vec3& p) const {
        return foot + scale * Vec2{glm::dot(p - origin, right), -glm::dot(p - origin, up)};
    }
    Vec3 toward() const { return glm::cross(right, up); }  ///< the viewer
};

/// How a tuft is drawn.
struct TuftAppearance {
    bool dry = false;   ///< dry hair: no point, open marks
    double ground = 0;  ///< metres, height of the sheet; hair pressed below it is drawn on it
};

/// A tuft, its state and its pose. The references must outlive the call.
struct PosedTuft {
    const brush::Tuft& tuft;
    const brush::TuftState& state;
    const brush::Pose& pose;
};

/// Draws the tuft hair by hair, with the holder of `length` metres. Nearer parts hide farther ones, so the
/// ferrule's rim covers the roots seen from above.
void draw_brush(BrushCanvas& canvas, const PosedTuft& posed, const BrushView& view, double length,
                const TuftAppearance& appearance = {});

/// Draws the contact patch seen from above with x to the right; its middle line is y = `y` of the picture.
void draw_patch(BrushCanvas& canvas, const brush::Tuft& tuft, const brush::TuftState& state, const BrushView& view,
                double y, const TuftAppearance& appearance = {});

}  // namespace tuft::render
