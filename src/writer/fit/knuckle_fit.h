#pragma once

#include "writer/fit/ink_fit.h"

/// \file
/// Takes knuckles off a fitted stroke. Called by `fit_stations`.
namespace tuft::writer {

/// Returns the stations with the fewest knuckles among those of `fitted` with heads, corners and tails moved where a
/// knuckle is. Near each, until it is gone, the path moves by 3 units away from a swelling, or by 3 or 6 towards it,
/// and by 3 towards a neck; the half width changes by an eighth; a head begins sooner, later or to the side. What is
/// kept raises
///
///     score − 0.01 Σ |curvature| / kKnuckle  over the knuckles,
///
/// `score` as in `fit_stations`. Knuckles under other strokes do not count. At most `options.knuckle_tries` drawings
/// with `drawing`; one where the stroke has no knuckle. A path is drawn as far as it differs from the one before
/// (`PlaneDrawing::draw_part`), and to its end where that is better. The last trace that `drawing` has drawn to its end
/// is that of the result. Deterministic.
FitResult take_off_knuckles(FitResult fitted, const FitTarget& target, const std::vector<float>& depths,
                            const BrushHand& hand, const Pace& pace, const FitOptions& options,
                            stroke::PlaneDrawing& drawing);

}  // namespace tuft::writer
