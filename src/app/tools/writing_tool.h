#pragma once

#include <optional>

#include "app/input/events.h"
#include "app/session/session.h"

/// \file
/// The tool for drawings and handwriting. Window thread.
namespace tuft::app {

/// Places a drawing with the mouse. `cursor`: over the model; null where it is not.
class WritingTool {
  public:
    explicit WritingTool(Session& session) : session_(session) {}

    /// Updates the preview of the drawing at the cursor, and places it where a place was typed.
    void watch(const Event* cursor);
    /// Scales the drawing; with Shift, turns it.
    void wheel(const Event& e);
    /// Paints the drawing at the cursor.
    void place(const Event* cursor);

  private:
    /// A point of the surface for the middle of the drawing, its normal towards the eye, and where that is.
    struct Spot {
        Vec3 at, normal, eye;
        std::vector<std::vector<Vec3>> guides = {};  ///< of what it snapped to
    };
    std::optional<Spot> spot(const Event* cursor) const;
    /// Where a place is typed. Shows a message and returns nothing for one that is not finite or far beside the model.
    std::optional<Spot> typed_spot() const;
    stroke::Placement placement_at(const Spot& spot) const;
    void place(const Spot& spot);

    Session& session_;
    // Arguments of the last preview.
    stroke::Placement placement_;
    double scale_ = 0;
    render::GlCamera camera_;
    Vec4f section_{0};
};

}  // namespace tuft::app
