#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "atlas/texel_map.h"
#include "ink/pigments.h"

/// Pigment amounts on the texels of an atlas.
namespace tuft::ink {

inline constexpr int kMaxPigments = 8;

/// Amounts of one pigment on one tile, film units, texel t = row * 16 + column.
struct alignas(64) Plane : std::array<float, atlas::kTileTexels> {};

/// What one tile held: for undo and for files. Planes follow each other in the order
/// of the set bits of `planes`.
struct TileSnapshot {
    std::uint32_t slot = 0;
    std::uint8_t planes = 0;     ///< bit p: pigment p has a plane here
    std::vector<float> amounts;  ///< [256 × number of set bits]

    bool operator==(const TileSnapshot&) const = default;
};

/// Sparse store: for each slot of an `atlas::TexelMap` up to eight planes, made when
/// first touched, so memory follows the painted area (1 KiB per tile and pigment).
/// Different slots may be read and written by different threads at once; adding
/// pigments, copying and the functions over all slots may not run beside them.
class Canvas {
  public:
    explicit Canvas(std::size_t n_slots = 0);
    Canvas(const Canvas& other);
    Canvas& operator=(const Canvas& other);
    Canvas(Canvas&&) noexcept;
    Canvas& operator=(Canvas&&) noexcept;
    ~Canvas();

    std::size_t n_slots() const { return slots_.size(); }

    /// Index of the pigment with this name; it is added when it is new (the first
    /// definition of a name stays). Throws `Error` for a ninth pigment.
    int add_pigment(const Pigment& pigment);
    const std::vector<Pigment>& pigments() const { return pigments_; }
    /// Gives plane `index` other optical properties: recolours without repainting.
    void set_pigment(int index, const Pigment& pigment);

    /// The plane, or nullptr where nothing was ever put.
    const Plane* plane(std::uint32_t slot, int pigment) const;
    /// The plane, made and zeroed when needed; the slot becomes dirty.
    Plane& touch(std::uint32_t slot, int pigment);
    /// Whether the slot has any plane.
    bool touched(std::uint32_t slot) const { return slots_[slot] != nullptr; }
    /// Slots with a plane, ascending.
    std::vector<std::uint32_t> touched_slots() const;

    /// Slots written since the last call, ascending; clears the list.
    std::vector<std::uint32_t> take_dirty();
    void mark_dirty(std::uint32_t slot) { dirty_[slot] = 1; }

    TileSnapshot snapshot(std::uint32_t slot) const;
    /// Puts a tile back as it was; the slot becomes dirty. Throws `Error` when the
    /// snapshot's size does not fit its planes, its slot or the pigments.
    void restore(const TileSnapshot& snapshot);
    /// Removes all ink; pigments stay.
    void clear();

    /// Bytes held by planes and slot tables.
    std::size_t memory_bytes() const;
    /// Hash of pigment names and all amounts. A plane of zeros counts like no plane.
    std::uint64_t hash() const;
    /// Same pigment names and same amounts to the bit, absent planes being zeros.
    bool same_contents(const Canvas& other) const;

    /// Σ amount · area of one pigment, film·m², in double, in slot order.
    double total(const atlas::TexelMap& map, int pigment) const;

  private:
    struct Tile {
        std::array<std::unique_ptr<Plane>, kMaxPigments> planes;
    };
    std::vector<Pigment> pigments_;
    std::vector<std::unique_ptr<Tile>> slots_;
    std::vector<std::uint8_t> dirty_;
    std::atomic<std::size_t> n_planes_{0}, n_tiles_{0};
};

}  // namespace tuft::ink
