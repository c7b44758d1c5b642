#pragma once

#include <span>
#include <vector>

#include "brush/papers/space/half_space.h"
#include "core/geometry/types.h"

/// \file
/// Particles and springs of the truss model and their first-order dynamics. Called by truss_model.cpp.
///
/// Source: [Baxter2001], 3.3 and 3.5. [p] is printed there, [R] is restored, [X] is ours.
///
/// A truss is a pyramid of five particles: four of its base, which the handle drives, and the point [p]. A round has
/// one, a flat or bright two, a filbert four with the outer ones shorter [p], by a fifth [X]. Neighbouring points are
/// joined by a spring [X]. The motion is Aristotelian, M ẋ = f [p]:
///
///     Δx = (I − h M⁻¹ J)⁻¹ h M⁻¹ f(x),   J = ∂f/∂x of the linear part of the springs.
///
/// The print lacks the M⁻¹ before J, without which N s/m is added to 1 [R]. M is the drag of a free particle, N s/m. J
/// is constant, −Σ k over the springs of a particle, the same in all directions [p, from Desbrun1999]. It is at
/// least as stiff as the springs are, so no step overshoots, however long; but hair that swings to the side is slowed
/// by the stiffness along it, so a step of the brush is cut into short ones [X].
///
/// No curvature is constrained; only stretch is limited: springs are contracted until none is more than 5 % long [X].
namespace tuft::brush::truss {

inline constexpr double kMostStretch = 0.05;  ///< of a spring's rest length [X]; the print has no number

/// Spring between two particles.
struct Spring {
    int from = 0, to = 0;  ///< particles
    double stiffness = 0;  ///< k, N/m
    double rest = 0;       ///< metres
};

enum class Kind { round, flat, filbert };

/// Measures of a brush head. The broad side lies along the ferrule's x.
struct Shape {
    Kind kind = Kind::round;
    double length = 0.03;          ///< metres
    double half_width = 3e-3;      ///< metres, of the base
    double half_thickness = 3e-3;  ///< metres
    double outer_length = 0.8;     ///< of the outer trusses of a filbert, over `length` [X]
};

/// Particles 4 j … 4 j + 3 are the base of truss j, round its centre; particle 4 count + j is its point.
struct Truss {
    int count = 1;           ///< pyramids
    std::vector<Vec3> rest;  ///< [5 count] metres, ferrule frame
    std::vector<Spring> springs;
    double stiffness = 0;      ///< k of the edges, N/m
    double half_diagonal = 0;  ///< ρ of a base, metres
    double drag = 0;           ///< M of a point, N s/m

    int base_count() const { return 4 * count; }
};

/// Returns the truss of a head with root stiffness B0 (N m²). The lateral stiffness of each point is that of a
/// cantilever with its share of B0 [X]:
///
///     2 k ρ²/ℓ² = 3 (B0/count)/L³,   ℓ the length of an edge,
///
/// and M = `relaxation` · 2 k ρ²/ℓ²: a point swings back in `relaxation` seconds [X].
Truss make_truss(const Shape& shape, double stiffness, double relaxation = 2e-3);

/// Returns the forces of the springs on all particles, newtons.
std::vector<Vec3> spring_forces(const Truss& truss, std::span<const Vec3> particles);
/// Returns Σ ½ k (l − l0)², joules.
double spring_energy(const Truss& truss, std::span<const Vec3> particles);
/// Returns the largest l/l0 − 1.
double largest_stretch(const Truss& truss, std::span<const Vec3> particles);

/// (I − h M⁻¹ J)⁻¹ h M⁻¹ for the points, [count × count] by rows, m/N.
std::vector<double> step_matrix(const Truss& truss, double h);

/// How the points meet the surface during a step. Empty: free in air.
struct StepContact {
    std::vector<HalfSpace> below;  ///< one per point, or none
    double friction = 0;           ///< μ
};

/// Moves the points over h seconds with the base at rest: the dynamics, friction and projection onto the surface. The
/// paper reduces the velocity of a colliding particle instead of adding a drag [p]. From −μ ‖F_n‖ v̂_t, where the print
/// has v_t without the hat [R], it is v_t max(0, 1 − μ F_n/F_t).
void move_points(const Truss& truss, std::span<const double> matrix, const StepContact& contact,
                 std::vector<Vec3>& particles);

/// Contracts springs that are too long, at most 20 sweeps, each followed by the projection; what still is too long is
/// contracted about the centre of the base [X]. After it no spring is more than kMostStretch long. No point is below
/// the surface if the base is above.
void limit_stretch(const Truss& truss, const StepContact& contact, std::vector<Vec3>& particles);

}  // namespace tuft::brush::truss
