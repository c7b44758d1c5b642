#include "stroke/placement/drape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/system/parallel.h"
#include "grids.h"

namespace tuft::stroke {
namespace {

/// Letters are written over this many metres to each side.
constexpr double kReach = 0.03;

Placement upright_at(const Vec3& p, const Vec3& n, SurfaceMapping mapping) {
    const Vec3 right = glm::normalize(glm::cross(Vec3{0, 0, 1}, n));
    return {p, right, glm::cross(right, n), mapping};
}

/// A zigzag over the square of the reach in steps of 0.5 mm.
std::vector<Vec2> zigzag() {
    std::vector<Vec2> points;
    for (int row = -6; row <= 6; ++row)
        for (int k = -60; k <= 60; ++k) points.push_back(kReach * Vec2((row % 2 ? -k : k) / 60.0, row / 6.0));
    return points;
}

/// Quotients of the distance of neighbours on the ground to that on paper, along the rows,
/// with the height over the ground left out (`up`: its direction at a place).
template <class Up>
std::pair<double, double> stretch(const SurfaceTrace& mapped, const std::vector<Vec2>& points, Up up) {
    double least = 1e9, most = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
        if (points[i].y != points[i - 1].y) continue;
        Vec3 d = mapped.samples[i].position - mapped.samples[i - 1].position;
        const Vec3 n = up(mapped.samples[i].position);
        d -= glm::dot(d, n) * n;
        const double q = glm::length(d) / glm::length(points[i] - points[i - 1]);
        least = std::min(least, q);
        most = std::max(most, q);
    }
    return {least, most};
}

/// The sphere with noise of +-0.4 mm on its vertices, 1 mm apart, as a poor scan has it.
TriangleMesh rough_sphere() {
    TriangleMesh m = make_sphere(160);
    for (std::size_t i = 0; i < m.positions.size(); ++i)
        m.positions[i] *= 1 + float(0.0004 / kSphereRadius * (2 * uniform(3, i) - 1));
    return m;
}

// Strokes of a drawing share the lines from its place; who asked before, and in how many threads, changes nothing.
TEST(Drape, SharedLinesGiveTheBitsOfOnesOwn) {
    const TriangleMesh ball = rough_sphere();
    const auto query = std::make_shared<const SurfaceQuery>(ball);
    const Placement front = upright_at({0, -kSphereRadius, 0}, {0, -1, 0}, SurfaceMapping::drape);
    std::vector<StrokeSamples> traces;
    for (std::uint64_t i = 0; i < 8; ++i) {
        const Placement place =
            i % 4 ? front : upright_at({0, 0.1 * double(i) * kSphereRadius, kSphereRadius}, {1, 0, 0}, front.mapping);
        std::vector<Vec2> points = scattered(12, 0.02);
        for (Vec2& p : points) p += Vec2(0.001 * double(i), 0);
        traces.push_back(make_trace(place, points));
    }
    Drapes shared(query);
    std::vector<SurfaceTrace> together(traces.size());
    parallel_for(traces.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) together[i] = map_to_surface(*query, traces[i], &shared);
    });
    for (std::size_t i = 0; i < traces.size(); ++i) {
        const SurfaceTrace alone = map_to_surface(*query, traces[i]);
        for (std::size_t k = 0; k < alone.samples.size(); ++k) {
            EXPECT_EQ(together[i].samples[k].position, alone.samples[k].position);
            EXPECT_EQ(together[i].samples[k].normal, alone.samples[k].normal);
            EXPECT_EQ(together[i].samples[k].right, alone.samples[k].right);
        }
    }
    EXPECT_EQ(shared.of(front), shared.of(front));
}

// What a trace far off needs, up to 375 MB, is not kept.
TEST(Drape, LargeOnesAreNotKept) {
    const TriangleMesh ball = rough_sphere();
    const auto query = std::make_shared<const SurfaceQuery>(ball);
    const Placement front = upright_at({0, -kSphereRadius, 0}, {0, -1, 0}, SurfaceMapping::drape);
    const StrokeSamples trace = make_trace(front, scattered(12, 0.02));
    Drapes shared(query), none(query, 0);
    const auto first = shared.of(front), other = none.of(front);
    const SurfaceTrace kept = map_to_surface(*query, trace, &shared), dropped = map_to_surface(*query, trace, &none);
    EXPECT_EQ(shared.of(front), first);
    EXPECT_NE(none.of(front), other);
    EXPECT_EQ(other->bytes(), first->bytes());
    EXPECT_GE(first->bytes(), sizeof(SurfacePatch) * 12 * 2);
    for (std::size_t k = 0; k < kept.samples.size(); ++k)
        EXPECT_EQ(kept.samples[k].position, dropped.samples[k].position);
}

TEST(Drape, OnAPlaneIsTheIdentity) {
    const TriangleMesh sheet = make_sheet();
    const SurfaceQuery query(sheet);
    const StrokeSamples trace =
        make_trace({{0.012, -0.007, 0}, {1, 0, 0}, {0, -1, 0}, SurfaceMapping::drape}, scattered(200, 0.05));
    const SurfaceTrace mapped = map_to_surface(query, trace);
    EXPECT_EQ(mapped.missed, 0u);
    for (std::size_t i = 0; i < mapped.samples.size(); ++i) {
        const Vec3 flat = trace.samples[i].position;
        // Between lines two degrees apart: chords, short by (2 degrees)²/8 = 1.5e-4 of 70 mm.
        EXPECT_LT(glm::length(mapped.samples[i].position - Vec3(0.012 + flat.x, -0.007 - flat.y, 0)), 1.1e-5);
        EXPECT_LT(glm::length(mapped.samples[i].right - Vec3(1, 0, 0)), 1e-5);
        EXPECT_LT(glm::length(mapped.samples[i].down - Vec3(0, -1, 0)), 1e-5);
    }
}

TEST(Drape, UnrollsACylinder) {
    const TriangleMesh cylinder = make_cylinder();
    const SurfaceQuery query(cylinder);
    const Placement place{{kCylinderRadius, 0, 0.01}, {0, 1, 0}, {0, 0, -1}, SurfaceMapping::drape};
    const StrokeSamples trace = make_trace(place, scattered(300, 0.035));
    const SurfaceTrace mapped = map_to_surface(query, trace);
    EXPECT_EQ(mapped.missed, 0u);
    for (std::size_t i = 0; i < mapped.samples.size(); ++i) {
        const Vec3 flat = trace.samples[i].position;
        const double a = flat.x / kCylinderRadius;
        const Vec3 want(kCylinderRadius * std::cos(a), kCylinderRadius * std::sin(a), 0.01 - flat.y);
        // 0.2 % of the length, as the header says: the paraboloid over 8 mm of a radius of 40 mm.
        EXPECT_LT(glm::length(mapped.samples[i].position - want), 2e-5 + 0.002 * glm::length(flat)) << i;
        EXPECT_LT(glm::length(mapped.samples[i].down - Vec3(0, 0, -1)), 0.01);
    }
}

TEST(Drape, WalksGreatCircles) {
    const Vec3 n0 = glm::normalize(Vec3(0.3, -0.8, 0.35));
    const Frame frame = make_frame(kSphereRadius * n0, n0, {0, 0, 1});
    const TriangleMesh sphere = make_sphere(128);
    const SurfaceQuery query(sphere);
    const std::vector<Vec2> points = scattered(200, 0.05);
    const SurfaceTrace mapped =
        map_to_surface(query, make_trace({frame.origin, frame.t, -frame.b, SurfaceMapping::drape}, points));
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double length = glm::length(points[i]), angle = length / kSphereRadius;
        const Vec3 heading = (points[i].x * frame.t - points[i].y * frame.b) / length;
        const Vec3 want = kSphereRadius * (std::cos(angle) * n0 + std::sin(angle) * heading);
        EXPECT_LT(glm::length(mapped.samples[i].position - want), 3e-5 + 0.002 * length) << i;
        const Vec3 along = std::cos(angle) * heading - std::sin(angle) * n0;
        EXPECT_NEAR(glm::dot(mapped.samples[i].right, along), points[i].x / length, 0.01);
        EXPECT_NEAR(glm::dot(mapped.samples[i].down, along), points[i].y / length, 0.01);
    }
}

TEST(Drape, LettersStayWholeOnANoisyScan) {
    const TriangleMesh rough = rough_sphere();
    const SurfaceQuery query(rough);
    const Vec3 n = glm::normalize(Vec3(0.3, -0.8, 0.35));
    const auto points = zigzag();
    const auto up = [](const Vec3& p) { return glm::normalize(p); };
    const auto drape = stretch(
        map_to_surface(query, make_trace(upright_at(kSphereRadius * n, n, SurfaceMapping::drape), points)), points, up);
    const auto wrap = stretch(
        map_to_surface(query, make_trace(upright_at(kSphereRadius * n, n, SurfaceMapping::wrap), points)), points, up);
    // The map of a sphere itself is narrower away from the middle: sin(a)/a at the corner,
    // a = 0.85, is 0.88. The noise may add as much.
    EXPECT_GT(drape.first, 0.76);
    EXPECT_LT(drape.second, 1.15);
    // Lines over the triangles part: this is what draping is for.
    EXPECT_GT(wrap.second, 2);
}

TEST(Drape, GoesStraightOverGroovesAndGaps) {
    // A plate with a groove 2 mm wide and 3 mm deep and, beyond it, a gap of 1.5 mm to another part.
    const auto plate = [](double from, double to, bool groove) {
        return make_grid(
            int(std::lround((to - from) / 0.0005)), 40,
            [=](double u, double v) {
                const double x = from + u * (to - from);
                const double into = groove ? std::clamp((0.001 - std::abs(x - 0.008)) / 0.0003, 0.0, 1.0) : 0;
                return Vec3(x, 0.1 * (v - 0.5), -0.003 * into);
            },
            [](const Vec3&) { return Vec3(0, 0, 1); });
    };
    TriangleMesh m = plate(-0.05, 0.02, true);
    const TriangleMesh other = plate(0.0215, 0.06, false);
    const auto shift = std::uint32_t(m.positions.size()), shift_t = std::uint32_t(m.triangles.size());
    m.positions.insert(m.positions.end(), other.positions.begin(), other.positions.end());
    m.corner_normals.insert(m.corner_normals.end(), other.corner_normals.begin(), other.corner_normals.end());
    for (auto t : other.triangles) m.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
    for (auto n : other.neighbours) m.neighbours.push_back(n == kNone ? kNone : n + shift_t);
    m.bounds.add(other.bounds.lo);
    m.bounds.add(other.bounds.hi);
    const SurfaceQuery query(m);
    std::vector<Vec2> line;
    for (int i = 0; i <= 400; ++i) line.push_back(Vec2(0.0001 * i, 0.00003 * i));
    const SurfaceTrace mapped =
        map_to_surface(query, make_trace({{0, 0, 0}, {1, 0, 0}, {0, -1, 0}, SurfaceMapping::drape}, line));
    for (std::size_t i = 0; i < line.size(); ++i) {
        const SurfaceSample& s = mapped.samples[i];
        const double across = std::hypot(s.position.x - line[i].x, s.position.y + line[i].y);
        // Where wrap would be 6 mm short. A tenth of the groove's depth is what it may tilt.
        EXPECT_LT(across, 3e-4) << i;
        EXPECT_GT(s.normal.z, 0.99) << i;
    }
    EXPECT_LT(mapped.missed, 20u) << "samples over the gap only";
    const SurfaceTrace wrapped =
        map_to_surface(query, make_trace({{0, 0, 0}, {1, 0, 0}, {0, -1, 0}, SurfaceMapping::wrap}, line));
    EXPECT_GT(line[150].x - wrapped.samples[150].position.x, 0.004);
}

TEST(Drape, DoesNotDependOnTheOtherSamples) {
    const TriangleMesh rough = rough_sphere();
    const SurfaceQuery query(rough);
    const Vec3 n = glm::normalize(Vec3(0.3, -0.8, 0.35));
    const Placement place = upright_at(kSphereRadius * n, n, SurfaceMapping::drape);
    const auto points = scattered(50, kReach);
    const SurfaceTrace all = map_to_surface(query, make_trace(place, points));
    for (std::size_t i = 0; i < points.size(); i += 7)
        EXPECT_EQ(map_to_surface(query, make_trace(place, {points[i]})).samples[0].position, all.samples[i].position);
}

TEST(Drape, PastABorderGoesOnFlat) {
    const TriangleMesh sheet = make_sheet();
    const SurfaceQuery query(sheet);
    const SurfaceTrace mapped =
        map_to_surface(query, make_trace({{0.09, 0, 0}, {1, 0, 0}, {0, -1, 0}, SurfaceMapping::drape},
                                         {{0, 0}, {0.005, 0.001}, {0.025, 0.01}}));
    EXPECT_EQ(mapped.missed, 1u);
    EXPECT_FALSE(mapped.samples[2].on_surface);
    EXPECT_LT(glm::length(mapped.samples[2].position - Vec3(0.115, -0.01, 0)), 1.1e-5);
    EXPECT_NEAR(mapped.samples[2].on.position.x, 0.1, 1e-8);
}

}  // namespace
}  // namespace tuft::stroke
