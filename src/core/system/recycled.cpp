#include "core/system/recycled.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace tuft {
namespace {

constexpr std::size_t kSmallest = 64, kLargest = std::size_t{1} << 20;  // bytes
constexpr std::size_t kSizes = std::bit_width(kLargest / kSmallest);
constexpr std::size_t kKept = std::size_t{4} << 20;  // bytes of one size that a thread keeps at most

// Blocks that are used again hide errors from a sanitizer that looks for use after free.
#if defined(__SANITIZE_ADDRESS__)  // gcc
#define TUFT_ADDRESS_SANITIZER
#elif defined(__has_feature)  // clang
#if __has_feature(address_sanitizer)
#define TUFT_ADDRESS_SANITIZER
#endif
#endif
#if defined(TUFT_ADDRESS_SANITIZER)
constexpr bool kRecycles = false;
#else
constexpr bool kRecycles = true;
#endif

std::size_t index_of(std::size_t bytes) {
    return bytes <= kSmallest ? 0 : std::bit_width((bytes - 1) / kSmallest);
}

std::size_t size_of(std::size_t index) {
    return kSmallest << index;
}

/// A free block; it lies in the block itself.
struct Link {
    Link* next = nullptr;
};

/// Free blocks of one thread. It has no destructor, so that vectors which die after `StoreEnd` may still use it.
struct Store {
    std::array<Link*, kSizes> first{};
    std::array<std::size_t, kSizes> count{};
    bool closed = false;
};
thread_local constinit Store store;

/// Frees the blocks when the thread ends; what comes back later goes to the heap.
struct StoreEnd {
    ~StoreEnd() {
        store.closed = true;
        for (Link*& first : store.first)
            while (first) ::operator delete(std::exchange(first, first->next));
    }
};
thread_local StoreEnd store_end;

bool keep(void* block, std::size_t index) {
    if (!kRecycles || store.closed || (store.count[index] + 1) * size_of(index) > kKept) return false;
    static_cast<void>(&store_end);  // constructs it, so that it is destroyed
    store.first[index] = new (block) Link{store.first[index]};
    ++store.count[index];
    return true;
}

}  // namespace

void* take_block(std::size_t bytes) {
    const std::size_t index = index_of(bytes);
    if (index >= kSizes) return ::operator new(bytes);
    Link* const block = store.first[index];
    if (!block) return ::operator new(size_of(index));
    store.first[index] = block->next;
    --store.count[index];
    return block;
}

void return_block(void* block, std::size_t bytes) noexcept {
    const std::size_t index = index_of(bytes);
    if (index >= kSizes || !keep(block, index)) ::operator delete(block);
}

void fill_block_store(std::size_t bytes, int count) {
    for (std::size_t index = 0; index < kSizes && size_of(index) <= bytes; ++index)
        for (int k = 0; k < count; ++k) {
            void* const block = ::operator new(size_of(index));
            if (!keep(block, index)) ::operator delete(block);
        }
}

}  // namespace tuft
