#pragma once

#include <cstddef>
#include <new>
#include <vector>

/// \file
/// Vectors whose memory is used again: what a step of the solver makes and throws away costs no heap allocation once
/// it is warm. Each thread keeps the blocks that it freed, by size, and gives them out again.
namespace tuft {

/// A block of at least `bytes`, aligned for any scalar. Throws `std::bad_alloc`.
void* take_block(std::size_t bytes);
/// Takes back a block of `take_block`, which any thread may have called with the same `bytes`.
void return_block(void* block, std::size_t bytes) noexcept;

/// Puts `count` free blocks of each size up to `bytes` into the calling thread's store, so that its first steps do not
/// allocate.
void fill_block_store(std::size_t bytes, int count);

/// Allocator of `Recycled`.
template <class T>
struct Recycler {
    static_assert(alignof(T) <= alignof(std::max_align_t));
    using value_type = T;
    /// Of an element, which may be a pointer.
    static constexpr std::size_t kBytes = sizeof(T);  // NOLINT(bugprone-sizeof-expression): not of what it points to

    Recycler() = default;
    template <class U>
    Recycler(const Recycler<U>&) {}

    T* allocate(std::size_t n) {
        if (n > static_cast<std::size_t>(-1) / 2 / kBytes) throw std::bad_array_new_length();
        return static_cast<T*>(take_block(n * kBytes));
    }
    void deallocate(T* block, std::size_t n) noexcept { return_block(block, n * kBytes); }
    template <class U>
    bool operator==(const Recycler<U>&) const {
        return true;
    }
};

template <class T>
using Recycled = std::vector<T, Recycler<T>>;

}  // namespace tuft
