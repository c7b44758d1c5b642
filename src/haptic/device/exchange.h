#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

/// \file
/// Data between two threads without a lock: the newest value, or a bounded queue. Each has one writer and one reader.
/// Neither waits nor allocates memory.
namespace tuft::haptic {

/// The newest value of a writer. A value is whole, and never older than one read before.
template <class T>
class TripleBuffer {
    static_assert(std::is_trivially_copyable_v<T>);

  public:
    /// Writer.
    void write(const T& value) {
        slots_[back_] = value;
        back_ = middle_.exchange(static_cast<std::uint8_t>(back_ | kFresh), std::memory_order_acq_rel) & kIndex;
    }
    /// Reader. Stores the newest value; returns false, and stores nothing, when none has come since the last call.
    bool read(T& value) {
        if (!(middle_.load(std::memory_order_acquire) & kFresh)) return false;
        front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
        value = slots_[front_];
        return true;
    }

  private:
    static constexpr std::uint8_t kFresh = 4, kIndex = 3;
    std::array<T, 3> slots_{};
    std::atomic<std::uint8_t> middle_{1};
    std::uint8_t back_ = 0, front_ = 2;
};

/// First in, first out; holds N at most, a power of two. What does not fit is counted.
template <class T, std::size_t N>
class BoundedQueue {
    static_assert(std::is_trivially_copyable_v<T> && (N & (N - 1)) == 0);

  public:
    /// Writer.
    bool push(const T& value) {
        const std::uint64_t end = end_.load(std::memory_order_relaxed);
        if (end - begin_.load(std::memory_order_acquire) == N) {
            overflow_.fetch_add(1, std::memory_order_relaxed);
            return false;
        }
        slots_[end % N] = value;
        end_.store(end + 1, std::memory_order_release);
        return true;
    }
    /// Reader.
    bool pop(T& value) {
        const std::uint64_t begin = begin_.load(std::memory_order_relaxed);
        if (begin == end_.load(std::memory_order_acquire)) return false;
        value = slots_[begin % N];
        begin_.store(begin + 1, std::memory_order_release);
        return true;
    }
    /// Any thread: values that did not fit.
    std::uint64_t overflow() const { return overflow_.load(std::memory_order_relaxed); }

  private:
    std::array<T, N> slots_{};
    alignas(64) std::atomic<std::uint64_t> begin_{0};
    alignas(64) std::atomic<std::uint64_t> end_{0};
    std::atomic<std::uint64_t> overflow_{0};
};

}  // namespace tuft::haptic
