#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/message.h"

/// \file
/// Lossless compression of number arrays for the table `arrays`. Inside `io` only. Any thread.
namespace tuft::io {

/// Layout of an array.
struct Packing {
    std::size_t element = 4;  ///< bytes per number: 1, 4 or 8
    std::size_t lag = 1;      ///< numbers are predicted by the one `lag` positions before (3 for xyz)
    int level = 3;            ///< of zstd
};

/// Compresses the differences of the bit patterns: bytes of equal significance side by side, then zstd.
std::vector<char> pack(const void* data, std::size_t count, const Packing& packing);

/// Returns the number of bytes that the blob's header announces; 0 where it announces none.
std::size_t packed_bytes(const void* blob, std::size_t blob_size);

/// Throws `Error` naming `what` when the blob's header does not announce `bytes` bytes.
void check_packed(const void* blob, std::size_t blob_size, std::size_t bytes, const Message& what);

/// Decompresses a blob of `pack` into `out`, [count]. Throws `Error` naming `what` when the blob is damaged or does not
/// hold `count` numbers. Never writes beyond `out`.
void unpack(const void* blob, std::size_t blob_size, void* out, std::size_t count, const Packing& packing,
            const Message& what);

}  // namespace tuft::io
