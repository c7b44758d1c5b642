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

/// Fits stations to a wanted area.
///
/// Each try draws the path on a plane (`stroke::plane_ink`) in the target's cells. A wrong cell (missing +, extra −)
/// goes to the left or right of its nearest station, as area over station spacing; extra ink that another station, more
/// than 60 units along the path, covered first lifts that one. Extra ink beyond the head that another station than the
/// first covered first lifts that station too; other cells beyond an end change the length. Smoothed over two stations,
/// the path moves by 0.6 · ½ (left − right) and the half width grows by 0.5 · ½ (left + right) less the kick. Half
/// widths stay below 16 units + the distance to the nearer tip. Cost: 0.1 ms per pose. Deterministic.
///
/// The best try is that of the largest score B / (B + Σ w d / 4): B cells are covered rightly, and a wrong cell of
/// weight w lies d ≤ 24 units on the wrong side of the edge. A lump counts more than a rim of the same area. Where the
/// best try overlaps by less than `options.weak`, it begins again in another manner (left and right are those of the
/// first path, and the first three stations move as one), and from `other`, if that is not empty, in both. A begin in a
/// manner ends early where its score is above 0.98 and a try gains less than 0.002, and where after t tries it is
/// behind the best of the others by more than 0.06 / t. At last the path is corrected in steps nearly as fine as those
/// of painting, smoothed over at most 1.2 stations; of these drawings the one is kept that has the largest score less
/// 0.002, or 0.0015 with `options.fair`, times `sharpness_of`, a sum over its knuckles. Those that are left are taken
/// off one by one (`take_off_knuckles`).
///
/// With `options.fair` the path and its half widths are made fair after each correction (`make_fair`), and wanted cells
/// that no disc within the area reaches weigh a tenth: discs of 0.9 half widths, less what exceeds a multiple of 4
/// units, at most 32 units. Overlap and score count those cells so too, also against `options.weak`: results of fair
/// and other fits do not compare.
FitResult fit_stations(const std::vector<Station>& stations, const FitTarget& target, const BrushHand& hand,
                       const Pace& pace, const FitOptions& options = {}, const std::vector<Station>& other = {});

/// Returns the ink of stations on a plane, in cells of `cell` units.
stroke::PlaneInk draw_on_plane(std::span<const Station> stations, const BrushHand& hand, const Pace& pace, double step,
                               double cell);

}  // namespace tuft::writer
