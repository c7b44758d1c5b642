#pragma once

#include <filesystem>
#include <vector>

#include "mesh/read/polygon_soup.h"

/// \file
/// Reader of VRML 2.0 (VRML97, ISO/IEC 14772-1) and of X3D in the classic VRML encoding (ISO/IEC 19776-2). Called by
/// read_model.cpp only. Any thread.
namespace tuft::io {

/// Returns all faces of a file: its nodes become a tree of X3D, which is read as read_x3d.h says. Prototypes, routes
/// and scripts are left out, the first with a warning. Throws `Error` naming file, line and fault; for VRML 1.0, nodes
/// more than 256 deep, more than four million nodes and more than sixteen million fields, too. VRML 2.0 stores no unit
/// (the standard says metres, but CAD writes millimetres): points are in the unit of the file, or in metres by a UNIT
/// of X3D; z is up, turned from y.
mesh::PolygonSoup read_vrml(const std::vector<char>& bytes, const std::filesystem::path& path);

}  // namespace tuft::io
