#pragma once

#include <filesystem>
#include <optional>

#include "mesh/read/polygon_soup.h"

namespace tuft::io {

/// Reads a model file: OBJ, PLY, STL, OFF, GLB or glTF, told apart by their first bytes
/// where the format has any, else by the extension. Throws `Error` naming file and fault.
///
/// glTF: all triangle lists, strips and fans of the default scene (or of all nodes)
/// with their node transforms, in metres, turned from y up to z up (x, −z, y), UVs of set 0
/// with v up, materials as groups; points and lines are skipped with a warning. Buffers may
/// lie in the file, in data URIs, or in files inside the model's folder.
///
/// Colours of its own: base colour (factor, picture of UV set 0, COLOR_0) in glTF, `Kd` and `map_Kd`
/// in OBJ, `TextureFile` in PLY, colours of facets and vertices (materials.h).
mesh::PolygonSoup read_model(const std::filesystem::path& path);

/// Metres per unit where the format fixes it (glTF: 1), else nothing.
std::optional<double> metres_per_unit_of(const std::filesystem::path& path);

}  // namespace tuft::io
