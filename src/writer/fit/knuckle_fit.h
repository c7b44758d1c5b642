#pragma once

#include <vector>

#include "writer/fit/ink_fit.h"

/// \file
/// Knuckles taken off a fitted stroke, one by one. Called at the end of the fit: a correction of the whole path would
/// make them again.
namespace tuft::writer {

/// What a stroke is to cover.
struct KnuckleTarget {
    const FitTarget& target;           ///< by which the fit scores: corners that no print reaches weigh little
    const FitTarget& whole;            ///< the same with all its corners, by which knuckles are told
    const std::vector<float>& depths;  ///< of each cell of the target from its edge, units
};

/// Takes knuckles off, at most four, the sharpest first.
///
/// About the station m that is nearest to a knuckle, or about the first where it is within 60 units of that, six
/// numbers change the path within 48 units of m. With s the length from m, w = max(0, 1 − |s| / 48) and
/// u = ±4 w (1 − w), negative before m,
///
///     centre += (w² a + u b) left + (w² c + u d) ahead,   half += w² e + u f.
///
/// Compass search over the six, steps of 4, 2 and 1 units, for the largest score less 0.0015 times `sharpness_of`; it
/// ends with the round in which the knuckle is gone. Only the part of the stroke from 16 units before the change to 40
/// after it is drawn anew: the tuft is bent up to there once. A change that makes the whole stroke no better is not
/// taken. Cost: about 30 such drawings a knuckle, 5 ms each. Deterministic.
void take_off_knuckles(FitResult& fitted, const KnuckleTarget& target, const BrushHand& hand, const Pace& pace,
                       const FitOptions& options);

}  // namespace tuft::writer
