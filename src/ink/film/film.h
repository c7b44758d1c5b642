#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "atlas/texels/seam_links.h"
#include "core/system/progress.h"
#include "ink/canvas/canvas.h"

/// The wet film: water and pigment that flow on the surface, soak in and dry.
namespace tuft::ink {

/// How liquid behaves on a surface. Amounts of liquid in film units (10 µm).
struct FilmParams {
    double mobility = 1e-10;        ///< D, m²/s per film unit: thick liquid flows to thin
    double threshold = 0.1;         ///< w_c: liquid below it is held by the surface
    double pin = 1;                 ///< film units above w_c that it takes to wet dry surface
    double mixing = 1e-10;          ///< m²/s: pigments' own diffusion within the liquid
    double grip = 1;                ///< film units: in thinner liquid, grains lie on the surface and lag behind
    double absorbency = 0;          ///< 1/s: part of the liquid that empty pores draw in
    double pores = 0;               ///< liquid that the substrate can hold inside; 0: none
    double retention = 0;           ///< part of the pigments that stays behind when liquid seeps through pores
    double evaporation = 1.0 / 60;  ///< film units a second
    double rim_evaporation = 0;     ///< film units · m a second, more, per metre of rim
    double rim_depth = 1;           ///< film units: rims are where less than that stands
    double stain = 0;               ///< part of a drying film that stays in bare substrate
    double unevenness = 0;          ///< rms of ln of how easily liquid flows, from place to place; 0: even
    Vec3 down{0};                   ///< towards the ground, length 1; zero: no weight
    double hold = 2;                ///< film units that neither weight nor surface tension moves
    double levelling = 1e-8;        ///< L, m²/s per film unit above `hold`: puddles draw together
    double ridge = 0.4;             ///< film units that stay on the ridges of dry paint
    double bead_angle = 0.15;       ///< radians: contact angle of a bead that runs down
    double bead_speed = 8e-3;       ///< m/s of a bead of √2 times the radius at which it stops
    double drain = 2;               ///< 1/s: part of the liquid above `hold` near a bead that it draws in
    double trail = 0.9;             ///< film units that a bead leaves behind
    double shortest_step = 0.05;    ///< seconds; a fifth on relief, half under liquid. Where
                                    ///< stability asked for shorter steps, the fastest flows are
                                    ///< held back instead, or go between blocks of texels; beside
                                    ///< seams, where blocks end, such steps are divided
};

/// What a surface does by its substance (`Substrate`: diffusion, threshold, edge, absorbency,
/// pores, evaporation, relief) and the direction of weight.
FilmParams film_params(const Substrate& substrate, const Vec3& down = Vec3{0});

struct FilmReport {
    std::size_t steps = 0;
    std::size_t tile_steps = 0;  ///< tiles stepped, over all steps
    double evaporated = 0;       ///< liquid that went into the air, film·m²
};

/// Steps the wet film of a canvas. Finite volumes on the texels with the metric of the
/// surface: liquid w on the surface and s in the pores (w + s = T), pigments p of the open film:
///
///     ∂w/∂t = ∇·((D ⟨w − w_c⟩ + L ⟨w − hold⟩) ∇w) − soak − e
///     ∂s/∂t = ∇·(D s ∇s) + soak,                           soak = a w (1 − s / pores)
///     ∂p/∂t = ∇·((p/H)↑ j + D_p M ∇(p/H)),                 j: the flux of w and of s (1 −
///     retention)
///
/// M = w + s (1 − retention): fibres sieve grains out of what seeps between them, so that water
/// runs ahead of the ink and a line has a dark core. ↑: of the texel the liquid comes from. H =
/// max(T, grip): what liquid gets thin over stays there, so that a drop dries as it stood and does
/// not draw its pigments into its middle. On relief of dry paint and of paste (z, film units,
/// `dry_relief` and `paste_height` less kPlain) the liquid's own surface levels, at any slope:
/// there (D ⟨w − w_c⟩ + L ⟨w − ridge⟩) ∇(w + z), ⟨w − ridge⟩ of the higher texel and no more than
/// that, so that ink leaves the ridges and stands in the furrows. Paste that liquid comes to is
/// bedded (`bed_paste`): it stirs none of it. Liquid goes onto a dry texel only from one that has
/// more than w_c + pin (rims stay where they are; pin varies by ± 40 % with the place, over about a
/// millimetre, as surfaces are not clean). With a direction of weight contact lines keep mounds as
/// they are (L = 0), and what is more than they hold runs down in beads (drips.h), 256 at once at
/// most. The rim evaporates faster, by `rim_evaporation` |∇ min(T, rim_depth)| / rim_depth, as much
/// per metre of rim whatever the texels, so that liquid, and pigment with it, is drawn there: dark
/// edges. A texel with nothing wet any more is closed (drying.h).
///
/// Where fibres and pores lie in clouds (`unevenness`) D varies with the place over a millimetre or
/// so, and fronts are crinkled.
///
/// Beside seams texels are cells that tile the surface together with those of the other chart
/// (border_cells.h). The fluxes through a face are the same numbers on both its sides, over seams
/// too, so each amount is kept to rounding. Explicit steps, as many as stability needs (never
/// negative, the pores never beyond their capacity) for any `seconds`; but none shorter than
/// `shortest_step`: there no face passes more than an eighth of a texel, and what pores would pass
/// beyond that goes, where they are wet all over, between blocks of 4 × 4 texels, for which the
/// same step is 16 times less (writing on rice paper with texels of 0.05 mm: steps of 25 and 50 ms,
/// where stability asks for 2, change amounts by 0.2 % of the greatest, rms). Blocks end at seams:
/// among the tiles beside them the same step is divided into as many as stability needs, half of
/// them before and half after what flows elsewhere (Strang 1968). Only tiles that are
/// wet or next to wet ones are looked at; the same bits for any number of threads and on every
/// instruction set. Conductances: 1/√g (g22, −g12; −g12, g11), the mixed term by diagonal faces
/// (Selling's decomposition), made when a tile first gets wet (some 4 KiB a tile). 10 to 16 ns per
/// texel and step with four pigments, by how much of it is sheared and lies beside seams: two
/// thirds are sums in the first cache.
class WetFilm {
  public:
    /// The map must outlive it.
    WetFilm(const atlas::TexelMap& map, atlas::SeamLinks seams);
    ~WetFilm();
    WetFilm(WetFilm&&) noexcept;

    /// Called for a slot before anything in it changes, in the order of slots within a step.
    using BeforeFn = std::function<void(std::uint32_t slot)>;

    /// How much of a texel is free, 0–255, as a mask says.
    using FreeFn = std::function<std::uint8_t(std::uint32_t slot, int texel)>;
    /// Tape on what is not free at all: from now on nothing goes over its edge, neither on nor off it. Where less is
    /// free, less flows. Empty: everything is free. Costs: the metric of wet tiles is looked at anew.
    void keep_within(FreeFn free);

    /// Lets `seconds` pass. Does nothing on a dry canvas. `progress` is asked at every step; where it
    /// says stop, the canvas is left as far as it came, for the caller to take back.
    FilmReport advance(Canvas& canvas, double seconds, const FilmParams& params, const BeforeFn& before = {},
                       const ProgressFn& progress = {});

    /// Lets time pass until nothing is wet, at most `limit` seconds; then what is left dries
    /// where it is. Also closes open films that never were wet.
    FilmReport dry(Canvas& canvas, const FilmParams& params, const BeforeFn& before = {}, double limit = 3600,
                   const ProgressFn& progress = {});

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tuft::ink
