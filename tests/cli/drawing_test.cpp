#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "program.h"

/// Coloured drawings from the command line.
namespace tuft::test {
namespace {

using nlohmann::json;

class Drawing : public Program {
  protected:
    void SetUp() override {
        Program::SetUp();
        write("a.svg",
              "<svg xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' width='40mm' viewBox='0 0 40 20'>"
              "<g inkscape:groupmode='layer' inkscape:label='Stripes'><rect width='40' height='8' fill='#1b2f5a'/></g>"
              "<g id='number' class='readable'><path d='M4 10 H8 V20 H4 Z M10 10 h3 v10 h-3 z' "
              "fill='#c8402a'/></g></svg>");
        write("black.svg",
              "<svg width='20mm' viewBox='0 0 20 10'><path d='M2 5 H18' stroke='black' stroke-width='1'/></svg>");
    }

    json paint(const std::string& more) const {
        const Ran ran = tuft("paint " + model("sheet.ply") + " --atlas-size 512 --json " + more);
        EXPECT_EQ(ran.status, 0) << ran.err;
        return ran.status == 0 ? json::parse(ran.out) : json();
    }
};

TEST_F(Drawing, IsPaintedInItsColoursUnlessOneInkIsAskedFor) {
    const std::string file = "--strokes " + path("a.svg") + " --place 0,0,0 ";
    const json j = paint(file);
    EXPECT_EQ(j["areas"], 2);
    EXPECT_TRUE(j["strokes"].empty());
    ASSERT_EQ(j["inks"].size(), 2u);
    EXPECT_EQ(j["inks"][0]["ink"], "#1b2f5a");
    EXPECT_LT(j["inks"][0]["delta_e_2000"], 1.5);
    // 40 × 8 + 4 × 10 + 3 × 10 mm² of films; never more than 100 µm thick.
    EXPECT_GT(j["ink_mm3"], 390 * 0.004);
    EXPECT_LT(j["ink_mm3"], 390 * 0.1);
    const json one = paint(file + "--ink carbon");
    EXPECT_EQ(one["areas"], 0);
    EXPECT_GT(one["strokes"].size(), 0u);
    EXPECT_EQ(paint(file + "--areas mask --ink carbon")["areas"], 2);
    EXPECT_EQ(paint("--strokes " + path("black.svg") + " --place 0,0,0")["areas"], 0);
    EXPECT_EQ(paint("--strokes " + path("black.svg") + " --place 0,0,0 --areas mask")["areas"], 1);
}

TEST_F(Drawing, InBlackHasTheBitsOfABrush) {
    const std::string file = "--strokes " + path("black.svg") + " --place 0,0,0 ";
    EXPECT_EQ(paint(file)["canvas_hash"], paint(file + "--areas brush")["canvas_hash"]);
}

TEST_F(Drawing, LayersAreGroupsAndCanBePaintedAlone) {
    const std::string project = path("p.tuft");
    paint("--strokes " + path("a.svg") + " --place 30,0,0 --mirror x --readable --project " + project);
    const Ran ran = tuft("inspect " + project + " --json");
    ASSERT_EQ(ran.status, 0) << ran.err;
    for (const char* group : {"a.svg: Stripes", "a.svg: number", "a.svg: Stripes (copy)"})
        EXPECT_NE((ran.out + read(project)).find(group), std::string::npos) << group;
    EXPECT_EQ(paint("--strokes " + path("a.svg") + " --place 0,0,0 --only Stripes")["areas"], 1);
    const Ran none = tuft("paint " + model("sheet.ply") + " --only stripes --strokes " + path("a.svg"));
    EXPECT_EQ(none.status, 1);
    EXPECT_NE(none.err.find("Stripes, number"), std::string::npos) << none.err;
    EXPECT_EQ(none.error_lines(), 1);
}

TEST_F(Drawing, AMirroredSheetHasTwiceTheInk) {
    const std::string file = "--strokes " + path("a.svg") + " --place 30,0,0 ";
    const double one = paint(file)["ink_mm3"];
    EXPECT_NEAR(double(paint(file + "--mirror x")["ink_mm3"]) / one, 2, 0.01);  // texels are not symmetric
    EXPECT_NEAR(double(paint(file + "--mirror x --readable")["ink_mm3"]) / one, 2, 0.01);
    EXPECT_NEAR(double(paint("--strokes " + path("a.svg") + " --place 60,0,0 --place-width 30 --radial 4")["ink_mm3"]) /
                    double(paint("--strokes " + path("a.svg") + " --place 60,0,0 --place-width 30")["ink_mm3"]),
                4, 0.02);
}

TEST_F(Drawing, FineDetailIsSaidWithTheTexelThatItNeeds) {
    write("fine.svg",
          "<svg width='40mm' viewBox='0 0 40 20'><path d='M0 5 H40 M0 15 H40' stroke='red' stroke-width='.3'/></svg>");
    const std::string file = " --strokes " + path("fine.svg") + " --place 0,0,0 ";
    const Ran coarse = tuft("paint " + model("sheet.ply") + " --atlas-size 512" + file);
    EXPECT_EQ(coarse.status, 0);
    EXPECT_NE(coarse.err.find("texels of 0.099 mm"), std::string::npos) << coarse.err;
    const Ran fine = tuft("paint " + model("sheet.ply") + " --auto-texel --json" + file);
    ASSERT_EQ(fine.status, 0) << fine.err;
    EXPECT_EQ(fine.err.find("detail"), std::string::npos) << fine.err;
    EXPECT_NEAR(double(json::parse(fine.out)["atlas"]["texel_size_mm"]), 0.1, 0.012);
}

TEST_F(Drawing, WideLinesAreAreasAndNarrowOnesStrokes) {
    write("wide.svg",
          "<svg width='40mm' viewBox='0 0 40 20'><path d='M5 5 H35' stroke='black' stroke-width='4'/>"
          "<path d='M5 15 H35' stroke='black' stroke-width='1'/></svg>");
    const std::string file = "--strokes " + path("wide.svg") + " --place 0,0,0 ";
    const json j = paint(file);
    EXPECT_EQ(j["areas"], 1);
    EXPECT_EQ(j["strokes"].size(), 1u);
    EXPECT_EQ(paint(file + "--wide-lines 0")["areas"], 2);
    EXPECT_EQ(paint(file + "--wide-lines 5")["areas"], 0);
    EXPECT_EQ(paint(file + "--place-width 9")["areas"], 0) << "1.2 and 0.3 mm wide as painted";
    for (const char* brush : {"--areas brush", "--brush wolf-medium", "--erase", "--film wet"})
        EXPECT_EQ(paint(file + brush)["areas"], 0) << brush;
    EXPECT_EQ(paint(file + "--ink cinnabar")["areas"], 1);
}

TEST_F(Drawing, EndsBeforeEdgesWhereItIsAsked) {
    write("across.svg",
          "<svg width='300mm' viewBox='0 0 300 20'><path d='M0 10 H300' stroke='red' stroke-width='10'/></svg>");
    const std::string file = "--strokes " + path("across.svg") + " --place 0,0,0 ";
    const double cut = paint(file)["ink_mm3"], before = paint(file + "--edges end-before --edge-margin 5")["ink_mm3"];
    // The sheet is 200 mm wide, the stripe ends 5 mm before both its borders; a texel is 0.4 mm.
    EXPECT_NEAR(before / cut, 0.95, 0.004);
    EXPECT_NEAR(double(paint(file + "--edges run-over")["ink_mm3"]) / cut, 1, 0.003);
    const std::string project = path("p.tuft");
    paint(file + "--edges end-before --project " + project);
    const Ran again = tuft("replay " + project + " --project " + path("q.tuft"));
    EXPECT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(again.out.find("replayed 1 area; atlas"), 0u) << again.out;
}

// A stripe over the edge of a box: its end lies on the wall, and no ink is lost on the way.
TEST_F(Drawing, WrapsRoundAnEdgeWhereItIsAsked) {
    std::string box;
    for (const int z : {0, 60})
        for (const int y : {-30, 30})
            for (const int x : {-30, 30})
                box += "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
    write("box.obj", box + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
    write("stripe.svg", "<svg width='40mm' viewBox='0 0 40 10'><rect width='40' height='10' fill='#c8402a'/></svg>");
    const auto ink = [&](const std::string& more) {
        const Ran ran = tuft("paint " + path("box.obj") + " --unit mm --atlas-size 512 --json --strokes " +
                             path("stripe.svg") + " " + more);
        EXPECT_EQ(ran.status, 0) << ran.err;
        return double(json::parse(ran.out)["ink_mm3"]);
    };
    const double whole = ink("--place 0,0,60"), over = ink("--place 20,0,60 --mapping wrap --edges wrap");
    EXPECT_NEAR(over / whole, 1, 0.02);  // texels of 0.4 mm along 100 mm of outline, less at the edge
    EXPECT_NEAR(ink("--place 20,0,60 --edges cut") / whole, 0.75, 0.02);
}

// Two plates, one 30 mm over the other: a cut drawing stays on the one that its middle lies on, and says what it
// leaves.
TEST_F(Drawing, SaysWhatACutLeavesBare) {
    write("plates.obj",
          "v -60 -30 0\nv 0 -30 0\nv 0 30 0\nv -60 30 0\nv 10 -30 -30\nv 60 -30 -30\nv 60 30 -30\nv 10 30 -30\n"
          "f 1 2 3 4\nf 5 6 7 8\n");
    write("two.svg",
          "<svg width='100mm' viewBox='0 0 100 10'><rect width='60' height='10' fill='#c8402a'/>"
          "<rect x='75' width='20' height='10' fill='#c8402a'/></svg>");
    const auto err = [&](const std::string& more) {
        const Ran ran = tuft("paint " + path("plates.obj") + " --unit mm --atlas-size 512 --strokes " +
                             path("two.svg") + " --place=-8,0,0 --mapping project --read-from top " + more);
        EXPECT_EQ(ran.status, 0) << ran.err;
        return ran.err;
    };
    EXPECT_NE(err("--edges cut")
                  .find("1 area covers no texel of the model that is connected with the middle of the "
                        "drawing, where --edges cut begins"),
              std::string::npos);
    EXPECT_EQ(err("").find("no texel"), std::string::npos);
}

TEST_F(Drawing, SnapsToTheMiddlePlaneOfTheModel) {
    const json at = paint("--strokes " + path("a.svg") + " --place 7,20,0 --snap x")["placed"]["at_mm"];
    EXPECT_NEAR(double(at[0]), 0, 1e-6);
    EXPECT_NEAR(double(at[1]), 20, 1e-6);
    EXPECT_NEAR(double(paint("--strokes " + path("a.svg") + " --place 7,20,0")["placed"]["at_mm"][0]), 7, 1e-6);
}

// The rim of a cylinder, from its wall; a place far from any edge is refused in a line that says how far.
TEST_F(Drawing, ABandRunsAlongTheEdgeNearestToThePlace) {
    write("tile.svg", "<svg width='10mm' viewBox='0 0 10 4'><rect width='10' height='4' fill='#c8402a'/></svg>");
    const std::string on = "paint " + model("cylinder.ply") + " --atlas-size 512 --json --strokes " + path("tile.svg") +
                           " --along edge --place ";
    const Ran far = tuft(on + "0,-30,20");
    EXPECT_EQ(far.status, 1);
    EXPECT_NE(far.err.find("the nearest edge is "), std::string::npos) << far.err;
    const Ran near = tuft(on + "0,-40,3");
    ASSERT_EQ(near.status, 0) << near.err;
    EXPECT_NE(near.err.find("the line is "), std::string::npos) << near.err;
    const json placed = json::parse(near.out)["placed"];
    EXPECT_NEAR(double(placed["normal"][2]), 0, 1e-3) << "on the wall, as its place";
}

TEST_F(Drawing, ABandHasAWholeNumberOfCopiesThatMeet) {
    // A band of one colour over its whole tile: where neighbours overlap or leave a gap, ink is lacking.
    write("tile.svg", "<svg width='30mm' viewBox='0 0 30 6'><rect width='30' height='6' fill='#c8402a'/></svg>");
    const std::string on = "paint " + model("bowl.ply") + " --atlas-size 2048 --json --strokes " + path("tile.svg");
    const auto band = [&](const std::string& more) {
        const Ran ran = tuft(on + " --along rim " + more);
        EXPECT_EQ(ran.status, 0) << ran.err;
        return json::parse(ran.out);
    };
    const json fit = band("");
    const int n = fit["placed"]["repeats"];
    const double step = fit["placed"]["step_mm"], whole = fit["placed"]["path_mm"];
    EXPECT_NEAR(n * step, whole, 1e-6 * whole);
    EXPECT_EQ(n, std::lround(whole / 30));
    EXPECT_NEAR(double(fit["placed"]["width_mm"]), step, 1e-6 * step);
    EXPECT_EQ(fit["areas"], n);
    // Its height grows with its width. Neighbours that meet lap by a texel at either end: that ink is given twice.
    const double texel = fit["atlas"]["texel_size_mm"];
    const auto given = [&](const json& j, int copies, double wide) {
        return double(j["ink_mm3"]) / ((whole + 2 * copies * texel) * 6 * wide / 30);
    };
    const double film = given(fit, n, step);
    const json seven = band("--repeat 7");
    EXPECT_EQ(seven["placed"]["repeats"], 7);
    const double wide = seven["placed"]["step_mm"];
    EXPECT_NEAR(given(seven, 7, wide), film, 0.01 * film);
    EXPECT_NEAR(double(band("--repeat 8 --place-width 15")["ink_mm3"]), film * 8 * 15 * 3, 0.01 * film * 8 * 15 * 3);
    for (const char* wrong : {"--repeat 0", "--repeat none", "--repeat 1001"})
        EXPECT_EQ(tuft(on + " --along rim " + wrong).status, 2) << wrong;
    write("path.svg", "<svg width='60mm' viewBox='0 0 60 10'><path d='M0 5 H60' stroke='black' fill='none'/></svg>");
    const Ran along = tuft("paint " + model("sheet.ply") + " --atlas-size 1024 --json --strokes " + path("tile.svg") +
                           " --along " + path("path.svg") + " --place 0,0,0");
    ASSERT_EQ(along.status, 0) << along.err;
    EXPECT_EQ(json::parse(along.out)["placed"]["repeats"], 2);
    EXPECT_NEAR(double(json::parse(along.out)["placed"]["step_mm"]), 30, 0.01);
}

}  // namespace
}  // namespace tuft::test
