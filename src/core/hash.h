#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

/// \file
/// Hashes of raw bytes: fingerprints of canvases, files and meshes, and keys of hash tables.
namespace tuft {

/// XXH3 64-bit hash of raw bytes; chain calls by passing the last result as seed.
std::uint64_t hash_bytes(const void* data, std::size_t size, std::uint64_t seed = 0);

/// Returns the hash of the bytes of `values`.
template <class T>
std::uint64_t hash_span(std::span<const T> values, std::uint64_t seed = 0) {
    static_assert(std::is_trivially_copyable_v<T>);
    return hash_bytes(values.data(), values.size_bytes(), seed);
}

}  // namespace tuft
