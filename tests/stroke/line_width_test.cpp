#include "stroke/drawing/line_width.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sheet.h"

namespace tuft::stroke {
namespace {

/// A line 50 mm long through the middle of the sheet, turned by `angle`, with made-up pressure.
PaintStroke straight(const std::string& brush, double width, double angle) {
    PaintStroke s;
    s.brush = brush;
    s.ink = "carbon";
    s.trace.pressed = false;
    s.trace.line_width = width;
    s.trace.placement = {{0, 0, 0},
                         {std::cos(angle), std::sin(angle), 0},
                         {std::sin(angle), -std::cos(angle), 0},
                         SurfaceMapping::drape};
    for (int i = 0; i <= 100; ++i)
        s.trace.samples.push_back({.time = i / 120.0, .position = {-0.025 + 5e-4 * i, 0, 0}, .pressure = 0.5});
    return s;
}

struct Band {
    double width = 0;     ///< metres, mean over the middle 20 mm
    double farthest = 0;  ///< metres of ink from the line, anywhere
};

Band drawn(const PaintStroke& stroke) {
    const Model model = sheet();
    Document painting(model);
    painting.paint(stroke);
    const atlas::TexelMap& map = model.texels;
    const Placement& place = stroke.trace.placement;
    Band band;
    for (const std::uint32_t slot : painting.layers().canvas().touched_slots())
        if (const ink::Plane* plane = painting.layers().canvas().plane(slot, 0))
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
            if (width < widths.least()) continue;  // of goat-medium and robot-2020, whose points draw 1.2 mm
            PaintStroke stroke = straight(brush, width, 0.3);
            draw_to_width(stroke.trace, widths);
            // A texel of 60 µm to both sides, and 5 % for the table's chords and the friction that sampled motion has.
            EXPECT_NEAR(drawn(stroke).width, width, 6e-5 + 0.05 * width) << brush << ' ' << width;
        }
}

TEST(LineWidth, ATraceThatBeginsPressedStaysOnItsLine) {
    // Round-off decides to which side a tuft bends that is set down upright; it must not be the front.
    for (const char* brush : {"wolf-medium", "goat-medium", "mixed-small"})
        for (const double angle : {0.0, 1e-7, 1e-3, 0.7}) {
            PaintStroke stroke = straight(brush, 0.002, angle);
            draw_to_width(stroke.trace, LineWidths(brush::load_preset(brush)));
            // The head of the line, where the tuft still stands, is up to half as wide again.
            EXPECT_LT(drawn(stroke).farthest, 0.0015) << brush << ' ' << angle;
        }
}

PaintStroke circle(const std::string& brush, double width, double radius) {
    PaintStroke stroke = straight(brush, width, 0);
    stroke.trace.samples.clear();
    for (int i = 0; i <= 200; ++i) {
        const double a = 2 * std::numbers::pi * (i % 200) / 200;
        stroke.trace.samples.push_back(
            {.time = i / 120.0, .position = radius * Vec3{std::cos(a), std::sin(a), 0}, .pressure = 0.5});
    }
    draw_to_width(stroke.trace, LineWidths(brush::load_preset(brush)));
    return stroke;
}

TEST(LineWidth, ATiltAgainstTheMotionDoesNotTurnTheTuftOver) {
    // A surface that is not quite as the hand takes it: three and six degrees tip ahead, and to the sides.
    for (const char* brush : {"wolf-medium*0.168", "goat-medium", "mixed-small"})
        for (const Vec2& lean : {Vec2{-0.05, 0}, Vec2{-0.1, 0}, Vec2{-0.05, 0.05}, Vec2{0, -0.05}}) {
            const double width = brush == std::string("goat-medium") ? 0.002 : 0.0012;
            PaintStroke stroke = straight(brush, width, 0.3);
            for (StrokeSample& s : stroke.trace.samples) s.tilt = lean;
            draw_to_width(stroke.trace, LineWidths(brush::load_preset(brush)));
            EXPECT_LT(drawn(stroke).farthest, 0.75 * width + 6e-5)
                << brush << ' ' << lean.x << ' ' << lean.y;  // as above, and a texel
        }
}

TEST(LineWidth, AFineBrushSetsDownOnItsLineToo) {
    // One that goes less than a texel ahead of its ink trails from the start as a large one does.
    const double width = 0.0007, radius = 0.0084;
    const Model model = sheet();
    Document painting(model);
    painting.paint(circle("wolf-medium*0.1074", width, radius));
    double farthest = 0;
    for (const std::uint32_t slot : painting.layers().canvas().touched_slots())
        if (const ink::Plane* plane = painting.layers().canvas().plane(slot, 0))
            for (int t = 0; t < atlas::kTileTexels; ++t)
                if (model.texels.tiles[slot].area[t] > 0 && (*plane)[t] >= 0.1f)
                    farthest = std::max(farthest, std::abs(glm::length(Vec3(model.texels.position(slot, t))) - radius));
    // Half of a line that may be a tenth wider, and a texel.
    EXPECT_LT(farthest, 0.55 * width + 6e-5);
}

TEST(LineWidth, AClosedLineHasNoGapWhereItsEndsMeet) {
    const double width = 0.002, radius = 0.008;
    const PaintStroke stroke = circle("wolf-small", width, radius);
    EXPECT_TRUE(std::is_sorted(stroke.trace.samples.begin(), stroke.trace.samples.end(),
                               [](auto& a, auto& b) { return a.time < b.time; }));
    const Model model = sheet();
    Document painting(model);
    painting.paint(stroke);
    std::vector<double> across(36, 0);  // area of ink per ten degrees
    for (const std::uint32_t slot : painting.layers().canvas().touched_slots())
        if (const ink::Plane* plane = painting.layers().canvas().plane(slot, 0))
            for (int t = 0; t < atlas::kTileTexels; ++t) {
                if (model.texels.tiles[slot].area[t] <= 0 || (*plane)[t] < 0.1f) continue;
                const Vec3 p(model.texels.position(slot, t));
                const double a = std::atan2(p.y, p.x) / (2 * std::numbers::pi);
                across[static_cast<std::size_t>(std::floor(36 * (a - std::floor(a)))) % 36] +=
                    model.texels.tiles[slot].area[t];
            }
    for (double& area : across) area /= 2 * std::numbers::pi * radius / 36;
    // As the straight line, and a fifth for heads and ends, which do not lie exactly over each other.
    for (const double w : across) EXPECT_NEAR(w, width, 0.2 * width + 6e-5);
}

/// Half of a cylinder's wall round the z axis with the radius of a bowl, seen from inside or from outside.
Model wall(double radius, bool inside) {
    constexpr int n = 120, m = 40;
    mesh::PolygonSoup soup;
    for (int j = 0; j <= m; ++j)
        for (int i = 0; i <= n; ++i) {
            const double a = std::numbers::pi * (i / double(n) - 0.5);
            soup.points.push_back(radius * Vec3(std::cos(a), std::sin(a), 0) + Vec3(0, 0, 0.1 * (j / double(m) - 0.5)));
        }
    soup.polygon_start.push_back(0);
    for (std::uint32_t j = 0; j < m; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
            for (const auto& t : {std::array{a, b, c}, std::array{a, c, d}}) {
                for (std::size_t k = 0; k < 3; ++k) soup.corners.push_back(t[inside ? 2 - k : k]);
                soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
            }
        }
    ModelOptions options;
    options.repair.metres_per_unit = 1;
    options.unwrap.size = 2048;
    return prepare_model(std::move(soup), options);
}

TEST(LineWidth, LinesOnCurvedWallsLieWhereTheyAreDrapedInBothDirections) {
    // Slanting over the wall: the hand runs ahead to where the wall leans otherwise.
    for (const bool inside : {false, true}) {
        const Model model = wall(0.05, inside);
        const mesh::SurfacePoint at = *model.query->closest_point({0.05, 0, 0});
        std::array<double, 2> aside{};
        for (const std::size_t direction : {0, 1}) {
            PaintStroke stroke = straight("wolf-medium", 0.0036, 0);
            Placement& place = stroke.trace.placement;
            place.origin = at.position;
            place.right = glm::normalize(glm::cross(Vec3(0, 0, 1), at.normal));
            place.down = glm::cross(place.right, at.normal);
            for (StrokeSample& s : stroke.trace.samples)
                s.position = s.position.x * (direction ? 1.0 : -1.0) * Vec3(std::sqrt(0.5), std::sqrt(0.5), 0);
            draw_to_width(stroke.trace, LineWidths(brush::load_preset("wolf-medium")));
            Document painting(model);
            painting.paint(stroke);
            const Vec3 across = (place.right - place.down) * std::sqrt(0.5);
            double area = 0;
            for (const std::uint32_t slot : painting.layers().canvas().touched_slots())
                if (const ink::Plane* plane = painting.layers().canvas().plane(slot, 0))
                    for (int t = 0; t < atlas::kTileTexels; ++t) {
                        const double texel = model.texels.tiles[slot].area[t];
                        const Vec3 p = Vec3(model.texels.position(slot, t)) - at.position;
                        if (texel <= 0 || (*plane)[t] < 0.1f || glm::length(p) > 0.01) continue;
                        area += texel;
                        aside[direction] += glm::dot(p, across) * texel;
                    }
            aside[direction] /= area;
        }
        // A tenth of the width. The tuft lies over some 6 mm, along which the wall leans by 0.1 rad and more; a hand
        // that was held over the surface ahead, not over the place of the ink, had the lines 1.1 mm aside.
        for (const double a : aside) EXPECT_NEAR(a, 0, 3.6e-4) << inside;
    }
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
    // Limited to the sizes that there are.
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
