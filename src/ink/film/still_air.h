#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ink/film/film_list.h"

/// \file
/// What still air takes up from wet places. Internal to the wet film (film.h).
namespace tuft::ink::wet {

/// Wet places of a surface, each over some millimetres.
struct VapourPatches {
    std::vector<float> x, y, z;                 ///< [n] metres, middles
    std::vector<float> nx, ny, nz;              ///< [n] unit normals
    std::vector<float> xx, yy, zz, xy, yz, zx;  ///< [n] m², means of (x − middle) (y − middle) and so on
    std::vector<float> radius;                  ///< [n] metres: alone, it gives off as much as a disc of this radius

    std::size_t size() const { return x.size(); }
};

/// Returns F [n], metres, ≥ 0: where air is saturated over the patches, each gives off D (c_s − c_∞) F to still air,
/// whose vapour spreads by diffusion, ∇² c = 0, and not through dry surface. Solves Σ K F = 1 with
///
///     K_ij = G e^(−G₀ / (δ G)),  G = ((2 π r)⁴ + (16 R_i R_j)²)^(−¼) (1 − q ln(1 + 1/q)),  G₀ = 1 / 2 π,
///     q = r⃗ · (n_i − n_j) / (2 r), within 0 and 1
///
/// where r⃗ = x_i − x_j and δ is the thickness of the still air, metres. A disc alone has F = 4 R; the first factor of G
/// is that over a plane, with it as the mean over near patches, the second Neumann's function of a ball, on which
/// vapour has more room. K_ii is that of R_i alone, G = 1 / 4 R, and no less than δ / A (1 − 2 δ / π R) of an even
/// layer that gives off over δ: of places wider than δ, F is their area over δ within 40 %. By conjugate gradients.
/// Cost: about 20 n² products. The same bits on every machine.
std::vector<float> still_air_fluxes(const VapourPatches& patches, float thickness);

/// Finds how fast texels dry in still air [HuLarson2002]: a spot of radius R gives off 4 R D (c_s − c_∞), so that by
/// area it dries as 1 / R, and what is wet near by slows it down.
///
/// The result is a factor of the rates of `FilmDrying`, smooth over some millimetres; the rates say how what a place
/// gives off is shared among its texels. Wet texels that lie within a cube of 1.5 mm or more in space and face the same
/// way are a patch. Its radius follows from the energy of a charge that lies evenly on them, found by blocks of 4 × 4
/// texels: drops side by side in a cube give off more than one of their area, a line more than a disc.
///
/// Factors hold for 4 s, or up to 64 s where all dries slowly (`slower`), and until a quarter more of the tiles are
/// wet: 0.7 µm dry meanwhile at most. `WetFilm` keeps them over calls of one stroke or wait. Cost of finding them:
/// about a third of a step of the film, and 1 ms at most for the patches. The same bits for any number of threads.
class StillAir {
  public:
    static constexpr std::size_t kMostPatches = 400;

    /// Drops what was found: a stroke or wait begins, whether anything is wet then or not.
    void forget();
    /// Begins a call of `WetFilm::advance` on a wet canvas.
    void start(const FilmParams& params, const atlas::TexelMap& map);
    /// Finds factors if those of before hold no more.
    void look(const TileList& tiles, std::span<const Sources> sources);
    /// Multiplies what dries in a step by what all texels have in common.
    void slow_down(Step& step) const;
    /// Time passes.
    void pass(double seconds) { known_for_ -= seconds, age_ += seconds; }
    /// Gives a slot that came to the list factors of the patches as they are. Other slots may be given theirs
    /// meanwhile.
    void complete(const atlas::TexelMap& map, std::uint32_t slot);
    /// Returns [256] factors of a slot, in `buffer` or not; null: 1.
    const float* of(std::uint32_t slot, Plane& buffer) const;
    /// Returns how many times as long a step may be as by the rates alone: 1, 2, 4, 8 or 16.
    double slower() const { return slower_; }

  private:
    enum class Kind : std::uint8_t { unknown, corners, plane };
    /// Of a slot: at its corner texels, from which the others' follow, or in its plane.
    struct Factors {
        std::array<float, 4> at{};
        Kind kind = Kind::unknown;
    };
    /// Where a tile lies.
    struct Place {
        std::array<Vec3f, 4> corners{};
        Vec3f middle{0};
        float radius = 0;     ///< about `middle`; < 0: no texel of a chart
        bool smooth = false;  ///< one cluster has all its texels, and it is small
    };
    /// Wet texels of a square of the tile, of one cluster.
    struct Block {
        Vec3f at{0}, normal{0};
        float area = 0, rate = 0;  ///< m², film · m²/s
    };
    struct Key {
        std::array<std::int32_t, 3> cube;
        std::uint8_t side;
        bool operator==(const Key&) const = default;
    };
    struct KeyHash {
        std::size_t operator()(const Key& k) const;
    };
    /// Blocks of a tile that lie in one cube.
    struct Piece {
        Key key{};
        double area = 0, rate = 0;
        Vec3 at{0}, normal{0};            ///< means
        std::array<double, 6> squares{};  ///< m², means of xx, yy, zz, xy, yz, zx from `at`
        double spread = 0;                ///< m²: that square whose mean square of distances it has
        double energy = 0;                ///< Σ area area' G
        std::uint32_t patch = 0;
    };
    struct Tile {
        std::vector<Block> blocks;  ///< empty: nothing is wet
        std::vector<Piece> pieces;
        std::array<double, 4> shares{};  ///< film · m²/s, of its rates by corner
        double given = 0;                ///< film · m²/s, by the factors
        float greatest = 0;              ///< factor
    };

    static Key key_of(const Block& block, float cube);
    static void cut(Tile& tile, float cube);
    const Place& place_of(const atlas::TexelMap& map, std::uint32_t slot);
    void find_rates(const TileList& tiles, std::span<const Sources> sources, const Active& tile, Plane& rates) const;
    void look_at(const TileList& tiles, std::span<const Sources> sources, std::size_t index);
    bool gather(float cube);
    static void push_spread(VapourPatches& p, std::span<Piece* const> pieces, const Vec3& at, double area);
    void set_factors(const atlas::TexelMap& map, std::uint32_t slot, Tile* tile);
    void fill_plane(const atlas::TexelMap& map, std::uint32_t slot, Tile* tile);
    void find(const TileList& tiles, std::span<const Sources> sources);

    FilmParams params_;
    bool used_ = false, found_ = false;
    double known_for_ = 0, age_ = 0, slower_ = 1;  ///< s for which the factors hold, since they were found
    std::size_t n_wet_ = 0;                        ///< tiles, when they were found
    double factor_ = 1;                            ///< that all have in common, so that their sum is right
    float cube_ = 0;                               ///< metres, of the patches
    int side_ = 4;                                 ///< texels, of blocks
    VapourPatches patches_;
    std::vector<float> rates_, fluxes_;           ///< of the patches, film · m²/s
    std::vector<Tile> tiles_;                     ///< of the list
    std::vector<Piece*> pieces_;                  ///< theirs, by patch
    std::vector<Factors> factors_;                ///< [n_slots]
    std::vector<std::unique_ptr<Place>> places_;  ///< [n_slots] null: not looked up yet
    std::vector<std::unique_ptr<Plane>> planes_;  ///< [n_slots] rates, then factors; null: never needed
};

}  // namespace tuft::ink::wet
