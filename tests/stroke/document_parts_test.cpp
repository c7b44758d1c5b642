#include <gtest/gtest.h>

#include "sheet.h"
#include "stroke/drawing/line_width.h"
#include "stroke/painting/undo_history.h"
#include "stroke/placement/tip_lag.h"

/// The parts of a document, each on its own.
namespace tuft::stroke {
namespace {

constexpr std::size_t kSlots = 4;

// A canvas with `film` units of one ink on the first texel of a slot.
void ink_slot(ink::Canvas& canvas, std::uint32_t slot, const std::string& ink, float film) {
    canvas.touch(slot, canvas.add_pigment(ink::load_ink(ink).parts[0].pigment))[0] = film;
}

LayerStack two_layers() {
    LayerStack layers(kSlots);
    ink_slot(layers.canvas(), 0, "carbon", 1);
    layers.edit(add_on_top(layers.table(), "upper"));
    ink_slot(layers.canvas(2), 1, "carbon", 2);
    return layers;
}

TEST(LayerStack, TakingAnEditBackLeavesTableAndTexelsAsTheyWere) {
    const LayerStack start = two_layers();
    const LayerTable& table = start.table();
    Layer half = start.layer(2);
    half.opacity = 0.5;
    LayerEdit copy = duplicated(table, 2, "copy");
    copy.layer.id = table.next_id;
    LayerEdit fresh = add_on_top(table, "third");
    fresh.layer.id = table.next_id;
    for (const LayerEdit& edit :
         {fresh, copy, changed(table, half), moved(table, 2, 0), removed(1), removed(2), merged_down(table, 2)}) {
        LayerStack layers = two_layers();
        LayerBackup before = layers.edit(edit);
        EXPECT_FALSE(layers.table() == table && layers.hash() == start.hash()) << "it does something";
        layers.restore(std::move(before));
        EXPECT_EQ(layers.table(), table);
        EXPECT_EQ(layers.hash(), start.hash());
    }
}

TEST(LayerStack, EveryCanvasHasThePigmentsInTheSamePlanes) {
    LayerStack layers(kSlots);
    layers.edit(add_on_top(layers.table(), "upper"));
    layers.mix_of(ink::load_ink("indigo"));
    layers.mix_of(ink::load_ink("carbon"));
    const std::vector<ink::Pigment>& upper = layers.canvas(2).pigments();
    ASSERT_EQ(upper.size(), layers.pigments().size());
    for (std::size_t p = 0; p < upper.size(); ++p) EXPECT_EQ(upper[p].name, layers.pigments()[p].name);
}

TEST(LayerStack, ReportsASlotOnceWhereFilmOrAppearanceChanged) {
    LayerStack layers = two_layers();
    EXPECT_EQ(layers.take_dirty(), (std::vector<std::uint32_t>{0, 1}));
    EXPECT_TRUE(layers.take_dirty().empty());
    layers.mark_changed(2);
    layers.mark_changed();
    EXPECT_EQ(layers.take_dirty(), (std::vector<std::uint32_t>{0, 1}));
}

// A record with a tile of so many floats.
UndoRecord record_of(std::uint64_t entry, std::size_t floats) {
    UndoRecord record{.entry = entry};
    record.tiles.push_back({kFirstLayer, {{.slot = 0, .amounts = std::vector<float>(floats)}}});
    return record;
}

TEST(UndoHistory, GivesUpTheOldestRecordsButNeverTheLast) {
    constexpr std::size_t kFloats = 1024, kEach = kFloats * sizeof(float) + sizeof(ink::TileSnapshot);
    UndoHistory history(2 * kEach);
    for (std::uint64_t entry = 1; entry <= 3; ++entry) history.add(record_of(entry, kFloats), entry);
    EXPECT_FALSE(history.take(2)) << "not the last one";
    EXPECT_TRUE(history.take(3));
    EXPECT_TRUE(history.take(2));
    EXPECT_FALSE(history.take(1)) << "three did not fit";
    history.add(record_of(4, 100 * kFloats), 4);
    EXPECT_TRUE(history.take(4)) << "larger than the budget";
}

TEST(UndoHistory, KnowsThePigmentsBeforeEachEntry) {
    UndoHistory history(1 << 20);
    history.clear(1);
    history.add(record_of(1, 1), 3);
    history.add(record_of(2, 1), 4);
    EXPECT_EQ(history.n_pigments(), 4u);
    history.take(2);
    EXPECT_EQ(history.n_pigments(), 3u);
    history.take(1);
    EXPECT_EQ(history.n_pigments(), 1u);
}

TEST(BrushesInHand, PuttingDownAndTakingThatBackChangesNothing) {
    BrushesInHand brushes;
    const BrushStart start{.preset = brush::load_preset("wolf-small"),
                           .name = "wolf-small",
                           .ink = "carbon",
                           .mix = {1},
                           .dip = DipMode::persistent};
    BrushBackup before = brushes.put_down(start.name, brushes.take_up(start));
    BrushInHand wiped = brushes.take_up(start);
    ink::wipe(wiped.reservoir, 0.5, {});
    const double left = wiped.reservoir.remaining();
    BrushBackup full = brushes.put_down(start.name, std::move(wiped));
    EXPECT_EQ(brushes.take_up(start).reservoir.remaining(), left) << "carried on";
    brushes.restore(std::move(full));
    EXPECT_GT(brushes.take_up(start).reservoir.remaining(), left);
    brushes.restore(std::move(before));
    EXPECT_EQ(brushes.find(start.name), nullptr);
}

TEST(Materials, ABrushInThePlaceOfAnotherHasATipLagOfItsOwn) {
    const Model model = sheet();
    const LayerStack layers(model.texels.n_slots());
    Materials materials("porcelain", layers);
    const auto longest = [&] { return materials.holder("wolf-small", *model.mesh, true).tip_lag.back().length; };
    const double small = longest();
    brush::Preset wide = brush::load_preset("wolf-medium");
    wide.name = "wolf-small";
    materials.use(wide);
    EXPECT_GT(longest(), 1.2 * small) << "of the larger brush";
}

// Paths are fitted by drawings on a plane: a hand that sets down elsewhere there draws heads that are painted
// elsewhere.
TEST(Materials, TheHandOfADrawingOnAPlaneIsThatWhichPaints) {
    const Model model = sheet();
    const LayerStack layers(model.texels.n_slots());
    const Materials materials("porcelain", layers);
    WidthTables tables;
    StrokeSamples pressed;
    for (int i = 0; i <= 20; ++i)
        pressed.samples.push_back({.time = 0.01 * i, .position = {4e-4 * i, 0, 0}, .pressure = 0.3});
    const auto hand = [&](const HolderOptions& holder) { return compensate_tip_lag(pressed, holder).samples; };
    const std::vector<StrokeSample> painted = hand(materials.holder("wolf-small", *model.mesh, true)),
                                    drawn = hand(tables.holder("wolf-small"));
    ASSERT_EQ(drawn.size(), painted.size());
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        EXPECT_EQ(drawn[i].position, painted[i].position) << i;
        EXPECT_EQ(drawn[i].tilt, painted[i].tilt) << i;
    }
}

TEST(Palette, IsMadeWhenItIsUsed) {
    Palette palette;
    EXPECT_TRUE(palette.take_dirty().empty());
    EXPECT_EQ(palette.canvas(), nullptr);
    const std::vector<ink::Pigment> pigments{ink::load_ink("carbon").parts[0].pigment};
    EXPECT_EQ(palette.canvas_with(pigments).pigments().size(), 1u);
    EXPECT_NE(palette.canvas(), nullptr);
}

}  // namespace
}  // namespace tuft::stroke
