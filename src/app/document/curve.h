#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/query/surface_query.h"
#include "stroke/placement/placement.h"
#include "writer/layout/text_layout.h"

/// \file
/// Lines and curves through control points on a model. Called by tools/curve_tool.h. Window thread.
namespace tuft::app {

/// A control point.
struct CurvePoint {
    Vec3 position{0};       ///< metres, on the surface
    Vec3 outward{0, 0, 1};  ///< unit, towards the eye that placed it; the curve is projected against it
    double pressure = 1;    ///< factor on the hand's pressure

    bool operator==(const CurvePoint&) const = default;
};

/// Course of the pressure along a curve.
struct CurveSettings {
    double taper_in = 0.12;  ///< fraction of the length in which the pressure rises
    double taper_out = 0.3;  ///< fraction of the length in which it falls
    double speed = 0.08;     ///< m/s
};

/// A point of a projected curve.
struct CurveSample {
    Vec3 position{0}, normal{0, 0, 1};  ///< metres; unit, towards the eye
    double along = 0;                   ///< metres from the start
    double pressure = 1;                ///< factor, as in `CurvePoint`
    bool on = true;                     ///< false: the surface is missing there
};

/// Returns the centripetal Catmull–Rom spline through the points, projected onto the surface. Knots are at the square
/// roots of the chords, so it has no loops and no overshoot; two points give a straight line. Each point moves against
/// the linearly interpolated `outward` to the first surface that faces it. [`per_span` per span + 1]; empty below two
/// points. Source: [Barry1988].
std::vector<CurveSample> project_curve(const mesh::SurfaceQuery& query, std::span<const CurvePoint> points,
                                       int per_span = 64);

/// Returns the curve up to where it leaves the surface. Throws `Error` where there is none.
writer::ModelPath path_of_curve(const mesh::SurfaceQuery& query, std::span<const CurvePoint> points);

/// How a curve is painted.
struct CurveHand {
    stroke::HolderOptions holder;  ///< with the tip lag of the brush, so that the ink is on the curve
    CurveSettings settings;
    double pressure = 0.5;                ///< 0–1
    Vec2 tilt{0};                         ///< radians, lean towards `right` and `down`; 0: as the make is held
    double roll = 0;                      ///< radians, of the ferrule, as of flat samples
    bool roll_follow = false;             ///< the broad side turns across the curve (roll.h); `roll` is added
    Vec3 right{1, 0, 0}, down{0, -1, 0};  ///< unit, of the view
};
/// Returns the poses along a curve, one list for each part that is on the model.
std::vector<std::vector<brush::Pose>> curve_poses(const mesh::SurfaceQuery& query, std::span<const CurvePoint> points,
                                                  const CurveHand& hand);

/// The curve being edited, or just painted.
struct CurveInWork {
    std::vector<CurvePoint> points;
    int over = -1, grabbed = -1;    ///< index of the control point under the cursor, being dragged; −1: none
    bool changed = false;           ///< since it was painted
    bool is_pending = false;        ///< the paint thread has not painted it yet
    std::uint64_t last_stroke = 0;  ///< its last entry in the journal; 0: not painted. Its points can be moved while
                                    ///< that is the journal's last entry
};

}  // namespace tuft::app
