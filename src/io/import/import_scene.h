#pragma once

#include <array>
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

/// Faults of a file in our own words; all others are Assimp's.
inline constexpr const char *kTooManyVertices = "has too many vertices",
                            *kNoSuchVertex = "has a face with a vertex that is not there",
                            *kTooMuchMemory = "asks for more memory than a file of its size may";
inline constexpr std::array kImportFaults{kTooManyVertices, kNoSuchVertex, kTooMuchMemory};

/// Makes an importer, fresh, ready for the files of one format, "fbx" or "dae"; it may then read any number of them.
void prepare_importer(Assimp::Importer& importer, const char* format);

/// Returns the packed `FileScene` (file_scene.h) of a file's bytes. `importer` was prepared for `format`. No other file
/// is opened. `is_read` is called once Assimp is done. Throws `std::runtime_error` for what cannot be read, with
/// Assimp's words or one of `kImportFaults`, or `std::bad_alloc`. `importer` holds what was read until its next file or
/// end: much to give back, which a process that ends need not do.
std::vector<char> import_scene(Assimp::Importer& importer, const char* format, std::span<const char> bytes,
                               const std::function<void()>& is_read = nullptr);

}  // namespace tuft::io
