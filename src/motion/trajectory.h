#pragma once

#include <string>

#include "mesh/query/surface_query.h"
#include "motion/retime.h"

/// \file
/// The strokes of a journal as motions of a robot or plotter that holds the brush: timed poses with approach, retract
/// and pen-up travel. `tuft trajectory` calls it; io/motion writes the result.
namespace tuft::motion {

/// One stroke as the hand made it.
struct StrokePath {
    std::uint64_t id = 0;  ///< of its entry
    std::string label;
    std::vector<Waypoint> points;  ///< `pose.time` is the hand's
    double tuft_length = 0.03;     ///< metres from the ferrule's mouth to the unbent tip
    double tuft_radius = 0.004;    ///< metres
};

/// Lean from the vertical up to which `make_upright` takes a holder, radians: more than a stroke drawn by lines has,
/// whose brush is set down ahead of its path.
inline constexpr double kMostStraightened = 0.2;

/// Stands the holder upright over a flat sheet, z up, for a machine that cannot lean it. The tip of the unbent tuft
/// stays where it is, and the holder keeps its rotation about its axis but for the turn that takes the axis to the
/// vertical the shortest way. A stroke in which it leans by more than `kMostStraightened` stays as it is. Returns the
/// greatest lean of the stroke as it was, radians.
double make_upright(StrokePath& stroke);

/// The holder behind the ferrule: a cylinder about its axis, with round ends, from the mouth backwards.
struct Holder {
    double radius = 0.006;  ///< metres
    double length = 0.15;   ///< metres
};

/// What the tool does at a waypoint.
enum class MoveKind {
    approach,  ///< along the axis, from `clearance` above the surface to the first pose
    stroke,
    retract,  ///< back along the axis
    travel,   ///< from stroke to stroke, clear of the model
};
/// Returns the word of a kind in files.
const char* name_of(MoveKind kind);

/// A stroke, or a motion without contact.
struct Move {
    MoveKind kind = MoveKind::stroke;
    std::size_t stroke = 0;        ///< index of the stroke that it belongs to, or leads to
    std::vector<Waypoint> points;  ///< from rest to rest; times from the start of the trajectory
};

/// The motion of the tool over all strokes.
struct Trajectory {
    std::vector<Move> moves;  ///< each begins where and when the one before it ends

    double seconds() const { return moves.empty() ? 0 : moves.back().points.back().pose.time; }
};

/// Options of `plan`.
struct MotionOptions {
    Limits limits;
    Holder holder;
    double clearance = 0.02;  ///< metres, of the tip above the surface before and after a stroke
};

/// Distance of brush and holder from the model in travel, metres, at least.
inline constexpr double kTravelGap = 0.003;

/// Returns the trajectory of strokes in their order. A stroke's path is its own, without points where mouth and unbent
/// tip are within 5 µm of the line between their neighbours, and the hand's clock within 1 ms. Travel is straight where
/// the whole tool stays `kTravelGap` clear of the model, sampled each 2 mm by closest points (Embree). Else it goes out
/// along the axis, round the model on a sphere, and in again; it goes over the top where the sphere's path would pass
/// below the model. Throws `Error` that names the stroke where the holder would hit the model, or no clear path leads
/// to it.
Trajectory plan(const mesh::SurfaceQuery& query, const std::vector<StrokePath>& strokes, const MotionOptions& options);

}  // namespace tuft::motion
