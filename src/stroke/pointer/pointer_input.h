#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "brush/preset/preset.h"
#include "mesh/query/surface_query.h"
#include "stroke/gesture/roll.h"
#include "stroke/placement/placement.h"
#include "stroke/placement/tip_lag.h"
#include "stroke/placement/turn_back.h"
#include "stroke/pointer/aim.h"
#include "stroke/pointer/pointer_settings.h"

/// \file
/// From cursor movements to poses of a brush, while the hand moves. Called by the window for its events and by
/// pointer_strokes.h for recorded samples.
namespace tuft::stroke {

/// Tip lag of one brush, for `tip_lag_at`: distance of the ink behind the holder. Empty: none.
struct BrushTipLag {
    std::vector<TipLag> upright;
    std::function<Vec2(double depth, const Vec2& lean, double turn)> tilted = {};
};

/// Part of a stroke.
struct StrokeStep {
    enum class Kind { begin, poses, end };
    Kind kind = Kind::poses;
    std::vector<brush::Pose> poses;
};

/// Turns a cursor into the holder of a brush.
///
/// Position: the cursor's point on the surface, pulled on a string (`pull`) and smoothed (`filter`); pressure and tilt
/// of a pen stay at their place on its path, and where a pen leaves, the tip catches up, but for what the smoothing
/// keeps it behind. A tip that rests on a slack string is pressed as the pen presses by then. Pressure: a pen's, or by
/// speed and dwell (`pressure_goal`; a fast mouse presses less, a resting one more). The brush lands and lifts
/// gradually. It crosses gaps and grooves narrower than the tuft, such as shut lines, without dipping into them. Where
/// the cursor leaves the model or jumps over an edge of its outline, the brush lifts and begins a new stroke behind it,
/// lightly at first. It stays on the side of the surface on which it was set down: a wall that shows its back through a
/// hole is not gone to, and nothing is set down there. The back of a sheet is painted on.
///
/// With `clean_ends` a stroke without pen pressure has ink from where the button went down to where it came up. The
/// direction of the stroke must be known first: the brush is set down once the cursor has moved three pixels, rested,
/// or the button is up. The tuft is then pressed at the first point while the holder tilts and advances, so that the
/// hair trails from the first contact. Along the stroke the holder leads the cursor by the tip lag of its depth
/// (`tip_lag_at`), in the direction of a point dragged behind it (stroke/placement/tip_lag.h). At the end the
/// hand decelerates evenly to the cursor's last point and lifts there; after a fast stroke it lifts while moving. Pens
/// need none of this: their pressure shapes the ends.
///
/// Where the path turns back a wide ferrule is lifted and set down to its other side, as of recorded samples
/// (stroke/placement/turn_back.h). Nobody knows what the hand does next: it is taken to go on straight. A pen, which
/// does not lead its ink, lifts the hair as it comes back over half of its tip lag, and sets it down over its end.
///
/// Where a wall is over the place, nearer than the tuft is long, such as a wheel arch over its tyre, the holder leans
/// from the surface's normal towards the eye until it has room: what is seen can be reached from there. Where it finds
/// none, and beside a wall, it stands along the normal.
///
/// A holder that neither a pen nor the settings lean, leans as its make is held (`lean_of_make`).
class PointerInput {
  public:
    PointerInput(const mesh::SurfaceQuery& surface, const brush::Preset& preset, const PointerSettings& settings,
                 BrushTipLag lag = {});

    /// The cursor moves while the brush is down.
    std::vector<StrokeStep> move(const Aim& aim);
    /// Lifts the brush off.
    std::vector<StrokeStep> lift();
    bool drawing() const { return down_ || !waiting_.empty(); }

    /// Returns the pose of a brush held above the aimed surface; nothing where the aim hits nothing.
    std::optional<brush::Pose> hover(const Aim& aim) const;
    const HolderOptions& holder() const { return holder_; }
    /// Returns the surface that the aim hits; over a gap narrower than the tuft, the surface on both sides. Its normal
    /// is one along which the holder has room.
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
        double time = 0, start = 0;  ///< seconds
        double gone = 0;             ///< metres moved since pen down
        double spread = 0;           ///< metres, additional lag of the tip at the start, at pressure 1
        double bridged = -1;         ///< `time` when the goal was last over a gap; negative: never
    };
    struct Strings {
        DraggedPoint dragged;       ///< on one of `tip_lag_turn`: where the tip lag points; of a clean stroke
        DraggedPoint trailing;      ///< on one of half the tip lag, of a pen that is lifted where it turns back
        double trailing_reach = 0;  ///< metres, length of that one
        DraggedPoint leant;         ///< on one of `lean_string`: where the make leans
    };
    struct Options {
        PointerSettings pointer;
        PressureOptions by_motion;  ///< at the scale of the last aim
        OneEuroOptions filter;      ///< of the position
    };
    /// What a hand's samples are steadied by (`gesture`).
    struct Steadying {
        String string;
        OneEuro<Vec3> position;
        PressureState press;
    };
    struct Place {
        Vec3 position{0}, normal{0, 0, 1};
    };
    /// How the holder turns about its axis along the stroke.
    struct Turns {
        RollFollower follower;                 ///< with `roll_follow`
        std::optional<BladeRoll> blade;        ///< of a clean stroke of a blade
        std::optional<FollowedTurn> followed;  ///< of a brush whose tip lag differs by turn
        TurnFollower back;                     ///< of a brush that is lifted where its path turns back
    };
    struct Side {
        std::optional<bool> on_back;  ///< of the surface, where it was set down
        bool over_edge = false;       ///< the cursor crossed an edge of the outline since it was pressed
    };

    bool has_room(const Vec3& at, const Vec3& along) const;
    bool is_clean(const Aim& aim) const { return options_.pointer.clean_ends && aim.pressure < 0; }
    brush::Pose pose_at(const Aim& aim, const Vec3& point, const Vec3& normal, double pressure, double time) const;
    Quat rotation_at(const Aim& aim, const Vec3& normal, const Vec3& up) const;
    double roll_at(const Aim& aim) const;
    double roll_of_ferrule(const Aim& aim) const;
    const DraggedPoint& trails(const Aim& aim) const { return is_clean(aim) ? strings_.dragged : strings_.trailing; }
    double pressed(const Aim& aim, double pressure) const;
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
    void grow_string();
    int parts_of(const Aim& aim, const Vec3& motion) const;
    void follow(const Aim& aim, const Vec3& goal, const Vec3& normal, std::vector<brush::Pose>& poses);
    void step(const Aim& aim, const Vec3& target, const Vec3& normal, double dt, std::vector<brush::Pose>& poses);
    Vec3 pull_on_string(Aim& aim, const Vec3& hand);
    void catch_up(std::vector<brush::Pose>& poses);
    void settle_pressure(const Aim& aim, double travel, double dt);
    Vec3 onto_surface();
    double goal_pressure(const Aim& aim) const;

    const mesh::SurfaceQuery& surface_;
    HolderOptions holder_;
    Options options_;
    LevelledView view_;
    double radius_;  ///< metres, of the tuft
    bool wide_;      ///< the ferrule is wider than thick
    bool down_ = false;
    Side side_;
    Aim aim_;                       ///< the last one
    std::vector<Waiting> waiting_;  ///< of a clean stroke, until its direction is known
    Strings strings_;
    Turns turns_;
    Place goal_, point_;  ///< of the cursor; of the smoothed or dragged point
    Motion motion_;
    Steadying steadying_;
};

}  // namespace tuft::stroke
