#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "brush/calibration/sweep.h"
#include "core/system/progress.h"

/// \file
/// Ranking of brushes by how well they draw measured lines. Called by `tuft brush match`.
namespace tuft::brush {

/// A brush beside a measured table.
struct BrushMatch {
    std::string name;
    /// Root mean square difference of each column, metres; NaN where not measured or not reached (depth unused).
    SweepRow rms{0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN(),
                 std::numeric_limits<double>::quiet_NaN()};
    /// Root of the mean over the measured cells of ((model − measured) / s)², s by `ruler_repeatability` of 30 mm.
    /// Infinite where the brush cannot be pressed as deep as the table.
    double fit_error = std::numeric_limits<double>::infinity();
    double size = 1;             ///< factor in [kLeastSize, kMostSize] at which the brush comes nearest to the table
    double sized_fit_error = 0;  ///< `fit_error` at that size
};

/// Greatest depth over hair length at which a brush is compared.
inline constexpr double kDeepestMatch = 0.6;

/// Returns the presets, nearest first: by fit error, then by fit error at their best size, then by name. A brush of f
/// times the size draws f times the line at f times the depth (`scaled`), so one sweep of 13 depths gives all sizes.
/// Deterministic. Cost: half a minute for all shipped brushes, most of it for the wide ones.
std::vector<BrushMatch> match_brushes(std::span<const std::string> names, std::span<const SweepRow> measured,
                                      const ProgressFn& progress = {});

}  // namespace tuft::brush
