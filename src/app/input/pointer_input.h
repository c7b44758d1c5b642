#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "brush/preset/preset.h"
#include "mesh/query/surface_query.h"
#include "render/gl/gl_camera.h"
#include "stroke/gesture/roll.h"
#include "stroke/placement/placement.h"

namespace tuft::app {

struct PointerSettings {
    double pressure = 0.45;      ///< 0–1 of the working depth at rest
    double speed_effect = 0.5;   ///< part of the pressure lost at `fast`
    double dwell_effect = 0.25;  ///< pressure added by resting for `dwell`
    double fast = 0.25;          ///< m/s
    double dwell = 0.8;          ///< seconds
    double smoothing = 0.03;     ///< seconds of the low-pass on position
    double string = 0;           ///< metres of the string on which the brush is drawn behind the cursor
    double pen_least = 0,
           pen_full = 1;       ///< a pen's pressure where the brush begins to sink, and where it is at its deepest
    double pen_gamma = 1;      ///< exponent in between
    Vec2 tilt{0};              ///< radians, lean of the holder to the right and upwards in the view
    double roll = 0;           ///< radians, of a wide ferrule about the holder's axis, anticlockwise seen from its end;
                               ///< 0: its broad side lies across the view
    bool roll_follow = false;  ///< its broad side turns across the path (stroke/gesture/roll.h); `roll` is added
    bool clean_ends = true;    ///< of strokes without a pen: see `PointerInput`
};

/// Part of the working depth, 0–1, for a pen's pressure: ((p − least) / (full − least)) ^ gamma, cut.
double pen_depth(const PointerSettings& settings, double pressure);

/// Where the cursor points at one moment.
struct Aim {
    render::GlRay ray;
    Vec3 view_right{1, 0, 0}, view_up{0, 0, 1};  ///< unit, of the camera
    double metres_per_pixel = 1e-4;              ///< at the model
    double time = 0;                             ///< seconds
    double pressure = -1;                        ///< of a pen, below 0: none
    std::optional<Vec2> tilt;                    ///< of a pen, as `PointerSettings::tilt`
    double turn = 0;                             ///< of a pen about itself, radians, clockwise for who holds it
    Vec4f section{0};                            ///< cut plane: what it hides is not met
};

/// How far ink lies behind the holder of one brush, for `stroke::lead_of`; empty: not at all.
struct TipLag {
    std::vector<stroke::TipLag> upright;
    std::function<Vec2(double depth, const Vec2& lean)> leaned = {};
};

/// The surface that an aim meets.
struct AimedSurface {
    Vec3 position{0};      ///< metres
    Vec3 normal{0, 0, 1};  ///< unit, towards who looks
    double distance = 0;   ///< metres from the eye
    bool bridged = false;  ///< over a gap or groove
};

/// Part of a stroke, for the painter.
struct HandStep {
    enum class Kind { begin, poses, end };
    Kind kind = Kind::poses;
    std::vector<brush::Pose> poses;
};

/// Makes a cursor hold a brush: its point on the surface, smoothed or drawn on a string;
/// pressure from a pen, or from speed and rest (a fast mouse presses less, a resting one
/// more, as a hand does); a soft landing and a soft lift. It goes over gaps and grooves narrower than
/// the tuft, such as shut lines, without dipping into them. Where the cursor leaves the model or
/// jumps over an edge of its outline, the brush lifts and begins a new stroke behind it.
///
/// With `clean_ends`, a hand without pressure makes strokes whose ink begins where the button went down
/// and ends where it came up. The brush is set down once the cursor has gone three pixels, rested, or
/// the button is up: then the direction of the stroke is known, and the tuft is pressed at the first place
/// while the holder tips and goes ahead, so that the hair trails from the first touch. Along the stroke
/// the holder is ahead of the cursor by the tip lag of its depth (`stroke::lead_of`), in the direction of
/// a point dragged behind it (stroke/placement/tip_lag.h). At the end the hand slows down evenly to the last
/// place of the cursor, from which the smoothing kept it, and lifts there; from a fast stroke it lifts on
/// the way. Pens have ends of their own: their pressure.
class PointerInput {
  public:
    PointerInput(const mesh::SurfaceQuery& surface, const brush::Preset& preset, const PointerSettings& settings,
                 TipLag lag = {});

    std::vector<HandStep> move(const Aim& aim);
    /// The hand lifts off.
    std::vector<HandStep> lift();
    bool drawing() const { return down_ || !waiting_.empty(); }

    /// The brush above what the cursor points at, not pressed; nothing where it meets nothing.
    std::optional<brush::Pose> hover(const Aim& aim) const;
    const stroke::HolderOptions& hold() const { return hold_; }
    /// What the aim meets; over a gap narrower than the tuft the ground on both sides of it. Found with
    /// pairs of rays on opposite sides of the aim: on a plane their mean depth is that of the aim.
    std::optional<AimedSurface> find_surface(const Aim& aim) const;

  private:
    struct Waiting {
        Aim aim;
        AimedSurface surface;
    };

    struct DraggedPoint {
        Vec3 position{0};  ///< metres: what the point drags on a string of `tip_lag_turn`
        Vec3 string{0};    ///< that string, of length 1 where it is taut
    };
    struct Motion {
        double pressure = 0;                   ///< 0-1
        double time = 0, rest = 0, start = 0;  ///< seconds
        double speed = 0;                      ///< m/s
    };

    bool is_clean(const Aim& aim) const { return settings_.clean_ends && aim.pressure < 0; }
    brush::Pose pose_at(const Aim& aim, const Vec3& point, const Vec3& normal, double pressure, double time) const;
    Quat rotation_at(const Aim& aim, const Vec3& up) const;
    void turn_holder(const Aim& aim, const Vec3& way);
    Vec3 ahead_of(const Aim& aim, const Vec3& normal, double pressure) const;
    void touch_down(const Aim& aim, const AimedSurface& hit, const Vec3& towards, std::vector<HandStep>& steps);
    void wait(const Aim& aim, const AimedSurface& hit, std::vector<HandStep>& steps);
    void set_down(std::vector<HandStep>& steps);
    void arrive(std::vector<brush::Pose>& poses);
    void drag();
    void follow(const Aim& aim, const Vec3& goal, const Vec3& normal, std::vector<brush::Pose>& poses);
    void onto_surface();
    double goal_pressure(const Aim& aim) const;

    const mesh::SurfaceQuery& surface_;
    stroke::HolderOptions hold_;
    PointerSettings settings_;
    bool wide_;                      ///< the ferrule
    stroke::RollFollower follower_;  ///< of a stroke whose holder follows it
    double reach_;                   ///< metres round the aim in which gaps are felt
    double bridged_ = -1;            ///< `time_` when the goal was last over a gap; below 0: never
    bool down_ = false;
    Aim aim_;                       ///< the last one
    std::vector<Waiting> waiting_;  ///< of a clean stroke, until its direction is known
    DraggedPoint dragged_;
    double gone_ = 0;    ///< metres since the touch
    double spread_ = 0;  ///< metres that the holder is further ahead there, at pressure 1
    Vec3 goal_{0}, goal_normal_{0, 0, 1}, point_{0}, normal_{0, 0, 1};
    Motion motion_;
};

/// First place the aim meets that its section does not hide.
std::optional<mesh::SurfacePoint> aim_at(const mesh::SurfaceQuery& surface, const Aim& aim);

}  // namespace tuft::app
