#include "io/strokes/area_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "stroke/surface/surface_stencil.h"

namespace tuft::io {
namespace {

using std::numbers::pi;

Ring circle(double r, int n = 90, Vec2 c = {0, 0}) {
    Ring ring;
    for (int i = 0; i < n; ++i) ring.push_back(c + r * Vec2(std::cos(2 * pi * i / n), std::sin(2 * pi * i / n)));
    return ring;
}
Ring box(double x0, double y0, double x1, double y1) {
    return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}
Ring star() {
    Ring ring;
    for (int i = 0; i < 10; ++i)
        ring.push_back((i % 2 ? 0.004 : 0.01) * Vec2(std::cos(pi * i / 5), std::sin(pi * i / 5)));
    return ring;
}

/// Distance from the nearest line in its half widths; below 1: painted. Straight pieces with widths that fall at
/// points.
double reach(const std::vector<AreaLine>& lines, const Vec2& p) {
    double least = 1e9;
    for (const AreaLine& l : lines) {
        if (stroke::inside_stencil(l.stencil, p) < 0) continue;
        double whole = 0, along = 0;
        for (std::size_t i = 1; i < l.line.size(); ++i) whole += glm::distance(l.line[i - 1], l.line[i]);
        for (std::size_t i = 1; i < l.line.size(); ++i) {
            const Vec2 a = l.line[i - 1], d = l.line[i] - a;
            const double length = glm::length(d),
                         t = length > 0 ? std::clamp(glm::dot(p - a, d) / (length * length), 0.0, 1.0) : 0;
            const double at = along + t * length;
            const double part = std::min(
                {1.0, l.taper_in > 0 ? at / l.taper_in : 1.0, l.taper_out > 0 ? (whole - at) / l.taper_out : 1.0});
            least = std::min(least, glm::distance(p, a + t * d) / std::max(0.5 * l.width * part, 1e-9));
            along += length;
        }
    }
    return least;
}

struct Shape {
    const char* name;
    std::vector<Ring> rings;
    std::function<bool(const Vec2&)> within;
    double extent;
};

TEST(AreaLines, CoverTheAreaAndLittleElse) {
    const std::vector<Shape> shapes{
        {"disk", {circle(0.01)}, [](const Vec2& p) { return glm::length(p) < 0.01; }, 0.012},
        {"ring",
         {circle(0.01), circle(0.007)},
         [](const Vec2& p) { return glm::length(p) < 0.01 && glm::length(p) > 0.007; },
         0.012},
        {"eccentric ring",
         {circle(0.01), circle(0.006, 90, {0.0025, 0})},
         [](const Vec2& p) { return glm::length(p) < 0.01 && glm::distance(p, Vec2(0.0025, 0)) > 0.006; },
         0.012},
        {"square",
         {box(-0.01, -0.01, 0.01, 0.01)},
         [](const Vec2& p) { return std::max(std::abs(p.x), std::abs(p.y)) < 0.01; },
         0.012},
        {"stem",
         {box(-0.02, -0.001, 0.02, 0.001)},
         [](const Vec2& p) { return std::abs(p.x) < 0.02 && std::abs(p.y) < 0.001; },
         0.022},
        {"square with a stem",
         {{{-0.01, -0.01},
           {0.01, -0.01},
           {0.01, -0.0004},
           {0.022, -0.0004},
           {0.022, 0.0004},
           {0.01, 0.0004},
           {0.01, 0.01},
           {-0.01, 0.01}}},
         [](const Vec2& p) {
             return std::max(std::abs(p.x), std::abs(p.y)) < 0.01 ||
                    (p.x >= 0.01 && p.x < 0.022 && std::abs(p.y) < 0.0004);
         },
         0.023},
    };
    for (const Shape& s : shapes) {
        const auto lines = area_lines(s.rings, FillRule::even_odd);
        ASSERT_FALSE(lines.empty()) << s.name;
        double width = 0;
        for (const AreaLine& l : lines) width = std::max(width, l.width);
        int inside = 0, bare = 0, spilt = 0;
        constexpr int n = 120;
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const Vec2 p = s.extent * Vec2((2 * i + 1.0) / n - 1, (2 * j + 1.0) / n - 1);
                const bool in = s.within(p), painted = reach(lines, p) < 1;
                inside += in;
                bare += in && !painted;
                spilt += !in && painted;
            }
        // Lines 0.2 w past the outline reach into square corners; chords of the circles cut off 0.1 % of them.
        EXPECT_LT(bare, 0.002 * inside) << s.name;
        EXPECT_LT(spilt, 0.002 * inside) << s.name;
    }
}

// What a scanner or a tracing program makes of a disk is drawn as the disk is, up to its own outline.
TEST(AreaLines, AJaggedOutlineIsDrawnAsASmoothOne) {
    const double r = 0.04;
    const auto smooth = area_lines(std::vector<Ring>{circle(r, 360)}, FillRule::nonzero);
    Ring jagged = circle(r, 6000), stairs;
    for (std::size_t i = 0; i < jagged.size(); ++i) jagged[i] *= 1 + (i % 2 ? 5e-4 : -5e-4);
    for (const Vec2& p : circle(r, 6000)) {
        const Vec2 at = 1e-4 * glm::round(1e4 * p);
        if (!stairs.empty() && stairs.back().x != at.x && stairs.back().y != at.y)
            stairs.push_back({at.x, stairs.back().y});
        if (stairs.empty() || stairs.back() != at) stairs.push_back(at);
    }
    for (const Ring& ring : {jagged, stairs}) {
        const auto lines = area_lines(std::vector<Ring>{ring}, FillRule::nonzero);
        ASSERT_EQ(lines.size(), smooth.size());
        const AreaLine &line = lines.back(), &same = smooth.back();
        EXPECT_NEAR(line.width, same.width, 0.02 * same.width);
        // Of the outermost, as far from the middle and as evenly bent: its points turn by no more than some of a
        // circle's, of which there are 2π r / (0.1 w) at most.
        const double bend = 2 * 0.1 * line.width / (r - 0.3 * line.width);
        for (std::size_t i = 1; i + 1 < line.line.size(); ++i) {
            EXPECT_NEAR(glm::length(line.line[i]), r - 0.22 * line.width, 0.03 * line.width);
            const Vec2 in = glm::normalize(line.line[i] - line.line[i - 1]),
                       out = glm::normalize(line.line[i + 1] - line.line[i]);
            EXPECT_LT(std::acos(std::min(1.0, glm::dot(in, out))), bend) << i;
        }
        EXPECT_GT(line.stencil.size(), ring.size() / 2) << "the stencil is the outline's own";
    }
}

// Teeth deeper than what lines leave out, one beside the other: a hundred would cross each other at the line's
// distance.
TEST(AreaLines, ADeeplyJaggedOutlineIsFilledToo) {
    Ring teeth = circle(0.04, 3000);
    for (std::size_t i = 0; i < teeth.size(); ++i) teeth[i] *= i % 2 ? 1.0025 : 0.9975;
    const auto lines = area_lines(std::vector<Ring>{teeth}, FillRule::nonzero);
    for (int i = 0; i < 400; ++i) {
        const Vec2 p = 0.0395 * std::sqrt((i + 0.5) / 400) * Vec2(std::cos(2.4 * i), std::sin(2.4 * i));
        EXPECT_LT(reach(lines, p), 1) << glm::length(p);
    }
}

TEST(AreaLines, TaperIntoCorners) {
    const std::vector<Ring> rings{star()};
    const auto lines = area_lines(rings, FillRule::nonzero);
    // Each of the five tips is met by the end of a line that falls to nothing there.
    for (int i = 0; i < 10; i += 2) {
        double nearest = 1;
        for (const AreaLine& l : lines) {
            // It goes on half a width past the corner.
            const auto passes = [&](const Vec2& end, const Vec2& before) {
                return glm::distance(end - 0.5 * l.width * glm::normalize(end - before), rings[0][i]);
            };
            if (l.taper_in > 0) nearest = std::min(nearest, passes(l.line.front(), l.line[1]));
            if (l.taper_out > 0) nearest = std::min(nearest, passes(l.line.back(), l.line[l.line.size() - 2]));
        }
        // Points lie a tenth of a width apart, so that the path ahead leaves the tip's middle by half of that, and its
        // side, which is 24 degrees off, by 0.05 w / tan 24 = 0.11 w before the end; twice for both sides' chords.
        EXPECT_LT(nearest, 0.22 * lines[0].width) << i;
    }
}

TEST(AreaLines, HolesFollowTheRule) {
    const std::vector<Ring> rings{box(-0.01, -0.01, 0.01, 0.01), box(-0.004, -0.004, 0.004, 0.004)};
    EXPECT_LT(reach(area_lines(rings, FillRule::nonzero), {0, 0}), 1) << "both run the same way";
    EXPECT_GT(reach(area_lines(rings, FillRule::even_odd), {0, 0}), 1);
    std::vector<Ring> turned = rings;
    std::reverse(turned[1].begin(), turned[1].end());
    EXPECT_GT(reach(area_lines(turned, FillRule::nonzero), {0, 0}), 1);
}

TEST(AreaLines, AreTheSameInEverySize) {
    const std::vector<Ring> rings{star()};
    std::vector<Ring> large = rings;
    for (Vec2& p : large[0]) p *= 8.0;
    const auto a = area_lines(rings, FillRule::nonzero), b = area_lines(large, FillRule::nonzero);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(b[i].width, 8 * a[i].width, 1e-12);
}

TEST(AreaLines, WithoutAreaThereAreNone) {
    EXPECT_TRUE(area_lines(std::vector<Ring>{{{0, 0}, {1, 1}}}, FillRule::nonzero).empty());
    EXPECT_TRUE(area_lines(std::vector<Ring>{}, FillRule::nonzero).empty());
    EXPECT_TRUE(area_lines(std::vector<Ring>{{{0, 0}, {0, 0}, {0, 0}}}, FillRule::even_odd).empty());
    EXPECT_TRUE(area_lines(std::vector<Ring>{circle(1, 100'000)}, FillRule::nonzero).empty())
        << "more edges than it takes";
}

}  // namespace
}  // namespace tuft::io
