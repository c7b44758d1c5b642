#include <cmath>
#include <vector>

#include "program.h"

namespace tuft::test {
namespace {

// Work that takes a minute and more is sent a signal: it must end by itself, with one line, and
// leave nothing half done. `timeout` kills a program that has not ended three seconds after the
// signal, with status 137: a second is promised, the rest is for a busy machine.
class Stop : public Program {
  protected:
    void expect_stopped(const std::string& arguments, double after = 1, const std::string& signal = "TERM") {
        const Ran ran = tuft(arguments, "timeout --preserve-status -s " + signal + " -k 3 " + std::to_string(after));
        EXPECT_EQ(ran.status, 1) << arguments << "\n" << ran.err;
        EXPECT_TRUE(ran.err.ends_with("tuft: stopped\n")) << arguments << "\n" << ran.err;
        for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
            const std::string name = entry.path().filename();
            EXPECT_EQ(name.find(".part"), std::string::npos) << arguments << " leaves " << name;
            EXPECT_FALSE(name.starts_with("out")) << arguments << " leaves " << name;
        }
    }

    /// A drawing of outlines as jagged as a scanned leaf, filled or drawn as a line. The line is thin enough to be
    /// painted with the brush: a wider one is filled as an area, in seconds.
    std::string leaf(int corners, bool filled, double size = 100) const {
        std::ostringstream svg;
        svg << "<svg xmlns='http://www.w3.org/2000/svg' width='" << size
            << "mm' viewBox='-100 -100 200 200'><path fill='" << (filled ? "black" : "none") << "' stroke='"
            << (filled ? "none" : "black") << "' stroke-width='0.02' d='M";
        for (int i = 0; i < corners; ++i) {
            const double a = 6.2831853 * i / corners,
                         r = 60 + 30 * std::sin(9 * a) + 3 * std::sin(40.5 * a * a) + (i % 2);
            svg << r * std::cos(a) << ' ' << r * std::sin(a) << ' ';
        }
        svg << "Z'/></svg>";
        return svg.str();
    }

    /// A wavy sheet of 2 n² triangles, in the plainest format.
    std::string sheet_of(int n) const {
        std::ostringstream obj;
        for (int y = 0; y <= n; ++y)
            for (int x = 0; x <= n; ++x)
                obj << "v " << 200.0 * x / n << ' ' << 200.0 * y / n << ' ' << std::sin(0.3 * x) * std::cos(0.2 * y)
                    << '\n';
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const int a = y * (n + 1) + x + 1, b = a + n + 1;
                obj << "f " << a << ' ' << a + 1 << ' ' << b + 1 << "\nf " << a << ' ' << b + 1 << ' ' << b << '\n';
            }
        return obj.str();
    }
};

TEST_F(Stop, AnAreaBeingFilledWithLines) {
    expect_stopped("paint " + model("sheet.ply") + " --atlas-size 256 --place 0,0,0 --strokes " +
                   write("leaf.svg", leaf(60'000, true, 5000)) + " --project " + path("out.tuft"));
}

TEST_F(Stop, LongLinesBeingWalkedOverTheModel) {
    const std::string drawing = write("line.svg", leaf(20'000, false, 4000)), mesh = write("sheet.obj", sheet_of(300));
    for (const char* mapping : {"wrap", "drape"})
        expect_stopped("paint " + mesh + " --atlas-size 512 --place 100,100,0 --mapping " + std::string(mapping) +
                           " --strokes " + drawing + " --export " + path("out.glb"),
                       3);
}

TEST_F(Stop, AModelBeingReadRepairedAndUnwrapped) {
    const std::string mesh = write("sheet.obj", sheet_of(700));
    for (const double after : {0.3, 1.0, 2.5}) expect_stopped("unwrap " + mesh + " -o " + path("out.obj"), after);
    expect_stopped("render " + mesh + " --size 4096x4096 -o " + path("out.png"), 3);
}

TEST_F(Stop, MeasuringAndFitting) {
    expect_stopped("bench", 2);
    expect_stopped("brush robot-2020 calibrate " + source_folder() + "/tests/data/brush/brush_robot2020_even.csv -o " +
                       path("out.toml"),
                   1);
}

TEST_F(Stop, InkFlowingAndReplayed) {
    const std::string drawing = write("line.svg", leaf(2'000, false, 150)),
                      short_one = write("good.inkml", stroke_file());
    const std::string paint =
        "paint " + model("sheet.ply") + " --atlas-size 2048 --brush wolf-large --film wet --strokes " + drawing;
    for (const char* signal : {"TERM", "INT", "HUP"})
        expect_stopped(paint + " --place 0,0,0 --preview " + path("out.png"), 1.5, signal);
    ASSERT_EQ(tuft("paint " + model("sheet.ply") + " --atlas-size 256 --strokes " + short_one + " --project " +
                   path("short.tuft"))
                  .status,
              0);
    expect_stopped("replay " + path("short.tuft") + " --atlas-size 8192 --export " + path("out.glb"), 0.7);
}

TEST_F(Stop, ASecondSignalEndsItAtOnce) {
    write("leaf.svg", leaf(60'000, true, 5000));
    const Ran ran =
        tuft("paint " + model("sheet.ply") + " --atlas-size 256 --place 0,0,0 --strokes " + path("leaf.svg") +
             " & p=$!; sleep 1; "
             "kill -TERM $p; kill -TERM $p; for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15; do kill "
             "-0 $p 2>/dev/null || exit 0; sleep 0.2; done; kill -KILL $p; exit 9; true");
    EXPECT_EQ(ran.status, 0);
}

}  // namespace
}  // namespace tuft::test
