#pragma once

#include <cstdint>
#include <memory>

#include "brush/rod/solver_work.h"
#include "core/geometry/types.h"
#include "core/system/recycled.h"

/// \file
/// Poses, sections and forces of a tuft: the data that `brush` gives to all modules above it.
namespace tuft::brush {

/// Pose of the holder: position of the ferrule's mouth (the root of the tuft, P_m) and its rotation. The tuft's
/// rest axis, from root to tip, is rotation * (0, 0, −1).
struct Pose {
    Vec3 position{0};  ///< metres, world
    Quat rotation{1, 0, 0, 0};
    double time = 0;  ///< seconds

    Vec3 axis() const { return rotation * Vec3{0, 0, -1}; }
};

/// Returns the pose at t in [0, 1] from `a` to `b`: position and time linearly, rotation along the shorter arc.
Pose interpolate(const Pose& a, const Pose& b, double t);

/// A cross-section of the tuft: an ellipse round a spine node P_i.
/// Outline: centre + a cos ω e + b sin ω m, m = e × tangent.
struct Section {
    Vec3 centre{0};          ///< metres, world
    Vec3 tangent{0, 0, -1};  ///< unit, towards the tip, bisecting the two segments
    Vec3 e{1, 0, 0};         ///< unit, normal of the bending plane
    Vec3 m{0, 1, 0};         ///< unit, in the bending plane
    double a = 0;            ///< semi-axis along e, metres
    double b = 0;            ///< semi-axis along m, metres; a b = r² (area is kept)
    /// Cosine and sine of ψ: the broad side of a strip's hair is at ω = ψ of the outline, its thickness a quarter turn
    /// on.
    Vec2 turn{1, 0};
    double moment = 0;    ///< bending moment, N·m
    double pressure = 0;  ///< contact force per length on the node, N/m
};

/// One spine with its sections, tip first (index 0) and root last.
struct Branch {
    Recycled<Section> sections;
    double ink_share = 1;  ///< of the tuft's ink; shares sum to one
    /// Corners of the hair's section where that is a strip, convex, over the semi-axes at ψ and across; else empty.
    Recycled<Vec2> strip;
    double rest_length = 1;  ///< of the hair, over the tuft's
    double edge_short = 0;   ///< metres, by how much the hair at the free edge of an outermost strip is shorter
};

/// Energy of the whole spine, joules; sub-spines follow it. The hand's work against `TuftState::force` and `moment`
/// is the change of stored() plus `lost`.
struct TuftEnergy {
    double bend = 0;     ///< stored in the bent hair
    double contact = 0;  ///< in indented hair, in sticking hair, and in the wet film
    double aside = 0;    ///< in side nodes shifted to one side by friction
    double spread = 0;   ///< part of bend and contact: in the springs of the spread side nodes
    double lost = 0;     ///< dissipated since the previous step by yielding, slip, damping; never negative

    double stored() const { return bend + contact + aside; }
};

struct CarriedShape;

/// What a tuft with a geometry or of foam looks like: the points of its carried shape (tuft/geometry_tuft.h), bent.
/// Empty for other tufts.
struct TuftShape {
    std::shared_ptr<const CarriedShape> carried;  ///< its points at rest, triangles and lines
    Recycled<Vec3> position;                      ///< [points] metres, world
    /// [points] metres over the surface. Of foam: where the point would be if the surface did not hold it; negative
    /// where it is pressed. Empty in air.
    Recycled<double> height;
    /// [points] metres over the surface, of the middle of the section that a point of a mesh of hair is in; or empty.
    Recycled<double> middle;
    Recycled<Vec3> normal;  ///< [points] unit, of the surface under the point; or empty
};

/// Gap between two neighbouring branches.
struct Opening {
    int first = 0, second = 1;  ///< branches
    /// By how much it is wider than ink bridges, metres; at most 0 where they are joined. Beyond the end of the shorter
    /// one: as at its tip. [sections of the first], tip first
    Recycled<double> width;
};

/// State of the tuft at one time: one branch, the sub-spines after bifurcation, or the spines of a ferrule.
struct TuftState {
    Recycled<Branch> branches;
    /// The branches are the spines of a ferrule, in the order of `Tuft::spines`; else one trunk, or its sub-spines.
    bool wide = false;
    bool strips = false;         ///< they stand in a row: the hair of each fills a rectangle, not a disc
    Recycled<Opening> openings;  ///< of neighbouring spines, or none
    Vec3 force{0};               ///< of the surface on the tuft, newtons, world
    Vec3 device_force{0};        ///< that force filtered by the hair's mass, newtons, world
    Vec3 moment{0};              ///< of `force` about the root, N·m, world
    double root_moment = 0;      ///< bending moment at the ferrule, N·m
    double normal_force = 0;     ///< newtons
    TuftEnergy energy;
    TuftShape shape;
    double volume_lost = 0;  ///< m³, by which foam is smaller than at rest
    bool touching = false;
    bool converged = true;  ///< false: the solver stopped at its limit with its best state
    SolverWork work;        ///< of all parts of the motion to this state
};

/// Contact plane of the tuft, or of one node: points p with dot(p − origin, normal) < 0 are inside the object. Next
/// to a sharp convex edge it also has the plane beyond the edge: a point is inside when it is inside both.
struct ContactPlane {
    Vec3 origin{0};         ///< metres, world
    Vec3 normal{0, 0, 1};   ///< unit, out of the object
    Vec3 beyond_origin{0};  ///< of the plane beyond the edge
    Vec3 beyond_normal{0};  ///< unit; zero: no edge near
};

inline constexpr double kEdgeRounding = 2e-4;  ///< m, rounding radius of edges in contact with the tuft

/// Returns the distance of p from the plane, or from both planes with their edge rounded (see wedge.h), metres.
double height_over(const ContactPlane& plane, const Vec3& p);

}  // namespace tuft::brush
