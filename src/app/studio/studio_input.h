#pragma once

#include "app/input/events.h"
#include "app/session/session.h"
#include "app/studio/comparison.h"
#include "app/tools/arm_input.h"
#include "app/tools/curve_tool.h"
#include "app/tools/lettering_tool.h"
#include "app/tools/stroke_input.h"
#include "app/tools/writing_tool.h"

/// \file
/// Dispatch of input events. Window thread.
namespace tuft::app {

/// Passes input events to the view, the tools and the keys.
class StudioInput {
  public:
    StudioInput(Session& session, const Comparison& comparison);

    /// Handles one event. `now`: seconds, of the frame on the events' clock.
    void handle(const Event& e, double now);
    /// Updates everything that follows the cursor or the arm. `now`: seconds.
    void watch(double now);
    /// Forgets strokes and curves, because the model was replaced.
    void drop();

    StrokeInput& stroke() { return stroke_; }
    const StrokeInput& stroke() const { return stroke_; }
    const ArmInput& arm() const { return arm_; }
    /// Returns the cursor over the model's view; null where it is not.
    const Event* cursor() const { return inside_ ? &cursor_ : nullptr; }
    bool turning() const { return drag_ != Drag::none; }
    /// Returns true while the view is turned and for `seconds` after.
    bool turned_within(double seconds, double now) const { return turning() || now - last_turn_ < seconds; }

  private:
    enum class Drag { none, turn, pan, zoom, atlas };

    void press(const Event& e);
    bool press_view(const Event& e);
    void press_tool(const Event& e);
    void move(const Event& e);
    void release(const Event& e);
    void scroll(const Event& e);
    void fly(const Event& e);
    void key(const Event& e);
    void assign_key(const Event& e);
    void perform(Action action);
    bool perform_view(Action action);
    bool perform_tool(Action action);

    Session& session_;
    const Comparison& comparison_;
    TipLagCache tip_lag_;
    StrokeInput stroke_;
    CurveTool curve_;
    WritingTool writing_;
    LetteringTool lettering_;
    ArmInput arm_;
    Event cursor_;
    bool inside_ = false;  ///< the cursor is over the model's view
    Drag drag_ = Drag::none;
    double now_ = 0, last_turn_ = -1;
};

}  // namespace tuft::app
