#include <gtest/gtest.h>

#include <cmath>

#include "brush/rod/rod.h"
#include "core/text/units.h"
#include "reference.h"

namespace tuft::brush::rod {
namespace {

/// Weightless, thin and rigid plane: the limit the reference was computed for.
Law hard_law(double mu) {
    Law law;
    law.normal.hard = true;
    law.normal.stiffness = 3e5;
    law.friction.stick_stiffness = 1e4;
    law.friction.coefficient = mu;
    law.limits.tolerance = 1e-9;
    law.limits.max_iterations = 400;
    law.limits.pass_tolerance = 1e-4;
    law.limits.max_passes = 60;
    return law;
}

struct Standing {
    Result result;
    Memory memory;
    double normal = 0, reach = 0, max_change = 0;
    int limited = 0;
};

/// Presses the rod to its depth, then drags it three lengths.
Standing press_and_drag(const Row& row, int n) {
    const Profile profile{row["alpha"], row["beta"]};
    const Rod rod = make_rod(profile, n, 0.4);
    const double tilt = row["tilt_deg"] * kDegree, depth = row["depth_over_L"], mu = row["mu"];
    Clamp clamp{{0, 0, std::sin(tilt)}, {std::cos(tilt), 0, -std::sin(tilt)}, {0, 1, 0}};
    Vec3 drag{0};
    if (row.text("drag") == "pull") drag = {-1, 0, 0};
    if (row.text("drag") == "push") drag = {1, 0, 0};
    if (row.text("drag") == "side") drag = {0, -1, 0};
    const Law law = hard_law(mu);
    const std::vector<Obstacle> plane(n + 1);
    Standing s{{}, make_memory(rod, clamp)};
    const int press = 40, pull = mu > 0 ? 300 : 0;
    for (int i = 1; i <= press + pull; ++i) {
        clamp.position.z = std::sin(tilt) - depth * std::min(1.0, static_cast<double>(i) / press);
        if (i > press) clamp.position += drag * (3.0 / pull);
        const Vec3 before = s.result.force;
        s.result = solve(rod, s.memory, clamp, {.obstacles = plane, .law = law});
        s.limited += !s.result.converged;
        if (i > press + pull - 50) s.max_change = std::max(s.max_change, glm::length(s.result.force - before));
    }
    double arc = 0, lever = 0;
    for (int i = 0; i <= n; ++i) {
        s.normal += s.result.normal_force[i];
        lever += arc * s.result.normal_force[i];
        if (i < n) arc += rod.length[i];
    }
    s.reach = lever / s.normal;
    s.memory.clamp = clamp;
    return s;
}

TEST(RodOnPlane, NormalForceTipAndContactLengthMatchTheReference) {
    for (const Row& row : read_rows("rod_on_plane.csv")) {
        SCOPED_TRACE(row.text("alpha") + " " + row.text("beta") + " tilt " + row.text("tilt_deg") + " depth " +
                     row.text("depth_over_L") + " " + row.text("drag") + " mu " + row.text("mu"));
        const Standing s = press_and_drag(row, 16);
        EXPECT_TRUE(s.result.converged) << s.result.passes << " passes";
        const double n = row["N_L2_E0I0"];
        EXPECT_NEAR(s.normal, n, 0.02 * n);
        EXPECT_NEAR(1 - s.reach, row["contact_len_over_L"], 0.03 * std::max(0.3, row["contact_len_over_L"]));
        const Vec3 tip = s.memory.node.back() - Vec3{s.memory.clamp.position.x, s.memory.clamp.position.y, 0};
        EXPECT_NEAR(tip.x, row["tip_x"], 0.002);
        EXPECT_NEAR(tip.y, row["tip_y"], 0.002);
        EXPECT_NEAR(s.result.moment.front(), row["root_moment_ML_E0I0"], 0.02 * row["root_moment_ML_E0I0"]);
        if (row["mu"] > 0) {
            EXPECT_LT(s.max_change, 2e-4 * n);  // twice what a pass may leave
        }
    }
}

}  // namespace
}  // namespace tuft::brush::rod
