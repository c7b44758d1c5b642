#include "variants/deviation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/text/units.h"

namespace tuft::variants {
namespace {

stroke::JournalEntry line(bool flat) {
    stroke::PaintStroke s;
    s.trace.flat = flat;
    s.trace.placement = {.origin = {0.01, 0.02, 0.03}, .right = {0, 1, 0}, .down = {0, 0, -1}};
    s.trace.placed = true;
    for (int i = 0; i <= 50; ++i) {
        stroke::StrokeSample p;
        p.time = 0.01 * i;
        p.position = {0.001 * i, 0.0002 * i, flat ? 0 : 0.05};
        p.pressure = 0.4;
        s.trace.samples.push_back(p);
    }
    return stroke::JournalEntry(s);
}

const stroke::StrokeSamples& trace_of(const std::vector<stroke::JournalEntry>& entries) {
    return entries.front().get<stroke::PaintStroke>().trace;
}

TEST(Deviation, NormalNumbersHaveTheMomentsOfTheNormalDistribution) {
    constexpr int kN = 100'000;
    double m1 = 0, m2 = 0, m4 = 0;
    for (int i = 0; i < kN; ++i) {
        const double z = normal_number(5, static_cast<std::uint64_t>(i));
        m1 += z / kN, m2 += z * z / kN, m4 += z * z * z * z / kN;
    }
    // Five standard errors: sqrt(1/N), sqrt(2/N), sqrt(96/N).
    EXPECT_NEAR(m1, 0, 5 * std::sqrt(1.0 / kN));
    EXPECT_NEAR(m2, 1, 5 * std::sqrt(2.0 / kN));
    EXPECT_NEAR(m4, 3, 5 * std::sqrt(96.0 / kN));
}

TEST(Deviation, ARandomDeviationHasItsSpreadAndItsCorrelation) {
    constexpr int kN = 20'000;
    const double spread = 0.3, length = 8;
    for (const double lag : {0.0, 4.0, 8.0, 16.0}) {
        double sum = 0;
        for (int i = 0; i < kN; ++i) {
            const RandomDeviation w(spread, length, static_cast<std::uint64_t>(i));
            sum += w.at(3) * w.at(3 + lag) / kN;
        }
        // The product of two normal numbers has at most twice their variance: five standard errors.
        EXPECT_NEAR(sum, spread * spread * std::exp(-lag * lag / (2 * length * length)),
                    5 * spread * spread * std::sqrt(2.0 / kN));
    }
}

TEST(Deviation, NoSpreadChangesNothing) {
    for (const bool flat : {true, false}) {
        std::vector<stroke::JournalEntry> entries{line(flat)};
        const stroke::StrokeSamples before = trace_of(entries);
        deviate(entries, {.name = "none"}, 3);
        for (std::size_t i = 0; i < before.samples.size(); ++i) {
            // A turn by 0 through sines and cosines is exact to rounding.
            EXPECT_LT(glm::length(trace_of(entries).samples[i].position - before.samples[i].position), 1e-15);
            EXPECT_EQ(trace_of(entries).samples[i].pressure, before.samples[i].pressure);
        }
        EXPECT_LT(glm::length(trace_of(entries).placement.right - before.placement.right), 1e-15);
    }
}

TEST(Deviation, TheSameSeedGivesTheSameBits) {
    const Tolerance t{.name = "all", .shift_mm = 1, .turn_deg = 2, .scale = 0.01, .hand_mm = 0.2, .pressure = 0.1};
    for (const bool flat : {true, false}) {
        std::vector<stroke::JournalEntry> a{line(flat)}, b{line(flat)}, c{line(flat)};
        deviate(a, t, 9), deviate(b, t, 9), deviate(c, t, 10);
        EXPECT_EQ(trace_of(a).samples[7].position, trace_of(b).samples[7].position);
        EXPECT_NE(trace_of(a).samples[7].position, trace_of(c).samples[7].position);
    }
}

TEST(Deviation, AStrokeInSpaceMovesRigidly) {
    std::vector<stroke::JournalEntry> entries{line(false)};
    const std::vector<stroke::StrokeSample> before = trace_of(entries).samples;
    deviate(entries, {.name = "jig", .shift_mm = 2, .turn_deg = 3}, 4);
    const std::vector<stroke::StrokeSample>& after = trace_of(entries).samples;
    for (std::size_t i = 1; i < before.size(); ++i)
        // Rounding of numbers of 50 mm.
        EXPECT_NEAR(glm::length(after[i].position - after[0].position),
                    glm::length(before[i].position - before[0].position), 1e-15);
    EXPECT_GT(glm::length(after[0].position - before[0].position), 1e-4);
}

TEST(Deviation, ShiftTurnAndScaleOfFlatStrokesHaveTheirSpread) {
    constexpr int kN = 4000;
    const Tolerance t{.name = "jig", .shift_mm = 2, .turn_deg = 3, .scale = 0.02};
    double shift = 0, turn = 0, scale = 0;
    for (int i = 0; i < kN; ++i) {
        std::vector<stroke::JournalEntry> entries{line(true)};
        deviate(entries, t, static_cast<std::uint64_t>(i));
        const auto& s = trace_of(entries);
        const Vec3 first = s.samples.front().position, last = s.samples.back().position;  // planned at the origin
        shift += (first.x * first.x + first.y * first.y) / kN;
        const double angle = std::asin(s.placement.right.z);  // planned: +y
        turn += angle * angle / kN;
        const double factor = glm::length(last - first) / glm::length(Vec3(0.05, 0.01, 0));
        scale += (factor - 1) * (factor - 1) / kN;
    }
    const double five = 5 * std::sqrt(2.0 / kN);  // standard errors of a variance
    EXPECT_NEAR(shift / (2 * std::pow(2 * kMillimetre, 2)), 1, five);
    EXPECT_NEAR(turn / std::pow(3 * kDegree, 2), 1, five);
    EXPECT_NEAR(scale / std::pow(0.02, 2), 1, five);
}

TEST(Deviation, PressureStaysInItsRange) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        std::vector<stroke::JournalEntry> entries{line(true)};
        deviate(entries, {.name = "hand", .pressure = 1}, seed);
        for (const stroke::StrokeSample& s : trace_of(entries).samples) {
            EXPECT_GE(s.pressure, 0);
            EXPECT_LE(s.pressure, 1);
        }
    }
}

}  // namespace
}  // namespace tuft::variants
