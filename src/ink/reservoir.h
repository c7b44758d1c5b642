#pragma once

#include "ink/deposit.h"

/// The ink in a tuft and how much of it a touch may take.
namespace tuft::ink {

/// Ink held by the tuft, film·m² of wet ink, by plane of a canvas and water.
struct Reservoir {
    double capacity = film_of_millilitres(0.5);
    std::array<double, kMaxPigments> pigment{};
    double water = 0;

    double remaining() const;
    /// Part of the capacity that is left, 0–1.
    double fullness() const;
    /// What would leave now: parts of the wet ink; all zero when empty.
    Mix mix() const;
};

/// An empty tuft that holds `millilitres`.
Reservoir make_reservoir(double millilitres);

/// Fills the tuft up with ink of the given mix; what is in it stays and mixes.
/// Returns the amount taken from the dish, film·m².
double dip(Reservoir& tuft, const Mix& mix);

/// Empties the tuft; returns what was in it, film·m².
double rinse(Reservoir& tuft);

/// Takes `amount` (film·m², at most what is left) in the proportions of the mix.
void take(Reservoir& tuft, double amount);

/// The source paper's recurrence (variable stiffness brush): what leaves at one stamp,
/// Q_i = η k_i (Z − Σ_{j<i} Q_j), with `remaining` = Z − ΣQ and k_i = |M_i| / M_max.
double paper_quantity(double eta, double moment_factor, double remaining);

/// The same independent of how densely the path is sampled:
/// Q = Z (1 − exp(−η k Δs / l)); equals the recurrence for Δs = l and η k → 0.
double supply_quantity(double eta, double moment_factor, double remaining, double ds,
                       double supply_length);

/// How a stamp touches.
struct StampContact {
    double moment_factor = 1;  ///< k = |M| / M_max of the tuft, 0–1
    double width = 0;          ///< metres across the motion
    double area = 0;           ///< m² of the contact patch
};

/// Film the stamp tends to. The tuft offers η k' Z / l ink per metre of travel (l =
/// `ink.supply_length`), with
/// k' = 0.25 + 0.75 k: a quarter comes by capillarity, also where the bending moment passes
/// through zero, the rest is squeezed out as in the paper. The stroke asks for `ink.film`
/// times the contact's width; with x = offered / asked
///
///     c = film (1 − exp(−x)) min(1, 0.85 + 0.3 k)
///
/// so a loaded tuft (x ≈ 5–100) paints full strength at any speed and in any width,
/// and one that has given most of its ink pales, wide strokes first. c · area never
/// exceeds what is left.
DepositParams stamp_deposit(const Reservoir& tuft, const Ink& ink, const StampContact& contact,
                            const Substrate& substrate);

}  // namespace tuft::ink
