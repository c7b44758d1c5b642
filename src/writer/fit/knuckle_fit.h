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
/// About the station c that is nearest to a knuckle, or about the first where it is within 60 units of that, six
/// numbers change the path within 48 units of c. With s the length from c, w = max(0, 1 − |s| / 48) and
/// u = ±4 w (1 − w), negative before c,
///
///     centre += (w² a + u d) left + (w² b + u e) ahead,   half += w² f + u g  (d, e, g turn and a, b, f move it; a dot
///
/// Compass search over the six, steps of 4, 2 and 1 units, for the largest score less 0.003 times `sharpness_of`. Only
/// the part of the stroke from 24 units before the change to 60 after it is drawn: the tuft is bent up to there once.
/// Cost: about 25 such drawings a knuckle, 5 ms each. Deterministic.
void take_off_knuckles(FitResult& fitted, const KnuckleTarget& target, const BrushHand& hand, const Pace& pace,
                       const FitOptions& options);

}  // namespace tuft::writer
