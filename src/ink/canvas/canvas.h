#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "atlas/texels/texel_map.h"
#include "ink/colour/pigments.h"

/// \file
/// Pigment and liquid on the texels of an atlas: the sparse store that strokes paint into. `stroke` owns it; all of
/// `ink` reads and writes it.
namespace tuft::ink {

inline constexpr int kMaxPigments = 8;

/// The films of a texel from the substrate upwards: pigment soaked into the substrate, dry films, and the open film
/// on top, which strokes paint into. An open film flows while it is wet. When its water is gone it is closed: it
/// becomes the texel's next dry film (drying.h).
inline constexpr int kDryFilms = 8;
inline constexpr int kFilms = kDryFilms + 2;
inline constexpr int kSoakedFilm = 0, kFirstDryFilm = 1, kOpenFilm = kFilms - 1;

/// Location of liquid: in the open film, or in the pores of the substrate.
enum class Liquid : std::uint8_t { film, pores };

/// Amounts of one pigment (or of liquid) on one tile, film units, texel t = row * 16 + column.
struct alignas(64) Plane : std::array<float, atlas::kTileTexels> {
    /// Allocates from a pool of large pages (plane_pool.cpp); safe in any thread.
    static void* operator new(std::size_t bytes);
    static void operator delete(void* plane, std::size_t bytes);
};

/// Planes of a film below the open one in a snapshot, or of the liquid (`film` = kFilms,
/// bit 0 the open film's, bit 1 the pores').
struct FilmPlanes {
    std::uint8_t film = 0;
    std::uint8_t planes = 0;  ///< bit p: pigment p has a plane here

    bool operator==(const FilmPlanes&) const = default;
};

/// Contents of one tile, for undo and for files. Planes are stored in the order of the set bits of `planes`, then
/// of those of `under`, film by film.
struct TileSnapshot {
    std::uint32_t slot = 0;
    std::uint8_t planes = 0;             ///< of the open film; bit p: pigment p has a plane here
    std::vector<float> amounts;          ///< [256 × number of set bits]
    std::vector<FilmPlanes> under = {};  ///< ascending, no empty ones

    bool operator==(const TileSnapshot&) const = default;
};

/// Sparse store of films. Each slot of an `atlas::TexelMap` has films of up to eight pigment planes and up to two
/// planes of liquid. Planes are allocated on first use, so memory is proportional to the painted area (1 KiB per
/// tile, film and pigment). Different threads may read and write different slots. Adding pigments, copying, and
/// functions over all slots must not run concurrently with them.
class Canvas {
  public:
    explicit Canvas(std::size_t n_slots = 0);
    Canvas(const Canvas& other);
    Canvas& operator=(const Canvas& other);
    Canvas(Canvas&&) noexcept;
    Canvas& operator=(Canvas&&) noexcept;
    ~Canvas();

    std::size_t n_slots() const { return slots_.size(); }

    /// Returns the index of the pigment with this name, and adds the pigment when it is new (the first definition
    /// of a name is retained). Throws `Error` for a ninth pigment.
    int add_pigment(const Pigment& pigment);
    const std::vector<Pigment>& pigments() const { return pigments_; }
    /// Removes pigments from the last one until `n` are left, as far as they have no amounts. An undone or
    /// cancelled stroke so does not change the order of later pigments.
    void forget_pigments(std::size_t n);
    /// Replaces the optical properties of plane `index`: recolours without repainting.
    void set_pigment(int index, const Pigment& pigment);

    /// Returns the plane of the open film, or nullptr where it was never written.
    const Plane* plane(std::uint32_t slot, int pigment) const { return film_plane(slot, kOpenFilm, pigment); }
    /// Returns all planes of the open film. A caller that changes them marks the slot dirty.
    std::array<Plane*, kMaxPigments> open_planes(std::uint32_t slot);
    /// Returns the plane of the open film, allocated and zeroed when needed. The slot becomes dirty.
    Plane& touch(std::uint32_t slot, int pigment) { return touch_film(slot, kOpenFilm, pigment); }

    /// The same for any film.
    const Plane* film_plane(std::uint32_t slot, int film, int pigment) const;
    Plane& touch_film(std::uint32_t slot, int film, int pigment);
    /// Whether the film has any plane.
    bool has_film(std::uint32_t slot, int film) const;

    /// The plane of liquid, film units, or nullptr where it is dry.
    const Plane* liquid(std::uint32_t slot, Liquid where) const;
    Plane& touch_liquid(std::uint32_t slot, Liquid where);
    /// Swaps `plane` with a plane of liquid or of the open film; either may be null.
    void swap_liquid(std::uint32_t slot, Liquid where, std::unique_ptr<Plane>& plane);
    void swap_open(std::uint32_t slot, int pigment, std::unique_ptr<Plane>& plane);
    /// Prefetches the table of a slot whose planes are swapped next.
    void expect(std::uint32_t slot) const {
        if (const char* tile = reinterpret_cast<const char*>(slots_[slot].get()))
            __builtin_prefetch(tile, 1), __builtin_prefetch(tile + 64, 1);
    }
    /// Whether any slot has a plane of liquid.
    bool wet() const { return n_liquid_ > 0; }
    /// Slots with a plane of liquid, ascending.
    std::vector<std::uint32_t> wet_slots() const;

    /// Whether the slot has any plane.
    bool touched(std::uint32_t slot) const { return slots_[slot] != nullptr; }
    /// Slots with a plane, ascending.
    std::vector<std::uint32_t> touched_slots() const;

    /// Slots written since the last call, ascending; clears the list.
    std::vector<std::uint32_t> take_dirty();
    void mark_dirty(std::uint32_t slot) { dirty_[slot] = 1; }

    /// Returns a copy of all that a tile holds.
    TileSnapshot snapshot(std::uint32_t slot) const;
    /// Restores a tile; the slot becomes dirty. Throws `Error` when the snapshot's size does not match its planes,
    /// its slot or the pigments.
    void restore(const TileSnapshot& snapshot);
    /// Removes all ink and liquid; pigments stay.
    void clear();

    /// Bytes held by planes and slot tables.
    std::size_t memory_bytes() const;
    /// Returns a hash of pigment names and all amounts. A plane of zeros counts as no plane. Pigments after the
    /// last one with amounts do not count.
    std::uint64_t hash() const;
    /// Returns true for the same pigment names and bit-equal amounts; absent planes are zeros.
    bool same_contents(const Canvas& other) const;

    /// Σ amount · area of one pigment in all films, film·m², in double, in slot order.
    double total(const atlas::TexelMap& map, int pigment) const;
    /// The same of the liquid, in film and pores.
    double total_liquid(const atlas::TexelMap& map) const;

  private:
    using PlanePtr = std::unique_ptr<Plane>;
    using Film = std::array<PlanePtr, kMaxPigments>;
    struct Tile {
        Film open;
        std::array<PlanePtr, 2> liquid;
        std::vector<std::unique_ptr<Film>> under;  ///< [film] soaked and dry ones, as many as needed
    };
    Tile& tile(std::uint32_t slot);
    Plane& make(PlanePtr& plane);
    /// Calls fn(film, index, plane) for the planes there are; film kFilms: liquid.
    /// Pigments up to the last one of which something lies anywhere.
    std::size_t used_pigments() const;
    template <class Fn>
    void each_plane(std::uint32_t slot, Fn&& fn) const;

    std::vector<Pigment> pigments_;
    std::vector<std::unique_ptr<Tile>> slots_;
    std::vector<std::uint8_t> dirty_;
    std::atomic<std::size_t> n_planes_{0}, n_films_{0}, n_tiles_{0}, n_liquid_{0};
};

}  // namespace tuft::ink
