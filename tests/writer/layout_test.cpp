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

Glyph bar(char32_t code, double advance) {  // a level stroke 100 units above the square's lower edge
    return {.code = code, .strokes = {{.median = {{10, 100}, {110, 100}}}}, .advance = advance};
}

// By Unicode's data file VerticalOrientation.txt: U, Tu, Tr and R.
TEST(Layout, FormsInAColumnAreThoseOfUnicode) {
    for (const char32_t c : std::u32string(U"永あア가・〇"))
        EXPECT_EQ(column_form(c), ColumnForm::upright) << utf8_of(c);
    for (const char32_t c : std::u32string(U"、。，．っャぁゎゖォヮヶㇰㇿ"))
        EXPECT_EQ(column_form(c), ColumnForm::corner) << utf8_of(c);
    for (const char32_t c : std::u32string(U"aZ7é(…—「」《》（）：ー～“"))
        EXPECT_EQ(column_form(c), ColumnForm::sideways) << utf8_of(c);
}

TEST(Layout, LatinLiesOnItsSideInAColumnAndTakesItsAdvance) {
    const Glyph a = in_column(bar(U'a', 400));
    EXPECT_EQ(a.strokes[0].median[0], Vec2(100, 390));  // its right end is down, its top to the right
    EXPECT_EQ(a.strokes[0].median[1], Vec2(100, 290));
    EXPECT_EQ(a.down, 400);
    EXPECT_EQ(a.advance, kSide);
    const auto at = place_in_lines({{in_column(bar(U'永', kSide)), a, in_column(bar(U'永', kSide))}},
                                   {.direction = Direction::vertical, .side = 1.024, .spacing = 1, .line_spacing = 1});
    EXPECT_NEAR(at[0][2].y - at[0][0].y, 1.424, 1e-12);
    EXPECT_NEAR(at[0][1].y - at[0][0].y, 0.4, 1e-12);  // lower edges
    EXPECT_NEAR(at[0][1].x, at[0][0].x, 1e-12);
}

// A comma stands in the lower left of its square on a line, and in the upper right in a column.
TEST(Layout, ACommaStandsInTheOtherCornerInAColumn) {
    const Glyph comma = in_column(bar(U'，', kSide));
    EXPECT_EQ(comma.strokes[0].median[0], Vec2(kSide - 110, kSide - 100));
    EXPECT_EQ(comma.strokes[0].median[1], Vec2(kSide - 10, kSide - 100));
    EXPECT_EQ(comma.down, kSide);
}

TEST(Layout, AQuarterOfTheSidePartsHanFromLatin) {
    std::vector<Glyph> line{bar(U'永', kSide), bar(U'a', 400), bar(U'7', 400), bar(U'永', kSide), bar(U'。', kSide)};
    space_scripts(line);
    const double want[] = {0.25 * kSide, 0, 0.25 * kSide, 0, 0};
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(line[i].after, want[i]) << i;
    const LayoutOptions options{.side = 1.024, .spacing = 1, .line_spacing = 1};
    const auto at = place_in_lines({line}, options);
    EXPECT_NEAR(at[0][1].x - at[0][0].x, 1.28, 1e-12);
    EXPECT_NEAR(at[0][2].x - at[0][1].x, 0.4, 1e-12);
    const ModelPath path{.points = {{0, 0, 0}, {9, 0, 0}}, .normals = {{0, 0, 1}, {0, 0, 1}}};
    const auto along = place_along(path, line, 4.5, options);  // middles
    EXPECT_NEAR(along[1] - along[0], 0.5 * 1.024 + 0.256 + 0.2, 1e-12);
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
    // A byte order mark, a selector of a variant and a joiner have no form.
    EXPECT_EQ(lines_of("\xef\xbb\xbf\xe8\x91\x9b\xf3\xa0\x84\x80\xe2\x80\x8d"), std::vector{std::u32string(U"\u845B")});
}

}  // namespace
}  // namespace tuft::writer
