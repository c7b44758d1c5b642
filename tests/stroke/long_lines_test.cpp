#include "stroke/drawing/long_lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sheet.h"
#include "stroke/drawing/drawing.h"

namespace tuft::stroke {
namespace {

constexpr double kWidth = 0.001;  // metres of the lines that are painted

/// Flat samples every 0.25 mm along corners.
StrokeSamples along(const std::vector<Vec2>& corners) {
    StrokeSamples t{
        .placement = {.mapping = SurfaceMapping::drape}, .placed = true, .pressed = false, .line_width = kWidth};
    double time = 0;
    for (std::size_t k = 1; k < corners.size(); ++k) {
        const double length = glm::distance(corners[k - 1], corners[k]);
        const int n = std::max(1, static_cast<int>(length / 2.5e-4));
        for (int i = k == 1 ? 0 : 1; i <= n; ++i)
            t.samples.push_back({.time = time + length * i / n / 0.06,
                                 .position = Vec3(glm::mix(corners[k - 1], corners[k], static_cast<double>(i) / n), 0),
                                 .pressure = 0.5});
        time += length / 0.06;
    }
    return t;
}

/// Half circles and straights over the sheet, `rows` of 44 mm, 8 mm apart.
StrokeSamples serpentine(int rows) {
    std::vector<Vec2> corners;
    for (int row = 0; row < rows; ++row) {
        const double y = 0.008 * (row - 0.5 * (rows - 1)), side = row % 2 ? -1 : 1;
        corners.emplace_back(-0.022 * side, y);
        corners.emplace_back(0.022 * side, y);
        for (int i = 1; i < 24 && row + 1 < rows; ++i) {
            const double a = std::numbers::pi * (i / 24.0 - 0.5);
            corners.emplace_back(side * (0.022 + 0.004 * std::cos(a)), y + 0.004 + 0.004 * std::sin(a));
        }
    }
    return along(corners);
}

struct Drawn {
    std::vector<double> width;  ///< metres, mean over each 5 mm of the line, of texels with 0.6 of
                                ///< a full film and more
    std::vector<StrokeReport> reports;
    std::vector<JournalEntry> entries;
};

/// The line by the brush that is chosen for it, or by `brush`; with `redips` as drawings are
/// painted.
Drawn drawn(const StrokeSamples& line, bool redips, const std::string& brush = "",
            const std::string& ink = "titanium-white", bool endless = false) {
    const Model model = sheet({}, 512);
    WidthTables widths;
    PaintStroke stroke{.trace = line, .brush = brush, .ink = ink};
    stroke.settings.endless = endless;
    std::vector<JournalEntry> entries{stroke};
    const std::vector<StrokeSamples*> drawing = drawing_in(entries, true);
    choose_brushes(entries, {drawing, 1, 0.05}, {.grow = false, .fit = brush.empty()}, widths);
    if (redips) redip_long_lines(entries, {}, widths);
    press_to_widths(entries, widths);
    Document painting(model);
    Drawn out;
    for (const JournalEntry& s : entries) out.reports.push_back(painting.paint(s));
    out.entries = entries;
    const atlas::TexelMap& map = model.texels;
    std::vector<double> at(line.samples.size(), 0);
    for (std::size_t i = 1; i < at.size(); ++i)
        at[i] = at[i - 1] + glm::distance(line.samples[i].position, line.samples[i - 1].position);
    out.width.assign(static_cast<std::size_t>(at.back() / 0.005) + 1, 0);
    const double full = 0.6 * painting.materials().ink(ink).film;
    for (const std::uint32_t slot : painting.layers().canvas().touched_slots())
        if (const ink::Plane* plane = painting.layers().canvas().plane(slot, 0))
            for (int t = 0; t < atlas::kTileTexels; ++t) {
                if (map.tiles[slot].area[t] <= 0 || (*plane)[t] < full) continue;
                const Vec3 p(map.position(slot, t));  // down is −y
                std::size_t nearest = 0;
                double least = 1;
                for (std::size_t i = 0; i < at.size(); ++i)
                    if (const double d = glm::distance(line.samples[i].position, Vec3(p.x, -p.y, 0)); d < least)
                        least = d, nearest = i;
                out.width[static_cast<std::size_t>(at[nearest] / 0.005)] += map.tiles[slot].area[t] / 0.005;
            }
    return out;
}

// A texel of 0.12 mm to both sides is half dark, and heads are up to a fifth wider
// (LineWidth.AClosedLine...).
constexpr double kSides = 0.15e-3, kHeads = 0.2;

TEST(LongLines, ALineIsAsFullAtItsEndAsAtItsBeginning) {
    const Drawn line = drawn(serpentine(6), true);
    ASSERT_GT(line.reports.size(), 1u) << "the brush is dipped again";
    for (const StrokeReport& r : line.reports) EXPECT_FALSE(r.ran_dry()) << r.dryness.from;
    for (std::size_t i = 1; i + 2 < line.width.size(); ++i)
        EXPECT_NEAR(line.width[i], kWidth, kSides + kHeads * kWidth) << "at " << 5 * i << " mm";
    // As it was: one dip for all of it.
    const Drawn dry = drawn(serpentine(6), false);
    ASSERT_EQ(dry.reports.size(), 1u);
    EXPECT_TRUE(dry.reports[0].ran_dry());
    EXPECT_LT(dry.width[dry.width.size() - 4], 0.5 * kWidth);
}

TEST(LongLines, TheFilmOfAnInkIsLookedUpOnceForADrawing) {
    const PaintStroke black{.trace = serpentine(1), .brush = "", .ink = "carbon"};
    PaintStroke red = black;
    red.ink = "cinnabar";
    std::vector<JournalEntry> entries{black, red, black, red, black};
    const std::vector<StrokeSamples*> drawing = drawing_in(entries, true);
    std::vector<std::string> asked;
    const BrushFit fit{.film = [&](const std::string& ink) { return asked.push_back(ink), 1e-5; }};
    WidthTables widths;
    choose_brushes(entries, {drawing, 1, 0.05}, fit, widths);
    EXPECT_EQ(asked.size(), 2u) << "for five lines of two inks";
    asked.clear();
    redip_long_lines(entries, fit, widths);
    EXPECT_EQ(asked.size(), 2u);
}

TEST(LongLines, ABrushThatNeverRunsDryNeedsNoSecondDip) {
    const Drawn line = drawn(serpentine(6), true, "", "titanium-white", true);
    ASSERT_EQ(line.reports.size(), 1u);
    EXPECT_FALSE(line.reports[0].ran_dry());
    for (std::size_t i = 1; i + 2 < line.width.size(); ++i)
        EXPECT_NEAR(line.width[i], kWidth, kSides + kHeads * kWidth) << "at " << 5 * i << " mm";
    const StrokeSettings& settings = line.entries[0].get<PaintStroke>().settings;
    EXPECT_EQ(settings_from_json(to_json(settings)), settings);
}

// It is as full at every pose as at first, so no paleness is for want of ink: exact. A brush of a tenth of the size
// holds a thousandth of the ink, and is pale from the first millimetre on.
TEST(LongLines, ASmallBrushThatIsAlwaysFullIsNotSaidToRunDry) {
    const Drawn line = drawn(along({{0, 0}, {0.004, 0}}), false, "goat-medium*0.1", "titanium-white", true);
    ASSERT_EQ(line.reports.size(), 1u);
    EXPECT_FALSE(line.reports[0].ran_dry());
    EXPECT_EQ(line.reports[0].dryness.path, 0);
}

TEST(LongLines, ARingIsClosedAndFullAllRound) {
    std::vector<Vec2> ring;
    for (int i = 0; i <= 180; ++i)
        ring.push_back(0.028 * Vec2(std::cos(i * std::numbers::pi / 90), std::sin((i % 180) * std::numbers::pi / 90)));
    ring.back() = ring.front();
    const Drawn line = drawn(along(ring), true);
    ASSERT_GT(line.reports.size(), 1u);
    for (std::size_t i = 0; i + 1 < line.width.size(); ++i)
        EXPECT_NEAR(line.width[i], kWidth, kSides + kHeads * kWidth) << "at " << 5 * i << " mm";
}

TEST(LongLines, PartsCoverTheLineOverlapAndAreCutWhereItIsStraight) {
    const StrokeSamples line = serpentine(6);
    const double whole = length_of(line), overlap = 0.004;
    const std::vector<StrokeSamples> clusters = cut_line(line, 0.1, overlap);
    ASSERT_EQ(clusters.size(), static_cast<std::size_t>(std::ceil(whole / 0.1)));
    double sum = 0;
    for (const StrokeSamples& p : clusters) {
        sum += length_of(p);
        EXPECT_EQ(p.samples.front().time, 0);
        EXPECT_LT(length_of(p), 0.1 * 1.2 + overlap) << "a tenth of a cluster at both ends";
    }
    EXPECT_NEAR(sum, whole + overlap * static_cast<double>(clusters.size() - 1), 1e-9);
    for (std::size_t k = 1; k < clusters.size(); ++k) {
        // The end of one and the beginning of the next go the same way, straight.
        const Vec3 a = clusters[k].samples.front().position, b = clusters[k - 1].samples.back().position;
        EXPECT_NEAR(glm::distance(a, b), overlap, 1e-6) << k << ": a little less in the last of a bend";
    }
    EXPECT_EQ(cut_line(line, 1, overlap).size(), 1u);
    EXPECT_EQ(cut_line(line, 1e-9, overlap).size(), static_cast<std::size_t>(whole / (4 * overlap)))
        << "no shorter than four overlaps";
}

TEST(LongLines, ALargerBrushIsTakenForALongerLine) {
    WidthTables widths;
    const double film = 1.8e-5, width = 0.004;
    const std::string usual = brush_for_width("wolf-medium", widths.of("wolf-medium"), width);
    const double enough = whole_length(widths.preset(usual), width, film);
    EXPECT_EQ(brush_for_line("wolf-medium", widths, width, 0.9 * enough, film, 0.06), usual);
    const std::string larger = brush_for_line("wolf-medium", widths, width, 1.1 * enough, film, 0.06),
                      largest = brush_for_line("wolf-medium", widths, width, 100 * enough, film, 0.06);
    EXPECT_GE(brush::sized_name(larger).factor, brush::sized_name(usual).factor);
    EXPECT_GT(brush::sized_name(largest).factor, brush::sized_name(usual).factor);
    EXPECT_GE(widths.of(largest).pressure(width), 0.299) << "not so large that it only tips the surface";
}

}  // namespace
}  // namespace tuft::stroke
