#pragma once

#include <optional>

#include "app/input/events.h"
#include "app/session/session.h"

namespace tuft::app {

/// Placing writing and drawings with the mouse. `cursor`: over the model; null where it is not.
class WritingTool {
  public:
    explicit WritingTool(Session& session) : session_(session) {}

    /// Shows where the writing would lie.
    void watch(const Event* cursor);
    /// Scales it; with Shift, turns it.
    void wheel(const Event& e);
    /// Paints it there.
    void place(const Event* cursor);

  private:
    std::optional<stroke::Placement> placement(const Event* cursor) const;

    Session& session_;
    // What the preview was made for.
    stroke::Placement placement_;
    double scale_ = 0;
    render::GlCamera camera_;
    Vec4f section_{0};
};

}  // namespace tuft::app
