#include "core/text/text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/bounds.h"
#include "core/text/nesting.h"

namespace tuft {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

TEST(Text, NamesOfOlderProgramsBecomeUtf8AndOthersStay) {
    EXPECT_EQ(to_utf8("T\xfcr"), "T\xc3\xbcr");
    EXPECT_EQ(to_utf8("T\xc3\xbcr"), "T\xc3\xbcr");
    EXPECT_EQ(to_utf8("七上"), "七上");
    for (int byte = 0; byte < 256; ++byte)
        EXPECT_TRUE(is_utf8(to_utf8(std::string(1, static_cast<char>(byte))))) << byte;
}

TEST(Text, OnlyWellFormedSequencesAreUtf8) {
    EXPECT_TRUE(is_utf8("a\xf4\x8f\xbf\xbf"));  // U+10FFFF
    for (const char* bad : {"\xc0\x80", "\xe0\x9f\xbf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\x80", "\xe4\xb8", "\xff"})
        EXPECT_FALSE(is_utf8(bad)) << testing::PrintToString(bad);
}

TEST(Text, AnExcerptIsShortReadableAndCutsNoCharacter) {
    EXPECT_EQ(excerpt("door\nleft\x01"), "door?left?");
    EXPECT_EQ(excerpt(std::string(60, 'x')), std::string(60, 'x'));
    EXPECT_EQ(excerpt(std::string(1'000'000, 'x')), std::string(60, 'x') + "...");
    for (std::size_t most = 1; most < 12; ++most) {
        const std::string shown = excerpt("七上八下", most);
        EXPECT_TRUE(is_utf8(shown)) << most;
        EXPECT_EQ(shown.size(), most / 3 * 3 + (most < 12 ? 3 : 0)) << most;
    }
    EXPECT_EQ(excerpt("\xfc\xfc\xfc", 4), "\xc3\xbc\xc3\xbc...");
}

TEST(Nesting, TomlMayHaveAsManyLevelsAsItsBoundAndNoMore) {
    const auto repeated = [](const char* text, int n) {
        std::string out;
        for (int i = 0; i < n; ++i) out += text;
        return out;
    };
    const auto message = [](const std::string& text) -> std::string {
        try {
            check_toml_nesting(text, "a.toml");
            return {};
        } catch (const Error& e) {
            return e.what();
        }
    };
    const int most = kDeepestToml;
    for (const std::string& key : {repeated("a.", most - 1) + "a = 1", "[" + repeated("a.", most - 1) + "a]\nx = 1",
                                   "x = " + repeated("[", most) + repeated("]", most)})
        EXPECT_EQ(message(key), "") << key;
    for (const std::string& key :
         {repeated("a.", most) + "a = 1", "[" + repeated("a.", most) + "a]", repeated("' '.", most) + "a = 1",
          "x = " + repeated("[", most + 1), "x = " + repeated("{a = ", most + 1), repeated("a . ", 100'000)})
        EXPECT_THAT(message("# one\n" + key), HasSubstr("a.toml:2: ")) << key.substr(0, 80);
    // What stands in strings and comments nests nothing; long tables and lists neither.
    EXPECT_EQ(message("x = \"" + repeated("[.\\\"", 99) + "\"\ny = '" + repeated("[.", 99) + "' # " +
                      repeated("[.", 99) + "\nz = \"\"\"" + repeated("[.\n", 99) + "\\\"\"\"\"\"\nu = '''" +
                      repeated("{.\n\"", 99) + "'''''\nv = 1"),
              "");
    EXPECT_EQ(message("x = [" + repeated("1.5, ", 10'000) + "]\n" + repeated("[[a.b]]\nc = 1.5\n", 1000)), "");
    // Behind strings that end it is looked at again.
    EXPECT_THAT(message("x = \"\"\"\"\"\"\ny = " + repeated("[", most + 1)), HasSubstr("a.toml:2: "));
    EXPECT_THAT(message("x = \"a\\\\\"\ny = " + repeated("[", most + 1)), HasSubstr("a.toml:2: "));
}

TEST(Nesting, JsonMayHaveAHundredLevels) {
    const std::string open(kDeepestJson, '[');
    EXPECT_NO_THROW(check_json_nesting(open + std::string(kDeepestJson, ']') + "[\"[[[[\\\"[[\"]", "a"));
    EXPECT_THROW(check_json_nesting(open + "{", "a"), Error);
    EXPECT_THROW(check_json_nesting(std::string(100'000, '['), "a"), Error);
}

TEST(Bounds, NothingThatIsNoNumberLiesWithin) {
    EXPECT_TRUE(within(Vec3(kFarthest, -kFarthest, 0)));
    for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1.001 * kFarthest, -1e300})
        for (int k = 0; k < 3; ++k) {
            Vec3 p(0);
            p[k] = bad;
            EXPECT_FALSE(within(p)) << bad;
        }
}

}  // namespace
}  // namespace tuft
