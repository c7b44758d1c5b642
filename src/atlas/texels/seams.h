#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "atlas/texels/texel_map.h"

/// \file
/// Mesh edges along which the atlas is cut, and the texels on both sides. Used by the other files of atlas/texels.
namespace tuft::atlas {

/// One side of a seam at one point: where it lies in the atlas and on the surface.
struct SeamSide {
    std::uint32_t triangle = kNone;  ///< on this side
    Vec2 uv{0};                      ///< texels
    Vec2 along{1, 0};                ///< unit, direction of the seam in the atlas, texels
    Vec3 normal{0, 0, 1};            ///< unit, corner normals interpolated
};

/// A point on a seam.
struct SeamSample {
    SeamSide a, b;      ///< its two sides
    Vec3 position{0};   ///< metres
    double length = 0;  ///< texels of the seam that the sample represents, mean of both sides
};

/// An edge of the mesh whose two triangles do not share it in the atlas.
struct SeamEdge {
    std::uint32_t triangle_a = kNone, triangle_b = kNone;  ///< on its two sides
    int corner_a = 0, corner_b = 0;                        ///< the edge starts here in a, and here in b (reversed)
};

/// Place of a triangle's corner in the atlas, texels, inside it. Not finite where the
/// atlas's own is not.
Vec2 corner_texels(const Atlas& atlas, std::uint32_t triangle, int corner);

/// Returns all edges at which charts meet, by triangle_a and corner_a.
std::vector<SeamEdge> find_seams(const mesh::TriangleMesh& mesh, const Atlas& atlas);

/// Samples of one edge, evenly spread, at most `spacing` texels apart on either side.
void sample_seam(const mesh::TriangleMesh& mesh, const Atlas& atlas, const SeamEdge& edge, double spacing,
                 std::vector<SeamSample>& samples);

/// Returns the covered texel of `chart` whose centre is nearest to `uv` (texels), at most `max_distance` texels
/// away and connected to the surface at `position`.
TexelRef nearest_texel(const TexelMap& map, std::uint32_t chart, const Vec2& uv, const Vec3& position,
                       double max_distance);

}  // namespace tuft::atlas
