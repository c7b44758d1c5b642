#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/query/surface_query.h"
#include "stroke/placement/placement.h"

/// Lines and curves through control points on a model, painted by a hand of even pace.
namespace tuft::app {

struct CurvePoint {
    Vec3 position{0};       ///< metres, on the surface
    Vec3 outward{0, 0, 1};  ///< unit, towards who placed it: the curve lies on what is seen from there
    double pressure = 1;    ///< part of the hand's pressure
};

/// How the hand goes along it.
struct CurveSettings {
    double taper_in = 0.12;  ///< part of the length in which it presses down
    double taper_out = 0.3;  ///< part in which it lifts
    double speed = 0.08;     ///< m/s
};

/// A place of a curve on the model.
struct CurveSample {
    Vec3 position{0}, normal{0, 0, 1};  ///< metres; unit, out of the side that is seen
    double along = 0;                   ///< metres from the start
    double pressure = 1;
    bool on = true;  ///< false: there is no surface
};

/// The centripetal Catmull–Rom spline through the points (Barry and Goldman 1988; knots at the square
/// root of the chords: no loops, no overshoot; two points give a straight line), each of its
/// points moved against the direction `outward`, which is interpolated linearly, onto the first
/// surface that faces it. [`per_span` points per span + 1]; empty below two points.
std::vector<CurveSample> project_curve(const mesh::SurfaceQuery& query, std::span<const CurvePoint> points,
                                       int per_span = 64);

/// The poses of a hand along it, one list for each piece that lies on the model. `hold`: with
/// the tip lag of the brush, upright and leaned, so that the ink lies on the curve; `pressure` of the hand, 0–1; `tilt`
/// radians to the right and down of whoever looks with `right` and `down`.
struct CurveHand {
    stroke::HolderOptions hold;
    CurveSettings settings;
    double pressure = 0.5;
    Vec2 tilt{0};
    double roll = 0;           ///< radians, of the ferrule, as of flat samples
    bool roll_follow = false;  ///< its broad side turns across the curve (stroke/gesture/roll.h); `roll` is added
    Vec3 right{1, 0, 0}, down{0, -1, 0};
};
std::vector<std::vector<brush::Pose>> curve_poses(const mesh::SurfaceQuery& query, std::span<const CurvePoint> points,
                                                  const CurveHand& hand);

/// The curve that is being made or was just painted.
struct CurveInWork {
    std::vector<CurvePoint> points;
    int over = -1, grabbed = -1;    ///< control point under the cursor, in the hand
    bool changed = false;           ///< since it was painted
    bool waits = false;             ///< for the painter to have painted it
    std::uint64_t last_stroke = 0;  ///< of it in the journal; 0: not painted. While it is the journal's
                                    ///< last one the points can still be moved
};

}  // namespace tuft::app
