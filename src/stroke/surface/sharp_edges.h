#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/query/surface_query.h"

/// \file
/// Sharp edges and borders of a mesh. Called by mask_texels.cpp and by the layout of texts and bands.
namespace tuft::stroke {

/// An edge between two vertices of the mesh.
using SharpEdge = std::array<std::uint32_t, 2>;

/// Returns the borders of the mesh and the edges whose two triangles have normals more than `angle` radians apart, each
/// once, in the order of their first triangle.
std::vector<SharpEdge> sharp_edges(const mesh::TriangleMesh& mesh, double angle);

}  // namespace tuft::stroke
