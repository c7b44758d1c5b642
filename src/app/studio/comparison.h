#pragma once

#include <memory>

#include "app/input/events.h"
#include "app/session/session.h"
#include "render/gl/gl_view.h"

namespace tuft::app {

/// The work beside one of its snapshots.
class Comparison {
  public:
    explicit Comparison(Session& session) : session_(session) {}

    bool on() const;
    /// Takes its part of the view.
    void layout();
    /// Before the work is drawn as `of_work`.
    void draw(const render::GlView::Frame& of_work, int height);
    /// Whether a press is one on the work, not on the snapshot beside or over it.
    bool on_work(const Event& e) const;
    void drop_graphics();

  private:
    void take_picture();

    Session& session_;
    std::unique_ptr<render::GlScene> scene_;  ///< the snapshot's
    std::unique_ptr<render::GlView> view_;
};

}  // namespace tuft::app
