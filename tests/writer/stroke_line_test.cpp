#include "writer/gesture/stroke_line.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/files/files.h"
#include "writer/gesture/corners.h"
#include "writer/gesture/heads.h"
#include "writer/gesture/knuckles.h"
#include "writer/gesture/side_table.h"
#include "writer/glyphs/glyph_source.h"

namespace tuft::writer {
namespace {

TEST(StrokeLine, CodesFollowTheDirection) {
    const auto code = [](double x, double y) {
        return make_stroke_line(std::vector<Vec2>{{0, 0}, {x, y}}).stroke_class();
    };
    EXPECT_EQ(code(300, 20), "H");
    EXPECT_EQ(code(0, -300), "S");
    EXPECT_EQ(code(-200, -250), "P");
    EXPECT_EQ(code(200, -180), "N");
    EXPECT_EQ(code(200, 150), "T");
    EXPECT_EQ(code(-30, 100), "U");
    EXPECT_EQ(code(-100, 10), "L");
}

TEST(StrokeLine, CornersAreFoundWhereTheyAre) {
    const StrokeLine line = make_stroke_line(std::vector<Vec2>{{0, 0}, {400, 30}, {390, -300}, {310, -270}});
    EXPECT_EQ(line.stroke_class(), "HSL");
    ASSERT_EQ(line.segments.size(), 3u);
    // A corner is a point of the resampled line, 4 units apart, and smoothing moves it by less than a step.
    EXPECT_LT(glm::distance(line.points[line.segments[0].last], Vec2(400, 30)), 8);
    EXPECT_LT(glm::distance(line.points[line.segments[1].last], Vec2(390, -300)), 8);
}

TEST(StrokeLine, ARoundBendIsNoCorner) {
    std::vector<Vec2> arc;
    for (int i = 0; i <= 60; ++i) {  // radius 120: 28 units turn by 0.23 rad on either side
        const double a = -std::numbers::pi / 2 * i / 60;
        arc.push_back(120.0 * Vec2(std::cos(a), std::sin(a)));
    }
    EXPECT_EQ(make_stroke_line(arc).segments.size(), 1u);
}

TEST(Sides, OfARectangleAreItsHalfWidth) {
    const std::vector<Ring> outline{{{0, -20}, {400, -20}, {400, 30}, {0, 30}}};
    const StrokeLine line = make_stroke_line(std::vector<Vec2>{{15, 0}, {390, 0}});
    const StrokeSides sides = measure_sides(line, outline);
    for (std::size_t k = 0; k < kKnots; ++k) {
        EXPECT_NEAR(sides.left[0][k], 30, 1e-9);
        EXPECT_NEAR(sides.right[0][k], 20, 1e-9);
    }
    EXPECT_NEAR(sides.head[2], 15, 1e-9);
    EXPECT_NEAR(sides.tail[2], 10, 1e-9);
    Cells area = cells_over(outline, 2, 40);
    for (const Ring& ring : area_of(line, sides)) fill(area, std::span(&ring, 1));
    // The fans cut the corners of the ends: rays at 60° are their last points.
    EXPECT_NEAR(static_cast<double>(area.count()) * 4, 400 * 50, 0.03 * 400 * 50);
    // The path is the middle of the sides, inside by its own half width.
    for (const Station& s : make_stations(line, sides, area)) {
        EXPECT_NEAR(s.centre.y, 5, 0.5);
        EXPECT_LE(s.half, 25 + 1.5);  // clearance is to centres of cells
    }
}

/// A line round the origin, anticlockwise from the top, units.
StrokeLine round_line(double radius, double turn) {
    std::vector<Vec2> points;
    for (int i = 0; i <= 200; ++i) {
        const double a = 0.5 * std::numbers::pi + turn * i / 200;
        points.push_back(radius * Vec2(std::cos(a), std::sin(a)));
    }
    return make_stroke_line(points);
}

// Between knots a tenth of the line apart the chord of a ring of radius 250 lies 10 units inside of it. The area is
// that of the ring to a twelfth of a unit along either edge, and no place of it is a cell farther off: 12² / 8 r is
// 0.07.
TEST(Sides, OfARoundStrokeBoundARingNotAPolygon) {
    const double radius = 250, half = 20;
    const StrokeLine line = round_line(radius, 5);
    ASSERT_EQ(line.segments.size(), 1u);
    StrokeSides sides;
    sides.left.emplace_back(), sides.right.emplace_back();
    sides.left[0].fill(half), sides.right[0].fill(half);
    const std::vector<Ring> rings = area_of(line, sides);
    for (std::size_t i = 0; i + 2 < rings.size(); ++i)  // without the fans
        for (const Vec2& p : rings[i]) {
            const double off = std::abs(glm::length(p) - radius);
            EXPECT_NEAR(off, half, 1);
        }
    for (std::size_t i = 0; i + 2 < rings.size(); ++i) {
        EXPECT_NEAR(glm::length(0.5 * (rings[i][0] + rings[i][3])), radius - half, 1);  // the left is inside
        EXPECT_NEAR(glm::length(0.5 * (rings[i][1] + rings[i][2])), radius + half, 1);
    }
}

TEST(Sides, OfARoundStrokeAreHalfAsWideUpwards) {
    EXPECT_TRUE(is_round(round_line(250, 2.6)));
    EXPECT_FALSE(is_round(round_line(250, 2.2)));  // as the hook of 心
    const StrokeLine line = round_line(250, 6);
    ASSERT_EQ(line.segments.size(), 1u);
    const StrokeSides sides = round_sides(line);
    const auto half_at = [&](double turned) {
        std::size_t k = 0;
        while (k + 1 < kKnots && kKnotPlaces[k] < turned / 6) ++k;
        return sides.left[0][k];
    };
    EXPECT_EQ(sides.left, sides.right);
    EXPECT_NEAR(half_at(0.5 * std::numbers::pi), 24,
                1.1);  // down at the left; knots are 0.6 rad apart: 6 (1 − cos 0.6)
    EXPECT_NEAR(half_at(1.5 * std::numbers::pi), 12, 1.1);  // up at the right
}

// 豎彎鉤 as a typeface's centre line has it: down, round, along, and up at the root of the hook, where it turns by less
// than a corner. All of it is one segment, which turns by more than a round stroke does. The nine 豎彎鉤 of
// held_out.txt that are one segment are 80 to 110 units wide at the root of the hook; a round stroke is at most 48 wide
// anywhere.
TEST(SideTable, AHanHookIsAsWideAsHooksAreWhereItsCornerIsSoft) {
    std::vector<Vec2> hook{{400, 700}, {400, 300}};
    for (int i = 1; i <= 10; ++i)
        hook.push_back(Vec2(550, 300) + 150.0 * Vec2(-std::cos(i * 0.157), -std::sin(i * 0.157)));
    for (const Vec2& p : {Vec2(740, 150), Vec2(790, 168), Vec2(820, 200), Vec2(826, 330)}) hook.push_back(p);
    const SideTable table = SideTable::load(data_folder() / "models" / "writer" / "sides.txt");
    const StrokeLine line = make_stroke_line(hook);
    ASSERT_EQ(line.segments.size(), 1u);
    ASSERT_TRUE(is_round(line));
    const auto width_at_root = [&](char32_t code) {
        const Glyph glyph{.code = code, .strokes = {{.median = {{250, 600}, {800, 660}}}, {.median = hook}}};
        const StrokeSides sides = table.predict(line, glyph, 1);
        return *std::max_element(sides.left[0].begin() + 8, sides.left[0].begin() + 14) +
               *std::max_element(sides.right[0].begin() + 8, sides.right[0].begin() + 14);
    };
    EXPECT_GT(width_at_root(U'七'), 80);
    EXPECT_LE(width_at_root(U'も'), 48);
}

// The table of heads.h, to the rounding of its numbers.
TEST(Heads, LinesOfAPenBeginAsTheTypefacesDo) {
    const auto head_of = [](const std::vector<Vec2>& median, const std::vector<Vec2>& other) {
        const Glyph glyph{.code = U'中', .strokes = {{.median = median}, {.median = other}}};
        return with_heads(glyph).strokes[0].median;
    };
    const std::vector<Vec2> apart{{600, 100}, {900, 100}};
    for (const double length : {150.0, 400.0, 800.0}) {
        const std::vector<Vec2> bar{{300, 900}, {300, 900 - length}};
        const std::vector<Vec2> head = head_of(bar, apart);
        EXPECT_NEAR(head[0].x, 300 - std::min(20 + 0.038 * length, 43.0), 1e-6) << length;
        EXPECT_NEAR(head[0].y, 900, 1e-6);
        const auto joined =
            std::find_if(head.begin(), head.end(), [](const Vec2& p) { return std::abs(p.x - 300) < 1e-9; });
        ASSERT_NE(joined, head.end());
        EXPECT_NEAR(joined->y, 900 - 1.9 * 35, 1e-6);
        EXPECT_EQ(head.back(), bar.back());
        EXPECT_EQ(head_of(head, apart), head) << "a head that is stated stays";
        EXPECT_EQ(head_of(bar, {{200, 910}, {400, 910}}), bar) << "a head on another line stays";
        EXPECT_NEAR(head_of(bar, {{200, 940}, {400, 940}})[0].x, 300 - 0.8 * (300 - head[0].x), 1e-6);
    }
    const std::vector<Vec2> level{{100, 500}, {500, 510}}, dot{{100, 500}, {100, 400}};
    EXPECT_EQ(head_of(level, apart), level);
    EXPECT_EQ(head_of(dot, apart), dot);
    // 撇折: the second arm runs back beyond the first point. The head is not drawn out with it: by 35 units at most,
    // what the axis of the first arm and its first point may differ by.
    const std::vector<Vec2> fold{{600, 800}, {500, 650}, {860, 800}};
    EXPECT_LT(glm::distance(head_of(fold, apart)[0], fold[0]), 48 + 35);
    Glyph stated{.code = U'中',
                 .strokes = {{.median = {{300, 900}, {300, 500}}, .outline = {{{0, 0}, {1, 0}, {0, 1}}}}}};
    EXPECT_EQ(with_heads(stated).strokes[0].median, stated.strokes[0].median);
    stated.strokes[0].outline.clear(), stated.code = U'り';
    EXPECT_EQ(with_heads(stated).strokes[0].median, stated.strokes[0].median);
}

Cells area_predicted(const Glyph& glyph, std::size_t stroke) {
    static const SideTable table = SideTable::load(data_folder() / "models" / "writer" / "sides.txt");
    const StrokeLine line = make_stroke_line(glyph.strokes[stroke].median);
    const std::vector<Ring> rings = area_of(line, table.predict(line, glyph, stroke));
    Cells cells = cells_over(rings, 2, 30);
    for (const Ring& ring : rings) fill(cells, std::span(&ring, 1));
    return cells;
}

// A ball at a head has a neck behind it. Of 114 heads of a typeface with the same characters, ten have one.
TEST(Heads, OfBundledCharactersHaveNoNecks) {
    const auto source = open_glyphs(bundled_glyphs());
    int necks = 0;
    for (const char32_t code : {U'川', U'山'}) {
        const Glyph glyph = with_heads(*source->find(code));
        ASSERT_EQ(glyph.strokes.size(), 3u);
        for (std::size_t s = 0; s < 3; ++s) {
            const Cells area = area_predicted(glyph, s);
            for (const EdgeTurn& turn : edge_turns(area, coverage_of(area), kKnuckle))
                necks += turn.curvature < 0 && glm::distance(turn.at, glyph.strokes[s].median[0]) < 110;
        }
    }
    EXPECT_LE(necks, 1);
}

// 豎折 of 山, drawn to the corner itself. Two arms as wide as the widest place of both hold a disc of that radius at
// their corner, and one of √2 of it where the inside is filled.
TEST(Corners, OfADrawnLineAreNoBalls) {
    const Glyph mountain = *open_glyphs(bundled_glyphs())->find(U'山');
    const Vec2 corner = 0.5 * (mountain.strokes[1].median[4] + mountain.strokes[1].median[5]);
    const Cells area = area_predicted(mountain, 1);
    const std::vector<float> room = clearances(area);
    float at_corner = 0, of_arms = 0;
    for (int j = 0; j < area.height; ++j)
        for (int i = 0; i < area.width; ++i) {
            const bool near = glm::distance(area.centre(i, j), corner) < 100;
            const float here = room[std::size_t(j) * area.width + static_cast<std::size_t>(i)];
            float& most = near ? at_corner : of_arms;
            most = std::max(most, here);
        }
    EXPECT_GT(of_arms, 20);
    EXPECT_LT(at_corner, std::numbers::sqrt2 * of_arms);
}

TEST(Clearances, OfADiscAreTheDistanceToItsEdge) {
    Ring ring;
    for (int i = 0; i < 720; ++i) {
        const double a = i * std::numbers::pi / 360;
        ring.push_back(100.0 * Vec2(std::cos(a), std::sin(a)));
    }
    Cells cells = cells_over(std::span(&ring, 1), 2, 20);
    fill(cells, std::span(&ring, 1));
    EXPECT_NEAR(static_cast<double>(cells.count()) * 4, std::numbers::pi * 1e4, 0.01 * std::numbers::pi * 1e4);
    const std::vector<float> d = clearances(cells);
    for (int j = 0; j < cells.height; ++j)
        for (int i = 0; i < cells.width; ++i) {
            const double want = 100 - glm::length(cells.centre(i, j));
            if (want > 2) {
                EXPECT_NEAR(d[std::size_t(j) * cells.width + i], want, 2.1);  // a cell and half its diagonal
            }
        }
}

TEST(SideTable, RowsOfSidesGoThereAndBack) {
    std::vector<double> row(2 * kKnots * 3 + 2 * kFan);
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = static_cast<double>(i);
    EXPECT_EQ(row_of(sides_of(row, 3)), row);
}

TEST(SideTable, DamagedTablesAreRefused) {
    for (const char* text : {"", "H", "H 34 42 4 2\n1 2 3\n", "H 1 1 1 1\n", "H 34 42 999999 2\n"})
        EXPECT_ANY_THROW(SideTable::parse(text, "sides.txt")) << text;
}

// Circle tangents are exact on a circle. A Hermite piece over 24° has tangents 4 tan(6°) r long where ours are the
// chord, 2 sin(12°) r: 1.1 % of a sagitta of 0.022 r.
TEST(Curve, PointsOfACircleBecomeACircleAndCornersStay) {
    std::vector<Vec2> circle;
    for (int i = 0; i <= 15; ++i) {
        const double a = i * 24 * 3.14159265358979 / 180;
        circle.push_back(100.0 * Vec2(std::cos(a), std::sin(a)));
    }
    for (const Vec2& p : curve_through(circle)) EXPECT_NEAR(glm::length(p), 100, 0.03);
    const std::vector<Vec2> corner{{0, 0}, {100, 0}, {100, 100}};
    for (const Vec2& p : curve_through(corner)) EXPECT_LT(std::min(std::abs(p.y), std::abs(p.x - 100)), 1e-9);
}

}  // namespace
}  // namespace tuft::writer
