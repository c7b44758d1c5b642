#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/system/parallel.h"
#include "sheet.h"

namespace tuft::stroke {
namespace {

const std::string kBrush = "wolf-small";

// A stroke on its own place of the sheet, row by row.
PaintStroke persistent_stroke(int row, const std::string& ink = "carbon", const std::string& brush = kBrush,
                              double depth = 4e-3) {
    PaintStroke s = line(brush, depth, make_frame({0, 0.004 * row - 0.012, 0}, {0, 0, 1}, {1, 0, 0}));
    s.ink = ink;
    s.settings.dip = DipMode::persistent;
    s.settings.spacing = 3;  // coarse is enough here, and quick
    return s;
}

BrushAction action(const BrushChange& what, const std::string& ink = {}, const std::string& brush = kBrush) {
    return {.what = what, .brush = brush, .ink = ink, .dip = DipMode::persistent};
}

// How far the hair has yielded, radians.
double set_of(const BrushInHand& brush) {
    double sum = 0;
    for (const auto& joint : brush.tuft.trunk().memory.joint)
        if (joint.yielded)
            for (const Vec2& stop : joint.stop) sum += glm::length(stop);
    return sum;
}

TEST(PersistentBrush, InkRunsDownFromStrokeToStrokeAndADipFillsItUp) {
    const Model model = sheet();
    Document painting(model);
    const double capacity = painting.materials().brush(kBrush).capacity * ink::kFilmPerVolume;
    double left = capacity;
    for (int row = 0; row < 3; ++row) {
        const StrokeReport r = painting.paint(persistent_stroke(row));
        // What was there is given or left.
        EXPECT_NEAR((r.ink_given + r.ink_left) / left, 1, 1e-9);
        EXPECT_LT(r.ink_left, left);
        left = r.ink_left;
        EXPECT_EQ(painting.brushes().find(kBrush)->reservoir.remaining(), left);
    }
    painting.paint(action(Dip{}, "carbon"));
    EXPECT_NEAR(painting.brushes().find(kBrush)->reservoir.remaining() / capacity, 1, 1e-12);
    painting.paint(action(Rinse{}));
    EXPECT_EQ(painting.brushes().find(kBrush)->reservoir.remaining(), 0);
    const StrokeReport dry = painting.paint(persistent_stroke(3));
    EXPECT_TRUE(dry.touched());
    EXPECT_EQ(dry.ink_given, 0);
}

TEST(PersistentBrush, HairKeepsItsSetUntilItIsCombed) {
    const Model model = sheet();
    Document painting(model);
    painting.paint(persistent_stroke(0, "carbon", kBrush, 0.6 * painting.materials().brush(kBrush).length));
    const double set = set_of(*painting.brushes().find(kBrush));
    ASSERT_GT(set, 0);
    painting.paint(action(Dip{}, "carbon"));
    EXPECT_EQ(set_of(*painting.brushes().find(kBrush)), set);
    const double ink = painting.brushes().find(kBrush)->reservoir.remaining();
    painting.paint(action(Reshape{}));
    EXPECT_EQ(set_of(*painting.brushes().find(kBrush)), 0);
    EXPECT_EQ(painting.brushes().find(kBrush)->reservoir.remaining(), ink);
}

TEST(PersistentBrush, WetnessFollowsTheInkAlsoInAReplay) {
    const Model model = sheet();
    const auto wetness = [](const Document& painting) { return painting.brushes().find(kBrush)->tuft.wetness; };
    Document painting(model);
    painting.paint(action(Dip{}, "carbon"));
    EXPECT_EQ(wetness(painting), 1);
    painting.paint(persistent_stroke(0));
    EXPECT_LE(wetness(painting), 1);
    painting.paint(action(Rinse{}));
    EXPECT_EQ(wetness(painting), 0) << "rinsed and wiped";
    Document again(model);
    again.replay(painting.journal().entries());
    EXPECT_EQ(wetness(again), 0);
    painting.paint(action(Dip{}, "carbon"));
    EXPECT_EQ(wetness(painting), 1);
}

TEST(PersistentBrush, ACombedFullBrushIsAFreshOne) {
    const Model model = sheet();
    Document carry(model), each(model);
    carry.paint(persistent_stroke(0));
    carry.paint(action(Reshape{}));
    carry.paint(action(Dip{}, "carbon"));
    carry.paint(persistent_stroke(1));
    PaintStroke a = persistent_stroke(0), b = persistent_stroke(1);
    a.settings.dip = b.settings.dip = DipMode::each;
    each.paint(a);
    each.paint(b);
    // The same up to the rounding of a refilled reservoir and a hair brought from elsewhere.
    EXPECT_NEAR(carry.layers().canvas().total(model.texels, 0) / each.layers().canvas().total(model.texels, 0), 1,
                1e-3);
}

TEST(PersistentBrush, AnotherInkIsDippedIntoUnlessLoadedBefore) {
    const Model model = sheet();
    Document painting(model);
    painting.paint(persistent_stroke(0, "carbon"));
    painting.paint(persistent_stroke(1, "cinnabar"));
    EXPECT_EQ(painting.brushes().find(kBrush)->dipped, "cinnabar");
    EXPECT_EQ(painting.brushes().find(kBrush)->reservoir.pigment(0), 0) << "washed before";
    // Told: a dip on top of what is left, which the next stroke keeps whichever of the two it names.
    painting.paint(action(Dip{}, "carbon"));
    const double mixed = painting.brushes().find(kBrush)->reservoir.pigment(0);
    EXPECT_GT(mixed, 0);
    painting.paint(persistent_stroke(2, "cinnabar"));
    EXPECT_GT(painting.brushes().find(kBrush)->reservoir.pigment(0), 0);
    EXPECT_LT(painting.brushes().find(kBrush)->reservoir.pigment(0), mixed);
    EXPECT_GT(painting.brushes().find(kBrush)->reservoir.pigment(1), 0);
}

// Strokes and actions of two brushes.
std::vector<JournalEntry> session() {
    return {persistent_stroke(0),
            persistent_stroke(1),
            persistent_stroke(1, "cinnabar", "goat-small"),
            action(Reshape{}),
            persistent_stroke(2),
            action(Dip{}, "cinnabar"),
            persistent_stroke(3),
            action(Rinse{}, {}, "goat-small"),
            action(Dip{}, "carbon", "goat-small"),
            persistent_stroke(4, "cinnabar", "goat-small")};
}

TEST(PersistentBrush, ReplayIsTheSameToTheBitForAnyThreadCount) {
    const Model model = sheet();
    std::uint64_t hash = 0;
    for (const int threads : {1, 3}) {
        set_thread_count(threads);
        Document painting(model);
        for (const JournalEntry& s : session()) painting.paint(s);
        if (threads == 1) hash = painting.layers().canvas().hash();
        EXPECT_EQ(painting.layers().canvas().hash(), hash);
        Document again(model);
        const auto reports = again.replay(painting.journal().entries());
        EXPECT_EQ(reports.size(), 6u) << "one for each stroke, none for the actions";
        EXPECT_EQ(again.layers().canvas().hash(), hash);
        EXPECT_EQ(again.brushes().find(kBrush)->reservoir.remaining(),
                  painting.brushes().find(kBrush)->reservoir.remaining());
    }
    set_thread_count(0);
}

TEST(PersistentBrush, UndoBringsTheBrushBackToo) {
    const Model model = sheet();
    for (const std::size_t undo_bytes : {std::size_t{1} << 28, std::size_t{1}}) {
        Document painting(model, {.undo_bytes = undo_bytes});
        const std::vector<JournalEntry> entries = session();
        struct Moment {
            std::uint64_t canvas;
            double ink, set;
        };
        std::vector<Moment> moments;
        const auto now = [&]() -> Moment {
            const BrushInHand* brush = painting.brushes().find(kBrush);
            return {painting.layers().canvas().hash(), brush ? brush->reservoir.remaining() : -1,
                    brush ? set_of(*brush) : -1};
        };
        for (const JournalEntry& s : entries) {
            moments.push_back(now());
            painting.paint(s);
        }
        const std::uint64_t end = painting.layers().canvas().hash();
        for (std::size_t i = entries.size(); i-- > 1;) {
            ASSERT_TRUE(painting.undo());
            const Moment m = now();
            EXPECT_EQ(m.canvas, moments[i].canvas) << i;
            EXPECT_EQ(m.ink, moments[i].ink) << i;
            EXPECT_EQ(m.set, moments[i].set) << i;
        }
        while (painting.redo()) {
        }
        EXPECT_EQ(painting.layers().canvas().hash(), end);
    }
}

TEST(PersistentBrush, AReopenedPaintingTakesAFreshBrushAndSaysSo) {
    const Model model = sheet();
    Document first(model);
    first.paint(persistent_stroke(0));
    EXPECT_EQ(first.journal().entries()[0].get<PaintStroke>().settings.dip, DipMode::each)
        << "nothing to carry on from";
    first.paint(persistent_stroke(1));
    EXPECT_EQ(first.journal().entries()[1].get<PaintStroke>().settings.dip, DipMode::persistent);
    Document second(model);
    second.adopt(first.journal().entries(), {{kFirstLayer, first.layers().canvas()}},
                 first.journal().entries().back().id);
    EXPECT_EQ(second.brushes().find(kBrush), nullptr);
    second.paint(persistent_stroke(2));
    EXPECT_EQ(second.journal().entries()[2].get<PaintStroke>().settings.dip, DipMode::each);
    second.paint(persistent_stroke(3));
    Document replayed(model);
    replayed.replay(second.journal().entries());
    EXPECT_EQ(replayed.layers().canvas().hash(), second.layers().canvas().hash());
}

TEST(PersistentBrush, ACancelledStrokeLeavesTheBrushAsItWas) {
    const Model model = sheet();
    Document painting(model);
    painting.paint(persistent_stroke(0));
    const double ink = painting.brushes().find(kBrush)->reservoir.remaining(),
                 set = set_of(*painting.brushes().find(kBrush));
    painting.begin(persistent_stroke(1));
    const auto poses = spatial_poses(persistent_stroke(1).trace);
    painting.extend(std::span(poses).first(poses.size() / 2));
    painting.cancel();
    EXPECT_EQ(painting.brushes().find(kBrush)->reservoir.remaining(), ink);
    EXPECT_EQ(set_of(*painting.brushes().find(kBrush)), set);
    EXPECT_THROW(painting.paint(action(Dip{}, "no-such-ink")), Error);
    EXPECT_EQ(painting.journal().entries().size(), 1u);
}

TEST(SmoothedSurface, AStrokeInPiecesIsTheWholeStrokeAndReplays) {
    const Model model = sheet();
    PaintStroke whole = line(kBrush, 4e-3);
    for (std::size_t i = 0; i < whole.trace.samples.size(); ++i)  // a shaky hand
        whole.trace.samples[i].position.y += 3e-4 * std::sin(1.9 * static_cast<double>(i));
    whole.settings.smooth = 1;
    whole.settings.stabilise = 1e-3;
    Document at_once(model), in_pieces(model), again(model);
    at_once.paint(whole);
    PaintStroke header = whole;
    header.trace.samples.clear();
    in_pieces.begin(header);
    for (const brush::Pose& pose : spatial_poses(whole.trace)) in_pieces.extend(std::span(&pose, 1));
    in_pieces.end();
    EXPECT_EQ(in_pieces.layers().canvas().hash(), at_once.layers().canvas().hash());
    // The journal keeps the hand as it was, so that the settings can still be changed.
    EXPECT_EQ(in_pieces.journal().entries()[0].get<PaintStroke>().trace.samples[20].position,
              whole.trace.samples[20].position);
    again.replay(in_pieces.journal().entries());
    EXPECT_EQ(again.layers().canvas().hash(), at_once.layers().canvas().hash());
}

}  // namespace
}  // namespace tuft::stroke
