#pragma once

#include <span>
#include <vector>

#include "brush/state/tuft_state.h"
#include "contact/sphere.h"
#include "mesh/query/surface_query.h"

/// \file
/// Contact by the source paper's method: distance over the nearest vertices, tip moved to the surface, effective
/// vertices in the tuft's bounding sphere, projection plane. Called by contact.h for `Method::vertices`. Source:
/// [Huang2018], sections 3 and 4.
namespace tuft::contact {

/// d = Σ w_i n_i·(P0 - v_i) / Σ w_i with w_i = 1 - |P0 - v_i| / d_max; negative inside.
struct WeightedDistance {
    double distance = 0;                     ///< metres, d_w
    Vec3 normal{0, 0, 1};                    ///< unit, Σ w_i n_i normalised
    std::vector<mesh::NearVertex> vertices;  ///< that were weighted
    bool found = false;                      ///< false: no vertex, or weights or normals sum to 0
};

/// Returns the weighted distance over given vertices. Exact on a plane; elsewhere the error is about κ h²/2 for
/// curvature κ and vertex spacing h. The farthest vertex has weight 0, so the distance is continuous when the set
/// changes.
WeightedDistance weighted_distance(std::span<const mesh::NearVertex> vertices, const Vec3& tip);

/// The same for the `k` vertices nearest to the tip with normals towards `holder`.
WeightedDistance weighted_distance(const mesh::SurfaceQuery& surface, const Vec3& tip, const Vec3& holder, int k = 8);

/// Returns P0 − d_w n: the tip projected onto the surface.
Vec3 snap_tip(const Vec3& tip, const WeightedDistance& d);

/// Returns `per_section` points round every section of the tuft, and the tip.
std::vector<Vec3> outline_points(const brush::TuftState& tuft, int per_section = 8);

/// Vertices within a sphere that face the holder and are connected to the triangle under the contact.
struct EffectivePatch {
    std::vector<std::uint32_t> vertices;  ///< in the order of the search
    Vec3 normal{0, 0, 1};                 ///< unit, Σ A_v n_v over them; the triangle's normal if there is none
    double area = 0;                      ///< m², Σ A_v: a third of the triangles round each vertex
};

/// Returns the patch of `triangle`: a search over adjacent triangles that intersect the sphere and face `holder`.
EffectivePatch effective_patch(const mesh::TriangleMesh& mesh, std::uint32_t triangle, const Sphere& sphere,
                               const Vec3& holder);

}  // namespace tuft::contact
