#include "brush/rod/profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "reference.h"

namespace tuft::brush {
namespace {

TEST(Profile, SmallDeflectionMatchesFortyDigitQuadrature) {
    for (const Row& row : read_rows("cantilever_variable_small.csv")) {
        const Profile profile{row["alpha"], row["beta"]};
        const SmallDeflection d = small_deflection(profile, row["xi"]);
        SCOPED_TRACE(row.text("alpha") + " " + row.text("beta") + " " + row.text("xi"));
        // The closed form loses digits as β goes to 0; the table says how many in double.
        const double slack = 1e-11 + 10 * row["rel_err_of_double_closed_form"];
        EXPECT_NEAR(d.w, row["w_E0I0_over_PL3"], slack * row["w_E0I0_over_PL3"] + 1e-15);
        EXPECT_NEAR(d.slope, row["slope_E0I0_over_PL2"], slack * row["slope_E0I0_over_PL2"] + 1e-15);
        EXPECT_NEAR(d.moment, row["moment_over_PL"], 1e-15);
    }
}

TEST(Profile, ClosedFormAndQuadratureAgreeWhereOneTakesOverFromTheOther) {
    // At |β| = 0.05 the closed form is good to 1e-8; the quadrature to round-off.
    const SmallDeflection inside = small_deflection({-1, -0.05 + 1e-12}, 1);
    const SmallDeflection outside = small_deflection({-1, -0.05 - 1e-12}, 1);
    EXPECT_NEAR(inside.w, outside.w, 1e-7 * inside.w);
}

TEST(Profile, SectionFollowsMasingsRule) {
    for (const Row& row : read_rows("elastoplastic.csv")) {
        const SectionMoment first = section_moment(row["k1"]);
        const SectionMoment second = section_moment(row["k1"], row["k2"]);
        EXPECT_NEAR(first.moment, row["mu1"], 1e-12);
        EXPECT_NEAR(first.residual, row["k_residual_after_k1"], 1e-12);
        EXPECT_NEAR(second.moment, row["mu2"], 1e-12);
        EXPECT_NEAR(second.residual, row["k_residual_after_k2"], 1e-12);
    }
}

TEST(Profile, SegmentsAreAnArithmeticProgressionOfSumOne) {
    for (const double ratio : {0.25, 0.4, 0.7, 1.0}) {
        const std::vector<double> l = spine_segments(16, ratio);
        EXPECT_NEAR(std::accumulate(l.begin(), l.end(), 0.0), 1, 1e-14);
        EXPECT_NEAR(l.back(), ratio / 16, 1e-15);
        for (std::size_t i = 2; i < l.size(); ++i) {
            EXPECT_NEAR(l[i] - l[i - 1], l[1] - l[0], 1e-14);
        }
    }
}

TEST(Profile, ElasticLimitIsWhereTheFirstSectionYields) {
    // Uniform: the root yields first, at P L = M_e.
    EXPECT_NEAR(elastic_limit_load({0, 0, 0.8, 0}), 0.8, 1e-12);
    // Any profile: at the limit no section exceeds M_e and one reaches it.
    const Profile p{-1, -0.8, 0.5, -1};
    const double limit = elastic_limit_load(p);
    double closest = 1e9;
    for (double xi = 0; xi < 0.999; xi += 0.001) {
        closest = std::min(closest, yield_moment(p, xi) - limit * (1 - xi));
    }
    EXPECT_NEAR(closest, 0, 1e-4);
}

TEST(Profile, GaussRuleIsExactToItsDegree) {
    const Quadrature q = gauss_legendre(5);
    for (int power = 0; power <= 9; ++power) {
        double sum = 0;
        for (int i = 0; i < 5; ++i) sum += q.w[i] * std::pow(q.x[i], power);
        EXPECT_NEAR(sum, 1.0 / (power + 1), 1e-14);
    }
}

}  // namespace
}  // namespace tuft::brush
