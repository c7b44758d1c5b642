#include <nlohmann/json.hpp>

#include "paths.h"
#include "program.h"

namespace tuft::test {
namespace {

using nlohmann::json;

class LayersOfAProject : public Program {
  protected:
    void paint(const std::string& more) {
        write("s.inkml", stroke_file());
        write("t.inkml", stroke_file("0 6 0"));
        const Ran ran = tuft("paint " + model("sheet.ply") + " --strokes " + path("s.inkml") +
                             " --atlas-size 256 --project " + path("p.tuft") + " --json " + more);
        ASSERT_EQ(ran.status, 0) << ran.err;
        painted_ = json::parse(ran.out);
    }
    json layers() { return json::parse(tuft("inspect " + path("p.tuft") + " --json").out)["layers"]; }
    std::string replayed() { return json::parse(tuft("replay " + path("p.tuft") + " --json").out)["canvas_hash"]; }
    std::string map(const std::string& more = "") {
        EXPECT_EQ(tuft("export " + path("p.tuft") + " -o " + path("m.png") + " " + more).status, 0);
        return read(path("m.png"));
    }
    json painted_;
};

TEST_F(LayersOfAProject, AreMadeByPaintingAndChangedByName) {
    paint("");
    EXPECT_EQ(layers().size(), 1u);
    const std::string below = map();
    const Ran gold =
        tuft("paint " + path("p.tuft") + " --strokes " + path("t.inkml") + " --layer gold --ink cinnabar --json");
    ASSERT_EQ(gold.status, 0) << gold.err;
    EXPECT_EQ(json::parse(gold.out)["strokes"].size(), 1u) << "what was painted now";
    ASSERT_EQ(layers().size(), 2u);
    EXPECT_EQ(layers()[1]["name"], "gold");
    EXPECT_EQ(replayed(), json::parse(gold.out)["canvas_hash"]);
    const std::string both = map();
    EXPECT_NE(both, below);
    const auto change = [&](const std::string& what) {
        const Ran ran = tuft("layer " + path("p.tuft") + " " + what);
        EXPECT_EQ(ran.status, 0) << ran.err;
    };
    change("hide gold");
    EXPECT_EQ(map(), below);
    EXPECT_EQ(map("--layers 'Layer 1',gold"), both);
    change("show gold");
    change("opacity gold 0.5");
    EXPECT_NE(map(), both);
    EXPECT_EQ(layers()[1]["opacity"], 0.5);
    change("move gold 1");
    EXPECT_EQ(layers()[0]["name"], "gold");
    change("rename gold leaf");
    change("lock leaf");
    const Ran refused = tuft("paint " + path("p.tuft") + " --strokes " + path("t.inkml") + " --layer leaf");
    EXPECT_EQ(refused.status, 1);
    EXPECT_EQ(refused.error_lines(), 1) << refused.err;
    EXPECT_NE(refused.err.find("'leaf' is locked"), std::string::npos) << refused.err;
    change("unlock leaf");
    change("remove leaf");
    EXPECT_EQ(map(), below);
    EXPECT_EQ(layers().size(), 1u);
}

TEST_F(LayersOfAProject, AreCopiedBlendedAndMerged) {
    paint("");
    ASSERT_EQ(tuft("paint " + path("p.tuft") + " --strokes " + path("t.inkml") + " --layer gold --ink cinnabar").status,
              0);
    const std::string below = map("--layers 'Layer 1'"), both = map();
    const auto change = [&](const std::string& what) {
        const Ran ran = tuft("layer " + path("p.tuft") + " " + what + " --json");
        EXPECT_EQ(ran.status, 0) << ran.err;
        return json::parse(ran.out)["layers"];
    };
    EXPECT_EQ(change("duplicate gold")[2]["name"], "gold copy");
    EXPECT_EQ(change("duplicate gold leaf")[2]["name"], "leaf");
    EXPECT_EQ(map("--layers leaf"), map("--layers gold"));
    EXPECT_EQ(change("blend leaf multiply")[2]["blend"], "multiply");
    EXPECT_NE(map("--layers leaf"), map("--layers gold")) << "over porcelain, which is not white";
    const Ran refused = tuft("layer " + path("p.tuft") + " merge leaf");
    EXPECT_EQ(refused.status, 1);
    EXPECT_EQ(refused.error_lines(), 1) << refused.err;
    change("remove leaf");
    change("remove 'gold copy'");
    const json merged = change("merge gold");
    ASSERT_EQ(merged.size(), 1u);
    EXPECT_EQ(map(), both);
    EXPECT_NE(map(), below);
    const std::string hash = replayed();
    EXPECT_EQ(hash, json::parse(tuft("replay " + path("p.tuft") + " --threads 3 --json").out)["canvas_hash"]);
    EXPECT_EQ(tuft("layer " + path("p.tuft") + " merge 'Layer 1'").status, 1);
    EXPECT_EQ(tuft("layer " + path("p.tuft") + " blend 'Layer 1' screen").status, 2);
}

TEST_F(LayersOfAProject, AreNamedInTheStrokeFile) {
    std::string ink = stroke_file();
    ink.insert(ink.find("<annotation type=\"tuft:brush\""),
               "<annotation type=\"tuft:layer\">gold &amp; 金</annotation>");
    write("g.inkml", ink);
    const Ran ran = tuft("paint " + model("sheet.ply") + " --strokes " + path("g.inkml") +
                         " --atlas-size 256 --project " + path("p.tuft"));
    ASSERT_EQ(ran.status, 0) << ran.err;
    ASSERT_EQ(layers().size(), 2u);
    EXPECT_EQ(layers()[1]["name"], "gold & 金");
}

TEST_F(LayersOfAProject, WhatCannotBeIsOneLine) {
    paint("");
    const auto refused = [&](const std::string& arguments, int status) {
        const Ran ran = tuft(arguments);
        EXPECT_EQ(ran.status, status) << arguments << ran.err;
        EXPECT_EQ(ran.error_lines(), 1) << ran.err;
    };
    refused("layer " + path("p.tuft") + " hide gold", 1);
    refused("layer " + path("p.tuft") + " remove 'Layer 1'", 1);
    refused("layer " + path("p.tuft") + " opacity 'Layer 1' 2", 1);
    refused("layer " + path("p.tuft") + " opacity 'Layer 1' much", 2);
    refused("layer " + path("p.tuft") + " move 'Layer 1' 5", 2);
    refused("layer " + path("p.tuft") + " melt 'Layer 1'", 2);
    refused("layer " + path("none.tuft") + " hide gold", 1);
    refused("export " + path("p.tuft") + " -o " + path("m.png") + " --layers gold", 2);
    EXPECT_EQ(layers().size(), 1u);
}

TEST_F(LayersOfAProject, AreFilledAndErased) {
    paint("");
    const Ran filled =
        tuft("fill " + path("p.tuft") +
             " --ink cinnabar --film 2 --to-ink indigo --from -20,0,0 --to 20,0,0 --layer ground --json");
    ASSERT_EQ(filled.status, 0) << filled.err;
    EXPECT_EQ(replayed(), json::parse(filled.out)["canvas_hash"]);
    EXPECT_GT(json::parse(filled.out)["pigment_mm3"], 0);
    const Ran erased =
        tuft("paint " + path("p.tuft") + " --strokes " + path("t.inkml") + " --layer ground --erase --json");
    ASSERT_EQ(erased.status, 0) << erased.err;
    const json stroke = json::parse(erased.out)["strokes"][0];
    EXPECT_GT(stroke["removed_mm3"], 0);
    EXPECT_EQ(stroke["ink_mm3"], 0);
    EXPECT_EQ(replayed(), json::parse(erased.out)["canvas_hash"]);
    for (const char* wrong : {"--film -1", "--film much", "--to-ink indigo", "--from 0,0,0", "--from 0,0,0 --to 0,0",
                              "--round", "--part 0,0,0 --chart 0,0,0"}) {
        const Ran ran = tuft("fill " + path("p.tuft") + " " + wrong);
        EXPECT_EQ(ran.status, 2) << wrong;
        EXPECT_EQ(ran.error_lines(), 1) << ran.err;
    }
    EXPECT_EQ(tuft("fill " + path("p.tuft") + " --from 1,1,1 --to 1,1,1").status, 1);
    EXPECT_EQ(tuft("fill " + path("p.tuft") + " --ink nothing").status, 1);
}

// Every change is in the file when the command ends, however it ends: a kill of the painting
// after it loses nothing of it.
TEST_F(LayersOfAProject, EveryFinishedChangeSurvivesAKill) {
    paint("");
    const std::string script = "export TUFT_DATA='" + source_folder() + "'\nP='" + path("p.tuft") + "'\nT='" +
                               tuft_program() + "'\n" +
                               "$T layer $P add gold >/dev/null || exit 1\n"
                               "$T paint $P --strokes '" +
                               path("t.inkml") +
                               "' --layer gold >/dev/null & pid=$!\n"
                               "sleep 0.05; kill -KILL $pid 2>/dev/null; wait $pid 2>/dev/null\n"
                               "$T layer $P opacity gold 0.25 >/dev/null || exit 1\n";
    ASSERT_EQ(std::system(("bash '" + write("kill.sh", script) + "' 2>/dev/null").c_str()), 0);
    ASSERT_EQ(layers().size(), 2u);
    EXPECT_EQ(layers()[1]["opacity"], 0.25);
    EXPECT_EQ(tuft("replay " + path("p.tuft")).status, 0);
}

}  // namespace
}  // namespace tuft::test
