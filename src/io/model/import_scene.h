#pragma once

#include <functional>
#include <span>
#include <vector>

/// \file
/// Reading of FBX and DAE by Assimp, which crashes, hangs and takes memory without end on damaged files. Called in
/// processes of their own only: by `tuft-import` (import_main.cpp), and by the fuzz targets.
namespace Assimp {
class Importer;
}

namespace tuft::io {

/// Returns the packed `FileScene` (file_scene.h) of a file's bytes. `format`: "fbx" or "dae". No other file is opened.
/// `is_read` is called once Assimp is done. Throws `std::runtime_error` for what cannot be read, or `std::bad_alloc`.
/// `importer`, fresh, holds what was read: much to give back, which a process that ends need not do.
std::vector<char> import_scene(Assimp::Importer& importer, const char* format, std::span<const char> bytes,
                               const std::function<void()>& is_read = nullptr);

}  // namespace tuft::io
