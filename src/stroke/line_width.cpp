#include "stroke/line_width.h"

#include <algorithm>
#include <cmath>

#include "brush/sweep.h"
#include "stroke/placement.h"

namespace tuft::stroke {

namespace {

constexpr int kSteps = 12;
constexpr double kMiddle = 0.5;               // of made-up pressures
constexpr double kLight = 0.1, kHeavy = 0.7; // between them a hand draws lines at ease
constexpr double kSizes = 1.25;              // from one size to the next: few brushes for many widths

}  // namespace

LineWidths::LineWidths(const brush::Preset& preset) : widths_(kSteps + 1, 0.0) {
    std::vector<double> depths;
    for (int i = 1; i <= kSteps; ++i) depths.push_back(working_depth(preset) * i / kSteps);
    const std::vector<brush::SweepRow> rows = brush::sweep_depth(preset, depths);
    for (std::size_t i = 0; i < rows.size(); ++i) widths_[i + 1] = std::max(widths_[i], rows[i].width + 2 * kSkinFilm);
}

double LineWidths::at(double pressure) const {
    const double x = std::clamp(pressure, 0.0, 1.0) * kSteps;
    const auto i = std::min(static_cast<std::size_t>(x), widths_.size() - 2);
    return std::lerp(widths_[i], widths_[i + 1], x - static_cast<double>(i));
}

double LineWidths::pressure(double width) const {
    const auto above = std::find_if(widths_.begin() + 1, widths_.end(), [&](double w) { return w >= width; });
    if (above == widths_.end()) return 1;
    const double below = *(above - 1), rise = *above - below;
    const double part = rise > 0 ? std::max(0.0, width - below) / rise : 0;
    return std::max(kLightest, (static_cast<double>(above - 1 - widths_.begin()) + part) / kSteps);
}

const LineWidths& WidthTables::of(const std::string& brush) {
    const auto at = known_.find(brush);
    return at != known_.end() ? at->second : known_.emplace(brush, brush::load_preset(brush)).first->second;
}

std::string brush_for_width(const std::string& name, const LineWidths& widths, double width) {
    if (width >= widths.at(kLight) && width <= widths.at(kHeavy)) return name;
    const brush::SizedName sized = brush::sized_name(name);
    const double hair = widths.at(kMiddle) - 2 * kSkinFilm;  // the ink round it is the same for all sizes
    const double factor = std::clamp(sized.factor * (width - 2 * kSkinFilm) / hair, brush::kLeastSize, brush::kMostSize);
    return brush::name_of({sized.base, std::pow(kSizes, std::round(std::log(factor) / std::log(kSizes)))});
}

void press_to_width(Trace& trace, const LineWidths& widths) {
    const double factor = widths.pressure(trace.line_width) / kMiddle;
    for (TraceSample& s : trace.samples) s.pressure = std::min(1.0, factor * s.pressure);
}

}  // namespace tuft::stroke
