#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "io/font/font.h"
#include "io/font/installed_fonts.h"
#include "io/svg/svg.h"
#include "stroke/painting/apply_area.h"

/// Text of drawings. 100 units are 100 mm. Every test holds for whatever font is installed as "sans-serif".
namespace tuft::io {
namespace {

using stroke::FlatArea;

// Outlines are chords within 1e-5 of the page (0.001 mm here), so equal texts are equal within twice that.
constexpr double kChord = 0.002;

struct Read {
    std::vector<FlatArea> areas;
    std::vector<std::string> notes;
};

Read read(const std::string& inside) {
    Read out;
    SvgOptions options{.painting = SvgPainting::areas};
    options.ink.note = [&](const Message& line) { out.notes.push_back(line.text()); };
    for (const stroke::RecordedStroke& r :
         parse_svg("<svg xmlns:xlink='http://www.w3.org/1999/xlink' width='100mm' height='100mm' viewBox='0 0 100 100'>"
                   "<g font-family='sans-serif' font-size='10' fill='#800000'>" +
                       inside + "</g></svg>",
                   "a.svg", options))
        out.areas.push_back(*std::get<stroke::Fill>(r.before.at(0)).area);
    return out;
}

struct Extent {
    double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;  // mm
    double width() const { return right - left; }
};

Extent extent(const std::string& inside) {
    Extent e;
    for (const FlatArea& area : read(inside).areas)
        for (const auto& ring : area.rings)
            for (const Vec2& p : ring) {
                e.left = std::min(e.left, 1e3 * p.x), e.right = std::max(e.right, 1e3 * p.x);
                e.top = std::min(e.top, 1e3 * p.y), e.bottom = std::max(e.bottom, 1e3 * p.y);
            }
    return e;
}

void expect_same(const std::string& a, const std::string& b, double shift_x = 0, double shift_y = 0) {
    const Extent p = extent(a), q = extent(b);
    ASSERT_GT(p.width(), 0) << a;
    EXPECT_NEAR(p.left + shift_x, q.left, kChord) << a << b;
    EXPECT_NEAR(p.right + shift_x, q.right, kChord) << a << b;
    EXPECT_NEAR(p.top + shift_y, q.top, kChord) << a << b;
    EXPECT_NEAR(p.bottom + shift_y, q.bottom, kChord) << a << b;
}

// Sum of the pen's advances of a text, units, by the font itself.
double advance(const std::u32string& text, double size) {
    Font font(find_font({.families = {"sans-serif"}}).file, find_font({.families = {"sans-serif"}}).face);
    double sum = 0;
    for (const ShapedGlyph& glyph : font.shape(text)) sum += size * glyph.advance;
    return sum;
}

TEST(SvgText, AnchorMovesATextByItsAdvance) {
    const double length = advance(U"Racing", 10);
    expect_same("<text x='50' y='50'>Racing</text>", "<text x='50' y='50' text-anchor='middle'>Racing</text>",
                -length / 2);
    expect_same("<text x='50' y='50'>Racing</text>", "<text x='50' y='50' style='text-anchor:end'>Racing</text>",
                -length);
}

TEST(SvgText, GrowsWithItsSizeAndItsTransformAlike) {
    expect_same("<text x='10' y='40' font-size='20'>Team</text>",
                "<text x='5' y='20' transform='scale(2)'>Team</text>");
    expect_same("<text x='10' y='40' font-size='2em'>Team</text>",
                "<g font-size='5'><text x='10' y='40' font-size='400%'>Team</text></g>");
    expect_same("<text x='10' y='40' style='font:20px sans-serif'>Team</text>",
                "<text x='10' y='40' font-size='20'>Team</text>");
}

TEST(SvgText, BlanksAreCollapsedUnlessTheyArePreserved) {
    expect_same("<text x='10' y='50'>a b</text>", "<text x='10' y='50'>\n  a\n \t b  </text>");
    expect_same("<text x='10' y='50'>a b</text>", "<text x='10' y='50'> a <tspan> b</tspan> </text>");
    const double blank = advance(U" ", 10);
    EXPECT_NEAR(extent("<text x='10' y='50' xml:space='preserve'>a  b</text>").width(),
                extent("<text x='10' y='50'>a b</text>").width() + blank, kChord);
}

TEST(SvgText, PositionsOfCharactersAreTheirs) {
    // Each character with its x stands where a text of its own would.
    const std::string one = "<text y='50' x='10 40 70'>abc</text>";
    const std::string three = "<text y='50' x='10'>a</text><text y='50' x='40'>b</text><text y='50' x='70'>c</text>";
    expect_same(one, three);
    // An inner element's positions go before its parent's; characters without one follow.
    expect_same("<text y='50' x='10 20 30'>a<tspan x='60'>bc</tspan></text>",
                "<text y='50' x='10'>a</text><text y='50' x='60'>b</text><text y='50' x='30'>c</text>");
    expect_same("<text x='10' y='50'>ab</text>", "<text x='10' y='50' dx='5' dy='-3'>ab</text>", 5, -3);
    const double a = advance(U"a", 10);
    expect_same("<text x='10' y='50' rotate='90'>aa</text>",
                "<text transform='translate(10 50) rotate(90)'>a</text><text transform='translate(" +
                    std::to_string(10 + a) + " 50) rotate(90)'>a</text>");
}

TEST(SvgText, LengthIsWhatTheFileAsksFor) {
    const double natural = advance(U"HHHH", 10);
    const Extent plain = extent("<text x='10' y='50'>HHHH</text>");
    const std::string to = std::to_string(1.5 * natural);
    const Extent glyphs =
        extent("<text x='10' y='50' textLength='" + to + "' lengthAdjust='spacingAndGlyphs'>HHHH</text>");
    EXPECT_NEAR(glyphs.left - 10, 1.5 * (plain.left - 10), kChord);
    EXPECT_NEAR(glyphs.right - 10, 1.5 * (plain.right - 10), kChord);
    const Extent spaced = extent("<text x='10' y='50' textLength='" + to + "'>HHHH</text>");
    EXPECT_NEAR(spaced.left, plain.left, kChord);
    EXPECT_NEAR(spaced.right, plain.right + 0.5 * natural, kChord);
    const Extent letters = extent("<text x='10' y='50' letter-spacing='2'>HHHH</text>");
    EXPECT_NEAR(letters.right, plain.right + 6, kChord);
    // An underline reaches from the first character's pen to the last one's end, without gaps.
    const std::string under = "<text x='10' y='50' textLength='60' text-decoration='underline'>H H</text>";
    EXPECT_NEAR(extent(under).left, 10, kChord);
    EXPECT_NEAR(extent(under).right, 70, kChord);
}

TEST(SvgText, OnAStraightPathIsAsOnALine) {
    expect_same("<defs><path id='p' d='M10 60 H95'/></defs><text><textPath xlink:href='#p'>Round</textPath></text>",
                "<text x='10' y='60'>Round</text>");
    expect_same(
        "<defs><path id='p' d='M10 60 H90'/></defs><text text-anchor='middle'><textPath href='#p' "
        "startOffset='50%'>Round</textPath></text>",
        "<text x='50' y='60' text-anchor='middle'>Round</text>");
}

// Middles of characters on a circle have its radius: a text of one letter, turned by its place on the circle, is that
// letter set upright at the top.
TEST(SvgText, OnACircleEveryCharacterIsTheFirstOneTurned) {
    const double r = 30, a = advance(U"o", 10);
    const std::string circle = "<defs><path id='c' d='M50 20 A30 30 0 0 1 50 80 A30 30 0 0 1 50 20'/></defs>";
    const std::string around = circle + "<text><textPath href='#c' startOffset='20'>ooo</textPath></text>";
    std::string turned;
    for (int k = 0; k < 3; ++k) {
        const double angle = (20 + (k + 0.5) * a) / r * 180 / std::numbers::pi;
        turned += "<text transform='rotate(" + std::to_string(angle) + " 50 50)' x='" + std::to_string(50 - a / 2) +
                  "' y='20'>o</text>";
    }
    const Extent p = extent(around), q = extent(turned);
    // The circle is chords within 0.001 mm, which turn a letter by up to their half angle, 0.5 degrees: 0.05 mm at 5.
    for (const auto& [x, y] : {std::pair(p.left, q.left), std::pair(p.right, q.right), std::pair(p.top, q.top),
                               std::pair(p.bottom, q.bottom)})
        EXPECT_NEAR(x, y, 0.05);
    EXPECT_NE(read(circle +
                   "<rect width='1' height='1'/><text><textPath href='#c' startOffset='99%'>oooooo</textPath></text>")
                  .notes.size(),
              0u);
}

TEST(SvgText, VerticalCharactersStandAnEmApartOnOneAxis) {
    const Extent one = extent("<text x='50' y='10' writing-mode='tb'>H</text>"),
                 two = extent("<text x='50' y='10' writing-mode='vertical-rl'>HH</text>");
    EXPECT_NEAR(0.5 * (one.left + one.right), 50, 0.2);  // side bearings of an H are about equal
    EXPECT_NEAR(two.left, one.left, kChord);
    EXPECT_NEAR(two.bottom, one.bottom + 10, kChord);
}

TEST(SvgText, ElementsKeepTheirColoursAndFonts) {
    const Read r = read("<text x='10' y='50'>red <tspan fill='#000080' font-weight='bold'>blue</tspan> red</text>");
    ASSERT_EQ(r.areas.size(), 2u);
    EXPECT_EQ(r.areas[0].stops.at(0).ink, "#800000");
    EXPECT_EQ(r.areas[1].stops.at(0).ink, "#000080");
    EXPECT_FALSE(r.areas[0].reading.part.empty());  // a mirrored copy keeps text readable
    EXPECT_EQ(r.areas[0].reading.part, r.areas[1].reading.part);
    EXPECT_NE(extent("<text x='10' y='50' font-weight='bold'>mmm</text>").width(),
              extent("<text x='10' y='50'>mmm</text>").width());
}

TEST(SvgText, IsHiddenAsTheFileSays) {
    expect_same("<text x='10' y='50'>ab</text>", "<text x='10' y='50'>ab<tspan display='none'>never</tspan></text>");
    expect_same("<text x='10' y='50'>ab</text>",
                "<text x='10' y='50'>ab<tspan visibility='hidden'>never</tspan></text>");
    EXPECT_TRUE(read("<rect width='9' height='9'/><text display='none'>no</text>").notes.empty());
}

TEST(SvgText, SaysWhichFontItLacks) {
    const auto notes = read("<text x='10' y='50' font-family='No Such Font 7'>a</text>").notes;
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_NE(notes[0].find("'No Such Font 7' is not installed"), std::string::npos) << notes[0];
    // A private character has a glyph in no text font.
    const auto lost = read("<text x='10' y='50'>a&#x10FFFD;&#x10FFFD;</text>").notes;
    ASSERT_EQ(lost.size(), 1u);
    EXPECT_EQ(lost[0].substr(0, 2), "2 ");
}

TEST(SvgText, ClipsAndPaintsLikeAnyShape) {
    const auto area = [](const std::string& inside) {
        double sum = 0;
        for (const FlatArea& a : read(inside).areas) {
            const double cell = 2e-5;
            const stroke::AreaRaster raster(a, cell);
            for (double y = raster.low().y; y < raster.high().y; y += cell)
                for (double x = raster.low().x; x < raster.high().x; x += cell)
                    sum += 1e6 * cell * cell * raster.mean({x + cell / 2, y + cell / 2}, 1e-9);
        }
        return sum;
    };
    const std::string word = "<text x='5' y='50' font-size='20'>HI</text>";
    const double ink = area(word);
    EXPECT_GT(ink, 20);
    EXPECT_NEAR(area("<clipPath id='t'>" + word + "</clipPath><rect width='100' height='100' clip-path='url(#t)'/>"),
                ink, 0.01 * ink);  // cells of 0.02 mm at edges
}

TEST(SvgText, TooMuchIsRefusedInALine) {
    const auto fault = [](const std::string& inside) {
        try {
            read(inside);
            return std::string();
        } catch (const Error& e) {
            return std::string(e.what());
        }
    };
    std::string nested = "<text>";
    for (int i = 0; i < 100; ++i) nested += "<tspan>";
    nested += "a";
    for (int i = 0; i < 100; ++i) nested += "</tspan>";
    EXPECT_NE(fault(nested + "</text>"), "");
    EXPECT_NE(fault("<text>" + std::string(200'000, 'a') + "</text>"), "");
    EXPECT_NE(fault("<text x='1 2 nonsense'>a</text>") + fault("<text font-size='1e300'>a</text>") +
                  fault("<text x='nan'>a</text>"),
              "never thrown: they may be passed over, but must not crash");
    EXPECT_EQ(fault("<rect width='1' height='1'/><text/><text><textPath href='#none'>a</textPath></text>"), "");
    EXPECT_EQ(fault("<path id='p' d='M0 0'/><rect width='1' height='1'/><text><textPath href='#p'>a</textPath></text>"),
              "");
}

// Chords of an outline lie within the tolerance of the curve: a coarse outline's area differs from a fine one's by no
// more than its length times the tolerance.
TEST(Font, OutlinesAreWithinTheirTolerance) {
    Font font(find_font({.families = {"sans-serif"}}).file, find_font({.families = {"sans-serif"}}).face);
    const auto measure = [&](double tolerance) {
        double area = 0, length = 0;
        for (const ShapedGlyph& glyph : font.shape(U"O8&", {.tolerance = tolerance}))
            for (const auto& ring : glyph.rings)
                for (std::size_t i = 0; i < ring.size(); ++i) {
                    const Vec2 &p = ring[i], &q = ring[(i + 1) % ring.size()];
                    area += 0.5 * (p.x * q.y - q.x * p.y);
                    length += glm::distance(p, q);
                }
        return std::pair(area, length);
    };
    const auto [fine, length] = measure(1e-6);
    for (const double tolerance : {1e-2, 1e-3, 1e-4})
        EXPECT_NEAR(measure(tolerance).first, fine, tolerance * length) << tolerance;
}

TEST(Font, DamagedFilesAreRefused) {
    EXPECT_THROW(Font("/dev/null"), Error);
    EXPECT_THROW(Font(__FILE__), Error);
}

}  // namespace
}  // namespace tuft::io
