#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Assimp and Open CASCADE in a process that goes on from input to input, for the targets `fbx`, `dae`, `stp` and
/// `igs`.
namespace tuft::fuzz {

/// Returns what `tuft-import` or `tuft-import-cad` hands over for an input: the packed scene; empty where the file is
/// refused, or where the library crashes, hangs or asks for too much, as its process may. A crash of what walks through
/// Assimp's scene is a broken promise.
std::vector<char> import_in_child(const char* format, std::span<const std::uint8_t> input);

}  // namespace tuft::fuzz
