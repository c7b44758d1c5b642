#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ink/film/film_list.h"
#include "ink/film/film_worker.h"
#include "ink/film/tile_set.h"

/// \file
/// Levelling of the wet film by surface tension. Internal to the wet film (film.h).
namespace tuft::ink::wet {

/// Of one tile on a grid of N × N cells of 16 / N texels a side, with a border of one cell from the tiles around.
///
///     v + ∇·(M ∇p) = f,   p = ∇·(C ∇v) + e      (both ∇· with the sign of outflow)
///
/// for the change v of thickness in the step, film units, and the pressure p, film units, since σ and the texel's area
/// A stand in the mobility M = σ dt w³ / (3 η A²), 1. C: conductance of faces, 1. e: p of the thickness w before the
/// step. f: 0 on the finest grid, on others what the finer one is missing, film units. ∇ by differences of cells.
///
/// Faces: right of columns −1 to N − 1, above rows −1 to N − 1; squares: above and right of both.
template <int N>
struct alignas(64) Grid {
    static constexpr int kCells = N, kRow = N + 2, kSquareRow = N + 1;
    static constexpr std::size_t kPadded = static_cast<std::size_t>(kRow * kRow + 15) / 16 * 16 + 32;
    static constexpr int at(int column, int row) { return (row + 1) * kRow + 1 + column; }

    alignas(64) std::array<float, kPadded> v{}, p{};
    alignas(64) std::array<float, N * N> f{}, e{};
    alignas(64) std::array<float, N * N> area{}, inverse{};             ///< over a texel's; 0: closed
    alignas(64) std::array<float, N*(N + 1)> cx{}, mx{}, cy{}, my{};    ///< conductance, that times mobility
    alignas(64) std::array<float, N * N> conductances{}, mobilities{};  ///< sums over a cell's faces over its area
    alignas(64) std::array<float, N * N> beyond_v{}, beyond_p{};        ///< Σ over seams, over the area
    struct Squares {
        std::array<float, (N + 1) * (N + 1)> c_up{}, m_up{}, c_down{}, m_down{};
    };
    std::unique_ptr<Squares> squares;  ///< null: no diagonals
};

/// A link over a seam through which liquid may flow.
struct TensionLink {
    std::uint32_t other = kNone;  ///< place in the set
    std::uint8_t texel = 0, other_texel = 0;
    float conductance = 0, mobility = 0;
    float area = 0;  ///< that it may empty, over a texel's
};

/// A tile in the set that is levelled.
struct TensionTile {
    std::uint32_t place = kNone;  ///< in the list
    float held = 0;
    std::array<std::uint32_t, 9> around{};                           ///< places in the set
    Field w{};                                                       ///< liquid on the surface
    alignas(64) std::array<float, Grid<kSide>::kPadded> mobility{};  ///< σ dt w³ / (3 η A²); 0: closed
    Grid<16> grid;
    Grid<8> grid2;
    Grid<4> grid4;
    Grid<2> grid8;
    Grid<1> grid16;
    std::vector<TensionLink> links;
    alignas(64) std::array<float, kTexels> inner;  ///< mobility of texels away from contact lines
    float missing = 0;                             ///< greatest of what the last cycle left of f
    float change = 0, share = 0;                   ///< greatest of v, and of v / w
    double bent = 0, bends = 0;                    ///< Σ area · curvature², before and after the step

    template <int N>
    Grid<N>& of() {
        if constexpr (N == 16)
            return grid;
        else if constexpr (N == 8)
            return grid2;
        else if constexpr (N == 4)
            return grid4;
        else if constexpr (N == 2)
            return grid8;
        else
            return grid16;
    }
};

/// Sets `mobility` of a tile's own texels, `factor` w³; 0 where liquid or that beside it is no thicker than `held`.
void open_texels(TensionTile& tile, const Geometry& g, float factor);
/// Sets `inner`, of `mobility` with its border: 0 also beside closed texels.
void hold_rims(TensionTile& tile, const Geometry& g);
/// Sets the finest grid's faces and curvature from `w` and `mobility` with their borders.
void set_faces(TensionTile& tile, const Geometry& g);
/// Sets the sums over faces and links. `scale`: of a link on this grid.
template <int N>
void sum_faces(Grid<N>& grid, std::span<const TensionLink> links, float scale);
/// Sets a grid's faces from the next finer one's.
template <int N>
void coarsen(const Grid<2 * N>& fine, Grid<N>& coarse);
/// Two half sweeps of Gauss and Seidel over v and p together, as on a draughtboard.
template <int N>
void relax(Grid<N>& grid);
/// Sets the coarser grid's right sides to what is missing, and its v and p to 0. Returns the greatest that is missing
/// of f.
template <int N>
float restrict_residual(const Grid<2 * N>& fine, Grid<N>& coarse);
/// Adds the coarser grid's v and p, linear between its cells.
template <int N>
void prolong(const Grid<N>& coarse, Grid<2 * N>& fine);

/// Sets dw of `work` and what carries pigments to the flow that p drives; no face passes more than an eighth of a
/// texel.
void tension_flow(Work& work, const Geometry& g, const Grid<16>& grid, float grip);

/// Flow from one end of a face to the other, film units · mean area, and what it carries of each end's pigments.
struct LinkFlow {
    float flow, a, b;
};
/// Over a link, from its texel to the other one: of both thickness, pressure, 1 / H.
LinkFlow flow_over_link(const TensionLink& link, const std::array<float, 2>& w, const std::array<float, 2>& p,
                        const std::array<float, 2>& rate);

/// Looks for places where liquid thicker than `held` is curved as ripples are.
Ripples find_ripples(const Field& w, const Geometry& g, float held);

/// Levels a set of tiles: thin-film theory for small slopes ([Reynolds1886]; ripples: [Orchard1962]),
///
///     ∂w/∂t = −∇·(w³ / (3 η) ∇(σ ∇² w)),
///
/// so that a ripple of wave number k decays at the rate σ w³ k⁴ / (3 η). Implicit in p with w³ of the start of the
/// step: stable for any step. Solved by multigrid over blocks of 2, 4, 8 and 16 texels; blocks only speed it up: what
/// flows is computed from p at texels' faces, seams' among them.
///
/// Texels within two of liquid no thicker than `held` are closed: contact lines hold, and a film that ends at them
/// keeps its edge.
class Tension {
  public:
    /// Sets what holds from now on.
    void start(const FilmParams& params, const atlas::TexelMap& map);
    /// Finds how steep a tile is. Different threads may look at different slots.
    void look_at(const atlas::TexelMap& map, std::uint32_t slot);
    /// Returns the film units that contact lines hold on a tile; where beads may run, their trails keep their profile.
    float held_on(std::uint32_t slot) const { return steep_[slot] == 1 ? held_on_steep_ : held_; }

    /// Chooses the tiles with ripples and, inside wide places, those around them; but for those on relief, where the
    /// liquid's own surface levels, and on steep places where it is so thick that beads may hang or run. Whether there
    /// are any.
    bool find(const TileList& tiles, std::span<const std::unique_ptr<Plane>> relief);

    struct TensionResult {
        double bends = 1;   ///< Σ curvature² after the step over that before it
        double change = 0;  ///< greatest, of the thickness there
    };
    /// Finds the pressures of a step of `dt` seconds on those tiles.
    TensionResult solve(const TileList& tiles, std::span<const Sources> sources, double dt);
    /// Of a place in the list; null: not among those tiles.
    const TensionTile* tile(std::uint32_t place) const {
        const std::uint32_t i = tiles_.index(place);
        return i == kNone ? nullptr : &tiles_[i];
    }
    /// As `wet::cross_seams`.
    void cross_seams(std::uint32_t place, std::span<const Sources> sources, int pigments, float grip, Work& work,
                     Crossing& crossing) const;

  private:
    TileSet<TensionTile> tiles_;
    std::vector<std::uint32_t> places_;  ///< chosen ones, ascending
    std::vector<std::int8_t> steep_;     ///< [n_slots] whether beads may run; −1: not looked up
    FilmParams params_;
    float held_ = 0, held_on_steep_ = 0;  ///< film units

    void begin(const TileList& tiles, std::span<const Sources> sources, float mobility);
    void take_tiles(const TileList& tiles);
    /// Sets liquid and mobility; a texel whose link leads to no liquid is closed.
    void open_tile(TensionTile& t, const Active& active, std::span<const Sources> sources, float mobility) const;
    void take_mobility(TensionTile& t) const;
    void close_rims(TensionTile& t, const Active& active) const;
    void link_over_seams(TensionTile& t, const Active& active) const;
    std::uint32_t in_set(std::uint32_t place) const { return tiles_.index(place); }

    template <int N>
    void cycle();
    template <int N>
    void relax_all();
    template <int N>
    void exchange(TensionTile& tile);
    template <class Fn>
    void each(Fn&& fn);
};

}  // namespace tuft::ink::wet
