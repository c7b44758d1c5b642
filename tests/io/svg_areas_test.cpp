#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "io/svg/style/svg_css.h"
#include "io/svg/svg.h"
#include "stroke/painting/apply_area.h"

/// Coloured drawings as areas. 100 units are 100 mm; areas below are in mm².
namespace tuft::io {
namespace {

using stroke::FlatArea;

struct Read {
    std::vector<FlatArea> areas;
    std::vector<std::string> groups, notes;
};

Read read(const std::string& inside, const std::string& page = "width='100mm' height='100mm' viewBox='0 0 100 100'") {
    Read out;
    SvgOptions options{.painting = SvgPainting::areas};
    options.ink.note = [&](const Message& line) { out.notes.push_back(line.text()); };
    for (const stroke::RecordedStroke& r : parse_svg(
             "<svg xmlns:xlink='http://www.w3.org/1999/xlink' " + page + ">" + inside + "</svg>", "a.svg", options)) {
        EXPECT_TRUE(r.samples.empty());
        out.areas.push_back(*std::get<stroke::Fill>(r.before.at(0)).area);
        out.groups.push_back(r.group);
    }
    return out;
}

/// What an area covers, mm², on cells of `cell` mm.
double covered(const FlatArea& area, double cell = 0.02) {
    const stroke::AreaRaster raster(area, 1e-3 * cell);
    const Vec2 size = raster.high() - raster.low();
    double sum = 0;
    for (double y = raster.low().y; y < raster.high().y; y += 1e-3 * cell)
        for (double x = raster.low().x; x < raster.high().x; x += 1e-3 * cell)
            sum += raster.mean({x + 0.5e-3 * cell, y + 0.5e-3 * cell}, 1e-9);
    EXPECT_GT(size.x, 0);
    return sum * cell * cell;
}
double covered(const std::string& inside, double cell = 0.02) {
    double sum = 0;
    for (const FlatArea& area : read(inside).areas) sum += covered(area, cell);
    return sum;
}
bool inside(const FlatArea& area, double x, double y) {
    return stroke::AreaRaster(area, 2e-5).mean({1e-3 * x, 1e-3 * y}, 1e-9) > 0.5;
}
std::string fault(const std::string& inside) {
    try {
        read(inside);
        return {};
    } catch (const Error& e) {
        return e.what();
    }
}

TEST(SvgAreas, ColoursAreInks) {
    const auto ink = [](const std::string& fill) {
        return read("<g color='#010203'><rect width='9' height='9' style='fill:" + fill + "'/></g>")
            .areas.at(0)
            .stops.at(0)
            .ink;
    };
    for (const auto& [text, hex] : std::vector<std::pair<std::string, std::string>>{{"#e30613", "#e30613"},
                                                                                    {"#F00", "#ff0000"},
                                                                                    {"#12345680", "#123456"},
                                                                                    {"rgb(1, 2, 250)", "#0102fa"},
                                                                                    {"rgb(10% 20% 100%)", "#1a33ff"},
                                                                                    {"hsl(120, 100%, 25%)", "#008000"},
                                                                                    {"RebeccaPurple", "#000000"},
                                                                                    {"CornflowerBlue", "#6495ed"},
                                                                                    {"currentColor", "#010203"},
                                                                                    {"white", "#ffffff"}})
        EXPECT_EQ(ink(text), hex) << text;
    EXPECT_NEAR(read("<rect width='9' height='9' fill='rgba(0,0,9,0.25)' opacity='.5'/>").areas[0].stops[0].opacity,
                0.125, 1e-12);
}

TEST(SvgAreas, ColoursThatAreTheSameToTheEyeShareAnInk) {
    const auto areas = read(
                           "<rect width='9' height='9' fill='#e30613'/><rect width='9' height='9' fill='#e30714'/>"
                           "<rect width='9' height='9' fill='#c30613'/>")
                           .areas;
    EXPECT_EQ(areas[1].stops[0].ink, "#e30613");
    EXPECT_EQ(areas[2].stops[0].ink, "#c30613");
}

TEST(SvgAreas, ShapesComeBackToFrontWithTheStrokeOverTheFill) {
    const auto areas =
        read("<rect width='9' height='9' fill='red' stroke='blue'/><g><circle r='3' fill='lime'/></g>").areas;
    ASSERT_EQ(areas.size(), 3u);
    EXPECT_EQ(areas[0].stops[0].ink, "#ff0000");
    EXPECT_EQ(areas[1].stops[0].ink, "#0000ff");
    EXPECT_EQ(areas[2].stops[0].ink, "#00ff00");
    EXPECT_EQ(areas[0].low, areas[2].low) << "all in the frame of the drawing";
}

TEST(SvgAreas, PaintOrderPutsTheFillOverTheStroke) {
    const auto first = [](const std::string& order) {
        return read("<g style='paint-order:" + order + "'><rect width='9' height='9' fill='red' stroke='blue'/></g>")
            .areas.at(0)
            .stops[0]
            .ink;
    };
    for (const char* order : {"stroke", "stroke fill", "markers stroke"}) EXPECT_EQ(first(order), "#0000ff") << order;
    for (const char* order : {"normal", "fill", "fill stroke", "markers"}) EXPECT_EQ(first(order), "#ff0000") << order;
}

// SVG 1.1, 14.5: a group is drawn opaque, then the whole is made translucent. Areas of this test are exact but for the
// cells on their edges.
TEST(SvgAreas, ATranslucentGroupIsOneFilm) {
    const std::string shapes =
        "<rect width='20' height='20' fill='red'/><rect x='10' y='10' width='20' height='20' fill='blue'/>";
    const auto group = read("<g opacity='.5'>" + shapes + "</g>");
    ASSERT_EQ(group.areas.size(), 2u);
    EXPECT_NEAR(covered(group.areas[0], 0.1), 300, 3);
    EXPECT_NEAR(covered(group.areas[1], 0.1), 400, 3);
    EXPECT_EQ(group.areas[0].stops[0].opacity, 0.5);
    EXPECT_TRUE(group.notes.empty());
    EXPECT_NEAR(covered(read(shapes).areas.at(0), 0.1), 400, 3);
    // Half of the line lies over the fill of its own shape, and hides it.
    const auto line = read("<rect width='20' height='20' fill='red' stroke='blue' stroke-width='2' opacity='.5'/>");
    EXPECT_NEAR(covered(line.areas.at(0), 0.1), 18 * 18, 3);
    // What is translucent within the group lets the other through, and that is said.
    const auto film = read("<g opacity='.5'>" + shapes + "<rect width='30' height='5' fill-opacity='.5'/></g>");
    EXPECT_NEAR(covered(film.areas.at(0), 0.1), 300, 3);
    EXPECT_EQ(film.notes.size(), 1u);
    // What is hidden wholly is not painted.
    EXPECT_EQ(read("<g opacity='.5'><circle cx='9' cy='9' r='2' fill='red'/>" + shapes + "</g>").areas.size(), 2u);
}

/// A comb over the page's width with its back at `y` mm and `n` points along its teeth, 10 mm long.
std::string comb(double y, int n) {
    std::string d = "M0 " + std::to_string(y);
    for (int i = 0; i <= n; ++i) d += "L" + std::to_string(100.0 * i / n) + " " + std::to_string(y + (i % 2 ? 10 : 8));
    return "<path d='" + d + "L100 " + std::to_string(y) + "z' fill='blue'/>";
}

TEST(SvgAreas, WhatIsTooLargeToCutStaysAndIsReported) {
    const std::string page = "<rect width='100' height='100' fill='red'/>";
    // The third comb over what two have left has more points than are cut.
    const auto combs = read("<g opacity='.9'>" + page + comb(10, 8'000) + comb(40, 8'000) + comb(70, 8'000) + "</g>");
    ASSERT_EQ(combs.areas.size(), 4u);
    EXPECT_EQ(combs.notes.size(), 1u);
    const stroke::AreaRaster cut(combs.areas[0], 1e-3);
    for (const auto& [y, left] : {std::pair(5, true), {15, false}, {25, true}, {45, false}, {75, true}})
        EXPECT_EQ(cut.mean({0.05, 1e-3 * y}, 1e-9) > 0.5, left) << y;
    // One that is too large by itself takes nothing back of what another hides.
    const auto large = read("<g opacity='.9'>" + page + "<rect x='40' y='2' width='20' height='6'/>" +
                            comb(10, 21'000) + "<rect x='40' y='92' width='20' height='6'/></g>");
    ASSERT_EQ(large.areas.size(), 4u);
    EXPECT_EQ(large.notes.size(), 1u);
    const stroke::AreaRaster kept(large.areas[0], 1e-3);
    for (const auto& [y, left] : {std::pair(5, false), {15, true}, {50, true}, {95, false}})
        EXPECT_EQ(kept.mean({0.05, 1e-3 * y}, 1e-9) > 0.5, left) << y;
}

TEST(SvgAreas, ShapesOfAFilmMeetWithinTheirClipsOnly) {
    const auto met = [](const std::string& of_film) {
        return !read(
                    "<clipPath id='l'><path d='M0 0H20V5H5V20H0z'/></clipPath><linearGradient id='g'>"
                    "<stop stop-color='red'/><stop offset='1' stop-color='blue'/></linearGradient><g opacity='.5'>"
                    "<rect width='20' height='20' clip-path='url(#l)'/>" +
                    of_film + "</g>")
                    .notes.empty();
    };
    EXPECT_FALSE(met("<rect x='10' y='10' width='9' height='9' fill='url(#g)'/>"));
    EXPECT_TRUE(met("<rect x='10' y='2' width='9' height='9' fill='url(#g)'/>"));
}

TEST(SvgAreas, ATranslucentPatternIsOneFilm) {
    const auto read_pattern = read(
        "<pattern id='p' width='10' height='10' patternUnits='userSpaceOnUse'><rect width='6' height='6' fill='red'/>"
        "<rect x='3' y='3' width='6' height='6' fill='blue'/></pattern>"
        "<rect width='10' height='10' fill='url(#p)' fill-opacity='.5'/>");
    ASSERT_EQ(read_pattern.areas.size(), 2u);
    EXPECT_NEAR(covered(read_pattern.areas[0], 0.1), 27, 0.5);  // but for the cells on its edges
    EXPECT_NEAR(covered(read_pattern.areas[1], 0.1), 36, 0.5);
}

TEST(SvgAreas, SelectorsAndSpecificity) {
    const auto ink = [](const std::string& sheet) {
        return read("<style>rect{fill:#400000}" + sheet +
                    "</style><g id='g' class='a'><circle r='1' fill='#000000'/><rect id='r' class='b c' data-k='one "
                    "two' "
                    "width='9' height='9'/></g>")
            .areas.at(1)
            .stops.at(0)
            .ink;
    };
    for (const std::string fits : {"*{fill:#00ff00} rect{}", "g rect", "g > rect", ".a .b", ".b.c", "#g rect.c",
                                   "circle + rect", "circle ~ .c", "[data-k~=two]", "[data-k^='one']", "[data-k$=two]",
                                   "[data-k*='e t']", "rect[id=r]", ".x, .b", "rect:last-child"}) {
        const std::string rule = fits.find('{') == std::string::npos ? fits + "{fill:#00ff00}" : "#r{fill:#00ff00}";
        EXPECT_EQ(ink(rule), "#00ff00") << fits;
    }
    for (const std::string no : {"g > g rect", "svg > rect", "circle > rect", ".a.b", "rect + circle", "[data-k=one]",
                                 "[data-k~=o]", "rect:first-child", "#g#r"})
        EXPECT_EQ(ink(no + "{fill:#00ff00}"), "#400000") << no;
    EXPECT_EQ(ink("#r{fill:#ff0000} g .b.c{fill:#00ff00}"), "#ff0000");
    EXPECT_EQ(ink("g rect{fill:#ff0000} .b{fill:#00ff00}"), "#00ff00") << "a class counts more than two names";
    EXPECT_EQ(ink(".b{fill:#ff0000} .c{fill:#00ff00}"), "#00ff00") << "the later one";
    EXPECT_EQ(ink(".b{fill:#00ff00 !important} #r{fill:#ff0000}"), "#00ff00");
}

TEST(SvgAreas, StrokesHaveTheirEndsAndCorners) {
    const std::string line = "<path d='M20 20 H60' fill='none' stroke='red' stroke-width='4' ";
    EXPECT_NEAR(covered(line + "/>"), 160, 0.2);
    EXPECT_NEAR(covered(line + "stroke-linecap='square'/>"), 176, 0.2);
    EXPECT_NEAR(covered(line + "stroke-linecap='round'/>"), 160 + 4 * std::numbers::pi, 0.3);
    const std::string corner = "<path d='M20 20 H60 V60' fill='none' stroke='red' stroke-width='4' stroke-linejoin='";
    EXPECT_NEAR(covered(corner + "miter'/>"), 320, 0.3);
    EXPECT_NEAR(covered(corner + "bevel'/>"), 318, 0.3);
    EXPECT_NEAR(covered(corner + "round'/>"), 316 + std::numbers::pi, 0.3);
    EXPECT_NEAR(covered(corner + "miter' stroke-miterlimit='1.4'/>"), 318, 0.3) << "beyond the limit";
    EXPECT_NEAR(covered("<rect x='20' y='20' width='30' height='20' fill='none' stroke='red' stroke-width='2'/>"),
                32 * 22 - 28 * 18, 0.3);
    EXPECT_NEAR(covered("<circle cx='50' cy='50' r='20' fill='none' stroke='red' stroke-width='6'/>"),
                std::numbers::pi * (23 * 23 - 17 * 17), 0.8);
    EXPECT_NEAR(covered("<circle cx='50' cy='50' r='2' fill='none' stroke='red' stroke-width='6'/>"),
                std::numbers::pi * 25, 0.2)
        << "wider than its radius";
    EXPECT_NEAR(covered("<path d='M50 50 z' stroke='red' stroke-width='6' stroke-linecap='round'/>"),
                9 * std::numbers::pi, 0.2);
    EXPECT_NEAR(covered("<g transform='scale(1,3)'>" + line + "/></g>"), 480, 0.5);
    EXPECT_NEAR(covered("<g transform='scale(1,3)'>" + line + "vector-effect='non-scaling-stroke'/></g>"), 160, 0.5);
}

TEST(SvgAreas, DashesHaveTheirLengths) {
    const std::string line = "<path d='M20 20 H60' fill='none' stroke='red' stroke-width='4' stroke-dasharray='";
    EXPECT_NEAR(covered(line + "5 3'/>"), 4 * 25, 0.2);
    EXPECT_NEAR(covered(line + "5'/>"), 4 * 20, 0.2);
    EXPECT_NEAR(covered(line + "5 3' stroke-dashoffset='4'/>"), 4 * 25, 0.2);
    EXPECT_NEAR(covered(line + "8 2 1'/>"), 4 * (8 + 1 + 2 + 8 + 1), 0.2) << "an odd list is doubled";
    EXPECT_NEAR(covered(line + "none'/>"), 160, 0.2);
    const auto dashes = read(line + "5 3' stroke-dashoffset='4'/>").areas.at(0);
    EXPECT_TRUE(inside(dashes, 20.5, 20));
    EXPECT_FALSE(inside(dashes, 22, 20));
    EXPECT_TRUE(inside(dashes, 26, 20));
}

TEST(SvgAreas, ClipPathsCut) {
    const std::string defs =
        "<clipPath id='c'><rect x='20' y='20' width='10' height='30'/></clipPath>"
        "<clipPath id='box' clipPathUnits='objectBoundingBox'><rect width='.5' height='1'/></clipPath>"
        "<clipPath id='both' clip-path='url(#c)'><rect x='10' y='10' width='15' height='20'/></clipPath>"
        "<clipPath id='ring'><path clip-rule='evenodd' d='M10 10h40v40h-40zM20 20h20v20h-20z'/></clipPath>";
    const std::string square = "<rect x='10' y='10' width='40' height='40' fill='red' ";
    EXPECT_NEAR(covered(defs + square + "clip-path='url(#c)'/>"), 300, 0.3);
    EXPECT_NEAR(covered(defs + "<g clip-path='url(#c)'>" + square + "/></g>"), 300, 0.3);
    EXPECT_NEAR(covered(defs + square + "style='clip-path:url(#box)'/>"), 800, 0.3);
    EXPECT_NEAR(covered(defs + "<g clip-path='url(#box)'>" + square + "/></g>"), 800, 0.3);
    EXPECT_NEAR(covered(defs + square + "clip-path='url(#both)'/>"), 5 * 10, 0.3);
    EXPECT_NEAR(covered(defs + square + "clip-path='url(#ring)'/>"), 1200, 0.3);
    EXPECT_NEAR(covered(defs + square + "clip-path='url(#c)' transform='translate(7 3)'/>"), 300, 0.3);
}

TEST(SvgAreas, MasksLetLightThrough) {
    const std::string square = "<rect x='10' y='10' width='40' height='40' fill='red' ";
    auto areas =
        read(
            "<mask id='m'><rect x='10' y='10' width='20' height='99' fill='white'/><rect x='30' y='10' width='10' "
            "height='99' fill='#808080'/></mask>" +
            square + "mask='url(#m)'/>")
            .areas;
    ASSERT_EQ(areas.size(), 2u);
    std::sort(areas.begin(), areas.end(),
              [](const auto& a, const auto& b) { return a.stops[0].opacity > b.stops[0].opacity; });
    EXPECT_NEAR(areas[0].stops[0].opacity, 1, 1e-9);
    EXPECT_NEAR(covered(areas[0]), 800, 0.3);
    EXPECT_NEAR(areas[1].stops[0].opacity, 128.0 / 255, 1e-3);
    EXPECT_NEAR(covered(areas[1]), 400, 0.3);
    // A fade: the film follows the mask's gradient.
    areas = read(
                "<linearGradient id='g' gradientUnits='userSpaceOnUse' x1='10' x2='50'><stop stop-color='white'/><stop "
                "offset='1'/></linearGradient><mask id='m'><rect width='99' height='99' fill='url(#g)'/></mask>" +
                square + "mask='url(#m)'/>")
                .areas;
    ASSERT_EQ(areas.size(), 1u);
    EXPECT_EQ(areas[0].gradient, stroke::AreaGradient::linear);
    EXPECT_NEAR(areas[0].stops.front().opacity, 1, 1e-9);
    EXPECT_NEAR(areas[0].stops.back().opacity, 0, 1e-9);
    EXPECT_NEAR(stroke::along_area(areas[0], {0.030, 0.02}), 0.5, 1e-9);
    for (const auto& stop : areas[0].stops) EXPECT_EQ(stop.ink, "#ff0000");
}

TEST(SvgAreas, GradientsHaveTheirEndsUnitsAndTransforms) {
    const auto t_at = [](const std::string& attributes, const std::string& name, double x, double y) {
        const auto areas = read("<" + name +
                                " id='base'><stop offset='10%' stop-color='#f00'/><stop offset='.9' "
                                "style='stop-color:#00f'/></" +
                                name + "><" + name + " id='g' xlink:href='#base' " + attributes +
                                "/><rect x='20' y='30' width='40' height='20' fill='url(#g)'/>")
                               .areas;
        EXPECT_EQ(areas.at(0).stops.front().ink, "#ff0000");
        EXPECT_EQ(areas.at(0).stops.back().ink, "#0000ff");
        EXPECT_NEAR(areas.at(0).stops.front().at, 0.1, 1e-12);
        EXPECT_NEAR(areas.at(0).stops.back().at, 0.9, 1e-12);
        EXPECT_GT(areas.at(0).stops.size(), 5u) << "red to blue is far";
        return stroke::along_area(areas.at(0), {1e-3 * x, 1e-3 * y});
    };
    EXPECT_NEAR(t_at("", "linearGradient", 30, 40), 0.25, 1e-9);
    EXPECT_NEAR(t_at("x2='0' y2='1'", "linearGradient", 30, 40), 0.5, 1e-9);
    EXPECT_NEAR(t_at("gradientUnits='userSpaceOnUse' x1='0' x2='100'", "linearGradient", 30, 40), 0.3, 1e-9);
    EXPECT_NEAR(t_at("gradientUnits='userSpaceOnUse' x1='0' x2='100' gradientTransform='translate(10)'",
                     "linearGradient", 30, 40),
                0.2, 1e-9);
    EXPECT_NEAR(t_at("spreadMethod='reflect' x2='.25'", "linearGradient", 35, 40), 0.5, 1e-9);
    EXPECT_NEAR(t_at("", "radialGradient", 50, 40), 0.5, 1e-9);
    EXPECT_NEAR(t_at("", "radialGradient", 40, 45), 0.5, 1e-9) << "an ellipse in the box";
    EXPECT_NEAR(t_at("gradientUnits='userSpaceOnUse' cx='40' cy='40' r='20' fx='30'", "radialGradient", 30, 40), 0,
                1e-9);
    EXPECT_NEAR(t_at("gradientUnits='userSpaceOnUse' cx='40' cy='40' r='20' fx='30'", "radialGradient", 60, 40), 1,
                1e-9);
    // Between ends colours are mixed in sRGB.
    const auto grey =
        read(
            "<linearGradient id='g'><stop stop-color='#000'/><stop offset='1' stop-color='#fff'/></linearGradient>"
            "<rect width='9' height='9' fill='url(#g)'/>")
            .areas.at(0)
            .stops;
    bool middle = false;
    for (const auto& stop : grey) middle = middle || (std::abs(stop.at - 0.5) < 1e-9 && stop.ink == "#808080");
    EXPECT_TRUE(middle || grey.size() % 2 == 0);
    for (std::size_t i = 1; i < grey.size(); ++i) EXPECT_GT(grey[i].ink, grey[i - 1].ink) << "lighter and lighter";
}

TEST(SvgAreas, UsesSymbolsAndInnerDrawingsHaveTheirFrames) {
    const std::string defs = "<symbol id='s' viewBox='0 0 10 10'><rect width='20' height='5' fill='red'/></symbol>";
    EXPECT_NEAR(covered(defs + "<use href='#s' width='20' height='20'/>"), 20 * 10, 0.2) << "cut at its frame";
    EXPECT_NEAR(covered(defs + "<use href='#s' width='20' height='40'/>"), 20 * 10, 0.2) << "as wide as fits";
    EXPECT_TRUE(inside(read(defs + "<use href='#s' width='20' height='40'/>").areas[0], 1, 11)) << "in the middle";
    EXPECT_NEAR(covered("<svg x='10' y='10' width='20' height='20' viewBox='0 0 4 4'><circle cx='2' cy='2' r='1' "
                        "fill='red'/></svg>"),
                25 * std::numbers::pi, 0.3);
    EXPECT_NEAR(
        covered("<svg width='20' height='10' viewBox='0 0 4 4' preserveAspectRatio='none'><rect width='2' height='4' "
                "fill='red'/></svg>"),
        100, 0.2);
    EXPECT_NEAR(
        covered("<svg width='20' height='10' viewBox='0 0 4 4' preserveAspectRatio='xMinYMin slice'><rect width='4' "
                "height='4' fill='red'/></svg>"),
        200, 0.2);
}

TEST(SvgAreas, PatternsAndMarkersAreDrawn) {
    EXPECT_NEAR(
        covered("<pattern id='p' patternUnits='userSpaceOnUse' width='10' height='10'><rect width='5' height='10' "
                "fill='red'/></pattern><rect x='12' y='10' width='40' height='20' fill='url(#p)'/>"),
        400, 1);
    EXPECT_NEAR(covered("<pattern id='p' width='.25' height='.5' viewBox='0 0 2 2'><circle cx='1' cy='1' r='1' "
                        "fill='red'/></pattern>"
                        "<rect width='40' height='20' fill='url(#p)'/>"),
                8 * 25 * std::numbers::pi, 2);
    const std::string marker =
        "<marker id='m' markerWidth='4' markerHeight='4' refX='2' refY='2' orient='auto'><rect width='4' "
        "height='2' fill='blue'/></marker>";
    const auto areas = read(marker + "<path d='M20 20 V60' stroke='red' stroke-width='2' marker-end='url(#m)'/>").areas;
    ASSERT_EQ(areas.size(), 2u);
    EXPECT_NEAR(covered(areas[1]), 8 * 4, 0.2) << "in units of the line's width";
    EXPECT_TRUE(inside(areas[1], 22, 60)) << "turned with the line";
    EXPECT_FALSE(inside(areas[1], 18, 60));
}

TEST(SvgAreas, LayersAndNamedGroupsAreGroups) {
    const auto r = read(
        "<g inkscape:label='Stripes' inkscape:groupmode='layer'><g id='inner'><rect width='9' height='9' fill='red'/>"
        "</g></g><g id='marks'><rect width='9' height='9' fill='red'/></g><rect width='9' height='9' fill='red'/>");
    EXPECT_EQ(r.groups, (std::vector<std::string>{"Stripes", "marks", ""}));
    const auto marked =
        read(
            "<g id='no' class='big readable'><rect x='10' width='10' height='10' fill='red'/><rect x='30' "
            "width='10' height='10' fill='red'/></g><rect width='9' height='9' fill='red'/>")
            .areas;
    EXPECT_EQ(marked[0].reading.part, "no");
    EXPECT_NEAR(marked[1].reading.centre.x, 0.025, 1e-9);
    EXPECT_EQ(marked[2].reading.part, "");
}

TEST(SvgAreas, WhiteOverThePageIsTheGround) {
    const std::string red = "<rect width='9' height='9' fill='red'/>";
    EXPECT_EQ(read("<rect width='100' height='100' fill='white'/>" + red).areas.size(), 1u);
    EXPECT_EQ(read(red + "<rect width='100' height='100' fill='white'/>").areas.size(), 2u);
    EXPECT_EQ(read("<rect width='50' height='100' fill='white'/>" + red).areas.size(), 2u);
}

TEST(SvgAreas, ADrawingInBlackIsForABrush) {
    const auto lines = [](const std::string& inside, SvgPainting painting) {
        return parse_svg("<svg width='100mm' viewBox='0 0 100 100'>" + inside + "</svg>", "a.svg",
                         {.painting = painting});
    };
    const std::string black =
        "<rect width='99' height='99' rx='20'/><path d='M0 0 L50 50' stroke='#000' stroke-width='3'/>";
    const auto before = lines(black, SvgPainting::brush), now = lines(black, SvgPainting::automatic);
    ASSERT_EQ(before.size(), now.size());
    for (std::size_t i = 0; i < now.size(); ++i) {
        ASSERT_EQ(before[i].samples.size(), now[i].samples.size());
        for (std::size_t k = 0; k < now[i].samples.size(); ++k)
            ASSERT_EQ(before[i].samples[k].position, now[i].samples[k].position);
    }
    EXPECT_TRUE(lines(black + "<rect width='9' height='9' fill='red'/>", SvgPainting::automatic)[0].samples.empty());
}

TEST(SvgAreas, WhatIsNotPaintedIsSaid) {
    const auto notes = read(
                           "<rect width='9' height='9' fill='red' filter='url(#f)'/><image/>"
                           "<rect width='9' height='9' fill='url(#gone)'/>")
                           .notes;
    EXPECT_EQ(notes.size(), 3u);
    EXPECT_TRUE(read("<g opacity='.5' stroke-dasharray='3'><rect width='9' height='9' fill='red' stroke='blue'/></g>")
                    .notes.empty());
}

TEST(SvgAreas, DrawingsThatNeverEndAreRefusedInALine) {
    std::string nest = "<g id='a0'><rect width='1' height='1' fill='red'/></g>";
    for (int i = 1; i < 30; ++i) {
        const std::string before = "<use href='#a" + std::to_string(i - 1) + "'/>";
        nest += "<g id='a" + std::to_string(i) + "'>" + before + before + "</g>";
    }
    EXPECT_NE(fault("<defs>" + nest + "</defs><use href='#a29'/>"), "");
    const std::string red = "<rect width='9' height='9' fill='red'/>", box = "<rect width='90' height='90' ";
    EXPECT_NE(fault("<g id='a'><use href='#a'/></g>" + red), "");
    EXPECT_NE(
        fault("<clipPath id='c' clip-path='url(#c)'>" + red + "</clipPath>" + box + "clip-path='url(#c)' fill='red'/>"),
        "");
    EXPECT_NE(fault("<clipPath id='c'><rect clip-path='url(#c)' width='9' height='9'/></clipPath>" + box +
                    "clip-path='url(#c)' fill='red'/>"),
              "");
    EXPECT_NE(
        fault("<mask id='m'><rect mask='url(#m)' width='9' height='9'/></mask>" + box + "mask='url(#m)' fill='red'/>"),
        "");
    EXPECT_NE(fault("<pattern id='p' width='.5' height='.5'><rect width='9' height='9' fill='url(#p)'/></pattern>" +
                    box + "fill='url(#p)'/>"),
              "");
    EXPECT_NE(fault("<pattern id='p' patternUnits='userSpaceOnUse' width='.001' height='.001'>" + red + "</pattern>" +
                    box + "fill='url(#p)'/>"),
              "");
    EXPECT_NE(fault("<marker id='m'><path d='M0 0 L1 1' stroke='red' marker-end='url(#m)'/></marker><path d='M0 0 L9 "
                    "9' stroke='red' marker-end='url(#m)'/>"),
              "");
    EXPECT_EQ(fault("<linearGradient id='g' href='#h'/><linearGradient id='h' href='#g'/><rect width='9' height='9' "
                    "fill='url(#g)'/>" +
                    red),
              "");
    EXPECT_EQ(fault("<path d='M0 0 H90' stroke='red' stroke-dasharray='1e-9'/>"), "") << "drawn whole";
    EXPECT_NE(fault("<rect width='1e9' height='1e9' fill='red' transform='scale(1e9)'/>"), "");
}

/// Parts of a later area that an earlier one goes on under, mm².
double under(const std::string& inside, std::size_t k) {
    FlatArea area = read(inside).areas.at(k);
    if (area.under.empty()) return 0;
    area.rings = area.under, area.even_odd = false;
    return covered(area, 0.05);
}

TEST(SvgAreas, AnAreaReachesUnderALaterOneAtASharedEdge) {
    // The drawing is 100 mm large: 2 mm deep from a strip of 0.05 mm along 40 mm, and a quarter of a disc beyond both
    // ends, less at its middle by what the strip's round ends lack.
    const double depth = 2.05;
    const std::string page = "<rect width='100' height='100' fill='#eee'/>";
    const std::string left = "<path d='M10 20h30v40H10z' fill='#00f'/>";
    const std::string right = "<path d='M40 10h30v60H40z' fill='#0a0'/>";
    EXPECT_NEAR(under(page + left + right, 1), depth * 40 + 0.5 * std::numbers::pi * depth * depth, 0.6);
    EXPECT_EQ(under(page + left + right, 0), 0) << "the ground lies under both";
    EXPECT_EQ(under(page + left + right, 2), 0) << "nothing lies over the last";
    EXPECT_NEAR(under(page + right + left, 1), depth * 40, 0.1) << "no farther than the later one";
    EXPECT_EQ(under(left + "<path d='M40.2 10h30v60h-30z' fill='#0a0'/>", 0), 0) << "a gap";
    EXPECT_EQ(under(left + "<path d='M39 10h31v60h-31z' fill='#0a0'/>", 0), 0) << "laps already";
    EXPECT_EQ(under(left + "<path d='M40 10h30v60h-30z' fill='#0a0' opacity='.5'/>", 0), 0) << "would show through";
    EXPECT_EQ(under("<path d='M10 20h30v40H10z' fill='#00f' stroke='#000' stroke-width='2'/>", 0), 0)
        << "the line lies on both sides of the edge";
    EXPECT_EQ(under(left + "<path d='M12 22h10v10H12z' fill='#0a0'/>", 0), 0) << "inside";
}

}  // namespace
}  // namespace tuft::io
