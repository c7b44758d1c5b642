#pragma once

#include <vector>

#include "stroke/drawing/line_width.h"
#include "stroke/journal/entry/samples.h"

/// \file
/// Lines that need more ink than a brush holds: larger brushes, slower strokes, and cuts where the hand dips again.
/// Called by `redip_long_lines` and `choose_brushes`.
namespace tuft::stroke {

/// Returns the length of a line `width` metres wide that a full brush draws before gaps show, metres:
///
///     L = 0.28 V / (film · width),
///
/// with V its capacity in m³ and `film` the thickness of the ink in metres. The rest stays in the hair. Measured: first
/// gaps show when 65 % of the ink are gone under firm pressure, 32 % under light pressure, where the tip alone draws.
double whole_length(const brush::Preset& preset, double width, double film);

/// Returns the brush for a line `width` metres wide and `length` metres long: `brush_for_width` if it draws the line
/// without gaps, else the smallest larger size (powers of `kBrushSizes`) that does so at a pressure of at least 0.3,
/// else the largest size with such a pressure. Only sizes with a supply time of at least 30 s: a large brush touches
/// with its tip alone. `name` is an unscaled preset; `film` in metres, `speed` in m/s.
std::string brush_for_line(const std::string& name, WidthTables& widths, double width, double length, double film,
                           double speed);

/// Returns the time in which a full brush would give all of its ink to a line at `speed` (m/s), seconds:
/// V / (film · width · speed). Below `kSteadySupply` ink leaves the tip faster than it flows there, and gaps show at
/// once.
double supply_time(const brush::Preset& preset, double width, double film, double speed);
inline constexpr double kSteadySupply = 22;

/// Slows a trace with made-up times down, uniformly, until its supply time is at least `kSteadySupply`.
void pace_line(StrokeSamples& trace, const brush::Preset& preset, double film);

/// Returns the length of a flat trace along its samples, metres.
double length_of(const StrokeSamples& trace);

/// Cuts a flat trace into pieces of about equal length, at most `longest` metres unless pieces would be shorter than
/// four overlaps. A piece begins `overlap` metres before the end of the one before. Each cut lies where curvature is
/// least within a tenth of a piece of its even position. The last piece of a closed line continues over its beginning
/// by `overlap`. Times begin at 0 in each piece. A line that is short enough is returned unchanged.
std::vector<StrokeSamples> cut_line(const StrokeSamples& trace, double longest, double overlap);

}  // namespace tuft::stroke
