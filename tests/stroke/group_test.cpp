#include <gtest/gtest.h>

#include "core/error.h"
#include "stroke/journal/journal.h"

/// Groups of journal entries.
namespace tuft::stroke {
namespace {

TEST(EntryGroups, GoThroughAnEntrysTextAndBack) {
    for (const Action action : {Action::stroke, Action::dip, Action::fill}) {
        Stroke s;
        s.action = action;
        s.group = {7, "飞燕 \"roundel\".svg"};
        Stroke back;
        read_entry_json(entry_json(s), back);
        EXPECT_EQ(back.group, s.group);
    }
}

TEST(EntryGroups, EntriesWrittenBeforeThereWereGroupsHaveNone) {
    Stroke s;
    EXPECT_EQ(entry_json(s).find("group"), std::string::npos);
    s.group = {3, "left from another entry"};
    read_entry_json(R"({"spacing":1.0,"layer":2})", s);
    EXPECT_EQ(s.group, EntryGroup{});
}

TEST(EntryGroups, NonsenseIsRefused) {
    Stroke s;
    for (const char* text :
         {R"({"group":1})", R"({"group":0,"group_name":"a"})", R"({"group":-2,"group_name":"a"})",
          R"({"group":1.5,"group_name":"a"})", R"({"group":"one","group_name":"a"})", R"({"group":1,"group_name":7})",
          R"({"group":1,"group_name":""})", R"({"group":9223372036854775807,"group_name":"a"})"})
        EXPECT_THROW(read_entry_json(text, s), Error) << text;
    EXPECT_THROW(read_entry_json(R"({"group":1,"group_name":")" + std::string(300, 'a') + "\"}", s), Error);
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
    Stroke s;
    s.group = {j.next_group_id(), "a"};
    j.append(s);
    s.group = {j.next_group_id() + 1, "b"};  // ahead of the entries, as two files painted at once are
    j.append(s);
    EXPECT_NE(j.next_group_id(), j.strokes()[0].group.id);
    EXPECT_NE(j.next_group_id(), j.strokes()[1].group.id);
    const std::uint64_t undone = j.strokes()[1].group.id;
    j.undo();
    EXPECT_NE(j.next_group_id(), undone);
}

}  // namespace
}  // namespace tuft::stroke
