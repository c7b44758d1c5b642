#include <gtest/gtest.h>

#include "core/error.h"
#include "entry_text.h"
#include "stroke/journal/journal.h"

/// Groups of journal entries.
namespace tuft::stroke {
namespace {

TEST(EntryGroups, GoThroughAnEntrysTextAndBack) {
    for (JournalEntry s : {JournalEntry(PaintStroke{}), JournalEntry(BrushAction{}), JournalEntry(Fill{})}) {
        s.group = {7, "飞燕 \"roundel\".svg"};
        EXPECT_EQ(written_and_read(s).group, s.group);
    }
}

TEST(EntryGroups, EntriesWrittenBeforeThereWereGroupsHaveNone) {
    EXPECT_EQ(entry_json(PaintStroke{}).find("group"), std::string::npos);
    EXPECT_EQ(entry_of({}, R"({"spacing":1.0,"layer":2})").group, EntryGroup{});
}

TEST(EntryGroups, NonsenseIsRefused) {
    for (const char* text :
         {R"({"group":1})", R"({"group":0,"group_name":"a"})", R"({"group":-2,"group_name":"a"})",
          R"({"group":1.5,"group_name":"a"})", R"({"group":"one","group_name":"a"})", R"({"group":1,"group_name":7})",
          R"({"group":1,"group_name":""})", R"({"group":9223372036854775807,"group_name":"a"})"})
        EXPECT_THROW(entry_of({}, text), Error) << text;
    EXPECT_THROW(entry_of({}, R"({"group":1,"group_name":")" + std::string(300, 'a') + "\"}"), Error);
}

TEST(EntryGroups, AFilesNameIsReadableWhateverItIs) {
    EXPECT_EQ(group_name("drawings/roundel.svg"), "roundel.svg");
    EXPECT_EQ(group_name("a\xff"
                         "b.svg"),
              "a?b.svg");
    EXPECT_EQ(group_name("two\nlines.svg"), "two?lines.svg");
    std::string characters;
    for (int i = 0; i < 80; ++i) characters += "飞";
    const std::string cut = group_name(characters);  // 240 bytes
    EXPECT_EQ(cut.size(), 198u) << "whole characters of three bytes";
    EXPECT_NO_THROW(check_name(cut, "group"));
}

TEST(EntryGroups, AFreshIdIsOfNoGroupThereIsOrCanBeRedone) {
    Journal j;
    JournalEntry s;
    s.group = {j.next_group_id(), "a"};
    j.append(s);
    s.group = {j.next_group_id() + 1, "b"};  // ahead of the entries, as two files painted at once are
    j.append(s);
    EXPECT_NE(j.next_group_id(), j.entries()[0].group.id);
    EXPECT_NE(j.next_group_id(), j.entries()[1].group.id);
    const std::uint64_t undone = j.entries()[1].group.id;
    j.undo();
    EXPECT_NE(j.next_group_id(), undone);
}

}  // namespace
}  // namespace tuft::stroke
