#include "stroke/journal/fit.h"

#include <gtest/gtest.h>

#include "sheet.h"

namespace tuft::stroke {
namespace {

constexpr double kDepth = 2e-3;

std::string reason_on(const Model& revised, const Stroke& stroke) {
    const Model former = sheet();
    Painting painting(revised);
    const auto reports = painting.replay({stroke});
    const auto length_of = [&](const std::string& brush) { return painting.brush(brush).length; };
    const auto misfits = find_misfits(reports, compare_fit(painting.journal().strokes(), length_of, *former.query, *revised.query));
    EXPECT_LE(misfits.size(), 1u);
    return misfits.empty() ? "" : misfits.front().reason;
}

Stroke pressed() {
    Stroke s = line("wolf-small", kDepth);
    s.id = 1;
    return s;
}

Model lifted(double by) { return sheet(make_frame({0, 0, by}, {0, 0, 1})); }

TEST(Fit, TheSameModelFitsAndSoDoesOneALittleOff) {
    EXPECT_EQ(reason_on(sheet(), pressed()), "");
    EXPECT_EQ(reason_on(lifted(0.3 * kDepth), pressed()), "");
}

// The straight tuft of the stroke reaches 2 mm into the sheet for most of its way.
TEST(Fit, ASurfaceThatMovedIsToldByItsDistance) {
    EXPECT_EQ(reason_on(lifted(3e-3), pressed()), "pressed 3.0 mm deeper");
    EXPECT_EQ(reason_on(lifted(-1.5e-3), pressed()), "pressed 1.5 mm less deep");
    EXPECT_EQ(reason_on(lifted(-12e-3), pressed()), "touches nothing, 10.0 mm away");
    EXPECT_EQ(reason_on(lifted(brush::load_preset("wolf-small").length + 1e-3), pressed()), "100 % of it lies inside the model");
}

// A sheet that ends under the middle of the stroke, which goes 15 mm to both sides of it.
TEST(Fit, APartThatIsGoneIsToldByItsShare) {
    const Model half = sheet(make_frame({0.5 * kSide, 0, 0}, {0, 0, 1}));
    const std::string reason = reason_on(half, pressed());
    ASSERT_TRUE(reason.ends_with(" % of it touches nothing")) << reason;
    EXPECT_NEAR(std::stod(reason), 50, 3);  // a sample of the hand is 1 % of the way
}

TEST(Fit, AStrokeInTheAirIsNoMisfit) {
    Stroke above = pressed();
    for (TraceSample& s : above.trace.samples) s.position.z += 0.2;
    EXPECT_EQ(reason_on(lifted(-5e-3), above), "");
}

}  // namespace
}  // namespace tuft::stroke
