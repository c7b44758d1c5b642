#pragma once

#include <span>
#include <vector>

#include "stroke/drawing/plane_ink.h"
#include "writer/fit/brush_hand.h"
#include "writer/gesture/style.h"

/// \file
/// Correction of a path until the ink of a real brush covers a wanted area (iterative learning control). Called by the
/// writer for every stroke.
namespace tuft::writer {

/// What a stroke is to cover.
struct FitTarget {
    Cells wanted;                ///< with a margin of at least 40 units
    std::vector<float> weights;  ///< of each cell's error, 0–1, as under another stroke; empty: 1

    double weight(std::size_t cell) const { return weights.empty() ? 1 : static_cast<double>(weights[cell]); }
};

/// Options of `fit_stations`.
struct FitOptions {
    int tries = kFitTries;  ///< drawings on the plane at most
    double step = 9.5;      ///< units between poses
    double weak = 0.955;    ///< overlap below which another manner and another begin are tried
    int idle = 4;           ///< tries without a gain after which it stops
    /// Units, in the last drawings: ink depends on the step, by .005 of the overlap from 5 to 1.
    double fine_step = 2.5;
    int last_tries = 3;  ///< drawings after those; each but the first is corrected
    bool fair = true;    ///< the path and its half widths are made fair (`make_fair`), and spikes left as they come
};

/// Result of `fit_stations`.
struct FitResult {
    std::vector<Station> stations;
    double iou = 0;    ///< weighted intersection over union with the wanted area
    double score = 0;  ///< that, with wrong cells counted by their depth
    int tries = 0;
    std::vector<float> inked;  ///< coverage of the target's cells by them, in fine steps
};

/// Fits stations to a wanted area. Each try draws the path on a plane (`stroke::plane_ink`) in the target's cells and
/// corrects it:
///
///     centre += 0.6 · ½ (left − right) n,   half += 0.5 (½ (left + right) − kick)
///
/// n: normal of the path, to the left. left, right: [stations] wrong area (missing +, extra −) beside the nearest
/// station over the spacing of stations, units. kick: [stations] extra ink that a station covered first and that lies
/// more than 60 units along the path from it, or beyond the head. Other wrong cells beyond an end change the length.
/// Corrections are smoothed over two stations; a half width stays below 16 units + the distance to the nearer tip.
///
/// A drawing is judged by the score
///
///     S = B / (B + Σ w d / 4)
///
/// B: cells covered rightly. w: weight of a wrong cell. d: its distance from the edge of the wanted area, at most 24
/// units. So a lump counts more than a rim of the same area.
///
/// Steps:
/// 1. Tries from `stations`, until `options.idle` of them gain nothing, or S > 0.98 and a try gains less than 0.002,
///    or S is behind the best of other begins by 0.06 / t after t tries.
/// 2. While the best overlaps by less than `options.weak`: the same with left and right told by the first path and
///    its first three stations moved as one; then both from `other`, if that is not empty.
/// 3. `options.last_tries` drawings in steps of `options.fine_step`, smoothed over at most 1.2 stations. The one with
///    the largest S less 0.002 `sharpness_of` is kept, 0.0015 with `options.fair`.
/// 4. Knuckles that are left are taken off one by one (`take_off_knuckles`).
///
/// With `options.fair` the path and its half widths are made fair after each correction (`make_fair`), and wanted cells
/// that no disc within the area reaches weigh a tenth: discs of 0.9 half widths, less what exceeds a multiple of 4
/// units, at most 32 units. Overlap and score count those cells so too, also against `options.weak`: results of fair
/// and other fits do not compare.
///
/// Cost: 0.1 ms per pose. Deterministic.
FitResult fit_stations(const std::vector<Station>& stations, const FitTarget& target, const BrushHand& hand,
                       const Pace& pace, const FitOptions& options = {}, const std::vector<Station>& other = {});

/// Returns the ink of stations on a plane, in cells of `cell` units.
stroke::PlaneInk draw_on_plane(std::span<const Station> stations, const BrushHand& hand, const Pace& pace, double step,
                               double cell);

}  // namespace tuft::writer
