#pragma once

#include <filesystem>
#include <vector>

#include "mesh/read/polygon_soup.h"

/// \file
/// Reader of GLB and glTF. Called by read_model.cpp only. Any thread.
namespace tuft::io {

/// Returns the triangles of the bytes of a GLB or glTF file, as `read_model` describes. `path` gives the folder of
/// external buffers and is named in messages. Throws `Error` naming file and fault.
mesh::PolygonSoup read_gltf(const std::vector<char>& bytes, const std::filesystem::path& path);

}  // namespace tuft::io
