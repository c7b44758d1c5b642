#include "writer/text/text.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "small_font.h"

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

/// A font of T, and of a solid square of almost four sides.
std::string small_font() {
    const std::string file = testing::TempDir() + "/tuft_text_" + std::to_string(getpid()) + ".ttf";
    const std::vector<FontRing> t{
        {{50, 600}, {50, 700}, {650, 700}, {650, 600}, {400, 600}, {400, 0}, {300, 0}, {300, 600}}};
    write_font(file, {{'T', t}, {'I', {font_box(300, 0, 400, 700)}}, {'W', {font_box(0, 0, 3900, 3900)}}});
    return file;
}

// Fitted to its outlines, a character of a font is strokes of a brush, equal ones the same; a pen's styles fill it.
TEST(Text, CharactersOfAFontAreStrokesWhereTheyAreFitted) {
    const std::string font = small_font();
    TextReader reader;
    EXPECT_TRUE(reader.read({.text = "T", .glyphs = font}).lines[0][0].strokes.empty());
    const Text fitted = reader.read({.text = "TTW", .glyphs = font, .fit = true});
    const std::vector<Glyph>& line = fitted.lines[0];
    for (const Glyph& glyph : {line[0], line[1]}) {
        EXPECT_TRUE(glyph.area.empty());
        ASSERT_EQ(glyph.strokes.size(), 2u);
        for (const GlyphStroke& stroke : glyph.strokes) EXPECT_FALSE(stroke.outline.empty());
    }
    EXPECT_EQ(line[0].strokes[0].median, line[1].strokes[0].median);
    EXPECT_FALSE(line[2].area.empty());
    EXPECT_EQ(fitted.kept_filled, 1u) << "W";
    const Text pen = reader.read({.text = "T", .glyphs = font, .style = "line", .fit = true});
    EXPECT_FALSE(pen.lines[0][0].area.empty());
    EXPECT_EQ(pen.kept_filled, 0u) << "none was to be strokes";
}

// 97 bars have more edges than lines are laid for. What is written has all its characters, or is refused by name. A
// character without an area, as some fonts have for a space, is no fault.
TEST(Text, ACharacterThatNoLinesFillIsNamed) {
    const std::string file = testing::TempDir() + "/tuft_bars_" + std::to_string(getpid()) + ".ttf";
    std::vector<FontRing> bars;
    for (int k = 0; k < 97; ++k) bars.push_back(font_box(0, 40 * k, 3900, 40 * k + 20));
    write_font(file, {{'B', bars}, {'I', {font_box(300, 0, 400, 700)}}, {'_', {font_box(0, 0, 0, 700)}}});
    const auto entries = [&](const std::string& letters) {
        Text text = TextReader().read({.text = letters, .glyphs = file});
        text.layout.side = 0.05;
        std::vector<stroke::JournalEntry> out;
        append_lines(out, text, {}, {});
        return out.size();
    };
    EXPECT_GT(entries("I_"), 0u);
    try {
        entries("IB");
        FAIL() << "B is left out";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(" B "), std::string::npos) << error.what();
    }
}

// A text is read at each key: only the character that is new is taken apart, and it can be stopped.
TEST(Text, ACharacterOfAFontIsTakenApartOnce) {
    const std::string font = small_font();
    TextReader reader;
    int asked = 0;
    const auto count = [&](std::string_view, double) { return ++asked, true; };
    const auto stop = [](std::string_view, double) { return false; };
    const auto strokes = [&](const std::string& text, const ProgressFn& progress) {
        return reader.read({.text = text, .glyphs = font, .fit = true}, progress).lines[0][0].strokes;
    };
    EXPECT_THROW(strokes("TW", stop), Cancelled);
    const std::vector<GlyphStroke> first = strokes("TW", count);
    EXPECT_EQ(asked, 1);
    EXPECT_EQ(strokes("TWT", stop)[0].median, first[0].median) << "nothing is left to be stopped, not of W either";
    EXPECT_EQ(reader.read({.text = "IT", .glyphs = font, .fit = true}, count).lines[0][1].strokes.size(), 2u);
    EXPECT_EQ(asked, 2);
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
