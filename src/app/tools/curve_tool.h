#pragma once

#include <optional>

#include "app/input/events.h"
#include "app/session/session.h"
#include "app/tools/tip_lag_cache.h"

namespace tuft::app {

/// Lines and curves: setting, moving and painting their control points. `now`: seconds on the window's clock.
class CurveTool {
  public:
    CurveTool(Session& session, TipLagCache& tip_lag) : session_(session), tip_lag_(tip_lag) {}

    void press(const Event& e);
    void drag(const Event& e);
    void release(const Event& e, double now);
    /// Changes the pressure of the point under the cursor.
    void wheel(const Event& e, double now);
    /// False where the key is none of the tool's.
    bool key(const Event& e, double now);
    /// Looks whether the curve is painted, and over which point the cursor is; null: over none.
    void watch(const Event* cursor);
    void drop() { line_start_.reset(); }

  private:
    int point_at(const Event& e) const;
    std::optional<CurvePoint> point_of(const Event& e) const;
    bool editable() const;
    void paint(double now);

    Session& session_;
    TipLagCache& tip_lag_;
    std::optional<Event> line_start_;  ///< where a new control point was set
};

}  // namespace tuft::app
