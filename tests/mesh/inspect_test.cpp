#include "mesh/repair/inspect.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh_checks.h"

namespace tuft::mesh {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

UnitGuess guess(double x, double y, double z) {
    Box box;
    box.add(Vec3(0));
    box.add({x, y, z});
    return guess_unit(box);
}

TEST(GuessUnit, ThingsPeoplePaintAreRecognised) {
    EXPECT_EQ(guess(165, 165, 72).unit, "mm");      // a bowl
    EXPECT_EQ(guess(4600, 1850, 1400).unit, "mm");  // a car
    EXPECT_EQ(guess(4.6, 1.85, 1.4).unit, "m");
    EXPECT_EQ(guess(460, 185, 140).unit, "mm");  // a model of one
    EXPECT_EQ(guess(0.165, 0.165, 0.072).unit, "m");
    EXPECT_EQ(guess(16.5, 16.5, 7.2).unit, "cm");
    EXPECT_NE(guess(16.5, 16.5, 7.2).second, "");  // two centimetres are possible too
    EXPECT_THAT(guess(165, 165, 72).sentence, HasSubstr("165 x 165 x 72.0 mm"));
    EXPECT_DOUBLE_EQ(guess(4.6, 1.85, 1.4).metres_per_unit, 1);
}

// A mug of 81 x 81 x 97 mm in inches has the numbers of a small lorry in metres.
TEST(GuessUnit, NamesEachUnitThatMakesAUsualSize) {
    const std::string mug = guess(3.2, 3.2, 3.8).sentence;
    EXPECT_THAT(mug, HasSubstr("metres: the model would be 3200 x 3200 x 3800 mm"));
    EXPECT_THAT(mug, HasSubstr("centimetres 32.0 x 32.0 x 38.0 mm (cm)"));
    EXPECT_THAT(mug, HasSubstr("inches 81.3 x 81.3 x 96.5 mm (in)"));
    EXPECT_EQ(mug.find("millimetres"), std::string::npos) << "3 mm are no usual size";
    EXPECT_EQ(guess(165, 165, 72).sentence.find("possible"), std::string::npos) << "a bowl in millimetres";
}

TEST(GuessUnit, SenselessSizesFallBackToMillimetres) {
    EXPECT_EQ(guess(0, 0, 0).unit, "mm");
    EXPECT_EQ(guess(1e-9, 1e-9, 0).unit, "mm");
    EXPECT_EQ(guess(1e20, 1, 1).unit, "mm");
    EXPECT_EQ(guess_unit(Box{}).unit, "mm");
    EXPECT_EQ(guess(1e20, 1, 1).sentence.find('\n'), std::string::npos);
}

TEST(Inspect, ReportsSizeAndNoDefectsOfASoundBox) {
    const Surface s = build_surface(make_box(Vec3(0), Vec3(100, 200, 50)));
    const MeshSummary m = summarise(s, 1e-3);
    EXPECT_EQ(m.n_triangles, 12u);
    // Float coordinates: 6e-8 relative.
    EXPECT_NEAR(m.volume, 1e-3, 1e-3 * 3e-7);
    EXPECT_NEAR(m.area, 0.07, 0.07 * 3e-7);
    EXPECT_NEAR(m.longest_edge, std::hypot(0.1, 0.2), 1e-7);
    EXPECT_EQ(m.unit.unit, "mm");
    const std::vector<std::string> lines = describe(m);
    EXPECT_THAT(lines, Contains("12 triangles, 8 vertices (in the file 6 faces, 8 vertices)"));
    EXPECT_THAT(lines, Contains("size 100 x 200 x 50.0 mm, area 700 cm², volume 1000 cm³"));
    EXPECT_THAT(lines, Contains("1 part, closed"));
    EXPECT_THAT(lines, Contains("no defects"));
    EXPECT_THAT(lines, Not(Contains(HasSubstr("tuft decimate"))));
}

TEST(Inspect, OffersALightCopyOfALargeScan) {
    MeshSummary m = summarise(build_surface(make_box(Vec3(0), Vec3(100, 200, 50))), 1e-3);
    m.n_triangles = 20'000'000;
    EXPECT_THAT(describe(m), Contains(HasSubstr("'tuft decimate' makes a light copy")));
}

TEST(Inspect, ReportsEveryDefectOnce) {
    PolygonSoup soup = make_sheet(4);
    soup.points.emplace_back(2, 1.5, 1);
    add_polygon(soup, {7, 12, 25});
    add_polygon(soup, {0, 0, 1});
    add_polygon(soup, {0, 1, 6});
    std::swap(soup.corners[3], soup.corners[4]);
    soup.points.emplace_back(9, 9, 9);
    soup.points.push_back(soup.points[0]);
    add_polygon(soup, {27, 5, 6});
    soup.warnings = {"from the reader"};
    const Surface s = build_surface(soup, {.metres_per_unit = 1e-3});
    EXPECT_THAT(texts(describe_defects(s.report)),
                ElementsAre("1 vertex lay on another one: welded", "1 vertex is used by no face: dropped",
                            "1 face without an area: dropped", HasSubstr("there twice"),
                            "1 edge with more than two faces: split", "1 face showed its back: turned round",
                            "from the reader"));
}

TEST(Inspect, WarnsWhenTheUnitLooksWrong) {
    const Surface s = build_surface(make_box(Vec3(0), Vec3(0.2)), {.metres_per_unit = 1e-3});
    EXPECT_THAT(describe(summarise(s, 1e-3)), Contains(HasSubstr("check --unit")));
    // A mug in inches, whose numbers look like metres: a person who says so knows it.
    const double inch = 25.4e-3;
    const Surface mug = build_surface(make_box(Vec3(0), Vec3(3.2, 3.2, 3.8)), {.metres_per_unit = inch});
    EXPECT_NE(summarise(mug, inch).unit.unit, "in");
    EXPECT_THAT(describe(summarise(mug, inch)), Not(Contains(HasSubstr("check --unit"))));
}

}  // namespace
}  // namespace tuft::mesh
