#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/types.h"
#include "ink/exchange/deposit.h"

/// The ink in a tuft and how much of it a touch may take.
namespace tuft::ink {

/// How the hair is divided for its ink: bundles side by side, each of cells from root to tip.
struct ReservoirLayout {
    std::vector<Vec2> bundles{Vec2{0}};      ///< places in the section, unit disc
    std::vector<double> cell_ends{1};        ///< where each cell ends, part of the length from the root;
                                             ///< rising, the last one is 1
    std::vector<double> cell_capacities{1};  ///< part of a bundle's capacity in each cell; sums to one
    double refill_time = 0.04;               ///< s in which a dry cell draws from a wet one above or below it
    double side_time = 0.25;                 ///< s the same between neighbouring bundles
    double mix_time = 30;                    ///< s in which cells one above the other become one mixture
};

/// What two cells exchange.
struct CellLink {
    std::uint32_t a = 0, b = 0;
    double flow = 0;    ///< film·m² per second and difference of saturation
    double mixing = 0;  ///< per second, of the smaller content
};

/// Ink held by the tuft, film·m² of wet ink, in cells. Plane p of a cell is the canvas' pigment
/// plane p; the last one is water. All amounts are ≥ 0 and no cell holds more than its capacity,
/// unless it was dipped dripping wet or `absorb` was given more than fits.
struct Reservoir {
    static constexpr int kPlanes = kMaxPigments + 1;
    using Content = std::array<double, kPlanes>;

    double capacity = film_of_millilitres(0.5);
    ReservoirLayout layout;
    std::vector<double> cell_capacity;  ///< [bundles * cells], cell c of bundle k at k * cells + c, root first
    std::vector<Content> content;       ///< likewise
    std::vector<CellLink> links;
    double unspent = 0;  ///< s of `flow` that did not fill a step yet

    std::size_t n_bundles() const { return layout.bundles.size(); }
    std::size_t n_cells() const { return layout.cell_ends.size(); }  ///< of each bundle

    double remaining() const;
    double pigment(int plane) const;
    double water() const { return pigment(kMaxPigments); }
    /// Part of the capacity that is left, 0–1; of the tuft, of a cell.
    double fullness() const;
    double saturation(std::size_t cell) const;
    /// What would leave now: parts of the wet ink; all zero when empty.
    Mix mix() const;
};

/// Which cells touch the surface: parts that sum to one, [bundles * cells]; empty: all alike.
using ContactCells = std::vector<float>;

/// An empty tuft that holds `millilitres`. Throws `Error` for a layout that is none.
Reservoir make_reservoir(double millilitres, ReservoirLayout layout = {});

/// Part of the tuft that is dipped, or wiped.
struct Reach {
    double depth = 1;  ///< of its length, from the tip, 0–1
    double side = 0;   ///< of its width, from the side of the sections' +x (> 0) or −x (< 0), −1–1; 0: all
};

inline constexpr double kMostLevel = 1.5;  ///< more drips off before the tuft comes anywhere

/// How far a tuft is dipped.
struct Dip {
    double depth = 1;  ///< as `Reach`
    double level = 1;  ///< part of their capacity up to which cells are filled; what is above 1 hangs on the
                       ///< hair and runs off it (`shed`), kMostLevel at most
    double side = 0;   ///< as `Reach`
};

/// Fills the tuft up with ink of the given mix; what is in it stays and mixes. Cells that are
/// dipped in part are filled in part; bundles at the edge of the side that is dipped have a soft
/// one, a tenth of the width, as hair draws ink. Returns the amount taken from the dish, film·m².
double dip(Reservoir& tuft, const Mix& mix, const Dip& how = {});

/// Draws the tuft over a rag: of what is in its cells within reach, `part` goes. Returns the
/// amount, film·m².
double wipe(Reservoir& tuft, double part, const Reach& reach = {});

/// Empties the tuft; returns what was in it, film·m².
double rinse(Reservoir& tuft);

/// Takes `amount` (film·m², at most what is left) from the cells that touch, of each its own
/// mixture; what they lack comes from all others in proportion. Returns what was taken, by plane.
Reservoir::Content take(Reservoir& tuft, double amount, const ContactCells& touch = {});

/// Room left in the cells that touch, film·m²: what they may take up from the surface.
double room_left(const Reservoir& tuft, const ContactCells& touch = {});

/// Takes up `lifted` (film·m² by plane) from the surface into the cells that touch; what they
/// have no room for goes on to the others, in proportion to theirs. Nothing is lost: beyond the capacity the touching
/// cells hold it all the same, so ask `room_left` before.
void absorb(Reservoir& tuft, const Reservoir::Content& lifted, const ContactCells& touch = {});

/// Mixture and saturation (0–1) that the surface meets: means over the touching cells.
Mix mix_at(const Reservoir& tuft, const ContactCells& touch);
double saturation_at(const Reservoir& tuft, const ContactCells& touch);

/// How far `flow` goes.
enum class FlowTo { whole_step, now };

/// Lets the ink move in the hair for `dt` seconds: between linked cells i and j
///
///     F = g (s_i − s_j),   s = content over capacity,
///
/// of the giver's mixture, and a slow exchange of equal parts that makes mixtures alike. In
/// steps of 5 ms on the tuft's own clock, so any division of a time gives the same within a
/// step; to `now` also what is left of a step, so that nothing jumps. What one cell loses another gains: the sum of
/// each plane is kept to rounding. About 1 µs a step for 40 bundles of 4 cells.
void flow(Reservoir& tuft, double dt, FlowTo to = FlowTo::whole_step);

/// How liquid that hangs on a tuft runs down it.
struct Drain {
    double length = 0.03, radius = 3e-3;  ///< metres, of the tuft
    double slope = 1;                     ///< part of its weight that drives it to where it touches, 0–1
};

/// What of the liquid that its hair does not hold by capillarity (beyond the capacity) leaves a tuft
/// that touches something in `dt` seconds, film·m². It hangs on the tuft as a film of thickness
/// δ = V / (π R L), and runs down by its weight, dV/dt = −2 π R slope ρ g δ³ / 3 μ (Jeffreys 1930), so
///
///     V(t) = V / √(1 + 2 c V² t),   c = 2 π R slope ρ g / (3 μ (π R L)³).
///
/// Ink of 2 mPa s. Takes nothing from the tuft.
double shed(const Reservoir& tuft, const Drain& drain, double dt);

/// The source paper's recurrence (variable stiffness brush): what leaves at one stamp,
/// Q_i = η k_i (Z − Σ_{j<i} Q_j), with `remaining` = Z − ΣQ and k_i = |M_i| / M_max.
double paper_quantity(double eta, double moment_factor, double remaining);

/// The same independent of how densely the path is sampled:
/// Q = Z (1 − exp(−η k Δs / l)); equals the recurrence for Δs = l and η k → 0.
double supply_quantity(double eta, double moment_factor, double remaining, double ds, double supply_length);

/// How a stamp touches.
struct StampContact {
    double moment_factor = 1;  ///< k = |M| / M_max of the tuft, 0–1
    double width = 0;          ///< metres across the motion, gaps between hairs left out
    double area = 0;           ///< m² of the contact patch
    double pending = 0;        ///< film·m² of what the tuft still holds that is laid down already
    double by_hair = 0;  ///< 0–1: how much single hairs touch, which leave a film of their own thickness or none
    std::span<const float> touch = {};  ///< as `ContactCells`; empty: the whole tuft alike
};

/// Film the stamp tends to. The tuft offers η k' Z / l ink per metre of travel (l =
/// `ink.supply_length`, Z the capacity times the saturation of the hair that touches), with
/// k' = 0.25 + 0.75 k: a quarter comes by capillarity, also where the bending moment passes
/// through zero, the rest is squeezed out as in the paper. The stroke asks for `ink.film`
/// times the contact's width; with x = offered / asked
///
///     c = film (1 − exp(−x)) min(1, 0.85 + 0.3 k)
///
/// so a loaded tuft (x ≈ 5–100) paints full strength at any speed and in any width,
/// and one that has given most of its ink pales, wide strokes first. Single hairs, of which
/// the fewer touch the less ink there is, do not pale below 0.6 of the film: a thinner thread
/// of ink breaks instead of spreading; and theirs is there at once, s0 being a tenth. c · area
/// never exceeds what is left.
DepositParams stamp_deposit(const Reservoir& tuft, const Ink& ink, const StampContact& contact,
                            const Substrate& substrate);

}  // namespace tuft::ink
