#include "ink/texels/relief.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/random.h"

namespace tuft::ink {
namespace {

Vec3 somewhere(int i) {
    return {0.2 * uniform(1, 3 * i), 0.2 * uniform(1, 3 * i + 1), 0.2 * uniform(1, 3 * i + 2)};
}

TEST(Relief, HasUnitRmsAroundZero) {
    for (const double length : {20e-6, 200e-6}) {
        double sum = 0, squares = 0;
        constexpr int kN = 40000;
        for (int i = 0; i < kN; ++i) {
            const double z = relief_at(somewhere(i), length);
            sum += z / kN;
            squares += z * z / kN;
        }
        EXPECT_NEAR(sum, 0, 0.02) << "1/√40000 = 0.005, four of them";
        EXPECT_NEAR(squares, 1, 0.03);
    }
}

TEST(Relief, IsSmoothOverItsLength) {
    const double length = 60e-6;
    double near = 0, far = 0;
    for (int i = 0; i < 4000; ++i) {
        const Vec3 p = somewhere(i);
        near += std::pow(relief_at(p + Vec3{0.02 * length, 0, 0}, length) - relief_at(p, length), 2) / 4000;
        far += std::pow(relief_at(p + Vec3{20 * length, 0, 0}, length) - relief_at(p, length), 2) / 4000;
    }
    EXPECT_LT(near, 0.01);
    EXPECT_NEAR(far, 2, 0.15) << "twice the variance: independent";
}

TEST(Relief, FilmFillsTheGrainFromItsHillsDown) {
    constexpr int kN = atlas::kTileTexels;
    std::array<float, kN> relief;
    for (int t = 0; t < kN; ++t) relief[t] = static_cast<float>(relief_at(somewhere(t), 60e-6));
    const float rms = 15e-6f;
    double before = -1;
    for (const double film : {-60e-6, -15e-6, 0.0, 15e-6, 30e-6, 90e-6}) {
        std::array<float, kN> exposure;
        exposure.fill(0.8f);
        expose_relief(exposure, relief, rms, static_cast<float>(film));
        double sum = 0;
        for (int t = 0; t < kN; ++t) {
            sum += static_cast<double>(exposure[t]) / 0.8 / kN;
            EXPECT_LE(exposure[t], 0.8f);
        }
        EXPECT_GE(sum, before);
        if (film == 0) {
            EXPECT_NEAR(sum, 0.5, 0.1) << "half of it lies below the mean";
        }
        before = sum;
    }
    EXPECT_NEAR(before, 1, 1e-6) << "more than the deepest valley";
    std::array<float, kN> smooth;
    smooth.fill(0.3f);
    expose_relief(smooth, relief, 0, 0);
    EXPECT_EQ(smooth[7], 0.3f);
}

}  // namespace
}  // namespace tuft::ink
