#include <algorithm>
#include <sstream>

#include "program.h"

/// Models that are too small for what shall be painted on them, as by a mistaken unit: each stamp reaches all of the
/// model, and its texels are so fine that a stroke has millions. It is refused in one line before anything is painted,
/// or painted. No test looks at a clock: one that had to wait for such a stroke would not end.
namespace tuft::test {
namespace {

class Size : public Program {
  protected:
    /// A cube of this side in millimetres, about the origin.
    std::string cube(double side) const {
        std::ostringstream obj;
        for (const int z : {-1, 1})
            for (const int y : {-1, 1})
                for (const int x : {-1, 1})
                    obj << "v " << 0.5 * side * x << ' ' << 0.5 * side * y << ' ' << 0.5 * side * z << '\n';
        return write("cube.obj", obj.str() + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
    }
    /// A line of `length` mm on top of a cube of `side` mm.
    std::string line(double side, const std::string& brush, double length) const {
        return write("line.inkml", stroke_file("0 0 " + std::to_string(0.5 * side), brush, length));
    }
    Ran paint(double side, const std::string& brush, double length, const std::string& more = "") const {
        return tuft("paint " + cube(side) + " --unit mm --strokes " + line(side, brush, length) + " --project " +
                    path("out.tuft") + " " + more);
    }
    void expect_refused(const Ran& ran, const std::string& words) const {
        EXPECT_EQ(ran.status, 1) << ran.err;
        EXPECT_EQ(ran.error_lines(), 1) << ran.err;
        EXPECT_TRUE(ran.err.starts_with("tuft: ")) << ran.err;
        EXPECT_NE(ran.err.find(words), std::string::npos) << ran.err;
        EXPECT_FALSE(std::filesystem::exists(path("out.tuft")));
    }
};

TEST_F(Size, AVeryLargeBrushOnATinyModelIsRefused) {
    expect_refused(paint(2, "wolf-large*4", 1), "the brush is 44 mm wide");
    expect_refused(paint(2, "wolf-large*4", 100), "the tuft of wolf-large*4 is");
}

TEST_F(Size, AStrokeOfAMetreOnAModelOfAMillimetreIsRefused) {
    expect_refused(paint(1, "wolf-small", 1000), "it is 1.73 mm across, the strokes 1e+03 mm");
    // A tuft of 2 mm is shorter than a cube of 2 mm is across; the stroke has 3 million texels all the same.
    expect_refused(paint(2, "wolf-small*0.1", 8000), "the stroke is too long for this model");
}

// A stroke of 60 mm for a cube of 80 mm, which is read in inches, centimetres or metres.
TEST_F(Size, AModelInAMistakenUnitIsRefusedFromATuftsLengthOn) {
    EXPECT_EQ(paint(80, "wolf-small", 60, "--atlas-size 256").status, 0);
    std::filesystem::remove(path("out.tuft"));
    for (const double unit : {25.4, 100.0, 1000.0})
        expect_refused(paint(80 / unit, "wolf-small", 60), "is its unit another one? (see --unit");
    // As large as the tuft is long or larger it can be painted, whatever is said about it.
    EXPECT_EQ(paint(80 / 2.54, "wolf-small", 60, "--atlas-size 256").status, 0);
}

TEST_F(Size, ABeadIsPaintedWithATuftThatIsLongerThanItIs) {
    const Ran ran = paint(4, "wolf-small*0.5", 3, "--atlas-size 256");
    EXPECT_EQ(ran.status, 0) << ran.err;
}

// In a project that exists the strokes are as new as on a model from a file; those before stay as they are.
TEST_F(Size, AProjectKeepsWhatItHasWhereNewStrokesAreRefused) {
    ASSERT_EQ(paint(4, "wolf-small*0.5", 3, "--atlas-size 256").status, 0);
    const std::string before = read(path("out.tuft"));
    const Ran ran = tuft("paint " + path("out.tuft") + " --strokes " + line(4, "wolf-small", 400));
    EXPECT_EQ(ran.status, 1) << ran.err;
    EXPECT_EQ(ran.error_lines(), 1) << ran.err;
    EXPECT_NE(ran.err.find("it is 6.93 mm across, the strokes 400 mm"), std::string::npos) << ran.err;
    EXPECT_EQ(read(path("out.tuft")), before);
}

// A drawing of areas needs no brush, so no tuft is too long: it is painted, and the unit is doubted.
TEST_F(Size, AreasOnAModelInAMistakenUnitAreReported) {
    const std::string svg =
        write("a.svg",
              "<svg xmlns='http://www.w3.org/2000/svg' width='60mm' height='60mm' viewBox='0 0 60 60'>"
              "<path d='M5 5H55V55H5Z' fill='#1c4fa0'/></svg>");
    const auto painted = [&](double side) {
        const Ran ran = tuft("paint " + cube(side) + " --unit mm --strokes " + svg +
                             " --on top --place-width 60 --atlas-size 128 --no-cache --project " + path("out.tuft"));
        EXPECT_EQ(ran.status, 0) << ran.err;
        return ran.err;
    };
    const std::string doubt = "is its unit another one? (see --unit";
    // A square of 60 mm has a diagonal of 85 mm, a cube of 15 mm one of 26 mm: a third of it.
    for (const double side : {80 / 25.4, 15.0}) {
        const std::string said = painted(side);
        EXPECT_NE(said.find(doubt), std::string::npos) << said;
        EXPECT_EQ(said.find("meets no surface"), said.rfind("meets no surface")) << "once: " << said;
    }
    EXPECT_EQ(painted(80).find(doubt), std::string::npos);
    for (const double side : {80 / 25.4, 80 * 25.4}) {
        const Ran ran = tuft("replay " + path("out.tuft") + " --unit mm --no-cache --model " + cube(side));
        EXPECT_EQ(ran.status, 0) << ran.err;
        EXPECT_NE(ran.err.find(doubt), std::string::npos) << ran.err;
    }
}

}  // namespace
}  // namespace tuft::test
