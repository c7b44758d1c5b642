#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/triangle_mesh.h"

/// \file
/// Groups of the parts of a glTF file: what its parts are called. Called by the reader, and for the model of a project
/// that was made before several nodes of one material were parts of their own. Any thread.
namespace tuft::mesh {

/// Groups of parts, each of one material, or of that of exports on each of its pages.
struct PartGroups {
    std::vector<std::uint32_t> of_part;  ///< [n_parts] index into `names`
    std::vector<std::string> names;      ///< unique, in the order of the parts
};

inline constexpr std::size_t kMaxPartNameBytes = 200;  ///< longer names are cut

/// Material of what is painted, in exports. It names no part, nor do "decorated.1002", "decorated.glass" …
inline constexpr const char* kDecoratedMaterial = "decorated";

/// End of its name where the part lets light through.
inline constexpr const char* kGlassSuffix = ".glass";

/// Returns the UDIM page of such a material ("decorated.1002", "decorated.1002.glass"); 0: no such material, or on the
/// one page of its model.
std::uint32_t decorated_page(std::string_view material);

/// Returns the groups of parts. A part is named by its `group`; else by its object where its node has one material; of
/// a node with several by its material where only this node has that, else "object / material". Parts without an object
/// are named by their material. Equal names get numbers, also those of several nodes with one `group`, as copies of an
/// exported object have; decorated materials of one node on several pages are one group.
PartGroups group_parts(std::span<const ScenePart> parts);

/// Returns the mesh with the groups of `group_parts`. Unchanged where its scene has parts that are its groups.
TriangleMesh with_part_groups(TriangleMesh mesh);

}  // namespace tuft::mesh
