#include "io/svg/svg.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"

namespace tuft::io {
namespace {

std::vector<stroke::RecordedStroke> drawn(const std::string& inside,
                                          const std::string& size = "width='100mm' viewBox='0 0 100 100'") {
    return parse_svg("<svg xmlns='http://www.w3.org/2000/svg' fill='none' " + size + ">" + inside + "</svg>",
                     "test.svg");
}
Vec2 first(const stroke::RecordedStroke& t) {
    return Vec2(t.samples.front().position) * 1e3;
}
Vec2 last(const stroke::RecordedStroke& t) {
    return Vec2(t.samples.back().position) * 1e3;
}
double length(const stroke::RecordedStroke& t) {
    double sum = 0;
    for (std::size_t i = 1; i < t.samples.size(); ++i)
        sum += glm::distance(t.samples[i - 1].position, t.samples[i].position);
    return 1e3 * sum;
}
void expect_near(const Vec2& a, const Vec2& b) {
    EXPECT_NEAR(a.x, b.x, 1e-6);
    EXPECT_NEAR(a.y, b.y, 1e-6);
}

TEST(Svg, UnitsFollowWidthAndViewBox) {
    const auto mm = drawn("<line x1='10' y1='20' x2='30' y2='20'/>");
    expect_near(first(mm[0]), {10, 20});
    expect_near(last(mm[0]), {30, 20});
    // 96 units are an inch where nothing is said.
    EXPECT_NEAR(length(drawn("<line x1='0' y1='0' x2='96' y2='0'/>", "")[0]), 25.4, 1e-6);
    EXPECT_NEAR(length(drawn("<line x1='0' y1='0' x2='1' y2='0'/>", "width='2in' viewBox='0 0 4 4'")[0]), 12.7, 1e-6);
}

TEST(Svg, CirclesAndArcsHaveTheirLength) {
    // Chords that stay within e of an arc of radius r are shorter than it by a part e / 3r: 20 µm of 5 mm is 0.13 %.
    EXPECT_NEAR(length(drawn("<circle cx='50' cy='50' r='5'/>")[0]), 10 * std::numbers::pi,
                0.0015 * 10 * std::numbers::pi);
    const auto half = drawn("<path d='M 0 0 A 10 10 0 0 1 20 0'/>");
    EXPECT_NEAR(length(half[0]), 10 * std::numbers::pi, 0.0015 * 10 * std::numbers::pi);
    for (const auto& s : half[0].samples) EXPECT_NEAR(glm::distance(1e3 * s.position, Vec3(10, 0, 0)), 10, 0.02);
    // y points down, so a positive sweep goes over the top.
    EXPECT_LT(half[0].samples[half[0].samples.size() / 2].position.y, 0);
    // Radii too small for the distance grow until they reach (F.6.6).
    EXPECT_NEAR(length(drawn("<path d='M 0 0 A 1 1 0 0 1 20 0'/>")[0]), 10 * std::numbers::pi,
                0.0015 * 10 * std::numbers::pi);
}

TEST(Svg, CommandsAgreeInTheirAbsoluteAndRelativeForms) {
    const auto a = drawn("<path d='M10 10 L20 10 H30 V20 C30 30 40 30 40 20 S50 10 50 20 Q55 30 60 20 T70 20 Z'/>");
    const auto r = drawn("<path d='m10 10 l10 0 h10 v10 c0 10 10 10 10 0 s10-10 10 0 q5 10 10 0 t10 0 z'/>");
    ASSERT_EQ(a.size(), 1u);
    ASSERT_EQ(a[0].samples.size(), r[0].samples.size());
    for (std::size_t i = 0; i < a[0].samples.size(); ++i)
        EXPECT_NEAR(glm::distance(a[0].samples[i].position, r[0].samples[i].position), 0, 1e-12);
    expect_near(last(a[0]), {10, 10});
}

TEST(Svg, AQuadraticIsTheParabolaItNames) {
    for (const auto& s : drawn("<path d='M0 0 Q 10 20 20 0'/>")[0].samples) {
        const double x = 1e3 * s.position.x;
        EXPECT_NEAR(1e3 * s.position.y, 2 * x - x * x / 10, 0.021);  // the tolerance of 20 µm
    }
}

TEST(Svg, TransformsNestFromTheOutside) {
    const auto t = drawn(
        "<g transform='translate(10,0) rotate(90)'><g transform='scale(2)'><line x1='1' y1='0' x2='3' "
        "y2='0'/></g></g>");
    expect_near(first(t[0]), {10, 2});
    expect_near(last(t[0]), {10, 6});
}

TEST(Svg, HiddenThingsAndDefinitionsAreLeftOut) {
    EXPECT_EQ(drawn("<defs><path d='M0 0 L1 1'/></defs><path display='none' d='M0 0 L9 9'/><rect x='0' y='0' width='1' "
                    "height='1'/>")
                  .size(),
              1u);
}

TEST(Svg, AUseDrawsItsElementAgainWhereItSays) {
    const std::string defs =
        "<defs><g id='g'><line x1='0' y1='0' x2='4' y2='0'/></g>"
        "<symbol id='s' viewBox='10 0 20 20'><line x1='10' y1='0' x2='30' y2='0'/></symbol></defs>";
    const auto t =
        drawn(defs +
              "<use xlink:href='#g' x='5' transform='rotate(90)'/><g transform='translate(0,7)'><use href='#g'/></g>"
              "<use href='#s' x='1' y='2' width='40'/><use href='#nothing'/><use href='elsewhere.svg#g'/>");
    ASSERT_EQ(t.size(), 3u);
    expect_near(first(t[0]), {0, 5});
    expect_near(last(t[0]), {0, 9});
    expect_near(first(t[1]), {0, 7});
    expect_near(first(t[2]), {1, 2});
    expect_near(last(t[2]), {41, 2});
}

TEST(Svg, LongLinesSwellAndTaper) {
    const auto& s = drawn("<line x1='0' y1='0' x2='50' y2='0'/>")[0].samples;
    EXPECT_GT(s[s.size() / 2].pressure, 1.5 * s.back().pressure);
}

// SVG 1.1, F.2: a path with a fault is drawn up to the last segment before it.
TEST(Svg, ADamagedPathIsDrawnUpToItsFault) {
    std::vector<std::string> notes;
    SvgOptions options;
    options.ink.note = [&](const Message& line) { notes.push_back(line.text()); };
    const auto lines = parse_svg(
        "<svg stroke='black' fill='none'><path d='M0 0 H96 V96 Z 5 5'/><path d='M0 0 H96 A1 1 0 7 1 2 2'/></svg>",
        "a.svg", options);
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_NEAR(lines[0].samples.back().position.x, 0, 1e-9);
    EXPECT_NEAR(lines[1].samples.back().position.x, 0.0254, 1e-9);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes[0].substr(0, 22), "2 paths are damaged: t");
}

TEST(Svg, EntitiesOfTheFileAreReplaced) {
    const auto read = [](const std::string& declared, const std::string& inside) {
        return parse_svg("<?xml version='1.0'?><!DOCTYPE svg PUBLIC '-//W3C' 'svg11.dtd' [" + declared + "]><svg>" +
                             inside + "</svg>",
                         "a.svg");
    };
    // Illustrator's styles; an entity in an entity; whole elements.
    const auto lines = read(
        "<!-- <!ENTITY a \"no\"> --><!ENTITY st0 \"stroke-width:3\"><!ENTITY b '&st0;;stroke:black'>"
        "<!ENTITY mark \"<line x2='7' style='stroke:black'/>\">",
        "<line x2='5' style='&b;'/>&mark;<!-- &st0; --><![CDATA[&gone;]]>");
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_NEAR(lines[0].line_width, 3 * 0.0254 / 96, 1e-9);
    EXPECT_THROW(read("<!ENTITY a '&b;'><!ENTITY b '&a;'>", "<line x2='5' style='&a;'/>"), Error);
    std::string laughs = "<!ENTITY l0 'ha'>";
    for (int i = 1; i < 12; ++i) {
        laughs += "<!ENTITY l" + std::to_string(i) + " '";
        for (int k = 0; k < 10; ++k) laughs += "&l" + std::to_string(i - 1) + ";";
        laughs += "'>";
    }
    EXPECT_THROW(read(laughs, "<line x2='5' id='&l11;'/>"), Error);
    for (const std::string open : {"<!ENTITY", "<!ENTITY a", "<!ENTITY a '", "<!--", "'", "]"})
        EXPECT_NO_THROW(try { read(open, "<line x2='5'/>"); } catch (const Error&){}) << open;
}

TEST(Svg, MistakesAreNamedWithTheFile) {
    const auto fault = [](const std::string& text) {
        try {
            parse_svg(text, "bad.svg");
            return std::string();
        } catch (const Error& e) {
            return std::string(e.what());
        }
    };
    for (const std::string inside :
         {"<path d='L'/>", "<path d='M 1 x'/>", "<path d='M 0 0 B 1 1'/>", "<path d='M0 0 L1e300 0'/>",
          "<text x='1e300'>Hi</text>", "<g transform='spin(3)'/>", "<path d='M0 0 Z 5 5'/>",
          "<path d='M0 0 A1 1 0 7 1 2 2'/>"}) {
        const std::string message = fault("<svg>" + inside + "</svg>");
        EXPECT_EQ(message.rfind("bad.svg", 0), 0u) << inside << ": " << message;
    }
    EXPECT_NE(fault("<ink/>"), "");
    EXPECT_NE(fault("<svg"), "");
    std::string deep;
    for (int i = 0; i < 5000; ++i) deep += "<g>";
    for (int i = 0; i < 5000; ++i) deep += "</g>";
    EXPECT_NE(fault("<svg>" + deep + "</svg>"), "");
    EXPECT_NE(fault("<svg><g id='a'><use href='#a'/><line x2='1'/></g></svg>"), "") << "an element that draws itself";
    // A thousand million lines in a few hundred bytes.
    std::string many = "<defs><line id='u0' x2='1'/>";
    for (int i = 1; i < 10; ++i) {
        many += "<g id='u" + std::to_string(i) + "'>";
        for (int k = 0; k < 10; ++k) many += "<use href='#u" + std::to_string(i - 1) + "'/>";
        many += "</g>";
    }
    EXPECT_NE(fault("<svg>" + many + "</defs><use href='#u9'/></svg>"), "");
}

TEST(Svg, LinesHaveTheWidthOfTheirStroke) {
    const auto width = [](const std::string& inside) { return 1e3 * drawn(inside).at(0).line_width; };
    const std::string line = "x1='0' y1='0' x2='9' y2='0'";
    EXPECT_EQ(width("<line " + line + "/>"), 0) << "the initial value of stroke is none";
    EXPECT_EQ(width("<line " + line + " stroke-width='2'/>"), 0);
    EXPECT_NEAR(width("<line " + line + " stroke='red'/>"), 1, 1e-9) << "the initial width";
    EXPECT_NEAR(width("<line " + line + " stroke='red' stroke-width='2.5'/>"), 2.5, 1e-9);
    EXPECT_NEAR(width("<line " + line + " stroke='red' stroke-width='1' style='fill:none; stroke-width : 4'/>"), 4,
                1e-9)
        << "a style counts more";
    EXPECT_EQ(width("<line " + line + " stroke='red' style='stroke:none'/>"), 0);
    EXPECT_NEAR(
        width("<g stroke='red' stroke-width='3'><g transform='scale(2) rotate(30)'><line " + line + "/></g></g>"), 6,
        1e-9)
        << "inherited; drawn under the transform";
    EXPECT_NEAR(width("<style>.a, .b{stroke:#000;stroke-width:2px} .b {stroke-width:3}</style><line " + line +
                      " class='x b'/>"),
                3, 1e-9);
    EXPECT_NEAR(width("<line " + line + " stroke='red' stroke-width='50%'/>"), 1, 1e-9)
        << "parts of the page are passed over";
    EXPECT_NO_THROW(drawn("<style>.a{stroke .b } } {{ .c,</style><line " + line + " class='a c' stroke='red'/>"));
    EXPECT_THROW(drawn("<line " + line + " stroke='red' stroke-width='wide'/>"), Error);
}

/// What is reported of a drawing with a black line and this in it.
std::vector<std::string> reported(const std::string& inside) {
    std::vector<std::string> notes;
    SvgOptions options;
    options.ink.note = [&](const Message& line) { notes.push_back(line.text()); };
    parse_svg("<svg xmlns:xlink='http://www.w3.org/1999/xlink'><path d='M0 0L9 9' stroke='black'/>" + inside + "</svg>",
              "a.svg", options);
    return notes;
}
using Notes = std::vector<std::string>;

TEST(Svg, WideLinesEndAsTheFileSays) {
    // Outlines of the stencils: a line of 40 x 10 mm is a box of that size, longer by its round or square ends.
    const auto extent = [](const std::string& more) {
        const auto lines = drawn("<path d='M20 50 H60' stroke='black' stroke-width='10' " + more + "/>");
        EXPECT_GT(lines.size(), 1u);
        Vec2 low(1e9), high(-1e9);
        for (const auto& t : lines)
            for (const auto& e : t.stencil) low = glm::min(low, e.from), high = glm::max(high, e.from);
        return Vec2(1e3 * (high - low));
    };
    expect_near(extent(""), {40, 10});
    expect_near(extent("stroke-linecap='square'"), {50, 10});
    EXPECT_NEAR(extent("stroke-linecap='round'").x, 50, 0.04) << "chords within 20 um";
    EXPECT_EQ(drawn("<path d='M20 50 H60' stroke='black' stroke-width='7'/>").size(), 1u) << "a line";
}

TEST(Svg, DashesAreLinesOfTheirOwn) {
    const std::string line = "<path d='M20 50 H60' stroke='black' stroke-width='.5' stroke-dasharray='";
    const auto dashes = drawn(line + "5 3'/>");
    ASSERT_EQ(dashes.size(), 5u);
    for (const auto& dash : dashes) EXPECT_NEAR(length(dash), 5, 1e-6);
    expect_near(first(dashes[1]), {28, 50});
    EXPECT_EQ(drawn(line + "none'/>").size(), 1u);
    // Dashes without length are points, which show their round ends only.
    EXPECT_EQ(drawn(line + "0 4' stroke-linecap='round'/>").size(), 11u);
    EXPECT_EQ(drawn("<path d='M1 1h9' stroke='black'/>" + line + "0 4'/>").size(), 1u);
    const auto fixed = drawn(
        "<g transform='scale(2)'><path d='M10 25 H30' stroke='black' stroke-width='.5' "
        "stroke-dasharray='5 3' vector-effect='non-scaling-stroke'/></g>");
    ASSERT_EQ(fixed.size(), 5u) << "neither width nor dashes grow";
    EXPECT_NEAR(1e3 * fixed[0].line_width, 0.5, 1e-9);
}

TEST(Svg, LinesStateWhatTheyCover) {
    SvgOptions options;
    options.outlines = true;
    const auto one = [&](const std::string& more) {
        auto lines = parse_svg(
            "<svg width='100mm' viewBox='0 0 100 100'><path d='M20 50 H60' stroke='black' "
            "stroke-width='10' " +
                more + "/></svg>",
            "test.svg", options);
        return lines.at(0);
    };
    const auto size = [&](const std::string& more) {
        Vec2 low(1e9), high(-1e9);
        for (const auto& ring : one(more).outline)
            for (const Vec2& p : ring) low = glm::min(low, p), high = glm::max(high, p);
        return Vec2(1e3 * (high - low));
    };
    expect_near(size(""), {40, 10});
    expect_near(size("stroke-linecap='square'"), {50, 10});
    EXPECT_NEAR(size("stroke-linecap='round'").x, 50, 3e-3) << "chords within a 100,000th of the page at either end";
    expect_near(size("stroke-dasharray='6 2'"), {6, 10});
    expect_near(size("transform='translate(5) scale(1,2)'"), {40, 20});
    EXPECT_TRUE(drawn("<path d='M20 50 H60' stroke='black' stroke-width='1'/>").at(0).outline.empty());
}

TEST(Svg, WhatIsLeftOutIsReportedInALineEach) {
    EXPECT_EQ(reported("<g/>"), Notes{});
    EXPECT_EQ(reported("<text>Hello <tspan>there</tspan></text><image/><text display='none'>no</text><g "
                       "visibility='hidden'><text>no</text></g>"),
              Notes{"1 image is left out: lines of a brush do not paint it"});
    EXPECT_EQ(reported("<switch><foreignObject/><g/></switch><foreignObject/>"), Notes{"1 foreignObject is left out"});
    EXPECT_EQ(reported("<use href='#gone'/><use xlink:href='#lost' x='3'/><use href='other.svg#a'/>"),
              (Notes{"2 uses draw nothing: the file has no elements of the ids that they name",
                     "1 use of another file is left out: put its element into this file"}));
    EXPECT_EQ(reported("<script/><path d='M0 0H9' stroke='#000'><animate/><set/></path>"),
              (Notes{"2 animations are not played", "1 script is not run"}));
}

TEST(Svg, EffectsThatABrushCannotPaintAreReportedWithTheirCounts) {
    const std::string line = "<path d='M0 0 H 50' stroke='black' ", square = "<rect width='20' height='20' ";
    EXPECT_EQ(reported("<g clip-path='url(#a)'>" + line + "/>" + line + "style='clip-path:url(#a)'/></g>"),
              Notes{"2 clip paths are not applied: what they hide is painted"});
    EXPECT_EQ(reported(line + "mask='url(#m)'/>" + line + "mask='none'/>"),
              Notes{"1 mask is not applied: what it hides is painted"});
    EXPECT_EQ(reported(line + "filter='url(#f)'/>"), Notes{"1 filter is not applied"});
    EXPECT_EQ(reported(line + "marker-end='url(#arrow)'/>"), Notes{"1 line loses its markers, such as arrow heads"});
    EXPECT_EQ(
        reported("<g opacity='.5'>" + line + "/></g>" + line + "style='stroke-opacity:40%'/>" + line + "opacity='1'/>"),
        Notes{"2 opacities are not applied: the ink is painted in full"});
    EXPECT_EQ(reported("<defs><linearGradient id='g'/><radialGradient id='r'/><pattern id='p'/></defs>" + square +
                       "fill='url(#g)'/>" + square + "style='fill:url(\"#r\")'/>" + square + "fill='url(#p) red'/>" +
                       square + "fill='url(#gone)'/>" + square + "fill='url(#gone) black'/>"),
              (Notes{"1 area or line has a paint that the file does not hold and is not painted",
                     "2 gradients are painted as one even ink", "1 pattern is painted as one even ink"}));
    EXPECT_EQ(reported("<style>g > path {fill:red} @media print {.b{fill:red} .c{fill:red}} .x{}</style>"),
              Notes{"1 rule of a style sheet is passed over: at-rules and most pseudo-classes are not understood"});
    EXPECT_EQ(reported(line + "style='transform:scale(2)'/>"),
              Notes{"1 transform in a style is not applied: write it as an attribute"});
}

TEST(Svg, ColoursThatBecomeOneInkAreNamed) {
    const auto square = [](const std::string& fill) { return "<rect width='20' height='20' fill='" + fill + "'/>"; };
    EXPECT_EQ(reported(square("black") + square("#000") + square("rgb(0, 0, 0)")), Notes{});
    EXPECT_EQ(reported(square("#E30613") + square("#e30613") + "<path d='M0 0H9' fill='none' stroke='navy'/>"),
              Notes{"3 colours are painted in one ink: black, #e30613, navy"});
    EXPECT_EQ(reported(square("white") + square("#FFF") + square("none")),
              Notes{"2 white areas and lines are left bare: white is the background, and what they cover stays "
                    "painted"});
    std::string many;
    for (int i = 0; i < 9; ++i) many += square("#00000" + std::to_string(i + 1));
    EXPECT_EQ(reported(many),
              Notes{"10 colours are painted in one ink: black, #000001, #000002, #000003, #000004, #000005, ..."});
}

TEST(Svg, WhatIsNotToBeSeenIsNotPainted) {
    const std::string line = "<path d='M0 0 H 50' ", ink = "stroke='black' ";
    EXPECT_EQ(drawn(line + ink + "/>" + line + ink + "visibility='hidden'/><g visibility='hidden'>" + line + ink +
                    "visibility='visible'/></g>")
                  .size(),
              2u);
    EXPECT_EQ(drawn(line + ink + "/>" + line + ink + "opacity='0'/>" + line + ink + "stroke-opacity='0'/>" + line +
                    "stroke='white'/>")
                  .size(),
              1u);
    EXPECT_EQ(drawn(line + ink + "/><rect width='9' height='9' fill='red' fill-opacity='0'/>").size(), 1u);
    EXPECT_EQ(drawn(line + ink + "/>" + line + "fill='black' stroke='url(#not-there)'/>" + line +
                    "fill='black' stroke='white'/>")
                  .size(),
              1u)
        << "no area, and a stroke that paints nothing";
}

TEST(Svg, RulesForNamesAndIdsCountAsTheirSpecificity) {
    const std::string sheet =
        "<style>/* .x{stroke-width:9} */ path{stroke:black;stroke-width:2} .c{stroke-width:3} "
        "#i{stroke-width:4}</style>";
    const auto width = [&](const std::string& more) {
        return 1e3 * drawn(sheet + "<path d='M0 0H9' stroke-width='1' " + more + "/>").at(0).line_width;
    };
    EXPECT_NEAR(width(""), 2, 1e-9) << "attributes count least";
    EXPECT_NEAR(width("class='c'"), 3, 1e-9);
    EXPECT_NEAR(width("class='c' id='i'"), 4, 1e-9);
    EXPECT_NEAR(width("class='c' id='i' style='stroke-width:5'"), 5, 1e-9);
}

TEST(Svg, LengthsHaveUnitsAndPartsOfThePage) {
    expect_near(last(drawn("<line x2='50%' y2='10%'/>", "width='200mm' viewBox='0 0 100 50'")[0]), {100, 10});
    EXPECT_NEAR(length(drawn("<line x2='1in'/>", "")[0]), 25.4, 1e-6);
    EXPECT_NEAR(length(drawn("<line x2='1'/>", "height='30mm' viewBox='0 0 100 3'")[0]), 10, 1e-6)
        << "a page whose height alone is said";
    // Round corners: quarter circles of 5, the sides between them.
    EXPECT_NEAR(length(drawn("<rect width='30' height='20' rx='5'/>")[0]), 2 * 20 + 2 * 10 + 10 * std::numbers::pi,
                0.05);
    EXPECT_EQ(drawn("<line x2='5'/><rect width='0' height='20'/>").size(), 1u);
}

TEST(Svg, WhatIsFilledIsPaintedAllOver) {
    const std::string square = "<rect x='10' y='10' width='20' height='20' ";
    const auto lines = drawn(square + "fill='#102030'/>");
    ASSERT_GT(lines.size(), 1u);
    for (const auto& t : lines) {
        EXPECT_GT(t.line_width, 0);
        for (const auto& s : t.samples) {
            EXPECT_GT(std::min(s.position.x, s.position.y), 0.0099);
            EXPECT_LT(std::max(s.position.x, s.position.y), 0.0301);
        }
    }
    EXPECT_EQ(drawn(square + "/>").size(), 1u) << "its outline";
    EXPECT_EQ(drawn(square + "/>")[0].line_width, 0);
    const auto both = drawn(square + "fill='red' stroke='blue' stroke-width='2'/>");
    EXPECT_EQ(both.size(), lines.size() + 1);
    EXPECT_NEAR(both.back().line_width, 0.002, 1e-12) << "the stroke lies over the fill";
    EXPECT_EQ(drawn("<g style='fill:black'>" + square + "class='x'/></g><style>.x{fill:none}</style>").size(), 1u);
    EXPECT_EQ(
        drawn("<rect width='99' height='99' fill='white'/><line x1='0' y1='0' x2='9' y2='9' stroke='red'/>").size(), 1u)
        << "the ground";
    EXPECT_EQ(drawn("<path d='M0 0 H9 V9' fill='none' stroke='red'/>").size(), 1u);
}

}  // namespace
}  // namespace tuft::io
