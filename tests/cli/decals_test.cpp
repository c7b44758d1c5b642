#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <regex>
#include <sstream>

#include "io/image/image.h"
#include "program.h"

namespace tuft {
namespace {

namespace fs = std::filesystem;

class Decals : public test::Program {
  protected:
    /// A project with writing on the bowl, texels of 0.3 mm.
    std::string bowl(const std::string& strokes = "man-bu-ren-sheng") const {
        const std::string project = path(strokes + ".tuft");
        const test::Ran ran =
            tuft("paint " + model("bowl.ply") + " --strokes " + source_folder() + "/samples/strokes/" + strokes +
                 ".inkml --atlas-size 1024 --quiet --project " + project);
        EXPECT_EQ(ran.status, 0) << ran.err;
        return project;
    }
};

using Trajectories = Decals;

TEST_F(Decals, WritesSheetsWithinTheStrainOfTheFilm) {
    const std::string project = bowl();
    const test::Ran ran = tuft("decals " + project + " -o " + path("sheet.pdf") + " --strain-map --json");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const nlohmann::json j = nlohmann::json::parse(ran.out);
    ASSERT_FALSE(j.at("pieces").empty());
    double paint = 0;
    for (const nlohmann::json& piece : j["pieces"]) {
        EXPECT_LE(piece.at("strain").get<double>(), 0.03);
        EXPECT_GT(piece.at("film_mm2").get<double>(), piece.at("paint_mm2").get<double>());
        EXPECT_GE(std::min(piece["size_mm"][0].get<double>(), piece["size_mm"][1].get<double>()),
                  9);  // 10 mm, cut at seams
        paint += piece["paint_mm2"].get<double>();
    }
    EXPECT_GT(paint, 100);
    // The same paint, whatever the film: in fewer pieces of wrap film.
    const test::Ran wrap = tuft("decals " + project + " -o " + path("wrap.dxf") + " --max-strain 15% --json");
    ASSERT_EQ(wrap.status, 0) << wrap.err;
    double same = 0;
    const nlohmann::json w = nlohmann::json::parse(wrap.out);
    for (const nlohmann::json& piece : w.at("pieces")) same += piece.at("paint_mm2").get<double>();
    EXPECT_LE(w["pieces"].size(), j["pieces"].size());
    EXPECT_NEAR(same, paint, 0.03 * paint);  // the film's strain, and cells on the rim of the paint
}

TEST_F(Decals, WritesAPlateForEachPigmentAndCutLinesAlone) {
    const std::string project = bowl();
    const test::Ran ran = tuft("decals " + project + " -o " + path("plates.pdf") + " --plates --json");
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_GE(nlohmann::json::parse(ran.out).at("plates").size(), 1u);
    const test::Ran dxf = tuft("decals " + project + " -o " + path("cut.dxf") + " --page roll:300mm --grain up");
    ASSERT_EQ(dxf.status, 0) << dxf.err;
    EXPECT_NE(read(path("cut.dxf")).find("CutContour"), std::string::npos);
}

TEST_F(Decals, OutlinesWhatIsPaintedInOneInk) {
    write("s.inkml", stroke_file());
    const std::string project = path("p.tuft");
    ASSERT_EQ(tuft("paint " + model("sheet.ply") + " --atlas-size 512 --ink carbon --quiet --strokes " +
                   path("s.inkml") + " --project " + project)
                  .status,
              0);
    const test::Ran dxf = tuft("decals " + project + " -o " + path("ink.dxf") + " --outlines --json");
    ASSERT_EQ(dxf.status, 0) << dxf.err;
    const nlohmann::json j = nlohmann::json::parse(dxf.out);
    EXPECT_EQ(j.at("inks"), nlohmann::json{"carbon black"});
    for (const nlohmann::json& piece : j.at("pieces")) EXPECT_TRUE(piece.at("outlined"));
    EXPECT_NE(read(path("ink.dxf")).find("Ink_carbon_black"), std::string::npos);
    const test::Ran svg = tuft("decals " + project + " -o " + path("ink.svg") + " --outlines --plates");
    ASSERT_EQ(svg.status, 0) << svg.err;
    EXPECT_EQ(read(path("ink.svg")).find("<image"), std::string::npos);
}

TEST_F(Decals, LaysAMaskFlatWhereNothingIsPainted) {
    const std::string project = bowl();
    ASSERT_EQ(tuft("mask " + project + " band --lasso '-40,-10 40,-10 40,10 -40,10' --view 200,0").status, 0);
    const test::Ran ran = tuft("decals " + project + " --mask band -o " + path("band.svg") + " --json");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const test::Ran wrong = tuft("decals " + project + " --mask bend -o " + path("band.pdf"));
    EXPECT_EQ(wrong.status, 2);
    EXPECT_NE(wrong.err.find("did you mean 'band'?"), std::string::npos) << wrong.err;
}

// One that is made, named with a slash at its end. Its pictures take seconds, so it is written once: for a piece on the
// underside, which the usual view does not show.
TEST_F(Decals, WritesItsGuideIntoAFolderNamedWithASlashAndShowsThePiecesInIt) {
    write("s.inkml", stroke_file());
    const std::string project = path("p.tuft");
    ASSERT_EQ(tuft("paint " + model("sheet.ply") + " --sides turned --atlas-size 512 --quiet --strokes " +
                   path("s.inkml") + " --project " + project)
                  .status,
              0);
    const test::Ran made = tuft("decals " + project + " -o " + path("x.dxf") + " --quiet --guide " + path("new/"));
    EXPECT_EQ(made.status, 0) << made.err;
    for (const char* file : {"lines.obj", "overview.png", "piece-01.png"})
        EXPECT_TRUE(fs::exists(path("new") + "/" + file)) << file;
    const io::Image8 overview = io::read_image8(path("new/overview.png"));
    std::size_t n_magenta = 0;
    for (std::size_t i = 0; i + 2 < overview.pixels.size(); i += static_cast<std::size_t>(overview.channels))
        n_magenta += overview.pixels[i] > 190 && overview.pixels[i + 1] < 30 && overview.pixels[i + 2] > 110;
    EXPECT_GT(n_magenta, 100u);  // of a cut line 2.5 pixels wide, some 90 long and seen at a slant; 0 from above
    write("file", "x");
    for (const char* guide : {"file", "file/", "missing/guide/"}) {
        const test::Ran ran = tuft("decals " + project + " -o " + path("y.dxf") + " --guide " + path(guide));
        EXPECT_EQ(ran.status, 1) << guide;
        EXPECT_EQ(ran.error_lines(), 1) << ran.err;
        EXPECT_FALSE(fs::exists(path("y.dxf"))) << guide;
    }
}

// Film round paint at an edge of the model reaches beyond it. The line on the model is whole there: it runs along the
// edge, within a step of 1 mm, as far as its next points on the model are less than 80 mm apart.
TEST_F(Decals, TheLinesOfTheGuideAreWholeWhereTheFilmLeavesTheModel) {
    write("sheet.obj", "v -30 -20 0\nv 30 -20 0\nv 30 20 0\nv -30 20 0\nf 1 2 3 4\n");
    write("s.svg", R"(<svg xmlns="http://www.w3.org/2000/svg" width="16mm" height="10mm" viewBox="0 0 16 10">)"
                   R"(<path d="M0 5H16" stroke="#000" stroke-width="10"/></svg>)");
    const std::string project = path("p.tuft");
    const test::Ran paint =
        tuft("paint " + path("sheet.obj") + " --unit mm --place 21,0,0 --place-width 16 --atlas-size 256 --quiet" +
             " --strokes " + path("s.svg") + " --project " + project);
    ASSERT_EQ(paint.status, 0) << paint.err;
    const test::Ran ran =
        tuft("decals " + project + " -o " + path("x.dxf") + " --quiet --bleed 3mm --guide " + path("guide"));
    ASSERT_EQ(ran.status, 0) << ran.err;
    std::ifstream lines(path("guide/lines.obj"));
    std::vector<std::array<double, 3>> points;
    std::vector<std::vector<std::size_t>> of_piece;
    bool is_arrow = false;
    for (std::string line, word; std::getline(lines, line);) {
        std::istringstream in(line);
        in >> word;
        if (word == "v") {
            points.emplace_back();
            for (double& x : points.back()) in >> x;
        } else if (word == "o") {
            is_arrow = line.ends_with("_up");
        } else if (word == "l" && !is_arrow) {
            of_piece.emplace_back();
            for (std::size_t i = 0; in >> i;) of_piece.back().push_back(i - 1);
        }
    }
    ASSERT_EQ(of_piece.size(), 1u);
    double right = 0, length = 0;
    for (std::size_t i = 0; i < of_piece[0].size(); ++i) {
        const auto& a = points.at(of_piece[0][i]);
        const auto& b = points.at(of_piece[0][(i + 1) % of_piece[0].size()]);
        const double step = std::hypot(b[0] - a[0], b[1] - a[1]);
        EXPECT_LT(step, 1.5) << i;  // 1 mm along the line; an inner corner is cut short
        EXPECT_LT(std::abs(a[2]), 1e-6);
        right = std::max(right, a[0]);
        length += step;
    }
    EXPECT_NEAR(right, 30, 1);
    // 16 × 10 mm from 13 to 29 mm, 3 mm round it up to the edge at 30, with round corners of 3 mm on the left.
    EXPECT_NEAR(length, 2 * 20 + 2 * 16 - 2 * 3 * (2 - std::numbers::pi / 2),
                1.5);  // texels of 0.24 mm, the edge's step
}

TEST_F(Decals, RefusesBadInputInOneLineAndWritesNothing) {
    const std::string project = bowl();
    const std::string start = "decals " + project + " -o " + path("x.pdf") + " ";
    for (const char* options : {"--page A5", "--page 10x10mm", "--bleed 3furlongs", "--bleed -1", "--max-strain 90%",
                                "--dpi 0", "--grain left", "--page 60mm", "--layers nothing", "--guide "}) {
        const test::Ran ran = tuft(start + options);
        EXPECT_EQ(ran.status, 2) << options;
        EXPECT_EQ(ran.error_lines(), 1) << options << ran.err;
    }
    for (const std::string& command :
         {"decals " + project + " -o " + path("x.png"), "decals " + project + " -o " + path("x.svg") + " --plates",
          "decals " + project + " -o " + path("x.pdf") + " --outlines --mask band"}) {
        EXPECT_EQ(tuft(command).status, 2) << command;
    }
    for (const std::string& command :
         {"decals " + project + " -o " + path("missing/x.pdf"), "decals " + path("none.tuft") + " -o " + path("x.pdf"),
          start + "--guide " + path("missing/guide")}) {
        const test::Ran ran = tuft(command);
        EXPECT_EQ(ran.status, 1) << command;
        EXPECT_EQ(ran.error_lines(), 1) << ran.err;
    }
    EXPECT_FALSE(fs::exists(path("x.pdf")));
    EXPECT_FALSE(fs::exists(path("x.svg")));
}

/// Intersection over union of the texels with paint.
double overlap_of(const io::ImageF& a, const io::ImageF& b) {
    std::size_t both = 0, any = 0;
    const auto amount = [](const io::ImageF& image, std::size_t i) {
        float sum = 0;
        for (int c = 0; c < image.channels; ++c)
            sum += image.pixels[i * static_cast<std::size_t>(image.channels) + static_cast<std::size_t>(c)];
        return sum;
    };
    for (std::size_t i = 0; i < static_cast<std::size_t>(a.width) * static_cast<std::size_t>(a.height); ++i) {
        const bool p = amount(a, i) > 0.2f, q = amount(b, i) > 0.2f;
        both += p && q, any += p || q;
    }
    return static_cast<double>(both) / static_cast<double>(any);
}

class ReadBack : public Decals {
  protected:
    io::ImageF amounts(const std::string& project, const std::string& to) const {
        EXPECT_EQ(tuft("export " + project + " -o " + path(to) + " --map pigments --quiet").status, 0);
        return io::read_image_float(path(to));
    }
    /// Overlap of a project on a model with what its trajectory, in a file of this extension, paints there.
    double overlap(const std::string& project, const std::string& on, const std::string& extension,
                   const std::string& options) const {
        const std::string file = path("back." + extension), again = path("back.tuft");
        fs::remove(again);
        const test::Ran ran = tuft("trajectory " + project + " -o " + file + " --json " + options);
        EXPECT_EQ(ran.status, 0) << ran.err;
        EXPECT_GT(nlohmann::json::parse(ran.out).at("largest_force_n").get<double>(), 0.001);
        const test::Ran back =
            tuft("paint " + model(on) + " --strokes " + file + " --atlas-size 1024 --quiet --project " + again);
        EXPECT_EQ(back.status, 0) << back.err;
        return overlap_of(amounts(project, "painted.exr"), amounts(again, "back.exr"));
    }
};

TEST_F(ReadBack, PaintsTheSameTexels) {
    const std::string project = bowl();
    for (const std::string extension : {"json", "csv"})
        EXPECT_GE(overlap(project, "bowl.ply", extension, ""), 0.99) << extension;
}

// A hand that comes down and lifts at once, faster than a robot may: its tips are hairlines, which trail by their
// speed.
TEST_F(ReadBack, KeepsTheHandsPace) {
    std::ofstream strokes(path("two.inkml"));
    strokes << R"(<ink xmlns="http://www.w3.org/2003/InkML"><definitions><traceFormat xml:id="f">
      <channel name="X" type="decimal" units="mm"/><channel name="Y" type="decimal" units="mm"/>
      <channel name="P" type="decimal" min="0" max="1"/><channel name="T" type="decimal" units="ms"/>
      </traceFormat><context xml:id="c" traceFormatRef="#f"/></definitions>)";
    for (int k = 0; k < 2; ++k) {
        strokes << R"(<trace contextRef="#c">)";
        for (int i = 0; i <= 80; ++i) {
            const double t = i / 80.0;
            strokes << (i ? ", " : "") << 16 * t - 8 << ' ' << 7 * k - 3 + 2 * std::sin(6 * t) << ' '
                    << 0.4 * std::sqrt(std::max(0.0, std::sin(3.14159 * t))) << ' ' << 10 * i;
        }
        strokes << "</trace>";
    }
    strokes << "</ink>";
    strokes.close();
    for (const auto& [on, brush] :
         {std::pair{"sphere.ply", "wolf-medium"}, {"bowl.ply", "flat-12"}, {"sheet.ply", "wolf-medium"}}) {
        const std::string project = path("hand.tuft");
        fs::remove(project);
        const test::Ran ran = tuft("paint " + model(on) + " --strokes " + path("two.inkml") + " --brush " + brush +
                                   " --smooth 1 --atlas-size 1024 --quiet --project " + project);
        ASSERT_EQ(ran.status, 0) << ran.err;
        EXPECT_GE(overlap(project, on, "csv", "--max-acceleration 200"), 0.99) << on << ' ' << brush;
    }
}

TEST_F(Trajectories, AreWrittenInEachLanguageAndRefusedWhereTheHolderHits) {
    const std::string project = bowl();
    for (const char* name : {"a.urscript", "a.mod", "a.src", "a.csv"})
        EXPECT_EQ(tuft("trajectory " + project + " --quiet -o " + path(name)).status, 0) << name;
    EXPECT_NE(read(path("a.src")).find("DEF a( )"), std::string::npos) << "KUKA wants the file's name";
    const test::Ran lean = tuft("trajectory " + project + " -o " + path("a.gcode"));
    EXPECT_EQ(lean.status, 1);
    EXPECT_NE(lean.err.find("G-code holds it upright"), std::string::npos) << lean.err;
    // A ball of 200 mm does not go into a bowl of 150 mm.
    const test::Ran hit = tuft("trajectory " + bowl("qi-shang-ba-xia") + " --holder 200x150 -o " + path("b.json"));
    EXPECT_EQ(hit.status, 1);
    EXPECT_TRUE(std::regex_search(hit.err, std::regex("stroke [0-9]+.*the holder would hit the model at"))) << hit.err;
    EXPECT_FALSE(fs::exists(path("b.json")));
    for (const char* options : {"--tool 1,2,3", "--holder 12", "--max-speed 0", "--base a"})
        EXPECT_EQ(tuft("trajectory " + project + " -o " + path("b.json") + " " + options).status, 2) << options;
}

// The brush of a drawn line is set down leaning; a plotter stands it upright.
TEST_F(Trajectories, OfADrawingOnASheetAreWrittenForAPlotter) {
    std::ofstream(path("line.svg")) << R"(<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="20mm"
        viewBox="0 0 40 20"><path d="M5 10 Q20 2 35 10" fill="none" stroke="black" stroke-width="1"/></svg>)";
    const std::string project = path("line.tuft");
    const test::Ran painted = tuft("paint " + model("sheet.ply") + " --strokes " + path("line.svg") +
                                   " --place 0,0,0 --atlas-size 512 --areas brush --quiet --project " + project);
    ASSERT_EQ(painted.status, 0) << painted.err;
    const test::Ran ran = tuft("trajectory " + project + " -o " + path("line.gcode"));
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_TRUE(std::regex_search(ran.err, std::regex("leans of up to [0-9]+ degrees in 1 stroke are left out")))
        << ran.err;
    EXPECT_GT(fs::file_size(path("line.gcode")), 500u);
}

// A drawing whose lines are filled as areas has no path of a brush: it is said how it gets one.
TEST_F(Trajectories, OfFilledAreasNameTheOptionThatPaintsThemByStrokes) {
    write("d.svg",
          "<svg xmlns='http://www.w3.org/2000/svg' width='20mm' viewBox='0 0 20 20'><path d='M2 15L18 15' "
          "stroke='#000' stroke-width='2'/></svg>");
    const std::string paint = "paint " + model("sheet.ply") + " --strokes " + path("d.svg") +
                              " --place 0,0,0 --atlas-size 128 --quiet --project ";
    ASSERT_EQ(tuft(paint + path("areas.tuft")).status, 0);
    const test::Ran none = tuft("trajectory " + path("areas.tuft") + " -o " + path("a.csv"));
    EXPECT_EQ(none.status, 1);
    EXPECT_NE(none.err.find("--areas brush"), std::string::npos) << none.err;
    ASSERT_EQ(tuft(paint + path("strokes.tuft") + " --areas brush").status, 0);
    const test::Ran lines = tuft("trajectory " + path("strokes.tuft") + " -o " + path("a.csv"));
    EXPECT_EQ(lines.status, 0);
    EXPECT_EQ(lines.err.find("stencils"), std::string::npos) << "a line has none: " << lines.err;
}

// A robot has no stencil: ink of a filled shape goes over its edge.
TEST_F(Trajectories, OfStrokesWithinStencilsSayThatTheirEdgesAreLost) {
    write(
        "f.svg",
        "<svg xmlns='http://www.w3.org/2000/svg' width='20mm' viewBox='0 0 20 20'><path d='M8 8L12 8L10 11Z'/></svg>");
    ASSERT_EQ(tuft("paint " + model("sheet.ply") + " --strokes " + path("f.svg") +
                   " --place 0,0,0 --atlas-size 128 --quiet --areas brush --project " + path("filled.tuft"))
                  .status,
              0);
    const test::Ran filled = tuft("trajectory " + path("filled.tuft") + " -o " + path("a.csv"));
    EXPECT_EQ(filled.status, 0);
    EXPECT_NE(filled.err.find("within stencils, which a trajectory does not hold"), std::string::npos) << filled.err;
}

}  // namespace
}  // namespace tuft
