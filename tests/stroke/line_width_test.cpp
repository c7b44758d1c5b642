#include "stroke/line_width.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sheet.h"

namespace tuft::stroke {
namespace {

/// A line 50 mm long through the middle of the sheet, turned by `angle`, with made-up pressure.
Stroke straight(const std::string& brush, double width, double angle) {
    Stroke s;
    s.trace.brush = brush;
    s.trace.ink = "carbon";
    s.trace.pressed = false;
    s.trace.line_width = width;
    s.trace.placement = {{0, 0, 0}, {std::cos(angle), std::sin(angle), 0}, {std::sin(angle), -std::cos(angle), 0}, Laying::drape};
    for (int i = 0; i <= 100; ++i) s.trace.samples.push_back({.time = i / 120.0, .position = {-0.025 + 5e-4 * i, 0, 0}, .pressure = 0.5});
    return s;
}

struct Band {
    double width = 0;     ///< metres, mean over the middle 20 mm
    double farthest = 0;  ///< metres of ink from the line, anywhere
};

Band drawn(const Stroke& stroke) {
    const Model model = sheet();
    Painting painting(model);
    painting.paint(stroke);
    const atlas::TexelMap& map = model.texels;
    const Placement& place = stroke.trace.placement;
    Band band;
    for (const std::uint32_t slot : painting.canvas().touched_slots())
        if (const ink::Plane* plane = painting.canvas().plane(slot, 0))
            for (int t = 0; t < atlas::kTileTexels; ++t) {
                if (map.tiles[slot].area[t] <= 0 || (*plane)[t] < 0.1f) continue;
                const Vec3 p = Vec3(map.position(slot, t)) - place.origin;
                const double along = glm::dot(p, place.right), across = std::abs(glm::dot(p, place.down));
                band.farthest = std::max(band.farthest, across);
                if (std::abs(along) < 0.01) band.width += map.tiles[slot].area[t] / 0.02;
            }
    return band;
}

TEST(LineWidth, ALineIsAsWideAsTheDrawingHasIt) {
    for (const char* brush : {"wolf-small", "goat-medium", "robot-2020"})
        for (const double width : {0.001, 0.0025, 0.004}) {
            const LineWidths widths(brush::load_preset(brush));
            Stroke stroke = straight(brush, width, 0.3);
            draw_to_width(stroke.trace, widths);
            // A texel of 60 µm to both sides, and 5 % for the table's chords and the friction that sampled motion has.
            EXPECT_NEAR(drawn(stroke).width, width, 6e-5 + 0.05 * width) << brush << ' ' << width;
        }
}

TEST(LineWidth, ATraceThatBeginsPressedStaysOnItsLine) {
    // Round-off decides to which side a tuft bends that is set down upright; it must not be the front.
    for (const char* brush : {"wolf-medium", "goat-medium", "mixed-small"})
        for (const double angle : {0.0, 1e-7, 1e-3, 0.7}) {
            Stroke stroke = straight(brush, 0.002, angle);
            draw_to_width(stroke.trace, LineWidths(brush::load_preset(brush)));
            // The head of the line, where the tuft still stands, is up to half as wide again.
            EXPECT_LT(drawn(stroke).farthest, 0.0015) << brush << ' ' << angle;
        }
}

TEST(LineWidth, AClosedLineHasNoGapWhereItsEndsMeet) {
    const double width = 0.002, radius = 0.008;
    Stroke stroke = straight("wolf-small", width, 0);
    stroke.trace.samples.clear();
    for (int i = 0; i <= 200; ++i) {
        const double a = 2 * std::numbers::pi * (i % 200) / 200;
        stroke.trace.samples.push_back({.time = i / 120.0, .position = radius * Vec3{std::cos(a), std::sin(a), 0}, .pressure = 0.5});
    }
    draw_to_width(stroke.trace, LineWidths(brush::load_preset("wolf-small")));
    EXPECT_TRUE(std::is_sorted(stroke.trace.samples.begin(), stroke.trace.samples.end(), [](auto& a, auto& b) { return a.time < b.time; }));
    const Model model = sheet();
    Painting painting(model);
    painting.paint(stroke);
    std::vector<double> across(36, 0);  // area of ink per ten degrees
    for (const std::uint32_t slot : painting.canvas().touched_slots())
        if (const ink::Plane* plane = painting.canvas().plane(slot, 0))
            for (int t = 0; t < atlas::kTileTexels; ++t) {
                if (model.texels.tiles[slot].area[t] <= 0 || (*plane)[t] < 0.1f) continue;
                const Vec3 p(model.texels.position(slot, t));
                const double a = std::atan2(p.y, p.x) / (2 * std::numbers::pi);
                across[static_cast<std::size_t>(std::floor(36 * (a - std::floor(a)))) % 36] += model.texels.tiles[slot].area[t];
            }
    for (double& area : across) area /= 2 * std::numbers::pi * radius / 36;
    // As the straight line, and a fifth for heads and ends, which do not lie exactly over each other.
    for (const double w : across) EXPECT_NEAR(w, width, 0.2 * width + 6e-5);
}

TEST(LineWidth, BrushesComeInTheSizeThatDrawsIt) {
    const LineWidths medium(brush::load_preset("goat-medium"));
    EXPECT_EQ(brush_for_width("goat-medium", medium, medium.at(0.45)), "goat-medium");
    for (const double width : {0.001, 0.02}) {
        const std::string name = brush_for_width("goat-medium", medium, width);
        EXPECT_NE(name, "goat-medium");
        const LineWidths sized(brush::load_preset(name));
        EXPECT_GT(sized.at(0.7), width) << name;
        EXPECT_LT(sized.at(0.1), width) << name;
    }
    // Held to the sizes that there are.
    EXPECT_LT(brush::sized_name(brush_for_width("goat-medium", medium, 1e-5)).factor, 1.25 * brush::kLeastSize);
    EXPECT_GT(brush::sized_name(brush_for_width("goat-medium", medium, 10)).factor, brush::kMostSize / 1.25);
}

TEST(LineWidth, PressureAndWidthAreEachOthersInverse) {
    const LineWidths widths(brush::load_preset("mixed-medium"));
    double before = 0;
    for (double p = LineWidths::kLightest; p <= 1; p += 0.01) {
        EXPECT_GE(widths.at(p), before);
        before = widths.at(p);
        if (widths.at(p - 0.005) < before) {
            EXPECT_NEAR(widths.pressure(before), p, 1e-9);  // round-off
        }
    }
    EXPECT_EQ(widths.pressure(0), LineWidths::kLightest);
    EXPECT_EQ(widths.pressure(1), 1);
}

}  // namespace
}  // namespace tuft::stroke
