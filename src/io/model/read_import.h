#pragma once

#include <filesystem>
#include <vector>

#include "mesh/read/polygon_soup.h"

/// \file
/// Readers of FBX (binary and text) and DAE (COLLADA), by Assimp. Called by read_model.cpp only. Any thread.
///
/// Assimp crashes on damaged files. It therefore runs in a process of its own, `tuft-import` (import_main.cpp). That
/// process opens no file and has limits of computing time and memory by the file's size. It costs 3 ms more than a
/// call.
namespace tuft::io {

/// Returns all polygons of all nodes with the nodes' transforms applied. Points are in metres, z up, by the file's unit
/// and axes. Each object and material is a group. UVs are those of the set that the base colour's picture uses. `path`
/// gives the folder of pictures and is named in messages. Throws `Error` in one line where the file is damaged, or
/// where the process crashes, hangs or exceeds a limit: of computing time, memory, output and waiting time, by the
/// size of the file.
mesh::PolygonSoup read_fbx(const std::vector<char>& bytes, const std::filesystem::path& path);
mesh::PolygonSoup read_dae(const std::vector<char>& bytes, const std::filesystem::path& path);

}  // namespace tuft::io
