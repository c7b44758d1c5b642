#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh/read/polygon_soup.h"
#include "mesh/repair/repair.h"
#include "paths.h"

namespace tuft::mesh {
namespace {

// A lip that is blunt along a part of a shut line turns the normals of the whole strip beside it, which then mirrors
// another part of the studio: a pale dash. Sheet metal beside the gap behind the bonnet, where the power dome's crease
// meets it, bends by less than 3 degrees from one triangle to the next.
TEST(ShippedModels, TheCarIsSharpAllAlongTheGapBehindItsBonnet) {
    const TriangleMesh car =
        build_surface(read_polygon_file(source_folder() + "/models/car.ply"), {.metres_per_unit = 1}).mesh;  // mm
    double most = 0;
    std::size_t n = 0;
    for (std::uint32_t t = 0; t < car.n_triangles(); ++t) {
        const Vec3 a = car.position(t, 0), b = car.position(t, 1), c = car.position(t, 2), m = (a + b + c) / 3.0;
        const Vec3 face = glm::normalize(glm::cross(b - a, c - a));
        if (!(m.x > 195 && m.x < 240 && std::abs(m.y) < 165 && m.z > 238 && face.z > 0.9)) continue;
        ++n;
        for (std::size_t k = 0; k < 3; ++k)
            most = std::max(most, std::acos(std::min(1.0, glm::dot(Vec3(car.corner_normals[3 * t + k]), face))));
    }
    EXPECT_GT(n, 200u);
    EXPECT_LT(most, 3 * 0.01745329);
}

}  // namespace
}  // namespace tuft::mesh
