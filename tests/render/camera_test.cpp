#include "render/picture/camera.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/error.h"
#include "core/random.h"

namespace tuft::render {
namespace {

TEST(Camera, RayThroughAProjectedPointHitsIt) {
    View view;
    view.target = Vec3{0.01, -0.02, 0.03};
    view.distance = 0.4;
    for (double azimuth : {-2.0, 0.0, 1.3, 3.0})
        for (double elevation : {-0.7, 0.0, 0.5, 1.5}) {
            view.azimuth = azimuth;
            view.elevation = elevation;
            const Camera c = make_camera(view, 640, 400, {});
            for (int i = 0; i < 20; ++i) {
                const Vec3 p = *view.target + 0.1 * Vec3{uniform(1, 3 * i) - 0.5, uniform(1, 3 * i + 1) - 0.5,
                                                         uniform(1, 3 * i + 2) - 0.5};
                const auto at = project(c, p);
                ASSERT_TRUE(at);
                const Vec3 hit = c.eye + ray_direction(c, at->x, at->y) * glm::length(p - c.eye);
                EXPECT_NEAR(glm::length(hit - p), 0, 1e-12);
            }
            const auto centre = project(c, *view.target);
            EXPECT_NEAR(centre->x, 320, 1e-9);
            EXPECT_NEAR(centre->y, 200, 1e-9);
            EXPECT_NEAR(centre->z, 0.4, 1e-12);
        }
}

TEST(Camera, FitTouchesTheMarginsAndCrossesNone) {
    Random random(7);
    for (int trial = 0; trial < 20; ++trial) {
        std::vector<Vec3f> points;
        for (int i = 0; i < 200; ++i)
            points.emplace_back(random.uniform(-1, 1) + 5, random.uniform(-0.3, 0.3), random.uniform(0, 0.8));
        View view;
        view.azimuth = random.uniform(-3, 3);
        view.elevation = random.uniform(-1.5, 1.5);
        view.margin = 0.08;
        const Camera c = make_camera(view, 1280, 720, points);
        double left = 1e9, right = 0, top = 1e9, bottom = 0;
        for (const Vec3f& p : points) {
            const auto at = project(c, Vec3(p));
            ASSERT_TRUE(at);
            left = std::min(left, at->x);
            right = std::max(right, at->x);
            top = std::min(top, at->y);
            bottom = std::max(bottom, at->y);
        }
        const double mx = 0.08 * 1280, my = 0.08 * 720;
        EXPECT_GE(left, mx - 1e-6);
        EXPECT_LE(right, 1280 - mx + 1e-6);
        EXPECT_GE(top, my - 1e-6);
        EXPECT_LE(bottom, 720 - my + 1e-6);
        // As near as possible: two opposite margins are touched.
        EXPECT_TRUE((std::abs(left - mx) < 1e-6 && std::abs(right - 1280 + mx) < 1e-6) ||
                    (std::abs(top - my) < 1e-6 && std::abs(bottom - 720 + my) < 1e-6));
    }
}

TEST(Camera, RefusesImpossibleViews) {
    View view;
    EXPECT_THROW(make_camera(view, 0, 100, {}), Error);
    EXPECT_THROW(make_camera(view, 100, 20000, {}), Error);
    view.elevation = 2;
    EXPECT_THROW(make_camera(view, 100, 100, {}), Error);
}

}  // namespace
}  // namespace tuft::render
