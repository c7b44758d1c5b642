#pragma once

#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "app/input/events.h"
#include "app/session/session.h"
#include "app/tools/tip_lag_cache.h"

namespace tuft::app {

/// What a stroke is painted with, by hand or along a line.
BeginStroke stroke_to_begin(const Session& s);

/// The stroke that a pointer draws on the model or on the palette.
class StrokeInput {
  public:
    StrokeInput(Session& session, TipLagCache& tip_lag) : session_(session), tip_lag_(tip_lag) {}

    bool drawing() const { return hand_.has_value(); }
    void press(const Event& e);
    /// Stirs, pours or picks on the palette, as its tool says.
    void press_palette(const Event& e);
    void move(const Event& e);
    /// The view turned under the cursor, which stays where it is.
    void follow_view(const Event& cursor);
    void release(const Event& e);
    /// Takes the stroke back.
    void cancel();
    /// Ends the stroke where it is.
    void lift(double now);
    /// The model is another one: there is no stroke.
    void drop();

    /// The last frame is on the screen at `now`.
    void shown(double now);
    /// Seconds from each sample to the moment when its ink was shown, since the last call.
    std::vector<double> take_delays() { return std::exchange(delays_, {}); }
    std::size_t samples() const { return samples_; }  ///< that went to the paint thread so far

  private:
    Aim aim(const Event& e) const;
    void start(const mesh::SurfaceQuery& surface, const brush::Preset& preset, bool on_plate);
    void post(std::vector<HandStep> steps, double time);

    Session& session_;
    TipLagCache& tip_lag_;
    std::optional<PointerInput> hand_;
    std::optional<stroke::Model> plate_;  ///< of the palette, once it was painted on
    bool on_plate_ = false;               ///< the stroke is there
    std::deque<double> asked_;            ///< when each sample was taken whose ink is not shown yet
    std::vector<double> delays_;
    std::size_t samples_ = 0;
};

}  // namespace tuft::app
