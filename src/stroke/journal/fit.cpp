#include "stroke/journal/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "stroke/hand/placement.h"

namespace tuft::stroke {
namespace {

constexpr double kPart = 0.1;       // of the way, that may be lost or buried
constexpr double kMost = 0.5;       // of the way: then no depth is worth telling
constexpr double kDepthPart = 0.5;  // of the depth, that it may change by
constexpr double kLeastChange = 2e-4;  // metres of depth that nobody sees

double median(std::vector<double>& values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

StrokeFit fit_of(const Stroke& stroke, double length, const mesh::SurfaceQuery& former, const mesh::SurfaceQuery& revised) {
    StrokeFit fit{.stroke = stroke.id};
    std::vector<double> depths, changes;
    const std::vector<brush::Pose> poses = spatial_poses(stroke.trace);
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const Vec3 mouth = poses[i].position, axis = poses[i].axis();
        const auto was = former.ray(mouth, axis, 0, length);
        fit.reached = fit.reached || was || former.closest_point(mouth, length);
        if (!was) continue;
        // A single touch has no way: it counts as a tenth of a millimetre.
        const double step = std::max(1e-4 / static_cast<double>(poses.size()), i > 0 ? glm::distance(mouth, poses[i - 1].position) : 0.0);
        fit.way += step;
        const auto now = revised.ray(mouth - length * axis, axis, 0, 2 * length);
        if (!now) {
            fit.lost += step;
        } else if (now->distance < length) {
            fit.buried += step;
        } else {
            depths.push_back(length - was->distance);
            changes.push_back(was->distance - (now->distance - length));
        }
    }
    fit.depth = median(depths);
    fit.deeper = median(changes);
    return fit;
}

}  // namespace

std::vector<StrokeFit> compare_fit(const std::vector<Stroke>& strokes, const std::function<double(const std::string&)>& length_of,
                                   const mesh::SurfaceQuery& former, const mesh::SurfaceQuery& revised) {
    std::vector<StrokeFit> fits;
    for (const Stroke& stroke : strokes)
        if (stroke.action == Action::stroke && !stroke.hidden && !stroke.trace.flat && stroke.layer != kPaletteLayer)
            fits.push_back(fit_of(stroke, length_of(stroke.trace.brush), former, revised));
    return fits;
}

std::string misfit_reason(const StrokeFit& fit) {
    if (fit.way <= 0) return "";
    const auto percent = [&](double part) { return static_cast<int>(std::lround(100 * part / fit.way)); };
    const bool moved = std::abs(fit.deeper) > std::max(kLeastChange, kDepthPart * fit.depth);
    // A surface that sank loses the light ends of a stroke too: that it sank says more.
    const double least = (moved ? kMost : kPart) * fit.way;
    if (fit.lost > least && fit.lost >= fit.buried) return fmt::format("{} % of it touches nothing", percent(fit.lost));
    if (fit.buried > least) return fmt::format("{} % of it lies inside the model", percent(fit.buried));
    if (moved) return fmt::format("pressed {:.1f} mm {}", 1e3 * std::abs(fit.deeper), fit.deeper > 0 ? "deeper" : "less deep");
    return "";
}

std::vector<Misfit> find_misfits(const std::vector<StrokeReport>& reports, const std::vector<StrokeFit>& fits) {
    std::vector<Misfit> found;
    for (const StrokeReport& report : reports) {
        const auto fit = std::find_if(fits.begin(), fits.end(), [&](const StrokeFit& f) { return f.stroke == report.stroke_id; });
        std::string reason;
        if (fit != fits.end() && (report.touched() || !fit->reached)) reason = misfit_reason(*fit);
        else if (!report.touched()) reason = fmt::format("touches nothing, {:.1f} mm away", 1e3 * report.nearest);
        if (!reason.empty()) found.push_back({report.stroke_id, std::move(reason)});
    }
    return found;
}

}  // namespace tuft::stroke
