#include "app/view/visibility.h"

#include <gtest/gtest.h>

#include "models.h"

namespace tuft::app {
namespace {

render::GlCamera from_front(double parallel_height) {
    return {.eye = {0, -1, 0},
            .right = {1, 0, 0},
            .up = {0, 0, 1},
            .forward = {0, 1, 0},
            .field_of_view = 0.5,
            .parallel_height = parallel_height,
            .near = 0.01,
            .far = 3,
            .width = 640,
            .height = 480};
}

// The sphere round the origin: what faces the eye is seen, the back is hidden behind the front.
TEST(Visibility, TheBackOfASphereIsHiddenUntilTheFrontIsCutAway) {
    const stroke::Model model = test::shipped_model("sphere.ply", 64);
    const Box& b = model.mesh->bounds;
    const Vec3 middle = b.centre(), front{middle.x, b.lo.y, middle.z}, back{middle.x, b.hi.y, middle.z};
    const double tolerance = 2e-3 * b.diagonal();
    for (const double parallel : {0.0, 0.5}) {
        render::GlCamera camera = from_front(parallel);
        camera.eye += middle;
        EXPECT_TRUE(is_seen(*model.query, camera, Vec4f(0), front, tolerance)) << parallel;
        EXPECT_FALSE(is_seen(*model.query, camera, Vec4f(0), back, tolerance)) << parallel;
        // The front half is cut away: dot((p, 1), plane) > 0 there.
        const Vec4f cut(0, -1, 0, static_cast<float>(middle.y));
        EXPECT_FALSE(is_seen(*model.query, camera, cut, front, tolerance)) << parallel;
        EXPECT_TRUE(is_seen(*model.query, camera, cut, back, tolerance)) << parallel;
    }
    render::GlCamera away = from_front(0);
    away.eye += middle;
    away.forward = {0, -1, 0};
    away.right = {-1, 0, 0};
    EXPECT_FALSE(is_seen(*model.query, away, Vec4f(0), front, tolerance)) << "behind the eye";
}

}  // namespace
}  // namespace tuft::app
