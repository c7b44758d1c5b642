#pragma once

#include <cstdint>
#include <span>

#include "atlas/atlas.h"

namespace tuft::atlas {

/// Takes the edges that must be seams out of `twin` [3n], so that for everything that makes
/// charts they are borders of the mesh. Throws `Error` when face groups are all that is asked
/// for and the mesh has none.
void cut_requested_seams(const mesh::TriangleMesh& mesh, const RequestedSeams& seams, std::span<std::uint32_t> twin);

}  // namespace tuft::atlas
