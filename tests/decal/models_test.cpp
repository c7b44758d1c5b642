#include <gtest/gtest.h>

#include "decal/panels/panels.h"
#include "decal/panels/select_film.h"
#include "io/model/read_model.h"
#include "mesh/repair/repair.h"
#include "paths.h"
#include "surfaces.h"

namespace tuft::decal {
namespace {

mesh::TriangleMesh shipped(const std::string& name) {
    return mesh::build_surface(io::read_model(source_folder() + "/models/" + name), {.metres_per_unit = 1e-3}).mesh;
}

/// Coverage where a point and the normal there are as asked.
template <class Chosen>
CoverageFn coverage_facing(const mesh::TriangleMesh& model, const Vec3& direction, Chosen chosen) {
    return [&model, direction, chosen](std::uint32_t triangle, const Weights& w) {
        return glm::dot(mesh::face_normal(model, triangle), direction) > 0.75 && chosen(point_at(model, triangle, w))
                   ? 1.0
                   : 0.0;
    };
}

void expect_within(const mesh::TriangleMesh& model, const CoverageFn& painted, double limit, std::size_t most) {
    FilmMesh film = select_film(model, painted, {.bleed = 0.005}, 5e-4);
    ASSERT_FALSE(film.source.empty());
    const std::vector<Panel> panels = cut_into_panels(film, painted, {.max_strain = limit});
    EXPECT_LE(panels.size(), most);
    for (const Panel& panel : panels) EXPECT_LE(largest_strain(panel.chart, panel.flat), limit);
}

// Parts beside shut lines are panels of their own.
TEST(ShippedModels, ACarDoorIsLaidWithinTheStrainOfWrapFilm) {
    const mesh::TriangleMesh car = shipped("car.ply");
    expect_within(
        car,
        test::coverage_where(
            car, [](const Vec3& p) { return p.y < -0.15 && std::abs(p.x) < 0.12 && p.z > 0.08 && p.z < 0.2; }),
        0.15, 12);
}

TEST(ShippedModels, ABonnetIsLaidWithinTheStrainOfWrapFilm) {
    const mesh::TriangleMesh car = shipped("car.ply");
    expect_within(
        car,
        coverage_facing(car, {0, 0, 1}, [](const Vec3& p) { return p.x > 0.25 && std::abs(p.y) < 0.15 && p.z > 0.15; }),
        0.15, 12);
}

TEST(ShippedModels, ABowlWallIsCutIntoWaterSlideDecals) {
    const mesh::TriangleMesh bowl = shipped("bowl.ply");
    const double middle = 0.5 * bowl.bounds.hi.z;
    expect_within(bowl,
                  test::coverage_where(bowl,
                                       [&](const Vec3& p) {
                                           const double r = std::hypot(p.x, p.y);
                                           return std::abs(p.z - middle) < 0.012 && r > 0.4 * bowl.bounds.hi.x;
                                       }),
                  0.03, 12);
}

}  // namespace
}  // namespace tuft::decal
