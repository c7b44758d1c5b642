#pragma once

#include <filesystem>
#include <vector>

#include "mesh/read/polygon_soup.h"

/// \file
/// Model formats that Assimp reads: FBX (binary and text) and DAE (COLLADA). Inside `io` only.
namespace tuft::io {

/// In metres, z up, by the file's unit and axes; every polygon of every node with its transforms, a group for each
/// object and material, UVs of the set by which the base picture lies. Assimp works in a process of its own
/// (import_main.cpp) that opens no file. Its computing time, its memory and what it hands over are limited by the
/// file's size, and how long it is waited for: a file that makes it crash, hang or grow is an `Error` in one line. 3 ms
/// more than in this process.
mesh::PolygonSoup read_fbx(const std::vector<char>& bytes, const std::filesystem::path& path);
mesh::PolygonSoup read_dae(const std::vector<char>& bytes, const std::filesystem::path& path);

}  // namespace tuft::io
