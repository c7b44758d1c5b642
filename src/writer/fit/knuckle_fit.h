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
/// Each number is changed once, by a unit, and the part of the stroke from 16 units before the change to 40 after it
/// drawn anew: the tuft is bent up to there once. By the distances from the edges of those drawings it is foretold
/// where the ink's edge would lie (`EdgeResponse`), and there a compass search, in steps of 4 to 0.5 units, looks for
/// the largest score less 0.002 times `sharpness_of`. What it finds is drawn, the response learns from that, and it
/// looks again: four times, or until the knuckle is gone. A change that makes the whole stroke no better is not taken.
/// Cost: ten such drawings a knuckle, 5 ms each. Deterministic.
void take_off_knuckles(FitResult& fitted, const KnuckleTarget& target, const BrushHand& hand, const Pace& pace,
                       const FitOptions& options);

}  // namespace tuft::writer
