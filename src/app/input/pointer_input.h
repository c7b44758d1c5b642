#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "brush/preset/preset.h"
#include "mesh/query/surface_query.h"
#include "render/gl/gl_camera.h"
#include "stroke/gesture/roll.h"
#include "stroke/placement/placement.h"
#include "stroke/placement/tip_lag.h"

/// \file
/// From cursor movements to poses of a brush. Called by tools/stroke_input.h. Window thread.
namespace tuft::app {

/// Settings of a pointer device.
struct PointerSettings {
    double pressure = 0.45;              ///< 0–1, fraction of the working depth at rest
    double speed_effect = 0.5;           ///< fraction of the pressure lost at `fast`
    double dwell_effect = 0.25;          ///< pressure added by dwelling for `dwell`
    double fast = 0.25;                  ///< m/s
    double dwell = 0.8;                  ///< seconds
    double smoothing = 0.03;             ///< seconds, time constant of the low-pass on position
    double string = 0;                   ///< metres, length of the string by which the cursor pulls the brush
    double pen_least = 0, pen_full = 1;  ///< pen pressures of depth 0 and of the full depth
    double pen_gamma = 1;                ///< exponent in between
    Vec2 tilt{0};                        ///< radians, lean of the holder to the right and upwards in the view
    double roll = 0;                     ///< radians, of a wide ferrule about the holder's axis, anticlockwise seen
                                         ///< from the handle's end; 0: its broad side is across the view
    bool roll_follow = false;            ///< the broad side turns across the path (roll.h); `roll` is added
    bool clean_ends = true;              ///< for strokes without a pen: see `PointerInput`
};

/// Returns the depth for a pen's pressure p, as a fraction of the working depth: ((p − least) / (full − least)) ^
/// gamma, clamped to 0–1.
double pen_depth(const PointerSettings& settings, double pressure);

/// Where the cursor points at one time.
struct Aim {
    render::GlRay ray;
    Vec3 view_right{1, 0, 0}, view_up{0, 0, 1};  ///< unit, of the camera
    double metres_per_pixel = 1e-4;              ///< at the model
    double time = 0;                             ///< seconds
    double pressure = -1;                        ///< 0–1 of a pen; negative: none
    std::optional<Vec2> tilt;                    ///< of a pen, as `PointerSettings::tilt`
    double turn = 0;                             ///< radians, rotation of a pen about its axis, clockwise from above
    Vec4f section{0};                            ///< cut plane; hidden parts of the model are not hit
};

/// Tip lag of one brush, for `stroke::tip_lag_at`: distance of the ink behind the holder. Empty: none.
struct TipLag {
    std::vector<stroke::TipLag> upright;
    std::function<Vec2(double depth, const Vec2& lean, double turn)> tilted = {};
};

/// Surface point that an aim hits.
struct AimedSurface {
    Vec3 position{0};      ///< metres
    Vec3 normal{0, 0, 1};  ///< unit, towards the eye, levelled as far as the holder does (`HolderOptions::steady`)
    double distance = 0;   ///< metres from the eye
    bool bridged = false;  ///< over a gap or groove
    bool back = false;     ///< the surface shows its back there
    bool inside = false;   ///< it does so to the inside of a body: it is seen through a hole
};

/// Part of a stroke, for the paint thread.
struct StrokeStep {
    enum class Kind { begin, poses, end };
    Kind kind = Kind::poses;
    std::vector<brush::Pose> poses;
};

/// Turns a cursor into the holder of a brush.
///
/// Position: the cursor's point on the surface, smoothed, or pulled on a string. Pressure: a pen's, or by speed and
/// dwell (a fast mouse presses less, a resting one more). The brush lands and lifts gradually. It crosses gaps and
/// grooves narrower than the tuft, such as shut lines, without dipping into them. Where the cursor leaves the model or
/// jumps over an edge of its outline, the brush lifts and begins a new stroke behind it, lightly at first. It stays on
/// the side of the surface on which it was set down: a wall that shows its back through a hole is not gone to, and
/// nothing is set down there. The back of a sheet is painted on.
///
/// With `clean_ends` a stroke without pen pressure has ink from where the button went down to where it came up. The
/// direction of the stroke must be known first: the brush is set down once the cursor has moved three pixels, rested,
/// or the button is up. The tuft is then pressed at the first point while the holder tilts and advances, so that the
/// hair trails from the first contact. Along the stroke the holder leads the cursor by the tip lag of its depth
/// (`stroke::tip_lag_at`), in the direction of a point dragged behind it (stroke/placement/tip_lag.h). At the end the
/// hand decelerates evenly to the cursor's last point and lifts there; after a fast stroke it lifts while moving. Pens
/// need none of this: their pressure shapes the ends.
///
/// A holder that neither a pen nor the settings lean, leans as its make is held (`stroke::lean_of_make`).
class PointerInput {
  public:
    PointerInput(const mesh::SurfaceQuery& surface, const brush::Preset& preset, const PointerSettings& settings,
                 TipLag lag = {});

    /// The cursor moves while the brush is down.
    std::vector<StrokeStep> move(const Aim& aim);
    /// Lifts the brush off.
    std::vector<StrokeStep> lift();
    bool drawing() const { return down_ || !waiting_.empty(); }

    /// Returns the pose of a brush held above the aimed surface; nothing where the aim hits nothing.
    std::optional<brush::Pose> hover(const Aim& aim) const;
    const stroke::HolderOptions& holder() const { return holder_; }
    /// Returns the surface that the aim hits. Over a gap narrower than the tuft it is the surface on both sides, found
    /// by pairs of rays on opposite sides of the aim. On a plane their mean depth is that of the aim.
    std::optional<AimedSurface> find_surface(const Aim& aim) const;

  private:
    struct Waiting {
        Aim aim;
        AimedSurface surface;
    };

    struct DraggedPoint {
        Vec3 position{0};  ///< metres, the point dragged on a string
        Vec3 string{0};    ///< the string, of length 1 where it is taut
    };
    struct Motion {
        double pressure = 0;                   ///< 0-1
        double time = 0, rest = 0, start = 0;  ///< seconds
        double speed = 0;                      ///< m/s
        double gone = 0;                       ///< metres moved since pen down
        double spread = 0;                     ///< metres, additional lag of the tip at the start, at pressure 1
        double bridged = -1;                   ///< `time` when the goal was last over a gap; negative: never
    };
    struct Place {
        Vec3 position{0}, normal{0, 0, 1};
    };
    /// How the holder turns about its axis along the stroke.
    struct Turns {
        stroke::RollFollower follower;                 ///< with `roll_follow`
        std::optional<stroke::BladeRoll> blade;        ///< of a clean stroke of a blade
        std::optional<stroke::FollowedTurn> followed;  ///< of a brush whose tip lag differs by turn
    };
    struct Side {
        std::optional<bool> on_back;  ///< of the surface, where it was set down
        bool over_edge = false;       ///< the cursor crossed an edge of the outline since it was pressed
    };

    std::optional<AimedSurface> find_gap(const Aim& aim, double centre) const;
    Vec3 levelled_normal(const Aim& aim, const mesh::SurfacePoint& hit) const;
    bool is_clean(const Aim& aim) const { return settings_.clean_ends && aim.pressure < 0; }
    brush::Pose pose_at(const Aim& aim, const Vec3& point, const Vec3& normal, double pressure, double time) const;
    Quat rotation_at(const Aim& aim, const Vec3& normal, const Vec3& up) const;
    double roll_at(const Aim& aim) const;
    double roll_of_ferrule(const Aim& aim) const;
    Vec3 across(const Aim& aim) const;
    Vec2 lean_of_make(const Aim& aim, const Vec3& normal) const;
    void turn_holder(const Aim& aim, const Vec3& motion);
    Vec3 ahead_of(const Aim& aim, const Vec3& normal, double pressure) const;
    void pen_down(const Aim& aim, const AimedSurface& hit, const Vec3& towards, std::vector<StrokeStep>& steps);
    void wait(const Aim& aim, const AimedSurface& hit, std::vector<StrokeStep>& steps);
    double at_start() const;
    Vec3 normal_at_start(const Aim& aim, const AimedSurface& at, const Vec3& towards) const;
    void set_down(std::vector<StrokeStep>& steps);
    void arrive(std::vector<brush::Pose>& poses);
    void drag(const Aim& aim);
    void follow(const Aim& aim, const Vec3& goal, const Vec3& normal, std::vector<brush::Pose>& poses);
    void onto_surface();
    double goal_pressure(const Aim& aim) const;

    const mesh::SurfaceQuery& surface_;
    stroke::HolderOptions holder_;
    PointerSettings settings_;
    bool wide_;     ///< the ferrule is wider than thick
    double reach_;  ///< metres, radius in which gaps are bridged
    bool down_ = false;
    Side side_;
    Aim aim_;                       ///< the last one
    std::vector<Waiting> waiting_;  ///< of a clean stroke, until its direction is known
    DraggedPoint dragged_;          ///< on a string of `tip_lag_turn`: where the tip lag points
    DraggedPoint leant_;            ///< on one of `stroke::lean_string`: where the make leans
    Turns turns_;
    Place goal_, point_;  ///< of the cursor; of the smoothed or dragged point
    Motion motion_;
};

/// Returns the first surface point on the aim's ray that its section does not hide.
std::optional<mesh::SurfacePoint> aim_at(const mesh::SurfaceQuery& surface, const Aim& aim);

/// Whether an aim hits the back of a surface from inside of a body, through a hole: nothing is set down there. The back
/// of an open sheet is none. Cost: 64 rays.
bool is_through_a_hole(const mesh::SurfaceQuery& surface, const mesh::SurfacePoint& hit, const Aim& aim);

}  // namespace tuft::app
