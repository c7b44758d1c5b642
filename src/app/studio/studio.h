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

/// \file
/// The studio: input, state and drawing of the window. Window thread.
namespace tuft::app {

/// The window's content. It needs a current OpenGL context and an ImGui context. It draws into the framebuffer given to
/// `frame`.
class Studio {
  public:
    Studio();
    ~Studio();

    Session& session() { return session_; }
    const Session& session() const { return session_; }
    /// Where a frame goes.
    struct Output {
        int width = 0, height = 0;  ///< pixels
        unsigned framebuffer = 0;
        bool seen = true;  ///< false: all is done but drawing
    };
    /// Handles the events of one frame and draws it. `now`: seconds on the events' clock.
    void frame(EventQueue& events, const Output& output, double now);
    /// Returns the seconds that the next frame may wait for an event: 0 while the picture moves, longer during work
    /// that only shows progress, longest when idle.
    double patience() const;
    /// Frees all graphics objects before the OpenGL context is lost; creates them in the new one.
    void drop_graphics();
    void make_graphics();
    /// Ends the current stroke and saves everything; also the project's picture where it is older than the strokes.
    void finish();
    /// Sets the display's scale of text.
    void set_content_scale(float scale) { content_scale_ = scale; }
    /// Changes a setting by its name, for scripts. Throws `Error` for an unknown name or value.
    void set(const std::string& name, const std::string& value);
    /// Reports that the last frame was presented at `now`, seconds.
    void shown(double now) { input_.stroke().shown(now); }
    /// Returns the seconds from each sample of a stroke until its ink was presented, since the last call.
    std::vector<double> take_delays() { return input_.stroke().take_delays(); }
    /// Number of samples of strokes sent to the paint thread so far.
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
    Output output_;  ///< of the last frame
};

}  // namespace tuft::app
