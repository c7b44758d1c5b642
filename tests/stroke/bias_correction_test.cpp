#include "stroke/gesture/bias_correction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/random.h"

namespace tuft::stroke {
namespace {

// A smooth stroke of some 10–30 mm: a random cubic, pressed and lifted, tilted a little.
RecordedStroke random_stroke(std::uint64_t seed) {
    Random random(seed);
    Vec2 p[4];
    for (Vec2& x : p) x = 0.02 * Vec2(random.uniform(-1, 1), random.uniform(-1, 1));
    const double press = random.uniform(0.4, 0.9);
    RecordedStroke t;
    for (int i = 0; i <= 120; ++i) {
        const double u = i / 120.0, v = 1 - u;
        const Vec2 x = v * v * v * p[0] + 3 * v * v * u * p[1] + 3 * v * u * u * p[2] + u * u * u * p[3];
        t.samples.push_back({.time = 0.01 * i,
                             .position = Vec3(x, 0),
                             .pressure = press * std::min(1.0, 6 * std::min(u, v)),
                             .tilt = {0.1 * random.uniform(), 0.05}});
    }
    return t;
}

std::vector<RecordedStroke> random_strokes(std::uint64_t seed, int n) {
    std::vector<RecordedStroke> out;
    for (int i = 0; i < n; ++i) out.push_back(random_stroke(100 * seed + static_cast<std::uint64_t>(i)));
    return out;
}

// Presses four fifths, slants by 0.2, narrows to nine tenths, leans the holder to the right.
std::vector<RecordedStroke> slanted(std::vector<RecordedStroke> traces) {
    for (RecordedStroke& t : traces)
        for (StrokeSample& s : t.samples) {
            s.position = {0.9 * s.position.x - 0.2 * s.position.y + 0.004, s.position.y - 0.002, 0};
            s.pressure *= 0.8;
            s.tilt += Vec2(0.15, -0.05);
        }
    return traces;
}

Vec3 mean_position(const std::vector<RecordedStroke>& traces) {
    Vec3 sum(0);
    double n = 0;
    for (const RecordedStroke& t : traces)
        for (const StrokeSample& s : t.samples) sum += s.position, ++n;
    return sum / n;
}

// Root mean square distance of positions once the whole is moved into place, metres.
double misplaced(const std::vector<RecordedStroke>& a, const std::vector<RecordedStroke>& b) {
    const Vec3 offset = mean_position(a) - mean_position(b);
    double sum = 0, n = 0;
    for (std::size_t t = 0; t < a.size(); ++t)
        for (std::size_t i = 0; i < a[t].samples.size(); ++i, ++n) {
            const Vec3 d = a[t].samples[i].position - b[t].samples[i].position - offset;
            sum += glm::dot(d, d);
        }
    return std::sqrt(sum / n);
}

TEST(BiasCorrection, IsUndoneOnStrokesNotTrainedOn) {
    const auto intended = random_strokes(1, 24);
    const BiasCorrection bias = learn_bias(intended, slanted(intended));
    const auto meant = random_strokes(2, 12);
    const auto written = slanted(meant);
    const auto corrected = correct_bias(bias, written);
    // The pull to the identity is 1e-3 of the scatter; unlike strokes lend their small mismatch.
    EXPECT_LT(misplaced(corrected, meant), 0.05 * misplaced(written, meant));
    for (std::size_t t = 0; t < meant.size(); ++t)
        for (std::size_t i = 10; i + 10 < meant[t].samples.size(); ++i) {
            const StrokeSample &c = corrected[t].samples[i], &m = meant[t].samples[i];
            EXPECT_NEAR(c.pressure / m.pressure, 1, 0.02) << t << ' ' << i;
            // The hand's own wobble of 0.1 rad differs between sample and sample.
            EXPECT_LT(glm::length(c.tilt - m.tilt), 0.01);
            EXPECT_EQ(c.time, written[t].samples[i].time);
        }
}

TEST(BiasCorrection, OfNoneChangesNothing) {
    const auto intended = random_strokes(3, 10);
    const BiasCorrection bias = learn_bias(intended, intended);
    const auto strokes = random_strokes(4, 5), same = correct_bias(bias, strokes);
    for (std::size_t t = 0; t < strokes.size(); ++t)
        for (std::size_t i = 0; i < strokes[t].samples.size(); ++i) {
            // Rounding only: all that is learned is the identity.
            EXPECT_LT(glm::distance(same[t].samples[i].position, strokes[t].samples[i].position), 1e-12);
            EXPECT_NEAR(same[t].samples[i].pressure, strokes[t].samples[i].pressure, 1e-9);
            EXPECT_LT(glm::length(same[t].samples[i].tilt - strokes[t].samples[i].tilt), 1e-9);
        }
}

// A straight stroke in the direction of an angle, from a place.
RecordedStroke straight(double angle, const Vec2& from, double length, double pressure) {
    RecordedStroke t;
    for (int i = 0; i <= 60; ++i) {
        const double u = i / 60.0;
        const Vec2 x = from + u * length * Vec2(std::cos(angle), std::sin(angle));
        t.samples.push_back({.time = 0.01 * i, .position = Vec3(x, 0), .pressure = pressure});
    }
    return t;
}

TEST(BiasCorrection, DependsOnTheKindOfStroke) {
    // Verticals come out light, horizontals heavy.
    std::vector<RecordedStroke> intended, written;
    for (int i = 0; i < 6; ++i) {
        const Vec2 from(0.01 * i, 0.003 * i);
        intended.push_back(straight(0.02 * i, from, 0.01 + 0.001 * i, 0.5));
        written.push_back(straight(0.02 * i, from, 0.01 + 0.001 * i, 0.5 * 1.25));
        intended.push_back(straight(1.5 + 0.02 * i, from, 0.01 + 0.001 * i, 0.6));
        written.push_back(straight(1.5 + 0.02 * i, from, 0.01 + 0.001 * i, 0.6 * 0.7));
    }
    const BiasCorrection bias = learn_bias(intended, written);
    const auto out = correct_bias(bias, {straight(0.05, Vec2(0.02, 0.02), 0.0125, 0.5 * 1.25),
                                         straight(1.55, Vec2(0.05, 0.01), 0.0125, 0.6 * 0.7)});
    for (const StrokeSample& s : out[0].samples) EXPECT_NEAR(s.pressure, 0.5, 0.01);
    for (const StrokeSample& s : out[1].samples) EXPECT_NEAR(s.pressure, 0.6, 0.01);
}

TEST(BiasCorrection, StaysWithinItsBounds) {
    // Ten times too light, and three times too small: taken back as far as by two.
    std::vector<RecordedStroke> intended, written;
    for (int i = 0; i < 6; ++i) {
        intended.push_back(straight(i, Vec2(0.01 * i, 0), 0.02, 0.9));
        written.push_back(straight(i, Vec2(0.01 * i, 0) / 3.0, 0.02 / 3, 0.09));
    }
    const BiasCorrection bias = learn_bias(intended, written);
    for (const BiasPiece& p : bias.pieces)
        for (const double r : p.pressure_ratio) EXPECT_NEAR(r, 2, 1e-12);
    for (const double angle : {0.0, 1.0, 2.0, 3.0})
        EXPECT_LE(glm::length(bias.linear * Vec2(std::cos(angle), std::sin(angle))), 2 + 1e-12);
    for (const RecordedStroke& t : correct_bias(bias, written))
        for (const StrokeSample& s : t.samples) EXPECT_LE(s.pressure, 0.18 + 1e-12);
}

TEST(BiasCorrection, ComesBackFromItsFile) {
    const auto intended = random_strokes(5, 4);
    const BiasCorrection bias = learn_bias(intended, slanted(intended));
    const BiasCorrection back = parse_bias(bias_toml(bias), "bias.toml");
    ASSERT_EQ(back.pieces.size(), bias.pieces.size());
    const auto written = random_strokes(6, 3);
    const auto a = correct_bias(bias, written), b = correct_bias(back, written);
    for (std::size_t t = 0; t < a.size(); ++t)
        for (std::size_t i = 0; i < a[t].samples.size(); ++i) {
            // Twelve digits are written.
            EXPECT_LT(glm::distance(a[t].samples[i].position, b[t].samples[i].position), 1e-10);
            EXPECT_NEAR(a[t].samples[i].pressure, b[t].samples[i].pressure, 1e-9);
        }
}

TEST(BiasCorrection, BadInputIsRefused) {
    const auto one = random_strokes(7, 1), two = random_strokes(7, 2);
    EXPECT_THROW(learn_bias(one, two), Error);
    EXPECT_THROW(learn_bias({}, {}), Error);
    auto space = one;
    space[0].flat = false;
    EXPECT_THROW(learn_bias(space, one), Error);
    for (const char* bad : {"linear = [1, 0, 0]", "linear = [1, 0, 0, nan]", "linear = [0, 0, 0, 0]", "colour = 3",
                            "[[cluster]]\npressure_ratio = [1, 1, 1, 3]", "[[cluster]]\nlength_mm = -1",
                            "[[cluster]]\nlength_mm = \"long\"", "[[cluster]]\nwidth = 2", "linear = ["})
        EXPECT_THROW(parse_bias(bad, "bad.toml"), Error) << bad;
}

TEST(BiasCorrection, DotsAndSingleSamplesAreTaken) {
    std::vector<RecordedStroke> dots(3);
    for (int i = 0; i < 20; ++i) dots[0].samples.push_back({.time = 0.01 * i, .pressure = 0.5});
    dots[1].samples.push_back({.pressure = 0.5});
    dots[2].samples.resize(5, {.position = {0.001, 0, 0}, .pressure = 0.2});
    auto heavier = dots;
    for (RecordedStroke& t : heavier)
        for (StrokeSample& s : t.samples) s.pressure *= 1.5;
    const BiasCorrection bias = learn_bias(heavier, dots);
    const auto out = correct_bias(bias, dots);
    for (const RecordedStroke& t : out)
        for (const StrokeSample& s : t.samples) {
            EXPECT_TRUE(std::isfinite(s.position.x) && std::isfinite(s.pressure));
            EXPECT_GE(s.pressure, 0.2);
        }
    EXPECT_NEAR(out[0].samples[10].pressure, 0.75, 0.05);
}

}  // namespace
}  // namespace tuft::stroke
