#pragma once

#include <span>

#include "brush/tuft.h"

/// Inside of the tuft: hair that was pressed straight down has no side of its own.
///
/// Its ends splay round the foot of the axis. Dragged by ds along -u, each end at azimuth φ from u
/// trails on its string of length ρ (a tractrix), dφ = -sin φ ds/ρ, which maps the circle to itself by
/// Möbius maps; the mean w of all e^{iφ} is the image of its beginning,
///
///   dw/ds = (u - w² ū) / (2ρ),   so that from rest |w| = tanh(s/2ρ):
///
/// half of the hair trails after a length ρ. The one spine that stands for them lies along w, and turns
/// there about the axis, which costs nothing; as |w| nears 1 all hair lies on one side, and only
/// friction turns it. u and w are complex numbers across the axis.
namespace tuft::brush {

/// Follows the ferrule's motion over one solve and turns the spine about the axis with its hair.
/// Hair that has just touched is splayed if it is straight and stands upright, and lies on one side
/// if it is bent or leans by more than the tuft's own taper (radius over length).
void turn_with_splay(const Preset& preset, Spine& spine, const Pose& from, const Pose& to,
                     std::span<const ContactPlane> planes);

}  // namespace tuft::brush
