#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <utility>

#include "core/system/parallel.h"
#include "ink/exchange/deposit.h"
#include "sheet.h"

/// Strokes painted one after the other, whose hair another thread bends ahead of their ink: the bits are those of one
/// thread.
namespace tuft::stroke {
namespace {

class Ahead : public testing::Test {
  protected:
    void TearDown() override { set_thread_count(0); }
};

const Model& model() {
    static const Model m = sheet();
    return m;
}

// The edge and the tone of wet hair are seeded.
constexpr std::uint64_t kSeed = 11;

PaintStroke stroke_at(double y, DipMode dip, const std::string& ink = "carbon") {
    PaintStroke s = line("wolf-small", 3e-3, make_frame({0, y, 0}, {0, 0, 1}, {1, 0, 0}));
    s.ink = ink;
    s.seed = kSeed;
    s.settings.dip = dip;
    s.settings.spacing = 2;  // coarse is enough here, and quick
    return s;
}

// Drawn over and over, until the tuft is dry and its hair parts.
PaintStroke until_dry(PaintStroke s, int times) {
    const std::vector<StrokeSample> once = s.trace.samples;
    const double time = once.back().time + 0.01;
    for (int i = 1; i < times; ++i)
        for (std::size_t k = 0; k < once.size(); ++k) {
            StrokeSample p = i % 2 ? once[once.size() - 1 - k] : once[k];
            p.time = i * time + once[k].time;
            s.trace.samples.push_back(p);
        }
    return s;
}

PaintStroke draped(double y, DipMode dip) {
    PaintStroke s;
    s.brush = "wolf-small";
    s.ink = "carbon";
    s.seed = kSeed;
    s.settings.dip = dip;
    s.settings.spacing = 2;
    s.trace.placement.origin = {0, y, 0};
    s.trace.placement.right = {1, 0, 0};
    s.trace.placement.down = {0, -1, 0};
    for (int i = 0; i <= 60; ++i)
        s.trace.samples.push_back(
            {.time = 0.01 * i, .position = {-0.012 + 4e-4 * i, 0, 0}, .pressure = 0.3 + 0.005 * i});
    return s;
}

struct Painted {
    std::uint64_t hash = 0;
    std::vector<StrokeReport> reports;
};

Painted paint(const std::vector<JournalEntry>& entries, int threads) {
    set_thread_count(threads);
    Document p(model(), {.substrate = "bisque", .record_forces = true});
    Painted painted;
    p.paint(entries, [&](const JournalEntry&, StrokeReport report) { painted.reports.push_back(std::move(report)); });
    painted.hash = p.layers().hash();
    return painted;
}

void expect_same(const std::vector<JournalEntry>& entries) {
    const Painted expected = paint(entries, 1);
    ASSERT_EQ(expected.reports.size(), entries.size());
    for (const int threads : {2, 5}) {
        const Painted painted = paint(entries, threads);
        EXPECT_EQ(painted.hash, expected.hash) << threads << " threads";
        ASSERT_EQ(painted.reports.size(), entries.size());
        for (std::size_t i = 0; i < entries.size(); ++i) {
            EXPECT_EQ(painted.reports[i].stamps, expected.reports[i].stamps) << i;
            EXPECT_EQ(painted.reports[i].ink_given, expected.reports[i].ink_given) << i;
            EXPECT_EQ(painted.reports[i].ink_left, expected.reports[i].ink_left) << i;
            ASSERT_EQ(painted.reports[i].forces.size(), expected.reports[i].forces.size()) << i;
            for (std::size_t k = 0; k < expected.reports[i].forces.size(); ++k)
                EXPECT_EQ(painted.reports[i].forces[k].force, expected.reports[i].forces[k].force) << i << ", " << k;
        }
    }
}

TEST_F(Ahead, StrokesWithOneFillingOfTheBrushHaveTheSameBits) {
    expect_same({stroke_at(-0.01, DipMode::persistent), stroke_at(0, DipMode::persistent),
                 until_dry(stroke_at(0.004, DipMode::persistent), 8), stroke_at(0.008, DipMode::persistent),
                 stroke_at(0.012, DipMode::each)});
}

TEST_F(Ahead, StrokesInWetInkHaveTheSameBits) {
    PaintStroke first = stroke_at(0, DipMode::each), second = stroke_at(0.001, DipMode::persistent, "cinnabar");
    first.settings.film = second.settings.film = FilmModel::wet;
    expect_same({first, second, until_dry(first, 3)});
}

TEST_F(Ahead, DrapedStrokesHaveTheSameBits) {
    PaintStroke wet = draped(0.006, DipMode::each);
    wet.settings.film = FilmModel::wet;
    expect_same({draped(-0.006, DipMode::persistent), draped(0, DipMode::persistent), wet,
                 draped(0.003, DipMode::persistent), draped(-0.01, DipMode::each)});
}

TEST_F(Ahead, AFaultOfAStrokePlannedAheadIsThatOfItsTurn) {
    std::vector<JournalEntry> entries{draped(-0.006, DipMode::persistent), draped(0, DipMode::persistent)};
    entries[1].get<PaintStroke>().brush = "no-such-brush";
    set_thread_count(3);
    Document p(model());
    EXPECT_THROW(p.paint(entries, {}), Error);
    EXPECT_EQ(p.journal().entries().size(), 1u);
}

/// Strokes of a hand, after each other, whose samples come `at_once` by `at_once`.
Painted paint_by_hand(const std::vector<PaintStroke>& strokes, std::size_t at_once, int threads) {
    set_thread_count(threads);
    Document p(model(), {.substrate = "bisque", .record_forces = true});
    Painted painted;
    for (PaintStroke s : strokes) {
        const std::vector<brush::Pose> poses = spatial_poses(s.trace);
        s.trace.samples.clear();
        p.begin(s);
        for (std::size_t i = 0; i < poses.size(); i += at_once)
            p.extend(std::span(poses).subspan(i, std::min(at_once, poses.size() - i)));
        painted.reports.push_back(p.end());
    }
    painted.hash = p.layers().hash();
    return painted;
}

// Its tuft is wet, gets half dry and parts on the way, or was parted; the ink stays, or flows.
TEST_F(Ahead, AHandsStrokesHaveTheSameBitsHoweverTheirSamplesCome) {
    PaintStroke in_wet = until_dry(stroke_at(0, DipMode::each), 2);
    in_wet.settings.film = FilmModel::wet;
    const std::vector<PaintStroke> strokes{stroke_at(-0.01, DipMode::each),
                                           until_dry(stroke_at(0.004, DipMode::persistent), 8),
                                           stroke_at(0.008, DipMode::persistent), in_wet};
    const Painted expected = paint_by_hand(strokes, 1'000'000, 1);
    for (const auto& [at_once, threads] : std::vector<std::pair<std::size_t, int>>{{1, 1}, {1, 2}, {7, 3}, {50, 2}}) {
        const Painted painted = paint_by_hand(strokes, at_once, threads);
        EXPECT_EQ(painted.hash, expected.hash) << at_once << " at once, " << threads << " threads";
        for (std::size_t i = 0; i < strokes.size(); ++i) {
            EXPECT_EQ(painted.reports[i].ink_left, expected.reports[i].ink_left) << i;
            ASSERT_EQ(painted.reports[i].forces.size(), expected.reports[i].forces.size()) << i;
            for (std::size_t k = 0; k < expected.reports[i].forces.size(); ++k)
                EXPECT_EQ(painted.reports[i].forces[k].force, expected.reports[i].forces[k].force) << i << ", " << k;
        }
    }
}

TEST_F(Ahead, WhoWatchesAHandSeesItsInkEveryFewStamps) {
    set_thread_count(2);
    Document p(model());
    const std::vector<brush::Pose> poses = spatial_poses(stroke_at(0, DipMode::each).trace);
    p.begin(stroke_at(0, DipMode::each));
    std::size_t seen = 0, changed = 0;
    p.extend(poses, [&] {
        ++seen;
        changed += !p.appearance().take_dirty().empty();
    });
    const StrokeReport report = p.end();
    EXPECT_GE(seen, report.stamps / 8 - 1);  // 8 stamps are a batch; the last poses come with the end
    EXPECT_GE(changed, seen / 2);
}

}  // namespace
}  // namespace tuft::stroke
