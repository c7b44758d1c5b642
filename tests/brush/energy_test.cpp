#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "brush/tuft/tuft.h"

/// The whole tuft with its side nodes: where the hand's work goes.
namespace tuft::brush {
namespace {

constexpr double kStep = 1e-3;  // s

/// The hand over the sheet z = 0: what it has done and where that is now. Joules.
struct Account {
    Tuft tuft;
    Pose pose;
    TuftState state;
    double work = 0, lost = 0;
    double least_lost = 0;  // in one step
    double worst = 0;       // of work - stored - lost, at any time
    double most_aside = 0, most_spread = 0, most_stored = 0;
    double least_left = 0;  // of bend and contact less what of them is in the side nodes

    Account(const std::string& brush, double wetness, double lean) : tuft(make_tuft(load_preset(brush))) {
        tuft.wetness = wetness;
        pose.rotation = glm::angleAxis(lean, Vec3{0, 1, 0});
        pose.position = Vec3{0, 0, 2.5e-3} - tuft.preset.length * pose.axis();
        go({0, 0, 0});
    }

    void go(const Vec3& d) {
        const ContactPlane sheet;
        const Vec3 before = state.force;
        pose.position += d;
        pose.time += kStep;
        state = step(tuft, pose, {&sheet, 1}, kStep);
        work -= 0.5 * glm::dot(before + state.force, d);
        const TuftEnergy& e = state.energy;
        lost += e.lost;
        least_lost = std::min(least_lost, e.lost);
        worst = std::max(worst, std::abs(work - e.stored() - lost));
        most_aside = std::max(most_aside, e.aside);
        most_spread = std::max(most_spread, e.spread);
        most_stored = std::max(most_stored, e.stored());
        least_left = std::min(least_left, e.bend + e.contact - e.spread);
    }

    /// Smooth motion by `motion` in n steps.
    void move(const Vec3& motion, int n) {
        const auto eased = [](double x) { return x * x * (3 - 2 * x); };
        for (int i = 1; i <= n; ++i) go((eased(double(i) / n) - eased(double(i - 1) / n)) * motion);
    }
};

/// Press, drag along the hair and across it, lift: everything moves both ways.
void stroke(Account& a) {
    const double l = a.tuft.preset.length;
    a.move({0, 0, -2.5e-3 - 0.02 * l}, 300);
    a.move({-0.1 * l, 0, -0.28 * l}, 600);
    a.move({-0.6 * l, 0, 0}, 600);
    a.move({0, 0.8 * l, 0}, 800);
    a.move({0, 0, 0.3 * l + 2.5e-3}, 600);
}

TEST(Energy, WorkOfTheHandIsStoredOrLostInAClosedCycle) {
    for (const char* brush : {"wolf-medium", "goat-medium", "mixed-medium", "robot-2020"}) {
        for (const double wetness : {1.0, 0.0}) {
            for (const double lean : {0.2, 0.0}) {
                SCOPED_TRACE(std::string(brush) + " wet " + std::to_string(wetness) + " lean " + std::to_string(lean));
                Account a(brush, wetness, lean);
                stroke(a);
                ASSERT_FALSE(a.state.touching);
                EXPECT_NEAR(a.work, a.state.energy.stored() + a.lost, 0.02 * a.work);
                EXPECT_LT(a.worst, 0.02 * a.work);  // at any time
                EXPECT_GE(a.least_lost, 0);
                // Friction across the hair has drawn the side nodes aside, and it is all gone.
                EXPECT_GT(a.most_aside, 1e-6 * a.work);
                EXPECT_LT(a.state.energy.aside, 1e-3 * a.most_aside);
                // What the spread side nodes hold is a part of the rod's; the film's pull is less than nothing.
                EXPECT_GT(a.most_spread, 1e-3 * a.most_stored);
                EXPECT_GT(a.least_left, -1e-3 * a.most_stored);
            }
        }
    }
}

TEST(Energy, NothingIsGainedWhileTheHandHoldsStill) {
    for (const char* brush : {"wolf-medium", "goat-medium"}) {
        Account a(brush, 1, 0.2);
        const double l = a.tuft.preset.length;
        a.move({-0.1 * l, 0, -2.5e-3 - 0.28 * l}, 400);
        a.move({-0.2 * l, 0.2 * l, 0}, 200);
        const double start = a.state.energy.stored(), lost = a.lost;
        for (int i = 0; i < 500; ++i) {
            const double before = a.state.energy.stored();
            a.go({0, 0, 0});
            EXPECT_LE(a.state.energy.stored(), before + 1e-6 * start) << brush;  // the solver's tolerance
        }
        EXPECT_NEAR(start - a.state.energy.stored(), a.lost - lost, 0.02 * start) << brush;
    }
}

}  // namespace
}  // namespace tuft::brush
