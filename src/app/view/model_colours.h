#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "atlas/atlas.h"
#include "mesh/triangle_mesh.h"

/// Colours of triangles that show how the atlas lies on the model, sRGB [n_triangles].
namespace tuft::app {

using TriangleColours = std::vector<std::array<std::uint8_t, 4>>;

/// A colour for each chart; neighbours in number differ.
TriangleColours chart_colours(const atlas::Atlas& atlas);

/// Texels per metre in each triangle against the mean, √((Γ² + γ²) / 2) of the map from the
/// surface to the atlas (Sander et al. 2001): grey where it is the mean, blue below, red above;
/// full colour at a factor of 1.5.
TriangleColours stretch_colours(const mesh::TriangleMesh& mesh, const atlas::Atlas& atlas);

}  // namespace tuft::app
