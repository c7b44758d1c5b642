#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "brush/preset/preset.h"
#include "brush/tuft/tuft.h"
#include "footprint/outline/cuts.h"
#include "footprint/outline/outline.h"

namespace tuft::footprint {
namespace {

constexpr double kCell = 5e-5;
const Frame kFlat;

/// A flat dragged over the plane along −y on its broad side, leaning ahead, wet or dry.
brush::TuftState dragged(const std::string& name, double wet = 1) {
    brush::Tuft tuft = brush::make_tuft(brush::load_preset(name), 5);
    tuft.wetness = tuft.ink_left = wet;
    brush::TuftState state;
    const brush::ContactPlane ground;
    const double length = tuft.preset.length;
    for (int i = 0; i <= 90; ++i) {
        brush::Pose pose;
        pose.rotation = glm::angleAxis(0.4, Vec3{1, 0, 0});
        pose.position = {0, -2e-4 * std::max(0, i - 30),
                         length * std::cos(0.4) - 0.2 * length * std::min(1.0, i / 30.0)};
        state = brush::step(tuft, pose, std::span(&ground, 1), 1e-3);
    }
    return state;
}

double coverage_area(const Footprint& f) {
    double sum = 0;
    for (const std::uint8_t c : f.coverage) sum += c / 255.0;
    return sum * f.cell * f.cell;
}

/// For each column of the picture over the middle `part` of its width: where coverage begins and ends, metres.
struct Rim {
    std::vector<double> lo, hi;
    double width = 0;
};
Rim rim_of(const Footprint& f, double part) {
    std::vector<std::pair<double, double>> all;
    for (int x = 0; x < f.width; ++x) {
        double lo = 1e9, hi = -1e9;
        for (int y = 0; y < f.height; ++y) {
            if (f.coverage[static_cast<std::size_t>(y) * f.width + x] < 128) continue;
            lo = std::min(lo, f.lo.y + (y + 0.5) * f.cell);
            hi = std::max(hi, f.lo.y + (y + 0.5) * f.cell);
        }
        if (hi >= lo) all.emplace_back(lo, hi);
    }
    Rim out;
    out.width = static_cast<double>(all.size()) * f.cell;
    const auto skip = static_cast<std::size_t>(0.5 * (1 - part) * static_cast<double>(all.size()));
    for (std::size_t i = skip; i + skip < all.size(); ++i) {
        out.lo.push_back(all[i].first);
        out.hi.push_back(all[i].second);
    }
    return out;
}

double spread(const std::vector<double>& v) {
    const auto [lo, hi] = std::minmax_element(v.begin(), v.end());
    return *hi - *lo;
}

/// A flat's patch is as wide as the brush, in one piece, and its front edge and tail are straight: no lobe of a spine
/// stands out.
TEST(WideOutline, FlatHasAStraightEdge) {
    const brush::TuftState tuft = dragged("flat-12");
    const std::vector<Outline> outlines = outlines_of(tuft, kFlat);
    const Footprint f = rasterise(outlines, kFlat, 0, kCell);
    const Rim rim = rim_of(f, 0.7);
    EXPECT_NEAR(rim.width, 12e-3, 1.5e-3);
    // A spine is 2.4 mm wide; lobes of ellipses would stand out by a millimetre.
    EXPECT_LT(spread(rim.lo), 0.15e-3);
    EXPECT_LT(spread(rim.hi), 0.15e-3);
    // In one piece: columns are covered from edge to edge.
    double filled = 0;
    for (std::size_t i = 0; i < rim.lo.size(); ++i) filled += (rim.hi[i] - rim.lo[i] + f.cell) * f.cell;
    EXPECT_NEAR(filled / coverage_area(f), 0.7, 0.1);
}

/// A filbert's toe is round: its middle touches further ahead than its edges, as a mirror image.
TEST(WideOutline, FilbertHasARoundToe) {
    const brush::TuftState tuft = dragged("filbert-12");
    const Footprint f = rasterise(outlines_of(tuft, kFlat), kFlat, 0, kCell);
    const Rim rim = rim_of(f, 0.9);
    // The hair trails towards +y.
    const std::size_t n = rim.hi.size();
    EXPECT_GT(rim.hi[n / 2], rim.hi.front() + 0.5e-3);
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(rim.hi[i], rim.hi[n - 1 - i], 3 * kCell);
}

/// Spines that are not joined keep outlines of their own; joined ones get one more between two.
TEST(WideOutline, OutlinesFollowTheOpenings) {
    brush::TuftState tuft = dragged("flat-12");
    const std::size_t joined = outlines_of(tuft, kFlat).size();
    EXPECT_EQ(joined, 5u + 4u);
    const double whole = coverage_area(rasterise(outlines_of(tuft, kFlat), kFlat, 0, kCell));
    for (std::vector<double>& row : tuft.openings)
        for (double& o : row) o = 1e-3;
    EXPECT_EQ(outlines_of(tuft, kFlat).size(), 5u);
    EXPECT_LT(coverage_area(rasterise(outlines_of(tuft, kFlat), kFlat, 0, kCell)), whole);
}

}  // namespace
}  // namespace tuft::footprint
