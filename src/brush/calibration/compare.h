#pragma once

#include <span>
#include <vector>

#include "brush/calibration/sweep.h"

/// \file
/// All spine methods of one brush beside a measured sweep. Called by `tuft brush --compare`; `calibrate` shares the
/// error.
namespace tuft::brush {

/// Returns the depths of a measured table, metres, rising, each once.
std::vector<double> depths_of(std::span<const SweepRow> measured);

/// Returns the root mean square difference of each column between the rows of `swept` and the measured ones of the
/// same depth; NaN where no row has the column; `depth` is unused. Precondition: `swept` has a row for each of
/// `depths_of(measured)`, in that order.
SweepRow rms_difference(std::span<const SweepRow> swept, std::span<const SweepRow> measured);

/// One spine method's sweep of a brush.
struct ModelSweep {
    SpineMethod method = SpineMethod::rod;
    std::vector<SweepRow> rows;  ///< one per depth of `depths_of`
    SweepRow rms;                ///< `rms_difference`
    /// Spine at the greatest depth, tip first: metres ahead of the axis' foot, metres over the sheet.
    std::vector<Vec2> spine;
};

/// Returns the sweep of each method that can bend such a tuft (`can_bend`) with the constants of `preset`, in the order
/// of `SpineMethod`. Nothing is fitted.
/// Cost: a fraction of a second.
std::vector<ModelSweep> compare_models(const Preset& preset, std::span<const SweepRow> measured);

}  // namespace tuft::brush
