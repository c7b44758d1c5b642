#include <sanitizer/asan_interface.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <new>

#include "promise.h"
#include "targets.h"

/// What the address sanitizer does beside its checks cost up to a third of the time (fbx, dae): it walks thirty frames
/// at each allocation and freeing, and holds 256 MB of freed memory back. `ASAN_OPTIONS` goes before.
extern "C" const char* __asan_default_options() {
    return "malloc_context_size=4:quarantine_size_mb=32:thread_local_quarantine_size_kb=256";
}

namespace {

/// Arrays of a megabyte and more are used again. OpenImageIO takes 16 MB to read any picture, however small. The
/// address sanitizer maps such an array anew each time and marks a byte for each eight, which costs ten times what
/// reading a small picture does. What is free is poisoned as before, until an array as large is taken.
class LargeArrays {
  public:
    void* take(std::size_t size) {
        const std::lock_guard lock(mutex_);
        for (Array& a : arrays_)
            if (!a.used && a.size == size) {
                a.used = true;
                __asan_unpoison_memory_region(a.memory, a.size);
                return a.memory;
            }
        void* memory = std::malloc(size);
        if (!memory) throw std::bad_alloc();
        const auto place = std::find_if(arrays_.begin(), arrays_.end(), [](const Array& a) { return !a.used; });
        if (place == arrays_.end()) return memory;  // freed for good
        if (place->memory) __asan_unpoison_memory_region(place->memory, place->size), std::free(place->memory);
        *place = {memory, size, true};
        any_ = true;
        return memory;
    }
    void give(void* memory) {
        if (any_ && memory) {
            const std::lock_guard lock(mutex_);
            for (Array& a : arrays_)
                if (a.used && a.memory == memory) {
                    a.used = false;
                    __asan_poison_memory_region(a.memory, a.size);
                    return;
                }
        }
        std::free(memory);
    }

  private:
    struct Array {
        void* memory = nullptr;
        std::size_t size = 0;
        bool used = false;
    };
    std::mutex mutex_;
    std::array<Array, 4> arrays_;
    std::atomic<bool> any_ = false;
};
LargeArrays large_arrays;

constexpr std::size_t kLarge = std::size_t{1} << 20;

}  // namespace

void* operator new[](std::size_t size) {
    if (size >= kLarge) return large_arrays.take(size);
    void* memory = std::malloc(std::max<std::size_t>(size, 1));
    if (!memory) throw std::bad_alloc();
    return memory;
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
    return std::malloc(std::max<std::size_t>(size, 1));
}
void operator delete[](void* memory) noexcept {
    large_arrays.give(memory);
}
void operator delete[](void* memory, const std::nothrow_t&) noexcept {
    large_arrays.give(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
    large_arrays.give(memory);
}

/// The entry of libFuzzer (LLVM, "libFuzzer: a library for coverage-guided fuzz testing"); one
/// program per target.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const tuft::fuzz::Target* const target = tuft::fuzz::find_target(TUFT_FUZZ_TARGET);
    tuft::fuzz::promise(target != nullptr, "the program is called after a target");
    target->run({data, size});
    return 0;
}
