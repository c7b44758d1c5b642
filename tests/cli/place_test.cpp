#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "program.h"

/// Where drawings go that say no place, and which way up the model is.
namespace tuft::test {
namespace {

using nlohmann::json;

class Place : public Program {
  protected:
    // A box of 80 x 60 x 40 mm about the origin, in millimetres with z up, or with y up.
    static std::string box(bool y_up) {
        std::ostringstream obj;
        for (const int z : {-20, 20})
            for (const int y : {-30, 30})
                for (const int x : {-40, 40}) {
                    if (y_up)
                        obj << "v " << x << ' ' << z << ' ' << -y << '\n';
                    else
                        obj << "v " << x << ' ' << y << ' ' << z << '\n';
                }
        obj << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
        return obj.str();
    }

    // Two lines, `width` wide and a quarter as high, from (x, y) on, in the file's own numbers.
    static std::string lines(double x, double y, double width) {
        std::ostringstream ink;
        ink << "<ink xmlns=\"http://www.w3.org/2003/InkML\">";
        for (const double below : {0.0, 0.25}) {
            ink << "<trace>";
            for (int i = 0; i <= 16; ++i) ink << (i ? ", " : "") << x + width * i / 16 << ' ' << y + width * below;
            ink << "</trace>";
        }
        return ink.str() + "</ink>";
    }

    /// What `paint --preview` shows of lines.inkml put there.
    std::string picture_of(const std::string& model, const std::string& place, const std::string& view) {
        const Ran ran = tuft("paint " + path(model) + " --brush wolf-small --atlas-size 256 --place " + place +
                             " --size 64x64 --strokes " + path("lines.inkml") + " --preview " + path("v.png") + view);
        EXPECT_EQ(ran.status, 0) << ran.err;
        return read(path("v.png"));
    }

    struct Reach {
        std::array<double, 3> low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
        double size(int axis) const { return high[axis] - low[axis]; }
        double middle(int axis) const { return 0.5 * (high[axis] + low[axis]); }
    };

    // Where the ferrule went, mm.
    Reach painted(const std::string& file, const std::string& more) const {
        const Ran ran = tuft("paint " + path("box.obj") + " --brush wolf-small --atlas-size 256 --strokes " +
                             path(file) + " --forces " + path("f.csv") + " " + more);
        EXPECT_EQ(ran.status, 0) << ran.err;
        Reach reach;
        std::istringstream csv(read(path("f.csv")));
        std::string line;
        std::getline(csv, line);
        while (std::getline(csv, line)) {
            std::replace(line.begin(), line.end(), ',', ' ');
            std::istringstream row(line);
            double stroke = 0, time = 0;
            row >> stroke >> time;
            for (int axis = 0; axis < 3; ++axis) {
                double v = 0;
                row >> v;
                reach.low[axis] = std::min(reach.low[axis], 1e3 * v);
                reach.high[axis] = std::max(reach.high[axis], 1e3 * v);
            }
        }
        return reach;
    }
};

// The path is resampled at a texel or so, 0.5 mm here.
constexpr double kStep = 0.5;

TEST_F(Place, ADrawingLiesWithItsMiddleAtThePlaceAsWideAsAsked) {
    write("box.obj", box(false));
    write("lines.inkml", lines(9000, -4000, 10));
    const Reach plain = painted("lines.inkml", "--place 10,0,20");
    // The ferrule is ahead of the ink at the end and, where it is set down, on its way there: by no more than hair lies
    // down.
    const double lag = plain.size(0) - 10;
    EXPECT_LT(std::abs(lag), 5) << "about what of the hair lies down";
    // The ferrule leans away from the tip: where it is shows against a drawing about the origin.
    write("about.inkml", lines(-5, -1.25, 10));
    const Reach about = painted("about.inkml", "--place 0,0,20");
    EXPECT_NEAR(plain.middle(0), 10 + about.middle(0), kStep);
    EXPECT_NEAR(plain.middle(1), about.middle(1), kStep);
    const Reach wide = painted("lines.inkml", "--place 10,0,20 --place-width 40");
    EXPECT_NEAR(wide.size(0), 40 + lag, kStep);
    EXPECT_NEAR(wide.size(1), 10, kStep);
    const Reach turned = painted("lines.inkml", "--place 10,0,20 --place-width 40 --place-turn 90");
    EXPECT_NEAR(turned.size(0), 10, kStep);
    EXPECT_NEAR(turned.size(1), 40 + lag, kStep);
    EXPECT_NEAR(turned.middle(1), about.middle(0), kStep) << "the lean turns too";
}

TEST_F(Place, TheWidthAskedForIsThatOfTheInk) {
    write("box.obj", box(false));
    write("thick.svg",
          "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 30 10' width='30mm'><path d='M5 5 h20' fill='none' "
          "stroke='#000' stroke-width='4'/></svg>");
    // 20 of line, 2 of ink beyond each end of a brush's.
    const Reach own = painted("thick.svg", "--areas brush --place 0,0,20");
    const Reach asked = painted("thick.svg", "--areas brush --place 0,0,20 --place-width 24");
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(own.size(axis), asked.size(axis), 1e-6) << "the scale is 1 but for rounding";
}

// With --brush the size stays, and the way out is named; with --fit-brush it was tried already.
TEST_F(Place, LinesThatABrushCannotDrawAreReportedWithWhatHelps) {
    write("box.obj", box(false));
    write("d.svg",
          "<svg xmlns='http://www.w3.org/2000/svg' width='30mm' height='10mm' viewBox='0 0 30 10'>"
          "<path d='M1,5 H29' fill='none' stroke='#000' stroke-width='0.001'/></svg>");
    const std::string paint = "paint " + path("box.obj") +
                              " --unit mm --up z --atlas-size 256 --areas brush --strokes " + path("d.svg") +
                              " --place-width 28 --brush goat-large ";
    const std::string chosen = tuft(paint).err, fitted = tuft(paint + "--fit-brush").err;
    EXPECT_NE(chosen.find("goat-large does not draw"), std::string::npos) << chosen;
    EXPECT_NE(chosen.find("--fit-brush takes a size of it that fits"), std::string::npos) << chosen;
    EXPECT_NE(fitted.find("does not draw"), std::string::npos) << fitted;
    EXPECT_NE(fitted.find("no size of it fits"), std::string::npos) << fitted;
}

TEST_F(Place, ADrawingFarLargerThanTheModelIsReported) {
    write("box.obj", box(false));  // 108 mm across
    write("lines.inkml", lines(0, 0, 10));
    for (const auto& [width, reported] : {std::pair{"300", false}, {"400", true}}) {
        const Ran ran = tuft("paint " + path("box.obj") + " --atlas-size 256 --strokes " + path("lines.inkml") +
                             " --place 0,-30,0 --place-width " + width);
        EXPECT_EQ(ran.status, 0) << ran.err;
        EXPECT_EQ(ran.err.find("the model is 108 mm across, the drawing 412 mm") != std::string::npos, reported)
            << ran.err;
    }
}

// The box is 107.7 mm across: a place read off a drawing may be out by 5 % of that. The drawing goes to the nearest
// place of the surface, and the place inside has a warning of its own.
TEST_F(Place, APlaceBesideTheModelIsToldWithItsDistance) {
    write("box.obj", box(false));
    write("lines.inkml", lines(0, 0, 10));
    const auto reported = [&](const std::string& place) {
        const Ran ran = tuft("paint " + path("box.obj") + " --brush wolf-small --atlas-size 256 --strokes " +
                             path("lines.inkml") + " --place " + place + " --json");
        EXPECT_EQ(ran.status, 0) << ran.err;
        const json placed = json::parse(ran.out)["placed"];
        EXPECT_NEAR(placed["at_mm"][1].get<double>(), -30, 1e-4) << "the front; single precision of metres";
        return ran.err;
    };
    EXPECT_EQ(reported("0,-30,0").find("the model"), std::string::npos);
    EXPECT_EQ(reported("0,-35.3,0").find("beside the model"), std::string::npos) << "4.9 %";
    EXPECT_NE(reported("0,-35.5,0").find("lies 5.5 mm beside the model"), std::string::npos) << "5.1 %";
    EXPECT_NE(reported("5,-1030,0")
                  .find("warning: --place 5,-1030,0 lies 1000.0 mm beside the model; the drawing goes to "
                        "the nearest place of its surface, 5.0,-30.0,0.0 mm"),
              std::string::npos);
    EXPECT_NE(reported("0,-20,0").find("lies 10.00 mm inside the model"), std::string::npos);
}

TEST_F(Place, ADrawingWithoutPlaceFitsTheFront) {
    write("box.obj", box(false));
    write("device.inkml", lines(12000, 3000, 8000));  // a tablet's own units, read as millimetres
    const Reach reach = painted("device.inkml", "");
    write("fits.inkml", lines(0, 0, 30));
    const Reach fits = painted("fits.inkml", "");
    const double lag = fits.size(0) - 30;
    // The ferrule is ahead of the ink at the end and, where it is set down, on its way there: by no more than hair lies
    // down.
    EXPECT_LT(std::abs(lag), 5) << "what fits stays as it is written";
    EXPECT_NEAR(reach.size(0), 48 + lag, kStep) << "six tenths of the front";
    EXPECT_LT(reach.high[1], -30 + 1e-3) << "before the front";
    EXPECT_NEAR(reach.middle(0), fits.middle(0), kStep);
}

TEST_F(Place, WhatLiesFlatIsWrittenOnFromAbove) {
    write("box.obj",
          "v -40 -30 0\nv 40 -30 0\nv 40 30 0\nv -40 30 0\nv -40 -30 2\nv 40 -30 2\nv 40 30 2\nv -40 30 2\n"
          "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
    write("lines.inkml", lines(0, 0, 20));
    EXPECT_GT(painted("lines.inkml", "").low[2], 2) << "over the top";
}

TEST_F(Place, ADrawingOnASlopeIsShownUpright) {
    // The lid falls by 18 degrees to the back; the drawing stands upright seen from the front.
    write("lid.obj",
          "v -40 -30 0\nv 40 -30 0\nv 40 30 0\nv -40 30 0\nv -40 -30 40\nv 40 -30 40\nv 40 30 20\nv -40 30 20\n"
          "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
    write("lines.inkml", lines(0, 0, 20));
    EXPECT_EQ(picture_of("lid.obj", "0,5,28", ""), picture_of("lid.obj", "0,5,28", " --view 0,80"));
    EXPECT_EQ(picture_of("lid.obj", "0,5,28 --place-turn 30", ""),
              picture_of("lid.obj", "0,5,28 --place-turn 30", " --view 0,80"));
    EXPECT_EQ(picture_of("lid.obj", "0,5,28 --place-turn 90", ""),
              picture_of("lid.obj", "0,5,28 --place-turn 90", " --view 90,80"));
}

TEST_F(Place, TheUnitIsGuessedWhereNothingSaysIt) {
    // A box of 0.6 x 0.06 x 0.04: metres, as `inspect` says too.
    std::string metres = box(false);
    std::istringstream in(metres);
    std::string out, line;
    while (std::getline(in, line)) {
        std::istringstream words(line);
        std::string tag;
        double x = 0, y = 0, z = 0;
        if (words >> tag >> x >> y >> z && tag == "v")
            line = "v " + std::to_string(x / 100) + " " + std::to_string(y / 100) + " " + std::to_string(z / 100);
        out += line + "\n";
    }
    write("metres.obj", out);
    write("lines.inkml", lines(0, 0, 30));
    const std::string paint =
        "paint " + path("metres.obj") + " --atlas-size 256 --strokes " + path("lines.inkml") + " --place 0,-300,0";
    const Ran guessed = tuft(paint + " --export " + path("out.glb"));
    const std::string guessed_model = read(path("out.glb"));
    EXPECT_EQ(guessed.status, 0) << guessed.err;
    EXPECT_NE(guessed.err.find("look like metres"), std::string::npos) << guessed.err;
    const Ran reported = tuft(paint + " --unit m --export " + path("out.glb"));
    EXPECT_EQ(reported.status, 0) << reported.err;
    EXPECT_EQ(reported.err.find("look like"), std::string::npos) << reported.err;
    EXPECT_TRUE(guessed_model == read(path("out.glb")));
}

TEST_F(Place, BrushesOfTheFileGrowWithTheDrawing) {
    write("box.obj", box(false));
    std::string ink = lines(0, 0, 40);
    ink.insert(ink.find("</ink>"), "</traceGroup>");
    ink.insert(ink.find("<trace>"), "<traceGroup><annotation type=\"tuft:brush\">goat-small</annotation>");
    write("named.inkml", ink);
    write("bare.inkml", lines(0, 0, 40));
    const auto brush_of = [&](const std::string& file, const std::string& more) {
        const Ran ran = tuft("paint " + path("box.obj") + " --atlas-size 256 --strokes " + path(file) +
                             " --place 0,-30,0 --project " + path("p.tuft") + " " + more);
        EXPECT_EQ(ran.status, 0) << ran.err;
        return json::parse(tuft("inspect " + path("p.tuft") + " --json").out)["strokes"][0]["brush"].get<std::string>();
    };
    EXPECT_EQ(brush_of("named.inkml", ""), "goat-small");
    EXPECT_EQ(brush_of("named.inkml", "--place-width 20"), "goat-small*0.5");
    EXPECT_EQ(brush_of("named.inkml", "--place-width 20 --brush wolf-small"), "wolf-small");
    EXPECT_EQ(brush_of("bare.inkml", "--place-width 60"), "wolf-medium");
    EXPECT_EQ(brush_of("bare.inkml", "--place-width 15"), "wolf-medium*0.25")
        << "60 mm of writing suit the whole brush";
}

TEST_F(Place, WhatHasNoPlaceIsDraped) {
    write("box.obj", box(false));
    write("lines.inkml", lines(0, 0, 30));
    const Reach by_itself = painted("lines.inkml", "");
    const Reach drape = painted("lines.inkml", "--laying drape");
    const Reach project = painted("lines.inkml", "--laying project");
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(by_itself.low[axis], drape.low[axis]) << "what has no place is draped";
        EXPECT_NEAR(project.low[axis], drape.low[axis], kStep) << "on a flat front all are the same";
    }
    EXPECT_EQ(tuft("paint " + path("box.obj") + " --strokes " + path("lines.inkml") + " --laying hung").status, 2);
}

TEST_F(Place, APictureIsTakenFromTheSideThatIsPaintedOn) {
    write("box.obj", box(false));
    write("lines.inkml", lines(0, 0, 30));
    const auto picture = [&](const std::string& view) { return picture_of("box.obj", "0,30,0", view); };
    const std::string by_itself = picture("");
    EXPECT_EQ(by_itself, picture(" --view 180,10"));
    EXPECT_NE(by_itself, picture(" --view 0,10"));
}

// Straight at a wall that leans out would be from below the ground it stands on.
TEST_F(Place, AWallThatLeansOutIsLookedAtFromAboveTheGround) {
    std::ostringstream obj;  // a trough: its front leans out by 37 degrees
    for (const int z : {-20, 20})
        for (const int y : {-1, 1})
            for (const int x : {-40, 40}) obj << "v " << x << ' ' << y * (z < 0 ? 20 : 50) << ' ' << z << '\n';
    write("trough.obj", obj.str() + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
    write("lines.inkml", lines(0, 0, 30));
    const auto picture = [&](const std::string& view) { return picture_of("trough.obj", "0,-35,0", view); };
    const std::string by_itself = picture("");
    EXPECT_EQ(by_itself, picture(" --view 0,5"));
    EXPECT_NE(by_itself, picture(" --view 0,-27"));
}

TEST_F(Place, AFileWithYUpIsTheSameModelStandingUpAndGoesBackAsItCame) {
    write("z.obj", box(false));
    write("y.obj", box(true));
    write("lines.inkml", lines(0, 0, 30));
    const auto paint = [&](const std::string& file, const std::string& more) {
        const Ran ran = tuft("paint " + path(file) + " --brush wolf-small --atlas-size 256 --strokes " +
                             path("lines.inkml") + " --json --project " + path("p.tuft") + more);
        EXPECT_EQ(ran.status, 0) << ran.err;
        return json::parse(ran.out)["canvas_hash"].get<std::string>();
    };
    const auto points = [&](const std::string& file) {
        std::istringstream obj(read(path(file)));
        std::vector<std::array<double, 3>> found;
        for (std::string line; std::getline(obj, line);)
            if (line.starts_with("v ")) {
                std::istringstream row(line.substr(2));
                std::array<double, 3> p{};
                row >> p[0] >> p[1] >> p[2];
                for (double& v : p) v = std::round(v * 1e4) / 1e4 + 0.0;
                found.push_back(p);
            }
        return found;
    };
    const std::string standing = paint("z.obj", "");
    EXPECT_NE(paint("y.obj", ""), standing);
    EXPECT_EQ(paint("y.obj", " --up y"), standing);
    // From the project again, and on a revised file in the same frame.
    ASSERT_EQ(tuft("export " + path("p.tuft") + " -o " + path("back.obj")).status, 0);
    EXPECT_EQ(points("back.obj"), points("y.obj"));
    const Ran replayed =
        tuft("replay " + path("p.tuft") + " --model " + path("y.obj") + " --json --export " + path("again.obj"));
    ASSERT_EQ(replayed.status, 0) << replayed.err;
    EXPECT_EQ(json::parse(replayed.out)["canvas_hash"], standing);
    EXPECT_EQ(points("again.obj"), points("y.obj"));
    EXPECT_EQ(tuft("unwrap " + path("y.obj") + " --up y -o " + path("u.obj")).status, 0);
    EXPECT_EQ(points("u.obj"), points("y.obj"));
    EXPECT_EQ(tuft("inspect " + path("y.obj") + " --up x").status, 2);
}

TEST_F(Place, ADrawingGoesToTheSideThatIsNamedAndSaysWhatWasChosen) {
    write("box.obj", box(false));
    write("lines.inkml", lines(0, 0, 8000));  // far too large
    const std::map<std::string, std::array<double, 3>> sides{{"front", {0, -30, 0}}, {"back", {0, 30, 0}},
                                                             {"left", {-40, 0, 0}},  {"right", {40, 0, 0}},
                                                             {"top", {0, 0, 20}},    {"bottom", {0, 0, -20}}};
    for (const auto& [side, at] : sides) {
        const Ran ran = tuft("paint " + path("box.obj") + " --brush wolf-small --atlas-size 256 --strokes " +
                             path("lines.inkml") + " --on " + side + " --json");
        ASSERT_EQ(ran.status, 0) << ran.err;
        const json placed = json::parse(ran.out)["placed"];
        EXPECT_EQ(placed["side"], side);
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(placed["at_mm"][k].get<double>(), at[k], 0.7) << side << ": a cell of 129";
        const double across = side == "left" || side == "right" ? 60 : 80;
        EXPECT_NEAR(placed["free_mm"][0].get<double>(), across, 1.3) << side;
        EXPECT_NEAR(placed["part"].get<double>(), 0.6, 1e-9);
        // The side of the drawing that fills the free area more takes the part; the other follows, off by what a cell
        // of 129 is of it.
        const auto taken = [&](const char* size, int axis) {
            return placed[size].get<double>() / placed["free_mm"][axis].get<double>();
        };
        EXPECT_NEAR(std::max(taken("width_mm", 0), taken("height_mm", 1)), 0.6, 1e-6) << side;
        EXPECT_GT(std::min(taken("width_mm", 0), taken("height_mm", 1)), 0.6 * (1 - 1 / 30.0))
            << side << ": 32 cells high";
        EXPECT_NE(ran.err.find("the " + side + " of the model"), std::string::npos) << ran.err;
        EXPECT_NE(ran.err.find("of which they take 60 %"), std::string::npos) << ran.err;
    }
    const Ran none =
        tuft("paint " + path("box.obj") + " --atlas-size 256 --strokes " + path("lines.inkml") + " --on inside");
    EXPECT_EQ(none.status, 1) << "a closed box has no inside";
    EXPECT_NE(none.err.find("no calm area is found on its inside"), std::string::npos) << none.err;
    EXPECT_EQ(tuft("paint " + path("box.obj") + " --strokes " + path("lines.inkml") + " --on lid").status, 2);
    EXPECT_EQ(tuft("paint " + path("box.obj") + " --strokes " + path("lines.inkml") + " --on top --place 0,0,0").status,
              2);
}

TEST_F(Place, TheReadersDirectionSaysWhichWayUpItIs) {
    write("box.obj", box(false));
    write("lines.inkml", lines(0, 0, 30));
    // Up to the lag of the hand, as in the tests above.
    const Reach front = painted("lines.inkml", "--on top"), left = painted("lines.inkml", "--on top --read-from left"),
                back = painted("lines.inkml", "--on top --read-from 0,1,0.5");
    EXPECT_NEAR(left.size(1), front.size(0), kStep) << "the lines go from back to front";
    EXPECT_NEAR(left.size(0), front.size(1), kStep);
    EXPECT_NEAR(back.size(0), front.size(0), kStep);
    EXPECT_NEAR(back.middle(0), -front.middle(0), kStep) << "turned half round";
    EXPECT_EQ(painted("lines.inkml", "--on top --read-from front").low, front.low);
    // Straight away from the reader, onto whatever lies there.
    const Reach slant = painted("lines.inkml", "--place 0,-30,10 --laying project --read-from 0,-1,1");
    EXPECT_NEAR(slant.size(0), front.size(0), kStep);
    EXPECT_EQ(tuft("paint " + path("box.obj") + " --strokes " + path("lines.inkml") + " --read-from nowhere").status,
              2);
    EXPECT_EQ(tuft("paint " + path("box.obj") + " --strokes " + path("lines.inkml") + " --read-from 0,0,0").status, 2);
}

TEST_F(Place, TheInsideOfABowlIsWithinItsWalls) {
    write("lines.inkml", lines(0, 0, 8000));
    const Ran ran =
        tuft("paint " + source_folder() + "/models/bowl.ply --brush wolf-small --atlas-size 256 --strokes " +
             path("lines.inkml") + " --on inside --json");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const json placed = json::parse(ran.out)["placed"];
    EXPECT_GT(placed["normal"][2].get<double>(), 0.9);
    EXPECT_LT(std::hypot(placed["at_mm"][0].get<double>(), placed["at_mm"][1].get<double>()), 6)
        << "its middle, within a few of 129 cells";
}

}  // namespace
}  // namespace tuft::test
