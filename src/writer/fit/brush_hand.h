#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "stroke/drawing/line_width.h"
#include "writer/gesture/sides.h"

/// \file
/// The hand that moves a brush along stations: pressure from the wanted width and time from the curvature. Called by
/// ink_fit.h and by writer/layout.
namespace tuft::writer {

/// A brush over a plane and the size of the character that it writes. The tables must outlive it.
struct BrushHand {
    const brush::Preset& preset;
    const stroke::LineWidths& widths;
    const stroke::HolderOptions& hold;
    double unit = 1e-4;  ///< metres per unit of the character
};

/// Pace of a hand, by the two-thirds law [Lacquaniti1983]:
///
///     v = speed · min(1, (κ · radius)^(−1/3)) · e,
///
/// with κ the curvature of the path and e rising from `ends` to 1 over `ease` at the head and at blunt ends.
struct Pace {
    double speed = 0.06;  ///< m/s
    double radius = 150;  ///< units
    double ends = 0.3;    ///< part of the speed
    double ease = 40;     ///< units
    /// Units to either side of the path over which a head is set down, from the left to the right; 0: along the path.
    double across = 1;
    double touch = 0.05;  ///< pressure of that, at most that of the head's width
    /// Radians by which the holder leans back along the path, by the code of a segment; others: upright.
    /// Of a brush whose make leans (`HolderOptions::lean`): as it is held.
    std::map<char, double> lean;
    double roll = 0;  ///< radians, of the holder
};

/// Returns the flat samples of a hand along stations, metres, y down: pressures that draw the widths
/// (`LineWidths::pressure`, below the least width in proportion to 0), the holder leaning as `pace.lean` says (upright
/// throughout where it names no segment of the stroke: `stroke::lean_holder` leans a make then), and a last sample
/// where the tip leaves. Before the station of the head the brush is set down across the path: its hair lies across,
/// and rounds the head. A tuft that is set down along the path leaves a point as thin as its tip. At corners the lean
/// goes over from one segment to the next within `pace.ease`. Frame: the character's square, origin at its lower left
/// corner, so y is negative within it.
stroke::StrokeSamples samples_of(std::span<const Station> stations, const BrushHand& hand, const Pace& pace = {});

}  // namespace tuft::writer
