#pragma once

#include "stroke/gesture/hand_filter.h"
#include "stroke/gesture/hand_pressure.h"
#include "stroke/journal/entry/settings.h"

/// \file
/// Samples of a stroke as its settings change them: filter, then string, then roll from motion (roll.h), then pressure
/// from motion. Called before a stroke meets the model; the journal stores the samples unchanged.
namespace tuft::stroke {

/// Steadies a whole flat trace. The filter runs forwards and backwards, so that nothing lags and both ends stay. At the
/// end of the string the tip catches up with the hand.
StrokeSamples steady(StrokeSamples trace, const StrokeSettings& settings);

/// Filter and string for poses in space, one after the other. Their depth is their pressure.
struct GestureFilter {
    HandFilter filter;
    String string;
};
/// Returns the next pose, steadied.
brush::Pose steady(GestureFilter& state, const brush::Pose& pose, const StrokeSettings& settings);

}  // namespace tuft::stroke
