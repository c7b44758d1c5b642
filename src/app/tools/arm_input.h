#pragma once

#include <memory>
#include <optional>

#include "app/input/events.h"
#include "app/session/session.h"

/// \file
/// The force-feedback arm over the open model: what it feels, how its space lies in the view, its strokes. Window
/// thread.
namespace tuft::app {

/// Joins the arm with the session, once a frame.
class ArmInput {
  public:
    explicit ArmInput(Session& session) : session_(session) {}

    /// `now`: seconds, of the frame. `pointer_draws`: a stroke is being drawn with the pointer, so the arm draws none.
    void update(double now, bool pointer_draws);
    /// The pointer as the hand of a simulated arm: moves it, or presses it onto the model. Returns false where the
    /// pointer is free for other tools.
    bool press(const Event& e);
    void move(const Event& e);
    void release(const Event& e);
    /// Drops the arm's stroke. Returns false where it draws none.
    bool cancel();
    /// Pose of the brush in the air that the arm guides; none while none is felt.
    std::optional<brush::Pose> hover() const;

  private:
    void follow_scene();
    void control(double now);
    void report();
    std::optional<Frame> start_frame() const;
    Quat axes() const;

    Session& session_;
    std::optional<stroke::Model> plate_;                 ///< of the palette, created when the arm first works on it
    std::string brush_;                                  ///< felt at present
    brush::Preset preset_;                               ///< of it
    const PaintThread* work_ = nullptr;                  ///< whose model is felt
    std::shared_ptr<const mesh::SurfaceQuery> surface_;  ///< of its visible parts
    bool on_palette_ = false, with_view_ = true, pressed_ = false;
    double scale_ = 1, counted_at_ = 0;
    std::uint64_t counted_periods_ = 0;
};

}  // namespace tuft::app
