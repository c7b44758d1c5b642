#include "ink/exchange/uptake.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tuft::ink {
namespace {

/// Lying hair: h² = γ r t/(2 η); 25 mm in 0.2 s through tubes of 0.25 mm.
TEST(Uptake, GrowsWithTheRootOfTimeWhereHairLies) {
    const Uptake lying{.pore_radius = 2.5e-4, .slope = 0};
    EXPECT_NEAR(uptake_height(lying, 0.2), 25e-3, 1e-12);
    for (const double t : {1e-3, 0.05, 0.8})
        EXPECT_NEAR(uptake_height(lying, 4 * t) / uptake_height(lying, t), 2, 1e-12);  // rounding
    EXPECT_EQ(uptake_height(lying, 0), 0);
}

/// Upright hair: as lying at first, then never more than Jurin's height 2 γ/(ρ g r) = 41 mm.
TEST(Uptake, EndsAtTheHeightThatSuctionCarries) {
    const Uptake upright{.pore_radius = 2.5e-4}, lying{.pore_radius = 2.5e-4, .slope = 0};
    const double most = 2 * 0.05 / (9810 * 2.5e-4);
    EXPECT_NEAR(most, 41e-3, 0.5e-3);
    // Weight takes h/(3 h_max) of it: 0.1 % after 1e-6 h_max² of the time.
    EXPECT_NEAR(uptake_height(upright, 1e-6) / uptake_height(lying, 1e-6), 1, 1e-3);
    EXPECT_NEAR(uptake_height(upright, 1e4) / most, 1, 1e-6);
    double before = 0;
    for (double t = 1e-4; t < 10; t *= 1.3) {
        const double h = uptake_height(upright, t);
        EXPECT_GT(h, before);
        EXPECT_LT(h, most);
        before = h;
    }
}

/// The rise obeys its equation of motion: suction is friction and weight together.
TEST(Uptake, SuctionIsFrictionAndWeight) {
    for (const double slope : {0.3, 1.0}) {
        const Uptake u{.pore_radius = 1e-4, .slope = slope};
        for (const double t : {0.01, 0.3, 4.0}) {
            const double dt = 1e-4 * t, h = uptake_height(u, t);
            const double rate = (uptake_height(u, t + dt) - uptake_height(u, t - dt)) / (2 * dt);
            const double friction = 8 * u.viscosity * h * rate / (u.pore_radius * u.pore_radius);
            const double suction = 2 * u.surface_tension / u.pore_radius;
            // Central differences: 1e-8 of the curvature.
            EXPECT_NEAR((friction + slope * 9810 * h) / suction, 1, 1e-5) << t;
        }
    }
}

}  // namespace
}  // namespace tuft::ink
