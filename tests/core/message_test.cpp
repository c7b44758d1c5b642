#include "core/message.h"

#include <gtest/gtest.h>

#include <map>
#include <new>
#include <vector>

#include "core/error.h"

namespace tuft {
namespace {

/// A language with these words.
std::string said(const Message& message, const std::map<std::string, std::string>& words) {
    return message.text([&](const char* english) -> const char* {
        const auto at = words.find(english);
        return at == words.end() ? nullptr : at->second.c_str();
    });
}

TEST(Message, PutsItsArgumentsInEnglish) {
    EXPECT_EQ(Message("{} of {} are '{}'", 3, std::size_t{40}, std::string("a")).text(), "3 of 40 are 'a'");
    EXPECT_EQ(Message("half: {}", 0.5).text(), "half: " + std::to_string(0.5));
    EXPECT_EQ(Message("command '{}'", 'q').text(), "command 'q'");
    EXPECT_EQ(Message().text(), "");
    EXPECT_TRUE(Message().empty());
    EXPECT_FALSE(Message("a").empty());
}

TEST(Message, ATranslationMayHaveItsArgumentsInAnotherOrder) {
    EXPECT_EQ(said(Message("{} of {}", 3, 40), {{"{} of {}", "aus {1} sind {0}"}}), "aus 40 sind 3");
}

TEST(Message, WhatHasNoTranslationStaysEnglish) {
    EXPECT_EQ(said(Message("{} of {}", 3, 40), {{"of", "von"}}), "3 of 40");
}

TEST(Message, ArgumentsAreTranslatedTooButNamesAreNot) {
    const std::map<std::string, std::string> words{{"{}: {}", "{}\u2014{}"}, {"no file", "keine Datei"}};
    EXPECT_EQ(said(Message("{}: {}", std::string("no file"), Message("no file")), words), "no file\u2014keine Datei");
    EXPECT_EQ(said(Message("{}: {}", std::string("no file"), "no file"), words), "no file\u2014keine Datei")
        << "a literal has a translation";
}

// A file may be called anything.
TEST(Message, ATextFromElsewhereIsNoFormat) {
    for (const std::string name : {"{}", "{0}", "{", "}", "%s"}) {
        EXPECT_EQ(Message(name).text(), name);
        EXPECT_EQ(Message("file {}", name).text(), "file " + name);
    }
}

TEST(Message, JoinsWithSemicolons) {
    const std::vector<Message> three{"a", "b", Message("{} c", 1)};
    EXPECT_EQ(join(three).text(), "a; b; 1 c");
    EXPECT_EQ(join({}).text(), "");
    EXPECT_EQ(texts(three), (std::vector<std::string>{"a", "b", "1 c"}));
}

TEST(Error, SaysFileAndLineBeforeItsMessage) {
    const Error error("a.obj", 7, Message("face {} is cut off", 3));
    EXPECT_STREQ(error.what(), "a.obj:7: face 3 is cut off");
    EXPECT_EQ(said(error.message(), {{"{}:{}: {}", "{1} in {0}: {2}"}, {"face {} is cut off", "Fläche {}"}}),
              "7 in a.obj: Fläche 3");
    EXPECT_STREQ(Error("a.obj", "no such file").what(), "a.obj: no such file");
}

TEST(Error, OfAnyKindHasAMessage) {
    EXPECT_EQ(message_of(Error("x")), Message("x"));
    EXPECT_EQ(message_of(std::runtime_error("disk")), Message(std::string("disk")));
    EXPECT_NE(message_of(std::bad_alloc()).text().find("memory"), std::string::npos);
}

}  // namespace
}  // namespace tuft
