#pragma once

#include <vector>

#include "stroke/pointer/pointer_input.h"

/// \file
/// Recorded samples of a hand, painted as the pointer of the window paints them. Called by `tuft paint --as-pointer`.
namespace tuft::stroke {

/// Returns the aims of a flat trace at a model with these bounds: parallel rays along right × down of its placement
/// from outside, in order of time. `pixel`: metres at the model. The aims have a pen's pressure and tilt where `pen`.
/// Throws `Error` for directions of the placement that are zero or parallel.
std::vector<Aim> aims_of(const StrokeSamples& trace, const Box& bounds, double pixel, bool pen);

/// Returns what a pointer that goes along `aims` paints: traces in space, more than one where it leaves the model or
/// crosses an edge of its outline. The last aim is that of the release.
std::vector<StrokeSamples> draw_with_pointer(PointerInput pointer, const std::vector<Aim>& aims);

}  // namespace tuft::stroke
