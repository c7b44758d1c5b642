#include "brush/tuft/bundles.h"

#include <gtest/gtest.h>

#include <cmath>

#include "brush/tuft/tuft.h"

namespace tuft::brush {
namespace {

TEST(Bundles, TheSeedLaysTheHair) {
    const Preset p = load_preset("mixed-medium");
    const Bundles a = make_bundles(p, 7), b = make_bundles(p, 7), c = make_bundles(p, 8);
    ASSERT_EQ(a.bristles.size(), 500u);
    ASSERT_EQ(a.place.size(), 40u);
    int same = 0;
    for (std::size_t i = 0; i < a.bristles.size(); ++i) {
        EXPECT_EQ(a.bristles[i].place, b.bristles[i].place);
        EXPECT_EQ(a.bristles[i].readiness, b.bristles[i].readiness);
        same += a.bristles[i].place == c.bristles[i].place;
        EXPECT_LE(glm::length(a.bristles[i].place), 1 + 1e-6f);
    }
    EXPECT_LT(same, 5);
    EXPECT_EQ(a.holds, b.holds);
    EXPECT_NE(a.holds, c.holds);
}

TEST(Bundles, BristlesAreEvenlySpreadAndEachHasTheBundleNearestToIt) {
    const Bundles b = make_bundles(load_preset("mixed-medium"), 3);
    double inside = 0;
    Vec2 mean{0};
    for (const Bristle& bristle : b.bristles) {
        const Vec2 at(bristle.place);
        mean += at / 500.0;
        inside += glm::length(at) < std::sqrt(0.5) ? 1 : 0;
        const double own = glm::distance(at, b.place[bristle.bundle]);
        for (const Vec2& other : b.place) EXPECT_GE(glm::distance(at, other), own - 1e-7);
    }
    EXPECT_NEAR(inside / 500, 0.5, 0.03) << "half of the area, to the shaking of those at its rim";
    EXPECT_LT(glm::length(mean), 0.02);
}

TEST(Bundles, ReadinessIsSpreadEvenly) {
    const Bundles b = make_bundles(load_preset("mixed-medium"), 3);
    double sum = 0, squares = 0;
    for (const Bristle& bristle : b.bristles) {
        const auto r = static_cast<double>(bristle.readiness);
        sum += r / 500;
        squares += r * r / 500;
    }
    EXPECT_NEAR(sum, 0.5, 1e-6);
    EXPECT_NEAR(squares, 1.0 / 3, 1e-5) << "ranks (i + ½)/n";
}

TEST(Bundles, SubSpinesTakeEqualSharesOfTheHair) {
    const Bundles b = make_bundles(load_preset("mixed-medium"), 5);
    for (int n = 1; n <= 5; ++n) {
        std::vector<int> count(static_cast<std::size_t>(n), 0);
        for (const Bristle& bristle : b.bristles) {
            const BranchPlace at = in_branch({}, Vec2(bristle.place), n);
            ASSERT_GE(at.branch, 0);
            ASSERT_LT(at.branch, n);
            ++count[static_cast<std::size_t>(at.branch)];
            EXPECT_LE(glm::length(at.place), 1 + 1e-6);
            if (n == 1) {
                EXPECT_EQ(at.place, Vec2(bristle.place));
            }
        }
        // The border of a strip is 2 long and cuts through 500 / π hairs an area: ± 2 % of the hair.
        for (const int c : count) EXPECT_NEAR(c / 500.0, 1.0 / n, 0.03) << n;
    }
}

TEST(Bundles, TheOrderFromSideToSideIsKept) {
    for (int n = 2; n <= 5; ++n) {
        int branch = 0;
        double x = -2;
        for (int i = 0; i <= 1000; ++i) {
            const BranchPlace at = in_branch({}, {-1 + i / 500.0, 0}, n);
            EXPECT_GE(at.branch, branch);
            if (at.branch == branch) {
                EXPECT_GE(at.place.x, x - 1e-12);
            }
            branch = at.branch;
            x = at.place.x;
        }
        EXPECT_EQ(branch, n - 1);
    }
}

TEST(Bundles, PartingDoesNotDependOnTheSteps) {
    const Preset p = load_preset("mixed-medium");
    Bundles once = make_bundles(p, 1), often = once;
    const std::vector<double> dry(once.place.size(), 0.05);
    split_bundles(once, p, 1, dry, 5e-3, 0.1);
    for (int i = 0; i < 50; ++i) split_bundles(often, p, 1, dry, 1e-4, 0.002);
    for (std::size_t k = 0; k < dry.size(); ++k) EXPECT_NEAR(once.separation[k], often.separation[k], 1e-12);
}

TEST(Bundles, DryHairUnderStressPartsStaysSoAndMergesWhenWettedOrCombed) {
    const Preset p = load_preset("mixed-medium");
    Bundles b = make_bundles(p, 1);
    const std::vector<double> dry(b.place.size(), 0.02), wet(b.place.size(), 0.98);
    const auto sum = [&] {
        double s = 0;
        for (const double a : b.separation) s += a;
        return s;
    };
    split_bundles(b, p, 1, wet, 1, 1);
    EXPECT_EQ(sum(), 0) << "wet hair holds together under any stress";
    split_bundles(b, p, 0.2, dry, 1, 1);
    EXPECT_EQ(sum(), 0) << "dry hair that is not pressed stays as it is";
    split_bundles(b, p, 1, dry, 0.02, 0.1);
    const double parted = sum();
    EXPECT_GT(parted, 0.8 * static_cast<double>(b.place.size()));
    split_bundles(b, p, 0, dry, 0.1, 10);
    EXPECT_EQ(sum(), parted) << "lifted and still dry";
    Bundles combed = b;
    rejoin_hair(combed);
    for (const double a : combed.separation) EXPECT_EQ(a, 0);
    split_bundles(b, p, 0, wet, 0, 1);
    EXPECT_LT(sum(), 1e-3 * parted) << "e^-10 after a second";
}

TEST(Bundles, CellsHoldWhatTheHairHolds) {
    for (const char* name : {"wolf-small", "goat-large", "robot-2020"}) {
        const HairCells cells = hair_cells(load_preset(name));
        double sum = 0;
        for (const double r : cells.capacities) {
            EXPECT_GT(r, 0);
            sum += r;
        }
        EXPECT_NEAR(sum, 1, 1e-12) << name;
        EXPECT_EQ(cells.ends.back(), 1);
        EXPECT_LT(cells.capacities.back(), cells.capacities.front()) << "the point holds little";
    }
}

// Presses and drags a dry tuft that splits into n.
Tuft dry_tuft(int n, TuftState& state) {
    Preset p = load_preset("mixed-medium");
    p.split_factor = 3;
    p.split_into = n;
    Tuft tuft = make_tuft(p);
    tuft.ink_left = 0.02;
    const ContactPlane plane;
    for (int i = 0; i <= 300; ++i) {
        Pose pose;
        pose.position = {2e-4 * i, 0, p.length * (1.01 - 0.43 * std::min(1.0, i / 60.0))};
        pose.time = 0.01 * i;
        state = step(tuft, pose, {&plane, 1}, 0.01);
    }
    return tuft;
}

TEST(Bundles, ChildrenOfAnyNumberAddUpToTheirParent) {
    for (int n = 2; n <= 5; ++n) {
        TuftState state;
        const Tuft tuft = dry_tuft(n, state);
        ASSERT_TRUE(tuft.split) << n;
        ASSERT_EQ(state.branches.size(), static_cast<std::size_t>(n));
        double shares = 0, area = 0, stiffness = 0;
        for (const Branch& b : state.branches) {
            shares += b.ink_share;
            area += b.sections[1].a * b.sections[1].b;
        }
        for (const Spine& sub_spine : tuft.sub_spines) stiffness += sub_spine.rod.stiffness.back();
        const double r = tuft.trunk().rest.radius[tuft.trunk().rest.radius.size() - 2];
        EXPECT_NEAR(shares, 1, 1e-12);
        EXPECT_NEAR(area, r * r, 1e-9 * r * r);
        EXPECT_NEAR(stiffness / tuft.trunk().rod.stiffness.back(), 1, 1e-12);
    }
}

TEST(Bundles, SubSpinesBeginInTheShapeOfTheTuftAndPartOnTheWay) {
    Preset p = load_preset("mixed-medium");
    p.split_factor = 3;
    Tuft tuft = make_tuft(p);
    tuft.ink_left = 0.02;
    const ContactPlane plane;
    double gap_before = 0;
    bool was_split = false;
    for (int i = 0; i <= 400; ++i) {
        Pose pose;
        pose.position = {1e-4 * i, 0, p.length * (1.01 - 0.43 * std::min(1.0, i / 120.0))};
        pose.time = 0.005 * i;
        const TuftState state = step(tuft, pose, {&plane, 1}, 0.005);
        if (state.branches.size() < 2) continue;
        const double gap = glm::distance(state.branches[0].sections[0].centre, state.branches[2].sections[0].centre);
        // 0.1 mm of path parts e^-1/60 of what is left. Rods that meet in the tip when straight are
        // half a millimetre apart when bent, beside a width of 8 mm: no jump from one tip to three.
        EXPECT_LT(std::abs(gap - gap_before), 6e-4) << i;
        gap_before = gap;
        was_split = true;
    }
    EXPECT_TRUE(was_split);
    EXPECT_GT(gap_before, 1e-3);
}

}  // namespace
}  // namespace tuft::brush
