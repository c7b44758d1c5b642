#pragma once

#include <span>

#include "brush/tuft.h"

/// Inside of the tuft: hair that was pressed straight down has no side of its own.
///
/// Its ends splay round the foot of the axis. Dragged by ds along -u, each end at azimuth φ from u
/// trails on its string of length ρ (a tractrix), dφ = -sin φ ds/ρ, which maps the circle to itself by
/// Möbius maps; the mean w of all e^{iφ} is the image of its beginning,
///
///   dw/ds = (u - w² ū) / (2ρ),   so that from rest |w| = tanh(s/2ρ).
///
/// u and w are complex numbers across the axis. One spine stands for all of the hair: it lies where
/// most of it does. Once the mean has gone to another side by 0.15 (after 0.3 ρ), the spine is laid there, turned
/// about the axis, which costs nothing; no hair slides on the way. From |w| = 0.5 on all hair has been
/// drawn to one side, and only friction turns it.
namespace tuft::brush {

/// Follows the ferrule's motion over one solve and turns the spine about the axis with its hair.
/// Hair in the air is splayed if it is straight and stands upright; it is on one side if it is bent or
/// leans by more than the tuft's own taper (radius over length).
void turn_with_splay(const Preset& preset, Spine& spine, const Pose& from, const Pose& to,
                     std::span<const ContactPlane> planes);

}  // namespace tuft::brush
