#pragma once

#include "brush/tuft/tuft.h"
#include "contact/groove.h"
#include "contact/near_vertices.h"
#include "contact/node_contact.h"
#include "core/system/recycled.h"
#include "mesh/query/surface_query.h"

/// \file
/// Contact of the tuft with the model: one call per pose finds the contact planes and bends the tuft. `stroke`
/// calls `step` for every sample of a stroke.
namespace tuft::contact {

/// Method that finds the surface near the tuft.
enum class Method {
    exact,  ///< one plane per node, at the closest point on the triangles
    /// Source paper: one plane by the weighted-average distance of the tip over the nearest vertices; projection
    /// plane from the effective vertices.
    vertices,
};

/// Options of `step`.
struct Options {
    Method method = Method::exact;
    double tolerance = 1e-3;       ///< metres: distance below which the device force is not 0
    double proximity_force = 0.1;  ///< N, within the tolerance; rises from 0 over its outer tenth
    int nearest_vertices = 8;      ///< k of the weighted-average distance
    double refresh_error = 2e-5;   ///< metres, allowed error of a plane at the solved position of its node
    int max_refreshes = 1;         ///< solves repeated with planes at the new node positions
};

/// Where the nodes came to rest at a sample, and what they rested on.
struct Rest {
    Recycled<brush::ContactPlane> planes, walls;  ///< of the nodes, and beside them
    Recycled<Vec3> nodes;                         ///< metres; none: nothing is known
    bool verified = false;                        ///< the planes were within `Options::refresh_error` there
    int searches = 0;                             ///< for planes since the nodes moved
};

/// Contact state of one stroke over one surface, from sample to sample. For another surface start with a new one.
struct Memory {
    bool touching = false;   ///< at the last sample
    Vec3 root{0};            ///< ferrule's mouth at the last sample, metres
    Vec3 outside{0};         ///< root, or its projection in front of the surface
    double side = 1;         ///< -1: on the back of an open sheet
    Vec3 heading{1, 0, 0};   ///< unit, t of the last contact frame
    Vec3 origin{0};          ///< of the last contact frame
    Vec3 centre{0};          ///< of the touching hair, followed like `origin` but not moved onto the surface
    Recycled<Vec3> centres;  ///< of all sections at the last sample, metres
    /// Of the spines' nodes at the last sample, or none: the next search begins there.
    Recycled<NodeContact> contacts;
    Recycled<NodeWalls> walls;  ///< of the spines' nodes at the last sample, where one lies in a groove, or none
    Rest rest;
    SmoothTriangles smooth;  ///< of the surface
};

/// Contact at one pose.
struct Result {
    brush::TuftState tuft;                 ///< bent
    Recycled<brush::ContactPlane> planes;  ///< of the last solve: one per node, one for all, or none
    /// [branch][section], tip first, as tuft.branches; empty when nothing is near.
    Recycled<Recycled<brush::ContactPlane>> branch_planes;
    /// On the surface under the contact patch, n outward; t is parallel-transported from the previous stamp;
    /// moves with the hair.
    Frame frame;
    std::uint32_t triangle = kNone;  ///< under frame.origin; kNone when nothing is near
    /// Metres, world: displacement of the touching hair since the last sample; 0 at first contact. Differs from
    /// that of the frame's origin over a crease.
    Vec3 travel{0};
    double distance = 0;   ///< metres from the tuft's surface to the model's; 0 when touching
    double inside = 0;     ///< metres, depth of the ferrule's mouth below the surface at the given pose
    Vec3 device_force{0};  ///< N, to a haptic device: gain, clamp and proximity applied
    Sphere sphere;         ///< Method::vertices: round the bent tuft
    EffectivePatch patch;  ///< Method::vertices: vertices the projection plane is made from
};

/// Returns the thickness, m, of hair or foam that is pressed flat under the ferrule.
double ferrule_pad(const brush::Preset& preset);

/// Returns the least height, m, of the ferrule's mouth over a surface with normal `n` for a tuft whose rest axis is
/// `axis`: `pad`, which is pressed flat, where the surface lies before the mouth, 0 where it lies beside it.
double mouth_clearance(const Vec3& n, const Vec3& axis, double pad);

/// Moves the brush to `pose`, finds the contact plane of every node and bends the tuft against the planes. The
/// result is always finite. `dt` is in seconds since the last step. Throws `Error` for a pose that `brush::step`
/// rejects. Cost: 50–200 µs.
///
/// Broad phase: overlap of the oriented boxes of tuft and model. Contact is one-sided: a node is pushed to the side
/// of the ferrule. This holds where a wall is thinner than the indentation, and where the ferrule itself has passed
/// through it since the last sample. The ferrule cannot enter the object: its mouth stays half a tuft's radius, of foam
/// 4 % of its height, off the surface it would cross, less beside that surface. The force is therefore at most that of
/// hair pressed flat. Planes are local, so creases, bowls and rims need no special case. They are updated where the
/// tuft has moved off them.
Result step(brush::Tuft& tuft, const brush::Pose& pose, const mesh::SurfaceQuery& surface, Memory& memory, double dt,
            const Options& options = {});

}  // namespace tuft::contact
