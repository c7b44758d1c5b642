#pragma once

#include "stroke/gesture/hand_filter.h"
#include "stroke/gesture/hand_pressure.h"
#include "stroke/journal/journal.h"

/// What a stroke's settings do to the hand before it meets the model: filter, then string,
/// then pressure from motion. The journal keeps the hand as it was.
namespace tuft::stroke {

/// A flat trace, all at once: the filter runs to its end and back again, so that nothing lags
/// and both ends stay; where the string ends, the tip catches up with the hand.
Trace steady(Trace trace, const Settings& settings);

/// Poses in space as they come. Filter and string only: a pose has its depth.
struct GestureFilter {
    HandFilter filter;
    String string;
};
brush::Pose steady(GestureFilter& state, const brush::Pose& pose, const Settings& settings);

}  // namespace tuft::stroke
