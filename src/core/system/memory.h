#pragma once

#include <cstddef>

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

}  // namespace tuft
