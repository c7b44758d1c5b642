#pragma once

/// \file
/// Laws of contact, friction and joints of a rod, in units of L and B0 (rod.h). `brush/tuft` derives them from a
/// preset.
namespace tuft::brush::rod {

/// Resistance of the hair to indentation, per length.
struct NormalLaw {
    bool hard = false;  ///< exact non-penetration by an augmented Lagrangian: more passes, no indentation
    /// k_c, force per length per indentation, > 0; the penalty when hard. Larger: hair is indented less, and a solve
    /// takes more iterations.
    double stiffness = 1e4;
    /// ≥ 0, further stiffness at indentations beyond core_start · radius. Larger: packed hair flattens less; 0: none.
    double core_stiffness = 0;
    double core_start = 0.65;  ///< 0–1, of the radius. Smaller: hair is packed at less indentation
    /// ≥ 0, indentation over which a stiffness rises from 0, which smooths its kink. Larger: fewer iterations, and a
    /// softer first touch; 0: a kink.
    double onset = 0;
    /// ≥ 0, shortening of the hair ends at the buckling load when normal to the surface; less with tilt. Fades to 0 at
    /// 4 end_compliance behind the tip. Larger: an upright tuft is pressed further before it buckles; 0: rigid ends.
    double end_compliance = 0;
};

/// Pull of the wet film between surface and hair.
struct AdhesionLaw {
    /// ≥ 0, per length of a wet node at gap 0; it falls as (1 − gap/range)² to 0 at `range`. Larger: a wet tuft stays
    /// on the surface longer when lifted; 0: dry.
    double strength = 0;
    double range = 0;  ///< ≥ 0, gap. Larger: nodes are drawn in from further away
};

/// Coulomb friction of hair on the surface, with sticking.
struct FrictionLaw {
    double coefficient = 0;  ///< μ ≥ 0. Larger: hair sticks at a larger tangential force; 0: it slides freely
    /// 0–1, fraction of μ of hair normal to the surface; the rest grows with sin² of the angle between hair and normal.
    /// Smaller: a tuft that stands on its point slides more easily; 1: the same μ at any angle.
    double end_share = 1;
    /// κ_f, 0–1: 2κ_f μ along the tangent, 2(1-κ_f) μ across. Below 0.5 hair slides more easily along itself; 0.5:
    /// isotropic.
    double grain = 0.5;
    /// C_η, 0–1: μ (1 − C_η cos⁴) when dragged tip last, cos of the angle between slip and hair. Larger: a dragged tuft
    /// trails with less force; 0: no difference to one that is pushed.
    double with_hair = 0;
    double pore_grip = 0;  ///< ≥ 0, extra μ of the tip when pushed tip first. Larger: a pushed point catches sooner
    /// k_t, tangential force per length per displacement, > 0. Larger: sticking hair gives less before it slides, and a
    /// solve takes more iterations.
    double stick_stiffness = 4e4;
};

/// What the joints do in time, over one solve of duration Δt.
struct JointLaw {
    /// ≥ 0, viscous stiffness over elastic stiffness of the joints: η/(k Δt) of backward Euler. Larger: joints follow
    /// more slowly; 0: no lag.
    double damping = 0;
    /// ≥ 0, Δt/T of the recovery of the set; see `recover_joint`. Larger: the set fades faster; 0: it stays.
    double recovery = 0;
};

/// Where the solver stops.
struct SolverLimits {
    int max_passes = 20;           ///< ≥ 1, passes of the outer fixed point over the normal forces
    int max_iterations = 80;       ///< ≥ 1, Newton iterations, all passes together; fewer may leave it unconverged
    double tolerance = 1e-7;       ///< > 0, largest residual moment. Smaller: more iterations
    double pass_tolerance = 1e-2;  ///< > 0, change of normal forces between passes, relative. Smaller: more passes
};

/// Law of a rod: of all its nodes and joints.
struct Law {
    /// ≥ 1, contact points per segment: one node and the points between, whose planes and radii are interpolated. More
    /// follow a curved surface or an edge more closely; the cost of contact is in proportion.
    int points_per_segment = 1;
    /// ≥ 0, rounding length of creases (wedge.h). At a crease a node has two planes, or neighbouring nodes have
    /// different ones. A point stays outside both planes (corner) or either (edge). Larger: rounder creases, fewer
    /// iterations; 0: one plane each.
    double edge = 0;
    NormalLaw normal;
    AdhesionLaw adhesion;
    FrictionLaw friction;
    JointLaw joints;
    SolverLimits limits;
};

}  // namespace tuft::brush::rod
