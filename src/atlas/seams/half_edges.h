#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/half_edge.h"
#include "mesh/triangle_mesh.h"

/// \file
/// Half-edges (mesh/half_edge.h) of a mesh and of a patch. Used by all of `atlas`.
namespace tuft::atlas {

using mesh::next_half;
using mesh::prev_half;

/// The opposite half-edge of each, kNone on a border. [3 n_triangles]. Neighbours
/// that do not share the edge in opposite directions count as borders.
std::vector<std::uint32_t> twin_half_edges(const mesh::TriangleMesh& mesh);

/// Returns the local number of half-edge `h` in `triangles` (ascending), or kNone.
std::uint32_t local_half(std::span<const std::uint32_t> triangles, std::uint32_t h);

/// A part of a mesh with its own numbering; whatever lies outside is border.
struct Patch {
    std::vector<std::uint32_t> triangles;  ///< [n] triangle of the mesh
    std::vector<std::uint32_t> twin;       ///< [3n] half-edges of the patch
    std::vector<std::uint32_t> vertex;     ///< [3n] corner to vertex; a vertex is one fan of triangles
    std::uint32_t n_vertices = 0;
    std::vector<Vec3f> normal;  ///< [n] unit
    std::vector<float> area;    ///< [n] m² over `unit`²
    std::vector<float> length;  ///< [3n] edge length over `unit`
};

/// `triangles` in ascending order; `twin` of the mesh, kNone also where it is cut;
/// `unit` in metres makes all numbers scale-free.
Patch make_patch(const mesh::TriangleMesh& mesh, std::span<const std::uint32_t> twin,
                 std::vector<std::uint32_t> triangles, double unit);

/// Sum of the corner angles at each vertex, radians. [n_vertices]
std::vector<float> vertex_angles(const Patch& patch);

/// Angle defect, radians, in absolute value, above which a vertex is flattened only with a seam that ends there.
inline constexpr double kSlitDefect = 1.0;

}  // namespace tuft::atlas
