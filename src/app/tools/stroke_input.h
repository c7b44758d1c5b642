#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "app/input/events.h"
#include "app/session/session.h"
#include "app/tools/tip_lag_cache.h"

/// \file
/// Strokes drawn with a pointer. Window thread.
namespace tuft::app {

/// Returns the command that begins a stroke with the present brush, ink, layer and mask.
BeginStroke stroke_to_begin(const Session& s);
/// The same on the palette.
BeginStroke stroke_to_stir(const Session& s);

/// The stroke being drawn on the model or on the palette.
class StrokeInput {
  public:
    StrokeInput(Session& session, TipLagCache& tip_lag) : session_(session), tip_lag_(tip_lag) {}

    bool drawing() const { return hand_.has_value(); }
    /// Pen down on the model, with the active brush.
    void press(const Event& e);
    /// Stirs, pours or picks on the palette, by its tool.
    void press_palette(const Event& e);
    /// Continues the stroke.
    void move(const Event& e);
    /// Moves the stroke after the view turned under the cursor.
    void follow_view(const Event& cursor);
    /// Pen up: ends the stroke where the button came up.
    void release(const Event& e);
    /// Cancels the stroke.
    void cancel();
    /// Ends the stroke at its present point.
    void lift(double now);
    /// Forgets the stroke, because the model was replaced.
    void drop();

    /// Reports that the last frame was presented at `now`, seconds.
    void shown(double now);
    /// Returns the seconds from each sample until its ink was presented, of all samples since the last call.
    std::vector<double> take_delays() { return std::exchange(delays_, {}); }
    std::size_t samples() const { return samples_; }  ///< sent to the paint thread so far

  private:
    Aim aim(const Event& e) const;
    void start(const mesh::SurfaceQuery& surface, const brush::Preset& preset, bool on_plate);
    void post(std::vector<StrokeStep> steps, double time);

    Session& session_;
    TipLagCache& tip_lag_;
    std::shared_ptr<const mesh::SurfaceQuery> surface_;  ///< of the stroke: parts may be hidden meanwhile
    std::optional<PointerInput> hand_;
    std::optional<stroke::Model> plate_;  ///< of the palette, created with its first stroke
    bool on_plate_ = false;               ///< the stroke is on the palette
    std::deque<double> sent_at_;          ///< seconds, of samples whose ink is not presented yet
    std::vector<double> delays_;
    std::size_t samples_ = 0;
};

}  // namespace tuft::app
