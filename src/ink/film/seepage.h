#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ink/film/film_list.h"
#include "ink/film/film_worker.h"
#include "ink/film/tile_set.h"

/// \file
/// Flow of liquid through the pores. Internal to the wet film (film.h).
namespace tuft::ink::wet {

/// m: D ∝ S^m with saturation S. Of drops in paper the area grows as V^⅔ (σ t / η)^⅓ ([Gillespie1958], [Kissa1981]),
/// which is Barenblatt's solution for m = 2.
inline constexpr int kSaturationPower = 2;

/// A link over a seam between two tiles of the set, and what goes through it.
struct SeepLink {
    std::uint32_t other = kNone;  ///< place in the set
    std::uint8_t texel = 0, other_texel = 0;
    float weight = 0;
    float apart = 1;  ///< distance of the texels, in texels
    std::array<float, 2> through{};
    float smeared = 0;  ///< what goes both ways with its pigments: cells' middles are further apart than near texels
};

/// What goes through a tile's faces, film units · mean area: through the right sides and the upper sides of texels k,
/// and through the diagonals of their squares.
struct SeepFaces {
    Field x{}, y{}, diagonal{};
};

/// A tile in the set through whose pores liquid flows.
struct SeepTile {
    std::uint32_t place = kNone;            ///< in the list
    std::array<std::uint32_t, 9> around{};  ///< places in the set
    Field open{};                           ///< 1: of a tile in the set
    const float* start = nullptr;           ///< [256] film units before the step
    const float* film = nullptr;            ///< [256] the same on the surface
    std::array<Plane, 2> s{};               ///< after the last two stages
    std::array<Plane, 2> soaked{};          ///< the same, what came from the surface
    std::array<SeepFaces, 2> faces{};       ///< the same, from the start on
    Plane beyond{};                         ///< Σ over seams of what goes out
    Plane carried{};                        ///< fraction of a texel's pigments that one unit of what leaves it carries
    std::vector<SeepLink> links;
    bool fed = true;          ///< something is on the surface
    bool starts_dry = false;  ///< nothing is there before the step
    bool dry = false;         ///< nor came there up to now
    float least = 0;          ///< film units, after the last stage
};

/// Factors of one stage.
struct SeepStage {
    float flow = 0;       ///< times the difference of S³, film units, over one stage
    float soak = 0;       ///< fraction of what is on the surface that empty pores draw in in one stage
    float per_pores = 0;  ///< 1 / capacity
    float now = 0, before = 0;
    int from = 0;  ///< of the two results the one to start from; the other one is replaced
};

/// Computes one stage of a tile from `s`, its amounts with their border; `beyond` holds what links take away.
/// Sets `least`.
void seep_stage(SeepTile& tile, const Field& s, const Geometry& g, const SeepStage& stage);
/// Computes one stage of a link between texels with s0 and s1. Turned round, it has the same bits with another sign.
void seep_over_link(SeepLink& link, float s0, float s1, const SeepStage& stage);
/// Sets `carried` for the result `last`: at most what there is leaves a texel. `rate`: the fraction of the pigments
/// that one unit of liquid carries.
void limit_carried(SeepTile& tile, const Geometry& g, int last, const Plane& rate);
/// Sets dw and ds of `work` and what carries pigments to the result `last`; `carried` has its border.
void seepage_flow(Work& work, const SeepTile& tile, const Geometry& g, int last, const Field& carried);

/// Draws liquid from the surface into the pores of a set of tiles, and moves it through them: unsaturated Darcy flow
/// [Richards1931] with
///
///     ∂s/∂t = ∇·(D₀ S² ∇s) + a w (1 − S),   ∂w/∂t = −a w (1 − S),   S = s / pores,   D₀ = k / ξ²,
///
/// so that a front fed from full pores is at √(k t): Lucas and Washburn's law with k = r σ cos θ / (2 η). S² makes the
/// front sharp. The flux through a face is g D₀ pores (S₀³ − S₁³) / 3.
///
/// Explicit in stages, by a Runge–Kutta–Gegenbauer method of first order [OSullivan2019]: n stages are stable and
/// keep amounts within their bounds for steps (n² + 3 n) / 4 times as long as one stage. Stages are sums of what went
/// through faces and surface, so amounts are conserved to rounding. A step with a negative amount is halved.
///
/// Pigments go with the liquid that leaves a texel, at most all of them in one step. Pores retain from it the fraction
/// retention · c / (c + 0.1), c pigments over liquid (both film units): grains of thick ink catch each other between
/// fibres, those of thin ink go with its water. A model, without a measurement behind the 0.1.
///
/// Tiles that no liquid has reached are left out of a stage.
class Seepage {
  public:
    void start(const FilmParams& params) { params_ = params; }
    /// Gives its memory back, 20 KiB a tile.
    void release() { tiles_.release(); }
    /// Chooses the tiles with liquid and those around them. Whether there are any.
    bool find(const TileList& tiles, std::span<const Sources> sources);
    /// Returns the greatest step, seconds, that follows fronts which start from a film: 50 ms, or longer where none
    /// runs more than a texel in it.
    double fresh_step(const atlas::TexelMap& map) const;
    /// Finds what flows on those tiles in `dt` seconds or the first part of it. Returns the seconds.
    double solve(const TileList& tiles, std::span<const Sources> sources, double dt);
    /// Of a place in the list; null: nothing flows there.
    const SeepTile* tile(std::uint32_t place) const {
        const std::uint32_t i = tiles_.index(place);
        return i == kNone || tiles_[i].dry ? nullptr : &tiles_[i];
    }
    /// Sets the flow of a tile of the set in `work` and `crossing`, as `fluxes` and `wet::cross_seams` do.
    void flow(std::uint32_t place, const TileList& tiles, std::span<const Sources> sources, int pigments, Work& work,
              Crossing& crossing) const;

  private:
    TileSet<SeepTile> tiles_;
    std::vector<std::uint32_t> places_;  ///< chosen ones, ascending
    FilmParams params_;
    int last_ = 0;  ///< of the two results the one of the last stage

    void take_tiles(const TileList& tiles, std::span<const Sources> sources);
    void open_tile(SeepTile& tile, const Active& active) const;
    /// `flow`, `soak`: of the whole step. Whether all amounts are positive.
    bool run_stages(const TileList& tiles, double flow, double soak, int n_stages);
    void run_stage(const TileList& tiles, SeepTile& tile, int from, const SeepStage& stage) const;
    /// Whether liquid reaches a tile from those beside it or over seams; `s`: plane `from` with its border.
    bool reached(const SeepTile& tile, const Field& s, int from) const;
    void smear_links(SeepTile& tile) const;
    void find_carried(SeepTile& tile, const TileList& tiles, const Sources& from) const;
    static constexpr int kStart = 2, kCarried = 3;  // instead of 0 and 1, the last two stages
    static const float* plane_of(const SeepTile& tile, int plane);
    /// With a border from the tiles around; 0 where there are none.
    Field padded(const SeepTile& tile, int plane) const;
};

}  // namespace tuft::ink::wet
