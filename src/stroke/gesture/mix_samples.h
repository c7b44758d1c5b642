#pragma once

#include <cmath>

#include "stroke/gesture/roll.h"
#include "stroke/journal/entry/samples.h"

/// \file
/// A sample between two samples of a path. Called where paths are cut, resampled and led anew.
namespace tuft::stroke {

/// Returns the flat sample at the part t, 0–1, of the way from a to b: all linear, the roll by its shortest turn.
inline StrokeSample mix_samples(const StrokeSample& a, const StrokeSample& b, double t) {
    StrokeSample out = b;
    out.time = std::lerp(a.time, b.time, t);
    out.position = glm::mix(a.position, b.position, t);
    out.pressure = std::lerp(a.pressure, b.pressure, t);
    out.tilt = glm::mix(a.tilt, b.tilt, t);
    out.roll = mix_roll(a.roll, b.roll, t);
    return out;
}

}  // namespace tuft::stroke
