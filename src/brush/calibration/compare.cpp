#include "brush/calibration/compare.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "core/system/parallel.h"

namespace tuft::brush {

std::vector<double> depths_of(std::span<const SweepRow> measured) {
    std::vector<double> depths;
    for (const SweepRow& row : measured) depths.push_back(row.depth);
    std::sort(depths.begin(), depths.end());
    depths.erase(std::unique(depths.begin(), depths.end()), depths.end());
    return depths;
}

SweepRow rms_difference(std::span<const SweepRow> swept, std::span<const SweepRow> measured) {
    const std::vector<double> depths = depths_of(measured);
    SweepRow rms;
    for (double SweepRow::*column : kSweepColumns) {
        int count = 0;
        for (const SweepRow& row : measured) {
            if (std::isnan(row.*column)) continue;
            const auto at = std::lower_bound(depths.begin(), depths.end(), row.depth) - depths.begin();
            const double d = swept[static_cast<std::size_t>(at)].*column - row.*column;
            rms.*column += d * d;
            ++count;
        }
        rms.*column = count > 0 ? std::sqrt(rms.*column / count) : std::numeric_limits<double>::quiet_NaN();
    }
    return rms;
}

std::vector<ModelSweep> compare_models(const Preset& preset, std::span<const SweepRow> measured) {
    const std::vector<double> depths = depths_of(measured);
    std::vector<ModelSweep> models;
    for (std::size_t m = 0; m < std::size(kSpineWords); ++m)
        if (const auto method = static_cast<SpineMethod>(m); can_bend(method, preset))
            models.push_back({.method = method, .rows = std::vector<SweepRow>(depths.size()), .rms = {}, .spine = {}});
    parallel_for(models.size() * depths.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            ModelSweep& model = models[k / depths.size()];
            const std::size_t at = k % depths.size();
            Preset p = preset;
            p.spine = model.method;
            SteadyTuft steady = sweep_at(p, depths[at]);
            model.rows[at] = steady.row;
            if (at + 1 == depths.size()) model.spine = std::move(steady.spine);
        }
    });
    for (ModelSweep& model : models) model.rms = rms_difference(model.rows, measured);
    return models;
}

}  // namespace tuft::brush
