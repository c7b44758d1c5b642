#include "stroke/journal/entry/layers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/error.h"
#include "core/system/parallel.h"
#include "entry_text.h"
#include "sheet.h"
#include "stroke/journal/tables.h"

namespace tuft::stroke {
namespace {

const Model& model() {
    static const Model m = sheet();
    return m;
}

PaintStroke on(std::uint32_t layer, int row = 0, const std::string& ink = "carbon") {
    PaintStroke s = line("wolf-small", 3e-3, make_frame({0, 0.004 * row, 0}, {0, 0, 1}, {1, 0, 0}));
    s.ink = ink;
    s.layer = layer;
    s.settings.spacing = 3;  // coarse is enough here, and quick
    return s;
}

std::uint32_t add(Document& p, const std::string& name) {
    p.paint(add_on_top(p.layers().table(), name));
    return p.layers().table().layers.back().id;
}

void set(Document& p, std::uint32_t id, const std::function<void(Layer&)>& how) {
    Layer layer = *p.layers().table().find(id);
    how(layer);
    p.paint(changed(p.layers().table(), layer));
}

std::vector<std::uint8_t> picture(const Document& p) {
    return ink::compose_srgb8(p.appearance().stack(), model().texels, p.appearance().substrate()).texels;
}

TEST(Layers, OneOverAnEmptyOneIsASingleLayerToTheBit) {
    Document single(model()), two(model()), below(model());
    single.paint(on(kFirstLayer));
    two.paint(on(add(two, "gold")));
    below.paint(on(kFirstLayer));
    add(below, "gold");
    EXPECT_TRUE(two.layers().canvas(2).same_contents(single.layers().canvas()));
    EXPECT_TRUE(below.layers().canvas().same_contents(single.layers().canvas()));
    const auto linear = [](const Document& p) {
        return ink::compose_linear(p.appearance().stack(), model().texels, p.appearance().substrate()).texels;
    };
    EXPECT_EQ(linear(two), linear(single));
    EXPECT_EQ(linear(below), linear(single));
    const auto height = [](const Document& p) {
        return ink::compose_height(p.appearance().stack(), model().texels).texels;
    };
    EXPECT_EQ(height(two), height(single));
    EXPECT_EQ(single.layers().hash(), single.layers().canvas().hash()) << "as without layers";
}

TEST(Layers, AHiddenOneAndOneWithoutOpacityContributeNothing) {
    Document p(model());
    p.paint(on(kFirstLayer));
    const auto before = picture(p);
    const std::uint32_t gold = add(p, "gold");
    p.paint(on(gold, 1, "cinnabar"));
    const auto both = picture(p);
    EXPECT_NE(both, before);
    set(p, gold, [](Layer& l) { l.visible = false; });
    EXPECT_EQ(picture(p), before);
    set(p, gold, [](Layer& l) { l.visible = true, l.opacity = 0; });
    EXPECT_EQ(picture(p), before);
    p.appearance().show_only({gold});
    EXPECT_TRUE(p.appearance().stack().layers.empty()) << "shown, but without opacity";
    set(p, gold, [](Layer& l) { l.opacity = 1; });
    p.appearance().show_only({});
    EXPECT_EQ(picture(p), both);
}

// What a change alters is reported, so that only that is drawn anew.
TEST(Layers, AChangeOfTheAppearanceIsDirtyWhereTheLayerHasInk) {
    Document p(model());
    p.paint(on(kFirstLayer, -3));
    const std::uint32_t gold = add(p, "gold");
    p.appearance().take_dirty();
    p.paint(on(gold, 3));
    const std::vector<std::uint32_t> touched = p.layers().canvas(gold).touched_slots();
    EXPECT_EQ(p.appearance().take_dirty(), touched);
    set(p, gold, [](Layer& l) { l.visible = false; });
    EXPECT_EQ(p.appearance().take_dirty(), touched);
    EXPECT_TRUE(p.appearance().take_dirty().empty());
    p.paint(removed(gold));
    EXPECT_EQ(p.appearance().take_dirty(), touched);
    p.undo();
    EXPECT_EQ(p.appearance().take_dirty(), touched);
}

TEST(Layers, ALockedOneRefusesTheHandAndNothingChanges) {
    Document p(model());
    const std::uint32_t gold = add(p, "gold");
    set(p, gold, [](Layer& l) { l.locked = true; });
    const std::uint64_t before = p.layers().hash();
    EXPECT_THROW(p.paint(on(gold)), Error);
    EXPECT_THROW(p.begin(on(gold)), Error);
    EXPECT_THROW(p.paint(on(7)), Error) << "no such layer";
    EXPECT_EQ(p.layers().hash(), before);
    EXPECT_EQ(p.journal().entries().size(), 2u);
    EXPECT_TRUE(p.paint(on(kFirstLayer)).touched());
}

// A session with every kind of change.
std::vector<JournalEntry> session() {
    LayerTable t;
    std::vector<JournalEntry> entries;
    const auto then = [&](const LayerEdit& e) {
        apply(t, e);
        entries.emplace_back(e);
    };
    entries.push_back(on(1, 0));
    then(add_on_top(t, "gold"));
    entries.push_back(on(2, 0, "cinnabar"));
    then(changed(t, {.id = 2, .name = "金", .visible = true, .opacity = 0.4, .locked = true}));
    then(add_on_top(t, "top"));
    then(moved(t, 3, 0));
    entries.push_back(on(3, 1, "indigo"));
    then(moved(t, 1, 2));
    then(removed(1));
    entries.push_back(on(3, 2));
    then(changed(t, {.id = 3, .name = "top", .visible = false}));
    then(removed(2));
    return entries;
}

TEST(Layers, UndoAndRedoGoOverEveryChange) {
    for (const std::size_t undo_bytes : {std::size_t{1} << 28, std::size_t{1}}) {
        Document p(model(), {.undo_bytes = undo_bytes});
        std::vector<LayerTable> tables;
        std::vector<std::vector<std::uint8_t>> pictures;
        const std::vector<JournalEntry> entries = session();
        for (const JournalEntry& s : entries) {
            tables.push_back(p.layers().table());
            pictures.push_back(picture(p));
            p.paint(s);
        }
        const LayerTable last = p.layers().table();
        const auto end = picture(p);
        for (std::size_t i = entries.size(); i-- > 0;) {
            ASSERT_TRUE(p.undo());
            EXPECT_EQ(p.layers().table(), tables[i]) << i;
            EXPECT_EQ(picture(p), pictures[i]) << i;
        }
        while (p.redo()) {
        }
        EXPECT_EQ(p.layers().table(), last);
        EXPECT_EQ(picture(p), end);
    }
}

TEST(Layers, AReplayIsTheSameToTheBitForAnyThreadCount) {
    std::uint64_t hash = 0;
    for (const int threads : {1, 3}) {
        set_thread_count(threads);
        Document p(model());
        for (const JournalEntry& s : session()) p.paint(s);
        if (threads == 1) hash = p.layers().hash();
        EXPECT_EQ(p.layers().hash(), hash);
        Document again(model());
        again.replay(p.journal().entries());
        EXPECT_EQ(again.layers().hash(), hash);
        EXPECT_EQ(again.layers().table(), p.layers().table());
    }
    set_thread_count(0);
}

// Stored texels serve also when the layers were changed after them.
TEST(Layers, ChangesAfterTheStoredTexelsNeedNoReplay) {
    Document p(model());
    for (const JournalEntry& s : session()) p.paint(s);
    Document at(model());
    std::vector<JournalEntry> strokes = p.journal().entries();
    const std::uint64_t stored = strokes[6].id;
    at.replay({strokes.begin(), strokes.begin() + 7});
    const auto stored_texels = [&] {
        std::vector<LayerCanvas> out;
        for (const LayerTexels& l : at.layers().canvases()) out.push_back({l.layer, *l.canvas});
        return out;
    };
    EXPECT_FALSE(fits(strokes, stored)) << "a stroke came after them";
    EXPECT_THROW(Document(model()).adopt(strokes, stored_texels(), stored), Error);
    strokes.resize(9);  // up to the removal of layer 1
    ASSERT_TRUE(fits(strokes, stored));
    Document adopted(model()), replayed(model());
    adopted.adopt(strokes, stored_texels(), stored);
    replayed.replay(strokes);
    EXPECT_EQ(adopted.layers().table(), replayed.layers().table());
    EXPECT_EQ(picture(adopted), picture(replayed));
    ASSERT_TRUE(adopted.undo());  // the removal, by what it kept
    EXPECT_EQ(adopted.layers().table().layers.size(), 3u);
    while (adopted.undo()) replayed.undo();
    EXPECT_EQ(adopted.layers().table(), LayerTable{});
}

// Copies, blends and a merge, with strokes between them.
std::vector<JournalEntry> merging_session() {
    LayerTable t;
    std::vector<JournalEntry> entries;
    const auto then = [&](const LayerEdit& e) {
        apply(t, e);
        entries.emplace_back(e);
    };
    entries.push_back(on(1, 0));
    then(duplicated(t, 1, "copy"));
    entries.push_back(on(2, 0, "cinnabar"));
    then(changed(t, {.id = 2, .name = "copy", .blend = ink::Blend::glaze}));
    then(changed(t, {.id = 1, .name = "Layer 1", .blend = ink::Blend::glaze}));
    then(merged_down(t, 2));
    entries.push_back(on(1, 1, "indigo"));
    then(duplicated(t, 1, "top"));
    then(changed(t, {.id = 3, .name = "top", .blend = ink::Blend::multiply}));
    then(moved(t, 3, 0));
    then({LayerChange::merge, {.id = 1}, 0, 3});
    entries.push_back(on(3, 2));
    return entries;
}

TEST(Layers, MergingAndCopyingUndoRedoAndReplayToTheBit) {
    for (const std::size_t undo_bytes : {std::size_t{1} << 28, std::size_t{1}}) {
        Document p(model(), {.undo_bytes = undo_bytes});
        std::vector<LayerTable> tables;
        std::vector<std::vector<std::uint8_t>> pictures;
        const std::vector<JournalEntry> entries = merging_session();
        for (const JournalEntry& s : entries) {
            tables.push_back(p.layers().table());
            pictures.push_back(picture(p));
            p.paint(s);
        }
        const auto end = picture(p);
        EXPECT_EQ(p.layers().table().layers.size(), 1u);
        EXPECT_EQ(p.layers().table().next_id, 4u);
        for (std::size_t i = entries.size(); i-- > 0;) {
            ASSERT_TRUE(p.undo());
            EXPECT_EQ(p.layers().table(), tables[i]) << i;
            EXPECT_EQ(picture(p), pictures[i]) << i;
        }
        while (p.redo()) {
        }
        EXPECT_EQ(picture(p), end);
        Document again(model());
        again.replay(p.journal().entries());
        EXPECT_EQ(picture(again), end);
    }
}

// A copy right above an opaque original shows nothing new; changed later, each goes its own way.
TEST(Layers, ACopyHasTheSameTexelsAndIsItsOwn) {
    Document p(model());
    p.paint(on(kFirstLayer));
    p.paint(duplicated(p.layers().table(), kFirstLayer, "copy"));
    const std::uint32_t copy = p.layers().table().layers.back().id;
    EXPECT_TRUE(p.layers().canvas(copy).same_contents(p.layers().canvas()));
    const std::uint64_t original = p.layers().canvas().hash();
    p.paint(on(copy, 1, "cinnabar"));
    EXPECT_EQ(p.layers().canvas().hash(), original);
    EXPECT_FALSE(p.layers().canvas(copy).same_contents(p.layers().canvas()));
}

TEST(Layers, MergedOnesLookAsBeforeAndLoseNoPigment) {
    for (const ink::Blend blend : {ink::Blend::normal, ink::Blend::glaze}) {
        Document p(model());
        p.paint(on(kFirstLayer));
        const std::uint32_t gold = add(p, "gold");
        p.paint(on(gold, 0, "cinnabar"));  // over the first
        p.paint(on(gold, 2, "gamboge"));   // beside it
        for (const std::uint32_t id : {kFirstLayer, gold}) set(p, id, [blend](Layer& l) { l.blend = blend; });
        const auto look =
            ink::compose_linear(p.appearance().stack(), model().texels, p.appearance().substrate()).texels;
        const auto amounts = ink::compose_amounts(p.appearance().stack(), model().texels).texels;
        p.paint(merged_down(p.layers().table(), gold));
        ASSERT_EQ(p.layers().table().layers.size(), 1u);
        const auto merged =
            ink::compose_linear(p.appearance().stack(), model().texels, p.appearance().substrate()).texels;
        float most = 0;
        for (std::size_t i = 0; i < look.size(); ++i) most = std::max(most, std::abs(look[i] - merged[i]));
        // The same films in the same order; glazes multiply in single precision.
        EXPECT_LT(most, blend == ink::Blend::normal ? 1e-6f : 1e-5f);
        const auto after = ink::compose_amounts(p.appearance().stack(), model().texels).texels;
        ASSERT_EQ(after.size(), amounts.size());
        for (std::size_t i = 0; i < amounts.size(); ++i) ASSERT_NEAR(after[i], amounts[i], 1e-5f);
    }
}

TEST(Layers, WhatOneLayerCannotShowIsNotMerged) {
    LayerTable t;
    apply(t, add_on_top(t, "gold"));
    EXPECT_THROW(merged_down(t, 1), Error) << "the lowest";
    EXPECT_THROW(merged_down(t, 7), Error);
    EXPECT_EQ(merged_down(t, 2).other, 1u);
    const auto refused = [&](std::uint32_t id, const std::function<void(Layer&)>& how) {
        LayerTable other = t;
        for (Layer& l : other.layers)
            if (l.id == id) how(l);
        EXPECT_THROW(merged_down(other, 2), Error);
    };
    for (const std::uint32_t id : {1u, 2u}) {
        refused(id, [](Layer& l) { l.visible = false; });
        refused(id, [](Layer& l) { l.locked = true; });
        refused(id, [](Layer& l) { l.opacity = 0.5; });
        refused(id, [](Layer& l) { l.blend = ink::Blend::glaze; });
    }
    for (Layer& l : t.layers) l.blend = ink::Blend::multiply;
    EXPECT_THROW(merged_down(t, 2), Error);
}

// Stored texels serve also when layers were copied and merged after them.
TEST(Layers, CopiesAndMergesAfterTheStoredTexelsNeedNoReplay) {
    Document p(model()), replayed(model());
    p.paint(on(kFirstLayer));
    const std::uint32_t gold = add(p, "gold");
    p.paint(on(gold, 0, "cinnabar"));
    std::vector<LayerCanvas> stored;
    for (const LayerTexels& l : p.layers().canvases()) stored.push_back({l.layer, *l.canvas});
    const std::uint64_t last = p.journal().entries().back().id;
    p.paint(duplicated(p.layers().table(), gold, "copy"));
    p.paint(merged_down(p.layers().table(), gold));
    Document adopted(model());
    ASSERT_TRUE(fits(p.journal().entries(), last));
    adopted.adopt(p.journal().entries(), std::move(stored), last);
    replayed.replay(p.journal().entries());
    EXPECT_EQ(adopted.layers().table(), replayed.layers().table());
    EXPECT_EQ(picture(adopted), picture(replayed));
    EXPECT_EQ(picture(adopted), picture(p));
}

TEST(Layers, FreeNamesAreFree) {
    LayerTable t;
    EXPECT_EQ(free_name(t, "gold"), "gold");
    apply(t, add_on_top(t, "gold"));
    EXPECT_EQ(free_name(t, "gold"), "gold 2");
}

TEST(Layers, EntriesComeBackFromTheirText) {
    for (const std::vector<JournalEntry>& entries : {session(), merging_session()})
        for (const JournalEntry& s : entries) {
            const JournalEntry back = written_and_read(s);
            EXPECT_EQ(kind_of(back), kind_of(s));
            EXPECT_EQ(layer_of(back), layer_of(s));
            const LayerEdit* edit = s.as<LayerEdit>();
            if (!edit) continue;
            const LayerEdit& read = back.get<LayerEdit>();
            EXPECT_EQ(read.what, edit->what);
            EXPECT_EQ(read.other, edit->other);
            if (edit->what != LayerChange::remove && edit->what != LayerChange::merge) {
                EXPECT_EQ(read, *edit);
            }
        }
    const JournalEntry old = entry_of(  // of a program that knew no blends
        {},
        R"({"action":"layer","edit":{"what":"add","id":2,"name":"gold","visible":true,"opacity":1,"locked":false,"place":1}})");
    EXPECT_EQ(old.get<LayerEdit>().layer.blend, ink::Blend::normal);
    EXPECT_EQ(entry_json(on(kFirstLayer)).find("layer"), std::string::npos) << "as without layers";
}

TEST(Layers, NonsenseIsRefused) {
    LayerTable t;
    const LayerTable before = t;
    EXPECT_THROW(apply(t, removed(1)), Error) << "the last";
    EXPECT_THROW(apply(t, removed(2)), Error);
    EXPECT_THROW(apply(t, add_on_top(t, "Layer 1")), Error);
    EXPECT_THROW(apply(t, add_on_top(t, "")), Error);
    EXPECT_THROW(apply(t, add_on_top(t, "\xff\xfe")), Error);
    EXPECT_THROW(apply(t, add_on_top(t, std::string(300, 'a'))), Error);
    EXPECT_THROW(apply(t, {LayerChange::add, {.id = 1, .name = "again"}, 0}), Error);
    EXPECT_THROW(apply(t, {LayerChange::add, {.id = 5, .name = "high"}, 2}), Error);
    EXPECT_THROW(apply(t, {LayerChange::merge, {.id = 1}, 0, 2}), Error) << "the last";
    EXPECT_THROW(apply(t, {LayerChange::duplicate, {.id = 2, .name = "b"}, 1, 7}), Error);
    EXPECT_THROW(apply(t, {LayerChange::change, {.opacity = 1.5}, 0}), Error);
    EXPECT_THROW(apply(t, {LayerChange::change, {.opacity = std::nan("")}, 0}), Error);
    EXPECT_EQ(t, before);
    for (
        const char* text :
        {R"({"action":"layer"})", R"({"action":"layer","edit":{"what":"melt","id":1}})",
         R"({"action":"layer","edit":{"what":"merge","id":1}})",
         R"({"action":"layer","edit":{"what":"merge","id":1,"other":-1}})",
         R"({"action":"layer","edit":{"what":"add","id":2,"name":"a","visible":true,"opacity":1,"locked":false,"place":0,"blend":"screen"}})",
         R"({"action":"layer","edit":{"what":"remove","id":-1}})", R"({"layer":"one"})", R"({"layer":-3})",
         R"({"action":"layer","edit":{"what":"add","id":2,"name":7,"visible":true,"opacity":1,"locked":false,"place":0}})"})
        EXPECT_THROW(entry_of({}, text), Error) << text;
    for (std::size_t i = 1; i < kMaxLayers; ++i) apply(t, add_on_top(t, std::to_string(i)));
    EXPECT_THROW(apply(t, add_on_top(t, "one more")), Error);
}

}  // namespace
}  // namespace tuft::stroke
