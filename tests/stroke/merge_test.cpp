#include "stroke/journal/merge.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "stroke/journal/tables.h"

/// Entries are told apart by their labels.
namespace tuft::stroke {
namespace {

JournalEntry with_id(std::uint64_t id, JournalEntry entry) {
    entry.id = id;
    return entry;
}

JournalEntry painted(std::uint64_t id, const std::string& label, std::uint32_t layer = kFirstLayer,
                     std::uint32_t mask = 0) {
    const PaintStroke s{.trace = {.flat = false, .samples = {{.position = {1, 2, 3}}}},
                        .brush = "wolf-small",
                        .ink = "carbon",
                        .layer = layer,
                        .mask = mask};
    return with_id(id, {s, label});
}

JournalEntry added(std::uint64_t id, std::uint32_t layer, const std::string& name) {
    return with_id(id, LayerEdit{LayerChange::add, Layer{.id = layer, .name = name}, 1});
}

JournalEntry masked(std::uint64_t id, std::uint32_t mask, const std::string& name, std::vector<std::uint32_t> of = {}) {
    return with_id(
        id, MaskEdit{
                .mask = {.id = mask, .name = name, .kind = of.empty() ? MaskKind::angle : MaskKind::invert, .of = of}});
}

std::string labels(const MergedJournal& m) {
    std::string out;
    for (const JournalEntry& s : m.entries)
        out += (out.empty() ? "" : " ") + (s.as<PaintStroke>() ? s.label + (s.hidden ? "-" : "") : name_of(kind_of(s)));
    return out;
}

std::set<std::uint64_t> ids(const MergedJournal& m) {
    std::set<std::uint64_t> out;
    for (const JournalEntry& s : m.entries) out.insert(s.id);
    return out;
}

const std::vector<JournalEntry> kBase{painted(1, "a"), painted(2, "b")};

std::vector<JournalEntry> with(std::vector<JournalEntry> entries, std::vector<JournalEntry> more) {
    entries.insert(entries.end(), more.begin(), more.end());
    return entries;
}

TEST(Merge, WhatBothSidesPaintedStaysTheirsFirst) {
    const MergedJournal m = merge_journals(marks_of(kBase), with(kBase, {painted(3, "mine"), painted(4, "mine too")}),
                                           with(kBase, {painted(3, "theirs")}));
    EXPECT_EQ(labels(m), "a b theirs mine mine too");
    EXPECT_EQ(ids(m).size(), 5u) << "each has an id of its own";
    EXPECT_EQ(m.from_theirs, 3u);
    EXPECT_FALSE(m.altered);
    EXPECT_EQ(m.news, 1u);
}

TEST(Merge, WithoutAChangeOnOneSideTheOtherOneIsTaken) {
    const auto more = with(kBase, {painted(3, "c")});
    EXPECT_EQ(labels(merge_journals(marks_of(kBase), kBase, more)), "a b c");
    EXPECT_EQ(labels(merge_journals(marks_of(kBase), more, kBase)), "a b c");
    // Written without the writer's knowing: it is not there twice.
    EXPECT_EQ(labels(merge_journals(marks_of(kBase), more, more)), "a b c");
    EXPECT_EQ(labels(merge_journals({}, kBase, {})), "a b");
}

TEST(Merge, WhatOneSideTookOutOrChangedIsSoAndNothingChangedIsLost) {
    const std::vector<JournalEntry> without_a{kBase[1]};
    std::vector<JournalEntry> hidden_a = kBase, other_ink = kBase;
    hidden_a[0].hidden = true;
    other_ink[0].label = "A";
    const auto marks = marks_of(kBase);
    EXPECT_EQ(labels(merge_journals(marks, without_a, kBase)), "b");
    EXPECT_EQ(labels(merge_journals(marks, kBase, without_a)), "b");
    EXPECT_EQ(labels(merge_journals(marks, hidden_a, kBase)), "a- b");
    EXPECT_EQ(labels(merge_journals(marks, kBase, hidden_a)), "a- b");
    EXPECT_TRUE(merge_journals(marks, hidden_a, kBase).altered);
    EXPECT_EQ(labels(merge_journals(marks, without_a, other_ink)), "A b") << "changed there, taken out here";
    EXPECT_EQ(labels(merge_journals(marks, other_ink, without_a)), "b A") << "changed here, taken out there";
    EXPECT_EQ(labels(merge_journals(marks, hidden_a, other_ink)), "a- b") << "of two changes mine stays";
}

// Both sides added a layer and painted on it: the ids are the same, the layers are not.
TEST(Merge, LayersOfBothSidesAreTwoLayers) {
    const MergedJournal m =
        merge_journals(marks_of(kBase), with(kBase, {added(3, 2, "gold"), painted(4, "mine", 2)}),
                       with(kBase, {added(3, 2, "gold"), painted(4, "theirs", 2), added(5, 3, "red")}));
    const MergedJournal n = merge_journals(marks_of(kBase), with(kBase, {added(3, 2, "ground"), painted(4, "mine", 2)}),
                                           with(kBase, {added(3, 2, "gold"), painted(4, "theirs", 2)}));
    EXPECT_EQ(labels(n), "a b layer theirs layer mine");
    const LayerTable table = layers_after(n.entries);
    ASSERT_EQ(table.layers.size(), 3u);
    EXPECT_EQ(table.find(layer_of(n.entries[3]))->name, "gold");
    EXPECT_EQ(table.find(layer_of(n.entries[5]))->name, "ground");
    // The very same edit with the very same id is one edit.
    EXPECT_EQ(labels(m), "a b layer theirs layer mine");
    EXPECT_EQ(layers_after(m.entries).find(layer_of(m.entries[5]))->name, "gold");
}

TEST(Merge, ALayerOrMaskThatIsGoneIsAddedAgainForWhatNeedsIt) {
    const std::vector<JournalEntry> base =
        with(kBase, {added(3, 2, "gold"), masked(4, 1, "rim"), masked(5, 2, "rest", {1})});
    std::vector<JournalEntry> theirs = base;
    const JournalEntry gone = with_id(6, removed(2));
    JournalEntry no_rest = masked(7, 2, ""), no_rim = masked(8, 1, "");
    no_rest.get<MaskEdit>().remove = no_rim.get<MaskEdit>().remove = true;
    theirs = with(theirs, {gone, no_rest, no_rim});
    const MergedJournal m = merge_journals(marks_of(base), with(base, {painted(6, "mine", 2, 2)}), theirs);
    EXPECT_EQ(labels(m), "a b layer mask mask layer mask mask layer mask mask mine");
    const PaintStroke& mine = m.entries.back().get<PaintStroke>();
    EXPECT_EQ(layers_after(m.entries).find(mine.layer)->name, "gold");
    const MaskTable masks = masks_after(m.entries);
    ASSERT_TRUE(masks.find(mine.mask));
    EXPECT_EQ(masks.find(mine.mask)->name, "rest");
    EXPECT_EQ(masks.find(masks.find(mine.mask)->of.at(0))->name, "rim");
}

// Taking a layer's entry out would leave what they painted on it without one.
TEST(Merge, NothingIsTakenOutThatTheOtherSideStandsOn) {
    const std::vector<JournalEntry> base = with(kBase, {added(3, 2, "gold")});
    const MergedJournal m =
        merge_journals(marks_of(base), with(kBase, {painted(4, "mine")}), with(base, {painted(4, "theirs", 2)}));
    EXPECT_EQ(labels(m), "a b layer theirs mine");
    EXPECT_FALSE(m.altered);
}

// A copy of a layer of mine that has another id now, merged down into it.
TEST(Merge, CopiedAndMergedLayersFollowTheirNewIds) {
    JournalEntry copy = added(5, 3, "gold copy"), down = added(6, 3, "");
    copy.get<LayerEdit>().what = LayerChange::duplicate;
    copy.get<LayerEdit>().other = 2;
    down.get<LayerEdit>().what = LayerChange::merge;
    down.get<LayerEdit>().other = 2;
    const MergedJournal m = merge_journals(
        marks_of(kBase), with(kBase, {added(3, 2, "gold"), painted(4, "mine", 2), copy, down, painted(7, "after", 2)}),
        with(kBase, {added(3, 2, "red")}));
    EXPECT_EQ(labels(m), "a b layer layer mine layer layer after");
    const LayerEdit& copied = m.entries[5].get<LayerEdit>();
    EXPECT_EQ(copied.other, layer_of(m.entries[4]));
    EXPECT_EQ(m.entries[6].get<LayerEdit>().layer.id, copied.layer.id);
    EXPECT_EQ(m.entries[6].get<LayerEdit>().other, layer_of(m.entries[4]));
    EXPECT_EQ(layers_after(m.entries).find(layer_of(m.entries[7]))->name, "gold");
}

}  // namespace
}  // namespace tuft::stroke
