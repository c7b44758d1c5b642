#pragma once

#include <vector>

#include "brush/tuft/tuft.h"
#include "contact/near_vertices.h"
#include "mesh/query/surface_query.h"

/// The tuft against the model.
namespace tuft::contact {

/// How the surface near the tuft is found.
enum class Method {
    exact,     ///< for every node the closest point on the triangles, as a plane of its own
    vertices,  ///< source paper: one plane by the weighted-average distance of the tip over
               ///< the nearest vertices; projection plane from the effective vertices
};

struct Options {
    Method method = Method::exact;
    double tolerance = 1e-3;       ///< metres: nearer than this the hand feels the surface
    double proximity_force = 0.1;  ///< N, within the tolerance; grows over its outer tenth
    int nearest_vertices = 8;      ///< k of the weighted-average distance
    double refresh_error = 2e-5;   ///< metres a plane may be off where the tuft came to rest
    int max_refreshes = 1;         ///< solves repeated with planes at the nodes' new places
};

/// What stays from sample to sample of one stroke.
struct Memory {
    bool touching = false;      ///< at the last sample
    Vec3 root{0};               ///< ferrule's mouth at the last sample, metres
    Vec3 outside{0};            ///< the same, or where it came out in front of the surface
    double side = 1;            ///< -1: on the back of an open sheet
    Vec3 heading{1, 0, 0};      ///< t of the last contact frame
    Vec3 origin{0};             ///< of the last contact frame
    std::vector<Vec3> centres;  ///< of all sections at the last sample, metres
};

/// The tuft against the model at one pose.
struct Result {
    brush::TuftState tuft;
    std::vector<brush::ContactPlane> planes;                      ///< that it was bent against, as in brush::step
    std::vector<std::vector<brush::ContactPlane>> branch_planes;  ///< of every section of tuft.branches,
                                                                  ///< empty when nothing is near
    Frame frame;                     ///< on the surface under the contact patch, n outward; t carried
                                     ///< along from the stamp before; travels with the hair
    std::uint32_t triangle = kNone;  ///< under frame.origin; kNone when nothing is near
    Vec3 travel{0};                  ///< metres, world: way of the touching hair since the last sample; the
                                     ///< frame's origin may go another way over a crease. 0 at first touch
    double distance = 0;             ///< metres from the tuft's skin to the surface; 0 when touching
    double inside = 0;               ///< metres that the pose would have the ferrule's mouth below the surface
    Vec3 device_force{0};            ///< N, to a haptic device: gain, clamp and proximity applied
    Sphere sphere;                   ///< Method::vertices: round the bent tuft
    EffectivePatch patch;            ///< Method::vertices: vertices the projection plane is made from
};

/// Moves the brush to `pose`, finds the surface every node meets and bends the tuft
/// against it. Broad phase: the tuft's oriented box against the model's. One-sided: a node is
/// pushed to the side the ferrule is on, also where the wall is thinner than the tuft is pressed
/// deep, and where the ferrule itself has been pushed through since the last sample. The ferrule
/// cannot enter the object: its mouth is held half a tuft's radius off the surface that it would go
/// through, less beside it, so that the force is at most that of hair pressed flat under it.
/// Creases, bowls and rims come out of the planes being local; they are looked up again where the
/// tuft has moved off them. Always finite. Cost: 50–200 µs.
Result step(brush::Tuft& tuft, const brush::Pose& pose, const mesh::SurfaceQuery& surface, Memory& memory, double dt,
            const Options& options = {});

}  // namespace tuft::contact
