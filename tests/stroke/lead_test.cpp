#include "stroke/hand/lead.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "sheet.h"

namespace tuft::stroke {
namespace {

/// A straight line from x = -16 mm to 8 mm of the sheet, pressed within its first 1.5 mm, drawn under a
/// holder that leans by `tilt` (radians, to the right and down).
Stroke leaning(const std::string& brush, double pressure, const Vec2& tilt) {
    Stroke s;
    s.trace.brush = brush;
    s.trace.ink = "carbon";
    s.trace.placement = {{0, 0, 0}, {1, 0, 0}, {0, -1, 0}, Laying::wrap};
    for (int i = 0; i <= 240; ++i) {
        TraceSample p;
        p.time = 0.0025 * i;
        p.position = {-0.016 + 1e-4 * i, 0, 0};
        p.pressure = pressure * std::min(1.0, i / 15.0);
        p.tilt = tilt;
        s.trace.samples.push_back(p);
    }
    return s;
}

/// Where ink lies across the sheet, by columns of half a millimetre, metres.
struct Span {
    double lo = 1, hi = -1;
    double width() const { return hi - lo; }
};
std::map<int, Span> columns_of(const Painting& painting) {
    std::map<int, Span> columns;
    const atlas::TexelMap& map = painting.model().texels;
    for (const std::uint32_t slot : painting.canvas().touched_slots()) {
        const ink::Plane* plane = painting.canvas().plane(slot, 0);
        for (int t = 0; plane && t < atlas::kTileTexels; ++t) {
            if ((*plane)[t] < 0.2f || map.tiles[slot].area[t] <= 0) continue;
            const Vec3 p = Vec3(map.position(slot, t));
            Span& span = columns[static_cast<int>(std::floor(p.x / 5e-4))];
            span.lo = std::min(span.lo, p.y);
            span.hi = std::max(span.hi, p.y);
        }
    }
    return columns;
}

TEST(Lead, UnderALeaningHolderTheLineLiesOnItsPath) {
    const Model model = sheet();
    for (const std::string brush : {"mixed-medium", "goat-small"}) {
        for (const Vec2 tilt : {Vec2{0.6, 0}, Vec2{-0.6, 0}, Vec2{0, 0.6}, Vec2{0, -0.6}, Vec2{0.35, 0.35}}) {
            SCOPED_TRACE(brush + ", leaning " + std::to_string(tilt.x) + " " + std::to_string(tilt.y));
            Painting painting(model);
            painting.paint(leaning(brush, 0.4, tilt));
            const std::map<int, Span> columns = columns_of(painting);
            const Span& middle = columns.at(-8);
            int first = 99, last = -99;
            for (const auto& [k, span] : columns) {
                if (span.width() < 0.9 * middle.width()) continue;
                first = std::min(first, k);
                last = std::max(last, k);
            }
            // The path runs from column -32 to 16. Under an upright holder's lead the full width began 5 mm
            // late and went on 6 mm beyond; what is left are the press and the grid of leans.
            EXPECT_NEAR(first, -31, 3);
            EXPECT_NEAR(last, 17, 3);
            EXPECT_NEAR(0.5 * (middle.lo + middle.hi), 0, 0.07 * middle.width());
        }
    }
}

TEST(Lead, AnUprightHolderLeadsAsBeforeAndSidesMirror) {
    LeanedLead lead(brush::load_preset("goat-small"));
    const double depth = 0.3 * working_depth(brush::load_preset("goat-small"));
    EXPECT_EQ(lead.at(depth, {0.03, -0.03}), Vec2(0));
    EXPECT_EQ(lead.at(0, {0.5, 0.5}), Vec2(0));
    const Vec2 left = lead.at(depth, {0.3, 0.5}), right = lead.at(depth, {0.3, -0.5});
    EXPECT_EQ(left, Vec2(right.x, -right.y));
    // Hair pulled behind a holder that leans ahead trails it less than an upright one's.
    EXPECT_LT(lead.at(depth, {0.6, 0}).x, -1e-3);
    EXPECT_EQ(lead.at(depth, {0.6, 0}).y, 0);
}

}  // namespace
}  // namespace tuft::stroke
