#include "cli/bench/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/text/xml_text.h"

namespace tuft::cli {
namespace {

constexpr double kWidth = 560, kHeight = 330, kLeft = 70, kRight = 20, kTop = 56, kBottom = 52;  // pixels
constexpr double kBarLine = 26, kBarLeft = 190, kBarRight = 80;
// Distinct for people who see red and green alike, and by lightness [Okabe2008].
constexpr std::array kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#000000"};

std::string head(double width, double height, const std::string& title) {
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" height=\"{1:g}\" "
        "font-family=\"sans-serif\" font-size=\"12\" role=\"img\">\n<title>{2}</title>\n"
        "<rect width=\"{0:g}\" height=\"{1:g}\" fill=\"#fff\"/>\n"
        "<text x=\"12\" y=\"22\" font-size=\"15\" font-weight=\"bold\">{2}</text>\n",
        width, height, xml_text(title));
}

/// Number of an axis, as short as it can be.
std::string number(double v) {
    if (std::abs(v) >= 999'500) return fmt::format("{:.3g} M", v / 1e6);
    if (std::abs(v) >= 1e4) return fmt::format("{:.3g} k", v / 1e3);
    return fmt::format("{:.6g}", v);
}

struct Axis {
    bool log = false;
    double lo = 0, hi = 1;
    std::vector<double> ticks;

    double part(double v) const {
        return log ? (std::log(v) - std::log(lo)) / (std::log(hi) - std::log(lo)) : (v - lo) / (hi - lo);
    }
};

double round_step(double range) {
    const double ten = std::pow(10, std::floor(std::log10(range / 5)));
    for (const double step : {1.0, 2.0, 5.0})
        if (range <= 6 * step * ten) return step * ten;
    return 10 * ten;
}

Axis make_axis(const std::vector<double>& values, bool log, bool from_zero) {
    Axis axis{.log = log};
    if (values.empty()) return axis;
    const auto [lo, hi] = std::minmax_element(values.begin(), values.end());
    if (log) {
        axis.lo = *lo / 1.15;
        axis.hi = *hi * 1.15;
        for (const bool all : {false, true}) {  // 1, 2, 5, or every digit where these are too few
            axis.ticks.clear();
            for (double ten = std::pow(10, std::floor(std::log10(axis.lo))); ten <= axis.hi; ten *= 10)
                for (int digit = 1; digit < 10; ++digit)
                    if ((all || digit == 1 || digit == 2 || digit == 5) && digit * ten >= axis.lo &&
                        digit * ten <= axis.hi)
                        axis.ticks.push_back(digit * ten);
            if (axis.ticks.size() >= 3) break;
        }
        return axis;
    }
    const double from = from_zero ? std::min(0.0, *lo) : *lo;
    const double step = round_step(std::max(*hi - from, 1e-9 * std::max(1.0, std::abs(*hi))));
    axis.lo = step * std::floor(from / step);
    axis.hi = step * std::ceil(*hi / step + 0.05);
    for (double v = axis.lo; v <= axis.hi + 0.5 * step; v += step)
        axis.ticks.push_back(std::abs(v) < 1e-9 * step ? 0 : v);
    return axis;
}

bool is_drawn(const Plot& plot, const Vec2& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && (!plot.log_x || p.x > 0) && (!plot.log_y || p.y > 0);
}

std::string axes(const Plot& plot, const Axis& x, const Axis& y) {
    std::string svg;
    const double right = kWidth - kRight, bottom = kHeight - kBottom;
    for (const double v : y.ticks) {
        const double at = bottom - y.part(v) * (bottom - kTop);
        svg += fmt::format(
            "<path d=\"M{:g} {:.1f}H{:g}\" stroke=\"#ddd\"/><text x=\"{:g}\" y=\"{:.1f}\" "
            "text-anchor=\"end\">{}</text>\n",
            kLeft, at, right, kLeft - 6, at + 4, number(v));
    }
    for (const double v : x.ticks) {
        const double at = kLeft + x.part(v) * (right - kLeft);
        svg += fmt::format(
            "<path d=\"M{:.1f} {:g}v5\" stroke=\"#333\"/><text x=\"{:.1f}\" y=\"{:g}\" "
            "text-anchor=\"middle\">{}</text>\n",
            at, bottom, at, bottom + 18, number(v));
    }
    svg +=
        fmt::format("<path d=\"M{:g} {:g}V{:g}H{:g}\" fill=\"none\" stroke=\"#333\"/>\n", kLeft, kTop, bottom, right);
    svg += fmt::format("<text x=\"{:g}\" y=\"{:g}\" text-anchor=\"middle\">{}</text>\n", 0.5 * (kLeft + right),
                       kHeight - 12, xml_text(plot.x_label));
    svg += fmt::format("<text transform=\"translate(16 {:g}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                       0.5 * (kTop + bottom), xml_text(plot.y_label));
    return svg;
}

}  // namespace

std::string svg_of(const Plot& plot) {
    std::vector<double> xs, ys;
    for (const PlotSeries& s : plot.series)
        for (const Vec2& p : s.points)
            if (is_drawn(plot, p)) xs.push_back(p.x), ys.push_back(p.y);
    Axis x = make_axis(xs, plot.log_x, false);
    const Axis y = make_axis(ys, plot.log_y, plot.from_zero);
    std::sort(xs.begin(), xs.end());
    xs.erase(std::unique(xs.begin(), xs.end()), xs.end());
    if (xs.size() <= 8) x.ticks = xs;  // the places that were measured
    std::string svg = head(kWidth, kHeight, plot.title) + axes(plot, x, y);
    double key = kLeft;
    for (std::size_t i = 0; i < plot.series.size(); ++i) {
        const char* colour = kColours[i % kColours.size()];
        std::string path, marks;
        for (const Vec2& p : plot.series[i].points) {
            if (!is_drawn(plot, p)) continue;
            const double px = kLeft + x.part(p.x) * (kWidth - kRight - kLeft);
            const double py = kHeight - kBottom - y.part(p.y) * (kHeight - kBottom - kTop);
            path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", px, py);
            marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>", px, py, colour);
        }
        const bool dashed = i % 2 == 1;
        svg += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"{}/>{}\n", path, colour,
                           dashed ? " stroke-dasharray=\"6 3\"" : "", marks);
        svg += fmt::format(
            "<path d=\"M{0:g} 40h18\" stroke=\"{1}\" stroke-width=\"2\"{2}/><text x=\"{3:g}\" y=\"44\">{4}</text>\n",
            key, colour, dashed ? " stroke-dasharray=\"6 3\"" : "", key + 23, xml_text(plot.series[i].name));
        key += 45 + 6.8 * static_cast<double>(plot.series[i].name.size());
    }
    return svg + "</svg>\n";
}

std::string svg_bars(const std::string& title, const std::string& unit,
                     const std::vector<std::pair<std::string, double>>& bars) {
    const double height = 44 + kBarLine * static_cast<double>(bars.size()) + 10;
    double most = 1e-300;
    for (const auto& [name, value] : bars) most = std::max(most, value);
    std::string svg = head(kWidth, height, title);
    double y = 40;
    for (const auto& [name, value] : bars) {
        const double width = std::max(1.0, value / most * (kWidth - kBarLeft - kBarRight));
        svg += fmt::format(
            "<text x=\"{:g}\" y=\"{:g}\" text-anchor=\"end\">{}</text><rect x=\"{:g}\" y=\"{:g}\" width=\"{:.1f}\" "
            "height=\"16\" "
            "fill=\"{}\"/><text x=\"{:.1f}\" y=\"{:g}\">{:.3g} {}</text>\n",
            kBarLeft - 8, y + 13, xml_text(name), kBarLeft, y, width, kColours[0], kBarLeft + width + 6, y + 13, value,
            xml_text(unit));
        y += kBarLine;
    }
    return svg + "</svg>\n";
}

}  // namespace tuft::cli
