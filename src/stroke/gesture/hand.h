#pragma once

#include "stroke/gesture/hand_filter.h"
#include "stroke/gesture/hand_pressure.h"
#include "stroke/journal/settings.h"

/// What a stroke's settings do to the hand before it meets the model: filter, then string,
/// then roll from motion (roll.h), then pressure from motion. The journal keeps the hand as it was.
namespace tuft::stroke {

/// A flat trace, all at once: the filter runs to its end and back again, so that nothing lags
/// and both ends stay; where the string ends, the tip catches up with the hand.
StrokeSamples steady(StrokeSamples trace, const StrokeSettings& settings);

/// Poses in space as they come. Filter and string only: a pose has its depth.
struct GestureFilter {
    HandFilter filter;
    String string;
};
brush::Pose steady(GestureFilter& state, const brush::Pose& pose, const StrokeSettings& settings);

}  // namespace tuft::stroke
