#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/input/events.h"
#include "app/session.h"
#include "brush/tuft/tuft.h"
#include "render/gl/gl_scene.h"
#include "render/gl/gl_view.h"

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
    /// Ends the stroke in hand and keeps everything; the project's picture is made once more where it is
    /// older than the strokes.
    void finish();
    /// What the display asks for as a scale of text.
    void set_content_scale(float scale) { content_scale_ = scale; }
    /// Changes a setting by its name in scripts. Throws `Error` for a name or value that is unknown.
    void set(const std::string& name, const std::string& value);
    /// The last frame is on the screen at `now`.
    void shown(double now);
    /// Seconds from each sample of the hand to the moment when its ink was shown, since the last call.
    std::vector<double> take_delays() { return std::exchange(delays_, {}); }
    /// Samples of the hand that went to the painter so far.
    std::size_t samples() const { return samples_; }

  private:
    enum class Drag { none, turn, pan, zoom, atlas };

    void layout(int width, int height);
    void panels();
    bool dialog_open() const;
    void take_model();
    void handle(const Event& event);
    void fly(const Event& event);
    void press(const Event& event);
    void move(const Event& event);
    void release(const Event& event);
    void key(const Event& event);
    void perform(Act act);
    BeginStroke stroke_to_begin() const;
    void post(std::vector<HandStep> steps, double time);
    void await_ink(double since_last);
    int curve_point_at(const Event& event) const;
    std::optional<CurvePoint> curve_point(const Event& event) const;
    bool curve_editable() const;
    void curve_press(const Event& event);
    void curve_drag(const Event& event);
    void curve_release(const Event& event);
    void curve_wheel(const Event& event);
    bool curve_key(const Event& event);
    void paint_curve();
    TipLag tip_lag(const brush::Preset& preset);
    void watch_curve();
    std::optional<stroke::Placement> writing_placement() const;
    void watch_writing();
    void writing_wheel(const Event& event);
    void lay_writing();
    void update_tuft(double now);
    void show_colours();
    void draw_scene(unsigned framebuffer, int height);
    void draw_atlas(const render::DrawOptions& options, unsigned framebuffer, int height);
    std::optional<Vec2> atlas_cursor() const;
    bool in_atlas(const Event& event) const;
    void atlas_press(const Event& event);
    void pick_press(const Event& event);
    bool in_palette(const Event& event) const;
    Aim palette_aim(const Event& event) const;
    void palette_press(const Event& event);
    void update_palette_picture();
    void update_thumbnails();
    void mask_press(const Event& event);
    void lasso_move(const Event& event);
    void lasso_release();
    void atlas_wheel(const Event& event);
    void look_at_uv(const Vec2& uv);
    bool shift_press(const Event& event);
    void shift_release(const Event& event);
    void keep_picture();
    bool comparing() const;
    bool on_work(const Event& event) const;
    void layout_comparison();
    void take_snapshot_picture();
    void draw_comparison(const render::GlView::Frame& of_work, int height);
    Aim aim_of(const Event& event) const;
    render::GlCamera camera() const;
    render::GlSolid tuft_solid() const;

    Session session_;
    std::unique_ptr<render::GlScene> scene_;
    std::unique_ptr<render::GlView> view_;
    std::unique_ptr<render::GlScene> compare_scene_;  ///< a snapshot's, while the work is compared with it
    std::unique_ptr<render::GlView> compare_view_;
    std::optional<stroke::Model> plate_;  ///< of the palette, once it was shown
    bool on_plate_ = false;               ///< the hand is over it
    std::optional<PointerInput> hand_;
    std::optional<Event> line_start_;  ///< where a new control point was set
    stroke::Placement ghost_placement_;
    double ghost_scale_ = 0;
    render::GlCamera ghost_camera_;
    Vec4f ghost_section_{0};
    std::vector<stroke::TipLag> tip_lag_;
    std::optional<stroke::TiltedTipLag> tilted_tip_lag_;
    std::string tip_lag_brush_;
    Event cursor_;
    bool cursor_inside_ = false;
    Drag drag_ = Drag::none;
    std::optional<brush::Tuft> preview_;
    std::string preview_brush_;
    ModelView colours_shown_ = ModelView::glaze;
    float content_scale_ = 1;
    std::optional<render::GlCamera> thumbnails_from_;  ///< from where the layers' pictures are seen
    double now_ = 0, last_event_ = 0, last_turn_ = -1, picture_due_ = 0;
    std::size_t strokes_seen_ = 0, frames_ = 0, draw_every_ = 1;
    unsigned framebuffer_ = 0;  ///< of the newest frame
    int height_ = 0;
    std::vector<double> delays_;
    std::filesystem::path pictured_;  ///< project whose picture is due, or kept
    std::deque<double> asked_;        ///< when each sample was taken whose ink is not shown yet
    std::size_t samples_ = 0;
};

/// Hair, as it is dipped into an ink of that colour (sRGB), and ferrule as triangles for drawing.
render::GlSolid solid_of(const brush::TuftState& tuft, unsigned ink);

}  // namespace tuft::app
