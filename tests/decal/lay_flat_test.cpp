#include "decal/panels/lay_flat.h"

#include <gtest/gtest.h>

#include "surfaces.h"

namespace tuft::decal {
namespace {

using test::kMm;

// Arc lengths of the closed form: the facets' chords fall short of them by (step)²/24, 5e-6 of the length here.
TEST(LayFlat, LengthsOnACylinderAreThoseOfItsDevelopment) {
    const double radius = 0.05, angle = 4, height = 0.12;
    const int around = 360, up = 40;
    const atlas::ChartMesh chart = test::chart_of(test::cylinder_part(radius, angle, height, around, up));
    const FlatPanel panel = lay_flat(chart, 0.03);
    ASSERT_TRUE(panel.sound);
    EXPECT_LT(panel.strain, 2e-5);
    Random random(7);
    const auto place = [&](int i, int j) {
        const auto t = static_cast<std::uint32_t>(2 * (j * around + i));
        return panel.flat[test::vertex_at(chart, t, 0)];
    };
    for (int k = 0; k < 200; ++k) {
        const int i0 = static_cast<int>(random.uniform() * around), i1 = static_cast<int>(random.uniform() * around);
        const int j0 = static_cast<int>(random.uniform() * up), j1 = static_cast<int>(random.uniform() * up);
        const double arc = radius * angle * (i1 - i0) / around, rise = height * (j1 - j0) / up;
        EXPECT_NEAR(glm::length(place(i1, j1) - place(i0, j0)), std::hypot(arc, rise), 0.01 * kMm);
    }
}

// The cone unrolls into a sector: polar coordinates (slant distance, angle times the sine of the half angle).
TEST(LayFlat, LengthsOnAConeAreThoseOfItsSector) {
    const double half = 0.5, angle = 5, from = 0.03, to = 0.13;
    const int around = 720, up = 30;
    const atlas::ChartMesh chart = test::chart_of(test::cone_part(half, angle, from, to, around, up));
    const FlatPanel panel = lay_flat(chart, 0.03);
    ASSERT_TRUE(panel.sound);
    Random random(8);
    for (int k = 0; k < 200; ++k) {
        std::array<Vec2, 2> flat, sector;
        for (std::size_t e = 0; e < 2; ++e) {
            const int i = static_cast<int>(random.uniform() * around), j = static_cast<int>(random.uniform() * up);
            const double s = from + (to - from) * j / up, a = angle * i / around * std::sin(half);
            sector[e] = s * Vec2(std::cos(a), std::sin(a));
            flat[e] = panel.flat[test::vertex_at(chart, static_cast<std::uint32_t>(2 * (j * around + i)), 0)];
        }
        EXPECT_NEAR(glm::length(flat[1] - flat[0]), glm::length(sector[1] - sector[0]), 0.01 * kMm);
    }
}

// [Milnor1969]: every map of a cap of angular radius α has greatest scale / least scale ≥ k = α / sin α, which the
// azimuthal equidistant map has. With the best size of the sheet the strain is then (k − 1)/(k + 1).
double least_cap_strain(double polar) {
    const double k = polar / std::sin(polar);
    return (k - 1) / (k + 1);
}

TEST(LayFlat, ACapIsStrainedByTheLeastPossibleWithinATenth) {
    for (const double polar : {0.4, 0.7, 1.0}) {
        const atlas::ChartMesh chart = test::chart_of(test::sphere_cap(0.06, polar, 28));
        ASSERT_TRUE(chart.disk);
        const double least = least_cap_strain(polar);
        const FlatPanel within = lay_flat(chart, 1.1 * least);
        EXPECT_TRUE(within.within(1.1 * least)) << polar << ": " << within.strain << " against " << least;
        // A mesh of 28 rings is flatter than its sphere by less than 1 %.
        EXPECT_GT(lay_flat(chart, 0.9 * least).strain, 0.98 * least) << polar;
    }
}

// A generous limit is no reason to strain the film more than it must be.
TEST(LayFlat, ACapIsStrainedByTheLeastPossibleUnderAWideLimitToo) {
    for (const double polar : {0.2, 0.55, 0.8, 1.0}) {
        const atlas::ChartMesh chart = test::chart_of(test::sphere_cap(0.05, polar, 28));
        const FlatPanel panel = lay_flat(chart, 0.15);
        EXPECT_TRUE(panel.sound);
        EXPECT_LT(panel.strain, 1.1 * least_cap_strain(polar)) << polar;
    }
}

// A flat square with one vertex raised: as rigid as possible it is strained by 4 % there. Bringing that to
// 3 % or less need not change the size of the rest. The rest is what lies further than a quarter of the side from the
// vertex.
TEST(LayFlat, OneSharpPlaceLeavesTheRestAtItsTrueSize) {
    const int n = 40;
    const double side = 0.1, height = 0.6 * kMm, limit = 0.03;
    const atlas::ChartMesh chart = test::chart_of(test::grid_mesh(n, n, false, false, [=](double u, double v) {
        const bool middle = std::abs(u - 0.5) + std::abs(v - 0.5) < 0.5 / n;
        return Vec3(side * (u - 0.5), side * (v - 0.5), middle ? height : 0);
    }));
    const FlatPanel panel = lay_flat(chart, limit);
    ASSERT_TRUE(panel.within(limit)) << panel.strain;
    EXPECT_GT(panel.strain, 0.015);  // else the test has no sharp place
    const std::vector<Stretch> stretches = measure_stretch(chart, panel.flat);
    const std::uint32_t top = test::vertex_at(chart, 2 * (n / 2 * n + n / 2), 0);
    const Vec3 raised = chart.position[top];
    double sum = 0;
    int far = 0;
    for (std::size_t t = 0; t < stretches.size(); ++t) {
        const Vec3 p(chart.position[chart.faces[t][0]]);
        if (glm::length(p - raised) < side / 4) continue;
        sum += 0.5 * (stretches[t].most + stretches[t].least) - 1;
        ++far;
    }
    // Strain about a point defect falls with the square of the distance: from 4 % over some 4 mm to 0.1 % at 25 mm.
    EXPECT_LT(std::abs(sum / far), 1e-3);
}

// The strains of a known linear map: σ = 1 / singular values of the map onto the sheet.
TEST(LayFlat, MeasuresTheStretchOfALinearMap) {
    const atlas::ChartMesh chart = test::chart_of(
        test::grid_mesh(4, 3, false, false, [](double u, double v) { return Vec3(0.2 * u, 0.1 * v, 0); }));
    std::vector<Vec2> flat;
    const double c = std::cos(0.3), s = std::sin(0.3);
    for (const Vec3& p : chart.position) {
        const Vec2 q(p.x / 1.08, p.y / 0.97);
        flat.push_back({c * q.x - s * q.y, s * q.x + c * q.y});
    }
    for (const Stretch& stretch : measure_stretch(chart, flat)) {
        EXPECT_NEAR(stretch.most, 1.08, 1e-6);  // positions are floats
        EXPECT_NEAR(stretch.least, 0.97, 1e-6);
    }
    EXPECT_NEAR(largest_strain(chart, flat), 0.08, 1e-6);
}

}  // namespace
}  // namespace tuft::decal
