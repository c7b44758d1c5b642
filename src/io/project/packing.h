#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// Arrays of numbers as small blobs, every bit kept; inside `io` only.
namespace tuft::io {

/// How the numbers of an array follow each other.
struct Packing {
    std::size_t element = 4;  ///< bytes per number: 1, 4 or 8
    std::size_t lag = 1;      ///< a number is like the one `lag` places before (3 for xyz)
    int level = 3;            ///< of zstd
};

/// Differences of the bit patterns, bytes of equal weight side by side, then zstd.
std::vector<char> pack(const void* data, std::size_t count, const Packing& packing);

/// Bytes that the blob unpacks to by its head; 0 where it does not say.
std::size_t packed_bytes(const void* blob, std::size_t blob_size);

/// Throws `Error` naming `what` when the blob does not unpack to `bytes` bytes by its head.
void check_packed(const void* blob, std::size_t blob_size, std::size_t bytes, const std::string& what);

/// Undoes `pack` into `out`, which has room for `count` numbers. Throws `Error` naming
/// `what` when the blob is damaged or holds another number of bytes; never writes past.
void unpack(const void* blob, std::size_t blob_size, void* out, std::size_t count, const Packing& packing,
            const std::string& what);

}  // namespace tuft::io
