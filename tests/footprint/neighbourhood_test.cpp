#include "footprint/stamp/neighbourhood.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "stage.h"

// Clusters that one search finds for several stamps.

namespace tuft::footprint {
namespace {

using testing::Unwrapped;
using Exposures = std::map<std::uint32_t, std::array<float, atlas::kTileTexels>>;

Exposures exposures_of(const Stage& stage, const StampJobs& jobs) {
    Exposures out;
    for (const TileJob& job : jobs.tiles) {
        std::array<float, atlas::kTileTexels> exposure;
        if (evaluate(stage.map, jobs, job, exposure)) out[job.slot] = exposure;
    }
    return out;
}

// Discs, each a few texels on and turned since the one before: at(k) is the frame of stamp k.
struct Stamps {
    std::vector<Footprint> footprints;
    std::vector<MovedFootprint> moved;

    template <class At>
    Stamps(const Stage& stage, double radius, double turn, At at) {
        for (int k = 0; k < 8; ++k) {
            const Frame frame = at(k);
            footprints.push_back(disc(frame, stage.triangle_at(frame.origin, frame.n), radius, stage.map.texel_size));
        }
        for (const Footprint& f : footprints) moved.push_back({f, {Vec2{2 * stage.map.texel_size, 0}, turn}});
    }
};

Frame on_sphere(double R, double travel) {
    const Vec3 a = glm::normalize(Vec3{1, 0.93, 0.2}), b = glm::normalize(glm::cross(a, Vec3{0.3, 0.1, 1}));
    const Vec3 n = std::cos(travel / R) * a + std::sin(travel / R) * b;
    return make_frame(R * n, n, std::cos(travel / R) * b - std::sin(travel / R) * a);
}

TEST(Neighbourhood, StampsOfABatchExposeWhatEachOfThemExposesByItself) {
    const double R = 0.02;
    for (const bool ball : {true, false}) {
        Stage stage(ball ? testing::sphere(R, 300, 80) : testing::sheet(0.06, 3, 120));
        const double texel = stage.map.texel_size;
        for (const double turn : {0.0, 0.02}) {
            const Stamps stamps(stage, 30 * texel, turn, [&](int k) {
                return ball ? on_sphere(R, 2 * k * texel)
                            : make_frame({0.002 + 2 * k * texel, -0.001, 0}, {0, 0, 1}, {1, 0, 0});
            });
            const Neighbourhood around = find_neighbourhood(stage.surface(), stamps.moved, {}, stage.scratch);
            ASSERT_FALSE(around.clusters.empty()) << ball;
            for (const MovedFootprint& stamp : stamps.moved) {
                const StampJobs alone = stage.plan(stamp.footprint, stamp.motion);
                EXPECT_FALSE(alone.piecewise);
                const Exposures truth = exposures_of(stage, alone);
                PlanScratch fresh;  // a stamp that takes its clusters from there needs no search before it
                const StampJobs shared =
                    plan_stamp(stage.surface(), stamp.footprint, stamp.motion, {}, {fresh}, around);
                ASSERT_GT(truth.size(), 9u);
                EXPECT_EQ(exposures_of(stage, shared), truth) << ball << " " << turn;
                EXPECT_TRUE(fresh.nodes.empty());
            }
        }
    }
}

TEST(Neighbourhood, EachStampSearchesByItselfWhereTheSurfaceIsNotSmooth) {
    // Beside a crease, the rim of a sheet, and where a thin plate's other side faces away.
    Stage corner(testing::right_angle(0.04, 200, false));
    const double texel = corner.map.texel_size;
    const auto beside = [&](int k) { return make_frame({-0.003 + k * texel, 0.0007, 0}, {0, 0, 1}, {1, 0, 0}); };
    const Stamps creased(corner, 0.006, 0, beside);
    EXPECT_TRUE(find_neighbourhood(corner.surface(), creased.moved, {}, corner.scratch).clusters.empty());
    // No crease within reach.
    const auto apart = [&](int k) { return make_frame({-0.02 + k * texel, 0.0007, 0}, {0, 0, 1}, {1, 0, 0}); };
    const Stamps flat(corner, 0.006, 0, apart);
    EXPECT_FALSE(find_neighbourhood(corner.surface(), flat.moved, {}, corner.scratch).clusters.empty());

    Stage sheet(testing::sheet(0.06, 1, 240));
    const auto rim = [&](int k) { return make_frame({0.028, k * texel, 0}, {0, 0, 1}, {0, 1, 0}); };
    const Stamps open(sheet, 0.006, 0, rim);
    EXPECT_TRUE(find_neighbourhood(sheet.surface(), open.moved, {}, sheet.scratch).clusters.empty());
}

TEST(Neighbourhood, IsEmptyWhereOneSearchCostsMoreThanThoseOfTheStamps) {
    Stage sheet(testing::sheet(0.06, 1, 400));
    const double texel = sheet.map.texel_size;
    // Half of a diameter apart the stamps reach seven halves more.
    const Stamps far(sheet, 30 * texel, 0, [&](int k) {
        return make_frame({-0.02 + 30 * k * texel, 0.0007, 0}, {0, 0, 1}, {1, 0, 0});
    });
    EXPECT_TRUE(find_neighbourhood(sheet.surface(), far.moved, {}, sheet.scratch).clusters.empty());
    EXPECT_TRUE(find_neighbourhood(sheet.surface(), std::span(far.moved).first(1), {}, sheet.scratch).clusters.empty());
}

}  // namespace
}  // namespace tuft::footprint
