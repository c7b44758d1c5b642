#pragma once

#include "brush/tuft/tuft.h"
#include "render/brush/brush_canvas.h"

/// One tuft drawn into a picture.
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

struct TuftLook {
    bool dry = false;   ///< no water holds the hair to a point or closes its marks
    double ground = 0;  ///< metres, height of the sheet: what was pressed into it rests on it
};

/// Hair by hair, with the holder of `length` metres: what is nearer hides what is behind it, so
/// that the ferrule's rim closes over the roots where it is seen from above.
void draw_brush(BrushCanvas& canvas, const brush::Tuft& tuft, const brush::TuftState& state, const brush::Pose& pose,
                const BrushView& view, double length, const TuftLook& look = {});

/// What touches the sheet, seen from above with x to the right: its middle line y = `y` of the
/// picture.
void draw_patch(BrushCanvas& canvas, const brush::Tuft& tuft, const brush::TuftState& state, const BrushView& view,
                double y, const TuftLook& look = {});

}  // namespace tuft::render
