#include "writer/text/text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "io/font/installed_fonts.h"

namespace tuft::writer {
namespace {

Text text_of(const std::string& text, double side = 0.02) {
    Text out = TextReader().read({.text = text});
    out.layout.side = side;
    return out;
}

TEST(Text, ItsGroupIsNamedByItWithoutBreaksAndSlashes) {
    EXPECT_EQ(group_of("a/b\nc"), "a b c");
    EXPECT_EQ(text_of("\xe6\xb0\xb8\n\xe6\x98\xa5").group, "\xe6\xb0\xb8 \xe6\x98\xa5");
}

// Fitted to its outlines, a character of a font is strokes of a brush, equal ones the same; a pen's styles fill it.
TEST(Text, CharactersOfAFontAreStrokesWhereTheyAreFitted) {
    const io::InstalledFont font = io::find_font({.families = {"sans-serif"}});
    if (font.file.empty()) GTEST_SKIP() << "no font is installed";
    TextReader reader;
    const Glyph filled = reader.read({.text = "T", .glyphs = font.family}).lines[0][0];
    EXPECT_TRUE(filled.strokes.empty());
    const Text fitted = reader.read({.text = "TT", .glyphs = font.family, .fit = true});
    for (const Glyph& glyph : fitted.lines[0]) {
        EXPECT_TRUE(glyph.area.empty());
        ASSERT_EQ(glyph.strokes.size(), 2u);
        for (const GlyphStroke& stroke : glyph.strokes) EXPECT_FALSE(stroke.outline.empty());
    }
    EXPECT_EQ(fitted.lines[0][0].strokes[0].median, fitted.lines[0][1].strokes[0].median);
    EXPECT_FALSE(
        reader.read({.text = "T", .glyphs = font.family, .style = "line", .fit = true}).lines[0][0].area.empty());
}

TEST(Text, EmptyLinesAtItsEndAreNone) {
    EXPECT_EQ(text_of("\xe6\xb0\xb8\n\n").lines.size(), 1u);
    EXPECT_EQ(text_of("\n\xe6\xb0\xb8").lines.size(), 2u) << "one at its beginning is a space";
    EXPECT_TRUE(text_of("\n\n").blank());
}

TEST(Text, SourcesAreOpenedAgainOnlyWhereTheyChange) {
    TextReader reader;
    EXPECT_FALSE(reader.read({.text = "\xe6\xb0\xb8"}).blank());
    EXPECT_THROW(reader.read({.text = "\xe6\xb0\xb8", .glyphs = "nowhere"}), Error);
    EXPECT_THROW(reader.read({.text = "\xe6\xb0\xb8", .glyphs = "nowhere"}), Error) << "not taken for opened";
    EXPECT_FALSE(reader.read({.text = "\xe6\xb0\xb8"}).blank());
}

// Two squares of side 1, `spacing` apart.
TEST(Text, ExtentIsThatOfItsSquares) {
    const Text text = text_of("\xe6\xb0\xb8\xe6\x98\xa5");
    const Vec2 extent = extent_of(text);
    EXPECT_NEAR(extent.x, 1 + text.style.spacing, 1e-12);  // rounding
    EXPECT_NEAR(extent.y, 1, 1e-12);
    EXPECT_NEAR(length_of(text), 2 * text.style.spacing, 1e-12);
}

// In a column a letter is as long as its advance on a line, and leans to its own right.
TEST(Text, LettersLieOnTheirSideInAColumn) {
    Text text = text_of("\xe6\xb0\xb8I");
    const double width = length_of(text);
    const Vec2 line = extent_of(text);
    text.layout.direction = Direction::vertical;
    text.layout.spacing = 1;
    const Vec2 column = extent_of(text);
    const double letter = text.lines[0][1].advance / kSide;
    EXPECT_NEAR(column.x, 1, 1e-12);
    EXPECT_NEAR(column.y, 1 + 0.25 + letter, 1e-12);  // a quarter of the side parts Han from Latin
    EXPECT_NEAR(line.y, 1, 1e-12);
    EXPECT_NEAR(width, 1.05 * (1 + letter) + 0.25, 1e-12);
    const auto lines = outlined_lines(text);
    const Vec2 stem = lines.back().back() - lines.back().front();  // of I: from its top to its foot
    EXPECT_LT(stem.x, 0) << "its top is to the right";
    EXPECT_NEAR(stem.y, 0, 1e-12);
}

TEST(Text, OutlinesLieInTheirSquares) {
    const Text text = text_of("\xe6\xb0\xb8", 0.02);
    const auto lines = outlined_lines(text);
    const auto alone = outlined_characters(text);
    ASSERT_EQ(lines.size(), text.lines[0][0].strokes.size());
    ASSERT_EQ(alone.size(), 1u);
    ASSERT_EQ(alone[0].size(), lines.size());
    for (const auto& line : alone[0])
        for (const Vec2& p : line) EXPECT_LT(std::max(std::abs(p.x), std::abs(p.y)), 0.01) << "half the side";
    // The same lines, moved.
    const Vec2 shift = lines[0][0] - alone[0][0][0];
    for (std::size_t i = 0; i < lines.size(); ++i)
        for (std::size_t k = 0; k < lines[i].size(); ++k)
            EXPECT_NEAR(glm::distance(lines[i][k] - shift, alone[0][i][k]), 0, 1e-15);
}

TEST(Text, ALongTextIsALineForEachRow) {
    const auto rows = middle_lines(text_of("\xe6\xb0\xb8\xe6\xb0\xb8\xe6\xb0\xb8\n\xe6\xb0\xb8"));
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].size(), 3u);
    EXPECT_EQ(rows[1].size(), 1u);
}

TEST(Text, AlongAPathItHasOneLine) {
    const ModelPath path{.points = {{0, 0, 0}, {1, 0, 0}}, .normals = {{0, 0, 1}, {0, 0, 1}}};
    EXPECT_EQ(places_along(text_of("\xe6\xb0\xb8\xe6\x98\xa5"), path, 0.5).size(), 2u);
    EXPECT_THROW(places_along(text_of("\xe6\xb0\xb8\n\xe6\x98\xa5"), path, 0.5), Error);
    EXPECT_THROW(places_along(text_of("\xe6\xb0\xb8\xe6\x98\xa5", 0.9), path, 0.5), Error) << "too long";
}

}  // namespace
}  // namespace tuft::writer
