#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "writer/copy/copied_glyph.h"
#include "writer/copy/correction.h"
#include "writer/copy/photo.h"
#include "writer/gesture/stroke_line.h"

namespace tuft::writer {
namespace {

/// A bar with round ends, pixels, y down.
struct Bar {
    Vec2 from, to;
    double half = 12;
};

double distance_to(const Bar& bar, const Vec2& p) {
    const Vec2 d = bar.to - bar.from;
    const double t = std::clamp(glm::dot(p - bar.from, d) / glm::dot(d, d), 0.0, 1.0);
    return glm::distance(p, bar.from + t * d);
}

/// A picture of bars on paper whose light falls to 45 % from the left to the right and is stained by ±3 %.
io::Image8 photo_of(const std::vector<Bar>& bars, int side = 400) {
    io::Image8 image{.width = side, .height = side, .channels = 1, .pixels = {}};
    std::uint32_t state = 1;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            double nearest = 1e9;
            for (const Bar& bar : bars) nearest = std::min(nearest, distance_to(bar, {x + 0.5, y + 0.5}) - bar.half);
            const double ink = std::clamp(0.5 - nearest, 0.0, 1.0);
            state = state * 1664525u + 1013904223u;
            const double grain = 0.06 * (state / 4294967296.0 - 0.5);
            const double light = (1 - 0.55 * x / side) * (0.9 - 0.7 * ink + grain);
            image.pixels.push_back(static_cast<std::uint8_t>(std::clamp(255 * light, 0.0, 255.0)));
        }
    return image;
}

const std::vector<Bar> kTen{{{50, 200}, {350, 200}}, {{200, 50}, {200, 350}}};
const std::vector<Bar> kMouth{
    {{100, 100}, {100, 300}}, {{100, 100}, {300, 100}}, {{300, 100}, {300, 300}}, {{100, 300}, {300, 300}}};

Glyph copied(const io::Image8& picture) {
    const Cells ink = ink_of(picture, "photo");
    const Skeleton s = skeleton_of(ink);
    return copied_glyph(ink, s, order_by_rules(s), U'x');
}

double overlap(const Cells& a, const Cells& b) {
    double both = 0, either = 0;
    for (std::size_t i = 0; i < a.inside.size(); ++i)
        both += a.inside[i] && b.inside[i], either += a.inside[i] || b.inside[i];
    return both / either;
}

// The box of 324 pixels becomes 0.84 of the square; a cell is 2 units, so an edge may be half a cell off.
TEST(Copy, ACrossOnShadedPaperIsTwoStrokesInOrder) {
    const Glyph g = copied(photo_of(kTen));
    ASSERT_EQ(g.strokes.size(), 2u);
    const double unit = kCopiedPart * kSide / 324;
    for (int k = 0; k < 2; ++k) {
        const GlyphStroke& s = g.strokes[k];
        const Vec2 d = s.median.back() - s.median.front();
        EXPECT_EQ(make_stroke_line(s.median).stroke_class(), k == 0 ? "H" : "S");
        // 300 pixels between the middles of the ends and 12 less than the half width beyond each.
        EXPECT_NEAR(glm::length(d), unit * (300 + 2 * 12) - 24, 6);
        for (const Vec2& p : s.median) EXPECT_NEAR(k == 0 ? p.y : p.x, 512, 4);  // 2 cells
        Cells area = cells_over(s.outline, 2, 10);
        fill(area, s.outline);
        // The bar with its ends; the crossing belongs to both. Rounding of the corners at the crossing: 3 %.
        const double full = unit * unit * (300 * 24 + 3.14159 * 144);
        EXPECT_NEAR(static_cast<double>(area.count()) * 4, full, 0.05 * full);
    }
}

TEST(Copy, SpecksPinholesAndARubbingGiveTheSameInk) {
    const io::Image8 clean = photo_of(kTen);
    io::Image8 dirty = clean, rubbing = clean;
    for (int k = 0; k < 40; ++k)
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 3; ++x) {
                const int a = 20 + 9 * k + x, b = (37 * k) % 380 + y;
                std::uint8_t& p = dirty.pixels[std::size_t(b) * 400 + a];
                if (std::abs(b - 200) > 20 && std::abs(a - 200) > 20) p = 10;
                if (std::abs(b - 200) < 8) p = 230;
            }
    for (std::uint8_t& p : rubbing.pixels) p = static_cast<std::uint8_t>(255 - p);
    const Cells ink = ink_of(clean, "photo");
    EXPECT_GT(overlap(ink, ink_of(dirty, "photo")), 0.98);
    // The light of a rubbing falls the other way round, so its threshold lies within the soft edge: half a pixel of 24.
    EXPECT_GT(overlap(ink, ink_of(rubbing, "photo")), 0.95);
}

/// Two colours of light, 0–1, laid over each other on warm paper in that light.
io::Image8 in_colour(const io::Image8& black, const io::Image8& seal, const Vec3& ink, const Vec3& other) {
    io::Image8 image{.width = black.width, .height = black.height, .channels = 3, .pixels = {}};
    constexpr Vec3 kPaper{1, 0.95, 0.85};
    for (std::size_t k = 0; k < black.pixels.size(); ++k) {
        const double light = 1 - 0.55 * static_cast<double>(k % std::size_t(black.width)) / black.width;
        for (int c = 0; c < 3; ++c) {
            const auto through = [&](const io::Image8& of, double own) {
                return std::pow(own, std::clamp((0.9 - of.pixels[k] / 255.0 / light) / 0.7, 0.0, 1.0));
            };
            const double v = 240 * light * kPaper[c] * through(black, ink[c]) * through(seal, other[c]);
            image.pixels.push_back(static_cast<std::uint8_t>(v));
        }
    }
    return image;
}

// A square seal beside and over the strokes. Of the ink alone, an edge may be half a cell off: 1 % of bars of 28 cells.
TEST(Copy, ASealOfAnotherColourIsLeftOut) {
    const Vec3 black{0.1, 0.1, 0.1}, red{0.8, 0.17, 0.15};
    const std::vector<Bar> seal{{{262, 262}, {338, 262}, 6}, {{338, 262}, {338, 338}, 6}, {{338, 338}, {262, 338}, 6},
                                {{262, 338}, {262, 262}, 6}, {{300, 270}, {300, 330}, 6}, {{190, 300}, {210, 300}, 10}};
    const io::Image8 none = photo_of({});
    const PictureInk alone = picture_ink(in_colour(photo_of(kTen), none, black, red), "photo");
    EXPECT_EQ(alone.other_colour, 0);
    const PictureInk sealed = picture_ink(in_colour(photo_of(kTen), photo_of(seal), black, red), "photo");
    EXPECT_GT(sealed.other_colour, 0.05);
    EXPECT_GT(overlap(alone.cells, sealed.cells), 0.98);
    // Writing in red is ink, and a small note in black beside it is what is left out.
    const PictureInk red_ink = picture_ink(in_colour(photo_of(kTen), photo_of({seal[4]}), red, black), "photo");
    EXPECT_GT(overlap(alone.cells, red_ink.cells), 0.97);
}

TEST(Copy, ABoxIsThreeStrokes) {
    const Glyph g = copied(photo_of(kMouth));
    ASSERT_EQ(g.strokes.size(), 3u);
    EXPECT_EQ(make_stroke_line(g.strokes[0].median).stroke_class(), "S");
    EXPECT_EQ(make_stroke_line(g.strokes[1].median).stroke_class(), "HS");
    EXPECT_EQ(make_stroke_line(g.strokes[2].median).stroke_class(), "H");
}

// Between the junctions at a foot of 木 lies a piece of which one point is left; its direction was 0 / 0.
TEST(Copy, AStrokeMayBeginWithAPieceOfOnePoint) {
    const std::vector<Ring> area{{{400, 300}, {600, 300}, {600, 700}, {400, 700}}};
    Cells ink = cells_over(area, 2, 20);
    fill(ink, area);
    Skeleton s;
    s.nodes = {{{500, 600}, 20, 3}, {{502, 600}, 20, 3}, {{540, 400}, 20, 1}};
    s.pieces.push_back({.line = {{500, 600}, {502, 600}}, .from = 0, .to = 1});
    s.pieces.push_back({.line = {}, .from = 1, .to = 2});
    for (int i = 0; i <= 100; ++i) s.pieces[1].line.emplace_back(502 + 0.38 * i, 600 - 2 * i);
    for (const bool turned : {false, true}) {
        const StrokeOrder order{turned ? std::vector<PieceUse>{{1, true}, {0, true}}
                                       : std::vector<PieceUse>{{0, false}, {1, false}}};
        const Glyph g = copied_glyph(ink, s, order, U'x');
        ASSERT_EQ(g.strokes.size(), 1u);
        for (const Vec2& p : g.strokes[0].median) EXPECT_TRUE(p.x >= 500 && p.x <= 540 && p.y >= 400) << turned;
    }
}

TEST(Copy, LeftBeforeRightAndTopBeforeBottom) {
    const Glyph g = copied(photo_of({{{250, 100}, {350, 100}}, {{250, 300}, {350, 300}}, {{80, 80}, {80, 320}}}));
    ASSERT_EQ(g.strokes.size(), 3u);
    EXPECT_LT(g.strokes[0].median[0].x, 400);
    EXPECT_GT(g.strokes[1].median[0].y, g.strokes[2].median[0].y);
}

// A 撇 whose head is cut aslant, the corner to the upper left. The line begins there and never goes back along the way
// of the stroke by more than the bend of its head: a path to and fro draws a ball.
TEST(Copy, AHeadIsWrittenFromItsCornerWithoutGoingBack) {
    const Ring outline{{600, 840}, {690, 800}, {660, 740}, {560, 690}, {380, 640}, {530, 740}, {590, 780}};
    Cells ink = cells_over(std::span(&outline, 1), 2, 40);
    fill(ink, std::span(&outline, 1));
    const Vec2 from(650, 800), to(395, 648), on = glm::normalize(to - from);
    Skeleton s{.pieces = {{.line = {}, .from = 0, .to = 1}}, .nodes = {{from, 15, 1}, {to, 5, 1}}};
    for (double at = 0; at < glm::distance(from, to); at += 2) s.pieces[0].line.push_back(from + at * on);
    const Glyph g = copied_glyph(ink, s, {{{0, false}}}, U'x');
    ASSERT_EQ(g.strokes.size(), 1u);
    const std::vector<Vec2>& line = g.strokes[0].median;
    EXPECT_LT(glm::distance(line.front(), outline[0]), 30);
    double farthest = -1e9, back = 0;
    for (const Vec2& p : line) {
        farthest = std::max(farthest, glm::dot(p, on));
        back = std::max(back, farthest - glm::dot(p, on));
    }
    EXPECT_LT(back, 12);  // units: the inset of a begin
}

// Junctions cut a short piece down to one point, which has no direction to be continued in.
TEST(Copy, AnArmOfOnePointHasNoCorner) {
    const Ring outline{{300, 300}, {340, 300}, {340, 500}, {300, 500}};
    Cells ink = cells_over(std::span(&outline, 1), 2, 40);
    fill(ink, std::span(&outline, 1));
    Skeleton s;
    s.nodes = {{{318, 480}, 18, 1}, {{320, 480}, 18, 2}, {{320, 320}, 18, 1}};
    s.pieces = {{.line = {{318, 480}, {320, 480}}, .from = 0, .to = 1}, {.line = {}, .from = 1, .to = 2}};
    for (int y = 480; y >= 320; y -= 2) s.pieces[1].line.emplace_back(320, y);
    const Glyph g = copied_glyph(ink, s, {{{0, false}, {1, false}}}, U'x');
    ASSERT_EQ(g.strokes.size(), 1u);
    for (const Vec2& p : g.strokes[0].median) EXPECT_LT(glm::distance(p, Vec2(320, 400)), 100);
}

TEST(Copy, PicturesWithoutInkAreNamed) {
    EXPECT_ANY_THROW(ink_of(photo_of({}), "photo"));
    EXPECT_ANY_THROW(
        ink_of(io::Image8{.width = 4, .height = 4, .channels = 1, .pixels = std::vector<std::uint8_t>(16)}, "p"));
}

TEST(Copy, AnOrderIsWhatItWasPrintedAs) {
    const StrokeOrder order = parse_order(" 1+-2, 4  3 ", 4);
    EXPECT_EQ(order, (StrokeOrder{{{0, false}, {1, true}}, {{3, false}}, {{2, false}}}));
    EXPECT_EQ(parse_order(order_text(order), 4), order);
    for (const char* bad : {"", " ", "0", "5", "1 1", "1+", "+1", "a", "1-2", "--1", "99999999999999999999999"})
        EXPECT_THROW(parse_order(bad, 4), Error) << bad;
}

TEST(CopiedPicture, TheSquareLiesOnTheInkOfThePicture) {
    const PictureInk ink = picture_ink(photo_of(kTen), "photo");
    // The box of the bars is [38, 362]², whose longer side is 0.84 of the square.
    EXPECT_LT(glm::distance(ink.pixel_at(Vec2(0.5 * kSide)), Vec2(200)), 1);
    const double half = 0.5 * kCopiedPart * kSide;
    EXPECT_LT(glm::distance(ink.pixel_at({0.5 * kSide - half, 0.5 * kSide + half}), Vec2(38)), 1.5) << "y goes up";
}

TEST(CopiedPicture, AThresholdNearerToThePaperTakesMoreForInk) {
    std::size_t before = 0;
    for (const double threshold : {-0.8, -0.4, 0.0, 0.4, 0.8}) {
        // The soft edge of the bars is a pixel wide: each step adds some of it, and takes nothing away. The square
        // follows the ink's box, which grows by less than its area does.
        const PictureInk ink = picture_ink(photo_of(kTen), "photo", threshold);
        const double area = static_cast<double>(ink.cells.count()) * std::pow(ink.cells.cell / ink.units, 2);
        EXPECT_GE(area, 0.995 * static_cast<double>(before)) << threshold;
        before = static_cast<std::size_t>(area);
    }
}

TEST(CopiedPicture, ACutDividesAPieceWhereItIsAndChangesNoStroke) {
    const io::Image8 picture = photo_of(kMouth);
    const CopiedPicture whole = take_apart(picture, "photo", {});
    const std::vector<PieceCut> cuts = parse_cuts("1:0.3, 2:0.75");
    const CopiedPicture cut = take_apart(picture, "photo", {.threshold = 0, .cuts = cuts, .order = {}});
    ASSERT_EQ(cut.skeleton.pieces.size(), whole.skeleton.pieces.size() + 2);
    for (std::size_t k = 0; k < 2; ++k) {
        const Piece &old = whole.skeleton.pieces[k], &first = cut.skeleton.pieces[k],
                    &rest = cut.skeleton.pieces[whole.skeleton.pieces.size() + k];
        EXPECT_NEAR(first.length(), cuts[k].at * old.length(), 1e-9);
        EXPECT_NEAR(rest.length(), (1 - cuts[k].at) * old.length(), 1e-9);
        EXPECT_EQ(first.line.back(), rest.line.front());
        EXPECT_EQ(rest.line.back(), old.line.back());
    }
    const Glyph a = copied_glyph(whole.ink.cells, whole.skeleton, whole.order, U'x'),
                b = copied_glyph(cut.ink.cells, cut.skeleton, cut.order, U'x');
    ASSERT_EQ(a.strokes.size(), b.strokes.size());
    // A cut adds a point to a line, on it.
    for (std::size_t s = 0; s < a.strokes.size(); ++s)
        for (const Vec2& p : b.strokes[s].median) {
            double nearest = 1e9;
            const std::vector<Vec2>& line = a.strokes[s].median;
            for (std::size_t i = 1; i < line.size(); ++i) {
                const Vec2 d = line[i] - line[i - 1];
                const double t = std::clamp(glm::dot(p - line[i - 1], d) / std::max(glm::dot(d, d), 1e-12), 0.0, 1.0);
                nearest = std::min(nearest, glm::distance(p, line[i - 1] + t * d));
            }
            EXPECT_LT(nearest, 1e-9);
        }
}

TEST(CopiedPicture, CutsAreReadAsTheyAreWrittenAndWrongOnesQuoted) {
    EXPECT_EQ(cuts_text(parse_cuts(" 3:0.45\t12:0.125,1:0.999")), "3:0.450 12:0.125 1:0.999");
    EXPECT_TRUE(parse_cuts("").empty());
    for (const char* wrong : {"3", "0:0.5", "3:0", "3:1", "3:", ":0.5", "3:0.5x", "-3:0.5", "3:nan"}) {
        try {
            parse_cuts(wrong);
            ADD_FAILURE() << wrong;
        } catch (const Error& error) {
            EXPECT_NE(error.message().text().find(wrong), std::string::npos) << error.message().text();
        }
    }
    EXPECT_THROW(take_apart(photo_of(kTen), "photo", {.threshold = 0, .cuts = {{99, 0.5}}, .order = {}}), Error);
}

Ring box_ring(double left, double bottom, double right, double top) {
    return {{left, bottom}, {left, top}, {right, top}, {right, bottom}};
}

/// Part of the area that strokes and it have in common.
double covered_part(const Glyph& written, const std::vector<Ring>& area) {
    Cells wanted = cells_over(area, 4, 20), covered = wanted;
    fill(wanted, area);
    for (const GlyphStroke& s : written.strokes) fill(covered, s.outline);
    return overlap(wanted, covered);
}

// 十 as a font has it: one outline without an order. What its strokes cover is the outline, but for corners that are
// rounded by half a cell.
TEST(Copy, TheAreaOfAFontIsTakenApartIntoStrokes) {
    const Ring cross{{100, 460}, {460, 460}, {460, 100}, {540, 100}, {540, 460}, {900, 460},
                     {900, 540}, {540, 540}, {540, 900}, {460, 900}, {460, 540}, {100, 540}};
    const Glyph font{.code = U'十', .area = {cross}, .advance = 900, .sideways = true};
    const Glyph written = strokes_of_area(font);
    ASSERT_EQ(written.strokes.size(), 2u);
    EXPECT_TRUE(written.area.empty());
    EXPECT_EQ(written.advance, 900);
    EXPECT_TRUE(written.sideways);
    EXPECT_GT(written.strokes[0].median.back().x - written.strokes[0].median.front().x, 700) << "橫 first";
    EXPECT_LT(written.strokes[1].median.back().y - written.strokes[1].median.front().y, -700) << "from the top";
    EXPECT_GT(covered_part(written, font.area), 0.98);
    Glyph wide = font;
    for (Vec2& p : wide.area[0]) p.x *= 6;
    EXPECT_EQ(strokes_of_area(wide).area, wide.area) << "an ornament wider than four characters stays filled";
    EXPECT_TRUE(strokes_of_area({.code = U' '}).strokes.empty());
}

// i and o beside each other: a stem, a dot above it, and a box with a hole.
TEST(Copy, ADotAndARingOfAFontAreStrokesToo) {
    const std::vector<Ring> area{box_ring(100, 0, 180, 500),
                                 box_ring(100, 600, 180, 680),
                                 box_ring(300, 0, 700, 500),
                                 {{380, 80}, {620, 80}, {620, 420}, {380, 420}}};
    const Glyph written = strokes_of_area({.code = U'i', .area = area, .advance = 800});
    EXPECT_TRUE(written.area.empty());
    EXPECT_GE(written.strokes.size(), 3u);
    EXPECT_GT(covered_part(written, area), 0.97);  // corners of cells, of a dot and a hole too
    const auto holds = [&](const Vec2& p) {
        return std::any_of(written.strokes.begin(), written.strokes.end(), [&](const GlyphStroke& s) {
            Cells cells = cells_over(s.outline, 2, 8);
            fill(cells, s.outline);
            return cells.contains(p);
        });
    };
    EXPECT_TRUE(holds({140, 640})) << "the dot";
    EXPECT_FALSE(holds({500, 250})) << "the hole";
}

// A font is anybody's file. Each of these took minutes, or gigabytes, before it was refused or at all.
TEST(Copy, HugeAreasOfAFontStayFilled) {
    std::vector<Ring> bars, dots;
    for (int k = 0; k < 97; ++k) bars.push_back(box_ring(0, 40 * k, 3900, 40 * k + 20));
    for (int k = 0; k < 40 * 40; ++k) {
        const double x = 25 * (k % 40), y = 25 * (k / 40);
        dots.push_back(box_ring(x, y, x + 10, y + 10));
    }
    const std::vector<Ring> far{box_ring(-16'000, -16'000, -15'990, -15'990), box_ring(16'000, 16'000, 16'010, 16'010)};
    for (const std::vector<Ring>& area : {std::vector<Ring>{box_ring(0, 0, 3900, 3900)}, bars, dots, far}) {
        const Glyph written = strokes_of_area({.code = U'x', .area = area, .advance = 1000});
        EXPECT_TRUE(written.strokes.empty());
        EXPECT_EQ(written.area, area);
    }
    const std::vector<Ring> block{box_ring(0, 0, 1000, 1000)};
    EXPECT_FALSE(strokes_of_area({.code = U'x', .area = block, .advance = 1000}).strokes.empty()) << "a square of ink";
}

}  // namespace
}  // namespace tuft::writer
