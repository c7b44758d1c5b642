#include <gtest/gtest.h>

#include <cmath>

#include "brush/rod/rod.h"
#include "core/text/units.h"
#include "reference.h"

namespace tuft::brush::rod {
namespace {

/// The rod lies along +x and bends towards +y.
const Clamp kClamp{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

struct Bent {
    Vec3 tip;
    double tip_angle, root_moment, energy;
    bool converged;
};

/// Loads the rod in even steps, so that the path is followed from rest.
Bent bend(const Profile& profile, int n, Vec3 force, double end_moment, int steps = 8) {
    const Rod rod = make_rod(profile, n, 0.6);
    Memory memory = make_memory(rod, kClamp);
    Law law;
    law.limits.tolerance = 1e-10;
    law.limits.max_iterations = 200;
    Result r;
    for (int i = 1; i <= steps; ++i) {
        const double part = static_cast<double>(i) / steps;
        r = solve(rod, memory, kClamp, {.law = law, .load = {part * force, part * end_moment, {0, 1, 0}}});
    }
    double angle = 0;
    Vec3 t = kClamp.tangent;
    for (const Vec3& next : memory.tangent) {
        angle += std::atan2(glm::cross(t, next).z, glm::dot(t, next));
        t = next;
    }
    return {memory.node.back(), angle, r.moment.front(), r.bend_energy, r.converged};
}

constexpr double kTip = 0.005;  // of L: the accuracy asked of 16 segments

TEST(Rod, UniformElasticaUnderATransverseLoadMatchesEllipticIntegrals) {
    for (const Row& row : read_rows("elastica_uniform.csv")) {
        const Bent b = bend({0, 0}, 16, {0, row["PL2_EI"], 0}, 0);
        SCOPED_TRACE(row["PL2_EI"]);
        EXPECT_TRUE(b.converged);
        EXPECT_NEAR(1 - b.tip.x, row["dx_over_L"], kTip);
        EXPECT_NEAR(b.tip.y, row["dy_over_L"], kTip);
    }
}

TEST(Rod, EndMomentGivesTheArc) {
    for (const Row& row : read_rows("elastica_moment.csv")) {
        const Bent b = bend({row["alpha"], row["beta"]}, 16, {0, 0, 0}, row["ML_E0I0"]);
        SCOPED_TRACE(row.text("alpha") + " " + row.text("beta") + " " + row.text("ML_E0I0"));
        EXPECT_TRUE(b.converged);
        EXPECT_NEAR(b.tip.x, row["x_tip_over_L"], kTip);
        EXPECT_NEAR(b.tip.y, row["y_tip_over_L"], kTip);
    }
}

TEST(Rod, TipTurnsTowardsTheLoadButNeverPastIt) {
    for (const double degrees : {45.0, 90.0, 120.0}) {
        double before = 0;
        for (const double load : {0.05, 0.3, 1.0, 4.0, 12.0}) {
            const double a = degrees * kDegree;
            const Bent b = bend({-1, -0.8}, 16, {load * std::cos(a), load * std::sin(a), 0}, 0, 30);
            EXPECT_LT(b.tip_angle, a);
            EXPECT_GT(b.tip_angle, before);
            before = b.tip_angle;
        }
    }
}

TEST(Rod, VariableStiffnessElasticaMatchesShooting) {
    for (const Row& row : read_rows("elastica_variable.csv")) {
        const double a = row["load_angle_deg"] * kDegree, p = row["PL2_E0I0"];
        const Bent b = bend({row["alpha"], row["beta"]}, 16, {p * std::cos(a), p * std::sin(a), 0}, row["endML_E0I0"]);
        SCOPED_TRACE(row.text("alpha") + " " + row.text("beta") + " P " + row.text("PL2_E0I0") + " angle " +
                     row.text("load_angle_deg") + " M " + row.text("endML_E0I0"));
        EXPECT_TRUE(b.converged);
        EXPECT_NEAR(b.tip.x, row["x_tip_over_L"], kTip);
        EXPECT_NEAR(b.tip.y, row["y_tip_over_L"], kTip);
        EXPECT_NEAR(b.root_moment, row["root_moment_ML_E0I0"], 0.02 * (0.1 + row["root_moment_ML_E0I0"]));
    }
}

}  // namespace
}  // namespace tuft::brush::rod
