#pragma once

#include "brush/preset/preset.h"
#include "brush/rod/profile.h"

/// \file
/// Stiffness and radius of a preset's resting tuft along the hair. Every spine model starts from them.
namespace tuft::brush {

/// Returns the stiffness and yield profile of the preset.
Profile profile_of(const Preset& preset);

/// Returns the radius of the resting tuft, metres: 1.06 R (1−u^2.4)^q (1 − 0.14 (1−u)^6), u from root to tip,
/// combined with the tip radius as the root of the sum of squares. Of foam: its radius, and the rounding of its rim.
double rest_radius(const Preset& preset, double u);

}  // namespace tuft::brush
