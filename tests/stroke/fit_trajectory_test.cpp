#include "stroke/drawing/fit_trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "stroke/drawing/plane_ink.h"

namespace tuft::stroke {
namespace {

constexpr double kWidth = 3e-3;

WidthTables& tables() {
    static WidthTables t;
    return t;
}

/// A line through the points, sampled every half millimetre as drawings are, pressed for its width.
const std::string kBrush = "wolf-medium";

StrokeSamples through(std::initializer_list<Vec2> points) {
    StrokeSamples trace{.pressed = false, .line_width = kWidth};
    const Vec2* before = nullptr;
    for (const Vec2& p : points) {
        const int n = before ? static_cast<int>(std::ceil(glm::distance(*before, p) / 5e-4)) : 1;
        for (int k = 1; k <= n; ++k)
            trace.samples.push_back(
                {.position = Vec3(before ? glm::mix(*before, p, double(k) / n) : p, 0), .pressure = 0.5});
        before = &p;
    }
    for (std::size_t i = 1; i < trace.samples.size(); ++i)
        trace.samples[i].time =
            trace.samples[i - 1].time + glm::distance(trace.samples[i].position, trace.samples[i - 1].position) / 0.06;
    draw_to_width(trace, tables().of(kBrush));
    return trace;
}

StrokeSamples fitted(const StrokeSamples& trace) {
    return fit_trajectory(trace, brush::load_preset(kBrush), tables().of(kBrush), tables().holder(kBrush));
}

/// How far round the ink goes from the line through the points, within `about` of `corner`: the
/// farthest ink from it, and the area of it, m², that is farther than half a width.
struct Spill {
    double farthest = 0, area = 0;
};
Spill spilt(const StrokeSamples& trace, std::initializer_list<Vec2> points, const Vec2& corner, double about) {
    const double cell = 5e-5;
    const PlaneInk ink = plane_ink(trace, brush::load_preset(kBrush), tables().holder(kBrush), 1e-4, cell);
    Spill s;
    for (double y = corner.y - about; y < corner.y + about; y += cell)
        for (double x = corner.x - about; x < corner.x + about; x += cell) {
            const Vec2 p(x, y);
            const double inked = ink.at({x, -y});
            if (inked < 0.5) continue;
            double far = 1e9;
            for (const Vec2* a = points.begin(); a + 1 < points.end(); ++a) {
                const Vec2 d = a[1] - a[0];
                far = std::min(far,
                               glm::distance(p, *a + std::clamp(glm::dot(p - *a, d) / glm::dot(d, d), 0.0, 1.0) * d));
            }
            s.farthest = std::max(s.farthest, far);
            if (far > 0.5 * kWidth) s.area += cell * cell;
        }
    return s;
}

TEST(FitTrajectory, CornersHaveNoKnobs) {
    // What of a straight line's soft edge falls on cells farther than half a width is no knob.
    const std::initializer_list<Vec2> straight{{-0.02, 0}, {0, 0}, {0.02, 0}};
    const double edge = spilt(through(straight), straight, {0, 0}, 3 * kWidth).area;
    for (const double turn : {60.0, 90.0, 115.0, 130.0}) {
        SCOPED_TRACE(turn);
        const double a = turn * std::numbers::pi / 180;
        const std::initializer_list<Vec2> points{{-0.02, 0}, {0, 0}, 0.02 * Vec2(std::cos(a), std::sin(a))};
        const StrokeSamples plain = through(points), tried = fitted(plain);
        const Spill before = spilt(plain, points, {0, 0}, 3 * kWidth), after = spilt(tried, points, {0, 0}, 3 * kWidth);
        // A tenth of the width is what a straight line may be wide or narrow (LineWidth.*), the
        // rest a cell of the picture and what is left of the tuft's turning over; unpractised it is
        // 0.2 to 0.5.
        EXPECT_LT(after.farthest, 0.62 * kWidth);
        EXPECT_LT(after.area - edge, 0.25 * (before.area - edge));
        EXPECT_EQ(tried.samples.front().position, plain.samples.front().position);
        EXPECT_NEAR(tried.samples.back().time, plain.samples.back().time, 1e-12);
    }
}

// A corner is tried with the path that the tuft needs to follow, not with all of a long line: it comes out as between
// short lines.
TEST(FitTrajectory, CornersOfLongLinesComeOutAsThoseOfShortOnes) {
    const std::initializer_list<Vec2> points{{-0.06, 0}, {0, 0}, {-0.025, 0.054}};
    const StrokeSamples plain = through(points), tried = fitted(plain);
    const Spill before = spilt(plain, points, {0, 0}, 3 * kWidth), after = spilt(tried, points, {0, 0}, 3 * kWidth);
    EXPECT_LT(after.farthest, 0.62 * kWidth);  // as above
    EXPECT_LT(after.area, 0.5 * before.area);  // with what soft edges leave
    // Far from the corner the hand keeps to the line.
    for (const StrokeSample& s : tried.samples)
        if (glm::length(s.position) > 0.03) {
            EXPECT_LT(std::min(std::abs(s.position.y), std::abs(0.054 * s.position.x + 0.025 * s.position.y)), 1e-9);
        }
}

TEST(FitTrajectory, LeavesWhatHasNoCornerAndIsRepeatable) {
    const StrokeSamples straight = through({{-0.02, 0}, {0.02, 0.003}});
    const StrokeSamples same = fitted(straight);
    ASSERT_EQ(same.samples.size(), straight.samples.size());
    for (std::size_t i = 0; i < same.samples.size(); ++i)
        EXPECT_EQ(same.samples[i].position, straight.samples[i].position);
    const StrokeSamples corner = through({{-0.01, 0}, {0, 0}, {0, 0.01}});
    const StrokeSamples a = fitted(corner), b = fitted(corner);
    ASSERT_EQ(a.samples.size(), b.samples.size());
    for (std::size_t i = 0; i < a.samples.size(); ++i) {
        EXPECT_EQ(a.samples[i].position, b.samples[i].position);
        EXPECT_EQ(a.samples[i].pressure, b.samples[i].pressure);
    }
}

TEST(FitTrajectory, LooksOnlyAtEdgesThatShow) {
    // A corner in the middle of what other lines cover stays as it was drawn.
    const auto drawn = [](const StrokeSamples& t) { return PaintStroke{.trace = t, .brush = kBrush, .ink = "carbon"}; };
    std::vector<PaintStroke> lines{drawn(through({{-0.005, 0}, {0, 0}, {0, 0.005}}))};
    const StrokeSamples before = lines[0].trace;
    for (int i = -5; i <= 5; ++i) lines.push_back(drawn(through({{-0.02, 2e-3 * i}, {0.02, 2e-3 * i}})));
    std::vector<PaintStroke*> all;
    for (PaintStroke& t : lines) all.push_back(&t);
    fit_trajectory(all, tables());
    ASSERT_EQ(lines[0].trace.samples.size(), before.samples.size());
    for (PaintStroke& t : lines) t.trace.placement.origin.x = &t == &lines[0] ? 1 : 0;  // now it lies elsewhere
    fit_trajectory(all, tables());
    EXPECT_NE(lines[0].trace.samples.size(), before.samples.size());
}

TEST(PlaneInk, AStraightLineIsAsWideAsItsPressure) {
    const StrokeSamples line = through({{-0.025, 0}, {0.025, 0}});
    const PlaneInk ink = plane_ink(line, brush::load_preset(kBrush), tables().holder(kBrush), 1e-4, 5e-5);
    double area = 0;
    for (double y = -0.005; y < 0.005; y += 5e-5)
        for (double x = -0.01; x < 0.01; x += 5e-5) area += ink.at({x + 2.5e-5, y + 2.5e-5}) * 2.5e-9;
    EXPECT_NEAR(area / 0.02, kWidth, 0.05 * kWidth);  // as LineWidth.ALineIsAsWideAsTheDrawingHasIt
    EXPECT_LT(ink.when({0.01, 0}), line.samples.back().time);
    EXPECT_GT(ink.when({0.01, 0}), ink.when({-0.01, 0}));
    EXPECT_LT(ink.when({0.01, 0.005}), 0);
}

}  // namespace
}  // namespace tuft::stroke
