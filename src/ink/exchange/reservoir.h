#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/types.h"
#include "core/system/recycled.h"
#include "ink/exchange/deposit.h"

/// \file
/// Ink reservoir of a tuft: cells of ink along the hair, their loading, flow and supply. `stroke` loads it,
/// advances `flow`, and withdraws what each stamp deposits.
///
/// Amounts are in film·m² of wet ink (pigments.h), saturations and fractions in [0, 1].
namespace tuft::ink {

/// Division of the hair into cells: bundles side by side, each with cells from root to tip.
struct ReservoirLayout {
    std::vector<Vec2> bundles{Vec2{0}};  ///< [n_bundles] positions in the section, unit disc
    /// [n_cells] end of each cell, fraction of the length from the root; increasing, the last is 1.
    std::vector<double> cell_ends{1};
    std::vector<double> cell_capacities{1};  ///< [n_cells] fraction of a bundle's capacity; sum 1
    double refill_time = 0.04;               ///< s, time constant of flow between adjacent cells of a bundle
    double side_time = 0.25;                 ///< s, time constant of flow between neighbouring bundles
    double mix_time = 30;                    ///< s, time constant of mixing between adjacent cells of a bundle
};

/// Exchange coefficients of two cells.
struct CellLink {
    std::uint32_t a = 0, b = 0;
    double flow = 0;    ///< g, film·m² per second per unit difference of saturation
    double mixing = 0;  ///< 1/s, fraction of the smaller content
};

/// Ink of the tuft in its cells, film·m² of wet ink. Plane p of a cell is the canvas' pigment plane p; the last
/// plane is water. Invariants: all amounts are ≥ 0. No cell exceeds its capacity, except after `dip` with level > 1,
/// an `absorb` beyond `free_capacity`, or `compress`.
struct Reservoir {
    static constexpr int kPlanes = kMaxPigments + 1;
    using Content = std::array<double, kPlanes>;

    double capacity = film_of_millilitres(0.5);
    ReservoirLayout layout;
    std::vector<double> cell_capacity;  ///< [bundles * cells], cell c of bundle k at k * cells + c, root first
    std::vector<Content> content;       ///< likewise
    std::vector<CellLink> links;
    double rest_capacity = film_of_millilitres(0.5);  ///< of the tuft that is not pressed; see `compress`
    double unspent = 0;                               ///< s of `flow` not yet applied, less than one step

    std::size_t n_bundles() const { return layout.bundles.size(); }
    std::size_t n_cells() const { return layout.cell_ends.size(); }  ///< of each bundle

    double remaining() const;         ///< film·m² of wet ink in all cells
    double pigment(int plane) const;  ///< film·m² of one plane in all cells
    double water() const { return pigment(kMaxPigments); }
    /// Content over capacity, 0–1: of the tuft; of a cell.
    double fullness() const;
    double saturation(std::size_t cell) const;
    /// Returns the mixture of the whole tuft: fractions of the wet ink; all 0 when empty.
    Mix mix() const;
};

/// Returns the wet ink of a content, film·m²: all planes together.
inline double sum_of(const Reservoir::Content& content) {
    double sum = 0;
    for (const double v : content) sum += v;
    return sum;
}

/// Sets the capacity of the tuft and of all its cells to `part` (0–1) of that at rest: foam that is pressed. Contents
/// do not change; cells may then hold more than their capacity.
void compress(Reservoir& tuft, double part);

/// Returns the content beyond the capacity, film·m²: what foam gives that is pressed.
double excess(const Reservoir& tuft);

/// Contact fractions of the cells, [bundles * cells], sum 1; empty: all alike.
using ContactCells = Recycled<float>;

/// Returns an empty reservoir of `millilitres`. Throws `Error` for an invalid layout.
Reservoir make_reservoir(double millilitres, ReservoirLayout layout = {});

/// Part of the tuft that is dipped or wiped.
struct Reach {
    double depth = 1;  ///< fraction of the length, from the tip, 0–1
    double side = 0;   ///< fraction of the width, from the sections' +x side (> 0) or −x side (< 0), −1–1; 0: all
};

/// Largest level of a dip; more drips off before the tuft reaches the surface
inline constexpr double kMostLevel = 1.5;

/// Depth and level of a dip.
struct Dip {
    double depth = 1;  ///< as `Reach`
    /// Saturation of the filled cells, at most kMostLevel; the excess over 1 runs off the hair (`drained_volume`).
    double level = 1;
    double side = 0;  ///< as `Reach`
};

/// Fills the cells in reach with ink of the given mix; their contents remain and mix with it. Partly dipped cells
/// are filled in part. The edge of a dipped side is soft over a tenth of the width, by capillarity. Returns the ink
/// taken from the dish, film·m².
double dip(Reservoir& tuft, const Mix& mix, const Dip& how = {});

/// Removes the fraction `part` of the ink of the cells in reach, as a rag does. Returns the removed amount,
/// film·m².
double wipe(Reservoir& tuft, double part, const Reach& reach = {});

/// Empties the tuft. Returns the former content, film·m².
double rinse(Reservoir& tuft);

/// Withdraws `amount` (film·m², at most `remaining`) from the touching cells, each with its own mixture. The
/// shortfall comes from all others in proportion. Returns the withdrawn amounts by plane.
Reservoir::Content take(Reservoir& tuft, double amount, const ContactCells& contact = {});

/// Returns the free capacity of the touching cells, film·m²: the limit of absorption from the surface.
double free_capacity(const Reservoir& tuft, const ContactCells& contact = {});

/// Adds `lifted` (film·m² by plane) to the touching cells. The excess is distributed over the other cells in
/// proportion to their free capacity. Nothing is lost: beyond the total capacity the touching cells hold it, so
/// call `free_capacity` first.
void absorb(Reservoir& tuft, const Reservoir::Content& lifted, const ContactCells& contact = {});

/// Returns the mixture and the saturation (0–1) at the surface: means over the touching cells.
Mix mix_at(const Reservoir& tuft, const ContactCells& contact);
double saturation_at(const Reservoir& tuft, const ContactCells& contact);

/// End time of `flow`: the last whole step, or the exact time.
enum class FlowTo { whole_step, now };

/// Advances the flow in the hair by `dt` seconds. Between linked cells i and j flows
///
///     F = g (s_i − s_j),   s = content over capacity,
///
/// with the giver's mixture. A slow exchange of equal amounts equalises mixtures. Steps of 5 ms on the reservoir's
/// own clock: any division of the time gives the same result within a step. With `now` the rest of a step is
/// applied too, so that nothing jumps. The sum of each plane is conserved to rounding. Cost: about 1 µs a step for
/// 40 bundles of 4 cells.
void flow(Reservoir& tuft, double dt, FlowTo to = FlowTo::whole_step);

/// Geometry of the liquid that runs down a tuft.
struct Drain {
    double length = 0.03, radius = 3e-3;  ///< metres, of the tuft
    double slope = 1;                     ///< fraction of its weight along the tuft towards the contact, 0–1
};

/// Returns the liquid, film·m², that runs off a touching tuft in `dt` seconds: part of the content beyond the
/// capacity, which capillarity does not hold. It is a film of thickness δ = V / (π R L) that drains by its weight,
/// dV/dt = −2 π R slope ρ g δ³ / 3 μ [Jeffreys1930], so
///
///     V(t) = V / √(1 + 2 c V² t),   c = 2 π R slope ρ g / (3 μ (π R L)³).
///
/// Viscosity of the ink: 2 mPa s. Does not change the tuft.
double drained_volume(const Reservoir& tuft, const Drain& drain, double dt);

/// Returns the ink of one stamp by the recurrence of [Huang2018], Q_i = η k_i (Z −
/// Σ_{j<i} Q_j), with `remaining` = Z − ΣQ and k_i = |M_i| / M_max.
double paper_quantity(double eta, double moment_factor, double remaining);

/// Returns the ink of one stamp independent of the sampling of the path: Q = Z (1 − exp(−η k Δs / l)). Equals the
/// recurrence for Δs = l and η k → 0.
double supply_quantity(double eta, double moment_factor, double remaining, double ds, double supply_length);

/// Contact of a stamp.
struct StampContact {
    double moment_factor = 1;  ///< k = |M| / M_max of the tuft, 0–1
    double width = 0;          ///< metres across the motion, gaps between hairs left out
    double area = 0;           ///< m² of the contact patch
    double pending = 0;        ///< film·m² already deposited but not yet withdrawn from the tuft
    /// 0–1: fraction of contact by single hairs, which leave a film of their own thickness or none.
    double by_hair = 0;
    std::span<const float> cells = {};  ///< as `ContactCells`; empty: the whole tuft alike
};

/// Returns the deposit parameters of a stamp: its target film c. The tuft offers η k' Z / l ink per metre of
/// travel, with l = `ink.supply_length`, Z the capacity times the saturation of the touching hair, and k' = 0.25 +
/// 0.75 k. A quarter comes by capillarity, also where the bending moment is 0; the rest is squeezed out as in the
/// paper. The stroke demands `ink.film` times the contact's width. With x = offered / demanded,
///
///     c = film (1 − exp(−x)) min(1, 0.85 + 0.3 k)
///
/// A loaded tuft (x ≈ 5–100) paints full strength at any speed and width. A nearly empty one pales, wide strokes
/// first. Single hairs do not pale below 0.6 of the film: a thinner thread of ink breaks instead of spreading, and
/// less ink means fewer hairs. Their film is complete at once: s0 is a tenth. c · area never exceeds the remaining
/// ink.
DepositParams stamp_deposit(const Reservoir& tuft, const Ink& ink, const StampContact& contact,
                            const Substrate& substrate);

}  // namespace tuft::ink
