#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "atlas/atlas.h"
#include "mesh/triangle_mesh.h"

/// \file
/// Colours of triangles that visualise the atlas, sRGB [n_triangles]. Any thread.
namespace tuft::app {

using TriangleColours = std::vector<std::array<std::uint8_t, 4>>;

/// Returns one colour per chart; consecutive charts differ.
TriangleColours chart_colours(const atlas::Atlas& atlas);

/// Returns colours for the texel density of each triangle over the mean, √((Γ² + γ²) / 2) with the singular values of
/// the map from surface to atlas [Sander2001]: grey at the mean, blue below, red above; saturated from a factor
/// of 1.5.
TriangleColours stretch_colours(const mesh::TriangleMesh& mesh, const atlas::Atlas& atlas);

}  // namespace tuft::app
