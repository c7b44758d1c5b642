#pragma once

#include <span>

#include "brush/rod/rod.h"
#include "core/system/recycled.h"

/// \file
/// Rods side by side, coupled where they are neighbours: the spines of a tuft with a wide ferrule. `brush/tuft` calls
/// `solve_coupled` for all spines of a tuft at every sample.
///
/// Nodes of equal number of two neighbours face each other. With d = x₂ − x₁, t the mean tangent, r ⊥ t the direction
/// of their row, m = t × r, D = d·r and gaps g = D − D₀, h = D − D₁ the coupling adds per length of hair
///
///     U = f [½ k_n ⟨g₀ − g⟩² − W φ(g/g_b) + ½ k_h ⟨−h⟩²] + ψ(u − u_p) + ψ(v − v_p),   g₀ = 3 W / (k_n g_b),
///     φ(y) = (1 − y)³ on [0, 1], 1 − 3 y below, 0 above.
///
/// D₀ is the distance at which the hair of both touches at rest, D₁ the same for hair that is spread. The first term is
/// the contact of hair with hair: neighbours do not pass through each other. The second is the wet film between two
/// tufts of hair: W its work of separation (Dupré), g_b the gap at which it breaks. Both are at equilibrium at g = 0.
/// The third is the contact of spread hair. f falls from 1 to 0 where neighbours have slid past each other out of the
/// row, as |v| goes from half of their depth to all of it.
///
/// u = d·t − s₀ and v = d·m are the shifts of the neighbours along the hair and out of their row since the straight
/// rest. ψ is a spring of stiffness k_s that slips where its force passes μ f k_n ⟨g₀ − g⟩ (Coulomb, lagged). So
/// coupled hair shears before it slides. u belongs to facing segments and turns with them: t = ½ (t₁ + t₂). That makes
/// a row stiff across its broad side.
///
/// In D and v the directions, and f, are frozen during one pass of the outer fixed point over friction. Method: Newton
/// over all rods together; each step by elimination from tip to root in blocks of all rods. Cost: 2 K tangents against
/// 5 K further unknowns a segment for K rods.
///
/// Units as in rod.h: all rods share one L and one B0. Arrays go from root to tip.
/// Sources: this project; [Bico2004] and [Py2007] (hair drawn together by a wet film).
namespace tuft::brush::rod {

inline constexpr int kMaxCoupled = 9;

/// Law of the coupling, in units of L and B0, per length of hair.
struct CouplingLaw {
    double contact = 0;     ///< k_n, against overlap of the hair at rest
    double spread = 0;      ///< k_h, against overlap of spread hair
    double film = 0;        ///< W, work of separation of the wet film; 0: dry
    double film_range = 1;  ///< g_b > 0, gap at which it has broken
    double shear = 0;       ///< k_s
    double friction = 0;    ///< μ between hair; infinite: it never slides

    /// The same where the film is `part` as high.
    CouplingLaw with_film(double part) const {
        CouplingLaw out = *this;
        out.film *= part;
        return out;
    }
    double rest_gap() const { return contact > 0 ? 3 * film / (contact * film_range) : 0; }
};

/// State of a pair from one solve to the next. [m+1] for m segments that both rods have.
struct PairMemory {
    Recycled<Vec2> slip;      ///< u_p of segment i, and v_p of node i
    Recycled<double> normal;  ///< k_n ⟨g₀ − g⟩ of the last solve
    Recycled<double> growth;  ///< its change over the last solves, for the first guess
};

/// Two neighbours. Node i of both faces the other for i ≤ m, m the smaller number of segments.
struct CoupledPair {
    int first = 0, second = 1;
    Vec2 direction{1, 0};         ///< unit, from the first to the second at rest, along the clamps' side and t × side
    Recycled<double> touching;    ///< [m+1] D₀
    Recycled<double> spread;      ///< [m+1] D₁ ≥ D₀, or empty: D₀
    Recycled<double> depth;       ///< [m+1] |v| at which they have slid past each other, or empty: they never do
    Recycled<double> film;        ///< [m+1] W over that of the law, 0–1, or empty: 1
    Recycled<double> rest_shift;  ///< [m] s₀, or empty: 0
    PairMemory* memory = nullptr;
    std::span<const double> guess;  ///< [m+1] normal force to start from in place of the memory's, or empty

    /// The law between nodes i.
    CouplingLaw law_at(const CouplingLaw& law, int i) const { return film.empty() ? law : law.with_film(film[i]); }
};

/// A rod with what it meets, as the arguments of `solve`.
struct CoupledRod {
    const Rod* rod = nullptr;
    Memory* memory = nullptr;
    Clamp clamp;
    std::span<const Obstacle> obstacles;
    const Law* law = nullptr;
    Load load;
    std::span<const Wall> walls;
    const Guess* guess = nullptr;  ///< for all rods, or for none
};

/// How a pair stands after a solve. [m+1]
struct PairState {
    Recycled<double> distance;  ///< D
    Recycled<double> gap;       ///< g
    Recycled<double> faces;     ///< f
};

/// Result of a solve of coupled rods.
struct CoupledResult {
    Recycled<Result> rods;  ///< forces and energies of each; `converged`, iterations and passes of all together
    Recycled<PairState> pairs;
    SolverWork work;         ///< an evaluation of all rods counts once
    double energy = 0;       ///< stored in the coupling, W of unbroken film negative
    double dissipation = 0;  ///< by hair that slides along hair
};

/// Moves all rods rigidly to their clamps, then minimises Σ Π + Σ U. At most kMaxCoupled rods. The work is bounded as
/// that of `solve`. All laws take the limits of iterations and passes and the tolerances of the first.
CoupledResult solve_coupled(std::span<const CoupledRod> rods, std::span<const CoupledPair> pairs,
                            const CouplingLaw& law);

/// Potential of the contact, film and spread terms of U at the distance d of the axes, for frozen t: value and
/// derivatives over d. Shear is not part of it.
struct PairEnergy {
    double value = 0;
    double force = 0;      ///< −∂U/∂D, positive where the pair is pushed apart
    double stiffness = 0;  ///< ∂²U/∂D²
    double normal = 0;     ///< k_n ⟨g₀ − g⟩
};
PairEnergy pair_energy(const CouplingLaw& law, double touching, double spread, double distance);

/// Returns max |H u + g| / max |g| of the first Newton step u found by elimination, with H filled as a dense matrix:
/// for tests. Infinite where H is not positive definite.
double elimination_residual(std::span<const CoupledRod> rods, std::span<const CoupledPair> pairs,
                            const CouplingLaw& law);

}  // namespace tuft::brush::rod
