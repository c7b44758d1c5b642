#pragma once

#include <cstdint>
#include <vector>

#include "decal/panels/film_mesh.h"

/// \file
/// Gaps that film spans: shut lines and grooves, in which a brush leaves little. Called by sheet.h.
namespace tuft::decal {

/// Distance of the walls of the widest gap that film spans, metres.
inline constexpr double kBridgedGap = 0.008;

/// Returns for each triangle of the film 1 where it lies in a gap: a ball of diameter `kBridgedGap` that touches its
/// middle from outside meets the model, and over such triangles it is no more than half of that to a wall that faces
/// another one. That wall is film as well, of the same panel and connected over such triangles: a handle beside a cup
/// and a mirror before a door are no gaps. So are no creases and fillets. Cost: a closest point and two rays for each
/// triangle. Any number of threads.
std::vector<std::uint8_t> find_gaps(const mesh::TriangleMesh& model, const FilmMesh& film);

}  // namespace tuft::decal
