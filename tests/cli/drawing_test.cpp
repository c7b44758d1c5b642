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

}  // namespace
}  // namespace tuft::test
