#pragma once

#include "core/message.h"
#include "mesh/triangle_mesh.h"

/// \file
/// Check of a mesh that was stored: by a project (`io`) or in the cache of prepared models (`stroke`).
namespace tuft::mesh {

/// Returns why a mesh cannot be used, empty when it can. Faults are arrays that are absent or of the wrong size,
/// indices of vertices, triangles, groups or parts that do not exist, points and normals that are no numbers or too far
/// away, and a model below `kSmallestModel`.
Message fault_of(const TriangleMesh& mesh);

}  // namespace tuft::mesh
