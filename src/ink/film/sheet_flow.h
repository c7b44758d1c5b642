#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ink/film/film_list.h"

/// \file
/// Sheets of liquid that run down a steep surface. Internal to the wet film (film.h).
namespace tuft::ink::wet {

/// Where liquid goes from the texels of a tile, and how easily.
struct Downhill {
    struct Edge {
        std::uint32_t slot = kNone;
        std::uint8_t texel = 0;
        float conductance = 0;  ///< width of the stream · sin α, metres: k w³ times that flows
    };
    std::array<float, kTexels> elevation{};        ///< metres, against gravity
    std::array<float, kTexels> steepness{};        ///< sin α; 0: nothing runs from here
    std::array<Vec2f, kTexels> across{}, along{};  ///< directions across and along the stream, texels per metre
    std::array<float, kTexels> roughness{};        ///< of what a contact line bears, over the mean
    std::array<std::uint16_t, kTexels + 1> start{};
    std::vector<Edge> edges;  ///< by texel
};

/// Moves films as sheets [Huppert1982]:
///
///     ∂w/∂t = −∇·(k w³ sin α e),   k = ρ g / (3 η),   e: downhill
///
/// so that the front of an amount A per metre of width is at (9 A² ρ g sin α t / (4 η))^⅓ below its top once that has
/// thinned. Implicit and upwind: texels are gone through from the highest to the lowest, each with what came from those
/// above; w + m k dt w³ = what is there has one root. Positive for any step; amounts go from texel to texel whole.
/// Inside charts a texel's stream goes to the two of its eight neighbours between which its direction lies, beside
/// seams through the cells' faces and links. It takes pigments as w over max(T, grip).
///
/// Contact lines. A column of liquid, which is all that comes down to a texel of a front, per width of its stream, is
/// held as a whole while its weight is below what the line bears [Furmidge1962],
///
///     ρ g ∫ w sin α ds < σ (cos θ_r − cos θ_a),
///
/// `FilmWeight::hysteresis` times the tension, the roughness of the place, and 1 + 5 mm over the width: the sides of a
/// narrow tongue hold it too. m is 0 for columns that hold and 1 for those that run. Liquid enters dry texels only from
/// more than w_c + pin.
///
/// At the edge of the model columns hold. Where the steepness is below 0.1 liquid stays, and takes up what comes.
class SheetFlow {
  public:
    /// Must be called before the first `run` and whenever parameters may have changed. `again`: this call follows the
    /// one before.
    void start(const FilmParams& params, const TileList& tiles, bool again);
    /// Gives its memory back, some 40 KiB a tile.
    void release();
    /// Advances the sheets by `seconds`. Where none ran the last time, they are looked for every 0.25 s. Returns the
    /// written slots, ascending.
    std::vector<std::uint32_t> run(Canvas& canvas, TileList& tiles, double seconds, const WetFilm::BeforeFn& before);
    /// Whether some ran in the last `run`.
    bool run_on() const { return ran_ && params_.weight.hysteresis > 0 && glm::length(params_.weight.down) > 0; }
    /// Whether some went further than a texel in the last `run`.
    bool fast() const { return fast_; }
    /// Whether a sheet ran there in the last `run`: no bead comes off it.
    bool runs_at(std::uint32_t slot, int texel) const;

  private:
    /// A texel of the tiles in work; `id`: place of the tile in `slots_` · 256 + texel.
    struct Node {
        std::uint32_t id = 0;
        std::uint32_t first = 0, last = 0;     ///< of `edges_`
        float area = 0;                        ///< m²
        float steepness = 0, conductance = 0;  ///< Σ over edges
        float entry = 0;                       ///< film units from which liquid enters dry texels
        float line = 0;                        ///< N/m that its contact line bears
    };
    struct Edge {
        std::uint32_t to = 0;  ///< id
        float conductance = 0;
        bool level = false;   ///< nothing runs from there
        double per_area = 0;  ///< 1 / m² of the texel there
    };

    FilmParams params_;
    std::vector<std::unique_ptr<Downhill>> downhill_;  ///< [n_slots]
    std::vector<std::uint8_t> near_seam_;              ///< [n_slots · 256] 1: flow is that of faces and links
    std::vector<std::uint32_t> slots_;                 ///< of the tiles in work, ascending
    std::vector<std::uint32_t> tile_of_;               ///< [n_slots] place in `slots_`
    std::vector<Node> nodes_;                          ///< from the highest to the lowest
    std::vector<Edge> edges_;
    std::vector<std::uint32_t> wet_;             ///< of `nodes_`, ascending: those with liquid that may run
    std::vector<double> w_, pores_, weight_on_;  ///< [id] film units, film units, N
    std::vector<std::array<double, 2>> inflow_;  ///< [id] scratch: Σ conductance, that times m of what lies above
    std::vector<double> mobile_;                 ///< [id] m
    std::vector<std::vector<double>> pigment_;   ///< [pigment][id] film units
    std::vector<std::uint8_t> runs_;             ///< [id] 1: in the last `run`
    std::vector<std::uint8_t> changed_;          ///< of `slots_`: 1 where liquid went
    std::vector<std::uint8_t> steep_;            ///< [n_slots] 0: not looked up, 1: level, 2: steep
    std::vector<std::uint8_t> marked_;           ///< [n_slots] scratch
    std::uint64_t faces_version_ = 0;
    double waited_ = 0;  ///< s since sheets were looked for
    bool ran_ = true, fast_ = false;

    /// Film units that stay: as thick as a bead's trail.
    double rest() const { return std::max(params_.ripples.held, params_.weight.trail); }
    const Downhill& downhill(TileList& tiles, std::uint32_t slot);
    void mark_seams(const TileList& tiles);
    bool choose_tiles(TileList& tiles, double seconds);
    void make_nodes(TileList& tiles);
    double edge_moves(const Edge& edge, double front) const;
    bool is_steep(TileList& tiles, std::uint32_t slot);
    /// k, 1 / s over film units² and metres: w² k sin α is the speed.
    double rate() const;
    void read_planes(const Canvas& canvas, int pigments);
    bool find_columns(const TileList& tiles);
    double front_moves(const TileList& tiles, const Node& n) const;
    double through_liquid(const TileList& tiles, const atlas::TexelPlace& from, const Vec2& direction,
                          double most) const;
    double width(const TileList& tiles, const Node& n) const;
    void drag();
    void sweep(double rate, int pigments);
    std::vector<std::uint32_t> store(Canvas& canvas, int pigments, const WetFilm::BeforeFn& before);
};

}  // namespace tuft::ink::wet
