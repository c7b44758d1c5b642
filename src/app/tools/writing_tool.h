#pragma once

#include <optional>

#include "app/input/events.h"
#include "app/session/session.h"
#include "app/tools/placing.h"

/// \file
/// The tool for drawings and handwriting. Window thread.
namespace tuft::app {

/// Places a drawing with the mouse. `cursor`: over the model; null where it is not.
class WritingTool {
  public:
    explicit WritingTool(Session& session) : session_(session) {}

    /// Updates the preview of the drawing at the cursor, and places it where a place was typed. Only while the tool is
    /// active.
    void watch(const Event* cursor);
    /// Scales the drawing; with Shift, turns it.
    void wheel(const Event& e);
    /// Paints the drawing at the cursor.
    void place(const Event* cursor);

  private:
    stroke::Placement placement_at(const PlacingSpot& spot) const;
    void place(const PlacingSpot& spot);

    Session& session_;
    // Arguments of the last preview.
    stroke::Placement placement_;
    double scale_ = 0;
    render::GlCamera camera_;
    Vec4f section_{0};
};

}  // namespace tuft::app
