#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "brush/papers/truss_dynamics.h"
#include "brush/papers/truss_force.h"
#include "brush/papers/truss_model.h"
#include "brush/papers/truss_skin.h"
#include "papers_strokes.h"

namespace tuft::brush::truss {
namespace {

/// A pyramid whose springs have no rest length: their force is linear.
Truss linear_truss() {
    Truss truss = make_truss({}, 2e-4);
    for (Spring& s : truss.springs) s.rest = 0;
    return truss;
}

TEST(TrussDynamics, LinearSpringsRelaxWithoutOvershootForAnyStep) {
    const Truss truss = linear_truss();
    for (const double h : {1e-6, 1e-3, 1.0, 1e6}) {
        const std::vector<double> matrix = step_matrix(truss, h);
        std::vector<Vec3> x = truss.rest;
        x[4] = {0.01, -0.02, 0.03};
        Vec3 before = x[4];  // relative to the balance, the centre of the base
        for (int i = 0; i < 20; ++i) {
            move_points(truss, matrix, {}, x);
            const double share = glm::dot(x[4], before) / std::max(glm::dot(before, before), 1e-300);
            EXPECT_GE(share, 0);
            EXPECT_LT(share, 1);
            // Along a straight line; rounding of bases some millimetres away.
            EXPECT_LE(glm::length(x[4] - share * before), 1e-12 * glm::length(before) + 1e-17);
            before = x[4];
            if (glm::length(before) < 1e-12) break;
        }
    }
}

TEST(TrussDynamics, EnergyOfRealSpringsNeverRises) {
    for (const Kind kind : {Kind::round, Kind::flat, Kind::filbert})
        for (const double h : {1e-5, 1e-3, 0.1}) {
            const Truss truss = make_truss({.kind = kind, .half_width = 6e-3}, 2e-4);
            const std::vector<double> matrix = step_matrix(truss, h);
            std::vector<Vec3> x = truss.rest;
            for (int j = 0; j < truss.count; ++j) x[truss.base_count() + j] += Vec3{0.012, 0.004 * j, 0.01};
            double energy = spring_energy(truss, x);
            for (int i = 0; i < 200; ++i) {
                move_points(truss, matrix, {}, x);
                const double now = spring_energy(truss, x);
                // J is as stiff as the springs can be, so each step lowers a bound of the energy.
                EXPECT_LE(now, energy * (1 + 1e-12) + 1e-18);
                energy = now;
            }
        }
}

TEST(TrussDynamics, ThePointHasTheStiffnessOfACantilever) {
    const double b0 = 2e-4;
    const Truss truss = make_truss({.length = 0.03, .half_width = 3e-3, .half_thickness = 3e-3}, b0);
    std::vector<Vec3> x = truss.rest;
    const double d = 1e-7;
    x[4].x += d;
    // Linear in d up to (d/ρ)².
    EXPECT_NEAR(-spring_forces(truss, x)[4].x / d, 3 * b0 / std::pow(0.03, 3), 1e-6 * 3 * b0 / std::pow(0.03, 3));
}

TEST(TrussDynamics, BucklesSidewaysAtTheLoadOfItsSlope) {
    // ρ/ℓ 0.01: the law holds for ρ ≪ ℓ, its next terms are of that square and of the shortening, 2e-4.
    const Truss truss = make_truss({.length = 0.03, .half_width = 3e-4, .half_thickness = 3e-4}, 2e-4);
    const double edge = glm::length(truss.rest[4] - truss.rest[0]), rho = truss.half_diagonal;
    const auto side_force = [&](double depth) {
        std::vector<Vec3> x = truss.rest;
        x[4] += Vec3{1e-9, 0, depth};
        return spring_forces(truss, x)[4].x;
    };
    double low = 0, high = 1e-4;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (side_force(middle) < 0 ? low : high) = middle;
    }
    std::vector<Vec3> x = truss.rest;
    x[4].z += low;
    const double load = -spring_forces(truss, x)[4].z, law = 2 * truss.stiffness * rho * rho / edge;
    EXPECT_NEAR(load, law, 1e-3 * law);
}

TEST(TrussModel, APressedRoundTrailsOnItsCircle) {
    Preset p = papers::plain_preset();
    p.radius = 6e-4;
    p.friction_wet = 0;
    for (const double depth : {0.07, 0.2, 0.4}) {
        papers::Stroke stroke;
        stroke.lean = 0;
        stroke.depth = depth;
        const auto model = make_truss_model(p);
        papers::draw(*model, p, stroke);
        const Vec3 tip = model->nodes().front(), root = model->nodes().back();
        const double law = p.length * std::sqrt(1 - (1 - depth) * (1 - depth));
        // Springs give by their load over their stiffness, some (ρ/ℓ)² of the length over the slope of the circle.
        EXPECT_NEAR(root.x - tip.x, law, 0.02 * p.length) << depth;
        EXPECT_NEAR(tip.z, 0, 1e-12);
    }
}

TEST(TrussModel, NoSpringIsEverTooLong) {
    for (const Kind kind : {Kind::round, Kind::flat, Kind::filbert}) {
        const Truss truss = make_truss({.kind = kind, .half_width = 6e-3, .half_thickness = 2e-3}, 2e-4);
        for (int k = 0; k < 40; ++k) {
            std::vector<Vec3> x = truss.rest;
            for (int i = 0; i < truss.base_count(); ++i) x[i] += Vec3{0.002 * k, 0.001 * k * std::sin(k), 0.02};
            StepContact ground;
            ground.below.assign(truss.count, {Vec3{0, 0, -0.02}, Vec3{0, 0, 1}});
            limit_stretch(truss, ground, x);
            EXPECT_LE(largest_stretch(truss, x), kMostStretch + 1e-12);
            for (int j = 0; j < truss.count; ++j) EXPECT_GE(x[truss.base_count() + j].z, -0.02 - 1e-15);
        }
    }
}

TEST(TrussModel, AFlatDrawsItsWidthAndAFilbertHasShorterSides) {
    const Preset p = papers::plain_preset();
    papers::Stroke stroke;
    stroke.direction = {0, 1, 0};
    stroke.lean = 0;
    const auto flat = make_truss_model(p, Kind::flat, 12e-3, 4e-3);
    const TuftState state = papers::draw(*flat, p, stroke);
    const Section& toe = state.branches.front().sections.front();
    // The drag bends the broad side; the toe lies on the surface with its width. Its ring has the width of an ellipse
    // through eight points, refined.
    EXPECT_NEAR(toe.centre.z, 0, 1e-12);
    EXPECT_NEAR(toe.a, 6e-3, 0.06e-3);
    EXPECT_NEAR(std::abs(toe.e.x), 1, 1e-3);
    const Truss filbert = make_truss({.kind = Kind::filbert, .length = 0.03}, 2e-4);
    EXPECT_EQ(filbert.count, 4);
    EXPECT_NEAR(filbert.rest[16].z, -0.024, 1e-15);
    EXPECT_NEAR(filbert.rest[17].z, -0.03, 1e-15);
}

std::vector<RingShape> cone() {
    std::vector<RingShape> rings;
    for (const double u : {0.0, 0.25, 0.5, 0.75}) rings.push_back({u, 4e-3 * (1 - u), 3e-3 * (1 - u)});
    return rings;
}

TEST(TrussSkin, WeightsSumToOneAndKeepAffineMotions) {
    for (const Kind kind : {Kind::round, Kind::flat, Kind::filbert}) {
        const Truss truss = make_truss({.kind = kind, .half_width = 6e-3, .half_thickness = 2e-3}, 2e-4);
        const ButterflyMesh coarse = make_control_skin(truss, cone()), fine = subdivide(subdivide(coarse));
        EXPECT_EQ(fine.triangles.size(), 16 * coarse.triangles.size());
        const Mat3 a{{1.1, 0.2, -0.1}, {0.05, 0.9, 0.3}, {-0.4, 0.1, 1.2}};
        const Vec3 shift{0.3, -0.2, 0.1};
        std::vector<Vec3> moved;
        for (const Vec3& x : truss.rest) moved.push_back(a * x + shift);
        for (int v = 0; v < fine.vertices(); ++v) {
            double sum = 0;
            for (const double w : fine.row(v)) sum += w;
            EXPECT_NEAR(sum, 1, 1e-12);
            EXPECT_LT(glm::length(place(fine.row(v), moved) - a * place(fine.row(v), truss.rest) - shift), 1e-12);
        }
    }
}

TEST(TrussSkin, RefinementInterpolatesAndClosesAllButTheRoot) {
    const Truss truss = make_truss({}, 2e-4);
    const ButterflyMesh coarse = make_control_skin(truss, cone()), fine = subdivide(coarse);
    for (int v = 0; v < coarse.vertices(); ++v)
        EXPECT_EQ(place(fine.row(v), truss.rest), place(coarse.row(v), truss.rest));
    std::multiset<std::pair<int, int>> edges;
    for (const auto& t : fine.triangles)
        for (int k = 0; k < 3; ++k) edges.insert({t[k], t[(k + 1) % 3]});
    int open = 0;
    for (const auto& [from, to] : edges) {
        EXPECT_EQ(edges.count({from, to}), 1u);  // the same side everywhere
        open += edges.count({to, from}) == 0;
    }
    EXPECT_EQ(open, 2 * kRingPoints);
}

TEST(TrussSkin, SectionsOfTheRestAreThoseOfTheHead) {
    Preset p = papers::plain_preset();
    const auto model = make_truss_model(p);
    const TuftState state = model->step({{}, {}, 0.01, 1});
    for (const Section& s : state.branches.front().sections) {
        EXPECT_NEAR(s.centre.x, 0, 1e-12);
        EXPECT_NEAR(s.a, s.b, 1e-9);
    }
    // Control rings are of the preset's radius at the root.
    EXPECT_NEAR(state.branches.front().sections.back().a, 0.86 * 1.06 * p.radius, 0.01 * p.radius);
}

TEST(TrussForce, MeetsTheHandleWithK1AtAnyTilt) {
    const ForceLaw law{0.5, 20};
    for (const double tilt : {0.0, 0.3, 0.7, 1.2}) {
        EXPECT_NEAR(head_force(0.02, 0.02, tilt, law), law.bristles, 1e-12);
        EXPECT_NEAR(head_force(0.024, 0.02, tilt, law), linear_force(0.024, 0.02, law), 1e-9);
        EXPECT_EQ(head_force(0, 0.02, tilt, law), 0);
        EXPECT_EQ(head_force(-1, 0.02, tilt, law), 0);
        // C¹ at the tuples.
        for (const double d : {0.08, 0.35, 1.0, 1.15}) {
            const auto f = [&](double x) { return head_force(0.02 * x, 0.02, tilt, law); };
            const double e = 1e-6;
            EXPECT_NEAR((f(d) - f(d - e)) / e, (f(d + e) - f(d)) / e, 1e-2);
        }
    }
    EXPECT_EQ(linear_force(0.02, 0.02, law), 0.5);
}

TEST(TrussForce, CompressionFadesSmoothlyToHalfARightAngle) {
    const double end = 0.25 * std::numbers::pi, e = 1e-5;
    EXPECT_EQ(compressive_share(0), 1);
    EXPECT_EQ(compressive_share(end), 0);
    EXPECT_EQ(compressive_share(1.2), 0);
    // γ ≈ 4 (θ − π/4)² there.
    EXPECT_NEAR(compressive_share(end - e), 0, 5 * e * e);
    EXPECT_NEAR(compressive_share(-0.3), compressive_share(0.3), 1e-15);
}

}  // namespace
}  // namespace tuft::brush::truss
