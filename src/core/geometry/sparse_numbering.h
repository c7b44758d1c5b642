#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// Consecutive numbers for a sparse set of 32-bit keys. Used by searches over a small part of a mesh
/// (`mesh/query/exact_geodesics.h`, `footprint/stamp`).
namespace tuft {

/// Maps keys to the numbers 0, 1, 2, ... in the order of their first use. Memory is proportional to the number of
/// keys, not to their range. The hash table uses open addressing and is at most half full.
class SparseNumbering {
  public:
    /// Removes all keys and retains the memory. Cost: O(1).
    void clear() {
        n_ = 0;
        if (++epoch_ == 0) {
            slots_.assign(slots_.size(), {});
            epoch_ = 1;
        }
    }

    /// Returns the number of `key`, and true when the key is new. Any 32-bit key is valid.
    std::pair<std::uint32_t, bool> number(std::uint32_t key) {
        if (2 * (n_ + 1) > slots_.size()) grow();
        Slot& slot = slots_[place(key)];
        if (slot.epoch == epoch_) return {slot.number, false};
        slot = {epoch_, key, n_};
        return {n_++, true};
    }

    /// Returns the number of `key`, or kNone when the key has none.
    std::uint32_t find(std::uint32_t key) const {
        if (n_ == 0) return kNone;
        const Slot& slot = slots_[place(key)];
        return slot.epoch == epoch_ ? slot.number : kNone;
    }

    std::uint32_t size() const { return n_; }

  private:
    struct Slot {
        std::uint32_t epoch = 0, key = 0, number = 0;
    };

    /// Returns the slot of `key`, or the empty slot where it would go.
    std::size_t place(std::uint32_t key) const {
        // Neighbours in a mesh have neighbouring numbers: Fibonacci hashing keeps them apart
        // (Knuth, The Art of Computer Programming 3, 6.4).
        const std::size_t mask = slots_.size() - 1;
        std::size_t at = (key * std::uint64_t{0x9E3779B97F4A7C15}) >> 32 & mask;
        while (slots_[at].epoch == epoch_ && slots_[at].key != key) at = (at + 1) & mask;
        return at;
    }

    void grow() {
        std::vector<Slot> before = std::move(slots_);
        slots_.assign(before.empty() ? 64 : 2 * before.size(), {});
        for (const Slot& slot : before)
            if (slot.epoch == epoch_) slots_[place(slot.key)] = slot;
    }

    std::vector<Slot> slots_;
    std::uint32_t epoch_ = 1, n_ = 0;
};

}  // namespace tuft
