#pragma once

#include <optional>

#include "app/input/events.h"
#include "app/session/session.h"
#include "app/tools/tip_lag_cache.h"

/// \file
/// The tool for lines and curves. Window thread.
namespace tuft::app {

/// Adds, moves and paints control points. `now`: seconds on the window's clock.
class CurveTool {
  public:
    CurveTool(Session& session, TipLagCache& tip_lag) : session_(session), tip_lag_(tip_lag) {}

    /// Set, move and end the move of a point of the curve.
    void press(const Event& e);
    void drag(const Event& e);
    void release(const Event& e, double now);
    /// Changes the pressure of the point under the cursor.
    void wheel(const Event& e, double now);
    /// Handles a key. Returns false for a key that is not one of the tool's.
    bool key(const Event& e, double now);
    /// Updates whether the curve is painted, and which point is under the cursor (null: not over the model).
    void watch(const Event* cursor);
    void drop() { line_start_.reset(); }

  private:
    int point_at(const Event& e) const;
    std::optional<CurvePoint> point_of(const Event& e) const;
    bool editable() const;
    void paint(double now);

    Session& session_;
    TipLagCache& tip_lag_;
    std::optional<Event> line_start_;  ///< press that set a new control point
};

}  // namespace tuft::app
