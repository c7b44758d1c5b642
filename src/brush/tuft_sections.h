#pragma once

#include <span>
#include <vector>

#include "brush/tuft.h"

/// Inside of the tuft: cross-sections along a solved spine.
namespace tuft::brush {

struct SectionInput {
    const Preset& preset;
    const Spine& spine;
    const rod::Result& result;
    std::span<const rod::Obstacle> obstacles;
    Quat rotation;       ///< of the ferrule
    double wetness = 1;  ///< 0 to 1: the film that draws the tip down, the cohesion that keeps hair together
    double share = 1;    ///< spines the hair is shared among
    std::span<const ContactPlane> walls = {};  ///< beside the nodes, tip first, that of the side of
                                               ///< e and that of the other; or none
};

struct SectionOutput {
    std::vector<Section> sections;    ///< tip first
    Vec3 wide{1, 0, 0};               ///< e at the root, ferrule frame
    std::vector<Vec3> sides;          ///< side nodes from the root, metres, ferrule frame, tip
                                      ///< first: that of the side of e, that of the other
};

/// Half-widths to both sides from the side nodes (lateral.h), pushed by the bending moment, the
/// force and the squash of the contact and dragged by its friction; a is their mean, the centre
/// lies midway, b = r²/a. The wide axis e lies in the contact plane where the spine presses
/// most, else along the axis of bending, else where it was; from there it is carried along
/// the spine without spin.
SectionOutput make_sections(const SectionInput& input);

}  // namespace tuft::brush
