#include <filesystem>
#include <nlohmann/json.hpp>

#include "program.h"

/// `tuft write` as a program.
namespace tuft::test {
namespace {

using nlohmann::json;

class Write : public Program {
  protected:
    Ran written(const std::string& options) const {
        return tuft("write " + model("sheet.ply") + " --place 0,0,0 --atlas-size 512 --json --quiet " + options,
                    "export XDG_CACHE_HOME='" + path("cache") + "';");
    }
};

TEST_F(Write, TheStrokesOfATextAreOneGroupAndReplayToTheBit) {
    const Ran ran = written("--text '一人' --size 40 --project " + path("a.tuft"));
    ASSERT_EQ(ran.status, 0) << ran.err;
    const json j = json::parse(ran.out);
    ASSERT_EQ(j.at("strokes").size(), 3u);
    const Ran inspected = tuft("inspect " + path("a.tuft") + " --json");
    ASSERT_EQ(inspected.status, 0) << inspected.err;
    EXPECT_NE(inspected.out.find("一人"), std::string::npos);  // the group's name
    EXPECT_NE(inspected.out.find("人 2"), std::string::npos);  // a stroke's label
    const Ran replayed = tuft("replay " + path("a.tuft") + " --json --quiet --project " + path("b.tuft"));
    ASSERT_EQ(replayed.status, 0) << replayed.err;
    EXPECT_EQ(json::parse(replayed.out).at("canvas_hash"), j.at("canvas_hash"));
}

TEST_F(Write, ACharacterIsCopiedFromAPicture) {
    ASSERT_EQ(written("--text 十 --size 150 --project " + path("a.tuft")).status, 0);
    ASSERT_EQ(tuft("export " + path("a.tuft") + " -o " + path("a.png") + " --map base-colour --quiet").status, 0);
    const std::string like = "--like " + path("a.png") + " --size 100 ";
    const Ran ran = written(like + "--text 十 --numbered " + path("n.svg") + " --project " + path("b.tuft"));
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(json::parse(ran.out).at("strokes").size(), 2u);
    EXPECT_TRUE(std::filesystem::exists(path("n.svg")));
    const Ran one = written(like + "--order -1");
    ASSERT_EQ(one.status, 0) << one.err;
    EXPECT_EQ(json::parse(one.out).at("strokes").size(), 1u);
    for (const std::string& options : {like + "--order 99", like + "--text 永永", "--like " + path("none.png")}) {
        const Ran wrong = written(options);
        EXPECT_GT(wrong.status, 0) << options;
        EXPECT_EQ(wrong.error_lines(), 1) << wrong.err;
    }
}

TEST_F(Write, AFitThatChangesNothingIsSaid) {
    const std::string write =
        "write " + model("sheet.ply") + " --text 一 --size 20 --place 0,0,0 --atlas-size 256 --fit ";
    for (const auto& [style, reason] : {std::pair("kaishu", "no outlines"), {"line", "a pen"}}) {
        const Ran ran = tuft(write + "--style " + style, "export XDG_CACHE_HOME='" + path("cache") + "';");
        EXPECT_EQ(ran.status, 0);
        EXPECT_NE((ran.err + ran.out).find("--fit changes nothing"), std::string::npos) << ran.err;
        EXPECT_NE((ran.err + ran.out).find(reason), std::string::npos) << ran.err;
    }
}

TEST_F(Write, MissingCharactersAndWrongOptionsAreOneLine) {
    const Ran missing = written("--text '永鑫'");
    EXPECT_EQ(missing.status, 1);
    EXPECT_EQ(missing.error_lines(), 1) << missing.err;
    EXPECT_NE(missing.err.find("鑫"), std::string::npos) << missing.err;
    for (const char* options :
         {"--text 永 --style kaisu", "--text 永 --glyphs nowhere", "--text 永 --direction curve"}) {
        const Ran ran = written(options);
        EXPECT_GT(ran.status, 0) << options;
        EXPECT_EQ(ran.error_lines(), 1) << ran.err;
    }
    EXPECT_EQ(written("--text ' '").status, 2);
    EXPECT_EQ(written("--text 永 --size big").status, 2);
    const Ran large = written("--text 永 --size 5000");
    EXPECT_EQ(large.status, 2);
    EXPECT_EQ(large.error_lines(), 1) << large.err;
    EXPECT_NE(large.err.find("5000 mm"), std::string::npos) << large.err;
}

}  // namespace
}  // namespace tuft::test
