#pragma once

#include <functional>
#include <span>
#include <vector>

#include "brush/preset/preset.h"
#include "brush/tuft/tuft_state.h"
#include "mesh/query/surface_query.h"
#include "stroke/journal/samples.h"

/// From flat pen data to the hand that holds a brush over a model: lay the samples
/// onto the surface, then hold the brush over them.
namespace tuft::stroke {

/// A flat sample on the model.
struct SurfaceSample {
    mesh::SurfacePoint on;   ///< where it lies; past an edge: the last point of the surface
    Vec3 position{0};        ///< metres, model frame: `on.position`, or beyond the edge the
                             ///< place where the surface would be if it went on flat
    Vec3 normal{0, 0, 1};    ///< unit, smooth, out of the surface
    Vec3 right{1, 0, 0};     ///< unit, along the surface: the direction of +x there
    Vec3 down{0, -1, 0};     ///< unit, along the surface, normal to `right`: that of +y
    bool on_surface = true;  ///< false past an edge, or where the ray met nothing
    double time = 0;         ///< seconds
    double pressure = 0;     ///< 0–1 of the working depth
    Vec2 tilt{0};            ///< radians, towards right, towards down
    double roll = 0;         ///< radians, see `StrokeSample`
    Vec2 tip_lag{0};         ///< metres to the right and down, in the plane of the surface there, that the
                             ///< hand is ahead of the ink
};

struct SurfaceTrace {
    std::vector<SurfaceSample> samples;  ///< one per sample of the trace, in order
    std::size_t missed = 0;              ///< samples that are not on the surface
    double origin_gap = 0;               ///< metres between the placement's origin and the surface
};

/// Lays a flat trace onto the mesh.
///
/// `SurfaceMapping::wrap` is the exponential map of the polyhedral surface at the point nearest to
/// the placement's origin: sample (x, y) lies |(x, y)| away along the straightest line that
/// leaves in direction x right + y down (Polthier and Schmies 1998: a line crosses an edge
/// straight in the unfolded plane), and its frame is carried along that line. Lengths and
/// angles at the origin are kept; on a developable surface all of them are.
/// `SurfaceMapping::drape` is the same map on the ground as a hand feels it that lies on it: at each
/// step along a line a paraboloid is fitted to the surface within `drape_radius` (rays onto
/// a hexagonal pattern of 37 points, least sum of pseudo-Huber distances, so that what is narrow
/// hardly counts), the line goes on straight on it, and the sample is taken down to the surface
/// along its normal. On a surface without detail of that size it is `wrap` within 0.2 % of the
/// length; over grooves, relief, the noise of a scan, and gaps between parts writing stays whole,
/// where straightest lines of the triangles part. It does not turn round a rim. `normal` and axes
/// are those of the ground. Past an edge it goes on straight.
/// `SurfaceMapping::project` shoots a ray along the placement's inward normal right × down from
/// outside the mesh and takes the first hit.
///
/// Past a border the line goes on straight in the last triangle's plane, and a ray that
/// misses takes the height and frame of the nearest sample in time that hit.
/// Throws `Error` when the trace is not flat, a number is not finite, or the placement's
/// directions are zero or parallel. Cost: about 0.1 µs per triangle crossed.
SurfaceTrace map_to_surface(const mesh::SurfaceQuery& query, const StrokeSamples& trace);

/// Radius in metres of the ground that `SurfaceMapping::drape` levels: 8 mm, or 4 % of the box diagonal
/// of a smaller model.
double drape_radius(const mesh::TriangleMesh& mesh);

/// The point a straightest line of the given length reaches, and the frame carried to it.
struct StraightestGeodesic {
    mesh::SurfacePoint end;   ///< `distance`: length walked on the surface
    Vec3 direction{1, 0, 0};  ///< unit, in the plane of the last triangle: where the line points
    double beyond = 0;        ///< metres left when it met a border
};

/// Walks from `start` (a point of the mesh) along `direction`, which is taken into the
/// triangle's plane. Bounded work: at most 4 n_triangles + 1000 crossings.
StraightestGeodesic trace_geodesic(const mesh::TriangleMesh& mesh, const mesh::SurfacePoint& start,
                                   const Vec3& direction, double length);

/// How far the hand runs ahead of the ink at one depth.
struct TipLag {
    double depth = 0;   ///< metres, of the unbent tip below the surface
    double length = 0;  ///< metres
};

struct HolderOptions {
    double tuft_length = 0.02;     ///< metres from the ferrule's mouth to the unbent tip
    double working_depth = 0.010;  ///< metres of the unbent tip below the surface at pressure 1
    double hover = 0.002;          ///< metres of the tip above the surface when not pressed
    double max_tilt = 1.2;         ///< radians; more lean than this is cut
    double steady = 0.008;         ///< metres to both sides over which the hand levels out height and normal: it
                                   ///< does not dip into grooves; 0: it feels every dent
    std::vector<TipLag> tip_lag;   ///< rising in depth, linear between, constant outside; empty: none
    /// What a lean adds to the tip_lag: metres ahead and to the path's left, for a depth (metres) and a
    /// lean along the path and to its left (radians); see TiltedTipLag. None: it adds nothing.
    std::function<Vec2(double depth, const Vec2& lean)> leaned = {};
    double tip_lag_turn = 0.0015;  ///< metres of travel in which the tip_lag follows a turn
};

/// Working depth of a brush: half of the free hair.
double working_depth(const brush::Preset& preset);

/// Options for a brush over a model (`steady` is its `drape_radius`), without a tip_lag.
HolderOptions holder_options(const brush::Preset& preset, const mesh::TriangleMesh& mesh);

/// The ferrule over each mapped sample. The holder's axis is the surface normal leaned by the
/// tilt, up ∝ normal + tan(tilt.x) right + tan(tilt.y) down; the broad side of the ferrule is x = cos(roll) r +
/// sin(roll) (up × r), with r the direction of `right` across up; the unbent tip lies `tip_depths` below the sample,
/// ahead of it by the tip_lag: where the ink is to lie, the hand does what it would do over the plane there. Normal and
/// height are those of a steady hand (`level_surface` over `steady` of path). It follows ridges and valleys, and passes
/// over grooves narrower than half of the radius. On a surface of curvature κ along the path the height is κ steady² /
/// 200 off at most.
std::vector<brush::Pose> hold(const mesh::SurfaceQuery& query, std::span<const SurfaceSample> samples,
                              const HolderOptions& options);

/// Poses of a trace in space: its samples as they are, rotations of unit length.
std::vector<brush::Pose> spatial_poses(const StrokeSamples& trace);

/// The whole way for any trace: tip_lag, lay, hold, lift off; or the poses as they are for one in space
/// (then `mapped` is empty).
struct HandPath {
    SurfaceTrace mapped;
    std::vector<brush::Pose> poses;
    std::size_t set_down = 0;  ///< of the poses, before that of the trace's first sample; those of the others follow
};
HandPath hand_path(const mesh::SurfaceQuery& query, const StrokeSamples& trace, const HolderOptions& options);

}  // namespace tuft::stroke
