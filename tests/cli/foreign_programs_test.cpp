#include "program.h"

/// Programs for robots, read by parsers of other people (read_programs.py) and compared with the neutral list.
namespace tuft::test {
namespace {

class ForeignPrograms : public Program {
  protected:
    void SetUp() override {
        if (!std::getenv("TUFT_ROBOT_GRAMMARS"))
            GTEST_SKIP()
                << "TUFT_ROBOT_GRAMMARS names no folder of grammars (tests/cli/read_programs.py lists its files)";
        if (std::system("command -v antlr4 >/dev/null && /usr/bin/python3 -c 'import antlr4' 2>/dev/null") != 0)
            GTEST_SKIP() << "antlr4 and python3-antlr4 are not installed";
        Program::SetUp();
    }
    /// Complaints of the parsers about the programs of a project, and places or times that differ.
    Ran read_programs(const std::string& project, const std::vector<std::string>& extensions) const {
        std::string files = path("a.json");
        const auto write = [&](const std::string& extension) {
            const Ran ran = tuft("trajectory " + project + " -o " + path("a" + extension) +
                                 " --quiet --base 400,20,100,5,10,30 --tool 1,2,120,10,20,30");
            EXPECT_EQ(ran.status, 0) << ran.err;
        };
        write(".json");
        for (const std::string& extension : extensions) {
            write(extension);
            files += " " + path("a" + extension);
        }
        return run("/usr/bin/python3",
                   source_folder() + "/tests/cli/read_programs.py " + std::getenv("TUFT_ROBOT_GRAMMARS") + " " + files);
    }
};

TEST_F(ForeignPrograms, OfABowlAreReadInThreeLanguages) {
    ASSERT_EQ(tuft("paint " + model("bowl.ply") + " --strokes " + source_folder() +
                   "/samples/strokes/qi-shang-ba-xia.inkml --atlas-size 256 --quiet --project " + path("p.tuft"))
                  .status,
              0);
    const Ran read = read_programs(path("p.tuft"), {".urscript", ".mod", ".src"});
    EXPECT_EQ(read.status, 0) << read.out << read.err;
}

// An upright hand that comes down, rests, creeps, turns in its place, draws a line and lifts.
TEST_F(ForeignPrograms, OfAHandThatRestsAndTurnsKeepItsTime) {
    std::string table = "t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz\n";
    double t = 0, x = 0, z = 34, turn = 0;
    const auto row = [&](double after, double to_x, double to_z, double by) {
        t += after, x += to_x, z += to_z, turn += by;
        table += std::to_string(t) + "," + std::to_string(x) + ",0," + std::to_string(z) + "," +
                 std::to_string(std::cos(turn / 2)) + ",0,0," + std::to_string(std::sin(turn / 2)) + "\n";
    };
    for (int i = 0; i < 20; ++i) row(0.02, 0, -0.5, 0);
    row(0.5, 0, 0, 0);
    for (int i = 0; i < 10; ++i) row(0.1, 0.003, 0, 0);
    for (int i = 0; i < 20; ++i) row(0.05, 0, 0, 0.05);
    for (int i = 0; i < 30; ++i) row(0.03, 1, 0, 0);
    for (int i = 0; i < 20; ++i) row(0.02, 0, 0.5, 0);
    ASSERT_EQ(tuft("paint " + model("sheet.ply") + " --strokes " + write("hand.csv", table) +
                   " --brush wolf-medium --atlas-size 256 --quiet --project " + path("p.tuft"))
                  .status,
              0);
    const Ran robots = read_programs(path("p.tuft"), {".urscript", ".mod", ".src"});
    EXPECT_EQ(robots.status, 0) << robots.out << robots.err;
    if (!std::getenv("RS274") && std::system("command -v rs274 >/dev/null") != 0) return;
    const Ran plotter = read_programs(path("p.tuft"), {".gcode"});
    EXPECT_EQ(plotter.status, 0) << plotter.out << plotter.err;
}

}  // namespace
}  // namespace tuft::test
