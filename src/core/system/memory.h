#pragma once

#include <cstddef>

/// What the process holds of the machine's memory.
namespace tuft {

/// Hands back to the system what the heap holds and nobody uses: after the charts of a million triangles 100 to 250 MB.
void release_free_memory();

/// From now on heaps give back what lies free at their ends once it is more than this, and blocks of four times the
/// size go back as soon as they are free; glibc would keep up to 64 MiB for each thread. What is taken anew the system
/// clears anew, which costs little where large blocks are rare.
void keep_free_memory_below(std::size_t bytes);

}  // namespace tuft
