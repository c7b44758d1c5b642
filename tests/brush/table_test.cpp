#include "brush/tuft/table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "brush/rod/rod.h"
#include "brush/tuft/tuft.h"
#include "reference.h"

namespace tuft::brush {
namespace {

Preset uniform_elastic() {
    Preset p;
    p.alpha = p.beta = 0;
    p.yield = 0;
    p.length = 0.04;
    p.stiffness = 3e-4;
    return p;
}

TEST(Table, UniformRowsLieOnTheElastica) {
    const Preset p = uniform_elastic();
    const QueryTable table = make_table(p, 64);
    for (const Row& row : read_rows("elastica_uniform.csv")) {
        const double moment = row["root_moment_ML_EI"] * p.stiffness / p.length;
        if (moment > table.rows.back().moment) continue;
        const TableRow at = look_up(table, moment);
        // 32 segments: tip within 0.0005 L; cubic interpolation between 64 rows adds 1e-4.
        EXPECT_NEAR(1 - at.nodes.front().x / p.length, row["dx_over_L"], 1e-3);
        EXPECT_NEAR(at.nodes.front().y / p.length, row["dy_over_L"], 1e-3);
        EXPECT_NEAR(at.load * p.length * p.length / p.stiffness, row["PL2_EI"], 5e-3 * row["PL2_EI"]);
    }
}

TEST(Table, SmallMomentsFollowTheLinearClosedForm) {
    Preset p = load_preset("mixed-medium");
    p.yield = 0;
    const QueryTable table = make_table(p, 400);
    const TableRow& row = table.rows[1];
    // M = P x_tip; the deflections of linear theory at every node.
    double s = p.length;
    const double force = row.load;
    for (std::size_t i = 0; i < row.nodes.size(); ++i) {
        const double w =
            small_deflection({p.alpha, p.beta}, s / p.length).w * force * std::pow(p.length, 3) / p.stiffness;
        if (w < 0.02 * p.length && w > 1e-6 * p.length) {
            EXPECT_NEAR(row.nodes[i].y, w, 0.03 * w + 1e-5 * p.length);
        }
        if (i + 1 < row.nodes.size()) s -= glm::length(row.nodes[i + 1] - row.nodes[i]);
    }
}

TEST(Table, RowsRiseAndKeepTheLength) {
    const Preset p = load_preset("wolf-medium");
    const QueryTable table = make_table(p);
    ASSERT_EQ(table.rows.size(), 64u);
    for (std::size_t k = 0; k < table.rows.size(); ++k) {
        const TableRow& row = table.rows[k];
        ASSERT_EQ(row.nodes.size(), 17u);
        EXPECT_NEAR(row.moments.back(), row.moment, 0.02 * row.moment + 1e-12);
        EXPECT_EQ(row.moments.front(), 0);
        if (k == 0) continue;
        EXPECT_GT(row.moment, table.rows[k - 1].moment);
        EXPECT_GT(row.load, table.rows[k - 1].load);
        EXPECT_LT(row.nodes.front().x, table.rows[k - 1].nodes.front().x);
        // The tip's direction stays short of the load's, a right angle.
        EXPECT_LT(row.angles.front(), std::numbers::pi / 2);
        double length = 0;
        for (std::size_t i = 1; i < row.nodes.size(); ++i) length += glm::length(row.nodes[i] - row.nodes[i - 1]);
        EXPECT_LE(length, p.length * (1 + 1e-9));
        EXPECT_GT(length, 0.97 * p.length);  // chords of bent segments
    }
}

TEST(Table, FixedShapeStandsOnThePlane) {
    const Preset p = load_preset("mixed-medium");
    const QueryTable table = make_table(p);
    for (const double part : {0.1, 0.3, 0.6}) {
        const double moment = part * table.rows.back().moment, height = 0.6 * p.length;
        const FixedShape shape = fixed_shape(table, moment, height, 0.3);
        EXPECT_NEAR(shape.nodes.front().y, 0, 1e-9);
        EXPECT_NEAR(shape.nodes.back().y, height, 1e-12);
        EXPECT_NEAR(shape.nodes.back().x, 0, 1e-12);
        const TableRow row = look_up(table, moment);
        EXPECT_NEAR(shape.tip_angle, std::numbers::pi / 2 - shape.holder_angle + row.angles.front(), 1e-12);
        EXPECT_NEAR(shape.friction, 0.3 * shape.reaction, 1e-12);
        // Prescribing the angle found gives the moment back.
        const FixedShape again = fixed_shape_at_angle(table, height, shape.holder_angle, 0.3);
        EXPECT_NEAR(again.moment, moment, 1e-3 * table.rows.back().moment);
    }
}

TEST(Table, AStraightTuftAboveThePlaneCarriesNoMoment) {
    const Preset p = load_preset("mixed-medium");
    const QueryTable table = make_table(p);
    EXPECT_EQ(fixed_shape_at_angle(table, 1.1 * p.length, std::numbers::pi / 2, 0.3).moment, 0);
}

TEST(Table, StrokesWorkWithTheTableToo) {
    Preset p = load_preset("mixed-medium");
    p.spine = SpineMethod::table;
    Tuft tuft = make_tuft(p);
    const ContactPlane plane;
    TuftState state;
    for (int i = 1; i <= 300; ++i) {
        const double a = 0.01 * i;
        const Pose pose{
            {0.02 * std::sin(a), 0.02 * (1 - std::cos(a)), p.length - 0.3 * p.length * std::min(1.0, i / 60.0)},
            {1, 0, 0, 0},
            0.01 * i};
        state = step(tuft, pose, {&plane, 1}, 0.01);
        if (i > 80) {
            const Section& tip = state.branches[0].sections.front();
            EXPECT_NEAR(tip.centre.z, 0, 1e-4);
            EXPECT_TRUE(state.touching);
            // The tip trails: it lies behind the hand's motion.
            const Vec3 velocity{std::cos(a), std::sin(a), 0};
            EXPECT_TRUE(i < 200 || glm::dot(tip.centre - pose.position, velocity) < 0);
        }
    }
    // Around a circle nothing changes but the direction.
    const double before = state.normal_force;
    const Pose pose{{0.02 * std::sin(3.01), 0.02 * (1 - std::cos(3.01)), 0.7 * p.length}, {1, 0, 0, 0}, 3.01};
    state = step(tuft, pose, {&plane, 1}, 0.01);
    EXPECT_NEAR(state.normal_force, before, 1e-6 * before);
}

}  // namespace
}  // namespace tuft::brush
