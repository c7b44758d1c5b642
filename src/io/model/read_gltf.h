#pragma once

#include <filesystem>
#include <vector>

#include "mesh/read/polygon_soup.h"

namespace tuft::io {

/// GLB or glTF from its bytes, as `read_model` says; `path` gives the folder of external
/// buffers and is used in messages.
mesh::PolygonSoup read_gltf(const std::vector<char>& bytes, const std::filesystem::path& path);

}  // namespace tuft::io
