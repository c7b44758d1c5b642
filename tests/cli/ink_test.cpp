#include <nlohmann/json.hpp>

#include "paths.h"
#include "program.h"

namespace tuft::test {
namespace {

using nlohmann::json;

class InksOfTheProgram : public Program {};

TEST_F(InksOfTheProgram, AreListedWithTheirColours) {
    const Ran ran = tuft("ink --json");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const json inks = json::parse(ran.out)["inks"];
    EXPECT_GE(inks.size(), 11u);
    for (const json& ink : inks) EXPECT_EQ(ink["colour_on_porcelain"].get<std::string>().size(), 7u) << ink;
    EXPECT_NE(tuft("ink").out.find("Cinnabar red"), std::string::npos);
}

TEST_F(InksOfTheProgram, AreMixedForAColourAndWrittenForPainting) {
    const Ran ran = tuft("ink match '#603010' -o " + path("brown.toml") + " --json");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const json match = json::parse(ran.out);
    EXPECT_LT(match["delta_e_2000"], 1);
    EXPECT_EQ(match["in_words"], "the same to the eye");
    write("s.inkml", stroke_file());
    const Ran painted = tuft("paint " + model("sheet.ply") + " --strokes " + path("s.inkml") + " --ink " +
                             path("brown.toml") + " --atlas-size 256 --json");
    ASSERT_EQ(painted.status, 0) << painted.err;
    // The colour's own name is the same ink.
    const Ran named = tuft("paint " + model("sheet.ply") + " --strokes " + path("s.inkml") +
                           " --ink '#603010' --atlas-size 256 --json --project " + path("p.tuft"));
    ASSERT_EQ(named.status, 0) << named.err;
    EXPECT_EQ(json::parse(named.out)["canvas_hash"], json::parse(painted.out)["canvas_hash"]);
    const Ran again = tuft("replay " + path("p.tuft") + " --json");
    EXPECT_EQ(json::parse(again.out)["canvas_hash"], json::parse(named.out)["canvas_hash"]);
}

TEST_F(InksOfTheProgram, OfAColourFillAndReplay) {
    write("s.inkml", stroke_file());
    ASSERT_EQ(tuft("paint " + model("sheet.ply") + " --strokes " + path("s.inkml") + " --atlas-size 256 --project " +
                   path("p.tuft"))
                  .status,
              0);
    const Ran filled = tuft("fill " + path("p.tuft") + " --ink '#d08040' --layer ground --json");
    ASSERT_EQ(filled.status, 0) << filled.err;
    const Ran replayed = tuft("replay " + path("p.tuft") + " --ink '#3060a0' --json");
    ASSERT_EQ(replayed.status, 0) << replayed.err;
    EXPECT_NE(json::parse(replayed.out)["canvas_hash"], json::parse(filled.out)["canvas_hash"]);
    EXPECT_EQ(tuft("export " + path("p.tuft") + " -o " + path("m.png") + " --recolour 'carbon=#3060a0'").status, 0);
}

TEST_F(InksOfTheProgram, OfAColourOutOfReachSaySoPlainly) {
    const Ran ran = tuft("ink match '#00ff00'");
    EXPECT_EQ(ran.status, 0);
    EXPECT_NE(ran.out.find("these pigments do not reach it"), std::string::npos) << ran.out;
}

TEST_F(InksOfTheProgram, RefuseWhatIsNoColour) {
    for (const std::string arguments :
         {"ink match", "ink match '#12'", "ink match red", "ink match '#ff0000' --film 99",
          "ink match '#ff0000' --film nan", "ink match '#ff0000' --pigments gamboge,gamboge",
          "ink match '#ff0000' -o x.png"}) {
        const Ran ran = tuft(arguments);
        EXPECT_EQ(ran.status, 2) << arguments;
        EXPECT_EQ(ran.error_lines(), 1) << ran.err;
    }
    for (const std::string arguments :
         {"ink match '#ff0000' --substrate nowhere", "ink match '#ff0000' --pigments nothing"}) {
        const Ran ran = tuft(arguments);
        EXPECT_EQ(ran.status, 1) << arguments;
        EXPECT_EQ(ran.error_lines(), 1) << ran.err;
    }
    write("s.inkml", stroke_file());
    const Ran ran =
        tuft("paint " + model("sheet.ply") + " --strokes " + path("s.inkml") + " --ink '#c0302' --atlas-size 256");
    EXPECT_EQ(ran.status, 1);
    EXPECT_NE(ran.err.find("is no colour"), std::string::npos) << ran.err;
}

}  // namespace
}  // namespace tuft::test
