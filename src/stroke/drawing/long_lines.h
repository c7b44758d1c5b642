#pragma once

#include <vector>

#include "stroke/drawing/line_width.h"
#include "stroke/journal/trace.h"

/// \file
/// Lines that need more ink than a brush holds: larger brushes for them, and where the hand
/// dips again.
namespace tuft::stroke {

/// Metres of a line `width` metres wide that a full brush draws before gaps show:
///
///     L = 0.28 V / (film · width),
///
/// V its capacity in m³ and `film` the thickness in metres that the ink leaves. The rest stays in
/// the hair: measured, first gaps show when 0.65 of the ink are gone under a firm hand, 0.32 under
/// a light one, which draws with the tip alone.
double whole_length(const brush::Preset& preset, double width, double film);

/// The brush for a line `width` metres wide and `length` metres long: `brush_for_width` where that
/// draws it whole, else the smallest larger size (powers of `kBrushSizes`) that does and still presses by a
/// pressure of 0.3 or more for the width, else the largest such size. Only where its supply time is
/// 30 s or more: so large a brush touches with its tip alone. `name` is of the size that brushes
/// are made in; `film` in metres, `speed` in m/s.
std::string brush_for_line(const std::string& name, WidthTables& widths, double width, double length, double film,
                           double speed);

/// Seconds in which a full brush would give all of its ink to a line `width` metres wide at
/// `speed`, V / (film · width · speed). Under kSteadySupply ink comes to the tip of the hair more
/// slowly than it leaves it, and gaps show at once.
double supply_time(const brush::Preset& preset, double width, double film, double speed);
inline constexpr double kSteadySupply = 22;

/// Slows a trace with a made-up pace down, all of it alike, until its supply time is kSteadySupply
/// or more.
void pace_line(Trace& trace, const brush::Preset& preset, double film);

/// Metres of a flat trace along its samples.
double length_of(const Trace& trace);

/// Cuts a flat trace into pieces of about the same length, `longest` metres at most where that
/// leaves no piece shorter than four overlaps. A piece begins `overlap` metres before the end of
/// the one before it; each cut is made where the line is bent least within a tenth of a piece of
/// its even place. Of a line that ends where it began the last piece goes on over the beginning by
/// as much. Times begin at 0 in each piece. A line that need not be cut comes back as it is.
std::vector<Trace> cut_line(const Trace& trace, double longest, double overlap);

}  // namespace tuft::stroke
