#pragma once

#include <span>
#include <vector>

#include "brush/tuft/tuft_state.h"
#include "contact/sphere.h"
#include "mesh/query/surface_query.h"

/// The source paper's way to a contact: distance over the nearest vertices, tip snapped to
/// the surface, effective vertices in the tuft's bounding sphere, projection plane.
/// Source: variable stiffness brush (Huang and Hou 2018), sections 3 and 4.
namespace tuft::contact {

/// d = Σ w_i n_i·(P0 - v_i) / Σ w_i with w_i = 1 - |P0 - v_i| / d_max; negative inside.
struct WeightedDistance {
    double distance = 0;   ///< metres, d_w
    Vec3 normal{0, 0, 1};  ///< unit, Σ w_i n_i normalised
    std::vector<mesh::NearVertex> vertices;
    bool found = false;  ///< false: no vertex, or weights or normals that cancel
};

/// The formula on given vertices. Exact on a plane; elsewhere the error is about κ h²/2 for
/// curvature κ and vertex spacing h. The farthest vertex has no weight, so that the distance
/// stays continuous when the set changes.
WeightedDistance weighted_distance(std::span<const mesh::NearVertex> vertices, const Vec3& tip);

/// The same for the `k` vertices nearest to the tip whose normals look towards `holder`.
WeightedDistance weighted_distance(const mesh::SurfaceQuery& surface, const Vec3& tip, const Vec3& holder, int k = 8);

/// P0 - d_w n: the tip put on the surface.
Vec3 snap_tip(const Vec3& tip, const WeightedDistance& d);

/// Points round every section of the tuft, `per_section` each, and the tip.
std::vector<Vec3> outline_points(const brush::TuftState& tuft, int per_section = 8);

/// Vertices of the surface within a sphere that face the holder and hang together with
/// the triangle under the contact.
struct EffectivePatch {
    std::vector<std::uint32_t> vertices;  ///< in the order of the walk
    Vec3 normal{0, 0, 1};                 ///< unit, Σ A_v n_v over them; of the triangle if none
    double area = 0;                      ///< m², Σ A_v: a third of the triangles round each vertex
};

/// Walks from `triangle` over triangles that reach into the sphere and face `holder`.
EffectivePatch effective_patch(const mesh::TriangleMesh& mesh, std::uint32_t triangle, const Sphere& sphere,
                               const Vec3& holder);

}  // namespace tuft::contact
