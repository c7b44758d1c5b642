#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/error.h"
#include "io/strokes/inkml.h"
#include "stroke/journal/entries.h"
#include "stroke/journal/entry/entry_json.h"
#include "stroke/journal/recorded_journal.h"

/// What a stroke file says of the journal beside strokes: brush actions, drying, fills.
namespace tuft::io {
namespace {

TEST(Inkml, WhatIsDoneWithTheBrushStandsOnTheTraceInOrder) {
    const std::string text =
        "<ink><traceGroup><annotation type=\"tuft:ink\">carbon</annotation>"
        "<trace><annotation type=\"tuft:rinse\"/><annotation type=\"tuft:dip\"> cinnabar </annotation>"
        "<annotation type=\"tuft:reshape\"/><annotation type=\"tuft:dry\"/>"
        "<annotation type=\"tuft:dry\"> 2.5 </annotation>0 0, 1 1</trace>"
        "<trace><annotation type=\"tuft:dip\" depth=\"0.2\"/><annotation type=\"tuft:wipe\" amount=\"0.3\"/>0 0, 1 "
        "1</trace><trace>0 0, 1 1</trace></traceGroup></ink>";
    const auto traces = parse_inkml(text, "actions.inkml");
    ASSERT_EQ(traces.size(), 3u);
    ASSERT_EQ(traces[0].before.size(), 5u);
    const auto kind = [&](std::size_t i, std::size_t k) { return stroke::kind_of(traces[i].before[k]); };
    const auto action = [&](std::size_t i, std::size_t k) {
        return std::get<stroke::BrushAction>(traces[i].before[k]);
    };
    EXPECT_EQ(kind(0, 0), stroke::EntryKind::rinse);
    EXPECT_EQ(kind(0, 1), stroke::EntryKind::dip);
    EXPECT_EQ(action(0, 1).ink, "cinnabar");
    EXPECT_EQ(kind(0, 2), stroke::EntryKind::reshape);
    EXPECT_EQ(std::get<stroke::Dry>(traces[0].before[3]).seconds, 0);
    EXPECT_EQ(std::get<stroke::Dry>(traces[0].before[4]).seconds, 2.5);
    EXPECT_EQ(action(0, 1).what, stroke::BrushChange(stroke::Dip{}));
    ASSERT_EQ(traces[1].before.size(), 2u);
    EXPECT_EQ(action(1, 0).ink, "");
    EXPECT_EQ(action(1, 0).what, stroke::BrushChange(stroke::Dip{.depth = 0.2}));
    EXPECT_EQ(kind(1, 1), stroke::EntryKind::wipe);
    EXPECT_EQ(action(1, 1).what, stroke::BrushChange(stroke::Wipe{.amount = 0.3}));
    EXPECT_TRUE(traces[2].before.empty());
    EXPECT_FALSE(traces[0].pressed) << "no P and no F";

    const auto back = parse_inkml(inkml_text(traces), "back.inkml");
    for (std::size_t i = 0; i < traces.size(); ++i) {
        ASSERT_EQ(back[i].before.size(), traces[i].before.size());
        for (std::size_t k = 0; k < traces[i].before.size(); ++k) {
            const stroke::Preparation &was = traces[i].before[k], &now = back[i].before[k];
            ASSERT_EQ(stroke::kind_of(now), stroke::kind_of(was));
            if (const auto* dry = std::get_if<stroke::Dry>(&was)) {
                EXPECT_EQ(std::get<stroke::Dry>(now).seconds, dry->seconds);
            }
            if (const auto* done = std::get_if<stroke::BrushAction>(&was)) {
                EXPECT_EQ(std::get<stroke::BrushAction>(now).ink, done->ink);
                EXPECT_EQ(std::get<stroke::BrushAction>(now).what, done->what);
            }
        }
    }
    for (const char* bad : {"-1", "soon", "1e9", "nan"})
        EXPECT_THROW(parse_inkml(std::string("<ink><trace><annotation type=\"tuft:dry\">") + bad +
                                     "</annotation>0 0, 1 1</trace></ink>",
                                 "bad.inkml"),
                     Error);
    for (const char* bad : {"wipe\" amount=\"1.5", "wipe\" time=\"3", "rinse\" depth=\"0.5", "dip\" time=\"-1"})
        EXPECT_THROW(
            parse_inkml(std::string("<ink><trace><annotation type=\"tuft:") + bad + "\"/>0 0, 1 1</trace></ink>",
                        "number.inkml"),
            Error)
            << bad;
    // For a whole group it would say nothing about when.
    EXPECT_THROW(parse_inkml("<ink><traceGroup><annotation type=\"tuft:dip\"/><trace>0 0</trace></traceGroup></ink>",
                             "group.inkml"),
                 Error);
}

// A stroke file cannot say changes of layers and masks; everything else comes back as the entry it was.
TEST(Inkml, EntriesOfEveryKindThatAFileCanSayComeBack) {
    std::vector<stroke::JournalEntry> entries;
    stroke::PaintStroke s{.trace = {.placed = true, .samples = {{}, {.time = 1, .position = {0.01, 0, 0}}}},
                          .brush = "wolf-small",
                          .ink = "carbon",
                          .seed = 7};
    s.settings.film = stroke::FilmModel::wet;
    s.settings.pressure = stroke::PressureFrom::speed_dwell;
    entries.emplace_back(s, "stroke");
    s.tool = stroke::Tool::eraser;
    entries.emplace_back(s, "eraser");
    for (const stroke::BrushChange& what :
         {stroke::BrushChange(stroke::Dip{.depth = 0.25, .amount = 1.25, .side = -0.5, .time = 1.0 / 3}),
          stroke::BrushChange(stroke::Wipe{.depth = 0.75, .amount = 0.1, .side = 0.5}),
          stroke::BrushChange(stroke::Rinse{}), stroke::BrushChange(stroke::Reshape{})})
        entries.emplace_back(stroke::BrushAction{.what = what, .brush = "goat-small", .ink = "indigo", .seed = 3});
    entries.emplace_back(stroke::Dry{.seconds = 2.5, .down = {0, -1, 0}});
    entries.emplace_back(stroke::WashPalette{});
    entries.emplace_back(stroke::Fill{.ink = "indigo", .layer = stroke::kPaletteLayer, .film = 0.5});
    std::vector<stroke::JournalEntry> back;
    stroke::append_entries(
        back, parse_inkml(inkml_text(stroke::record(entries).strokes), "kinds.inkml", {.actions = true}), {});
    ASSERT_EQ(back.size(), entries.size());
    for (std::size_t i = 0; i < entries.size(); ++i) {
        EXPECT_EQ(stroke::entry_json(back[i]), stroke::entry_json(entries[i])) << i;
        EXPECT_EQ(stroke::brush_of(back[i]), stroke::brush_of(entries[i])) << i;
        EXPECT_EQ(stroke::seed_of(back[i]), stroke::seed_of(entries[i])) << i;
        EXPECT_EQ(stroke::samples_of(back[i]).samples.size(), stroke::samples_of(entries[i]).samples.size()) << i;
    }
    entries.emplace_back(stroke::add_on_top({}, "gold"));
    entries.emplace_back(stroke::MaskEdit{.mask = {.id = 1, .name = "cap"}});
    EXPECT_EQ(stroke::record(entries).left_out, 1u) << "a layer is added again where it is painted on";
}

TEST(Inkml, TracesWithBrushActionsOnlyAreReadOnRequest) {
    const std::string file =
        "<ink><trace><annotation type='tuft:rinse'/></trace><trace></trace><trace>0 0,1 1</trace></ink>";
    EXPECT_EQ(parse_inkml(file, "actions.inkml").size(), 1u);
    const auto all = parse_inkml(file, "actions.inkml", {.actions = true});
    ASSERT_EQ(all.size(), 2u);
    EXPECT_TRUE(all[0].samples.empty());
    ASSERT_EQ(all[0].before.size(), 1u);
    EXPECT_EQ(stroke::kind_of(all[0].before[0]), stroke::EntryKind::rinse);
}

}  // namespace
}  // namespace tuft::io
