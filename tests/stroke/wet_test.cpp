#include <gtest/gtest.h>

#include "core/system/parallel.h"
#include "sheet.h"

namespace tuft::stroke {
namespace {

const std::string kBrush = "wolf-small";

// A stroke along x, or along y, with ink that stays wet.
PaintStroke wet_line(const std::string& ink, bool along_y = false, double offset = 0) {
    const Vec3 along = along_y ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
    const Vec3 centre = along_y ? Vec3{offset, 0, 0} : Vec3{0, offset, 0};
    PaintStroke s = line(kBrush, 4e-3, make_frame(centre, {0, 0, 1}, along));
    s.ink = ink;
    s.settings.film = FilmModel::wet;
    s.settings.dip = DipMode::persistent;
    s.settings.spacing = 3;  // coarse is enough here, and quick
    return s;
}

Dry dry(double seconds) {
    return {.seconds = seconds};
}

double in_hair(const Document& painting, int plane) {
    const BrushInHand* brush = painting.brushes().find(kBrush);
    return brush ? brush->reservoir.pigment(plane) : 0;
}

TEST(WetInk, AStopAtAnyMomentLeavesEverythingAsItWas) {
    const Model model = sheet();
    Document painting(model, {.substrate = "bisque"}), undisturbed(model, {.substrate = "bisque"});
    PaintStroke slow = wet_line("carbon", true);
    slow.trace.samples.back().time += 1;  // the hand rests, the film flows meanwhile
    for (const JournalEntry& entry : {JournalEntry(wet_line("carbon")), JournalEntry(slow), JournalEntry(dry(1))}) {
        const std::uint64_t before = painting.layers().canvas().hash();
        const double hair = in_hair(painting, 0);
        int asked = 0;
        const StrokeReport report = undisturbed.paint(entry, [&](std::string_view, double) { return ++asked > 0; });
        // Between two stamps, and between two steps of the film, a stop is possible.
        EXPECT_GE(asked, static_cast<int>(report.stamps));
        EXPECT_GT(asked, 10);
        for (const int last : {1, asked / 2, asked}) {
            int n = 0;
            EXPECT_THROW(painting.paint(entry, [&](std::string_view, double) { return ++n < last; }), Cancelled);
            EXPECT_EQ(n, last) << "it stops at once";
            EXPECT_EQ(painting.layers().canvas().hash(), before);
            EXPECT_EQ(in_hair(painting, 0), hair);
        }
        painting.paint(entry);
        EXPECT_EQ(painting.layers().canvas().hash(), undisturbed.layers().canvas().hash())
            << "what comes after does not know of it";
    }
    EXPECT_EQ(painting.journal().entries().size(), 3u);
}

TEST(WetInk, KeepsEachPigmentThroughStrokePickUpFlowDryAndUndo) {
    const Model model = sheet();
    Document painting(model, {.substrate = "bisque"});
    painting.paint(wet_line("carbon"));
    const double carbon = painting.layers().canvas().total(model.texels, 0) + in_hair(painting, 0);
    const double capacity = painting.materials().brush(kBrush).capacity * ink::kFilmPerVolume;
    EXPECT_NEAR(carbon / capacity, 1, 1e-6) << "the brush was full of it";
    const std::uint64_t first = painting.layers().canvas().hash();
    painting.paint(wet_line("carbon", true));  // through the wet line with what is left in the hair
    EXPECT_NEAR((painting.layers().canvas().total(model.texels, 0) + in_hair(painting, 0)) / carbon, 1, 1e-6);
    const double left = painting.layers().canvas().total(model.texels, 0);
    const std::uint64_t second = painting.layers().canvas().hash();
    painting.paint(dry(3));
    EXPECT_NEAR(painting.layers().canvas().total(model.texels, 0) / left, 1, 1e-5);
    EXPECT_TRUE(painting.layers().canvas().wet());
    painting.paint(dry(0));
    EXPECT_FALSE(painting.layers().canvas().wet());
    EXPECT_NEAR(painting.layers().canvas().total(model.texels, 0) / left, 1, 1e-5);
    painting.undo();
    painting.undo();
    EXPECT_EQ(painting.layers().canvas().hash(), second) << "drying taken back, wet tiles that flowed too";
    painting.undo();
    EXPECT_EQ(painting.layers().canvas().hash(), first);
    painting.redo();
    EXPECT_EQ(painting.layers().canvas().hash(), second);
}

TEST(WetInk, ReplaysToTheBitOnAnyNumberOfThreads) {
    const Model model = sheet();
    std::uint64_t hashes[2];
    std::vector<JournalEntry> journal;
    for (int i = 0; i < 2; ++i) {
        set_thread_count(i ? 3 : 1);
        Document painting(model, {.substrate = "bisque"});
        if (i == 0) {
            painting.paint(wet_line("carbon"));
            painting.paint(dry(1));
            painting.paint(wet_line("gamboge", true));
            painting.paint(dry(2));
            journal = painting.journal().entries();
        } else {
            painting.replay(journal);
        }
        hashes[i] = painting.layers().canvas().hash();
    }
    set_thread_count(0);
    EXPECT_EQ(hashes[0], hashes[1]);
}

PaintStroke erasing(PaintStroke s) {
    s.tool = Tool::eraser;
    return s;
}

TEST(WetInk, NothingStaysOfAStrokeThatTheSameStrokeErases) {
    const Model model = sheet();
    Document painting(model, {.substrate = "porcelain"});
    PaintStroke s = wet_line("carbon");
    s.settings.spacing = 1;
    s.settings.dip = DipMode::each;  // with the same hair
    painting.paint(s);
    const double painted = painting.layers().canvas().total(model.texels, 0);
    const std::uint64_t before = painting.layers().canvas().hash();
    const StrokeReport report = painting.paint(erasing(s));
    double most = 0;
    for (const std::uint32_t slot : painting.layers().canvas().touched_slots())
        if (const ink::Plane* w = painting.layers().canvas().plane(slot, 0))
            for (const float v : *w) most = std::max(most, static_cast<double>(v));
    EXPECT_LT(most, 0.02)
        << "of 1.8: a reflectance less by 8 %, on single texels; 0.3 on a rim where the ink had run on";
    EXPECT_LT(painting.layers().canvas().total(model.texels, 0), 1e-4 * painted);
    EXPECT_NEAR((report.removed.pigment[0] + painting.layers().canvas().total(model.texels, 0)) / painted, 1, 1e-6);
    painting.undo();
    EXPECT_EQ(painting.layers().canvas().hash(), before);
}

TEST(WetInk, AnEraserThroughAWashLeavesItsEdgesAsDryOnesAre) {
    const Model model = sheet();
    std::vector<double> ink;
    for (const bool wet : {false, true}) {
        Document painting(model, {.substrate = "porcelain"});
        PaintStroke s = wet_line("carbon");
        if (!wet) s.settings.film = FilmModel::still;
        painting.paint(s);
        const double painted = painting.layers().canvas().total(model.texels, 0);
        PaintStroke across = erasing(wet_line("carbon", true));
        across.settings.film = s.settings.film;
        painting.paint(across);
        ink.push_back(painting.layers().canvas().total(model.texels, 0) / painted);
    }
    EXPECT_LT(ink[0], 0.95) << "it did erase";
    EXPECT_NEAR(ink[1], ink[0], 0.01);
}

TEST(WetInk, YellowThroughWetPurplePicksItUpAndNotWhenItIsDry) {
    const Model model = sheet();
    double picked[2];
    for (int i = 0; i < 2; ++i) {
        Document painting(model);
        painting.paint(wet_line("indigo"));
        if (i) painting.paint(dry(0));
        painting.paint(wet_line("gamboge", true));
        // Indigo beside the line that was indigo, further along the yellow one.
        picked[i] = 0;
        for (std::uint32_t slot = 0; slot < model.texels.n_slots(); ++slot)
            for (int t = 0; t < atlas::kTileTexels; ++t)
                if (const ink::Plane* w = painting.layers().canvas().plane(slot, 0);
                    w && std::abs(model.texels.position(slot, t).y) > 6e-3f)
                    picked[i] += static_cast<double>((*w)[t] * model.texels.tiles[slot].area[t]);
    }
    EXPECT_GT(picked[0], 1e-7) << "film m2: 0.1 mm2 at one unit";
    EXPECT_EQ(picked[1], 0);
}

TEST(WetInk, ADrippingTuftLeavesDripsOnAWallAndAFullOneDoesNot) {
    const Model model = sheet();
    double lowest[2];
    for (int i = 0; i < 2; ++i) {
        Document painting(model, {.substrate = "porcelain"});
        PaintStroke line = wet_line("carbon");
        const BrushAction dip{.what = Dip{.amount = i ? 1.5 : 1}, .brush = kBrush, .ink = "carbon"};
        line.settings.down = {0, -1, 0};  // the sheet as a wall
        painting.paint(dip);
        const double held = in_hair(painting, 0);
        const double capacity = painting.materials().brush(kBrush).capacity * ink::kFilmPerVolume;
        EXPECT_NEAR(held / capacity, i ? 1.5 : 1, 1e-9);
        painting.paint(line);
        const Dry wait{.seconds = 2, .down = line.settings.down};
        painting.paint(wait);
        EXPECT_NEAR((painting.layers().canvas().total(model.texels, 0) + in_hair(painting, 0)) / held, 1, 1e-5);
        lowest[i] = 1;
        for (const std::uint32_t slot : painting.layers().canvas().touched_slots())
            for (int t = 0; t < atlas::kTileTexels; ++t)
                if (const ink::Plane* p = painting.layers().canvas().plane(slot, 0); p && (*p)[t] > 0.05f)
                    lowest[i] = std::min(lowest[i], static_cast<double>(model.texels.position(slot, t).y));
    }
    EXPECT_LT(lowest[1], lowest[0] - 4e-3);
    EXPECT_GT(lowest[0], -4e-3) << "half the width of the stroke";
}

TEST(WetInk, StillInkIsUnchanged) {
    // With all that is wet left out of the settings, nothing flows and no time passes.
    const Model model = sheet();
    Document painting(model);
    PaintStroke s = wet_line("carbon");
    s.settings.film = FilmModel::still;
    painting.paint(s);
    EXPECT_FALSE(painting.layers().canvas().wet());
    const std::uint64_t hash = painting.layers().canvas().hash();
    painting.paint(dry(100));
    EXPECT_EQ(painting.layers().canvas().hash(), hash) << "it is closed only when all is to dry";
    painting.paint(dry(0));
    EXPECT_NE(painting.layers().canvas().hash(), hash);
}

TEST(WetInk, SettingsComeBackFromTheirText) {
    StrokeSettings s;
    s.film = FilmModel::wet;
    s.down = {0.5, 0, -0.25};
    EXPECT_EQ(settings_from_json(to_json(s)), s);
    EXPECT_EQ(settings_from_json("{}").film, FilmModel::still) << "journals of old";
    EXPECT_ANY_THROW(settings_from_json(R"({"film": "damp"})"));
    EXPECT_ANY_THROW(settings_from_json(R"({"down": [1, 2]})"));
}

}  // namespace
}  // namespace tuft::stroke
