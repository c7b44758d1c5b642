#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "atlas/texels/seam_links.h"
#include "core/system/progress.h"
#include "ink/canvas/canvas.h"
#include "ink/film/tile/film_params.h"

/// \file
/// The wet film: flow, absorption and drying of liquid and pigment on the surface. `stroke` advances it between
/// stamps and between strokes.
namespace tuft::ink {

/// Work of `WetFilm::advance`.
struct FilmReport {
    std::size_t steps = 0;       ///< number of steps
    std::size_t tile_steps = 0;  ///< tiles stepped, over all steps
    double evaporated = 0;       ///< evaporated liquid, film·m²
};

/// Steps the wet film of a canvas by finite volumes on the texels, with the metric of the surface. Unknowns: liquid
/// w on the surface and s in the pores (w + s = T), pigments p of the open film:
///
///     ∂w/∂t = ∇·((D ⟨w − w_c⟩ + L ⟨w − w_r⟩) ∇w) − soak − e
///     ∂s/∂t = ∇·(D₀ S² ∇s) + soak,                         soak = a w (1 − S),  S = s / pores,  D₀ = k / ξ²
///     ∂p/∂t = ∇·((p/H)↑ j + D_p M ∇(p/H)),                 j: flux of w and of s (1 − retention)
///
/// Pores. Lucas–Washburn: a front fed from full pores is at √(k t), k = r σ cos θ / (2 η) (`washburn`). In steps of
/// their own, stable for any length (seepage.h).
///
/// Symbols. M = w + s (1 − retention): fibres retain pigment from seeping liquid, of thin ink less (seepage.h), so
/// water runs ahead and lines have dark cores. ↑: upwind, of the texel the liquid comes from. H = max(T, grip): pigment
/// under thin liquid does not move, so a drop dries as it is and its pigments do not collect in its middle.
///
/// Levelling. Surface tension levels ripples of the liquid on the surface by the law of thin films, to which the above
/// adds what thin-film theory does not know (fibres, roughness):
///
///     ∂w/∂t = −∇·(w³ / (3 η) ∇(σ ∇² w)),    so that a ripple decays at the rate σ w³ k⁴ / (3 η) [Orchard1962]
///
/// Ripples of less than 1 % of the thickness stay, beside contact lines of less than 3 to 10 %. Contact lines hold:
/// texels within two of liquid no thicker than `held` neither give nor take. On steep places nothing levels that is no
/// thicker than a bead's trail, nor beside liquid so thick that beads may run. Implicit, by multigrid (tension.h), in
/// steps of their own of 0.05 s and more.
///
/// Relief. On relief of dry paint and paste (z, film units, `dry_relief` and `paste_height` less kPlain) the
/// liquid's own surface levels, at any slope: the flux is (D ⟨w − w_c⟩ + L ⟨w − ridge⟩) ∇(w + z), with ⟨w − ridge⟩
/// of the higher texel as its limit. Ink leaves the ridges and fills the furrows. Paste under liquid is bedded
/// (`bed_paste`) and not stirred.
///
/// Rims. Liquid enters a dry texel only from one with more than w_c + pin, so rims stay in place. pin varies by ±
/// 40 % over about a millimetre, since surfaces are not clean. With a direction of gravity, contact lines preserve
/// mounds (L = 0), and what they cannot hold runs down: drops and the excess of films in beads (drips.h), at most 256
/// at once, and columns of liquid as sheets (sheet_flow.h) where `FilmWeight::hysteresis` is more than 0. The rim
/// evaporates faster, by `rim_evaporation` |∇ min(T, rim_depth)| / rim_depth: the same per metre of rim for any texel
/// size. This draws liquid and pigment there: dark edges. In still air all of that is multiplied by what it takes up
/// (still_air.h): 1 / R by area from a spot of radius R. A texel without liquid is closed (drying.h). With `unevenness`
/// D and D₀ vary in clouds of about a millimetre and, as far as pores retain pigments, along fibres (fibres.h): fronts
/// feather.
///
/// Seams. Beside seams, texels are cells that tile the surface together with those of the other chart
/// (border_cells.h). The flux through a face is one number for both sides, over seams too, so each amount is
/// conserved to rounding.
///
/// Steps. Explicit, as many as stability needs for any `seconds`: amounts are never negative, and pores never
/// exceed their capacity. None is shorter than `shortest_step`. There no face passes more than an eighth of a
/// texel. Where the surface is wet throughout, the excess flows between blocks of 4 × 4 texels, for which the same
/// step is 16 times smaller relative to stability. Blocks end at seams: among the tiles there the step is divided as
/// stability needs, half of it before and half after the other flows [Strang1968].
///
/// Cost: 10 to 16 ns per texel and step with four pigments, depending on the fraction sheared and beside seams; two
/// thirds are sums in the first-level cache. A step of levelling costs 80 to 130 ns per texel of tiles with ripples.
/// Only wet tiles and their neighbours are visited. Conductances 1/√g (g22, −g12; −g12, g11), the mixed term by
/// diagonal faces (Selling's decomposition), are computed when a tile first gets wet (about 4 KiB a tile). The same
/// bits for any number of threads and on every instruction set.
class WetFilm {
  public:
    /// The map must outlive it.
    WetFilm(const atlas::TexelMap& map, atlas::SeamLinks seams);
    ~WetFilm();
    WetFilm(WetFilm&&) noexcept;

    /// Called for a slot before anything in it changes, in the order of slots within a step.
    using BeforeFn = std::function<void(std::uint32_t slot)>;
    using FreeFn = FreeTexelsFn;

    /// Sets a stencil: from now on no liquid crosses the edge of texels that are not free at all. Flow is reduced
    /// where a texel is partly free. Empty: all texels are free. Cost: the metric of wet tiles is computed again.
    void keep_within(FreeFn free);

    /// Advances the film by `seconds`; no effect on a dry canvas. Calls `progress` at every step. When it stops the
    /// work, the canvas is left at the time reached; the caller restores it.
    FilmReport advance(Canvas& canvas, double seconds, const FilmParams& params, const BeforeFn& before = {},
                       const ProgressFn& progress = {});

    /// Advances the film until nothing is wet, at most `limit` seconds. Remaining liquid then dries in place. Also
    /// closes open films that were never wet.
    FilmReport dry(Canvas& canvas, const FilmParams& params, const BeforeFn& before = {}, double limit = 3600,
                   const ProgressFn& progress = {});

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tuft::ink
