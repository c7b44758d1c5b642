#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "writer/layout/text_layout.h"

namespace tuft::writer {
namespace {

std::vector<Glyph> squares(std::size_t n) {
    return std::vector<Glyph>(n, Glyph{.code = U'永'});
}

ModelPath circle(double radius, int n) {
    ModelPath path{.closed = true};
    for (int i = 0; i < n; ++i) {
        const double a = 2 * std::numbers::pi * i / n;
        path.points.push_back(radius * Vec3(std::cos(a), std::sin(a), 0));
        path.normals.emplace_back(std::cos(a), std::sin(a), 0);
    }
    return path;
}

TEST(Layout, HorizontalLinesAreCentredAndGoDown) {
    const auto at = place_in_lines({squares(3), squares(1)}, {.side = 0.1, .spacing = 1, .line_spacing = 1.5});
    EXPECT_NEAR(at[0][0].x, -0.15, 1e-12);
    EXPECT_NEAR(at[0][2].x, 0.05, 1e-12);
    EXPECT_NEAR(at[1][0].x, -0.05, 1e-12);              // in the middle under the three
    EXPECT_NEAR(at[1][0].y - at[0][0].y, 0.15, 1e-12);  // y is down
}

TEST(Layout, ColumnsGoFromRightToLeft) {
    const auto at = place_in_lines({squares(2), squares(2)},
                                   {.direction = Direction::vertical, .side = 0.1, .spacing = 1, .line_spacing = 1.5});
    EXPECT_NEAR(at[1][0].x - at[0][0].x, -0.15, 1e-12);
    EXPECT_NEAR(at[0][1].y - at[0][0].y, 0.1, 1e-12);
    EXPECT_NEAR(at[0][0].x, at[0][1].x, 1e-12);
}

TEST(Layout, RoundARimCharactersStandAtEqualArcs) {
    const ModelPath path = circle(0.05, 3600);
    const double whole = path.length();
    EXPECT_NEAR(whole, 2 * std::numbers::pi * 0.05, 1e-6);  // chords of 3600 corners
    const auto glyphs = squares(10);
    const std::vector<double> at =
        place_along(path, glyphs, 0, {.direction = Direction::rim, .side = 0.02, .spacing = 1.2});
    for (std::size_t i = 1; i < at.size(); ++i) EXPECT_NEAR(at[i] - at[i - 1], 0.024, 1e-12);
    EXPECT_NEAR(0.5 * (at.front() + at.back()), 0, 1e-12);  // the middle stands at the named point
    for (const double s : at) {
        const PathPlace p = place_on(path, s, 0.005);
        const double angle = s / 0.05;
        EXPECT_LT(glm::distance(p.position, 0.05 * Vec3(std::cos(angle), std::sin(angle), 0)), 1e-6);
        EXPECT_NEAR(glm::dot(p.right, p.normal), 0, 1e-9);
    }
}

TEST(Layout, ATextLongerThanItsPathIsRefused) {
    EXPECT_THROW(place_along(circle(0.01, 360), squares(10), 0, {.side = 0.02}), Error);
}

TEST(Layout, LinesBreakAtNewlines) {
    EXPECT_EQ(lines_of("ab\ncd").size(), 2u);
    EXPECT_EQ(lines_of("ab\\ncd")[1], U"cd");
    EXPECT_EQ(lines_of("").size(), 1u);
}

}  // namespace
}  // namespace tuft::writer
