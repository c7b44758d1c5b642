#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/geometry/types.h"

namespace tuft {

/// Numbers 0, 1, 2, ... for some keys out of many, in the order in which they come. Memory goes
/// with the number of keys, not with their range; open addressing, at most half full.
class SparseNumbering {
  public:
    /// Forgets all keys, keeps the memory. Cost: none.
    void clear() {
        n_ = 0;
        if (++epoch_ == 0) {
            slots_.assign(slots_.size(), {});
            epoch_ = 1;
        }
    }

    /// The key's number, and whether it is new. The key may be any number.
    std::pair<std::uint32_t, bool> number(std::uint32_t key) {
        if (2 * (n_ + 1) > slots_.size()) grow();
        Slot& slot = slots_[place(key)];
        if (slot.epoch == epoch_) return {slot.number, false};
        slot = {epoch_, key, n_};
        return {n_++, true};
    }

    /// kNone: it has none.
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

    /// Where the key is, or an empty slot for it.
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
