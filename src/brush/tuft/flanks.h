#pragma once

#include <span>
#include <vector>

#include "brush/tuft/tuft.h"

namespace tuft::brush {

/// What the flanks of a spine feel of the walls beside it (tip first, two to a node, as in `step`;
/// a normal of zero: none), in units of L and B0, one for each: the hair that has spread gives way
/// with the stiffness of the springs that hold it together (`side_stiffness`) from the free
/// half-width of its section on,
///
///     h = √(a² (e·n)² + r⁴/a² (1 - (e·n)² - (t·n)²)),
///
/// the ellipse's towards the wall's normal n; a is `Spine::flank`, of the step before. A wall that
/// leans away from e is ground: its share fades from 53° to 26° between e and the wall, where the
/// section lies on it. None before the first step.
std::vector<rod::Wall> flank_walls(const Preset& preset, const Spine& spine, const Quat& turn,
                                   std::span<const ContactPlane> walls, double wetness);

}  // namespace tuft::brush
