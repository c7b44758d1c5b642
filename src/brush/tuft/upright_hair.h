#pragma once

#include <span>

#include "brush/tuft/tuft.h"

/// \file
/// Hair pressed straight down: its ends splay round the foot of the axis until motion draws them to one side.
/// Called by the spine solver and by `footprint`.
///
/// Dragged by ds along −u, each end at azimuth φ from u trails on a string of length ρ (a tractrix), dφ = −sin φ
/// ds/ρ. This maps the circle to itself by Möbius maps. The mean w of all e^{iφ} is the image of its start,
///
///     dw/ds = (u − w² ū) / (2ρ),   so that from rest |w| = tanh(s/2ρ).
///
/// u and w are complex numbers in the plane across the axis. One spine represents all of the hair and lies where
/// most of it lies. When the mean has moved to another side by 0.15 (after 0.3 ρ), the spine is rotated there about
/// the axis; this costs no energy, since no hair slides. From |w| = 0.5 on, all hair lies on one side, and only
/// friction turns it.
namespace tuft::brush {

/// Updates the mean direction over one solve and rotates the spine with its hair about the axis. Hair in the air is
/// splayed if it is straight and upright; it lies on one side if it is bent or tilted by more than the tuft's own
/// taper (radius over length).
void turn_with_spread(const Preset& preset, Spine& spine, const Pose& from, const Pose& to,
                      std::span<const ContactPlane> planes);

/// Foot of the axis of a touching tuft on the surface, and the fraction of hair splayed round it.
struct UprightHair {
    Vec3 centre{0};     ///< metres, world
    double radius = 0;  ///< metres, of the straight tuft at the height of the surface
    double share = 0;   ///< 1: hair lies on all sides … 0: all hair lies on one side
};

/// Returns the upright hair; `tip` is the contact plane of the tip. `share` is 0 for hair in the air, for a split
/// tuft, for the query table, and under a horizontal ferrule.
UprightHair upright_hair_of(const Tuft& tuft, const ContactPlane& tip);

}  // namespace tuft::brush
