#pragma once

#include <span>

#include "brush/tuft/tuft.h"

/// Hair that was pressed straight down has no side of its own.
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
void turn_with_spread(const Preset& preset, Spine& spine, const Pose& from, const Pose& to,
                      std::span<const ContactPlane> planes);

/// Where the axis of a tuft that touches meets the surface, and the hair that stands round it there
/// while not all of it has been drawn to the side where the spine lies.
struct UprightHair {
    Vec3 centre{0};     ///< metres, world
    double radius = 0;  ///< metres, of the straight tuft at the height of the surface
    double share = 0;   ///< 1: hair lies on all sides alike … 0: all of it has been drawn to one side
};

/// `tip`: the plane that the tip meets. No share for hair in the air, split, from the query table, or
/// under a ferrule that lies level.
UprightHair upright_hair_of(const Tuft& tuft, const ContactPlane& tip);

}  // namespace tuft::brush
