#include <algorithm>
#include <cstring>

#include "program.h"

namespace tuft::test {
namespace {


// Every kind of bad input: the stated exit status, one line on standard error that starts
// with the program's name, nothing on standard output, no file left behind.
class BadInput : public Program {
  protected:
    void expect_refused(const std::string& arguments, int status, const std::string& words,
                        const std::string& prefix = "") {
        const Ran ran = tuft(arguments, prefix);
        EXPECT_EQ(ran.status, status) << arguments << "\n" << ran.err;
        EXPECT_EQ(ran.error_lines(), 1) << ran.err;
        EXPECT_TRUE(ran.err.starts_with("tuft: ")) << ran.err;
        EXPECT_NE(ran.err.find(words), std::string::npos) << "no '" << words << "' in: " << ran.err;
        EXPECT_TRUE(ran.out.empty()) << ran.out;
        for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
            const std::string name = entry.path().filename();
            EXPECT_EQ(name.find(".part"), std::string::npos) << name;
            EXPECT_NE(name, "out.glb");
            EXPECT_NE(name, "out.tuft");
        }
    }
    std::string sheet() const { return model("sheet.ply"); }
    std::string good_strokes() const { return write("good.inkml", stroke_file()); }
};

std::string binary_stl(std::uint32_t triangles, std::size_t bytes) {
    std::string stl(80, ' ');
    stl.append(reinterpret_cast<const char*>(&triangles), 4);
    stl.append(bytes, '\1');
    return stl;
}

TEST_F(BadInput, MissingModel) { expect_refused("inspect " + path("none.ply"), 1, "no such file"); }

TEST_F(BadInput, EmptyModel) { expect_refused("inspect " + write("e.obj", ""), 1, "empty"); }

TEST_F(BadInput, FolderInsteadOfModel) { expect_refused("inspect " + folder_.string(), 1, "folder"); }

TEST_F(BadInput, TruncatedStl) {
    expect_refused("inspect " + write("t.stl", binary_stl(1000, 500)), 1, "t.stl");
}

TEST_F(BadInput, TruncatedPly) {
    const std::string whole = read(sheet());
    expect_refused("inspect " + write("t.ply", whole.substr(0, whole.size() / 2)), 1, "t.ply");
}

TEST_F(BadInput, PlyThatPromisesABillionVertices) {
    expect_refused("inspect " + write("b.ply", "ply\nformat ascii 1.0\nelement vertex 1000000000\n"
                                               "property float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n"),
                   1, "b.ply");
}

TEST_F(BadInput, IndexOutOfRange) {
    expect_refused("inspect " + write("i.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n"), 1, "i.obj:4");
}

TEST_F(BadInput, OnlyNotANumber) {
    expect_refused("inspect " + write("n.obj", "v nan 0 0\nv 1 inf 0\nv 0 1 0\nf 1 2 3\n"), 1, "n.obj");
}

TEST_F(BadInput, ZeroArea) {
    expect_refused("inspect " + write("z.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), 1, "z.obj");
}

TEST_F(BadInput, UnknownBrushWithTheNearestName) {
    expect_refused("paint " + sheet() + " --strokes " + good_strokes() + " --brush wolff-small", 1, "wolf-small");
    expect_refused("brush goatt-large", 1, "goat-large");
}

TEST_F(BadInput, UnknownInkWithTheNearestName) {
    expect_refused("paint " + sheet() + " --strokes " + good_strokes() + " --ink carbn", 1, "carbon");
}

TEST_F(BadInput, UnknownBrushLeavesNoProject) {
    expect_refused("paint " + sheet() + " --strokes " + good_strokes() + " --brush xyzzy --project " + path("out.tuft"),
                   1, "xyzzy");
}

TEST_F(BadInput, InkmlNotWellFormed) {
    expect_refused("paint " + sheet() + " --strokes " + write("w.inkml", "<ink>\n<trace>1 2, 3 4</trac></ink>"), 1,
                   "w.inkml:2");
}

TEST_F(BadInput, InkmlWithoutTraces) {
    expect_refused("paint " + sheet() + " --strokes " +
                       write("t.inkml", "<ink xmlns=\"http://www.w3.org/2003/InkML\"></ink>"),
                   1, "t.inkml");
}

TEST_F(BadInput, AtlasThatExceedsMemory) {
    expect_refused("paint " + sheet() + " --strokes " + good_strokes() + " --atlas-size 1000000", 1, "1000000");
    expect_refused("paint " + sheet() + " --strokes " + good_strokes() + " --texel-size 0.0000001", 1, "texel");
}

TEST_F(BadInput, AtlasTooSmallForItsCharts) {
    expect_refused("unwrap " + model("bowl.ply") + " --atlas-size 8 -o " + path("out.obj"), 1, "bowl.ply");
}

TEST_F(BadInput, OutputFolderThatDoesNotExist) {
    expect_refused("paint " + sheet() + " --strokes " + good_strokes() + " --export " + path("no/out.glb"), 1,
                   "does not exist");
}

TEST_F(BadInput, OutputOfAnUnknownKind) {
    expect_refused("paint " + sheet() + " --strokes " + good_strokes() + " --export " + path("out.xyz"), 2, ".glb");
}

TEST_F(BadInput, DiskThatFillsUp) {
    // No file may grow beyond 8 KiB: a write fails half-way, as on a full disk.
    expect_refused("export " + path("p.tuft") + " -o " + path("out.glb"), 1, "p.tuft");
    ASSERT_EQ(tuft("paint " + sheet() + " --strokes " + good_strokes() + " --atlas-size 256 --project " + path("p.tuft")).status, 0);
    expect_refused("export " + path("p.tuft") + " -o " + path("out.glb"), 1, "out.glb", "trap '' XFSZ; ulimit -f 8;");
}

TEST_F(BadInput, ProjectThatIsNotOurs) {
    expect_refused("replay " + write("x.tuft", std::string(4096, 'x')), 1, "x.tuft");
    expect_refused("inspect " + write("y.tuft", "ply\nformat ascii 1.0\n"), 1, "y.tuft");
}

TEST_F(BadInput, ProjectFromANewerVersion) {
    ASSERT_EQ(tuft("paint " + sheet() + " --strokes " + good_strokes() + " --atlas-size 256 --project " + path("n.tuft")).status, 0);
    // SQLite keeps user_version at byte 60 of the file, big-endian.
    std::string bytes = read(path("n.tuft"));
    bytes[60] = 0x7f;
    write("newer.tuft", bytes);
    expect_refused("inspect " + path("newer.tuft"), 1, "newer");
}

TEST_F(BadInput, WrongUsage) {
    expect_refused("paint", 2, "MODEL");
    expect_refused("frobnicate", 2, "");
    expect_refused("", 2, "subcommand");
    expect_refused("paint " + sheet() + " --strokes " + good_strokes() + " --unit furlong", 2, "furlong");
    expect_refused("render " + sheet() + " -o " + path("a.png") + " --size 12", 2, "WIDTHxHEIGHT");
    expect_refused("paint " + sheet() + " --strokes " + good_strokes() + " --atlas-size -4", 2, "atlas-size");
}

TEST_F(BadInput, StrokeThatNeverTouchesIsAWarningWithItsDistance) {
    std::string spatial =
        "<ink xmlns=\"http://www.w3.org/2003/InkML\"><definitions><traceFormat xml:id=\"f\">"
        "<channel name=\"X\" units=\"mm\"/><channel name=\"Y\" units=\"mm\"/><channel name=\"Z\" units=\"mm\"/>"
        "</traceFormat><context xml:id=\"c\" traceFormatRef=\"#f\"/></definitions>"
        "<trace contextRef=\"#c\">0 0 120, 5 0 120, 10 0 120</trace></ink>";
    const Ran ran = tuft("paint " + sheet() + " --strokes " + write("air.inkml", spatial) +
                         " --brush wolf-small --atlas-size 256");
    EXPECT_EQ(ran.status, 0);
    EXPECT_NE(ran.err.find("never touches"), std::string::npos) << ran.err;
    // The ferrule is 120 mm up and the tuft 20 mm long.
    EXPECT_NE(ran.err.find("100.00 mm"), std::string::npos) << ran.err;
}

}  // namespace
}  // namespace tuft::test
