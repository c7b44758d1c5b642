#include "render/brush/comparison_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "core/text/units.h"
#include "render/brush/brush_canvas.h"

namespace tuft::render {

using namespace brush;

namespace {

const Vec3 kPaper = linear_colour(246, 243, 236), kInk = linear_colour(50, 46, 42),
           kGrid = linear_colour(216, 210, 198);

/// Of the methods in their order: apart in lightness too, for those who do not see the hues.
const std::array<Vec3, std::size(kSpineWords)> kColours = {linear_colour(20, 20, 24), linear_colour(150, 150, 156),
                                                           linear_colour(214, 120, 20), linear_colour(28, 110, 190),
                                                           linear_colour(30, 140, 80)};

/// A plot from (0, low) on; `box` in pixels, y down.
struct Plot {
    Vec2 corner, size;  ///< lower left corner; width and height
    Vec2 low, high;     ///< values there and at the upper right, millimetres

    Vec2 at(const Vec2& v) const {
        const Vec2 f = (v - low) / (high - low);
        return {corner.x + f.x * size.x, corner.y - f.y * size.y};
    }
};

/// A step of 1, 2 or 5 times a power of ten, some five to a span.
double tick_step(double span) {
    const double raw = span / 5, power = std::pow(10, std::floor(std::log10(raw)));
    return power * (raw < 1.5 * power ? 1 : raw < 3.5 * power ? 2 : raw < 7.5 * power ? 5 : 10);
}

std::string whole(double v) {
    return std::to_string(static_cast<int>(std::lround(v)));
}

class Sheet {
  public:
    Sheet(BrushCanvas& canvas, double unit) : canvas_(canvas), unit_(unit) {}

    void line(std::span<const Vec2> points, double width, const Vec3& colour) const {
        const double w = width * unit_;
        stroke_line(canvas_, points, {&w, 1}, colour);
    }
    void text(const std::string& words, Vec2 at, double size, const Vec3& colour = kInk) const {
        write_text(canvas_, words, at, size * unit_, colour);
    }
    double text_width(const std::string& words, double size) const { return render::text_width(words, size * unit_); }

    void dot(const Vec2& at, double radius) const {
        std::vector<Vec2> points;
        for (int k = 0; k < 24; ++k) {
            const double a = k * std::numbers::pi / 12;
            points.push_back(at + radius * unit_ * Vec2{std::cos(a), std::sin(a)});
        }
        points.push_back(points.front());
        line(points, 2.5, linear_colour(176, 30, 40));
    }

    /// Grid with numbers, and the name of what is plotted.
    void axes(const Plot& plot, const std::string& name) const {
        const double dx = tick_step(plot.high.x - plot.low.x), dy = tick_step(plot.high.y - plot.low.y);
        for (double x = std::ceil(plot.low.x / dx) * dx; x <= plot.high.x + 1e-9; x += dx) {
            const Vec2 rule[] = {plot.at({x, plot.low.y}), plot.at({x, plot.high.y})};
            line(rule, 1.2, kGrid);
            text(whole(x), rule[0] + Vec2{-0.5 * text_width(whole(x), 12), 24 * unit_}, 12);
        }
        for (double y = std::ceil(plot.low.y / dy) * dy; y <= plot.high.y + 1e-9; y += dy) {
            const Vec2 rule[] = {plot.at({plot.low.x, y}), plot.at({plot.high.x, y})};
            line(rule, 1.2, kGrid);
            text(whole(y), rule[0] + Vec2{-text_width(whole(y), 12) - 10 * unit_, 5 * unit_}, 12);
        }
        const Vec2 frame[] = {plot.at({plot.low.x, plot.high.y}), plot.at(plot.low),
                              plot.at({plot.high.x, plot.low.y})};
        line(frame, 2, kInk);
        text(name, plot.at({plot.low.x, plot.high.y}) + Vec2{0, -16 * unit_}, 15);
    }

  private:
    BrushCanvas& canvas_;
    double unit_;
};

void plot_column(const Sheet& sheet, const Plot& plot, std::span<const ModelSweep> models,
                 std::span<const SweepRow> measured, double SweepRow::*column) {
    for (const ModelSweep& model : models) {
        std::vector<Vec2> points;
        for (const SweepRow& row : model.rows) points.push_back(plot.at(Vec2{row.depth, row.*column} / kMillimetre));
        sheet.line(points, 4, kColours[static_cast<std::size_t>(model.method)]);
    }
    for (const SweepRow& row : measured)
        if (!std::isnan(row.*column)) sheet.dot(plot.at(Vec2{row.depth, row.*column} / kMillimetre), 6);
}

void plot_spines(const Sheet& sheet, Plot plot, std::span<const ModelSweep> models) {
    Box box;
    for (const ModelSweep& model : models)
        for (const Vec2& x : model.spine) box.add(Vec3{x / kMillimetre, 0});
    if (box.empty()) return;
    // The same scale on both axes; what trails the hand is to the right, behind the axis.
    const double scale = std::min(plot.size.x / (box.size().x + 4), plot.size.y / (box.hi.y + 2));
    plot.low = {-box.hi.x - 2, 0};
    plot.high = plot.low + plot.size / scale;
    sheet.axes(plot, "spines at the greatest depth, mm behind the axis");
    for (const ModelSweep& model : models) {
        std::vector<Vec2> points;
        for (const Vec2& x : model.spine) points.push_back(plot.at({-x.x / kMillimetre, x.y / kMillimetre}));
        sheet.line(points, 4, kColours[static_cast<std::size_t>(model.method)]);
    }
}

}  // namespace

BrushPicture draw_comparison(std::span<const ModelSweep> models, std::span<const SweepRow> measured, int width) {
    width = std::clamp(width, 320, 8000);
    const double unit = width / 2000.0;
    const int height = static_cast<int>(std::lround(1360 * unit));
    BrushCanvas canvas(width, height, kPaper);
    const Sheet sheet(canvas, unit);
    double x = 70 * unit;
    for (const ModelSweep& model : models) {
        const Vec3& colour = kColours[static_cast<std::size_t>(model.method)];
        const Vec2 sample[] = {{x, 40 * unit}, {x + 60 * unit, 40 * unit}};
        sheet.line(sample, 5, colour);
        const std::string name = kSpineWords[static_cast<std::size_t>(model.method)];
        sheet.text(name, {x + 74 * unit, 47 * unit}, 17);
        x += 130 * unit + sheet.text_width(name, 17);
    }
    sheet.dot({x + 10 * unit, 40 * unit}, 6);
    sheet.text("measured", {x + 30 * unit, 47 * unit}, 17);

    constexpr const char* kNames[] = {"width over depth, mm", "contact length over depth, mm", "offset over depth, mm"};
    double deepest = 0, most = 0;
    for (const SweepRow& row : measured) {
        deepest = std::max(deepest, row.depth / kMillimetre);
        for (double SweepRow::*column : kSweepColumns) most = std::max(most, row.*column / kMillimetre);
    }
    for (const ModelSweep& model : models)
        for (const SweepRow& row : model.rows)
            for (double SweepRow::*column : kSweepColumns) most = std::max(most, row.*column / kMillimetre);
    for (std::size_t k = 0; k < 4; ++k) {
        const Vec2 size = Vec2{870, 500} * unit;
        const Vec2 corner = Vec2{90 + 970.0 * static_cast<double>(k % 2), k < 2 ? 640 : 1290} * unit;
        Plot plot{corner, size, {0, 0}, {1.03 * std::max(deepest, 1e-3), 1.05 * std::max(most, 1e-3)}};
        if (k == 3) {
            plot_spines(sheet, plot, models);
            continue;
        }
        sheet.axes(plot, kNames[k]);
        plot_column(sheet, plot, models, measured, kSweepColumns[k]);
    }
    return {width, height, to_srgb(canvas)};
}

}  // namespace tuft::render
