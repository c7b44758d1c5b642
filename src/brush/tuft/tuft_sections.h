#pragma once

#include <span>

#include "brush/tuft/spine.h"
#include "brush/tuft/tuft.h"
#include "core/system/recycled.h"

/// \file
/// Cross-sections along a solved spine. Internal to `brush/tuft`.
namespace tuft::brush {

/// Returns the unit tangents at the nodes, root first: bisectors of the two segments.
Recycled<Vec3> node_tangents(const rod::Memory& memory);
/// Returns the clamp's side carried along the spine to its nodes by parallel transport, unit, root first.
Recycled<Vec3> broad_axes(const rod::Memory& memory, std::span<const Vec3> tangents);

/// What `make_sections` takes of one spine.
struct SectionInput {
    const Preset& preset;
    const Spine& spine;
    const rod::Result& result;
    std::span<const rod::Obstacle> obstacles;
    std::span<const Vec3> node;                ///< [n+1] positions of the hair, units of L
    Quat rotation;                             ///< of the ferrule
    double wetness = 1;                        ///< 0 to 1: adhesion of the tip, cohesion of the hair
    double share = 1;                          ///< number of spines that share the hair
    std::span<const ContactPlane> walls = {};  ///< beside the nodes, tip first; the side of e, then the other; or empty
    const Neighbours& neighbours;              ///< spines beside it
    std::span<const Vec3> along = {}, broad = {};  ///< as in SolvedRod

    /// A spine of a wide ferrule: its section at rest is an ellipse.
    bool wide() const { return !spine.rest.section.empty(); }
};

/// Result of `make_sections`.
struct SectionOutput {
    Recycled<Section> sections;                  ///< tip first
    Vec3 wide{1, 0, 0};                          ///< e at the root, ferrule frame
    Recycled<double> aside;                      ///< as in Spine
    Recycled<signed char> slips;                 ///< as in Spine
    double aside_energy = 0, spread_energy = 0;  ///< J
    /// Side nodes from the root, metres, ferrule frame, tip first; the side of e, then the other.
    Recycled<Vec3> sides;
    Recycled<double> flank;  ///< as in Spine
};

/// Returns the stiffness of a side node against a wall, relative to that of the contact: side node and cohesion
/// springs in series; 0 dry … 1 wet.
double side_stiffness(double wetness);

/// Computes the sections from the side nodes (lateral.h). Bending moment, contact force and indentation push the
/// side nodes out; friction drags them. a is the mean of both half-widths, the centre lies midway, b = r²/a.
///
/// Energy. The stiffnesses B and k_c of a tuft are those of hair that is free to spread. The full potential of
/// spine x and side nodes u is A(x) − q(x)·u + ½ uᵀK u, and the rod's potential Π is its minimum over u. The hand's
/// work on the side nodes therefore passes through the rod's own forces, −∂A/∂x + u ∂q/∂x = −∂Π/∂x, and the springs
/// hold ½ uᵀK u of the rod's energy. This holds for the symmetric part. The shift δ by friction adds S(δ)
/// (`drag_lateral`). Two sides of equal push and shift pull the spine equally, and the dragging force belongs to
/// the rod's friction. The hand has done that work during the slip: δ grows by at most the slip along e, and slip
/// dissipates less by the same amount.
///
/// Walls. A wall beside the tuft holds the side nodes with the force of their springs, which acts on the spine. The
/// rod has it as the potential of the springs at the free half-width of the previous step (flanks.h).
///
/// Point. Ink that hangs at the point of a wet round tuft (`Preset::tip_drop`) widens the sections there; it is no hair
/// and takes no part in the balance.
///
/// Axis. The wide axis e lies in the contact plane where the spine presses most; without contact along the axis of
/// bending; without bending it is unchanged. It is parallel-transported along the spine from there.
SectionOutput make_sections(const SectionInput& input);

}  // namespace tuft::brush
