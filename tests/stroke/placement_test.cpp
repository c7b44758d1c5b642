#include "stroke/placement.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/random.h"
#include "grids.h"
#include "stroke/lead.h"

namespace tuft::stroke {
namespace {

TEST(Placement, WrapAndProjectOnTheSheetAreTheIdentity) {
    const TriangleMesh sheet = make_sheet();
    const SurfaceQuery query(sheet);
    for (Laying laying : {Laying::wrap, Laying::project}) {
        const Placement place{{0.012, -0.007, 0.003}, {1, 0, 0}, {0, -1, 0}, laying};
        const Trace trace = make_trace(place, scattered(200, 0.06));
        const LaidTrace laid = lay(query, trace);
        ASSERT_EQ(laid.samples.size(), trace.samples.size());
        EXPECT_EQ(laid.missed, 0u);
        EXPECT_NEAR(laid.origin_gap, 0.003, 1e-9);
        for (std::size_t i = 0; i < laid.samples.size(); ++i) {
            const Vec3 want(0.012 + trace.samples[i].position.x,
                            -0.007 - trace.samples[i].position.y, 0);
            // Vertices are floats: 0.1 m carries 7e-9 m.
            EXPECT_LT(glm::length(laid.samples[i].position - want), 5e-8);
            EXPECT_LT(glm::length(laid.samples[i].right - Vec3(1, 0, 0)), 1e-6);
            EXPECT_LT(glm::length(laid.samples[i].down - Vec3(0, -1, 0)), 1e-6);
        }
    }
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
                          Laying::wrap};
    const Trace trace = make_trace(place, scattered(300, 0.045));
    const LaidTrace laid = lay(query, trace);
    EXPECT_EQ(laid.missed, 0u);
    const double sagitta = kCylinderRadius * (1 - std::cos(pi / 180));
    for (std::size_t i = 0; i < laid.samples.size(); ++i) {
        const Vec3 flat = trace.samples[i].position;
        const double a = a0 + flat.x / kCylinderRadius;
        const Vec3 want(kCylinderRadius * std::cos(a), kCylinderRadius * std::sin(a),
                        0.01 - flat.y);
        EXPECT_LT(glm::length(laid.samples[i].position - want), 2 * sagitta + 0.045 * 1e-4);
        // The frame does not turn; the facets' normals differ from the circle's by pi/180 at most.
        EXPECT_LT(glm::length(laid.samples[i].right - Vec3(-std::sin(a), std::cos(a), 0)), 0.02);
        EXPECT_LT(glm::length(laid.samples[i].down - Vec3(0, 0, -1)), 1e-5);
    }
}

TEST(Placement, WrapOnASphereWalksGreatCircles) {
    const Vec3 n0 = glm::normalize(Vec3(0.3, -0.8, 0.35));
    const Frame frame = make_frame(kSphereRadius * n0, n0, {0, 0, 1});
    const Placement place{frame.origin, frame.t, -frame.b, Laying::wrap};
    const std::vector<Vec2> points = scattered(200, 0.05);
    double worst[2];
    for (int level = 0; level < 2; ++level) {
        const TriangleMesh sphere = make_sphere(level ? 128 : 64);
        const SurfaceQuery query(sphere);
        const LaidTrace laid = lay(query, make_trace(place, points));
        worst[level] = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double length = glm::length(points[i]), angle = length / kSphereRadius;
            const Vec3 heading = (points[i].x * frame.t - points[i].y * frame.b) / length;
            const Vec3 want = kSphereRadius * (std::cos(angle) * n0 + std::sin(angle) * heading);
            worst[level] = std::max(worst[level], glm::length(laid.samples[i].position - want));
            // Parallel transport along a great circle keeps the angle to it.
            const Vec3 along = std::cos(angle) * heading - std::sin(angle) * n0;
            const LaidSample& s = laid.samples[i];
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
        const Vec3 p{uniform(1, 3 * i) - 0.5, uniform(1, 3 * i + 1) - 0.5,
                     uniform(1, 3 * i + 2) - 0.5};
        const auto start = query.closest_point(p);
        ASSERT_TRUE(start);
        const Walk there = walk(sphere, *start, Vec3(0.3, 1, -0.2), 0.1);
        const Walk back = walk(sphere, there.end, -there.direction, 0.1);
        // Straightest lines are reversible. One that meets a vertex within rounding is not;
        // none of these does. 100 crossings of 1e-7 edge each give 1e-8 m.
        EXPECT_LT(glm::length(back.end.position - start->position), 1e-7) << i;
        EXPECT_DOUBLE_EQ(there.end.distance, 0.1);
    }
}

TEST(Placement, LinePastABorderGoesOnFlat) {
    const TriangleMesh sheet = make_sheet();
    const SurfaceQuery query(sheet);
    const Placement place{{0.09, 0, 0}, {1, 0, 0}, {0, -1, 0}, Laying::wrap};
    const LaidTrace laid = lay(query, make_trace(place, {{0, 0}, {0.005, 0.001}, {0.025, 0.01}}));
    EXPECT_EQ(laid.missed, 1u);
    EXPECT_FALSE(laid.samples[2].on_surface);
    EXPECT_LT(glm::length(laid.samples[2].position - Vec3(0.115, -0.01, 0)), 5e-8);
    EXPECT_NEAR(laid.samples[2].on.position.x, 0.1, 1e-8);
}

TEST(Placement, WalkFromEveryVertexAlongEveryEdgeEnds) {
    const TriangleMesh sheet = make_sheet(0.2, 5);
    for (std::uint32_t t = 0; t < sheet.n_triangles(); ++t)
        for (int k = 0; k < 3; ++k) {
            const auto start = mesh::surface_point(sheet, t, k == 1, k == 2);
            for (int other = 0; other < 3; ++other) {
                if (other == k) continue;
                const Vec3 d = sheet.position(t, other) - sheet.position(t, k);
                const Walk w = walk(sheet, start, d, 1.0);  // always reaches the border
                const Vec3 want = start.position + w.end.distance * glm::normalize(d);
                EXPECT_GT(w.beyond, 0.7);
                EXPECT_LT(glm::length(w.end.position - want), 1e-6);
            }
        }
}

TEST(Placement, ProjectTakesTheFirstSurfaceFromOutside) {
    const TriangleMesh sphere = make_sphere();
    const SurfaceQuery query(sphere);
    const Placement place{{0, 0, 0}, {0, 1, 0}, {0, 0, -1}, Laying::project};  // seen from +x
    const std::vector<Vec2> points = scattered(100, 0.03);
    const LaidTrace laid = lay(query, make_trace(place, points));
    EXPECT_EQ(laid.missed, 0u);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 p = laid.samples[i].position;
        EXPECT_NEAR(p.y, points[i].x, 1e-8);
        EXPECT_NEAR(p.z, -points[i].y, 1e-8);
        // On the facets: at most their sagitta below the sphere, steeper where it turns away.
        EXPECT_NEAR(p.x, std::sqrt(kSphereRadius * kSphereRadius - glm::dot(points[i], points[i])),
                    5e-5);
    }
    const LaidTrace off =
        lay(query, make_trace(place, {{0.03, 0}, {0.049, 0}, {0.06, 0}, {0.08, 0}}));
    EXPECT_EQ(off.missed, 2u);
    EXPECT_NEAR(off.samples[3].position.y, 0.08, 1e-12);
    EXPECT_NEAR(off.samples[3].position.x, off.samples[1].position.x, 1e-12);
}

TEST(Placement, HeldTuftReachesThePressedDepth) {
    const TriangleMesh sphere = make_sphere();
    const SurfaceQuery query(sphere);
    Trace trace =
        make_trace({{0, -1, 0}, {1, 0, 0}, {0, 0, -1}, Laying::wrap}, scattered(40, 0.02));
    for (std::size_t i = 0; i < trace.samples.size(); ++i) {
        trace.samples[i].pressure = double(i % 5) / 4;
        trace.samples[i].tilt = {0.3 * uniform(3, i), -0.4 * uniform(4, i)};
    }
    const HoldOptions options{
        .tuft_length = 0.03, .working_depth = 0.01, .hover = 0.004, .lead = {}};
    const HandPath path = hand_path(query, trace, options);
    ASSERT_EQ(path.poses.size(), trace.samples.size());
    for (std::size_t i = 0; i < path.poses.size(); ++i) {
        const LaidSample& s = path.laid.samples[i];
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

TEST(Placement, SteadyHandPassesOverAGroove) {
    // A slot 2.5 mm wide and deep across the way: one sample in each wall, the rest on its floor.
    std::vector<LaidSample> samples(401);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double x = 1e-4 * (double(i) - 200);
        const bool inside = std::abs(x) < 1.25e-3;
        samples[i].position = {x, 0, inside ? -2.5e-3 : 0};
        samples[i].pressure = 0.5;
        if (std::abs(std::abs(x) - 1.2e-3) < 5e-5) samples[i].normal = {x > 0 ? -1 : 1, 0, 0};
    }
    const HoldOptions options{.lead = {}};
    for (const brush::Pose& pose : hold(samples, options)) {
        EXPECT_NEAR(pose.position.z, options.tuft_length - 0.5 * options.working_depth, 1e-12);
        EXPECT_NEAR(pose.axis().z, -1, 1e-12);
    }
}

TEST(Placement, SteadyHandKeepsItsHeightOnCurvedSurfaces) {
    const TriangleMesh cylinder = make_cylinder();
    const SurfaceQuery query(cylinder);
    std::vector<Vec2> points;
    for (int i = 0; i <= 400; ++i) points.push_back({1e-4 * i, 0});
    Trace trace =
        make_trace({{kCylinderRadius, 0, 0}, {0, 1, 0}, {0, 0, -1}, Laying::wrap}, points);
    const HoldOptions options{.lead = {}};
    const double shift = options.steady * options.steady / (8 * kCylinderRadius);
    for (const brush::Pose& pose : hand_path(query, trace, options).poses) {
        const double r = std::hypot(pose.position.x, pose.position.y);
        const double want = kCylinderRadius + options.tuft_length - 0.5 * options.working_depth;
        EXPECT_LT(r, want + 2e-5);                // facets lie inside the circle
        EXPECT_GT(r, want - 1.1 * shift - 2e-5);  // as the header says
    }
}

TEST(Placement, LeadRunsAheadAndTurnsWithThePath) {
    // Straight: ahead by the length for the depth, once the tip has touched.
    std::vector<Vec2> points;
    for (int i = 0; i <= 100; ++i) points.push_back({1e-4 * i, 0});
    Trace trace = make_trace({}, points);
    const HoldOptions options{
        .working_depth = 0.008, .lead = {{0.002, 0.001}, {0.006, 0.005}}, .lead_turn = 1e-3};
    Trace led = lead_hand(trace, options);
    ASSERT_GT(led.samples.size(), trace.samples.size());
    std::size_t touch = led.samples.size() - trace.samples.size();
    EXPECT_NEAR(led.samples[touch].position.x, 0.003, 1e-12);
    EXPECT_NEAR(led.samples[touch + 100].position.x, 0.01 + 0.003, 1e-12);  // depth 4 mm
    // The tip touches where the trace begins, and trails while the hand presses.
    EXPECT_EQ(led.samples[0].pressure, 0);
    EXPECT_NEAR(led.samples[0].position.x, 0, 1e-3) << "the shortest lead of the table";
    for (std::size_t i = 1; i <= touch; ++i) {
        EXPECT_GT(led.samples[i].pressure, led.samples[i - 1].pressure);
        EXPECT_GE(led.samples[i].position.x, led.samples[i - 1].position.x);
        EXPECT_GT(led.samples[i].time, led.samples[i - 1].time);
    }
    // On a circle a string of length l lags by asin(l/2R)-like angle: steady tractrix,
    // sin φ = l/R with the string tangent to the inner circle of radius sqrt(R² - l²).
    const double radius = 0.01, l = options.lead_turn;
    points.clear();
    for (int i = 0; i <= 20000; ++i)
        points.push_back(radius * Vec2(std::cos(1e-3 * i), std::sin(1e-3 * i)));
    trace = make_trace({}, points);
    led = lead_hand(trace, options);
    const Vec2 p(trace.samples.back().position),
        d = (Vec2(led.samples.back().position) - p) / 0.003;
    EXPECT_NEAR(glm::length(d), 1, 1e-9);
    EXPECT_NEAR(glm::dot(d, p / radius), l / radius, 6e-4);  // half a sample's step over R: 5e-4
    // There and back: the lead passes through zero and turns round.
    points.clear();
    for (int i = 0; i <= 200; ++i) points.push_back({1e-4 * (i <= 100 ? i : 200 - i), 0});
    led = lead_hand(make_trace({}, points), options);
    touch = led.samples.size() - points.size();
    EXPECT_NEAR(led.samples[touch + 110].position.x, 0.009, 1e-9);  // the string is slack after one length
    EXPECT_NEAR(led.samples[touch + 200].position.x, -0.003, 1e-9);
    // A dot has no direction.
    led = lead_hand(make_trace({}, {{0.01, 0.02}, {0.01, 0.02}}), options);
    EXPECT_EQ(led.samples[1].position, Vec3(0.01, 0.02, 0));
    // No lead: nothing moves.
    led = lead_hand(trace, {.lead = {}});
    EXPECT_EQ(led.samples[77].position, trace.samples[77].position);
}

TEST(Placement, RefusesWhatCannotBeLaid) {
    const TriangleMesh sheet = make_sheet(0.2, 3);
    const SurfaceQuery query(sheet);
    Trace trace = make_trace({}, {{0, 0}});
    trace.placement.down = {2, 0, 0};
    EXPECT_THROW(lay(query, trace), Error);
    trace = make_trace({}, {{0, std::nan("")}});
    EXPECT_THROW(lay(query, trace), Error);
    trace = make_trace({}, {{0, 0}});
    trace.flat = false;
    EXPECT_THROW(lay(query, trace), Error);
}

}  // namespace
}  // namespace tuft::stroke
