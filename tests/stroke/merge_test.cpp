#include "stroke/painting/merge.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "stroke/painting/painting.h"

/// Entries are told apart by their labels.
namespace tuft::stroke {
namespace {

Stroke painted(std::uint64_t id, const std::string& label, std::uint32_t layer = kFirstLayer, std::uint32_t mask = 0) {
    Stroke s;
    s.id = id;
    s.layer = layer;
    s.mask = mask;
    s.trace.flat = false;
    s.trace.label = label;
    s.trace.brush = "wolf-small";
    s.trace.ink = "carbon";
    s.trace.samples = {{.position = {1, 2, 3}}};
    return s;
}

Stroke added(std::uint64_t id, std::uint32_t layer, const std::string& name) {
    Stroke s;
    s.id = id;
    s.trace.flat = false;
    s.action = Action::layer;
    s.edit = {LayerChange::add, Layer{.id = layer, .name = name}, 1};
    return s;
}

Stroke masked(std::uint64_t id, std::uint32_t mask, const std::string& name, std::vector<std::uint32_t> of = {}) {
    Stroke s;
    s.id = id;
    s.trace.flat = false;
    s.action = Action::mask;
    s.mask_edit.mask = {.id = mask, .name = name, .kind = of.empty() ? MaskKind::angle : MaskKind::invert, .of = of};
    return s;
}

std::string labels(const MergedJournal& m) {
    std::string out;
    for (const Stroke& s : m.entries)
        out += (out.empty() ? "" : " ") +
               (s.action == Action::stroke ? s.trace.label + (s.hidden ? "-" : "") : name_of(s.action));
    return out;
}

std::set<std::uint64_t> ids(const MergedJournal& m) {
    std::set<std::uint64_t> out;
    for (const Stroke& s : m.entries) out.insert(s.id);
    return out;
}

const std::vector<Stroke> kBase{painted(1, "a"), painted(2, "b")};

std::vector<Stroke> with(std::vector<Stroke> entries, std::vector<Stroke> more) {
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
    const std::vector<Stroke> without_a{kBase[1]};
    std::vector<Stroke> hidden_a = kBase, other_ink = kBase;
    hidden_a[0].hidden = true;
    other_ink[0].trace.label = "A";
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
    EXPECT_EQ(table.find(n.entries[3].layer)->name, "gold");
    EXPECT_EQ(table.find(n.entries[5].layer)->name, "ground");
    // The very same edit with the very same id is one edit.
    EXPECT_EQ(labels(m), "a b layer theirs layer mine");
    EXPECT_EQ(layers_after(m.entries).find(m.entries[5].layer)->name, "gold");
}

TEST(Merge, ALayerOrMaskThatIsGoneIsAddedAgainForWhatNeedsIt) {
    const std::vector<Stroke> base = with(kBase, {added(3, 2, "gold"), masked(4, 1, "rim"), masked(5, 2, "rest", {1})});
    std::vector<Stroke> theirs = base;
    Stroke gone = added(6, 2, "");
    gone.edit = removed(2);
    Stroke no_rest = masked(7, 2, ""), no_rim = masked(8, 1, "");
    no_rest.mask_edit.remove = no_rim.mask_edit.remove = true;
    theirs = with(theirs, {gone, no_rest, no_rim});
    const MergedJournal m = merge_journals(marks_of(base), with(base, {painted(6, "mine", 2, 2)}), theirs);
    EXPECT_EQ(labels(m), "a b layer mask mask layer mask mask layer mask mask mine");
    const Stroke& mine = m.entries.back();
    EXPECT_EQ(layers_after(m.entries).find(mine.layer)->name, "gold");
    const MaskTable masks = masks_after(m.entries);
    ASSERT_TRUE(masks.find(mine.mask));
    EXPECT_EQ(masks.find(mine.mask)->name, "rest");
    EXPECT_EQ(masks.find(masks.find(mine.mask)->of.at(0))->name, "rim");
}

// Taking a layer's entry out would leave what they painted on it without one.
TEST(Merge, NothingIsTakenOutThatTheOtherSideStandsOn) {
    const std::vector<Stroke> base = with(kBase, {added(3, 2, "gold")});
    const MergedJournal m =
        merge_journals(marks_of(base), with(kBase, {painted(4, "mine")}), with(base, {painted(4, "theirs", 2)}));
    EXPECT_EQ(labels(m), "a b layer theirs mine");
    EXPECT_FALSE(m.altered);
}

// A copy of a layer of mine that has another id now, merged down into it.
TEST(Merge, CopiedAndMergedLayersFollowTheirNewIds) {
    Stroke copy = added(5, 3, "gold copy"), down = added(6, 3, "");
    copy.edit.what = LayerChange::duplicate;
    copy.edit.other = 2;
    down.edit.what = LayerChange::merge;
    down.edit.other = 2;
    const MergedJournal m = merge_journals(
        marks_of(kBase), with(kBase, {added(3, 2, "gold"), painted(4, "mine", 2), copy, down, painted(7, "after", 2)}),
        with(kBase, {added(3, 2, "red")}));
    EXPECT_EQ(labels(m), "a b layer layer mine layer layer after");
    const Stroke& copied = m.entries[5];
    EXPECT_EQ(copied.edit.other, m.entries[4].layer);
    EXPECT_EQ(m.entries[6].edit.layer.id, copied.edit.layer.id);
    EXPECT_EQ(m.entries[6].edit.other, m.entries[4].layer);
    EXPECT_EQ(layers_after(m.entries).find(m.entries[7].layer)->name, "gold");
}

}  // namespace
}  // namespace tuft::stroke
