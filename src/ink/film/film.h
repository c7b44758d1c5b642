#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "atlas/texels/seam_links.h"
#include "core/system/progress.h"
#include "ink/canvas/canvas.h"

/// \file
/// The wet film: flow, absorption and drying of liquid and pigment on the surface. `stroke` advances it between
/// stamps and between strokes.
namespace tuft::ink {

/// How liquid behaves on a surface. Amounts of liquid in film units (10 µm).
struct FilmParams {
    double mobility = 1e-10;        ///< D, m²/s per film unit of water
    double threshold = 0.1;         ///< w_c: film units held by the surface
    double pin = 1;                 ///< film units above w_c needed to wet dry surface
    double mixing = 1e-10;          ///< D_p, m²/s: diffusion of the pigments in the liquid
    double grip = 1;                ///< film units: in thinner liquid, pigment lies on the surface and lags behind
    double absorbency = 0;          ///< a, 1/s: absorption by empty pores
    double pores = 0;               ///< film units, capacity of the pores; 0: none
    double suction = 0;             ///< k, m²/s: a front fed from full pores is at √(k t); 0: nothing seeps
    double retention = 0;           ///< fraction of the pigments that pores retain from seeping liquid
    double evaporation = 1.0 / 60;  ///< film units per second
    double rim_evaporation = 0;     ///< film units · m per second, additional, per metre of rim
    double rim_depth = 1;           ///< film units: rims are thinner than this
    double stain = 0;               ///< fraction of a drying film that soaks into bare substrate
    double unevenness = 0;          ///< rms of ln of the relative mobility over the ground; 0: even
    Vec3 down{0};                   ///< unit, direction of gravity; zero: none
    double retained = 2;            ///< w_r: film units not moved by gravity or surface tension
    double levelling = 1e-8;        ///< L, m²/s per film unit above `retained`: spreading onto dry surface
    bool levels_ripples = true;     ///< by tension, in this call; false: the caller counts the time, see `unlevelled`
    double unlevelled = 0;          ///< s before this call in which ripples have not levelled yet
    double tension = 0.06;          ///< σ, N/m: between water (0.073) and water with glue (0.05); 0: ripples stay
    double viscosity = 1e-3;        ///< η, Pa s, of water; pigments and glue make some inks several times as viscous
    double held = 0.3;              ///< film units: so thin a film is held by its contact line and does not level
    double ridge = 0.4;             ///< film units that stay on the ridges of dry paint
    double bead_angle = 0.15;       ///< radians: contact angle of a bead that runs down
    double bead_speed = 8e-3;       ///< m/s, speed of a bead of √2 times the radius at which it stops
    double drain = 2;               ///< 1/s: rate at which a bead draws in near liquid above `retained`
    double trail = 0.9;             ///< film units that a bead leaves behind
    /// Seconds; a fifth on relief, half under liquid. Where stability needs shorter steps, the fastest flows are
    /// limited, or computed between blocks of texels; beside seams such steps are divided.
    double shortest_step = 0.05;
};

/// Returns k = r σ cos θ / (2 η), m²/s: the square of the length of a front in pores of radius r (m) over time, with
/// contact angle θ (radians), σ (N/m) and η (Pa s) ([Lucas1918], [Washburn1921]).
double washburn(double pore_radius, double contact_angle, double tension, double viscosity);

/// Returns the parameters of a substrate (diffusion, threshold, edge, absorbency, pores, pore radius, contact angle,
/// evaporation, relief) and the direction of gravity. Where no pore radius is given, full pores have the diffusion of
/// the film: k = ξ² D pores.
FilmParams film_params(const Substrate& substrate, const Vec3& down = Vec3{0});

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
/// mounds (L = 0), and the excess runs down in beads (drips.h), at most 256 at once. The rim evaporates faster, by
/// `rim_evaporation` |∇ min(T, rim_depth)| / rim_depth: the same per metre of rim for any texel size. This draws
/// liquid and pigment there: dark edges. A texel without liquid is closed (drying.h). With `unevenness` D and D₀ vary
/// in clouds of about a millimetre and, as far as pores retain pigments, along fibres (fibres.h): fronts feather.
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

    /// Returns the free fraction of a texel, 0–255, from the mask.
    using FreeFn = std::function<std::uint8_t(std::uint32_t slot, int texel)>;
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
