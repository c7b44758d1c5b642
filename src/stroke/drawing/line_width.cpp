#include "stroke/drawing/line_width.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

#include "brush/calibration/sweep.h"
#include "core/ease.h"
#include "stroke/gesture/tractrix.h"
#include "stroke/placement/holder.h"
#include "stroke/placement/placement.h"
#include "stroke/placement/tip_lag.h"

namespace tuft::stroke {

namespace {

constexpr int kSteps = 12;
constexpr double kMidPressure = 0.5;          // made-up pressure of a line's whole width
constexpr double kEase = 0.36;                // in that of a brush chosen for a width: corners come out best
constexpr double kLight = 0.3, kHeavy = 0.7;  // a pressure between them draws lines with the brush that is there

}  // namespace

LineWidths::LineWidths(const brush::Preset& preset) : knots_{{0, 0}} {
    std::vector<double> pressures{kLightest}, depths;
    for (int i = 1; i <= kSteps; ++i) pressures.push_back(static_cast<double>(i) / kSteps);
    for (const double p : pressures) depths.push_back(p * working_depth(preset));
    const std::vector<brush::SweepRow> rows = brush::sweep_depth(preset, depths);
    for (std::size_t i = 0; i < rows.size(); ++i)
        knots_.push_back({pressures[i], std::max(knots_.back().width, rows[i].width + 2 * kSkinFilm)});
}

double LineWidths::at(double pressure) const {
    const double p = std::clamp(pressure, 0.0, 1.0);
    std::size_t i = 1;
    while (i + 1 < knots_.size() && knots_[i].pressure < p) ++i;
    const Knot &a = knots_[i - 1], &b = knots_[i];
    return std::lerp(a.width, b.width, (p - a.pressure) / (b.pressure - a.pressure));
}

double LineWidths::pressure(double width) const {
    const auto above = std::find_if(knots_.begin() + 1, knots_.end(), [&](const Knot& k) { return k.width >= width; });
    if (above == knots_.end()) return 1;
    const Knot& below = *(above - 1);
    const double rise = above->width - below.width;
    const double part = rise > 0 ? std::max(0.0, width - below.width) / rise : 0;
    return std::max(kLightest, std::lerp(below.pressure, above->pressure, part));
}

const LineWidths& WidthTables::of(const std::string& brush) {
    const auto at = known_.find(brush);
    return at != known_.end() ? at->second : known_.emplace(brush, preset(brush)).first->second;
}

const brush::Preset& WidthTables::preset(const std::string& brush) {
    const auto at = presets_.find(brush);
    return at != presets_.end() ? at->second : presets_.emplace(brush, brush::load_preset(brush)).first->second;
}

const HolderOptions& WidthTables::holder(const std::string& brush) {
    const auto at = holds_.find(brush);
    if (at != holds_.end()) return at->second;
    HolderOptions options = holder_options(preset(brush));
    // A hand that sets down pressed leans ahead. Copies of the options may outlive the tables.
    const auto tilted = std::make_shared<TiltedTipLag>(preset(brush));
    options.tip_lag = tilted->as_held();
    options.tip_lag_change = [tilted](double depth, const Vec2& lean, double turn) {
        return tilted->at(depth, lean, turn);
    };
    return holds_.emplace(brush, std::move(options)).first->second;
}

std::string brush_for_width(const std::string& name, const LineWidths& widths, double width) {
    if (width >= widths.at(kLight) && width <= widths.at(kHeavy)) return name;
    const brush::SizedName sized = brush::sized_name(name);
    const double hair = widths.at(kEase) - 2 * kSkinFilm;  // the ink round it is the same for all sizes
    const double factor =
        std::clamp(sized.factor * (width - 2 * kSkinFilm) / hair, brush::kLeastSize, brush::kMostSize);
    return brush::name_of({sized.base, std::pow(kBrushSizes, std::round(std::log(factor) / std::log(kBrushSizes)))});
}

namespace {

constexpr double kEnd = 1.5;          // line widths over which a hand sets down and lifts
constexpr double kMostOfLine = 0.25;  // of the line at most
constexpr double kPoint = 0.4;        // part of the width that the line has at its very ends

/// A line that ends where it began goes on along itself for `more` metres, at the same pace.
void overlap(StrokeSamples& trace, double more) {
    std::vector<StrokeSample>& s = trace.samples;
    const std::vector<double> along = travelled<StrokeSample>(s);
    const std::size_t n = s.size();
    if (n < 4 || glm::length(s.back().position - s.front().position) > 1e-6 * along.back()) return;
    const double ends = s.back().time, begins = s.front().time;
    for (std::size_t i = 1; i < n; ++i) {
        StrokeSample next = s[i];
        const double part = std::min(1.0, (more - along[i - 1]) / std::max(along[i] - along[i - 1], 1e-12));
        next.position = glm::mix(s[i - 1].position, s[i].position, part);
        next.time = ends + std::lerp(s[i - 1].time, s[i].time, part) - begins;
        s.push_back(next);
        if (part < 1 || along[i] >= more) break;
    }
}

}  // namespace

double line_end(double width) {
    return kEnd * width;
}

void add_extent(Box& box, const StrokeSamples& trace) {
    for (const StencilEdge& edge : trace.stencil) box.add(Vec3(edge.from, 0)), box.add(Vec3(edge.to, 0));
    if (!trace.stencil.empty()) return;
    for (const auto& ring : trace.outline)
        for (const Vec2& p : ring) box.add(Vec3(p, 0));
    if (!trace.outline.empty()) return;
    const Vec3 beside = 0.5 * trace.line_width * Vec3(1, 1, 0);
    for (const StrokeSample& sample : trace.samples)
        box.add(sample.position - beside), box.add(sample.position + beside);
}

void draw_to_width(StrokeSamples& trace, const LineWidths& widths) {
    if (trace.samples.empty()) return;
    const double whole = travelled<StrokeSample>(trace.samples).back();
    const double end = std::min(line_end(trace.line_width), kMostOfLine * whole);
    overlap(trace, 2 * end);
    const std::vector<double> along = travelled<StrokeSample>(trace.samples);
    const auto part = [&](const StrokeSample& s) { return s.pressure / kMidPressure; };
    const bool head = part(trace.samples.front()) > kPoint,
               tail = part(trace.samples.back()) > kPoint;  // else it runs out by itself
    for (std::size_t i = 0; i < along.size(); ++i) {
        double near = 1e30;
        if (head) near = along[i];
        if (tail) near = std::min(near, along.back() - along[i]);
        const double ends = end > 0 ? std::lerp(kPoint, 1.0, smooth_step(near / end)) : 1;
        trace.samples[i].pressure = widths.pressure(trace.line_width * std::min(1.0, part(trace.samples[i])) * ends);
    }
}

}  // namespace tuft::stroke
