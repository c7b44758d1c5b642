#pragma once

#include <memory>

#include "app/input/events.h"
#include "app/session/session.h"
#include "render/gl/gl_view.h"

/// \file
/// Comparison of the work with a snapshot. Window thread.
namespace tuft::app {

/// Shows one snapshot beside or over the work.
class Comparison {
  public:
    explicit Comparison(Session& session) : session_(session) {}

    /// Whether two states stand side by side.
    bool on() const;
    /// Takes its part of the view's area.
    void layout();
    /// Draws the snapshot with the frame options of the work. Call it before the work is drawn.
    void draw(const render::GlView::Frame& of_work, int height);
    /// Returns true for a press on the work, false for one on the snapshot.
    bool on_work(const Event& e) const;
    void drop_graphics();

  private:
    void take_picture();

    Session& session_;
    std::unique_ptr<render::GlScene> scene_;  ///< of the snapshot
    std::unique_ptr<render::GlView> view_;
};

}  // namespace tuft::app
