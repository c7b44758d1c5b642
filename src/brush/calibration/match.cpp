#include "brush/calibration/match.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "brush/calibration/calibrate.h"
#include "brush/calibration/compare.h"
#include "core/error.h"
#include "core/system/parallel.h"

namespace tuft::brush {

namespace {

constexpr int kDepths = 13;  ///< of the sweep that gives all sizes
constexpr int kSizes = 200;  ///< between the least and the greatest

double fit_error_of(std::span<const SweepRow> swept, std::span<const SweepRow> measured) {
    const std::vector<double> depths = depths_of(measured);
    const SweepRow spread = ruler_repeatability(30e-3);
    double sum = 0;
    int count = 0;
    for (const SweepRow& row : measured) {
        const auto at = std::lower_bound(depths.begin(), depths.end(), row.depth) - depths.begin();
        for (double SweepRow::*column : kSweepColumns) {
            if (std::isnan(row.*column)) continue;
            sum += std::pow((swept[static_cast<std::size_t>(at)].*column - row.*column) / (spread.*column), 2);
            ++count;
        }
    }
    return count > 0 ? std::sqrt(sum / count) : 0;
}

/// Depths of the sweep, 0 to `deepest`: closer where the line is thin and its width grows fastest.
double depth_of(std::size_t k, double deepest) {
    const double part = static_cast<double>(k) / (kDepths - 1);
    return deepest * part * part;
}

/// The sweep at a depth between those of `grid`.
SweepRow between(std::span<const SweepRow> grid, double deepest, double depth) {
    const double at = std::sqrt(std::clamp(depth / deepest, 0.0, 1.0)) * (kDepths - 1);
    const auto k = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(kDepths - 2));
    const double from = depth_of(k, deepest), to = depth_of(k + 1, deepest);
    SweepRow row{depth};
    for (double SweepRow::*column : kSweepColumns)
        row.*column = std::lerp(grid[k].*column, grid[k + 1].*column, (depth - from) / (to - from));
    return row;
}

BrushMatch match_of(const Preset& preset, std::span<const SweepRow> measured, std::span<const SweepRow> grid) {
    const std::vector<double> depths = depths_of(measured);
    const double deepest = kDeepestMatch * preset.length;
    BrushMatch out{.name = preset.name, .sized_fit_error = std::numeric_limits<double>::infinity()};
    if (depths.back() <= deepest) {
        const std::vector<SweepRow> swept = sweep_depth(preset, depths);
        out.rms = rms_difference(swept, measured);
        out.fit_error = fit_error_of(swept, measured);
    }
    for (int i = 0; i <= kSizes; ++i) {
        const double f = kLeastSize * std::pow(kMostSize / kLeastSize, static_cast<double>(i) / kSizes);
        if (depths.back() > f * deepest) continue;
        std::vector<SweepRow> swept;
        for (const double depth : depths) {
            swept.push_back(between(grid, deepest, depth / f));
            for (double SweepRow::*column : kSweepColumns) swept.back().*column *= f;
        }
        const double fit_error = fit_error_of(swept, measured);
        if (fit_error < out.sized_fit_error) std::tie(out.sized_fit_error, out.size) = std::pair(fit_error, f);
    }
    if (out.fit_error <= out.sized_fit_error) std::tie(out.sized_fit_error, out.size) = std::pair(out.fit_error, 1.0);
    return out;
}

}  // namespace

std::vector<BrushMatch> match_brushes(std::span<const std::string> names, std::span<const SweepRow> measured,
                                      const ProgressFn& progress) {
    std::vector<BrushMatch> out;
    for (const std::string& name : names) {
        report(progress, "matching", static_cast<double>(out.size()) / static_cast<double>(names.size()));
        const Preset preset = load_preset(name);
        std::vector<SweepRow> grid(kDepths);
        parallel_for(grid.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k)
                grid[k] = sweep_at(preset, depth_of(k, kDeepestMatch * preset.length)).row;
        });
        out.push_back(match_of(preset, measured, grid));
    }
    std::stable_sort(out.begin(), out.end(), [](const BrushMatch& a, const BrushMatch& b) {
        return std::tie(a.fit_error, a.sized_fit_error, a.name) < std::tie(b.fit_error, b.sized_fit_error, b.name);
    });
    return out;
}

}  // namespace tuft::brush
