#include <sys/stat.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <vector>

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

TEST_F(BadInput, MissingModel) {
    expect_refused("inspect " + path("none.ply"), 1, "no such file");
}

// What cannot be found for another reason is not called missing.
TEST_F(BadInput, PathsThatLeadNowhereSayWhy) {
    std::filesystem::create_symlink("loop.ply", path("loop.ply"));
    write("plain", "x");
    const std::string deep = std::string(300, 'a') + ".ply";
    expect_refused("inspect " + path("loop.ply"), 1, "symbolic links");
    expect_refused("inspect " + path("plain/x.ply"), 1, "Not a directory");
    expect_refused("inspect " + path(deep), 1, "too long");
    expect_refused("render " + sheet() + " -o " + path("loop.ply/x.png"), 1, "symbolic links");
    expect_refused("render " + sheet() + " -o " + path("plain/x.png"), 1, "Not a directory");
}

// The options of a command are in its own help.
TEST_F(BadInput, MistakenOptionsNameTheHelpOfTheirCommand) {
    expect_refused("paint " + sheet() + " --strokes " + good_strokes() + " --on ceiling", 2,
                   "(see 'tuft paint --help')");
    expect_refused("paint " + sheet() + " --strokes " + good_strokes() + " --on top --snap z", 2, "the top side");
    expect_refused("device test --seconds never", 2, "(see 'tuft device test --help')");
    expect_refused("brush calibrate", 2, "(see 'tuft brush calibrate --help')");
    expect_refused("", 2, "(see 'tuft --help')");
    expect_refused("polish", 2, "(see 'tuft --help')");
}

TEST_F(BadInput, EmptyModel) {
    expect_refused("inspect " + write("e.obj", ""), 1, "empty");
}

TEST_F(BadInput, FolderInsteadOfModel) {
    expect_refused("inspect " + folder_.string(), 1, "folder");
}

TEST_F(BadInput, TruncatedStl) {
    expect_refused("inspect " + write("t.stl", binary_stl(1000, 500)), 1, "t.stl");
}

TEST_F(BadInput, TruncatedPly) {
    const std::string whole = read(sheet());
    expect_refused("inspect " + write("t.ply", whole.substr(0, whole.size() / 2)), 1, "t.ply");
}

TEST_F(BadInput, PlyThatPromisesABillionVertices) {
    expect_refused("inspect " + write("b.ply",
                                      "ply\nformat ascii 1.0\nelement vertex 1000000000\n"
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
    expect_refused(
        "paint " + sheet() + " --strokes " + write("t.inkml", "<ink xmlns=\"http://www.w3.org/2003/InkML\"></ink>"), 1,
        "t.inkml");
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
    ASSERT_EQ(
        tuft("paint " + sheet() + " --strokes " + good_strokes() + " --atlas-size 256 --project " + path("p.tuft"))
            .status,
        0);
    for (const std::string& out : {path("out.glb"), path("out.3mf"), path("out.obj")})
        expect_refused("export " + path("p.tuft") + " -o " + out, 1, out.substr(0, out.rfind('.')),
                       "trap '' XFSZ; ulimit -f 8;");
}

TEST_F(BadInput, ProjectThatIsNotOurs) {
    expect_refused("replay " + write("x.tuft", std::string(4096, 'x')), 1, "x.tuft");
    expect_refused("inspect " + write("y.tuft", "ply\nformat ascii 1.0\n"), 1, "y.tuft");
}

TEST_F(BadInput, ProjectFromANewerVersion) {
    ASSERT_EQ(
        tuft("paint " + sheet() + " --strokes " + good_strokes() + " --atlas-size 256 --project " + path("n.tuft"))
            .status,
        0);
    // SQLite keeps user_version at byte 60 of the file, big-endian.
    std::string bytes = read(path("n.tuft"));
    bytes[60] = 0x7f;
    write("newer.tuft", bytes);
    expect_refused("inspect " + path("newer.tuft"), 1, "newer");
}

std::string repeated(const std::string& text, int n) {
    std::string out;
    for (int i = 0; i < n; ++i) out += text;
    return out;
}

TEST_F(BadInput, TextsNestedAHundredThousandDeep) {
    constexpr int kDeep = 100'000;
    const std::vector<std::string> tomls{repeated("a.", kDeep) + "a = 1\n", "[" + repeated("a.", kDeep) + "a]\n",
                                         "x = " + repeated("[", kDeep), "x = " + repeated("{a = ", kDeep)};
    for (const std::string& text : tomls) {
        const std::string file = write("deep.toml", text);
        expect_refused("brush " + file, 1, "deep.toml:1");
        expect_refused("paint " + sheet() + " --strokes " + good_strokes() + " --ink " + file, 1, "deep.toml:1");
        expect_refused("paint " + sheet() + " --strokes " + good_strokes() + " --substrate " + file, 1, "deep.toml:1");
        expect_refused("paint " + sheet() + " --strokes " + good_strokes() + " --bias " + file, 1, "deep.toml:1");
    }
    const std::string groups = repeated("<g>", kDeep) + repeated("</g>", kDeep);
    expect_refused("paint " + sheet() + " --strokes " +
                       write("deep.svg", "<svg xmlns='http://www.w3.org/2000/svg'>" + groups + "</svg>"),
                   1, "nested too deeply");
    expect_refused("paint " + sheet() + " --strokes " +
                       write("circle.svg",
                             "<svg xmlns='http://www.w3.org/2000/svg'><g id='a'><use href='#b'/></g><g id='b'><use "
                             "href='#a'/></g></svg>"),
                   1, "nested too deeply");
    expect_refused("paint " + sheet() + " --strokes " +
                       write("deep.inkml",
                             "<ink>" + repeated("<traceGroup>", kDeep) + repeated("</traceGroup>", kDeep) + "</ink>"),
                   1, "nested too deeply");
    expect_refused("paint " + sheet() + " --strokes " +
                       write("set.inkml", "<ink><annotation type='tuft:settings'>" + repeated("[", kDeep) +
                                              "</annotation><trace>0 0,1 1</trace></ink>"),
                   1, "nested more than");
    expect_refused("inspect " + write("deep.gltf", repeated("{\"a\":", kDeep)), 1, "nested more than");
}

TEST_F(BadInput, MagnitudesThatCanBeNoModel) {
    const std::string paint = "paint " + sheet() + " --atlas-size 256 --strokes " + good_strokes() + " ";
    for (const char* bad : {"1e300,0,0", "0,nan,0", "0,0,-inf", "1e24,0,0", "20000000,0,0"}) {
        for (const char* option : {"--target", "--place"}) expect_refused(paint + option + " " + bad, 2, option);
        expect_refused("render " + sheet() + " -o " + path("a.png") + " --target " + bad, 2, "--target");
        expect_refused("inspect " + path("p.tuft") + " --at " + bad, 2, "--at");
        for (const char* option : {"--part", "--chart"})
            expect_refused("fill " + path("p.tuft") + " " + option + " " + bad, 2, option);
        expect_refused("fill " + path("p.tuft") + " --to 1,0,0 --from " + bad, 2, "--from");
        expect_refused("fill " + path("p.tuft") + " --from 1,0,0 --to " + bad, 2, "--to");
    }
    // Models: each format, too large, too small, and in units that make them so.
    const auto obj = [](const std::string& s) { return "v 0 0 0\nv " + s + " 0 0\nv 0 " + s + " 0\nf 1 2 3\n"; };
    const auto off = [](const std::string& s) { return "OFF\n3 1 0\n0 0 0\n" + s + " 0 0\n0 " + s + " 0\n3 0 1 2\n"; };
    const auto stl = [](const std::string& s) {
        return "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex " + s + " 0 0\nvertex 0 " + s +
               " 0\nendloop\nendfacet\nendsolid a\n";
    };
    const auto ply = [](const std::string& s) {
        return "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double "
               "z\nelement face 1\n"
               "property list uchar int vertex_indices\nend_header\n0 0 0\n" +
               s + " 0 0\n0 " + s + " 0\n3 0 1 2\n";
    };
    for (const std::string s : {"1e300", "1e38", "1e24", "1e11", "1e8", "1e-30", "1e-45", "1e-8"}) {
        const bool large = s.find("e-") == std::string::npos;
        for (const auto& [name, text] :
             {std::pair{"m.obj", obj(s)}, {"m.off", off(s)}, {"m.stl", stl(s)}, {"m.ply", ply(s)}}) {
            const std::string file = write(name, text);
            // Where no unit is said, one is guessed that makes the smaller ones things.
            if (s != "1e8" && s != "1e-8")
                expect_refused("inspect " + file, 1, large ? "m." : "smaller than a micrometre");
            expect_refused("paint " + file + " --unit mm --strokes " + good_strokes(), 1, "m.");
        }
    }
    expect_refused("inspect --unit m " + write("u.obj", obj("20000")), 1, "say its unit");
    expect_refused("inspect --unit um " + write("u.obj", obj("0.1")), 1, "smaller than a micrometre");
    // Strokes: placed and in space.
    for (const char* bad : {"1e300", "1e20", "nan", "2e7"})
        expect_refused("paint " + sheet() + " --strokes " + write("o.inkml", stroke_file(std::string("0 0 ") + bad)), 1,
                       "o.inkml:");
    for (const char* bad : {"1e300", "1e20", "1e9"})
        expect_refused("paint " + sheet() + " --strokes " +
                           write("x.inkml", std::string("<ink><traceFormat><channel name='X'/><channel "
                                                        "name='Y'/><channel name='Z'/></traceFormat><trace>0 0 ") +
                                                bad + ", 1 1 1</trace></ink>"),
                       1, "x.inkml:");
}

TEST_F(BadInput, NumbersThatAreNoNumbers) {
    ASSERT_EQ(
        tuft("paint " + sheet() + " --strokes " + good_strokes() + " --atlas-size 256 --project " + path("p.tuft"))
            .status,
        0);
    const std::string paint = "paint " + sheet() + " --strokes " + good_strokes() + " ";
    for (const char* bad : {"nan", "-nan", "inf", "1e999", "0x10", "3mm", "-1e308"}) {
        for (const char* option :
             {"--dry", "--smooth", "--stabilise", "--place-width", "--place-turn", "--texel-size", "--wide-lines",
              "--radial", "--atlas-size", "--zoom", "--light", "--sharp-angle", "--pages", "--threads"})
            expect_refused(paint + option + "=" + bad, 2, option);
        expect_refused(paint + "--edges end-before --edge-margin=" + bad, 2, "--edge-margin");
        expect_refused(paint + "--as-pointer --pixel=" + bad, 2, "--pixel");
        for (const char* option : {"--film", "--parts"})
            expect_refused(std::string("ink match '#603010' ") + option + "=" + bad, 2, option);
        for (const char* option : {"--film", "--to-film"})
            expect_refused("fill " + path("p.tuft") + " " + option + "=" + bad, 2, option);
        for (const char* option : {"--within", "--soft"})
            expect_refused("mask " + path("p.tuft") + " m --facing 0,0,1 " + option + "=" + bad, 2, option);
        expect_refused(paint + "--view=" + bad + ",0", 2, "--view");
        expect_refused("mask " + path("p.tuft") + " m --lasso '0,0 1,0 1," + bad + "'", 2, "--lasso");
    }
    for (const char* option : {"--texel-size", "--place-width", "--atlas-size"}) {
        const Ran ran = tuft(paint + option + " 0");
        EXPECT_EQ(ran.status, 2);
        EXPECT_LT(ran.err.size(), 200u) << "no range of 300 digits: " << ran.err;
    }
}

TEST_F(BadInput, OptionsThatWouldDoNothingAlone) {
    const std::string paint = "paint " + sheet() + " --strokes " + good_strokes() + " ";
    expect_refused(paint + "--repeat 3", 2, "--along");
    expect_refused(paint + "--edge-margin 3", 2, "--edges");
}

TEST_F(BadInput, ValuesThatAreEmpty) {
    for (const char* option : {"--ink", "--brush", "--layer", "--mask", "--substrate", "--project", "--export",
                               "--preview", "--bias", "--film"})
        expect_refused("paint " + sheet() + " --strokes " + good_strokes() + " " + option + " ''", 2, option);
    expect_refused("inspect ''", 2, "FILE");
    expect_refused("layer " + path("p.tuft") + " add ''", 2, "NAME");
}

TEST_F(BadInput, PipesDevicesAndFoldersAreNoInput) {
    ASSERT_EQ(::mkfifo(path("pipe.ply").c_str(), 0600), 0);
    for (const char* name : {"pipe.svg", "pipe.inkml", "pipe.toml", "pipe.tuft", "pipe.csv", "pipe.gltf"})
        std::filesystem::create_symlink(path("pipe.ply"), path(name));
    // A program that waits for the pipe's other end is killed after ten seconds: status 137.
    const std::string prefix = "timeout -s KILL 10";
    for (const std::string& input :
         {path("pipe.ply"), path("pipe.gltf"), path("pipe.tuft"), std::string("/dev/zero"), std::string("/dev/tty")}) {
        expect_refused("inspect " + input, 1, "not a regular file", prefix);
        expect_refused("render " + input + " -o " + path("a.png"), 1, "not a regular file", prefix);
    }
    for (const char* name : {"pipe.svg", "pipe.inkml"})
        expect_refused("paint " + sheet() + " --strokes " + path(name), 1, "not a regular file", prefix);
    expect_refused("paint " + sheet() + " --strokes /dev/zero", 1, "not a regular file", prefix);
    expect_refused("brush " + path("pipe.toml"), 1, "not a regular file", prefix);
    expect_refused("paint " + sheet() + " --strokes " + good_strokes() + " --ink " + path("pipe.toml"), 1,
                   "not a regular file", prefix);
    expect_refused("brush wolf calibrate " + path("pipe.csv") + " -o " + path("b.toml"), 1, "not a regular file",
                   prefix);
    // Nor is one written over.
    expect_refused("render " + sheet() + " --size 32x32 -o " + path("pipe.png"), 1, "not a regular file",
                   "mkfifo '" + path("pipe.png") + "'; " + prefix);
}

TEST_F(BadInput, FilesThatMayNotGrowLeaveNothing) {
    // The shell's limit kills a program that does not ask to be told instead.
    expect_refused("render " + sheet() + " --size 256x256 -o " + path("a.png"), 1, "a.png", "ulimit -f 1;");
    ASSERT_EQ(
        tuft("paint " + sheet() + " --strokes " + good_strokes() + " --atlas-size 256 --project " + path("p.tuft"))
            .status,
        0);
    for (const char* name : {"out.glb", "out.obj", "out.exr"})
        expect_refused("export " + path("p.tuft") + " -o " + path(name), 1, "out", "ulimit -f 1;");
    expect_refused(
        "paint " + sheet() + " --strokes " + good_strokes() + " --atlas-size 256 --project " + path("out.tuft"), 1,
        "out.tuft: cannot be read or written: File too large", "ulimit -f 8;");
}

TEST_F(BadInput, PointsBesideTheModel) {
    ASSERT_EQ(
        tuft("paint " + sheet() + " --strokes " + good_strokes() + " --atlas-size 256 --project " + path("p.tuft"))
            .status,
        0);
    expect_refused("inspect " + path("p.tuft") + " --at 1000,0,0", 1, "beside the model");
    expect_refused("fill " + path("p.tuft") + " --part 0,0,1000", 1, "beside the model");
    expect_refused("mask " + path("p.tuft") + " m --chart 0,-1000,0", 1, "beside the model");
    EXPECT_EQ(tuft("inspect " + path("p.tuft") + " --at 0,0,0.2").status, 0);
}

TEST_F(BadInput, NamesOfOlderProgramsInJson) {
    const std::string mesh = "o T\xfcr\nv 0 0 0\nv 10 0 0\nv 0 10 0\nv 10 10 5\nf 1 2 3\no Dach\nf 2 4 3\n";
    const Ran ran = tuft("inspect --json " + write("a.obj", mesh));
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_NE(ran.out.find("T\xc3\xbcr"), std::string::npos) << ran.out;
    // A file's own name that is not UTF-8.
    const Ran named = tuft("inspect --json " + write("T\xfcr.obj", mesh));
    EXPECT_EQ(named.status, 0) << named.err;
    EXPECT_NE(named.out.find("\"triangles\": 2"), std::string::npos);
    for (const char* head : {"solid T\xfcr\n", "solid \xff\xfe\n"})
        EXPECT_EQ(tuft("inspect --json " +
                       write("a.stl", std::string(head) +
                                          "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 10 0 0\nvertex 0 10 0\n"
                                          "endloop\nendfacet\nendsolid\n"))
                      .status,
                  0);
    EXPECT_EQ(
        tuft(
            "inspect --json " +
            write("a.ply",
                  "ply\nformat ascii 1.0\ncomment TextureFile T\xfcr.png\ncomment TextureFile b.png\nelement vertex 3\n"
                  "property float x\nproperty float y\nproperty float z\nelement face 1\n"
                  "property list uchar int vertex_indices\nproperty int texnumber\nend_header\n0 0 0\n10 0 0\n0 10 "
                  "0\n3 0 1 2 0\n"))
            .status,
        0);
    expect_refused("inspect --json " + write("bad.gltf", "{\"asset\": \xff}"), 1, "its JSON cannot be read");
}

TEST_F(BadInput, OptionsStandBehindSubcommands) {
    // The first fault told is that of the table, not of an unknown option.
    for (const char* option : {"--threads 1", "--json", "--quiet"})
        expect_refused("brush wolf calibrate " + path("none.csv") + " -o " + path("b.toml") + " " + option, 1,
                       "none.csv");
}

TEST_F(BadInput, WrongUsage) {
    expect_refused("paint", 2, "MODEL");
    expect_refused("frobnicate", 2, "");
    expect_refused("", 2, "subcommand");
    expect_refused("paint " + sheet() + " --strokes " + good_strokes() + " --unit furlong", 2, "furlong");
    expect_refused("render " + sheet() + " -o " + path("a.png") + " --size 12", 2, "WIDTHxHEIGHT");
    expect_refused("render " + sheet() + " -o " + path("a.png") + " --size 100000x100000", 2, "16 to 16384 pixels");
    expect_refused("paint " + sheet() + " --strokes " + good_strokes() + " --atlas-size -4", 2, "atlas-size");
}

TEST_F(BadInput, StrokeThatNeverTouchesIsAWarningWithItsDistance) {
    std::string spatial =
        "<ink xmlns=\"http://www.w3.org/2003/InkML\"><definitions><traceFormat xml:id=\"f\">"
        "<channel name=\"X\" units=\"mm\"/><channel name=\"Y\" units=\"mm\"/><channel name=\"Z\" units=\"mm\"/>"
        "</traceFormat><context xml:id=\"c\" traceFormatRef=\"#f\"/></definitions>"
        "<trace contextRef=\"#c\">0 0 120, 5 0 120, 10 0 120</trace></ink>";
    const Ran ran =
        tuft("paint " + sheet() + " --strokes " + write("air.inkml", spatial) + " --brush wolf-small --atlas-size 256");
    EXPECT_EQ(ran.status, 0);
    EXPECT_NE(ran.err.find("never touches"), std::string::npos) << ran.err;
    // The ferrule is 120 mm up and the tuft 20 mm long.
    EXPECT_NE(ran.err.find("100.00 mm"), std::string::npos) << ran.err;
}

}  // namespace
}  // namespace tuft::test
