#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/error.h"
#include "core/files/files.h"
#include "core/system/parallel.h"
#include "core/text/units.h"
#include "stroke/drawing/plane_ink.h"
#include "stroke/placement/tip_lag.h"
#include "writer/fit/writer.h"
#include "writer/gesture/heads.h"
#include "writer/glyphs/glyph_source.h"

namespace tuft::writer {
namespace {

Glyph bundled(char32_t code) {
    return *open_glyphs(bundled_glyphs())->find(code);
}

WriterOptions options() {
    return {.style = load_style("kaishu"), .side = 0.1};
}

bool equal(const stroke::StrokeSamples& a, const stroke::StrokeSamples& b) {
    if (a.samples.size() != b.samples.size()) return false;
    for (std::size_t i = 0; i < a.samples.size(); ++i)
        if (a.samples[i].time != b.samples[i].time || a.samples[i].position != b.samples[i].position ||
            a.samples[i].pressure != b.samples[i].pressure)
            return false;
    return true;
}

TEST(Writer, FitIsTheSameForAnyNumberOfThreadsAndFromTheCache) {
    const std::vector<Glyph> text{bundled(U'人')};
    set_thread_count(1);
    const auto one = Writer(options()).write(text);
    set_thread_count(4);
    WriterOptions cached = options();
    const auto folder = std::filesystem::path(testing::TempDir()) / ("tuft-fit-cache-" + std::to_string(getpid()));
    std::filesystem::remove_all(folder);
    cached.cache = DiskCache(folder);
    Writer first(cached), second(cached);
    const auto many = first.write(text), again = second.write(text);
    set_thread_count(0);
    EXPECT_EQ(first.fitted(), 2u);
    EXPECT_EQ(second.fitted(), 0u);  // all of it was in the cache
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_TRUE(equal(one[0][i].trace, many[0][i].trace));
        EXPECT_TRUE(equal(one[0][i].trace, again[0][i].trace));
    }
    std::filesystem::remove_all(folder);
}

// The predicted area of a bundled character is what its strokes are to cover; 0.90 is the floor of a stroke that a
// reader takes for it, dots and turns included.
TEST(Writer, InkCoversThePredictedArea) {
    const SideTable table = SideTable::load(data_folder() / "models" / "writer" / "sides.txt");
    Writer writer(options());
    stroke::WidthTables tables;
    const BrushHand hand{tables.preset(writer.brush()), tables.of(writer.brush()), tables.holder(writer.brush()),
                         writer.unit()};
    const Glyph glyph = with_heads(bundled(U'大'));
    const auto strokes = writer.write({glyph}).front();
    for (std::size_t s = 0; s < strokes.size(); ++s) {
        const StrokeLine line = make_stroke_line(glyph.strokes[s].median);
        const std::vector<Ring> rings = area_of(line, table.predict(line, glyph, s));
        Cells wanted = cells_over(rings, 2, 60);
        for (const Ring& ring : rings) fill(wanted, std::span(&ring, 1));
        const stroke::PlaneInk ink =
            stroke::plane_ink(strokes[s].trace, hand.preset, hand.hold, 1.5 * hand.unit, 2 * hand.unit);
        double both = 0, either = 0;
        for (int j = 0; j < wanted.height; ++j)
            for (int i = 0; i < wanted.width; ++i) {
                const bool a = wanted.at(i, j), b = ink.at(wanted.centre(i, j) * hand.unit) > 0.5;
                both += a && b, either += a || b;
            }
        EXPECT_GT(both / either, 0.90) << strokes[s].label;
    }
}

// 橫鉤 as a pen draws it: the typeface's hook is three times as wide along its bisector as the bar. The cap is exact.
TEST(Writer, AHookOfAPensLineIsNoBall) {
    const SideTable table = SideTable::load(data_folder() / "models" / "writer" / "sides.txt");
    Glyph glyph{.code = U'x'};
    glyph.strokes.push_back({.median = {{150, 600}, {820, 650}, {850, 640}, {800, 560}}});
    const StrokeLine line = make_stroke_line(glyph.strokes[0].median);
    const auto widest = [&](bool of_pen) {
        glyph.of_pen = of_pen;
        const StrokeSides sides = table.predict(line, glyph, 0);
        std::vector<double> all;
        for (const auto* side : {&sides.left, &sides.right})
            for (const auto& row : *side) all.insert(all.end(), row.begin(), row.end());
        std::sort(all.begin(), all.end());
        return all.back() - (1.25 * all[all.size() / 2] + 8);
    };
    EXPECT_GT(widest(false), 8);
    EXPECT_LE(widest(true), 1e-9);
}

/// Width across of the ink of a level line of half width 20, `inside` units from the first ink of its head, units.
double width_of_head(const BrushHand& hand, const Pace& pace, double inside) {
    std::vector<Station> line;
    for (int i = 0; i <= 40; ++i) line.push_back({{100 + 8.0 * i, 100}, std::min(20.0, 5 + 2.0 * i)});
    const stroke::PlaneInk ink = draw_on_plane(line, hand, pace, 1, 0.5);
    const auto width_at = [&](double x) {
        double width = 0;
        for (double y = 50.25; y < 150; y += 0.5) width += 0.5 * (ink.at(hand.unit * Vec2(x, y)) > 0.5);
        return width;
    };
    double first = 60;
    while (first < 140 && width_at(first) < 1) first += 0.5;
    return width_at(first + inside);
}

// Before a stroke is drawn: the cells of such a character are smaller than the print of a hair. The size that the fault
// names is accepted, and a tenth less is not: it has two digits, rounded up.
TEST(Writer, ACharacterTooSmallForABrushIsRefusedWithTheSizeThatWillDo) {
    const Glyph dot{.code = U'丶', .strokes = {{.median = {{500, 520}, {530, 500}}}}};
    Style style = load_style("kaishu");
    style.tries = 1;
    const auto write = [&](double side) { return Writer({.style = style, .side = side}).write({dot}); };
    double enough = 0;
    try {
        write(1e-5);
    } catch (const Error& error) {
        const std::string fault = error.what();
        enough = std::stod(fault.substr(fault.rfind("from ") + 5)) * 1e-3;
    }
    ASSERT_GT(enough, 1e-5);
    EXPECT_THROW(write(0.9 * enough), Error);
    EXPECT_NO_THROW(write(enough)) << enough;
}

TEST(BrushHand, AHeadIsSetDownAcrossThePathAndIsRounderForIt) {
    stroke::WidthTables tables;
    const std::string brush = "goat-medium";
    const BrushHand hand{tables.preset(brush), tables.of(brush), tables.holder(brush), 1.3e-4};
    const std::vector<Station> line{{{100, 100}, 8}, {{108, 100}, 14}, {{116, 100}, 20}, {{124, 100}, 20}};
    const Pace pace;
    const stroke::StrokeSamples trace = samples_of(line, hand, pace), plain = samples_of(line, hand, {.across = 0});
    ASSERT_GT(trace.samples.size(), plain.samples.size());
    const std::size_t touch = trace.samples.size() - plain.samples.size();
    double middle = 0;
    for (std::size_t i = 0; i < touch; ++i) {
        const stroke::StrokeSample& s = trace.samples[i];
        EXPECT_NEAR(s.position.x, plain.samples[0].position.x, 1e-12);
        EXPECT_LE(std::abs(s.position.y - plain.samples[0].position.y), pace.across * hand.unit + 1e-12);
        EXPECT_EQ(s.pressure, trace.samples[0].pressure);
        middle += (s.position.y - plain.samples[0].position.y) / static_cast<double>(touch);
    }
    EXPECT_NEAR(middle, 0, 1e-12);
    EXPECT_EQ(trace.samples[0].time, 0);
    for (std::size_t i = 1; i < trace.samples.size(); ++i) EXPECT_GT(trace.samples[i].time, trace.samples[i - 1].time);
    for (std::size_t i = 0; i < plain.samples.size(); ++i)
        EXPECT_EQ(trace.samples[touch + i].position, plain.samples[i].position);
    // One unit inside its edge: a disc of radius r is 2 √(2 r − 1) wide there, 5 for 3.6 units, 8 for 8.5. Half the
    // difference is asked for. Three units inside, either head is as wide as its line.
    EXPECT_GT(width_of_head(hand, pace, 1), 1.3 * width_of_head(hand, {.across = 0}, 1));
}

// A brush that does not fit is answered with a size that does, and the style's own fits at any size of characters.
TEST(Writer, NamesTheSizeOfABrushThatFits) {
    for (const double side : {0.012, 0.05, 0.133, 0.3}) {
        const Writer writer({.style = load_style("kaishu"), .side = side});
        EXPECT_EQ(size_that_fits(writer.brush(), side), std::nullopt) << writer.brush();
    }
    EXPECT_EQ(size_that_fits("goat-medium", 0.133), std::nullopt);
    for (const auto& [brush, side] : {std::pair{"wolf-large", 0.02}, std::pair{"goat-small", 0.4}}) {
        const auto fits = size_that_fits(brush, side);
        ASSERT_TRUE(fits) << brush;
        EXPECT_EQ(size_that_fits(*fits, side), std::nullopt) << *fits;
    }
}

// 撇 begins with a slanted head and turns back. Set down at a tenth of its depth, a tuft prints a disc at its point
// that no correction takes back.
TEST(Fit, ASofterTouchCoversASlantedHeadBetter) {
    stroke::WidthTables tables;
    const std::string brush = "goat-medium";
    const BrushHand hand{tables.preset(brush), tables.of(brush), tables.holder(brush), 1.3e-4};
    std::vector<Station> falling;
    for (int i = 0; i < 7; ++i) falling.push_back({Vec2(300, 700) + 8.0 * i * Vec2(0.6, -0.8), 7 + 3.5 * i});
    const Vec2 turn = falling.back().centre;
    for (int i = 1; i <= 30; ++i) falling.push_back({turn + 8.0 * i * Vec2(-0.7, -0.714), 28 - 0.75 * i});
    std::vector<Ring> discs;
    for (const Station& s : resample_stations(falling, 3)) {
        Ring& disc = discs.emplace_back();
        for (int k = 0; k < 40; ++k)
            disc.push_back(s.centre +
                           s.half * Vec2(std::cos(k * std::numbers::pi / 20), std::sin(k * std::numbers::pi / 20)));
    }
    FitTarget target{.wanted = cells_over(discs, 2, 80)};
    fill(target.wanted, discs);
    const FitResult soft = fit_stations(falling, target, hand, {}, {}),
                    hard = fit_stations(falling, target, hand, {.touch = 0.1}, {});
    EXPECT_GT(soft.iou, hard.iou);
}

// What was drawn before must not be seen.
TEST(Fit, ADrawingAfterAnotherIsTheSameToTheBit) {
    stroke::WidthTables tables;
    const std::string brush = "goat-medium";
    const BrushHand hand{tables.preset(brush), tables.of(brush), tables.holder(brush), 1.3e-4};
    std::vector<Station> line;
    for (int i = 0; i < 30; ++i) line.push_back({{100 + 8.0 * i, 100}, 18});
    stroke::PlaneDrawing drawing(hand.preset, hand.hold, 4 * hand.unit, 2 * hand.unit);
    for (const int changed : {-1, 12, 0}) {
        std::vector<Station> own = line;
        if (changed >= 0) own[static_cast<std::size_t>(changed)].centre.y += 5;
        const stroke::StrokeSamples trace = samples_of(own, hand);
        const stroke::PlaneInk &ink = drawing.draw(trace),
                               alone = stroke::plane_ink(trace, hand.preset, hand.hold, 4 * hand.unit, 2 * hand.unit);
        int there = 0, wrong = 0;
        for (double y = 50; y < 150; y += 2)
            for (double x = 50; x < 400; x += 2) {
                const Vec2 p = hand.unit * Vec2(x, y);
                there += alone.at(p) > 0.5;
                wrong += ink.at(p) != alone.at(p) || ink.when(p) != alone.when(p);
            }
        EXPECT_EQ(wrong, 0) << changed;
        EXPECT_GT(there, 29 * 36) << changed;  // cells of 29 · 8 units by two half widths: 2088, and half of them
    }
}

TEST(Fit, AStraightBarIsCoveredFromAWrongStart) {
    stroke::WidthTables tables;
    const std::string brush = "goat-medium";
    const BrushHand hand{tables.preset(brush), tables.of(brush), tables.holder(brush), 1.3e-4};
    Ring bar;
    for (int i = 0; i <= 180; ++i) {  // round ends, as a brush leaves them
        const double a = 0.5 * 3.14159265358979 + 3.14159265358979 * i / 180;
        bar.push_back(Vec2(100, 100) + 22.0 * Vec2(std::cos(a), std::sin(a)));
    }
    for (int i = 0; i <= 180; ++i) {
        const double a = -0.5 * 3.14159265358979 + 3.14159265358979 * i / 180;
        bar.push_back(Vec2(500, 100) + 22.0 * Vec2(std::cos(a), std::sin(a)));
    }
    FitTarget target{.wanted = cells_over(std::span(&bar, 1), 2, 80)};
    fill(target.wanted, std::span(&bar, 1));
    std::vector<Station> start;
    for (double x = 100; x <= 500; x += 8) start.push_back({{x, 112}, 14});  // 12 units beside it, too thin
    const FitResult once = fit_stations(start, target, hand, {}, {.tries = 1, .last_tries = 0});
    const FitResult fitted = fit_stations(start, target, hand, {}, {.tries = 12});
    EXPECT_LT(once.iou, 0.6);
    // A cell along both edges, 2 of 44 units, and 6 units at either end, 12 of 444: where a tuft lands and lifts.
    EXPECT_GT(fitted.iou, 0.93);
}

// The best of several begins and manners is at least as good as the first of them, which is among them: exact.
TEST(Fit, OtherBeginsAndMannersNeverLose) {
    stroke::WidthTables tables;
    const std::string brush = "goat-medium";
    const BrushHand hand{tables.preset(brush), tables.of(brush), tables.holder(brush), 1.3e-4};
    const Ring hook{{100, 80}, {420, 80}, {420, 100}, {330, 230}, {320, 225}, {360, 125}, {100, 125}};
    FitTarget target{.wanted = cells_over(std::span(&hook, 1), 2, 80)};
    fill(target.wanted, std::span(&hook, 1));
    std::vector<Station> start, other;
    for (double x = 110; x < 380; x += 8) start.push_back({{x, 102}, 20}), other.push_back({{x, 102}, 20});
    for (double t = 0; t <= 1; t += 0.0625) {
        start.push_back({{std::lerp(380, 328, t), std::lerp(102, 220, t)}, std::lerp(20, 5, t)});
        other.push_back({{std::lerp(395, 328, t), std::lerp(95, 220, t)}, std::lerp(20, 5, t)});
    }
    const FitResult first = fit_stations(start, target, hand, {}, {.tries = 4, .weak = 0, .last_tries = 0}, other),
                    best = fit_stations(start, target, hand, {}, {.tries = 4, .weak = 1, .last_tries = 0}, other);
    EXPECT_LE(first.tries, 4);
    EXPECT_GT(best.tries, first.tries);
    EXPECT_GE(best.score, first.score);
    EXPECT_GT(first.score, 0.5);  // a hook that a reader sees
}

// A brush paints in steps of about a unit, and its ink depends on the step: corrected in such steps, a path draws less
// wrong ink in them.
TEST(Fit, TheLastTriesLessenTheWrongInkOfAPaintersSteps) {
    stroke::WidthTables tables;
    const std::string brush = "goat-medium";
    const BrushHand hand{tables.preset(brush), tables.of(brush), tables.holder(brush), 1.3e-4};
    const Ring bow{{100, 80}, {200, 95}, {300, 80}, {380, 50}, {390, 60}, {310, 125}, {200, 138}, {100, 120}};
    FitTarget target{.wanted = cells_over(std::span(&bow, 1), 2, 80)};
    fill(target.wanted, std::span(&bow, 1));
    std::vector<Station> start;
    for (double x = 104; x <= 384; x += 8) start.push_back({{x, 112 - 0.0012 * (x - 200) * (x - 200)}, 18});
    const auto wrong = [&](int last_tries) {
        const FitResult fitted = fit_stations(start, target, hand, {}, {.last_tries = last_tries});
        const Cells& cells = target.wanted;
        const stroke::PlaneInk ink = draw_on_plane(fitted.stations, hand, {}, 1, cells.cell);
        int n = 0;
        for (int j = 0; j < cells.height; ++j)
            for (int i = 0; i < cells.width; ++i) n += cells.at(i, j) != (ink.at(cells.centre(i, j) * hand.unit) > 0.5);
        return n;
    };
    const int coarse = wrong(0), last = wrong(2);
    EXPECT_LT(last, 0.95 * coarse) << "a twentieth of " << coarse << " cells: half of what it gains in characters";
}

// The head of a 撇: set down to the lower right, turned to the lower left. Pressed too soon, the belly of the tuft
// reaches back beyond the point where it was set down, and a path that begins later does not help.
TEST(Fit, ABellyThatReachesBackBeyondAHeadIsPressedLess) {
    stroke::WidthTables tables;
    const std::string brush = "goat-medium";
    const BrushHand hand{tables.preset(brush), tables.of(brush), tables.holder(brush), 1.3e-4};
    int beyond = 0;
    for (const double scale : {1.0, 1.2, 1.4}) {
        const auto sized = [&](Ring ring) {
            for (Vec2& p : ring) p *= scale;
            return ring;
        };
        const Ring head = sized({{98, 294},
                                 {104, 301},
                                 {114, 298},
                                 {140, 286},
                                 {162, 266},
                                 {167, 252},
                                 {160, 240},
                                 {140, 222},
                                 {90, 166},
                                 {30, 108},
                                 {16, 100},
                                 {12, 104},
                                 {40, 140},
                                 {80, 194},
                                 {98, 226},
                                 {100, 262}});
        FitTarget target{.wanted = cells_over(std::span(&head, 1), 2, 80)};
        const Cells& cells = target.wanted;
        fill(target.wanted, std::span(&head, 1));
        const StrokeLine line = make_stroke_line(sized({{106, 291}, {136, 252}, {108, 216}, {66, 160}, {18, 106}}));
        const FitResult fitted =
            fit_stations(make_stations(line, measure_sides(line, std::span(&head, 1)), cells), target, hand, {});
        const stroke::PlaneInk ink = draw_on_plane(fitted.stations, hand, {}, 2, cells.cell);
        for (int j = 0; j < cells.height; ++j)
            for (int i = 0; i < cells.width; ++i)
                if (const Vec2 p = cells.centre(i, j); glm::distance(p, head[1]) < 30 && !cells.at(i, j))
                    beyond += ink.at(p * hand.unit) > 0.5;
    }
    EXPECT_LT(beyond, 3 * 38) << "of each a spot 14 units across, a third of a stroke's width: 38 cells";
}

// Where no try meets the target, the path is the one that was given.
TEST(Fit, APathFarFromItsTargetIsReturned) {
    stroke::WidthTables tables;
    const std::string brush = "goat-medium";
    const BrushHand hand{tables.preset(brush), tables.of(brush), tables.holder(brush), 1.3e-4};
    const Ring bar{{100, 80}, {200, 80}, {200, 120}, {100, 120}};
    FitTarget target{.wanted = cells_over(std::span(&bar, 1), 2, 80)};
    fill(target.wanted, std::span(&bar, 1));
    std::vector<Station> start;
    for (double x = 2000; x <= 2100; x += 8) start.push_back({{x, 2000}, 16});
    EXPECT_EQ(fit_stations(start, target, hand, {}, {.tries = 2}).stations, start);
}

TEST(Style, ShippedOnesLoadAndUnknownKeysAreNamed) {
    EXPECT_EQ(list_styles(), (std::vector<std::string>{"italic", "kaishu", "line", "xingshu"}));
    for (const std::string& name : list_styles()) EXPECT_EQ(load_style(name).name, name);
    EXPECT_ANY_THROW(load_style("kaisu"));
    EXPECT_ANY_THROW(parse_style("speed_mm = 3", "s.toml"));
    EXPECT_ANY_THROW(parse_style("tries = 1000", "s.toml"));
}

// A make that leans keeps its lean in segments that a style does not name, and in strokes without one that it names.
TEST(Style, AMakeThatLeansLeansInTheOtherSegments) {
    stroke::WidthTables tables;
    stroke::HolderOptions hold;
    hold.lean = 0.4, hold.tuft_length = 0.02;
    const BrushHand hand{tables.preset("goat-medium"), tables.of("goat-medium"), hold, 1e-4};
    std::vector<Station> bend;  // 橫 to the right, then 豎 down
    for (int i = 0; i <= 100; ++i) bend.push_back({{8.0 * i, 800}, 20});
    for (int i = 1; i <= 100; ++i) bend.push_back({{800, 800 - 8.0 * i}, 20});
    const Pace pace{.across = 0, .lean = {{'S', 0.1}}};
    const auto length = [&](const stroke::StrokeSamples& trace, std::size_t i) {
        return glm::length(stroke::lean_holder(trace, hand.hold).samples[i].tilt);
    };
    const stroke::StrokeSamples own = samples_of(bend, hand, {.across = 0}), named = samples_of(bend, hand, pace);
    ASSERT_GT(length(own, 50), 0.3) << "as the make is held";
    EXPECT_NEAR(length(named, 50), length(own, 50), 1e-12);
    EXPECT_NEAR(length(named, 150), 0.1, 1e-9);
    const std::vector<Station> straight(bend.begin(), bend.begin() + 90);
    EXPECT_NEAR(length(samples_of(straight, hand, pace), 50), length(own, 50), 1e-12);
}

// 0 is a lean that is stated.
TEST(Style, AMakeThatLeansStandsUprightInAStrokeThatTheStyleWantsSo) {
    stroke::WidthTables tables;
    stroke::HolderOptions hold;
    hold.lean = 0.4, hold.tuft_length = 0.02;
    const BrushHand hand{tables.preset("goat-medium"), tables.of("goat-medium"), hold, 1e-4};
    std::vector<Station> falling;
    for (int i = 0; i <= 100; ++i) falling.push_back({{800, 800 - 8.0 * i}, 20});
    const auto most = [&](const Pace& pace) {
        double lean = 0;
        for (const stroke::StrokeSample& s : stroke::lean_holder(samples_of(falling, hand, pace), hold).samples)
            lean = std::max(lean, glm::length(s.tilt));
        return lean;
    };
    ASSERT_GT(most({}), 0.3) << "as the make is held";
    EXPECT_LT(most({.lean = {{'S', 0}}}), 1e-6);
}

// A style that states no lean holds the brush upright. 人: 撇, then 捺.
TEST(Style, TheHolderLeansBackInTheSegmentsThatTheStyleNames) {
    const auto written = [](const std::string& lean) {
        const Style style = parse_style("tries = 1\n" + lean, "s.toml");
        return Writer({.style = style, .brush = {}, .side = 0.1}).write({bundled(U'人')}).front();
    };
    const auto upright = written(""), leaning = written("[lean_deg]\nP = 12\n");
    ASSERT_EQ(leaning.size(), 2u);
    for (const WrittenStroke& s : upright)
        for (const stroke::StrokeSample& sample : s.trace.samples) EXPECT_EQ(sample.tilt, Vec2(0));
    const std::vector<stroke::StrokeSample>& falling = leaning[0].trace.samples;
    const std::size_t middle = falling.size() / 2;
    const Vec2 on(falling[middle + 1].position - falling[middle - 1].position), tilt = falling[middle].tilt;
    EXPECT_NEAR(glm::length(tilt), 12 * kDegree, 0.01 * kDegree);  // blended over a curve of a degree or two
    EXPECT_LT(glm::dot(tilt, glm::normalize(on)), -0.99 * glm::length(tilt));
    const std::vector<stroke::StrokeSample>& pressed = leaning[1].trace.samples;
    EXPECT_EQ(pressed[pressed.size() / 2].tilt, Vec2(0));
    EXPECT_ANY_THROW(parse_style("lean_deg = 3", "s.toml"));
    EXPECT_ANY_THROW(parse_style("[lean_deg]\nQ = 3", "s.toml"));
    EXPECT_ANY_THROW(parse_style("[lean_deg]\nP = 60", "s.toml"));
}

// A nib's width is that of its ferrule, whatever the pressure: it is pressed evenly and lightly.
TEST(Style, ABroadEdgeKeepsItsAngleAndItsPressure) {
    const Style style = load_style("italic");
    const auto written = Writer({.style = style, .brush = {}, .side = 0.06}).write({bundled(U'o')});
    ASSERT_FALSE(written.front().empty());
    for (const WrittenStroke& stroke : written.front()) {
        for (std::size_t i = 0; i < stroke.trace.samples.size(); ++i) {
            EXPECT_EQ(stroke.trace.samples[i].roll, style.edge_angle);
            EXPECT_EQ(stroke.trace.samples[i].pressure, i + 1 < stroke.trace.samples.size() ? style.edge_pressure : 0)
                << i;
        }
    }
}

TEST(Links, GapsUpToTheStylesLengthAreDrawn) {
    Style style;
    style.link = 100;
    const std::vector<Station> a{{{0, 0}, 20}, {{8, 0}, 20}, {{16, 0}, 20}},
        near{{{80, 0}, 20}, {{88, 0}, 20}, {{96, 0}, 20}}, far{{{400, 0}, 20}, {{408, 0}, 20}, {{416, 0}, 20}};
    const auto joined = linked({a, near, far}, style);
    ASSERT_EQ(joined.size(), 2u);
    EXPECT_EQ(joined[0].front().centre, a.front().centre);
    EXPECT_EQ(joined[0].back().centre, near.back().centre);
    style.link = 0;
    EXPECT_EQ(linked({a, near, far}, style).size(), 3u);
}

/// A straight stroke from `from` to `to`, 20 units wide to either side but for its ends.
std::vector<Station> straight(Vec2 from, Vec2 to) {
    std::vector<Station> s;
    const auto n = static_cast<int>(glm::distance(from, to) / kStationsApart);
    for (int i = 0; i <= n; ++i)
        s.push_back({glm::mix(from, to, static_cast<double>(i) / n), i == 0 || i == n ? 3.0 : 20.0});
    return s;
}

// The hand leaves a stroke the way it goes, and its tip is lifted between: widest at both joints, thinnest once
// between, thinner where it goes farther.
TEST(Links, LeaveAlongTheStrokeAndThinOutBetween) {
    Style style;
    style.link = 300;
    double thinnest_before = 1e9;
    for (const double gap : {80.0, 160.0}) {
        const std::vector<Station> a = straight({0, 0}, {160, 0}), b = straight({160 + gap, 40}, {320 + gap, 40});
        const auto joined = linked({a, b}, style);
        ASSERT_EQ(joined.size(), 1u);
        const std::vector<Station> link(joined[0].begin() + static_cast<std::ptrdiff_t>(a.size()),
                                        joined[0].end() - static_cast<std::ptrdiff_t>(b.size()));
        ASSERT_GE(link.size(), 4u);
        const auto first = std::min_element(link.begin(), link.end(),
                                            [](const Station& x, const Station& y) { return x.half < y.half; });
        EXPECT_TRUE(std::is_sorted(link.begin(), first, [](auto& x, auto& y) { return x.half > y.half; }));
        EXPECT_TRUE(std::is_sorted(first, link.end(), [](auto& x, auto& y) { return x.half < y.half; }));
        EXPECT_LT(first->half, 0.6 * std::min(link.front().half, link.back().half));
        EXPECT_LT(first->half, thinnest_before);
        EXPECT_GE(joined[0][a.size() - 1].half, link.front().half);  // no neck at the joint
        thinnest_before = first->half;
        const Vec2 out = link[0].centre - a.back().centre, in = b.front().centre - link.back().centre;
        EXPECT_LT(std::abs(out.y / out.x), 0.2);  // one of n stations of a curve that begins at 0
        EXPECT_LT(std::abs(in.y / in.x), 0.2);
    }
}

TEST(Links, AreNotDrawnWhereAHandTurnsRoundOrCrossesInk) {
    Style style;
    style.link = 180;
    const std::vector<Station> level = straight({0, 0}, {160, 0}), below = straight({40, -100}, {200, -100}),
                               under = straight({140, -40}, {300, -40}), on = straight({260, 0}, {420, 0}),
                               across = straight({210, 150}, {210, -150});
    EXPECT_EQ(linked({level, below}, style).size(), 2u);  // 156 units away, and turns by 280°
    EXPECT_EQ(linked({level, under}, style).size(), 2u);  // 45 units for a turn by 230°
    EXPECT_EQ(linked({level, on}, style).size(), 1u);     // 100 units straight on
    std::vector<Station> bold = across;
    for (Station& s : bold) s.half = 40;
    EXPECT_EQ(linked({bold, level, on}, style).size(), 3u);
}

// A head that is set down across its stroke has no place where the tuft comes along a link.
TEST(Links, TakeThePlaceOfAHeadSetDownAcross) {
    Style style;
    style.link = 200;
    std::vector<Station> b = straight({260, 0}, {420, 0});
    const std::vector<Station> cue = straight({260, 40}, {260, 0});
    b.insert(b.begin(), cue.begin(), cue.end() - 1);
    const auto joined = linked({straight({0, 0}, {160, 0}), b}, style);
    ASSERT_EQ(joined.size(), 1u);
    for (const Station& s : joined[0]) EXPECT_LT(s.centre.y, 20);
    EXPECT_EQ(joined[0].back(), b.back());
}

}  // namespace
}  // namespace tuft::writer
