#pragma once

#include <cstddef>
#include <vector>

/// \file
/// Returning free heap memory to the system. `atlas`, `io` and `stroke` call it after work on a large mesh.
namespace tuft {

/// Returns unused heap memory to the system: 100 to 250 MB after the charts of a million triangles.
void release_free_memory();

/// Sets the free bytes at the end of a heap above which the heap shrinks. glibc would retain up to 64 MiB for each
/// thread. From this call on, blocks of 4 MiB and more return to the system as soon as they are freed: in a heap, small
/// blocks that outlive them would hold the gaps. The system clears memory that is allocated again, which costs 0.1 ms a
/// MiB.
void keep_free_memory_below(std::size_t bytes);

/// Asks the system for large pages (2 MiB on x86) under a block that nothing has been written to: fewer faults, and
/// fewer misses of the address cache where it is read out of order. Without effect where the system has none.
void prefer_large_pages(const void* block, std::size_t bytes);

/// Gives an empty vector n elements in such pages.
template <class T>
void resize_in_large_pages(std::vector<T>& v, std::size_t n) {
    v.reserve(n);
    prefer_large_pages(v.data(), n * sizeof(T));
    v.resize(n);
}

}  // namespace tuft
