#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "ink/film/drips.h"
#include "ink/film/film_tile.h"

/// The tiles that a step of the wet film goes through; inside `ink` only.
namespace tuft::ink::wet {

/// Conductances over seams together, over the texel's area: as much as a step allows. Less, and texels that nearly lie
/// on each other lag behind at a front (of 300 random layouts of two charts 14 were more than 1 % of the peak off with
/// 5; now 5).
inline constexpr double kSeamPart = 7;

using PlanePtr = std::unique_ptr<Plane>;

/// A tile's planes as a step finds them; a line of memory and a bit, since neighbours ask too.
struct alignas(64) Sources {
    std::array<const Plane*, 2> liquid{};
    std::array<const Plane*, kMaxPigments> open{};
    const Plane* relief = nullptr;  ///< of what is dry, film units; null: plain
};

/// A tile over a seam from another one.
struct Beyond {
    std::uint32_t slot = kNone;
    std::uint32_t place = kNone;  ///< in the list
    bool linked = false;          ///< liquid goes there; else only slopes are taken from it
    std::uint16_t lines = 0;      ///< bits: rows of texels there that this tile looks at
};

/// A tile in the list of a step.
struct Active {
    std::uint32_t slot = kNone;
    std::array<std::uint32_t, 9> around{};  ///< places in the list, row by row, this one in the middle
    std::uint32_t absent = 0;               ///< bits: tiles around it that there are, but not in the list
    std::uint32_t pigments = 0;             ///< bits: those computed
    std::span<const Beyond> others;         ///< ascending slots
    std::span<const atlas::SeamLink> links;
    std::span<const std::uint16_t> link_others;  ///< of the links: places in `others`
    std::span<const float> link_areas;           ///< of the links: area over the mean that each may empty
    std::span<const atlas::SeamTap> taps;
    Outcome outcome;
    float stiffness = 0;
    const Geometry* geometry = nullptr;              ///< null: not looked up yet
    const Geometry::Diagonals* diagonals = nullptr;  ///< its own; to be asked for before it is there
    bool seam_wet = false;
    bool spreads = true;  ///< wet in other places than when `changed` looked
    bool idle = false;    ///< nothing wet in sight
    PlanePtr w, s;        ///< of the step's end, until they are in the canvas
    std::array<PlanePtr, kMaxPigments> p;
    std::unique_ptr<std::array<std::uint8_t, kTexels>> closing;  ///< where outcome.closing

    bool wet() const { return outcome.most_w + outcome.most_s > 0; }
};

struct TileList {
    const atlas::TexelMap& map;
    atlas::SeamLinks seams;                           ///< scaled: what goes over seams stays within what a step allows
    std::vector<std::unique_ptr<Geometry>> geometry;  ///< [n_slots] null: never wet
    /// [n_slots] of tiles beside seams: what flows among them may go in shorter steps. Null: not
    /// looked up yet.
    std::vector<std::unique_ptr<SplitGeometry>> split_geometry;
    std::vector<Active> list;  ///< ascending slots
    /// Places in the list as a step goes through them: strip by strip of the atlas, so that what a tile and the one
    /// below it read, and the planes that get free, are still in the second cache.
    std::vector<std::uint32_t> order;
    std::unique_ptr<std::atomic<std::uint32_t>[]> readers;  ///< of the list: tiles that still need this one's planes

    std::vector<std::uint32_t> n_readers;  ///< of the list: how many there are in a step

    TileList(const atlas::TexelMap& m, atlas::SeamLinks s);

    /// For surfaces that let liquid flow more easily here than there (`ease_of_flow`). Costs when it changes.
    void set_unevenness(double unevenness);
    /// The same for what is free of stencil edge.
    void set_free(WetFilm::FreeFn free);
    const BaseColour& ground() const { return ground_; }
    /// Whether a tile has texels at a seam, or blocks of 4 × 4 texels beside some of the next
    /// tile's.
    bool beside_seam(std::uint32_t slot) const { return beside_[slot]; }
    /// Makes `split_geometry` of a tile beside a seam.
    void split_faces(std::uint32_t slot);
    /// The list becomes the canvas' wet tiles and those round them.
    void begin(const Canvas& canvas);
    /// The list becomes the wet tiles and those that liquid may reach in the next step.
    void spread();
    /// Whether other tiles may be reached than when it was last asked: whether `spread` would
    /// change the list.
    bool changed();
    /// Appearance at slots that something else wrote to, and takes them into the list.
    void look_at(const Canvas& canvas, std::span<const std::uint32_t> slots);
    /// Where beads may start: of each cube of a grain's length the place that gives way first, the
    /// lowest first, so that it does not matter how the surface lies in the atlas.
    std::vector<Drips::Seed> seeds_of_beads(const Canvas& canvas, const FilmParams& params) const;

    /// Calls fn with every place in the list whose planes a tile reads, its own among them.
    template <class Fn>
    void each_read(std::size_t index, Fn&& fn) const {
        for (const std::uint32_t i : list[index].around)
            if (i != kNone) fn(i);
        for (const Beyond& other : list[index].others)
            if (other.place != kNone) fn(other.place);
    }

  private:
    std::vector<float> weights_;        ///< of the links as they came
    std::vector<atlas::SeamTap> taps_;  ///< as they came
    BaseColour ground_;
    std::vector<std::uint32_t> near_start_;  ///< [n_slots + 1]
    std::vector<Beyond> near_;               ///< over seams, by slot; places unknown
    std::vector<std::uint16_t> link_near_;   ///< of the links: which of the slot's `near_`
    std::vector<float> link_areas_;          ///< of the links
    std::vector<Beyond> others_;             ///< of the list
    std::vector<std::uint8_t> beside_;       ///< [n_slots]
    std::vector<std::uint8_t> wanted_;       ///< of the list: scratch
    std::vector<std::uint8_t> mark_;         ///< [n_slots] scratch
    std::vector<std::uint32_t> place_;       ///< [n_slots] scratch

    void find_near();
    void look_anew();
    void limit_links();
    void find_link_areas();
    void find_beside();
    void close_taps();
    std::span<const atlas::SeamLink> links_of(std::uint32_t slot) const;
    std::array<std::uint32_t, 9> around(std::uint32_t slot) const;
    void put_in_order();
};

}  // namespace tuft::ink::wet
