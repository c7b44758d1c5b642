#pragma once

#include <span>

#include "brush/tuft/tuft.h"
#include "core/system/recycled.h"

/// \file
/// Contact of the tuft's flanks with walls beside the spine. Called by the spine solver (spine.h).
namespace tuft::brush {

/// Returns the walls that act on a spine through its spread hair, in units of L and B0, one per input wall; empty
/// before the first step. `walls` come tip first, two to a node, as in `step`; a normal of zero means none. The
/// hair yields with the stiffness of its cohesion springs (`side_stiffness`), from the free half-width of its
/// section on,
///
///     h = √(a² (e·n)² + r⁴/a² (1 − (e·n)² − (t·n)²)),
///
/// the support of the ellipse in the direction of the wall's normal n; a is `Spine::flank` of the previous step. A
/// wall tilted away from e acts as floor: its share falls from 1 to 0 as the angle between e and the wall goes from
/// 53° to 26°, where the section lies on it.
Recycled<rod::Wall> flank_walls(const Preset& preset, const Spine& spine, const Quat& turn,
                                std::span<const ContactPlane> walls, double wetness);

/// Adds to the walls of a spine those across from its nodes, one for each after two for each. `across`: of the nodes,
/// root first, in units of L; a normal of zero means none.
void add_walls_across(std::span<const rod::Obstacle> across, Recycled<rod::Wall>& walls);

}  // namespace tuft::brush
