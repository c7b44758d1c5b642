#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>
#include <sstream>

#include "paths.h"
#include "stage.h"

// Where stamps put texels on surfaces whose log map is known.

namespace tuft::footprint {
namespace {

using testing::Unwrapped;
constexpr double kPi = std::numbers::pi;

TEST(Stamp, ExposesOnTheSheetWhatTheFootprintShows) {
    for (const int charts : {1, 3}) {
        Stage stage(testing::sheet(0.06, charts, 360.0 / charts));
        const double texel = 0.06 / 360, r = 40 * texel;
        const Vec3 at{0.0021, -0.0013, 0};
        const Footprint f = disc(make_frame(at, {0, 0, 1}, {0.8, 0.6, 0}), stage.triangle_at(at), r, texel);
        const StampJobs jobs = stage.plan(f);
        EXPECT_FALSE(jobs.piecewise);
        EXPECT_LT(jobs.discrepancy, 1e-5);  // float rounding on a flat sheet, seams or not
        double worst = 0;
        for_exposed(stage, jobs, [&](std::uint32_t slot, int t, float e) {
            const double d = glm::length(Vec3(stage.map.position(slot, t)) - at) / texel;
            worst = std::max(worst, std::abs(e - std::clamp(0.5 - (d - 40), 0.0, 1.0)));
        });
        // Bilinear interpolation of a clamped ramp one cell wide: up to a quadrant at its ends.
        EXPECT_LT(worst, 0.26);
        // Sampling a disc of 40 texels at its texels, 1/255 steps: few parts in 10 000.
        EXPECT_NEAR(deposit_area(stage, jobs) / disc_area(f), 1, 1e-3) << charts;
    }
}

TEST(Stamp, CoversOnTheSphereTheAreaOfTheCap) {
    // A geodesic disc of radius r = q R has 2 (1 − cos q) / q² of πr².
    const double R = 0.02;
    Stage stage(testing::sphere(R, 500, 80));
    const Vec3 n = glm::normalize(Vec3{1, 0.93, 0.2});  // near a seam
    for (const double q : {0.25, 0.5, 1.0}) {
        const Footprint f = disc(make_frame(R * n, n), stage.triangle_at(R * n), q * R, q * R / 64);
        StampJobs jobs = stage.plan(f);
        jobs.piecewise = false;
        const double exact = 2 * (1 - std::cos(q)) / (q * q);
        // Where charts meet, texels are counted by their centres: up to half a texel too much or
        // too little along a diameter of 160 … 640 texels.
        EXPECT_NEAR(deposit_area(stage, jobs) / disc_area(f) / exact, 1, q < 0.3 ? 4e-3 : 2e-3) << q;
    }
}

TEST(Stamp, FollowsTheSphereAndTheCylinder) {
    const double R = 0.02;
    Stage ball(testing::sphere(R, 500, 80));
    for (const double q : {0.25, 0.5, 1.0}) {
        const Vec3 n = glm::normalize(Vec3{1, 0.93, 0.2});
        const Footprint f = disc(make_frame(R * n, n), ball.triangle_at(R * n), q * R, q * R / 64);
        const StampJobs jobs = ball.plan(f);
        const Errors e = errors(ball, jobs, f, q * R, [&](const Vec3& p) {
            const Vec3 m = glm::normalize(p);
            const Vec3 d = m - glm::dot(m, n) * n;
            const double angle = std::acos(std::clamp(glm::dot(m, n), -1.0, 1.0));
            const double s = glm::length(d) > 0 ? R * angle / glm::length(d) : 0;
            return s * Vec2{glm::dot(d, f.frame.t), glm::dot(d, f.frame.b)};
        });
        // Targets: 0.1 % mean, 0.5 % max up to ratio 0.5; 1 % and 6 % at 1.
        EXPECT_LT(e.mean, q <= 0.5 ? 1e-3 : 1e-2) << q;
        EXPECT_LT(e.max, q <= 0.5 ? 5e-3 : 6e-2) << q;
    }
    Stage tube(testing::cylinder(R, 0.06, 5, 10000, 48));
    for (const double q : {0.5, 1.0}) {
        const Vec3 n{std::cos(1.2), std::sin(1.2), 0};
        const Footprint f = disc(make_frame(R * n, n, {0, 0, 1}), tube.triangle_at(R * n), q * R, q * R / 64);
        const StampJobs jobs = tube.plan(f);
        const Errors e = errors(tube, jobs, f, q * R, [&](const Vec3& p) {
            const double angle = std::remainder(std::atan2(p.y, p.x) - 1.2, 2 * kPi);
            return Vec2{p.z, -R * angle};  // t = z, b = n × t = −∂/∂φ
        });
        // A fifth of the circumference in 48 facets: chords and interpolated normals.
        EXPECT_LT(e.mean, 1e-3) << q;
        EXPECT_LT(e.max, 5e-3) << q;
        // A developable surface keeps the area.
        EXPECT_NEAR(deposit_area(tube, jobs) / disc_area(f), 1, 2e-3) << q;
    }
}

/// Cone with its tip at the origin, half angle `alpha`, from slant `s0` to `s1`, in `n` strips.
Unwrapped cone(double alpha, double s0, double s1, int n, double texels_per_metre) {
    std::vector<testing::Patch> patches;
    const double width = 2 * kPi * s1 * std::sin(alpha) / n * texels_per_metre;
    const double height = (s1 - s0) * texels_per_metre;
    for (int k = 0; k < n; ++k) {
        const double a0 = 2 * kPi * k / n, da = 2 * kPi / n;
        const auto angle = [=](double s) { return k == n - 1 && s == 1 ? 0 : a0 + s * da; };
        testing::Patch p;
        p.position = [=](double s, double t) {
            const double a = angle(s), slant = s0 + t * (s1 - s0);
            return slant * Vec3{std::sin(alpha) * std::cos(a), std::sin(alpha) * std::sin(a), std::cos(alpha)};
        };
        p.normal = [=](double s, double) {
            const double a = angle(s);
            return Vec3{std::cos(alpha) * std::cos(a), std::cos(alpha) * std::sin(a), -std::sin(alpha)};
        };
        p.ns = 64;
        p.nt = 32;
        testing::place(p, {8.3 + k * (width + 9), 8.4}, {width, 0}, {0, height});
        patches.push_back(p);
    }
    return testing::build(patches, static_cast<std::uint32_t>(std::max(n * (width + 9), height) + 20));
}

TEST(Stamp, UnrollsTheConesOfTheReferenceTable) {
    // A cone is flat but for its tip: (u, v) = (s sin δ, s cos δ − s0), δ = Δφ sin α. The rows of
    // tests/data/physics/geodesic.csv confirm the formula; the stamps are held against it.
    std::ifstream file(test_data() + "/physics/geodesic.csv");
    ASSERT_TRUE(file);
    int rows = 0;
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with("cone")) continue;
        std::replace(line.begin(), line.end(), ',', ' ');
        std::istringstream in(line.substr(4));
        double v[21];
        for (double& x : v) in >> x;
        ASSERT_TRUE(in);
        const Vec3 from{v[2], v[3], v[4]}, to{v[14], v[15], v[16]};
        const double turned = std::remainder(std::atan2(to.y, to.x) - std::atan2(from.y, from.x), 2 * kPi);
        const double s = glm::length(to), angle = turned * std::sin(v[0]);
        EXPECT_NEAR(s * std::sin(angle), v[17], 1e-9);
        EXPECT_NEAR(s * std::cos(angle) - v[1], v[18], 1e-9);
        ++rows;
    }
    EXPECT_EQ(rows, 37);

    struct Case {
        double alpha, contact, radius;  // of slant and footprint, table's unit: 1 cm here
        double mean, max;               // of the radius
    };
    // On the slope, radius over curvature 0.4 (2 where the disc comes near the tip) and 0.9; then
    // over the tip, whose neighbourhood is
    // cut off at 0.3: behind it the paths from both sides meet. Targets up to ratio 1: 1 %, 6 %.
    for (const Case& c : {Case{1.1, 10, 8, 2e-3, 1e-2}, Case{0.5, 2, 1, 1e-3, 1e-2}, Case{1.1, 10, 13, 2e-3, 2e-2}}) {
        const double unit = 0.01;
        Stage stage(cone(c.alpha, 0.03 * c.contact * unit, 2.4 * c.contact * unit, 3, 64 / (c.radius * unit)));
        const double phi = 0.3;
        const Vec3 out{std::sin(c.alpha) * std::cos(phi), std::sin(c.alpha) * std::sin(phi), std::cos(c.alpha)};
        const Vec3 n{std::cos(c.alpha) * std::cos(phi), std::cos(c.alpha) * std::sin(phi), -std::sin(c.alpha)};
        const Vec3 at = c.contact * unit * out;
        Frame frame = make_frame(at, n, {-std::sin(phi), std::cos(phi), 0});
        const double r = c.radius * unit;
        const Footprint f = disc(frame, stage.triangle_at(at, n), r, r / 64);
        const StampJobs jobs = stage.plan(f);
        double mean = 0, max = 0;
        std::size_t count = 0;
        const double side = glm::dot(frame.b, out);  // +1: v points away from the tip
        for_exposed(stage, jobs, [&](std::uint32_t slot, int t, float) {
            const Vec3 p(stage.map.position(slot, t));
            const double turned = std::remainder(std::atan2(p.y, p.x) - phi, 2 * kPi);
            const double s = glm::length(p), angle = turned * std::sin(c.alpha);
            if (std::abs(turned) > 0.9 * kPi) return;  // the cut locus
            const Vec2 truth{s * std::sin(angle), side * (s * std::cos(angle) - c.contact * unit)};
            const double error = glm::length(place_of(stage, jobs, f, slot, t) - truth) / r;
            mean += error;
            max = std::max(max, error);
            ++count;
        });
        ASSERT_GT(count, 5000u);
        EXPECT_LT(mean / double(count), c.mean) << c.alpha << " " << c.radius;
        EXPECT_LT(max, c.max) << c.alpha << " " << c.radius;
    }
}

TEST(Stamp, UnfoldsARightAngle) {
    for (const bool one_chart : {true, false}) {
        Stage stage(testing::right_angle(0.04, 300, one_chart));
        const double r = 0.01, a = 0.3 * r;
        const Vec3 at{-a, 0.0007, 0};
        const Footprint f = disc(make_frame(at, {0, 0, 1}), stage.triangle_at(at), r, r / 64);
        const StampJobs jobs = stage.plan(f);
        EXPECT_TRUE(jobs.piecewise);
        const Errors e = errors(stage, jobs, f, r, [&](const Vec3& p) {
            return Vec2{p.z < -1e-7 ? a - p.z : p.x + a, p.y - at.y};  // u = a + b beyond the edge
        });
        // Target for creases is 0.5 % at most; flat clusters meet in points of both planes.
        EXPECT_LT(e.max, 1e-3) << one_chart;
        EXPECT_NEAR(deposit_area(stage, jobs) / disc_area(f), 1, 3e-3) << one_chart;
    }
}

TEST(Stamp, RollsOverAFillet) {
    // Two leaves at a right angle with a fillet of ρ = 0.2 r between, rounded out or in: the
    // path over it is ρ π/2 longer. Contact 0.3 r before it.
    const double r = 0.01, rho = 0.2 * r, a = 0.3 * r, side = 0.03, texels = 400;
    for (const double sense : {1.0, -1.0}) {
        testing::Patch level = testing::flat({-side, -0.5 * side, 0}, {side, 0, 0}, {0, side, 0}, 8, 8);
        testing::Patch bend;
        bend.position = [=](double s, double t) {
            const double angle = s * kPi / 2;
            return Vec3{rho * std::sin(angle), (t - 0.5) * side, -sense * rho * (1 - std::cos(angle))};
        };
        bend.normal = [=](double s, double) { return Vec3{sense * std::sin(s * kPi / 2), 0, std::cos(s * kPi / 2)}; };
        bend.ns = 48;
        bend.nt = 8;
        const Vec3 down{0, 0, -sense * side};
        testing::Patch wall = testing::flat({rho, -0.5 * side, -sense * rho}, down, {0, side, 0}, 8, 8);
        const double width = texels / side * rho * kPi / 2;
        testing::place(level, {8.3, 8.3}, {texels, 0}, {0, texels});
        testing::place(bend, {8.3 + texels + 9.2, 8.3}, {width, 0}, {0, texels});
        testing::place(wall, {8.3 + texels + width + 18.7, 8.3}, {texels, 0}, {0, texels});
        Stage stage(testing::build({level, bend, wall}, static_cast<std::uint32_t>(2 * texels + width + 40)));
        const Vec3 at{-a, 0.0007, 0};
        const Footprint f = disc(make_frame(at, {0, 0, 1}), stage.triangle_at(at), r, r / 128);
        const StampJobs jobs = stage.plan(f);
        const Errors e = errors(stage, jobs, f, r, [&](const Vec3& p) {
            const double below = -sense * p.z;
            double u = p.x;
            if (p.x > 0) u = below > rho ? rho * kPi / 2 + below - rho : rho * std::atan2(p.x, rho - below);
            return Vec2{u + a, p.y - at.y};
        });
        // Target for fillets is 0.5 % at most.
        EXPECT_LT(e.mean, 1e-3) << sense;
        EXPECT_LT(e.max, 5e-3) << sense;
        // Two seams of 250 texels, each counted by centres to half a texel, in a disc of 55 000.
        EXPECT_NEAR(deposit_area(stage, jobs) / disc_area(f), 1, 8e-3) << sense;
    }
}

/// The surface without the triangles whose middle is `out`.
Unwrapped pierced(Unwrapped u, const std::function<bool(const Vec3&)>& out) {
    Unwrapped left = u;
    left.mesh.triangles.clear();
    left.mesh.corner_normals.clear();
    left.mesh.neighbours.clear();
    left.atlas.corner_uvs.clear();
    left.atlas.triangle_chart.clear();
    std::vector<std::uint32_t> place(u.mesh.n_triangles(), kNone);
    for (std::uint32_t t = 0; t < u.mesh.n_triangles(); ++t) {
        if (out((u.mesh.position(t, 0) + u.mesh.position(t, 1) + u.mesh.position(t, 2)) / 3.0)) continue;
        place[t] = static_cast<std::uint32_t>(left.mesh.n_triangles());
        left.mesh.triangles.push_back(u.mesh.triangles[t]);
        left.atlas.triangle_chart.push_back(u.atlas.triangle_chart[t]);
        for (std::uint32_t c = 3 * t; c < 3 * t + 3; ++c) {
            left.mesh.corner_normals.push_back(u.mesh.corner_normals[c]);
            left.mesh.neighbours.push_back(u.mesh.neighbours[c]);
            left.atlas.corner_uvs.push_back(u.atlas.corner_uvs[c]);
        }
    }
    for (std::uint32_t& n : left.mesh.neighbours) n = n == kNone ? kNone : place[n];
    return left;
}

TEST(Stamp, LiesOverOpeningsAsOverTheSurfaceWithoutThem) {
    // What lies behind an opening belongs where a print laid over it has it, as the tuft spans it;
    // the way round is longer, and on a curved surface turned by the curvature that it encloses.
    const double R = 0.02;
    for (const double q : {0.0, 0.25, 0.5, -0.5, -1.0}) {  // r/R; below 0: on the cylinder
        const bool ball = q > 0, tube = q < 0;
        const double r = q == 0 ? 0.01 : std::abs(q) * R;
        const Vec3 n = ball   ? glm::normalize(Vec3{1, 0.93, 0.2})
                       : tube ? Vec3{std::cos(1.2), std::sin(1.2), 0}
                              : Vec3{0, 0, 1};
        const Vec3 at = q == 0 ? Vec3{0.0021, -0.0013, 0} : R * n;
        const Frame frame = make_frame(at, n, tube ? Vec3{0, 0, 1} : Vec3{0.8, 0.6, 0.3});
        const auto exact = [&](const Vec3& p) {
            if (tube) return Vec2{p.z, -R * std::remainder(std::atan2(p.y, p.x) - 1.2, 2 * kPi)};
            if (!ball) return Vec2(frame.to_local(p));
            const Vec3 m = glm::normalize(p), d = m - glm::dot(m, n) * n;
            const double angle = std::acos(std::clamp(glm::dot(m, n), -1.0, 1.0));
            const double s = glm::length(d) > 0 ? R * angle / glm::length(d) : 0;
            return s * Vec2{glm::dot(d, frame.t), glm::dot(d, frame.b)};
        };
        const auto round = [](const Vec2& uv) { return glm::length(uv - Vec2{0.35, 0.35}) < 0.25; };
        const auto slit = [](const Vec2& uv) { return std::abs(uv.x - 0.35) < 0.05 && std::abs(uv.y) < 0.45; };
        for (const std::function<bool(Vec2)>& open : {std::function<bool(Vec2)>(round), {slit}}) {
            Stage stage(pierced(ball   ? testing::sphere(R, 500, 160)
                                : tube ? testing::cylinder(R, 0.06, 5, 10000, 192)
                                       : testing::sheet(0.06, 3, 120, 64),
                                [&](const Vec3& p) { return open(exact(p) / r); }));
            const Footprint f = disc(frame, stage.triangle_at(at, n), r, r / 64);
            const StampJobs jobs = stage.plan(f);
            double worst = 0;
            std::size_t behind = 0;
            for_exposed(stage, jobs, [&](std::uint32_t slot, int t, float) {
                const Vec2 truth = exact(Vec3(stage.map.position(slot, t)));
                worst = std::max(worst, glm::length(place_of(stage, jobs, f, slot, t) - truth) / r);
                bool hidden = false;
                for (int k = 1; k < 50; ++k) hidden |= open(truth / r * (k / 50.0));
                behind += hidden;
            });
            EXPECT_GT(behind, 1000u) << q;
            EXPECT_LT(worst, 5e-3) << q;  // as on these surfaces without openings
        }
    }
}

TEST(Stamp, UnfoldsARightAngleWithAnOpeningOverTheEdge) {
    const double r = 0.01, a = 0.3 * r;
    const Vec3 at{-a, 0.0007, 0};
    const auto unfolded = [&](const Vec3& p) { return Vec2{p.z < -1e-7 ? a - p.z : p.x + a, p.y - at.y}; };
    Stage stage(pierced(testing::right_angle(0.04, 300, false), [&](const Vec3& p) {
        return glm::length(unfolded(p) - Vec2{a, 0.2 * r}) < 0.25 * r;
    }));
    const Footprint f = disc(make_frame(at, {0, 0, 1}), stage.triangle_at(at), r, r / 64);
    const StampJobs jobs = stage.plan(f);
    EXPECT_TRUE(jobs.piecewise);
    // Flat leaves: the way round the opening leads to the same place as the straight one.
    EXPECT_LT(errors(stage, jobs, f, r, unfolded).max, 1e-3);
}

TEST(Stamp, PlaneMappingProjectsAlongTheNormals) {
    // On a sphere the paper's mapping puts a point at angle θ at R tan θ instead of R θ: the
    // stamp of radius q R reaches θ = atan q and covers 2 (1 − cos θ) / q² of πr².
    const double R = 0.02, q = 0.5;
    Stage stage(testing::sphere(R, 500, 80));
    const Vec3 n = glm::normalize(Vec3{1, 0.4, 0.2});
    const Footprint f = disc(make_frame(R * n, n), stage.triangle_at(R * n), q * R, q * R / 64);
    const StampJobs jobs = stage.plan(f, {}, {.mapping = Mapping::plane});
    EXPECT_FALSE(jobs.piecewise);
    const double exact = 2 * (1 - std::cos(std::atan(q))) / (q * q);
    EXPECT_NEAR(deposit_area(stage, jobs) / disc_area(f) / exact, 1, 3e-3);
}

}  // namespace
}  // namespace tuft::footprint
