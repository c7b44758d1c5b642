#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/input/events.h"
#include "app/panels/panels.h"
#include "app/session/session.h"
#include "app/studio/project_picture.h"
#include "app/studio/scene_view.h"
#include "app/studio/studio_input.h"

namespace tuft::app {

/// The window's content. Needs a current OpenGL context and an ImGui context; the place
/// where it draws is the framebuffer given to `frame`.
class Studio {
  public:
    Studio();
    ~Studio();

    Session& session() { return session_; }
    const Session& session() const { return session_; }
    /// One turn: takes events, draws everything. `now` in seconds on the events' clock.
    void frame(EventQueue& events, int width, int height, unsigned framebuffer, double now);
    /// Seconds that the next frame may wait for an event: none while the picture moves, a while
    /// during work that only shows its progress, long when nothing happens.
    double patience() const;
    /// The OpenGL context is gone, or goes; then there is a new one.
    void drop_graphics();
    void make_graphics();
    /// Ends the stroke in hand and saves everything; the project's picture is made once more where it is
    /// older than the strokes.
    void finish();
    /// What the display asks for as a scale of text.
    void set_content_scale(float scale) { content_scale_ = scale; }
    /// Changes a setting by its name in scripts. Throws `Error` for a name or value that is unknown.
    void set(const std::string& name, const std::string& value);
    /// The last frame is on the screen at `now`.
    void shown(double now) { input_.stroke().shown(now); }
    /// Seconds from each sample of the hand to the moment when its ink was shown, since the last call.
    std::vector<double> take_delays() { return input_.stroke().take_delays(); }
    /// Samples of the hand that went to the paint thread so far.
    std::size_t samples() const { return input_.stroke().samples(); }

  private:
    void restyle(int width, int height);
    void layout(int width, int height);
    void draw_panels();
    void take_menu(MenuChoice choice);
    void draw_journal(float top, float bottom, float left);
    void draw_side_panels();
    void draw_dialogs();
    void take_file(const std::filesystem::path& path);
    void take_work();
    void await_ink(double since_last);

    Session session_;
    SceneView scene_;
    StudioInput input_;
    ProjectPicture picture_;
    float content_scale_ = 1;
    double now_ = 0, last_event_ = 0;
    std::size_t frames_ = 0, draw_every_ = 1;
    unsigned framebuffer_ = 0;  ///< of the newest frame
    int height_ = 0;
};

}  // namespace tuft::app
