#pragma once

#include <vector>

#include "brush/tuft.h"
#include "mesh/surface_query.h"

namespace tuft::contact {

/// How the surface near the tuft is found.
enum class Method {
    exact,     ///< closest point on the triangles for every node (Embree)
    vertices,  ///< source paper: weighted-average distance over the nearest vertices
};

struct Options {
    Method method = Method::exact;
    double tolerance = 1e-3;        ///< metres: nearer than this the hand feels the surface
    double proximity_force = 0.1;   ///< N, within the tolerance
};

/// What stays from sample to sample of one stroke.
struct Memory {
    Vec3 normal{0};                 ///< outward normal under the tuft at the last touch, or zero
    Vec3 heading{1, 0, 0};          ///< t of the last contact frame
};

/// The tuft against the model at one pose.
struct Result {
    brush::TuftState tuft;
    std::vector<brush::ContactPlane> planes;  ///< of the nodes, as in brush::predicted_nodes
    Frame frame;                ///< on the surface under the contact patch, n outward; t carried
                                ///< along from the stamp before
    std::uint32_t triangle = kNone;  ///< under frame.origin; kNone when nothing is near
    double distance = 0;        ///< metres from the tip to the surface; 0 when touching
    Vec3 hand_force{0};         ///< N, to a haptic device: gain, clamp and proximity applied
};

/// Moves the brush to `pose`, finds the surface every node meets and bends the tuft
/// against it. One-sided: a node is pushed to the side the ferrule is on, also where the
/// wall is thinner than the tuft. Cost: two closest points per node near the surface and
/// the solve, 40–100 µs.
Result step(brush::Tuft& tuft, const brush::Pose& pose, const mesh::SurfaceQuery& surface,
            Memory& memory, double dt, const Options& options = {});

}  // namespace tuft::contact
