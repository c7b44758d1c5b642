#pragma once

#include <filesystem>
#include <vector>

#include "mesh/read/polygon_soup.h"

namespace tuft::io {

/// 3MF core specification 1.3 with the parts of its extensions that say where triangles lie and what colour they have:
/// components and their transforms, objects in other parts of the package (production), base materials, colour groups
/// and textures (materials). In metres by the file's unit, z up; a group for each object and material. Own reader,
/// because Assimp 5.2 leaves aside the unit, the names, all materials but an object's first, and the UVs of a
/// triangle. Throws `Error` naming file and fault. Inside `io` only.
mesh::PolygonSoup read_3mf(const std::vector<char>& bytes, const std::filesystem::path& path);

}  // namespace tuft::io
