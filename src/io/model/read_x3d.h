#pragma once

#include <filesystem>
#include <vector>

#include "mesh/read/polygon_soup.h"

namespace pugi {
class xml_document;
}

/// \file
/// Reader of X3D in XML (ISO/IEC 19776-1). Called by read_model.cpp and read_vrml.cpp. Any thread. Assimp 5.2 does not
/// replace it: it gives each vertex one UV, the last of its corners'.
namespace tuft::io {

/// Returns all faces of a file: sets of faces, triangles and quads, strips and fans, under Transform, Group, Switch and
/// LOD, with DEF and USE. Points are in metres by the file's unit, rotated from y up to z up. Each object and material
/// is a group. Material and ImageTexture are read, pictures from the model's folder only. Inline files, prototypes and
/// shapes by formula (Box, Extrusion) are skipped with a warning. `path` gives the folder and is named in messages.
/// Throws `Error` naming file and fault.
mesh::PolygonSoup read_x3d(const std::vector<char>& bytes, const std::filesystem::path& path);

/// The same from the tree of a file's elements.
mesh::PolygonSoup read_x3d_tree(const pugi::xml_document& document, const std::filesystem::path& path);

}  // namespace tuft::io
