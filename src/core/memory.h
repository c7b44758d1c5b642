#pragma once

#include <cstddef>

/// What the process holds of the machine's memory.
namespace tuft {

/// Hands back to the system what the heap holds and nobody uses: after the charts of a million triangles 100 to 250 MB.
void release_free_memory();

/// From now on a heap with more than so many free bytes at its end gives them back as soon as they are free, as do blocks
/// of four times the size, but for glibc's own habit of keeping up to 64 MiB for each thread. What is taken anew the system
/// clears anew: little where large blocks are rare.
void keep_free_memory_below(std::size_t bytes);

}  // namespace tuft
