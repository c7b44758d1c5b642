#include "ink/deposit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/random.h"
#include "ink/composite.h"
#include "ink/reservoir.h"

namespace tuft::ink {
namespace {

constexpr int kN = atlas::kTileTexels;
using Texels = std::array<float, kN>;

Ink plain(const std::string& name, std::vector<std::pair<std::string, double>> parts = {}) {
    Ink ink;
    ink.name = name;
    if (parts.empty()) parts = {{name, 1.0}};
    for (const auto& [pigment, fraction] : parts) {
        InkPart part;
        part.pigment.name = pigment;
        part.fraction = fraction;
        ink.parts.push_back(part);
    }
    return ink;
}

Texels constant(float v) {
    Texels a;
    a.fill(v);
    return a;
}

Texels random_texels(std::uint64_t seed, double lo, double hi) {
    Texels a;
    for (int t = 0; t < kN; ++t) a[t] = static_cast<float>(lo + (hi - lo) * uniform(seed, t));
    return a;
}

const Texels kArea = random_texels(99, 0.5e-8, 1.5e-8);  // texels of about 0.1 mm

TEST(Deposit, FollowsTheRateLawForAnySteps) {
    const Ink ink = plain("black");
    for (const double step : {0.05e-3, 0.1e-3, 0.5e-3, 1e-3}) {
        Canvas canvas(1);
        DepositParams params{
            .mix = mix_of(canvas, ink), .target = 1.6f, .transfer_length = 0.5e-3f};
        for (double s = 0; s < 1e-3 - 1e-9; s += step)
            deposit(canvas, 0, constant(0.75f), kArea, step, params);
        // w(s) = c f (1 − exp(−s/s0)); float rounding per step 6e-8, at most 20 steps.
        const double expected = 1.6 * 0.75 * (1 - std::exp(-2.0));
        EXPECT_NEAR((*canvas.plane(0, 0))[100], expected, 3e-6) << step;
    }
}

TEST(Deposit, PassingAgainNeitherBeadsNorLosesTheEdge) {
    Canvas canvas(1);
    const Texels coverage = random_texels(3, 0, 1);
    const DepositParams params{.mix = mix_of(canvas, plain("black")), .target = 1.8f};
    for (int i = 0; i < 200; ++i) deposit(canvas, 0, coverage, kArea, 1e-3, params);
    for (int t = 0; t < kN; ++t)
        EXPECT_NEAR((*canvas.plane(0, 0))[t], 1.8f * coverage[t], 2e-6f) << "the edge keeps f";
}

TEST(Deposit, ATexelHalfCoveredLooksHalfCovered) {
    for (const auto& [name, under, tolerance] :
         {std::tuple{"carbon", "porcelain", 0.02}, std::tuple{"cinnabar", "porcelain", 0.04},
          std::tuple{"titanium-white", "clay", 0.06}}) {
        const Ink ink = load_ink(name);
        const Substrate substrate = load_substrate(under);
        Canvas canvas(1);
        const DepositParams params{.mix = mix_of(canvas, ink),
                                   .target = static_cast<float>(ink.film),
                                   .extinction = extinction_of(ink)};
        Texels coverage;
        for (int t = 0; t < kN; ++t) coverage[t] = static_cast<float>(t) / (kN - 1);
        for (int i = 0; i < 50; ++i) deposit(canvas, 0, coverage, kArea, 1e-3, params);
        EXPECT_NEAR((*canvas.plane(0, 0))[kN - 1], ink.film, 1e-4 * ink.film)
            << "1 − f hidden is near 0 there and has lost digits";
        const TileLook look = look_of_tile(canvas, 0, substrate);
        for (int t = 0; t < kN; ++t) {
            const double bare = look.colour[1][0], full = look.colour[1][kN - 1];
            // Exact for a film that only absorbs; the tolerance is that of the scattering.
            EXPECT_NEAR(look.colour[1][t], bare + coverage[t] * (full - bare), tolerance)
                << name << t;
        }
    }
}

TEST(Deposit, GoalsFollowTheLogarithm) {
    const Texels coverage = random_texels(4, 0, 1);
    for (const double extinction : {0.01, 1.0, 4.0, 100.0}) {
        Canvas canvas(1);
        deposit(canvas, 0, coverage, kArea, 1e6,
                {.mix = mix_of(canvas, plain("black")),
                 .target = 1.5f,
                 .extinction = static_cast<float>(extinction)});
        const double e = std::min(extinction, 12 / 1.5);
        for (int t = 0; t < kN; ++t) {
            const double x = 1 - coverage[t] * -std::expm1(-e * 1.5);
            // Float rounding of x, magnified by the slope 1 / (ε x).
            EXPECT_NEAR((*canvas.plane(0, 0))[t], -std::log(x) / e, 3e-7 * (1 + 1 / (e * x)))
                << extinction;
        }
    }
}

TEST(Deposit, GivenInkIsWhatTheTexelsGained) {
    Canvas canvas(1);
    const Mix mix = mix_of(canvas, plain("purple", {{"red", 0.3}, {"blue", 0.6}}));
    double given = 0;
    for (int i = 0; i < 300; ++i)
        given +=
            deposit(canvas, 0, random_texels(i, 0, 1), kArea, 2e-5, {.mix = mix, .target = 1.8f});
    double on_texels = 0, red = 0;
    for (int t = 0; t < kN; ++t) {
        const double area = kArea[t];
        red += area * (*canvas.plane(0, 0))[t];
        on_texels += area * (*canvas.plane(0, 0))[t] + area * (*canvas.plane(0, 1))[t];
    }
    // The differences are booked as stored, so the sums agree to double rounding; the
    // ink is 90 % pigment (as floats) and the rest water.
    const double strength = static_cast<double>(mix[0]) + static_cast<double>(mix[1]);
    EXPECT_NEAR(given * strength, on_texels, 1e-13 * on_texels);
    EXPECT_NEAR(red / on_texels, 1.0 / 3, 1e-6);
}

TEST(Deposit, AnotherInkGoesOnTopUpToTheCapacity) {
    Canvas canvas(1);
    const Mix black = mix_of(canvas, plain("black")), white = mix_of(canvas, plain("white"));
    for (int i = 0; i < 50; ++i)
        deposit(canvas, 0, constant(1), kArea, 1e-3, {.mix = black, .target = 2, .capacity = 3});
    const float black_before = (*canvas.plane(0, 0))[5];
    for (int i = 0; i < 50; ++i)
        deposit(canvas, 0, constant(1), kArea, 1e-3, {.mix = white, .target = 2, .capacity = 3});
    EXPECT_EQ((*canvas.plane(0, 0))[5], black_before) << "what lies there stays";
    EXPECT_NEAR(black_before, 2, 1e-6);
    EXPECT_NEAR((*canvas.plane(0, 1))[5], 1, 1e-6) << "no more than the capacity in all";
    const double more =
        deposit(canvas, 0, constant(1), kArea, 1e-3, {.mix = black, .target = 9, .capacity = 3});
    EXPECT_LE(more, 1e-6 * 1e-8 * kN);
}

TEST(Deposit, NothingWantedTouchesNothing) {
    Canvas canvas(1);
    const Mix mix = mix_of(canvas, plain("black"));
    EXPECT_EQ(deposit(canvas, 0, constant(0), kArea, 1e-3, {.mix = mix}), 0);
    EXPECT_EQ(deposit(canvas, 0, constant(1), kArea, 0, {.mix = mix}), 0);
    EXPECT_EQ(deposit(canvas, 0, constant(1), kArea, 1e-3, {.mix = mix, .target = 0}), 0);
    EXPECT_EQ(deposit(canvas, 0, constant(1), kArea, 1e-3, {}), 0) << "an empty tuft";
    EXPECT_FALSE(canvas.touched(0));
    EXPECT_TRUE(canvas.take_dirty().empty());
}

TEST(Deposit, BitsArePinnedForEveryInstructionSet) {
    // The same sums in the written order, one texel at a time.
    Canvas canvas(1);
    const Mix mix = mix_of(canvas, plain("purple", {{"red", 0.3}, {"blue", 0.6}}));
    std::array<Texels, 2> w{};
    for (int i = 0; i < 40; ++i) {
        const Texels f = random_texels(i, 0, 1);
        deposit(canvas, 0, f, kArea, 7e-5, {.mix = mix, .target = 1.8f, .capacity = 1.5f});
        const auto rate = static_cast<float>(
            -std::expm1(-7e-5 / static_cast<double>(DepositParams{}.transfer_length)));
        for (int t = 0; t < kN; ++t) {
            float inverse0 = 1.0f / mix[0], inverse1 = 1.0f / mix[1];
            float all = w[0][t] + w[1][t];
            float film0 = w[0][t] * inverse0, film1 = w[1][t] * inverse1;
            const float film = std::min<float>(film0, film1);
            float room = film + 1.5f;
            room = room - all;
            float goal = 1.8f * f[t];
            float lack = std::min<float>(goal, room) - film;
            float dw = std::max<float>(lack, 0) * rate;
            for (int p = 0; p < 2; ++p) {
                float part = mix[p] * dw;
                w[p][t] = w[p][t] + part;
            }
        }
    }
    for (int p = 0; p < 2; ++p)
        for (int t = 0; t < kN; ++t) EXPECT_EQ((*canvas.plane(0, p))[t], w[p][t]) << t;
}

TEST(Reservoir, DippingFillsUpAndMixes) {
    Canvas canvas(1);
    const Mix black = mix_of(canvas, plain("black")),
              thin = mix_of(canvas, plain("thin", {{"white", 0.5}}));
    Reservoir tuft = make_reservoir(0.6);
    EXPECT_NEAR(tuft.capacity, 0.06, 1e-15) << "1 mL is 0.1 film·m²";
    EXPECT_NEAR(dip(tuft, black), 0.06, 1e-15);
    take(tuft, 0.03);
    EXPECT_NEAR(tuft.fullness(), 0.5, 1e-15);
    EXPECT_NEAR(dip(tuft, thin), 0.03, 1e-15);
    EXPECT_NEAR(tuft.mix()[0], 0.5, 1e-7);
    EXPECT_NEAR(tuft.mix()[1], 0.25, 1e-7);
    EXPECT_NEAR(tuft.water, 0.015, 1e-15);
    EXPECT_NEAR(rinse(tuft), 0.06, 1e-15);
    EXPECT_EQ(tuft.remaining(), 0);
}

TEST(Reservoir, ThePaperRecurrenceIsTheRateLawAtItsOwnSpacing) {
    double z = 1, sum = 0;
    const double eta = 0.004;
    for (int i = 0; i < 1000; ++i) {
        const double k = 0.2 + 0.6 * uniform(5, i);
        const double q = paper_quantity(eta, k, z - sum);
        EXPECT_NEAR(q, supply_quantity(eta, k, z - sum, 0.5e-3, 0.5e-3), eta * q)
            << "1 − exp(−x) = x (1 − x/2 …) with x ≤ η";
        sum += q;
    }
    double product = 1;
    for (int i = 0; i < 1000; ++i) product *= 1 - eta * (0.2 + 0.6 * uniform(5, i));
    EXPECT_NEAR(z - sum, product, 1e-13) << "remaining Z Π(1 − η k)";
    // Any sampling of one path gives the same.
    const double once = supply_quantity(eta, 0.5, 1, 20e-3, 0.5e-3);
    double left = 1;
    for (int i = 0; i < 400; ++i) left -= supply_quantity(eta, 0.5, left, 0.05e-3, 0.5e-3);
    EXPECT_NEAR(1 - left, once, 1e-13);
}

TEST(Reservoir, ALoadedBrushWritesBlackAndAnEmptyOnePale) {
    const Ink ink = load_ink("carbon");
    const Substrate substrate = load_substrate("porcelain");
    Canvas canvas(1);
    Reservoir tuft = make_reservoir(0.5);
    dip(tuft, mix_of(canvas, ink));
    for (const double fullness : {1.0, 0.6, 0.4}) {
        take(tuft, tuft.remaining() - fullness * tuft.capacity);
        for (const double width : {0.3e-3, 2e-3, 6e-3, 10e-3}) {
            const DepositParams p = stamp_deposit(
                tuft, ink, {.moment_factor = 0.5, .width = width, .area = width * width},
                substrate);
            EXPECT_GE(p.target, 0.9 * ink.film) << fullness << " " << width;
        }
    }
    take(tuft, tuft.remaining() - 0.01 * tuft.capacity);
    const StampContact wide{.moment_factor = 0.5, .width = 8e-3, .area = 6e-5};
    const StampContact hair{.moment_factor = 0.5, .width = 0.3e-3, .area = 1e-7};
    EXPECT_LE(stamp_deposit(tuft, ink, wide, substrate).target, 0.3 * ink.film);
    EXPECT_GE(stamp_deposit(tuft, ink, hair, substrate).target, 0.8 * ink.film);
    rinse(tuft);
    EXPECT_EQ(stamp_deposit(tuft, ink, wide, substrate).target, 0);
}

TEST(Reservoir, TuftAndTexelsTogetherKeepTheInk) {
    const Ink ink = load_ink("carbon");
    const Substrate substrate = load_substrate("porcelain");
    constexpr std::uint32_t kSlots = 63;
    Canvas canvas(kSlots);
    const Mix mix = mix_of(canvas, ink);
    Reservoir tuft = make_reservoir(0.0005);
    const double start = dip(tuft, mix);
    const Texels area = random_texels(8, 2e-6, 4e-6);  // coarse: much surface, little ink
    for (int i = 0; i < 1500; ++i) {
        const StampContact contact{.moment_factor = 0.5, .width = 5e-3, .area = 4 * kN * 4e-6};
        const DepositParams params = stamp_deposit(tuft, ink, contact, substrate);
        double given = 0;
        for (std::uint32_t slot = 0; slot < 4; ++slot)
            given += deposit(canvas, (i / 25 + slot) % kSlots, random_texels(i, 0, 1), area, 1e-4,
                             params);
        take(tuft, given);
    }
    double on_texels = 0;
    for (std::uint32_t slot = 0; slot < kSlots; ++slot)
        for (int t = 0; t < kN && canvas.touched(slot); ++t)
            on_texels +=
                static_cast<double>(area[t]) * static_cast<double>((*canvas.plane(slot, 0))[t]);
    EXPECT_GT(on_texels, 0.9 * start) << "the test wants a brush that runs dry";
    EXPECT_GE(tuft.remaining(), 0);
    EXPECT_NEAR(on_texels + tuft.remaining(), start, 1e-6 * start);
}

}  // namespace
}  // namespace tuft::ink
