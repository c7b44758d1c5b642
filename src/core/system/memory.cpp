#include "core/system/memory.h"

#include <malloc.h>

#include <algorithm>

namespace tuft {

void release_free_memory() {
#ifdef __GLIBC__
    ::malloc_trim(0);
#endif
}

void keep_free_memory_below(std::size_t bytes) {
#ifdef __GLIBC__
    constexpr std::size_t kMost = std::size_t{32} << 20;  // that glibc takes as a threshold
    ::mallopt(M_TRIM_THRESHOLD, static_cast<int>(std::min(bytes, kMost)));
    ::mallopt(M_MMAP_THRESHOLD, 4 << 20);
#else
    (void)bytes;
#endif
}

}  // namespace tuft
