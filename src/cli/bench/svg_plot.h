#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// Plots as SVG texts, for the page of `tuft bench`.
namespace tuft::cli {

/// One line of a plot.
struct PlotSeries {
    std::string name;
    std::vector<Vec2> points;  ///< ascending in x
};

/// A plot of several lines over common axes.
struct Plot {
    std::string title, x_label, y_label;
    bool log_x = false, log_y = false;
    bool from_zero = true;  ///< a linear y axis begins at 0
    std::vector<PlotSeries> series;
};

/// Returns lines with a mark at every point, axes at round numbers, and the names of the series. Values that are not
/// finite, or not above 0 on a logarithmic axis, are left out.
std::string svg_of(const Plot& plot);

/// Returns bars, each with its name and value.
std::string svg_bars(const std::string& title, const std::string& unit,
                     const std::vector<std::pair<std::string, double>>& bars);

}  // namespace tuft::cli
