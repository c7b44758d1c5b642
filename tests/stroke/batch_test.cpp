#include <gtest/gtest.h>

#include <atomic>

#include "core/error.h"
#include "core/system/parallel.h"
#include "sheet.h"
#include "stroke/painting/tile_reach.h"
#include "stroke/session/forecast.h"
#include "stroke/session/session.h"

/// Strokes painted side by side: whatever the number of threads, the bits are those of one stroke after the other.
namespace tuft::stroke {
namespace {

class Batch : public testing::Test {
  protected:
    void TearDown() override { set_thread_count(0); }
};

const Model& model() {
    static const Model m = sheet();
    return m;
}

PaintStroke stroke_at(double x, double y, double turn, const std::string& brush = "wolf-small",
                      const std::string& ink = "carbon") {
    const Vec3 along{std::cos(turn), std::sin(turn), 0};
    PaintStroke s = line(brush, 3e-3, make_frame({x, y, 0}, {0, 0, 1}, along));
    s.ink = ink;
    s.seed = 17;             // of the edge and the tone of wet hair
    s.settings.spacing = 3;  // coarse is enough here, and quick
    return s;
}

// Strokes that cross, touch, lie apart; wet ones and dry ones; two inks; an eraser over some.
std::vector<JournalEntry> crossing_strokes() {
    std::vector<JournalEntry> all;
    for (int i = 0; i < 6; ++i)
        all.emplace_back(stroke_at(-0.02 + 0.004 * i, -0.012 + 0.005 * i, 0.3 * i, "wolf-small",
                                   i % 3 == 2 ? "cinnabar" : "carbon"));
    PaintStroke eraser = stroke_at(-0.01, 0.002, 1.2);
    eraser.tool = Tool::eraser;
    all.emplace_back(eraser);
    PaintStroke dry = stroke_at(-0.015, 0.014, 0);
    for (StrokeSample& s : dry.trace.samples) s.time *= 0.1;  // fast strokes part the hair
    all.emplace_back(dry);
    all.emplace_back(stroke_at(0.008, -0.02, 1.5, "wolf-small", "cinnabar"));
    all.emplace_back(stroke_at(-0.02, -0.02, 0.1));
    return all;
}

std::uint64_t one_by_one(const std::vector<JournalEntry>& entries, std::size_t n) {
    set_thread_count(1);
    Document p(model());
    for (std::size_t i = 0; i < n; ++i) p.paint(entries[i]);
    return p.layers().hash();
}

TEST_F(Batch, WatchedStrokesHaveTheSameBitsAndAreSeenAlongTheirPath) {
    const std::vector<JournalEntry> entries = crossing_strokes();
    const std::uint64_t expected = one_by_one(entries, entries.size());
    set_thread_count(3);
    Document p(model());
    std::size_t strokes = 0, seen = 0;
    double last = 1;
    p.watch_poses([&](const StrokeSession& session, double part) {
        if (part <= last) ++strokes;  // begins anew
        last = part;
        seen += session.tuft().branches.empty() ? 0 : 1;
        EXPECT_GT(part, 0);
        EXPECT_LE(part, 1);
    });
    p.paint(entries, {});
    EXPECT_EQ(p.layers().hash(), expected);
    EXPECT_EQ(strokes, entries.size());
    EXPECT_GT(seen, 10 * entries.size());
    p.watch_poses({});
    p.paint(stroke_at(0, 0, 0));
    EXPECT_EQ(strokes, entries.size());
}

TEST_F(Batch, PaintsTheBitsOfOneStrokeAfterTheOther) {
    const std::vector<JournalEntry> entries = crossing_strokes();
    set_thread_count(1);
    Document alone(model());
    std::vector<StrokeReport> expected;
    for (const JournalEntry& entry : entries) expected.push_back(alone.paint(entry));
    for (const int threads : {1, 2, 5}) {
        set_thread_count(threads);
        Document p(model());
        std::vector<StrokeReport> reports;
        p.paint(entries, [&](const JournalEntry& entry, StrokeReport report) {
            EXPECT_EQ(entry.id, reports.size() + 1) << "in order";
            reports.push_back(std::move(report));
        });
        EXPECT_EQ(p.layers().hash(), alone.layers().hash()) << threads << " threads";
        ASSERT_EQ(reports.size(), expected.size());
        for (std::size_t i = 0; i < reports.size(); ++i) {
            EXPECT_EQ(reports[i].stamps, expected[i].stamps);
            EXPECT_EQ(reports[i].ink_given, expected[i].ink_given);
            EXPECT_EQ(reports[i].ink_left, expected[i].ink_left);
        }
        // The brush in hand, too, which a stroke goes on with.
        PaintStroke next = stroke_at(0, 0.01, 0.5);
        next.settings.dip = DipMode::persistent;
        Document both(model());
        both.paint(entries, {});
        both.paint(JournalEntry(next));
        set_thread_count(1);
        Document q(model());
        for (const JournalEntry& entry : entries) q.paint(entry);
        q.paint(JournalEntry(next));
        EXPECT_EQ(both.layers().hash(), q.layers().hash());
        set_thread_count(threads);
        Document again(model());
        again.replay(p.journal().entries());
        EXPECT_EQ(again.layers().hash(), alone.layers().hash());
    }
}

TEST_F(Batch, IsTakenBackStrokeByStroke) {
    const std::vector<JournalEntry> entries = crossing_strokes();
    set_thread_count(3);
    Document p(model());
    p.paint(entries, {});
    for (std::size_t n = entries.size(); n-- > 5;) {
        set_thread_count(3);
        ASSERT_TRUE(p.undo());
        EXPECT_EQ(p.layers().hash(), one_by_one(entries, n)) << n;
    }
}

// A ferrule within a closed model is held on its surface, far from where it is expected.
TEST_F(Batch, StrokeOutsideItsPlanIsPaintedByItself) {
    std::vector<JournalEntry> entries = crossing_strokes();
    const double below = 0.05;  // under the sheet, farther than the tuft is long
    PaintStroke lost = stroke_at(-0.01, 0, 0.4);
    for (StrokeSample& s : lost.trace.samples) s.position.z -= below;
    // From above the sheet to below it at once: the tuft stays on the side that it came from.
    lost.trace.samples.front().position.z += below;
    entries.insert(entries.begin() + 4, lost);
    set_thread_count(3);
    Document p(model());
    p.paint(entries, {});
    EXPECT_EQ(p.layers().hash(), one_by_one(entries, entries.size()));
    EXPECT_EQ(p.journal().entries().size(), entries.size());
}

TEST_F(Batch, FaultLeavesWhatCameBefore) {
    std::vector<JournalEntry> entries = crossing_strokes();
    entries[5].get<PaintStroke>().brush = "no-such-brush";
    set_thread_count(3);
    Document p(model());
    EXPECT_THROW(p.paint(entries, {}), Error);
    EXPECT_EQ(p.journal().entries().size(), 5u);
    EXPECT_EQ(p.layers().hash(), one_by_one(entries, 5));
    EXPECT_EQ(p.layers().pigments().size(), 2u);

    // The same where whoever stores the strokes fails.
    Document q(model());
    const auto entries_of_all = crossing_strokes();
    EXPECT_THROW(q.paint(entries_of_all,
                         [](const JournalEntry& entry, const StrokeReport&) {
                             if (entry.id == 3) throw Error("the disk is full");
                         }),
                 Error);
    EXPECT_EQ(q.layers().hash(), one_by_one(entries_of_all, 3));
}

TEST_F(Batch, StopLeavesAPrefix) {
    const std::vector<JournalEntry> entries = crossing_strokes();
    for (const double at : {0.05, 0.4, 0.8}) {
        set_thread_count(3);
        Document p(model());
        EXPECT_THROW(p.paint(entries, {}, [at](std::string_view, double done) { return done < at; }), Cancelled);
        const std::size_t n = p.journal().entries().size();
        EXPECT_LT(n, entries.size());
        EXPECT_EQ(p.layers().hash(), one_by_one(entries, n));
    }
}

// The hair of a forecast is that of the session, until the tuft is dry and after.
TEST_F(Batch, ForecastDoesNotChangeAStroke) {
    for (const double length : {1.0, 6.0}) {
        PaintStroke stroke = stroke_at(-0.02, 0, 0);
        const std::vector<StrokeSample> once = stroke.trace.samples;
        for (int i = 1; i < static_cast<int>(length); ++i)  // to and fro until it is dry
            for (std::size_t k = 0; k < once.size(); ++k) {
                StrokeSample s = i % 2 ? once[once.size() - 1 - k] : once[k];
                s.time = i * (once.back().time + 0.01) + once[k].time;
                stroke.trace.samples.push_back(s);
            }
        set_thread_count(1);
        Document alone(model());
        const StrokeReport expected = alone.paint(JournalEntry(stroke));
        set_thread_count(2);
        Document p(model());
        std::vector<StrokeReport> reports;
        p.paint({JournalEntry(stroke), JournalEntry(stroke_at(0.01, 0.025, 0))},
                [&](const JournalEntry&, StrokeReport report) { reports.push_back(std::move(report)); });
        EXPECT_EQ(reports.at(0).ink_left, expected.ink_left);
        EXPECT_EQ(reports.at(0).stamps, expected.stamps);
    }
}

TEST_F(Batch, PartsOfAPathCoverItOnce) {
    std::vector<brush::Pose> poses(50);
    for (std::size_t i = 0; i < poses.size(); ++i) poses[i].position.x = 1e-3 * static_cast<double>(i);
    const std::vector<std::size_t> parts = parts_of_path(poses, 7e-3);
    EXPECT_EQ(parts.back(), poses.size());
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const std::size_t begin = k ? parts[k - 1] : 0;
        EXPECT_GE(parts[k], begin + 4);
        EXPECT_GE(static_cast<double>(parts[k] - begin), 7.0);
    }
    EXPECT_EQ(parts_of_path(std::span(poses).first(3), 7e-3), (std::vector<std::size_t>{3}));
    EXPECT_EQ(parts_of_path({}, 7e-3), (std::vector<std::size_t>{0}));
}

// Up to eight stamps of ink wait at the end of a stroke, and a lift passes several parts in the air.
TEST_F(Batch, PlacesOfALiftAreInUseToTheEnd) {
    const brush::Preset preset = brush::load_preset("wolf-small");
    std::vector<brush::Pose> poses(60);
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const double lift = 1e-3 * std::max(0.0, static_cast<double>(i) - 19);  // metres
        poses[i].position = {1e-3 * static_cast<double>(std::min<std::size_t>(i, 19)), 0, preset.length - 2e-3 + lift};
    }
    const std::vector<std::size_t> parts = parts_of_path(poses, 5e-3);
    const std::vector<ReachedPlace> places = reached_places(*model().query, poses, parts, preset, 6e-5);
    const auto end = static_cast<std::uint32_t>(parts.size());
    ASSERT_FALSE(places.empty());
    EXPECT_GT(end, places.back().first + 3) << "in the air";
    EXPECT_EQ(places.back().last, end);
    EXPECT_LT(places.front().last, end);
}

// A batch of long strokes would hold all of their poses at once, 25 kB each.
TEST(StrokeForecast, HoldsNoMoreThanItsBudgetAndIsTheSame) {
    brush::Tuft tuft = brush::make_tuft(brush::load_preset("wolf-small"), 1);
    std::vector<brush::Pose> path;
    for (int i = 0; i < 400; ++i)
        path.push_back(
            {.position = {1e-4 * i - 0.02, 0, 0.9 * tuft.preset.length}, .rotation = {1, 0, 0, 0}, .time = 5e-3 * i});
    const auto forces = [&](std::size_t most, std::size_t& held) {
        ForecastBudget budget{.most = most};
        std::vector<Vec3> found;
        {
            StrokeForecast forecast(tuft, path, *model().query, {});
            forecast.compute(false, budget);
            for (const brush::Pose& pose : path) {
                PoseForecast* ready = forecast.next(pose, tuft, false);
                if (!ready) break;
                found.push_back(ready->contact.tuft.force);
                held = std::max<std::size_t>(held, budget.held);
            }
        }
        EXPECT_EQ(budget.held, 0u);
        return found;
    };
    std::size_t all = 0, few = 0;
    tuft.wetness = 1;
    const std::vector<Vec3> whole = forces(std::size_t{1} << 40, all), bounded = forces(1, few);
    EXPECT_EQ(whole.size(), path.size());
    EXPECT_GT(glm::length(whole.back()), 1e-3) << "it touches";
    EXPECT_EQ(whole, bounded);
    // Two parts of 32 poses of 400, the one that is used and the next; the first ones have less contact.
    EXPECT_LT(few, all / 5);
}

}  // namespace
}  // namespace tuft::stroke
