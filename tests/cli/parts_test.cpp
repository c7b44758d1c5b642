#include <nlohmann/json.hpp>

#include "paths.h"
#include "program.h"

/// Parts of a model by the command line.
namespace tuft::test {
namespace {

using nlohmann::json;

class PartsOfAProject : public Program {
  protected:
    // A sheet of 60 mm as the part "body", under a pane 4 mm above it.
    void SetUp() override {
        Program::SetUp();
        write("m.obj",
              "o body\nv -30 -30 0\nv 30 -30 0\nv 30 30 0\nv -30 30 0\nf 1 2 3 4\n"
              "o pane\nv -30 -30 4\nv 30 -30 4\nv 30 30 4\nv -30 30 4\nf 5 6 7 8\n");
        write("s.inkml", stroke_file("0 0 4"));
    }
    Ran paint(const std::string& more) {
        return tuft("paint " + path("m.obj") + " --unit mm --up z --sides file --strokes " + path("s.inkml") +
                    " --mapping project --atlas-size 512 --project " + path("p.tuft") + " --json " + more);
    }
    // Film units of ink on the surface at a height.
    double ink_at(const std::string& z) {
        const Ran ran = tuft("inspect " + path("p.tuft") + " --at 0,0," + z + " --json");
        EXPECT_EQ(ran.status, 0) << ran.err;
        const json j = json::parse(ran.out);
        double sum = 0;
        for (const auto& [pigment, amount] : j["film"].items()) sum += amount.get<double>();
        return sum;
    }
    json parts(const std::string& more) {
        const Ran ran = tuft("part " + path("p.tuft") + " " + more + " --json");
        EXPECT_EQ(ran.status, 0) << ran.err;
        return json::parse(ran.out)["parts"];
    }
    std::string replayed() { return json::parse(tuft("replay " + path("p.tuft") + " --json").out)["canvas_hash"]; }
};

TEST_F(PartsOfAProject, HiddenOnesArePaintedThroughAndStayInTheProject) {
    const Ran ran = paint("--hide-parts pane --substrate clay --substrate pane=glass");
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(replayed(), json::parse(ran.out)["canvas_hash"]);
    const json listed = parts("list");
    ASSERT_EQ(listed.size(), 2u);
    EXPECT_EQ(
        listed[0],
        json(
            {{"name", "body"}, {"visible", true}, {"locked", false}, {"substrate", "clay"}, {"own_substrate", false}}));
    EXPECT_EQ(listed[1], json({{"name", "pane"},
                               {"visible", false},
                               {"locked", false},
                               {"substrate", "glass"},
                               {"own_substrate", true}}));
    EXPECT_GT(ink_at("0"), 0);
    EXPECT_EQ(parts("show")[1]["visible"], true);
    EXPECT_EQ(ink_at("4"), 0);
    EXPECT_EQ(replayed(), json::parse(ran.out)["canvas_hash"]);
    EXPECT_EQ(parts("isolate pane")[0]["visible"], false);
    EXPECT_EQ(parts("substrate pane=none")[1]["own_substrate"], false);
    EXPECT_EQ(parts("lock body")[0]["locked"], true);
    EXPECT_EQ(parts("unlock")[0]["locked"], false);
}

TEST_F(PartsOfAProject, LockedOnesGetNoInkAndOnlyLeavesTheOthersOut) {
    const Ran locked = paint("--lock-parts pane");
    ASSERT_EQ(locked.status, 0);
    EXPECT_NE(locked.err.find("all that the drawing meets is locked"), std::string::npos) << locked.err;
    EXPECT_NE(locked.err.find("(locked: pane)"), std::string::npos) << locked.err;
    EXPECT_EQ(ink_at("4"), 0);
    const std::string before = replayed();
    ASSERT_EQ(tuft("paint " + path("p.tuft") + " --strokes " + path("s.inkml") + " --mapping project --only-parts body")
                  .status,
              0);
    EXPECT_GT(ink_at("0"), 0);
    EXPECT_NE(replayed(), before);
}

TEST_F(PartsOfAProject, AreasRoundTheModelMeetNeitherItNorItsLockedParts) {
    // The sheets are 85 mm across the corners.
    const auto ring = [&](double radius) {
        write("r.svg", "<svg xmlns='http://www.w3.org/2000/svg' width='120mm' viewBox='-60 -60 120 120'><circle r='" +
                           std::to_string(radius) + "' fill='none' stroke='#bd3b25' stroke-width='4'/></svg>");
        return tuft("paint " + path("m.obj") + " --unit mm --up z --sides file --strokes " + path("r.svg") +
                    " --place 0,0,4 --place-width " + std::to_string(2 * radius + 4) +
                    " --mapping project --atlas-size 512 --lock-parts pane");
    };
    const Ran round = ring(50), on = ring(20);
    ASSERT_EQ(round.status, 0) << round.err;
    EXPECT_EQ(round.err.find("is locked"), std::string::npos) << round.err;
    EXPECT_NE(round.err.find("1 area covers no texel of the model"), std::string::npos) << round.err;
    ASSERT_EQ(on.status, 0) << on.err;
    EXPECT_NE(on.err.find("all that the drawing meets is locked"), std::string::npos) << on.err;
    EXPECT_EQ(on.err.find("covers no texel"), std::string::npos) << on.err;
}

TEST_F(PartsOfAProject, BadNamesAreOneLine) {
    for (const char* more : {"--hide-parts pain", "--lock-parts wheel", "--substrate pane=glas", "--substrate pane="}) {
        const Ran ran = paint(more);
        EXPECT_NE(ran.status, 0) << more;
        EXPECT_EQ(ran.error_lines(), 1) << ran.err;
    }
    ASSERT_EQ(paint("").status, 0);
    EXPECT_EQ(parts("list pane").size(), 1u);
    for (const char* more : {"hide", "hide pain", "isolate", "substrate pane", "substrate", "see pane", "list pain"}) {
        const Ran ran = tuft("part " + path("p.tuft") + " " + more);
        EXPECT_NE(ran.status, 0) << more;
        EXPECT_EQ(ran.error_lines(), 1) << ran.err;
    }
}

}  // namespace
}  // namespace tuft::test
