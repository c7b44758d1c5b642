#include "stroke/placement/placement.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/random.h"
#include "grids.h"
#include "stroke/placement/holder.h"
#include "stroke/placement/snap.h"
#include "stroke/placement/tip_lag.h"

namespace tuft::stroke {
namespace {

TEST(Placement, WrapAndProjectOnTheSheetAreTheIdentity) {
    const TriangleMesh sheet = make_sheet();
    const SurfaceQuery query(sheet);
    for (SurfaceMapping mapping : {SurfaceMapping::wrap, SurfaceMapping::project}) {
        const Placement place{{0.012, -0.007, 0.003}, {1, 0, 0}, {0, -1, 0}, mapping};
        const StrokeSamples trace = make_trace(place, scattered(200, 0.06));
        const SurfaceTrace mapped = map_to_surface(query, trace);
        ASSERT_EQ(mapped.samples.size(), trace.samples.size());
        EXPECT_EQ(mapped.missed, 0u);
        EXPECT_NEAR(mapped.origin_gap, 0.003, 1e-9);
        for (std::size_t i = 0; i < mapped.samples.size(); ++i) {
            const Vec3 want(0.012 + trace.samples[i].position.x, -0.007 - trace.samples[i].position.y, 0);
            // Vertices are floats: 0.1 m carries 7e-9 m.
            EXPECT_LT(glm::length(mapped.samples[i].position - want), 5e-8);
            EXPECT_LT(glm::length(mapped.samples[i].right - Vec3(1, 0, 0)), 1e-6);
            EXPECT_LT(glm::length(mapped.samples[i].down - Vec3(0, -1, 0)), 1e-6);
        }
    }
}

TEST(Placement, AnchorsSnapToThePointOfTheSurfaceInAPlane) {
    const TriangleMesh cylinder = make_cylinder();
    const SurfaceQuery query(cylinder);
    const double sagitta = kCylinderRadius * (1 - std::cos(pi / 180));
    for (const double offset : {0.0, 0.01, -0.03}) {
        const SnapPlane plane{.through = {offset, 0.3, 0.2}, .normal = {1, 0, 0}};
        // A circle and an upright plane cross at (d, ± √(r² − d²)); the facets lie within the sagitta of the circle,
        // and the crossing moves by that over the sine of the angle between plane and surface.
        const double y = std::sqrt(kCylinderRadius * kCylinderRadius - offset * offset);
        const auto at = surface_point_in_plane(query, {offset + 0.004, y, 0.02}, plane, 0.02);
        ASSERT_TRUE(at);
        EXPECT_NEAR(at->position.x, offset, 1e-6);
        EXPECT_NEAR(at->position.y, y, sagitta * kCylinderRadius / y + 1e-6);
        EXPECT_NEAR(at->position.z, 0.02, 1e-5);
    }
    EXPECT_FALSE(surface_point_in_plane(query, {0.05, 0, 0}, {.through = {0.06, 0, 0}, .normal = {1, 0, 0}}, 0.02));
    EXPECT_FALSE(surface_point_in_plane(query, {0.05, 0, 0}, {.through = {0, 0, 0}, .normal = {1, 0, 0}}, 0.02))
        << "farther than its reach";
}

TEST(Placement, WrapOnACylinderUnrollsIt) {
    // A prism with n sides is developable too: lengths round it are those of the prism, which
    // are shorter than the circle's by (pi/n)²/6 = 5e-5; positions are off by the sagitta.
    const TriangleMesh cylinder = make_cylinder();
    const SurfaceQuery query(cylinder);
    const double a0 = 2 * pi * 0.5 / 180;
    const Placement place{{0.05 * std::cos(a0), 0.05 * std::sin(a0), 0.01},
                          {-std::sin(a0), std::cos(a0), 0},
                          {0, 0, -1},
                          SurfaceMapping::wrap};
    const StrokeSamples trace = make_trace(place, scattered(300, 0.045));
    const SurfaceTrace mapped = map_to_surface(query, trace);
    EXPECT_EQ(mapped.missed, 0u);
    const double sagitta = kCylinderRadius * (1 - std::cos(pi / 180));
    for (std::size_t i = 0; i < mapped.samples.size(); ++i) {
        const Vec3 flat = trace.samples[i].position;
        const double a = a0 + flat.x / kCylinderRadius;
        const Vec3 want(kCylinderRadius * std::cos(a), kCylinderRadius * std::sin(a), 0.01 - flat.y);
        EXPECT_LT(glm::length(mapped.samples[i].position - want), 2 * sagitta + 0.045 * 1e-4);
        // The frame does not turn; the facets' normals differ from the circle's by pi/180 at most.
        EXPECT_LT(glm::length(mapped.samples[i].right - Vec3(-std::sin(a), std::cos(a), 0)), 0.02);
        EXPECT_LT(glm::length(mapped.samples[i].down - Vec3(0, 0, -1)), 1e-5);
    }
}

TEST(Placement, WrapOnASphereWalksGreatCircles) {
    const Vec3 n0 = glm::normalize(Vec3(0.3, -0.8, 0.35));
    const Frame frame = make_frame(kSphereRadius * n0, n0, {0, 0, 1});
    const Placement place{frame.origin, frame.t, -frame.b, SurfaceMapping::wrap};
    const std::vector<Vec2> points = scattered(200, 0.05);
    double worst[2];
    for (int level = 0; level < 2; ++level) {
        const TriangleMesh sphere = make_sphere(level ? 128 : 64);
        const SurfaceQuery query(sphere);
        const SurfaceTrace mapped = map_to_surface(query, make_trace(place, points));
        worst[level] = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double length = glm::length(points[i]), angle = length / kSphereRadius;
            const Vec3 heading = (points[i].x * frame.t - points[i].y * frame.b) / length;
            const Vec3 want = kSphereRadius * (std::cos(angle) * n0 + std::sin(angle) * heading);
            worst[level] = std::max(worst[level], glm::length(mapped.samples[i].position - want));
            // Parallel transport along a great circle keeps the angle to it.
            const Vec3 along = std::cos(angle) * heading - std::sin(angle) * n0;
            const SurfaceSample& s = mapped.samples[i];
            EXPECT_NEAR(glm::dot(s.right, along), points[i].x / length, 0.02);
            EXPECT_NEAR(glm::dot(s.down, along), points[i].y / length, 0.02);
            EXPECT_NEAR(glm::length(s.right), 1, 1e-12);
            EXPECT_NEAR(glm::dot(s.right, s.normal), 0, 1e-12);
            EXPECT_NEAR(glm::dot(s.right, s.down), 0, 1e-12);
        }
    }
    // 0.05 m away on 1.6 and 3.1 mm triangles. A vertex carries the curvature around it, so a
    // line bends only at vertices' sides: error falls at least linearly with the edge.
    EXPECT_LT(worst[0], 8e-4);
    EXPECT_LT(worst[1], 4e-4);
    EXPECT_LT(worst[1], 0.7 * worst[0]);
}

TEST(Placement, WalkThereAndBackReturns) {
    const TriangleMesh sphere = make_sphere();
    const SurfaceQuery query(sphere);
    for (int i = 0; i < 50; ++i) {
        const Vec3 p{uniform(1, 3 * i) - 0.5, uniform(1, 3 * i + 1) - 0.5, uniform(1, 3 * i + 2) - 0.5};
        const auto start = query.closest_point(p);
        ASSERT_TRUE(start);
        const StraightestGeodesic there = trace_geodesic(sphere, *start, Vec3(0.3, 1, -0.2), 0.1);
        const StraightestGeodesic back = trace_geodesic(sphere, there.end, -there.direction, 0.1);
        // Straightest lines are reversible. One that meets a vertex within rounding is not;
        // none of these does. 100 crossings of 1e-7 edge each give 1e-8 m.
        EXPECT_LT(glm::length(back.end.position - start->position), 1e-7) << i;
        EXPECT_DOUBLE_EQ(there.end.distance, 0.1);
    }
}

TEST(Placement, LinePastABorderGoesOnFlat) {
    const TriangleMesh sheet = make_sheet();
    const SurfaceQuery query(sheet);
    const Placement place{{0.09, 0, 0}, {1, 0, 0}, {0, -1, 0}, SurfaceMapping::wrap};
    const SurfaceTrace mapped = map_to_surface(query, make_trace(place, {{0, 0}, {0.005, 0.001}, {0.025, 0.01}}));
    EXPECT_EQ(mapped.missed, 1u);
    EXPECT_FALSE(mapped.samples[2].on_surface);
    EXPECT_LT(glm::length(mapped.samples[2].position - Vec3(0.115, -0.01, 0)), 5e-8);
    EXPECT_NEAR(mapped.samples[2].on.position.x, 0.1, 1e-8);
}

TEST(Placement, WalkFromEveryVertexAlongEveryEdgeEnds) {
    const TriangleMesh sheet = make_sheet(0.2, 5);
    for (std::uint32_t t = 0; t < sheet.n_triangles(); ++t)
        for (int k = 0; k < 3; ++k) {
            const auto start = mesh::surface_point(sheet, t, k == 1, k == 2);
            for (int other = 0; other < 3; ++other) {
                if (other == k) continue;
                const Vec3 d = sheet.position(t, other) - sheet.position(t, k);
                const StraightestGeodesic w = trace_geodesic(sheet, start, d, 1.0);  // always reaches the border
                const Vec3 want = start.position + w.end.distance * glm::normalize(d);
                EXPECT_GT(w.beyond, 0.7);
                EXPECT_LT(glm::length(w.end.position - want), 1e-6);
            }
        }
}

TEST(Placement, ProjectTakesTheFirstSurfaceFromOutside) {
    const TriangleMesh sphere = make_sphere();
    const SurfaceQuery query(sphere);
    const Placement place{{0, 0, 0}, {0, 1, 0}, {0, 0, -1}, SurfaceMapping::project};  // seen from +x
    const std::vector<Vec2> points = scattered(100, 0.03);
    const SurfaceTrace mapped = map_to_surface(query, make_trace(place, points));
    EXPECT_EQ(mapped.missed, 0u);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 p = mapped.samples[i].position;
        EXPECT_NEAR(p.y, points[i].x, 1e-8);
        EXPECT_NEAR(p.z, -points[i].y, 1e-8);
        // On the facets: at most their sagitta below the sphere, steeper where it turns away.
        EXPECT_NEAR(p.x, std::sqrt(kSphereRadius * kSphereRadius - glm::dot(points[i], points[i])), 5e-5);
    }
    const SurfaceTrace off = map_to_surface(query, make_trace(place, {{0.03, 0}, {0.049, 0}, {0.06, 0}, {0.08, 0}}));
    EXPECT_EQ(off.missed, 2u);
    EXPECT_NEAR(off.samples[3].position.y, 0.08, 1e-12);
    EXPECT_NEAR(off.samples[3].position.x, off.samples[1].position.x, 1e-12);
}

TEST(Placement, HeldTuftReachesThePressedDepth) {
    const TriangleMesh sphere = make_sphere();
    const SurfaceQuery query(sphere);
    StrokeSamples trace = make_trace({{0, -1, 0}, {1, 0, 0}, {0, 0, -1}, SurfaceMapping::wrap}, scattered(40, 0.02));
    for (std::size_t i = 0; i < trace.samples.size(); ++i) {
        trace.samples[i].pressure = double(i % 5) / 4;
        trace.samples[i].tilt = {0.3 * uniform(3, i), -0.4 * uniform(4, i)};
    }
    const HolderOptions options{.tuft_length = 0.03, .working_depth = 0.01, .hover = 0.004, .steady = 0, .tip_lag = {}};
    const HandPath path = hand_path(query, trace, options);
    ASSERT_EQ(path.poses.size(), trace.samples.size());
    for (std::size_t i = 0; i < path.poses.size(); ++i) {
        const SurfaceSample& s = path.mapped.samples[i];
        const brush::Pose& pose = path.poses[i];
        const Vec3 tip = pose.position + options.tuft_length * pose.axis();
        const double want = s.pressure > 0 ? -s.pressure * options.working_depth : options.hover;
        EXPECT_LT(glm::length(tip - s.position - want * s.normal), 1e-12);
        const Vec3 up = -pose.axis();  // leans by the tilt in both planes
        EXPECT_NEAR(glm::dot(up, s.right) / glm::dot(up, s.normal), std::tan(s.tilt.x), 1e-12);
        EXPECT_NEAR(glm::dot(up, s.down) / glm::dot(up, s.normal), std::tan(s.tilt.y), 1e-12);
        EXPECT_EQ(pose.time, s.time);
    }
}

/// Of a holder that leans along its broad side: however both are turned on the surface.
TEST(Placement, ABroadSideThatTheHolderLeansAlongStaysInItsPlane) {
    const HolderOptions options{.tuft_length = 0.03, .steady = 0, .tip_lag = {}};
    for (const double turn : {0.3, 0.8, 2.0, -1.2}) {
        const Vec2 along = std::tan(0.4) * Vec2(std::cos(turn), -std::sin(turn));  // y of a trace is down
        const brush::Pose pose = pose_holder(Vec3(0), 0, {.tilt = glm::atan(along), .roll = turn}, options);
        const Vec3 x = pose.rotation * Vec3(1, 0, 0), across(-std::sin(turn), std::cos(turn), 0);
        EXPECT_NEAR(glm::dot(-pose.axis(), across), 0, 1e-12) << turn;
        EXPECT_NEAR(glm::dot(x, across), 0, 1e-12) << turn;
    }
}

/// Heights of the unbent tip over z = 0, pressed with 0.5, on a straight path along x from -20 to 20 mm over the ground
/// z(x), which has 0.25 mm between vertices.
std::vector<double> tip_heights(const std::function<double(double)>& z, double scale = 1) {
    const TriangleMesh m = make_grid(
        320, 40,
        [&](double u, double v) {
            const double x = 0.08 * (u - 0.5);
            return scale * Vec3(x, 0.08 * (v - 0.5), z(x));
        },
        [](const Vec3&) { return Vec3(0, 0, 1); });
    const SurfaceQuery query(m);
    std::vector<Vec2> points;
    for (int i = -200; i <= 200; ++i) points.push_back(scale * Vec2(1e-4 * i, 1.3e-5 * i));
    const HolderOptions options{
        .tuft_length = 0.02 * scale, .working_depth = 0.01 * scale, .steady = 0.008 * scale, .tip_lag = {}};
    std::vector<double> heights;
    for (const brush::Pose& pose :
         hand_path(query, make_trace({{0, 0, scale * z(0)}, {1, 0, 0}, {0, -1, 0}, SurfaceMapping::project}, points),
                   options)
             .poses)
        heights.push_back((pose.position + options.tuft_length * pose.axis()).z / scale +
                          0.5 * options.working_depth / scale);
    return heights;
}

TEST(Placement, SteadyHandPassesOverGrooves) {
    // Slots as a shut line has them, with walls of 0.25 mm, and one as wide as half of what the hand levels.
    for (const double width : {0.0015, 0.0025, 0.004})
        for (const double height : tip_heights([=](double x) { return std::abs(x) < 0.5 * width ? -2.5e-3 : 0; }))
            // Samples in the slot pull the fit by some of 1 % of the radius each, 80 µm; 2.5 mm would be to dip in.
            EXPECT_NEAR(height, 0, 1.5e-4) << width;
}

TEST(Placement, SteadyHandFollowsRidgesAndValleys) {
    // A ridge, as that of a nose, and a valley: a hyperbola of slopes +-0.8 with a radius of 4 mm.
    for (const double sign : {-1.0, 1.0}) {
        const auto ground = [=](double x) { return sign * 0.8 * std::hypot(x, 0.8 * 0.004); };
        const std::vector<double> heights = tip_heights(ground);
        // Half of the depth that a line of 1 mm takes with a brush of 10 mm. The mean over 8 mm is 1.4 mm off at the
        // top.
        for (std::size_t i = 0; i < heights.size(); ++i)
            EXPECT_NEAR(heights[i], ground(1e-4 * (double(i) - 200)), 2.5e-4) << i;
    }
}

TEST(Placement, SteadyHandDoesNotTrembleOnNoise) {
    // Vertices 1 mm apart with +-0.4 mm, evenly distributed, as a poor scan has them: the surface has 0.15 mm rms.
    TriangleMesh m = make_grid(
        80, 80, [](double u, double v) { return Vec3(0.08 * (u - 0.5), 0.08 * (v - 0.5), 0); },
        [](const Vec3&) { return Vec3(0, 0, 1); });
    for (std::size_t i = 0; i < m.positions.size(); ++i) m.positions[i].z += float(0.0004 * (2 * uniform(5, i) - 1));
    m.bounds.add(Vec3(0, 0, 4e-4));
    m.bounds.add(Vec3(0, 0, -4e-4));
    const SurfaceQuery query(m);
    std::vector<Vec2> points;
    for (int i = -200; i <= 200; ++i) points.push_back(Vec2(1e-4 * i, 1.3e-5 * i));
    const StrokeSamples trace = make_trace({{0, 0, 0}, {1, 0, 0}, {0, -1, 0}, SurfaceMapping::drape}, points);
    const auto unsteadiness = [&](double steady) {
        const HolderOptions options{.steady = steady, .tip_lag = {}};
        double sum = 0, squares = 0;
        for (const brush::Pose& pose : hand_path(query, trace, options).poses) {
            const double z = (pose.position + options.tuft_length * pose.axis()).z;
            sum += z, squares += z * z;
        }
        return std::sqrt(squares / double(points.size()) - sum * sum / double(points.size() * points.size()));
    };
    // 0.25 of it measured: the mean over some ten vertices, which is what a disk of 2 to 8 mm and 4 mm of the path
    // hold.
    EXPECT_LT(unsteadiness(0.008), 0.3 * unsteadiness(0));
}

TEST(Placement, SteadyHandDoesTheSameInEverySize) {
    const auto ground = [](double x) { return 0.002 * std::sin(700 * x) - (std::abs(x - 0.003) < 0.001 ? 0.002 : 0); };
    const std::vector<double> whole = tip_heights(ground), small = tip_heights(ground, 0.25);
    // Rays start and end at floats: 1e-7 of 80 mm, and where one falls beside an edge for it, part of the slot.
    for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_NEAR(small[i], whole[i], 3e-5) << i;
}

TEST(Placement, SteadyHandKeepsItsHeightOnCurvedSurfaces) {
    const TriangleMesh cylinder = make_cylinder();
    const SurfaceQuery query(cylinder);
    std::vector<Vec2> points;
    for (int i = 0; i <= 400; ++i) points.push_back({1e-4 * i, 0});
    StrokeSamples trace = make_trace({{kCylinderRadius, 0, 0}, {0, 1, 0}, {0, 0, -1}, SurfaceMapping::wrap}, points);
    const HolderOptions options{.tip_lag = {}};
    const double shift = options.steady * options.steady / (200 * kCylinderRadius);
    for (const brush::Pose& pose : hand_path(query, trace, options).poses) {
        const double r = std::hypot(pose.position.x, pose.position.y);
        const double want = kCylinderRadius + options.tuft_length - 0.5 * options.working_depth;
        EXPECT_NEAR(r, want, shift + 2e-5);  // facets lie inside the circle
    }
}

TEST(Placement, TipLagCompensationIsAheadAndTurnsWithThePath) {
    // Straight: ahead by the length for the depth, once the tip has touched.
    std::vector<Vec2> points;
    for (int i = 0; i <= 100; ++i) points.push_back({1e-4 * i, 0});
    StrokeSamples trace = make_trace({}, points);
    const HolderOptions options{
        .working_depth = 0.008, .tip_lag = {{0.002, 0.001}, {0.006, 0.005}}, .tip_lag_turn = 1e-3};
    StrokeSamples led = compensate_tip_lag(trace, options);
    ASSERT_GT(led.samples.size(), trace.samples.size());
    std::size_t touch = led.samples.size() - trace.samples.size();
    EXPECT_NEAR(led.samples[touch].position.x, 0.003, 1e-12);
    EXPECT_NEAR(led.samples[touch + 100].position.x, 0.01 + 0.003, 1e-12);  // depth 4 mm
    // The tip touches where the trace begins, and trails while the hand presses.
    EXPECT_NEAR(led.samples[0].pressure, 0, 1e-6);
    EXPECT_NEAR(led.samples[0].position.x, 0, 1e-3) << "the shortest lag of the table";
    for (std::size_t i = 1; i <= touch; ++i) {
        EXPECT_GT(led.samples[i].pressure, led.samples[i - 1].pressure);
        EXPECT_GE(led.samples[i].position.x, led.samples[i - 1].position.x);
        EXPECT_GT(led.samples[i].time, led.samples[i - 1].time);
    }
    // On a circle a string of length l lags by asin(l/2R)-like angle: steady tractrix,
    // sin φ = l/R with the string tangent to the inner circle of radius sqrt(R² - l²).
    const double radius = 0.01, l = options.tip_lag_turn;
    points.clear();
    for (int i = 0; i <= 20000; ++i) points.push_back(radius * Vec2(std::cos(1e-3 * i), std::sin(1e-3 * i)));
    trace = make_trace({}, points);
    led = compensate_tip_lag(trace, options);
    const Vec2 p(trace.samples.back().position), d = (Vec2(led.samples.back().position) - p) / 0.003;
    EXPECT_NEAR(glm::length(d), 1, 1e-9);
    EXPECT_NEAR(glm::dot(d, p / radius), l / radius, 6e-4);  // half a sample's step over R: 5e-4
    // There and back: the lag passes through zero and turns round.
    points.clear();
    for (int i = 0; i <= 200; ++i) points.push_back({1e-4 * (i <= 100 ? i : 200 - i), 0});
    led = compensate_tip_lag(make_trace({}, points), options);
    touch = led.samples.size() - points.size();
    EXPECT_NEAR(led.samples[touch + 110].position.x, 0.009, 1e-9);  // the string is slack after one length
    EXPECT_NEAR(led.samples[touch + 200].position.x, -0.003, 1e-9);
    // A dot is set to the right and down, or to where the holder leans.
    StrokeSamples dot = make_trace({}, {{0.01, 0.02}, {0.01, 0.02}});
    const auto gone = [&] { return Vec2(compensate_tip_lag(dot, options).samples.back().position) - Vec2(0.01, 0.02); };
    EXPECT_LT(glm::distance(gone(), 0.003 * Vec2(std::sqrt(0.5))), 1e-12);
    for (StrokeSample& s : dot.samples) s.tilt = {0, -0.2};
    EXPECT_LT(glm::distance(gone(), Vec2(0, -0.003)), 1e-12);
    // No lag: nothing moves.
    led = compensate_tip_lag(trace, {.tip_lag = {}});
    EXPECT_EQ(led.samples[77].position, trace.samples[77].position);
}

TEST(Placement, RefusesWhatCannotBeMapped) {
    const TriangleMesh sheet = make_sheet(0.2, 3);
    const SurfaceQuery query(sheet);
    StrokeSamples trace = make_trace({}, {{0, 0}});
    trace.placement.down = {2, 0, 0};
    EXPECT_THROW(map_to_surface(query, trace), Error);
    trace = make_trace({}, {{0, std::nan("")}});
    EXPECT_THROW(map_to_surface(query, trace), Error);
    trace = make_trace({}, {{0, 0}});
    trace.flat = false;
    EXPECT_THROW(map_to_surface(query, trace), Error);
}

}  // namespace
}  // namespace tuft::stroke
