#pragma once

#include <span>
#include <vector>

#include "brush/tuft/tuft.h"

/// Inside of the tuft: cross-sections along a solved spine.
namespace tuft::brush {

struct SectionInput {
    const Preset& preset;
    const Spine& spine;
    const rod::Result& result;
    std::span<const rod::Obstacle> obstacles;
    std::span<const Vec3> node;  ///< [n+1] where the hair is, units of L
    Quat rotation;               ///< of the ferrule
    double wetness = 1;          ///< 0 to 1: the film that draws the tip down, the cohesion that keeps hair together
    double share = 1;            ///< spines the hair is shared among
    std::span<const ContactPlane> walls = {};  ///< beside the nodes, tip first, that of the side of
                                               ///< e and that of the other; or none
};

struct SectionOutput {
    std::vector<Section> sections;               ///< tip first
    Vec3 wide{1, 0, 0};                          ///< e at the root, ferrule frame
    std::vector<double> aside;                   ///< as in Spine
    std::vector<signed char> slips;              ///< as in Spine
    double aside_energy = 0, spread_energy = 0;  ///< J
    std::vector<Vec3> sides;                     ///< side nodes from the root, metres, ferrule frame, tip
                                                 ///< first: that of the side of e, that of the other
    std::vector<double> flank;                   ///< as in Spine
};

/// Stiffness against a wall of a side node and the springs that draw it in, one behind the other, over that of the
/// contact; 0 dry … 1 wet.
double side_stiffness(double wetness);

/// Half-widths to both sides from the side nodes (lateral.h), pushed by the bending moment, the
/// force and the indentation of the contact and dragged by its friction; a is their mean, the centre
/// lies midway, b = r²/a.
///
/// Energy. The stiffnesses of a tuft, B and k_c, are those of hair that is free to spread: with the
/// full potential A(x) - q(x)·u + ½ uᵀK u of spine x and side nodes u, the rod's is its minimum over
/// u, so that the push takes from the hand what it brings to the side nodes, through the very
/// forces -∂A/∂x + u ∂q/∂x = -∂Π/∂x that the rod has, and the springs hold ½ uᵀK u of the rod's own
/// energy. What is to either side alike stays so. What friction shifts, δ, comes on top: S(δ)
/// (`drag_lateral`); two sides that are pushed alike and shifted alike pull alike at the spine, and
/// the force that drags them is of the friction that the rod has. The hand has worked for it on the
/// way of the slip: δ grows by no more than the slip along e, and the slip loses so much less.
/// A wall beside the tuft holds the side nodes by what their springs push, and that passes on to the spine:
/// the rod has it as the springs' potential in the free half-width of the step before (flanks.h).
/// The wide axis e lies in the contact plane where the spine presses
/// most, else along the axis of bending, else where it was; from there it is carried along
/// the spine without spin.
SectionOutput make_sections(const SectionInput& input);

}  // namespace tuft::brush
