#pragma once

#include <filesystem>
#include <optional>
#include <vector>

/// \file
/// Compressed glTF: KHR_draco_mesh_compression and EXT_meshopt_compression [glTF2]. Called by
/// gltf_file.cpp only. Any thread.
namespace tuft::io {

/// Returns a GLB of the same document without these extensions, its buffers decoded and joined into one; nothing where
/// the file uses neither. Precondition: the container is sound and the nesting of its JSON bounded. Accessors of
/// Draco's primitives are new ones; all else keeps its index. Throws `Error` in one line for what is damaged. Sizes are
/// checked before memory is taken: a Draco mesh has at most 32 triangles for each of its bytes, a meshopt stream
/// decodes to at most 256 times its size. Draco streams other than of bitstream 2.2 without metadata, which the
/// extension asks for, are refused.
std::optional<std::vector<char>> decompress_gltf(const std::vector<char>& bytes, const std::filesystem::path& path);

}  // namespace tuft::io
