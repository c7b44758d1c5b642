#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "brush/preset/preset.h"
#include "brush/state/tuft_state.h"
#include "mesh/query/surface_query.h"
#include "stroke/journal/entry/samples.h"

/// \file
/// From flat pen data to poses of the ferrule: samples are mapped onto the surface, then the holder is posed over them.
/// Called by `Document` for flat strokes, and by fit.h to compare models.
namespace tuft::stroke {

/// A flat sample on the model.
struct SurfaceSample {
    mesh::SurfacePoint on;   ///< past a border: the last point of the surface
    Vec3 position{0};        ///< metres, model frame: `on.position`; past a border the point of the surface continued
                             ///< flat
    Vec3 normal{0, 0, 1};    ///< unit, smooth, outward
    Vec3 right{1, 0, 0};     ///< unit, along the surface: direction of +x there
    Vec3 down{0, -1, 0};     ///< unit, along the surface, orthogonal to `right`: direction of +y
    bool on_surface = true;  ///< false past a border, or where the ray hit nothing
    double time = 0;         ///< seconds
    double pressure = 0;     ///< part of the working depth, 0–1
    Vec2 tilt{0};            ///< radians, towards right, towards down
    double roll = 0;         ///< radians, see `StrokeSample`
    Vec2 tip_lag{0};         ///< metres to the right and down, in the tangent plane, by which the hand leads the ink
};

class Drapes;

/// A flat trace on the model.
struct SurfaceTrace {
    std::vector<SurfaceSample> samples;  ///< one per sample of the trace, in order
    std::size_t missed = 0;              ///< samples that are not on the surface
    double origin_gap = 0;               ///< metres between the placement's origin and the surface
};

/// Maps a flat trace onto the mesh.
///
/// `SurfaceMapping::wrap` is the exponential map of the polyhedral surface at the point nearest to the placement's
/// origin. Sample (x, y) lies at distance |(x, y)| along the straightest geodesic in the direction x right + y down
/// ([Polthier1998]: it crosses an edge straight in the unfolded plane); its frame is parallel transported
/// along it. Lengths and angles at the origin are preserved; on a developable surface all of them are.
///
/// `SurfaceMapping::drape` is the same map on the smoothed surface: at each step a patch is fitted to the surface
/// within `drape_radius` (`fit_patch`), the geodesic continues straight on it, and the sample is projected onto the
/// triangles along the patch's normal. On a surface without detail of that size it agrees with `wrap` to 0.2 % of the
/// length. Over grooves, relief, noise of a scan and gaps between parts a drawing stays whole, where geodesics of the
/// triangles diverge. It does not turn round a rim. Normal and axes are those of the patch.
///
/// `SurfaceMapping::project` takes the first hit of a ray along right × down from outside the mesh. `hand_path` then
/// takes the stroke off all but one sheet (`leave_other_sheets`, projection.h).
///
/// Past a border a geodesic continues straight in the last plane. A ray without a hit takes height and frame of the
/// sample nearest in time that has one. `shared`, where given, has the lines of drapes (drape.h). Throws `Error` for a
/// trace that is not flat, numbers that are not finite, and directions of the placement that are zero or parallel.
/// Cost: about 0.1 µs per triangle crossed.
SurfaceTrace map_to_surface(const mesh::SurfaceQuery& query, const StrokeSamples& trace, Drapes* shared = nullptr);

/// Returns the radius of patches of `SurfaceMapping::drape`, metres: 8 mm, or 4 % of the box diagonal of a small model.
double drape_radius(const mesh::TriangleMesh& mesh);

/// End of a straightest geodesic.
struct StraightestGeodesic {
    mesh::SurfacePoint end;   ///< `distance`: length on the surface
    Vec3 direction{1, 0, 0};  ///< unit tangent at the end, in the plane of the last triangle
    double beyond = 0;        ///< metres that were left at a border; 0: it met none
};

/// Traces a geodesic of `length` metres from `start`, a point of the mesh, along `direction` projected into the
/// triangle's plane. At most 4 n_triangles + 1000 crossings.
StraightestGeodesic trace_geodesic(const mesh::TriangleMesh& mesh, const mesh::SurfacePoint& start,
                                   const Vec3& direction, double length);

/// Tip lag of a brush at one depth: distance from the foot of the holder's axis back to the ink.
struct TipLag {
    double depth = 0;   ///< metres of the unbent tip below the surface
    double length = 0;  ///< metres
};

/// How a holder is posed over a surface.
struct HolderOptions {
    double tuft_length = 0.02;     ///< metres from the ferrule's mouth to the unbent tip
    double working_depth = 0.010;  ///< metres of the unbent tip below the surface at pressure 1
    double hover = 0.002;          ///< metres of the tip above the surface when not pressed
    double max_tilt = 1.2;         ///< radians; larger tilts are clamped
    double steady = 0.008;         ///< radius of `level_surface`, metres; 0: no levelling
    std::vector<TipLag> tip_lag;   ///< ascending in depth, linear between, constant outside; empty: no tip lag
    /// Change of the tip lag by a lean and a turn: metres ahead and to the path's left, for a depth (metres), a lean
    /// along the path and to its left, and a turn of the ferrule's x from the path, anticlockwise (radians);
    /// `TiltedTipLag::at`. Empty: no change.
    std::function<Vec2(double depth, const Vec2& lean, double turn)> tip_lag_change = {};
    /// Where the ink of a dot, a trace that stays within half of `tip_lag_turn` of its first place, has its middle on a
    /// plane, metres to the right and down of its mean place, led without this: `middle_of_dot`. The hand stands that
    /// much back. Empty: it does not.
    std::function<Vec2(const StrokeSamples& dot)> dot_place = {};
    /// Metres of travel in which the tip lag follows a turn; less of a blade, which slips across its edge meanwhile.
    double tip_lag_turn = 0.0015;
    /// Metres of travel over which a blade, whose longest hair stands ahead of its axis, lands leaning ahead; 0: no
    /// blade.
    double blade_landing = 0;
    double lean = 0;      ///< radians, `brush::Preset::lean`
    bool across = false;  ///< `is_bent_across`: lean and tip lag are across the broad side; false: along the path
    bool foam = false;    ///< a sponge: a dot is pressed straight down
    bool turned = false;  ///< `has_lag_by_turn`: the tip lag differs on the edge and across the broad side
    double toe = 0;       ///< metres by which the hair at the edges of a wide ferrule is shorter; 0: no toe
    double toe_end = 0;   ///< metres that the hand goes on while it lifts a toe from `toe`: its stroke ends so round
    std::shared_ptr<Drapes> drapes = {};  ///< lines that strokes of one placement share; empty: each walks its own
};

/// Returns the working depth of a brush, metres: half of the free hair.
double working_depth(const brush::Preset& preset);

/// Whether hair of this brush bends across the broad side only, whichever way the path goes: of a wide ferrule whose
/// make leans, such as a fan, but for a blade, which leans along its broad side. Along that a fan's hair has no steady
/// place.
bool is_bent_across(const brush::Preset& preset);

/// Whether the tip lag of this brush differs by how its broad side lies to the path: of a wide ferrule that does not
/// bend across alone. A blade, which is led along its broad side, has one tip lag.
bool has_lag_by_turn(const brush::Preset& preset);

/// Returns options for a brush over a model, `steady` its `drape_radius`, without tip lag.
HolderOptions holder_options(const brush::Preset& preset, const mesh::TriangleMesh& mesh);

/// Returns the ferrule's pose over each mapped sample. The holder's axis is the normal rotated by the tilt,
///
///     up ∝ normal + tan(tilt.x) right + tan(tilt.y) down.
///
/// The broad side of the ferrule is turned about that axis by the roll,
///
///     x = cos(roll) r + sin(roll) (up × r),    r: `right`, turned as the normal is by the smallest rotation to up.
///
/// The unbent tip lies `tip_depths` below the sample and leads it by the tip lag in the tangent plane. Normal and
/// height are levelled (`level_surface` over `steady` of path): the holder follows ridges and valleys and passes over
/// grooves narrower than half of that radius. On a surface of curvature κ along the path the height is off by at most
/// κ steady² / 200.
std::vector<brush::Pose> pose_holder(const mesh::SurfaceQuery& query, std::span<const SurfaceSample> samples,
                                     const HolderOptions& options);

/// Returns the poses of a trace in space: its samples, with rotations normalised.
std::vector<brush::Pose> spatial_poses(const StrokeSamples& trace);

/// Poses of a trace. The rolls of a flat one are turned with its path: the ferrule lies to the path on the surface as
/// it did to the flat path.
struct HandPath {
    SurfaceTrace mapped;  ///< of a flat trace
    std::vector<brush::Pose> poses;
    std::size_t set_down = 0;  ///< poses before that of the trace's first sample
};
/// Returns the poses of a trace: of a flat one after `lean_holder`, `compensate_tip_lag`, `lift_off`, `map_to_surface`,
/// `leave_other_sheets` and `pose_holder`; of one in space its own. The brush is lifted where a stroke leaves its
/// sheet, its tip over the edge where another sheet is near, and pressed over its tip lag where the stroke comes back.
HandPath hand_path(const mesh::SurfaceQuery& query, const StrokeSamples& trace, const HolderOptions& options);

}  // namespace tuft::stroke
