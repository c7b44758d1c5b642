#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/types.h"
#include "core/system/parallel.h"

/// \file
/// Some tiles of a list, with what a part of the wet film computes on them. Internal to the wet film (film.h).
namespace tuft::ink::wet {

/// `Tile` has a `place`, its index in the list.
template <class Tile>
class TileSet {
  public:
    /// Makes it the tiles at `places` of a list of `n` tiles. Each has its place; what else it has is of an earlier
    /// use.
    void take(std::span<const std::uint32_t> places, std::size_t n) {
        for (auto& tile : tiles_) spare_.push_back(std::move(tile));
        tiles_.clear();
        index_of_.assign(n, kNone);
        for (const std::uint32_t place : places) {
            index_of_[place] = static_cast<std::uint32_t>(tiles_.size());
            if (spare_.empty()) spare_.push_back(std::make_unique<Tile>());
            tiles_.push_back(std::move(spare_.back()));
            spare_.pop_back();
            tiles_.back()->place = place;
        }
    }
    /// Gives the memory back.
    void release() { tiles_.clear(), spare_.clear(); }

    std::size_t size() const { return tiles_.size(); }
    Tile& operator[](std::size_t i) const { return *tiles_[i]; }
    auto begin() const { return tiles_.begin(); }
    auto end() const { return tiles_.end(); }
    /// Returns the index of the tile of a place; kNone where it has none, and for kNone.
    std::uint32_t index(std::uint32_t place) const { return place == kNone ? kNone : index_of_[place]; }
    /// Calls fn(tile) for each, on all threads.
    template <class Fn>
    void each(std::size_t grain, Fn&& fn) const {
        parallel_for(tiles_.size(), grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) fn(*tiles_[i]);
        });
    }

  private:
    std::vector<std::unique_ptr<Tile>> tiles_, spare_;
    std::vector<std::uint32_t> index_of_;  ///< [list]
};

}  // namespace tuft::ink::wet
