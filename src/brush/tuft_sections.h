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
};

struct SectionOutput {
    std::vector<Section> sections;    ///< tip first
    Vec3 wide{1, 0, 0};               ///< e at the root, ferrule frame
};

/// a = r (1 + κ1 |m|/M_e0 + κ2 k_F + κ3 squash), bent over smoothly to stay below
/// flatten_max r, and b = r²/a; held round by the ferrule at the root. The wide axis e lies in the contact plane where the spine presses
/// most, else along the axis of bending, else where it was; from there it is carried along
/// the spine without spin.
SectionOutput make_sections(const SectionInput& input);

}  // namespace tuft::brush
