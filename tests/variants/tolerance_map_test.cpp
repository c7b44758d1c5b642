#include "variants/tolerance_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/text/units.h"
#include "variants/deviation.h"

namespace tuft::variants {
namespace {

/// A flat sheet of 60 × 40 mm about the origin, 256 texels wide.
stroke::Model sheet() {
    mesh::PolygonSoup soup;
    soup.points = {{-30, -20, 0}, {30, -20, 0}, {30, 20, 0}, {-30, 20, 0}};
    soup.corners = {0, 1, 2, 3};
    soup.polygon_start = {0, 4};
    stroke::ModelOptions options;
    options.repair.metres_per_unit = kMillimetre;
    options.unwrap.size = 256;
    return stroke::prepare_model(std::move(soup), options);
}

constexpr double kHalf = 4e-3;  // metres, half the width of the band

/// A band along x, moved; with places along its middle.
Coverage band(const stroke::Model& model, const Vec2& moved) {
    Coverage c;
    c.n_slots = static_cast<std::uint32_t>(model.texels.n_slots());
    for (std::uint32_t slot = 0; slot < c.n_slots; ++slot) {
        std::array<std::uint64_t, 4> bits{};
        for (int t = 0; t < atlas::kTileTexels; ++t)
            if (model.texels.tiles[slot].cluster[t] != atlas::kNoCluster &&
                std::abs(model.texels.position(slot, t).y - moved.y) < kHalf)
                bits[t / 64] |= std::uint64_t{1} << (t % 64);
        if (bits == std::array<std::uint64_t, 4>{}) continue;
        c.slots.push_back(slot);
        c.painted.push_back(bits);
    }
    for (int i = -20; i <= 20; ++i) c.feet.emplace_back(1e-3 * i + moved.x, moved.y, 0);
    return c;
}

double normal_below(double x) {
    return 0.5 * std::erfc(-x / std::sqrt(2.0));
}

TEST(ToleranceMap, ABandThatMovesNormallyHasTheProbabilityOfItsClosedForm) {
    const stroke::Model model = sheet();
    constexpr int kN = 1000;
    const double sigma = 1.5e-3;
    ToleranceMap map(model, band(model, {0, 0}));
    for (std::uint64_t i = 0; i < kN; ++i)
        map.add(band(model, sigma * Vec2(normal_number(8, 2 * i), normal_number(8, 2 * i + 1))));
    const std::vector<float> p = map.probability(), moved = map.displacement();
    std::size_t seen = 0;
    for (std::uint32_t slot = 0; slot < model.texels.n_slots(); ++slot)
        for (int t = 0; t < atlas::kTileTexels; ++t) {
            if (model.texels.tiles[slot].cluster[t] == atlas::kNoCluster) continue;
            const double y = model.texels.position(slot, t).y;
            const double truth = normal_below((kHalf - y) / sigma) - normal_below((-kHalf - y) / sigma);
            const std::size_t i = atlas::kTileTexels * slot + t;
            // Five standard errors of a count of kN, and one sample.
            EXPECT_NEAR(p[i], truth, 5 * std::sqrt(truth * (1 - truth) / kN) + 1.0 / kN);
            // Squares of two normal numbers: five standard errors of their mean, halved by the root.
            if (p[i] > 0) {
                EXPECT_NEAR(moved[i] / (sigma * std::sqrt(2.0)), 1, 2.5 / std::sqrt(kN));
            }
            ++seen;
        }
    EXPECT_GT(seen, 20'000u);
    const MoveFigures f = map.figures();
    EXPECT_EQ(f.samples, static_cast<std::size_t>(kN));
    EXPECT_NEAR(f.planned_mm2, 60 * 2e3 * kHalf, 60 * 0.3);  // a row of texels is 0.24 mm wide
    EXPECT_NEAR(f.rms_mm, 1e3 * sigma * std::sqrt(2.0), 1e3 * sigma * std::sqrt(2.0) * 2.5 / std::sqrt(kN));
    // Distances are of Rayleigh's distribution: 95 % are below sigma sqrt(2 ln 20). The standard error of a quantile is
    // sqrt(q (1 - q) / n) over the density there, sigma 0.056.
    EXPECT_NEAR(f.most_95_mm, 1e3 * sigma * std::sqrt(2 * std::log(20.0)), 5 * 1e3 * sigma * 0.056);
    EXPECT_LT(f.always_mm2, f.planned_mm2);
    EXPECT_GT(f.ever_mm2, f.planned_mm2);
}

TEST(ToleranceMap, SamplesThatDoNotMoveOverlapWholly) {
    const stroke::Model model = sheet();
    ToleranceMap map(model, band(model, {0, 0}));
    for (int i = 0; i < 3; ++i) map.add(band(model, {0, 0}));
    const MoveFigures f = map.figures();
    EXPECT_EQ(f.overlap, 1);
    EXPECT_EQ(f.most_mm, 0);
    EXPECT_DOUBLE_EQ(f.always_mm2, f.planned_mm2);
    EXPECT_DOUBLE_EQ(f.ever_mm2, f.planned_mm2);
}

TEST(ToleranceMap, ABandMovedByItsWidthOverlapsNowhereAndByHalfInAThird) {
    const stroke::Model model = sheet();
    for (const auto& [moved, overlap] : {std::pair{kHalf * 2, 0.0}, {kHalf, 1.0 / 3}}) {
        ToleranceMap map(model, band(model, {0, 0}));
        map.add(band(model, {0, moved}));
        EXPECT_NEAR(map.figures().overlap, overlap, 0.03);  // a row of 0.24 mm of 8 mm
        EXPECT_NEAR(map.figures().rms_mm, 1e3 * moved, 1e-5);
    }
}

TEST(ToleranceMap, ResultsOfOtherModelsAreRefused) {
    const stroke::Model model = sheet();
    Coverage other = band(model, {0, 0});
    ToleranceMap map(model, other);
    other.n_slots += 1;
    EXPECT_THROW(map.add(other), Error);
    EXPECT_THROW(ToleranceMap(model, other), Error);
    other.n_slots -= 1;
    other.feet.pop_back();
    EXPECT_THROW(map.add(other), Error);
}

}  // namespace
}  // namespace tuft::variants
