#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mesh/triangle_mesh.h"

/// \file
/// Groups of the parts of a glTF file: what its parts are called. Called by the reader, and for the model of a project
/// that was made before several nodes of one material were parts of their own. Any thread.
namespace tuft::mesh {

/// Groups of parts, each of one material.
struct PartGroups {
    std::vector<std::uint32_t> of_part;  ///< [n_parts] index into `names`
    std::vector<std::string> names;      ///< unique, in the order of the parts
};

inline constexpr std::size_t kMaxPartNameBytes = 200;  ///< longer names are cut

/// Material of what is painted, in exports. It names no part, nor do "decorated.1002", "decorated.glass" …
inline constexpr const char* kDecoratedMaterial = "decorated";

/// Returns the groups of parts. A part is named by its `group`; else by its material where only one node has that; else
/// by its object, and by "object / material" where its node has several materials. Equal names get numbers, also those
/// of several nodes with one `group`, as copies of an exported object have.
PartGroups group_parts(std::span<const ScenePart> parts);

/// Returns the mesh with the groups of `group_parts`. Unchanged where its scene has parts that are its groups.
TriangleMesh with_part_groups(TriangleMesh mesh);

}  // namespace tuft::mesh
