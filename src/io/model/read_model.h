#pragma once

#include <filesystem>
#include <optional>

#include "mesh/read/polygon_soup.h"

namespace tuft::io {

/// The formats that `read_model` reads, for messages.
inline constexpr const char* kModelFormats = "OBJ, PLY, STL, OFF, GLB, glTF, FBX, DAE, 3MF and X3D";

/// Whether `path` has the extension of one of them, in any case.
bool is_model_file(const std::filesystem::path& path);

/// Reads a model file of `kModelFormats`, recognised by their first bytes
/// where the format has any, else by the extension. Throws `Error` naming file and fault.
///
/// glTF: all triangle lists, strips and fans of the default scene (or of all nodes)
/// with their node transforms, in metres, turned from y up to z up (x, −z, y), UVs of set 0
/// with v up, materials as groups; points and lines are skipped with a warning. Buffers may
/// lie in the file, in data URIs, or in files inside the model's folder.
///
/// FBX, DAE, 3MF and X3D: all faces with the transforms of their nodes, in metres, z up, by the unit and the axes of
/// the file (read_import.h, read_3mf.h, read_x3d.h).
///
/// Colours of its own: base colour (factor, picture of UV set 0, COLOR_0) in glTF, `Kd` and `map_Kd`
/// in OBJ, `TextureFile` in PLY, colours of facets and vertices (materials.h).
mesh::PolygonSoup read_model(const std::filesystem::path& path);

/// Metres per unit where the file's format says it, else nothing: `read_model` gives glTF, FBX, DAE, 3MF and X3D in
/// metres.
std::optional<double> metres_per_unit_of(const std::filesystem::path& path);

}  // namespace tuft::io
