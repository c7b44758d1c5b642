#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "ink/film/drips.h"
#include "ink/film/tile/film_tile.h"

/// \file
/// List of the tiles that a step of the wet film processes. Internal to the wet film (film.h).
namespace tuft::ink::wet {

/// Largest sum of the conductances over seams, over the texel's area, in one step. With a smaller limit, texels
/// that nearly coincide lag behind at a front (of 300 random layouts of two charts, 14 were off by more than 1 % of
/// the peak with 5; now 5).
inline constexpr double kSeamPart = 7;

using PlanePtr = std::unique_ptr<Plane>;

/// Planes of a tile at the start of a step, in about one cache line, since neighbours read it too.
struct alignas(64) Sources {
    std::array<const Plane*, 2> liquid{};
    std::array<const Plane*, kMaxPigments> open{};
    const Plane* relief = nullptr;  ///< of what is dry, film units; null: plain
};

/// How uneven a tile's liquid is.
struct Ripples {
    bool strong = false;  ///< so much that it levels beside contact lines too
    bool faint = false;   ///< so much that it levels away from them
    bool rims = false;    ///< some of its texels, or of those beside it, hold contact lines
};

/// A tile on the other side of a seam.
struct SeamNeighbour {
    std::uint32_t slot = kNone;
    std::uint32_t place = kNone;  ///< in the list
    bool linked = false;          ///< liquid flows there; otherwise only slopes are read
    std::uint16_t lines = 0;      ///< bits: rows of texels there that this tile looks at
};

/// Seams of a tile in the list.
struct ActiveSeams {
    std::span<const SeamNeighbour> others;  ///< ascending slots
    std::span<const atlas::SeamLink> links;
    std::span<const std::uint16_t> link_others;  ///< of the links: places in `others`
    std::span<const float> link_areas;           ///< of the links: area over the mean that each may empty
    std::span<const atlas::SeamTap> taps;
    bool wet = false;  ///< liquid stands at a link
};

/// Faces of a tile in the list.
struct ActiveFaces {
    float stiffness = 0;                             ///< the geometry's
    const Geometry* geometry = nullptr;              ///< null: not looked up yet
    const Geometry::Diagonals* diagonals = nullptr;  ///< the geometry's; for prefetching
};

/// A tile in the list of a step.
struct Active {
    std::uint32_t slot = kNone;
    std::array<std::uint32_t, 9> around{};  ///< places in the list, row by row, this one in the middle
    std::uint32_t absent = 0;               ///< bits: tiles around it that there are, but not in the list
    std::uint32_t pigments = 0;             ///< bits: those computed
    ActiveSeams seams;
    Outcome outcome;
    ActiveFaces faces;
    bool spreads = true;  ///< wet at other texels than at the last `changed`
    bool idle = false;    ///< no wet texel in this tile or its neighbours
    Ripples ripples;      ///< at the last step that searched for them
    PlanePtr w, s;        ///< end of the step, before they are swapped into the canvas
    std::array<PlanePtr, kMaxPigments> p;
    std::unique_ptr<std::array<std::uint8_t, kTexels>> closing;  ///< where outcome.closing

    bool wet() const { return outcome.most_w + outcome.most_s > 0; }
};

/// The tiles with wet ink, and what a step needs of each.
struct TileList {
    const atlas::TexelMap& map;
    atlas::SeamLinks seams;                           ///< scaled: what goes over seams stays within what a step allows
    std::vector<std::unique_ptr<Geometry>> geometry;  ///< [n_slots] null: never wet
    /// [n_slots] geometry of tiles beside seams, whose flow may use shorter steps. Null: not computed yet.
    std::vector<std::unique_ptr<SplitGeometry>> split_geometry;
    std::vector<Active> list;  ///< ascending slots
    /// Order in which a step visits the list: strip by strip of the atlas, so that the planes read by a tile and
    /// the one below it, and the freed planes, are still in the second-level cache.
    std::vector<std::uint32_t> order;
    std::unique_ptr<std::atomic<std::uint32_t>[]> readers;  ///< of the list: tiles that still need this one's planes

    std::vector<std::uint32_t> n_readers;  ///< of the list: how many there are in a step

    TileList(const atlas::TexelMap& m, atlas::SeamLinks s);

    /// Sets the unevenness of the surface, and how fibrous it is (`EaseOfFlow`). Costly when it changes.
    void set_unevenness(double unevenness, double fibrous);
    /// Sets the stencil. Costly when it changes.
    void set_free(WetFilm::FreeFn free);
    const FlowMedium& medium() const { return medium_; }
    /// Returns a number that is another one whenever the faces of tiles have changed.
    std::uint64_t faces_version() const { return faces_version_; }
    /// Whether a tile has texels at a seam, or blocks of 4 × 4 texels beside some of the next
    /// tile's.
    bool beside_seam(std::uint32_t slot) const { return beside_[slot]; }
    /// Makes `split_geometry` of a tile beside a seam.
    void split_faces(std::uint32_t slot);
    /// Returns a tile's faces in a part of a step.
    const Geometry& faces_of(std::uint32_t slot, Part part) const {
        const SplitGeometry* split = split_geometry[slot].get();
        return part == Part::whole || !split ? *geometry[slot] : part == Part::inside ? split->inside : split->outside;
    }
    /// Sets the list to the canvas' wet tiles and their neighbours.
    void begin(const Canvas& canvas);
    /// Sets the list to the wet tiles and those that liquid may reach in the next step.
    void spread();
    /// Returns true when `spread` would change the list since the last call.
    bool changed();
    /// Updates slots that were written from outside, and adds them to the list.
    void search_tile(const Canvas& canvas, std::span<const std::uint32_t> slots);
    /// Returns the possible starts of beads: in each cube of a grain's length the weakest place, the lowest first,
    /// so that the layout of the atlas does not matter. None where `in_sheet`.
    std::vector<Drips::Seed> seeds_of_beads(const Canvas& canvas, const FilmParams& params,
                                            const std::function<bool(std::uint32_t slot, int texel)>& in_sheet) const;

    /// Calls fn with every place in the list whose planes a tile reads, its own among them.
    template <class Fn>
    void for_each_read_tile(std::size_t index, Fn&& fn) const {
        for (const std::uint32_t i : list[index].around)
            if (i != kNone) fn(i);
        for (const SeamNeighbour& other : list[index].seams.others)
            if (other.place != kNone) fn(other.place);
    }

  private:
    /// Links and taps as they came, before what goes over seams was limited.
    struct Unlimited {
        std::vector<float> weights;  ///< of the links
        std::vector<atlas::SeamTap> taps;
    };
    /// Tiles over seams.
    struct OverSeams {
        std::vector<std::uint32_t> start;    ///< [n_slots + 1]
        std::vector<SeamNeighbour> tiles;    ///< by slot; places unknown
        std::vector<std::uint16_t> of_link;  ///< of the links: which of the slot's `tiles`
    };
    struct Scratch {
        std::vector<std::uint8_t> wanted;  ///< of the list
        std::vector<std::uint8_t> mark;    ///< [n_slots]
        std::vector<std::uint32_t> place;  ///< [n_slots]
    };

    Unlimited unlimited_;
    FlowMedium medium_;
    OverSeams over_seams_;
    std::vector<float> link_areas_;      ///< of the links
    std::vector<SeamNeighbour> others_;  ///< of the list
    std::vector<std::uint8_t> beside_;   ///< [n_slots]
    Scratch scratch_;
    std::uint64_t faces_version_ = 0;

    void find_near();
    void use_seams(Active& tile) const;
    void find_neighbours();
    void search_again();
    void limit_links();
    void find_link_areas();
    void find_beside();
    void close_taps();
    std::span<const atlas::SeamLink> links_of(std::uint32_t slot) const;
    std::array<std::uint32_t, 9> around(std::uint32_t slot) const;
    void put_in_order();
};

}  // namespace tuft::ink::wet
