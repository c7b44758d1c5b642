#pragma once

#include <filesystem>
#include <vector>

#include "mesh/read/polygon_soup.h"

/// \file
/// Reader of 3MF. Called by read_model.cpp only. Any thread. Assimp 5.2 does not replace it: it ignores the unit, the
/// names, all materials but an object's first, and the UVs of a triangle.
namespace tuft::io {

/// Returns the triangles of a 3MF file (core specification 1.3). Of its extensions it reads what gives positions and
/// colours: components with their transforms, objects in other parts of the package (production), base materials,
/// colour groups and textures (materials). Points are in metres by the file's unit, z up. Each object and material is a
/// group. Throws `Error` naming file and fault.
mesh::PolygonSoup read_3mf(const std::vector<char>& bytes, const std::filesystem::path& path);

}  // namespace tuft::io
