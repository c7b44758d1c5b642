#include "core/system/memory.h"

#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>

namespace tuft {

void release_free_memory() {
#ifdef __GLIBC__
    ::malloc_trim(0);
#endif
}

void keep_free_memory_below(std::size_t bytes) {
#ifdef __GLIBC__
    constexpr std::size_t kMost = std::size_t{1} << 30;  // an int holds it
    constexpr int kLargeBlock = 4 << 20;
    ::mallopt(M_TRIM_THRESHOLD, static_cast<int>(std::min(bytes, kMost)));
    ::mallopt(M_MMAP_THRESHOLD, kLargeBlock);
#else
    (void)bytes;
#endif
}

void prefer_large_pages(const void* block, std::size_t bytes) {
#ifdef MADV_HUGEPAGE
    static const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
    const auto at = reinterpret_cast<std::uintptr_t>(block);
    const std::uintptr_t begin = (at + page - 1) / page * page, end = (at + bytes) / page * page;
    if (begin < end) ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
#else
    (void)block, (void)bytes;
#endif
}

}  // namespace tuft
