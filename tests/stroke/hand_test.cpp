#include "stroke/gesture/hand.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/random.h"
#include "entry_text.h"

namespace tuft::stroke {
namespace {

constexpr double kPixel = 1.5e-4;  // metres: a 15 cm model on 1000 pixels

// Jitter of one pixel's standard deviation on x and y [BoxMuller1958].
Vec3 jitter(Random& random) {
    const double r = std::sqrt(-2 * std::log(1 - random.uniform()));
    const double a = 2 * std::numbers::pi * random.uniform();
    return kPixel * r * Vec3(std::cos(a), std::sin(a), 0);
}

TEST(HandFilter, AHandAtRestStaysWhereItIs) {
    HandFilter f;
    const StrokeSample still{.position = {0.01, 0.02, 0.03}, .pressure = 0.4, .tilt = {0.1, -0.2}};
    for (int i = 0; i < 500; ++i) {
        StrokeSample s = still;
        s.time = i * 0.008;
        const StrokeSample out = smooth(f, s);
        // x̂ += α (x − x̂) with x = x̂ is exact.
        EXPECT_EQ(out.position, still.position);
        EXPECT_EQ(out.pressure, still.pressure);
        EXPECT_EQ(out.tilt, still.tilt);
        EXPECT_NEAR(std::abs(glm::dot(out.rotation, still.rotation)), 1, 1e-15);
    }
}

TEST(HandFilter, AStepIsFollowedWithoutOvershoot) {
    OneEuro<double> f;
    const OneEuroOptions o{.cutoff = 2, .beta = 0};
    filter(f, 0.0, 0, o);
    double last = 0;
    for (int i = 1; i <= 4000; ++i) {
        const double t = i * 1e-3, x = filter(f, 1.0, t, o);
        EXPECT_GE(x, last);
        EXPECT_LE(x, 1);
        // A fixed cutoff is a first-order lag of time constant 1/(2π f). The step is a ramp of 1 ms between two
        // samples: half of it later, but for (dt/tau)²/24 = 7e-6.
        EXPECT_NEAR(x, -std::expm1(-2 * std::numbers::pi * 2 * (t - 0.5e-3)), 1e-5);
        last = x;
    }
    EXPECT_NEAR(last, 1, 1e-6);
}

TEST(HandFilter, LagAtConstantSpeedStaysUnderItsBoundAtAnyRate) {
    const HandFilterOptions o;
    const double bound = 1 / (2 * std::numbers::pi * o.position.beta);
    EXPECT_LT(bound, 5.4e-4);
    for (const double rate : {60.0, 125.0, 1000.0})
        for (const double v : {0.002, 0.02, 0.1, 0.5, 2.0}) {
            HandFilter f;
            StrokeSample s, out;
            for (int i = 0; i <= static_cast<int>(2 * rate); ++i) {
                s.time = i / rate;
                s.position = {v * s.time, 0, 0};
                out = smooth(f, s, o);
            }
            const double lag = s.position.x - out.position.x;
            EXPECT_LT(lag, bound);
            // Closed form for the steady state.
            const double exact = v / (2 * std::numbers::pi * (o.position.cutoff + o.position.beta * v));
            EXPECT_NEAR(lag / exact, 1, 1e-3) << rate << " Hz, " << v << " m/s";
        }
}

// Power of what is left of the jitter, across the motion, over that of the jitter itself.
double power_left(double speed, double rate) {
    HandFilter f;
    Random random(7);
    double in = 0, out = 0;
    for (int i = 0; i < 8000; ++i) {
        StrokeSample s;
        s.time = i / rate;
        const Vec3 noise = jitter(random);
        s.position = Vec3(speed * s.time, 0, 0) + noise;
        const double y = smooth(f, s).position.y;
        if (i < 1000) continue;
        in += noise.y * noise.y;
        out += y * y;
    }
    return out / in;
}

TEST(HandFilter, JitterLosesItsPower) {
    EXPECT_LT(power_left(0, 125), 1.0 / 10);
    EXPECT_LT(power_left(0.02, 125), 1.0 / 4);
    EXPECT_LT(power_left(0, 1000), 1.0 / 50);
    EXPECT_LT(power_left(0.02, 1000), 1.0 / 20);
}

TEST(HandFilter, AWholeTraceDoesNotLagAndKeepsItsEnds) {
    StrokeSettings settings;
    settings.smooth = 1;
    StrokeSamples t;
    Random random(9);
    double in = 0, out = 0;
    for (int i = 0; i <= 500; ++i)
        t.samples.push_back(
            {.time = 0.008 * i, .position = Vec3(0.03 * 0.008 * i, 0, 0) + jitter(random), .pressure = 0.5});
    const StrokeSamples steadied = steady(t, settings);
    ASSERT_EQ(steadied.samples.size(), t.samples.size());
    double behind = 0;
    for (std::size_t i = 50; i <= 450; ++i) {
        EXPECT_EQ(steadied.samples[i].time, t.samples[i].time);
        behind += (0.03 * t.samples[i].time - steadied.samples[i].position.x) / 401;
        in += t.samples[i].position.y * t.samples[i].position.y;
        out += steadied.samples[i].position.y * steadied.samples[i].position.y;
    }
    EXPECT_LT(std::abs(behind), 0.1 * kPixel);  // the mean of 401 jitters alone is 0.05 pixels
    EXPECT_LT(out / in, 1.0 / 6);
    // The ends are off by no more than the jitter itself.
    EXPECT_LT(glm::distance(steadied.samples.front().position, t.samples.front().position), 4 * kPixel);
    EXPECT_LT(glm::distance(steadied.samples.back().position, t.samples.back().position), 4 * kPixel);
}

TEST(HandFilter, CommutesWithRotations) {
    const Quat turn = glm::angleAxis(1.1, glm::normalize(Vec3(1, 2, -1)));
    HandFilter a, b;
    Random random(3);
    for (int i = 0; i < 300; ++i) {
        brush::Pose p{.position = {0.05 * std::cos(0.02 * i), 0.03 * std::sin(0.03 * i), 0.01},
                      .rotation = glm::angleAxis(0.3 * std::sin(0.05 * i), Vec3(0, 1, 0)),
                      .time = 0.004 * i};
        p.position += jitter(random);
        const brush::Pose turned{turn * p.position, turn * p.rotation, p.time};
        const brush::Pose x = smooth(a, p), y = smooth(b, turned);
        EXPECT_LT(glm::distance(turn * x.position, y.position), 1e-14);
        EXPECT_NEAR(std::abs(glm::dot(turn * x.rotation, y.rotation)), 1, 1e-13);
    }
}

TEST(HandFilter, TimesThatStandStillAreTaken) {
    HandFilter f;
    StrokeSample s, out;
    for (int i = 0; i < 3000; ++i) {
        s.position.x = 1;
        out = smooth(f, s);
        ASSERT_TRUE(std::isfinite(out.position.x));
    }
    EXPECT_NEAR(out.position.x, 1, 1e-6);
}

TEST(String, IsNeverLongerThanItsLengthAndTheTipNeverGoesFartherThanTheHand) {
    constexpr double length = 3e-3;
    Random random(11);
    String s;
    Vec3 hand(0), last(0);
    double hand_length = 0, tip_length = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 step = 1e-3 * Vec3(random.uniform(-1, 1.2), random.uniform(-1, 1), 0);
        hand += step;
        if (i == 0)
            last = hand;
        else
            hand_length += glm::length(step);
        const StrokeSample out = pull(s, StrokeSample{.time = 0.01 * i, .position = hand, .pressure = 0.5}, length);
        EXPECT_LE(glm::distance(out.position, hand), length * (1 + 1e-12));
        tip_length += glm::distance(out.position, last);
        last = out.position;
        EXPECT_NEAR(out.pressure, 0.5, 1e-15);
        EXPECT_LT(s.past.size(), 3000u);  // only the string's worth of travel is kept
    }
    EXPECT_LE(tip_length, hand_length);
    EXPECT_LT(tip_length, 0.6 * hand_length);  // the wobble is gone
}

TEST(String, AWobbleNarrowerThanTheStringMovesNothing) {
    String s;
    for (int i = 0; i < 1000; ++i) {
        const double a = 0.1 * i;
        const Vec3 hand = i == 0 ? Vec3(0) : 0.9e-3 * Vec3(std::cos(a), std::sin(a), 0);
        EXPECT_EQ(pull(s, StrokeSample{.time = 0.01 * i, .position = hand}, 1e-3).position, Vec3(0));
    }
}

TEST(String, AStraightPullIsATractrix) {
    // Hand along x from (0, L): the tip at the origin follows x = L artanh(√(1−w²)) − L √(1−w²),
    // w the distance from the hand's line over L (Huygens 1692).
    constexpr double length = 1e-2;
    String s;
    pull(s, StrokeSample{.position = {0, 0, 0}}, length);
    pull(s, StrokeSample{.position = {0, length, 0}}, length);
    StrokeSample tip;
    for (int i = 1; i <= 20000; ++i)
        tip = pull(s, StrokeSample{.time = 1e-4 * i, .position = {1e-6 * i, length, 0}}, length);
    const double w = (length - tip.position.y) / length, c = std::sqrt(1 - w * w);
    EXPECT_NEAR(tip.position.x, length * (std::atanh(c) - c), 2e-6);  // first order in steps of 1 µm
}

TEST(String, ZeroLengthPassesEverythingThrough) {
    String s;
    Random random(5);
    for (int i = 0; i < 100; ++i) {
        const StrokeSample in{.time = 0.01 * i,
                              .position = {random.uniform(), random.uniform(), 0},
                              .pressure = random.uniform(),
                              .tilt = {random.uniform(), 0}};
        const StrokeSample out = pull(s, in, 0);
        EXPECT_LT(glm::distance(out.position, in.position), 1e-15);
        EXPECT_EQ(out.pressure, in.pressure);
        EXPECT_EQ(out.tilt, in.tilt);
    }
}

TEST(String, PressureStaysAtItsPositionOnThePath) {
    // A straight drag whose pressure grows along the path; once taut the tip must have, wherever
    // it is, the pressure the hand had there.
    StrokeSettings settings;
    settings.stabilise = 4e-3;
    StrokeSamples t;
    for (int i = 0; i <= 300; ++i)
        t.samples.push_back({.time = 0.01 * i, .position = {1e-4 * i, 0, 0}, .pressure = i / 300.0});
    const StrokeSamples out = steady(t, settings);
    for (const StrokeSample& s : out.samples) EXPECT_NEAR(s.pressure, s.position.x / 3e-2, 1e-9);
    EXPECT_LT(glm::distance(out.samples.back().position, t.samples.back().position), 1e-12);
    EXPECT_EQ(out.samples.back().pressure, 1);
    for (std::size_t i = 1; i < out.samples.size(); ++i) EXPECT_GE(out.samples[i].time, out.samples[i - 1].time);
}

TEST(String, AFerrulePressesThroughAtOnce) {
    String s;
    brush::Pose out;
    for (int i = 0; i <= 100; ++i) {
        const brush::Pose in{.position = {1e-4 * i, 0, 0.03 - 1e-4 * i}, .rotation = {1, 0, 0, 0}, .time = 0.01 * i};
        out = pull(s, in, 2e-3);
        EXPECT_NEAR(out.position.z, in.position.z, 1e-15);
        EXPECT_LE(in.position.x - out.position.x, 2e-3 * (1 + 1e-12));
    }
    EXPECT_NEAR(out.position.x, 8e-3, 1e-12);
}

// Pressure in the steady state of a drag.
double drag_pressure(PressureFrom from, double speed, double rate = 250) {
    PressureState s;
    double p = 0;
    for (int i = 0; i <= static_cast<int>(3 * rate); ++i)
        p = press(s, {speed * i / rate, 0, 0}, i / rate, {.from = from});
    return p;
}

TEST(Pressure, FastIsLightAndRestIsHeavy) {
    const PressureOptions o;
    double last = 2;
    for (const double v : {0.0, 0.01, 0.05, 0.2, 1.0}) {
        const double p = drag_pressure(PressureFrom::speed, v);
        EXPECT_NEAR(p, o.level * (1 + o.speed_effect * std::expm1(-v / o.fast)), 1e-6);
        EXPECT_LT(p, last);
        last = p;
    }
    // After 3 s, 8.5 of its time constants, rest is complete to 2e-4.
    EXPECT_NEAR(drag_pressure(PressureFrom::dwell, 0), o.level * (1 + o.dwell_effect), 1e-3);
    EXPECT_NEAR(drag_pressure(PressureFrom::dwell, 1), o.level, 1e-3);
    EXPECT_NEAR(drag_pressure(PressureFrom::speed_dwell, 0), o.level * (1 + o.dwell_effect), 1e-3);
}

TEST(Pressure, IsTheSameAtAnyRateAndLandsSoftly) {
    const auto at = [](double rate) {
        PressureState s;
        std::vector<double> p;
        for (int i = 0; i <= static_cast<int>(rate); ++i) {
            const double t = i / rate;
            const double x = press(s, {0.05 * t * t, 0, 0}, t, {});
            if (i % static_cast<int>(rate / 50) == 0) p.push_back(x);
        }
        return p;
    };
    const std::vector<double> coarse = at(250), fine = at(2000);
    ASSERT_EQ(coarse.size(), fine.size());
    EXPECT_EQ(coarse.front(), 0);
    for (std::size_t i = 0; i < fine.size(); ++i)
        EXPECT_NEAR(coarse[i], fine[i], 0.02);  // first order: half of 4 ms / 25 ms of a change of 0.25
}

TEST(Pressure, ATraceBecomesLightWhereItIsFastAndEndsLifted) {
    StrokeSamples t;
    double x = 0;
    for (int i = 0; i <= 200; ++i) {
        t.samples.push_back({.time = 0.005 * i, .position = {x, 0, 0}, .pressure = 1});
        x += 0.005 * (i < 100 ? 0.01 : 0.2);
    }
    const StrokeSamples none = press(t, {.from = PressureFrom::none});
    for (const StrokeSample& s : none.samples) EXPECT_EQ(s.pressure, 1);
    const StrokeSamples out = press(t, {.from = PressureFrom::speed});
    EXPECT_GT(out.samples[90].pressure, 1.5 * out.samples[180].pressure);
    EXPECT_EQ(out.samples.back().pressure, 0);
    for (std::size_t i = 1; i + 1 < out.samples.size(); ++i) {
        EXPECT_GT(out.samples[i].pressure, 0);
        // At 0.2 m/s the 3 mm of the run-out are three samples, which share 0.25 of pressure.
        EXPECT_LT(std::abs(out.samples[i].pressure - out.samples[i - 1].pressure), 0.15);
    }
    // A tap is a dot, not nothing.
    StrokeSamples tap;
    for (int i = 0; i <= 50; ++i) tap.samples.push_back({.time = 0.01 * i});
    EXPECT_GT(press(tap, {}).samples[49].pressure, 0.5);
}

TEST(StrokeSettings, OfAHandComeBackAndNonsenseIsRefused) {
    PaintStroke entry;
    entry.settings.dip = DipMode::persistent;
    entry.settings.pressure = PressureFrom::speed_dwell;
    entry.settings.smooth = 1.5;
    entry.settings.stabilise = 2.5e-3;
    EXPECT_EQ(written_and_read(entry).get<PaintStroke>().settings, entry.settings);
    // What earlier versions wrote.
    const JournalEntry old =
        entry_of({}, R"({"spine":"rod","footprint":"surface","contact":"exact","spacing":1.0,"lead":true})");
    EXPECT_EQ(old.get<PaintStroke>().settings, StrokeSettings{});
    for (const char* bad : {R"({"dip":"often"})", R"({"spine":"bone"})", R"({"pressure":"guess"})", R"({"smooth":-1})",
                            R"({"stabilise":1e9})", R"({"action":"sneeze"})", R"({"action":3})", "{"})
        EXPECT_THROW(entry_of({}, bad), Error) << bad;
}

}  // namespace
}  // namespace tuft::stroke
