#pragma once

#include <span>
#include <vector>

#include "writer/fit/ink_fit.h"
#include "writer/gesture/knuckles.h"

/// \file
/// How well ink covers a wanted area. Called by the parts of the fit.
namespace tuft::writer {

inline constexpr double kTaken = 0.5;  ///< coverage above which a cell is ink

/// What a score is made of: B, B + Σ w and Σ w d / 4.
struct InkSums {
    double both = 0, either = 0, deep = 0;
};

/// Agreement of ink with a wanted area; both are 1 where they are the same.
struct InkScore {
    double iou = 0;    ///< B / (B + Σ w)
    double score = 0;  ///< B / (B + Σ w d / 4)
};

/// Returns the coverage of cells by ink. [cells] Precondition: the ink has the same cells, with `lo` a
/// corner of one, as `cells_over` makes them.
std::vector<float> coverage_by(const stroke::PlaneInk& ink, const Cells& cells);

/// Returns the agreement of ink with a target: B cells are covered rightly, and the sums are over those covered
/// wrongly, each of weight w and d units from the edge. `depths`, `coverage`: [cells of the target].
InkScore score_of(const FitTarget& target, std::span<const float> depths, std::span<const float> coverage);

/// Returns the sums for a part of the cells or all, of which a score is made.
InkSums sums_of(const FitTarget& target, std::span<const float> depths, std::span<const float> coverage);
InkScore score_of(const InkSums& sums);

/// Returns the turns of an area by which the knuckles of ink on it are recognised.
std::vector<EdgeTurn> wanted_edge_turns(const Cells& wanted);

/// Returns the knuckles of ink, `wanted_edge_turns` given, but for those under other strokes, where errors weigh less
/// than 1 and are not seen.
std::vector<EdgeTurn> seen_knuckles(const FitTarget& target, std::span<const EdgeTurn> turns,
                                    std::span<const float> coverage);

/// Returns Σ min(|curvature| / kKnuckle, 4) over knuckles.
double sharpness_of(std::span<const EdgeTurn> knuckles);

/// Returns that of the seen knuckles of ink.
double sharpness_of(const FitTarget& target, std::span<const EdgeTurn> turns, std::span<const float> coverage);

}  // namespace tuft::writer
