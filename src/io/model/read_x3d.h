#pragma once

#include <filesystem>
#include <vector>

#include "mesh/read/polygon_soup.h"

namespace tuft::io {

/// X3D in XML (ISO/IEC 19776-1): sets of faces, triangles and quads, strips and fans, under Transform, Group, Switch
/// and LOD, with DEF and USE; Material and ImageTexture, the latter from the model's folder only. Metres by the file's
/// unit, turned from y up to z up; a group for each object and material. Inline files and shapes by formula (Box,
/// Extrusion) are skipped with a warning. Own reader, because Assimp 5.2 gives each vertex one UV, the last of its
/// corners'. Throws `Error` naming file and fault. Inside `io` only.
mesh::PolygonSoup read_x3d(const std::vector<char>& bytes, const std::filesystem::path& path);

}  // namespace tuft::io
