#include <gtest/gtest.h>

#include <map>

#include "decal/outline.h"
#include "decal/panels/panels.h"
#include "decal/panels/select_film.h"
#include "surfaces.h"

namespace tuft::decal {
namespace {

using test::kMm;

double area_of_mesh(const mesh::TriangleMesh& m) {
    return mesh::surface_area(m);
}

double farthest_from(const Vec3& middle, const FilmMesh& film) {
    double farthest = 0;
    for (const Vec3f& p : film.mesh.positions) farthest = std::max(farthest, glm::length(Vec3(p) - middle));
    return farthest;
}

/// Corners lie on the model's surface where their weights say, to the rounding of floats.
void expect_corners_on(const mesh::TriangleMesh& model, const FilmMesh& film) {
    for (std::size_t t = 0; t < film.source.size(); ++t)
        for (int k = 0; k < 3; ++k)
            EXPECT_LT(glm::length(point_at(model, film.source[t], film.weights[t][static_cast<std::size_t>(k)]) -
                                  film.mesh.position(t, k)),
                      1e-7);
}

// A plane divides triangles and loses nothing: the area is the same, every interior edge has two sides, and corners lie
// where their weights say.
TEST(FilmMesh, CuttingKeepsTheSurface) {
    const mesh::TriangleMesh model = test::whole_cylinder(0.04, 0.1, 60, 20);
    FilmMesh film = select_film(
        model, [](std::uint32_t, const Weights&) { return 1.0; }, {.bleed = 0.01}, 1e-3);
    ASSERT_EQ(film.n_labels, 1u);
    const double area = area_of_mesh(model);
    EXPECT_EQ(cut(film, 0, {glm::normalize(Vec3(1, 0.3, 0.2)), 0.011}).size(), 2u);
    const std::vector<std::uint32_t> again = cut(film, 1, {glm::normalize(Vec3(0.1, 1, -0.4)), -0.003});
    EXPECT_GE(again.size(), 2u);
    EXPECT_NEAR(area_of_mesh(film.mesh), area, 1e-6 * area);  // new corners are rounded to floats
    double open = 0;                                          // the two rims, and nothing else
    for (std::uint32_t h = 0; h < film.mesh.neighbours.size(); ++h)
        if (film.mesh.neighbours[h] == kNone)
            open += glm::length(film.mesh.position(h / 3, static_cast<int>((h + 1) % 3 == 0 ? 0 : h % 3 + 1)) -
                                film.mesh.position(h / 3, static_cast<int>(h % 3)));
    EXPECT_NEAR(open, 2 * 60 * 2 * 0.04 * std::sin(test::kPi / 60), 1e-6);
    expect_corners_on(model, film);
}

TEST(FilmMesh, APlaneBesideAPartLeavesItWhole) {
    const mesh::TriangleMesh model = test::whole_cylinder(0.04, 0.1, 60, 20);
    FilmMesh film = select_film(
        model, [](std::uint32_t, const Weights&) { return 1.0; }, {.bleed = 0.01}, 1e-3);
    for (const double offset : {-0.05, 0.05}) EXPECT_EQ(cut(film, 0, {{1, 0, 0}, offset}), std::vector{0u});
    EXPECT_EQ(film.n_labels, 1u);
}

TEST(FilmMesh, TakesWhatIsPaintedAndAMarginRoundIt) {
    const mesh::TriangleMesh model =
        test::grid_mesh(100, 100, false, false, [](double u, double v) { return Vec3(0.1 * u, 0.1 * v, 0); });
    const auto painted =
        test::coverage_where(model, [](const Vec3& p) { return glm::length(p - Vec3(0.05, 0.05, 0)) < 0.01; });
    const FilmMesh film = select_film(model, painted, {.bleed = 5 * kMm}, 0.5 * kMm);
    const double farthest = farthest_from({0.05, 0.05, 0}, film);
    EXPECT_GT(farthest, 15 * kMm);
    EXPECT_LT(farthest, 16 * kMm);  // 10 + 5, and a little more, so that the cut line lies on the film
}

// The same on two triangles of 400 mm: they are divided first. The film has no more area than its disc.
TEST(FilmMesh, LargeFacetsAreDivided) {
    const mesh::TriangleMesh model =
        test::grid_mesh(1, 1, false, false, [](double u, double v) { return Vec3(0.4 * u, 0.4 * v, 0); });
    const Vec3 middle(0.13, 0.21, 0);
    const auto painted = test::coverage_where(model, [&](const Vec3& p) { return glm::length(p - middle) < 0.02; });
    const FilmMesh film = select_film(model, painted, {.bleed = 3 * kMm}, 0.3 * kMm);
    const double farthest = farthest_from(middle, film);
    EXPECT_GT(farthest, 23 * kMm);
    EXPECT_LT(farthest, 24 * kMm);
    EXPECT_NEAR(area_of_mesh(film.mesh), test::kPi * 23.5 * 23.5 * kMm * kMm,
                0.02 * test::kPi * 23.5 * 23.5 * kMm * kMm);
    EXPECT_EQ(film.n_labels, 1u);
    expect_corners_on(model, film);
}

// Two dots of 6 mm, 9 mm apart, with a bleed of 3 mm: the closing that joins them needs film between them.
TEST(FilmMesh, HoldsWhatBridgesAGap) {
    const mesh::TriangleMesh model =
        test::grid_mesh(60, 60, false, false, [](double u, double v) { return Vec3(0.1 * u, 0.1 * v, 0); });
    const auto painted = test::coverage_where(model, [](const Vec3& p) {
        return glm::length(p - Vec3(0.0425, 0.05, 0)) < 0.003 || glm::length(p - Vec3(0.0575, 0.05, 0)) < 0.003;
    });
    EXPECT_EQ(select_film(model, painted, {.bleed = 3 * kMm}, 0.2 * kMm).n_labels, 2u);
    const FilmMesh film = select_film(model, painted, film_reach(3 * kMm, 10 * kMm), 0.2 * kMm);
    EXPECT_EQ(film.n_labels, 1u);
    Vec3 lo(1), hi(0);
    for (const Vec3f& p : film.mesh.positions) lo = glm::min(lo, Vec3(p)), hi = glm::max(hi, Vec3(p));
    EXPECT_NEAR(hi.y - lo.y, 13 * kMm, 0.6 * kMm);  // no more than the bleed beyond both dots
    EXPECT_NEAR(hi.x - lo.x, 28 * kMm, 0.6 * kMm);
}

// A ring of paint with a hole of 8 mm is laid as a disc, one with a hole of 80 mm is not.
TEST(FilmMesh, FillsSmallHoles) {
    const mesh::TriangleMesh model =
        test::grid_mesh(80, 80, false, false, [](double u, double v) { return Vec3(0.2 * u, 0.2 * v, 0); });
    for (const double inner : {8 * kMm, 40 * kMm}) {
        const auto painted = test::coverage_where(model, [&](const Vec3& p) {
            const double r = glm::length(p - Vec3(0.1, 0.1, 0));
            return r > inner && r < inner + 0.01;
        });
        const FilmMesh film = select_film(model, painted, film_reach(3 * kMm, 10 * kMm), 0.5 * kMm);
        const bool has_middle = std::ranges::any_of(
            film.mesh.positions, [](const Vec3f& p) { return glm::length(Vec3(p) - Vec3(0.1, 0.1, 0)) < 0.004; });
        EXPECT_EQ(has_middle, inner < 0.02);
    }
}

// A cylinder is cut open once and unrolls without strain.
TEST(Panels, AWholeCylinderIsOnePieceWithOneSeam) {
    const mesh::TriangleMesh model = test::whole_cylinder(0.03, 0.08, 120, 30);
    const CoverageFn all = [](std::uint32_t, const Weights&) { return 1.0; };
    FilmMesh film = select_film(model, all, {.bleed = 0.005}, 1e-3);
    const std::vector<Panel> panels = cut_into_panels(film, all, {.max_strain = 0.03});
    ASSERT_EQ(panels.size(), 1u);
    EXPECT_LT(panels[0].strain, 2e-5);
    EXPECT_EQ(panels[0].chart.faces.size(), film.source.size());
}

// Paint in three patches on a cylinder: the cut runs between them, not through one.
TEST(Panels, CutsRunBetweenMotifs) {
    const mesh::TriangleMesh model = test::whole_cylinder(0.03, 0.04, 180, 24);
    const CoverageFn patches = test::coverage_where(model, [](const Vec3& p) {
        const double a = std::fmod(std::atan2(p.y, p.x) + 2 * test::kPi, 2 * test::kPi / 3);
        return a > 0.25 && a < 1.9;
    });
    FilmMesh film = select_film(
        model, [](std::uint32_t, const Weights&) { return 1.0; }, {.bleed = 0.005}, 1e-3);
    const std::vector<Panel> panels = cut_into_panels(film, patches, {.max_strain = 0.03});
    ASSERT_EQ(panels.size(), 1u);
    double cut = 0, through = 0;
    for (std::uint32_t h = 0; h < panels[0].is_seam.size(); ++h) {
        if (!panels[0].is_seam[h]) continue;
        const std::uint32_t t = panels[0].chart.triangles[h / 3];
        const Vec3 a = film.mesh.position(t, static_cast<int>(h % 3));
        const Vec3 b = film.mesh.position(t, static_cast<int>((h % 3 + 1) % 3));
        Weights w;
        for (std::size_t k = 0; k < 3; ++k)
            w[k] = 0.5 * (film.weights[t][h % 3][k] + film.weights[t][(h % 3 + 1) % 3][k]);
        cut += glm::length(b - a);
        through += patches(film.source[t], w) * glm::length(b - a);
    }
    EXPECT_GT(cut, 0.07);  // both sides of one seam 40 mm long
    EXPECT_EQ(through, 0);
}

// A sphere cannot be laid flat; its pieces keep the limit, cover it once, and there are no more than such pieces need:
// a cap strained by 3 % has an angular radius of 0.59, 8.6 % of the sphere.
TEST(Panels, ASphereIsCutIntoPiecesWithinTheLimit) {
    const mesh::TriangleMesh model = test::grid_mesh(72, 36, true, false, [](double u, double v) {
        const double polar = test::kPi * (0.04 + 0.92 * v);
        return Vec3(0.03 * std::sin(polar) * std::cos(2 * test::kPi * u),
                    0.03 * std::sin(polar) * std::sin(2 * test::kPi * u), -0.03 * std::cos(polar));
    });
    const CoverageFn all = [](std::uint32_t, const Weights&) { return 1.0; };
    for (const double limit : {0.03, 0.15}) {
        FilmMesh film = select_film(model, all, {.bleed = 0.005}, 1e-3);
        const std::vector<Panel> panels = cut_into_panels(film, all, {.max_strain = limit});
        std::map<std::uint32_t, int> seen;
        for (const Panel& panel : panels) {
            EXPECT_LE(panel.strain, limit);
            EXPECT_TRUE(atlas::check_flat(panel.chart, panel.flat).sound());
            for (const std::uint32_t t : panel.chart.triangles) ++seen[t];
        }
        EXPECT_EQ(seen.size(), film.source.size());
        for (const auto& [triangle, times] : seen) EXPECT_EQ(times, 1) << triangle;
        EXPECT_LE(panels.size(), limit < 0.1 ? 24u : 8u);
    }
}

}  // namespace
}  // namespace tuft::decal
