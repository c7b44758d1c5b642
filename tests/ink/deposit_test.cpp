#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/random.h"
#include "ink/composite/composite.h"
#include "ink/exchange/tile_deposit.h"
#include "texels.h"

namespace tuft::ink {
namespace {

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

const Texels kArea = random_texels(99, 0.5e-8, 1.5e-8);  // texels of about 0.1 mm

/// Deposits a stamp that travels `ds` metres on tile 0.
double deposit_over(Canvas& canvas, const Texels& coverage, double ds, const DepositParams& params) {
    return deposit(canvas, {0, coverage, kArea}, params, deposit_law(params, ds));
}

TEST(Deposit, FollowsTheRateLawForAnySteps) {
    const Ink ink = plain("black");
    for (const double step : {0.05e-3, 0.1e-3, 0.5e-3, 1e-3}) {
        Canvas canvas(1);
        DepositParams params{.mix = mix_of(canvas, ink), .target = 1.6f, .transfer_length = 0.5e-3f};
        for (double s = 0; s < 1e-3 - 1e-9; s += step) deposit_over(canvas, constant(0.75f), step, params);
        // w(s) = c f (1 − exp(−s/s0)); float rounding per step 6e-8, at most 20 steps.
        const double expected = 1.6 * 0.75 * (1 - std::exp(-2.0));
        EXPECT_NEAR((*canvas.plane(0, 0))[100], expected, 3e-6) << step;
    }
}

TEST(Deposit, PassingAgainNeitherBeadsNorLosesTheEdge) {
    Canvas canvas(1);
    const Texels coverage = random_texels(3, 0, 1);
    const DepositParams params{.mix = mix_of(canvas, plain("black")), .target = 1.8f};
    for (int i = 0; i < 200; ++i) deposit_over(canvas, coverage, 1e-3, params);
    for (int t = 0; t < kN; ++t) EXPECT_NEAR((*canvas.plane(0, 0))[t], 1.8f * coverage[t], 2e-6f) << "the edge keeps f";
}

TEST(Deposit, AnEmptyPlaneChangesNothing) {
    // A tile that holds one pigment is inked in one pass, one that holds more step by step: to the bit the same.
    Texels coverage = random_texels(11, 0, 1);
    std::fill(coverage.begin(), coverage.begin() + 48, 0.0f);
    std::fill(coverage.begin() + 96, coverage.begin() + 160, 1.0f);
    for (const float extinction : {0.0f, 1.7f}) {
        Canvas alone(1), beside(1);
        DepositParams params{.mix = mix_of(alone, plain("black")), .capacity = 2.5f, .extinction = extinction};
        mix_of(beside, plain("black"));
        beside.touch(0, beside.add_pigment(plain("white").parts[0].pigment));
        for (int i = 0; i < 40; ++i) {
            params.target = i % 3 == 0 ? 0.7f : 1.9f;
            const double a = deposit_over(alone, coverage, 0.03e-3, params);
            const double b = deposit_over(beside, coverage, 0.03e-3, params);
            ASSERT_EQ(a, b) << i;
        }
        EXPECT_EQ(*alone.plane(0, 0), *beside.plane(0, 0));
        EXPECT_GT((*alone.plane(0, 0))[120], 1.0f);
    }
}

TEST(Deposit, ATexelHalfCoveredLooksHalfCovered) {
    for (const auto& [name, under, tolerance] :
         {std::tuple{"carbon", "bisque", 0.02}, std::tuple{"cinnabar", "bisque", 0.04},
          std::tuple{"titanium-white", "clay", 0.06},
          // A glaze deepens half tones, as dot gain does in print: with R = 0.92 (1 − f) below it,
          // (1 − k) R / (1 − k R) lies up to 0.17 under the straight line.
          std::tuple{"carbon", "porcelain", 0.17}}) {
        const Ink ink = load_ink(name);
        const Substrate substrate = load_substrate(under);
        Canvas canvas(1);
        const DepositParams params{
            .mix = mix_of(canvas, ink), .target = static_cast<float>(ink.film), .extinction = extinction_of(ink)};
        Texels coverage;
        for (int t = 0; t < kN; ++t) coverage[t] = static_cast<float>(t) / (kN - 1);
        for (int i = 0; i < 50; ++i) deposit_over(canvas, coverage, 1e-3, params);
        EXPECT_NEAR((*canvas.plane(0, 0))[kN - 1], ink.film, 1e-4 * ink.film)
            << "1 − f hidden is near 0 there and has lost digits";
        const TileAppearance look = shade_tile(canvas, 0, substrate);
        for (int t = 0; t < kN; ++t) {
            const double bare = look.colour[1][0], full = look.colour[1][kN - 1];
            // Exact for a film that only absorbs; the tolerance is that of the scattering.
            EXPECT_NEAR(look.colour[1][t], bare + coverage[t] * (full - bare), tolerance) << name << t;
        }
    }
}

TEST(Deposit, GoalsFollowTheLogarithm) {
    const Texels coverage = random_texels(4, 0, 1);
    for (const double extinction : {0.01, 1.0, 4.0, 100.0}) {
        Canvas canvas(1);
        deposit_over(
            canvas, coverage, 1e6,
            {.mix = mix_of(canvas, plain("black")), .target = 1.5f, .extinction = static_cast<float>(extinction)});
        const double e = std::min(extinction, 12 / 1.5);
        for (int t = 0; t < kN; ++t) {
            const double x = 1 - coverage[t] * -std::expm1(-e * 1.5);
            // Float rounding of x, magnified by the slope 1 / (ε x).
            EXPECT_NEAR((*canvas.plane(0, 0))[t], -std::log(x) / e, 3e-7 * (1 + 1 / (e * x))) << extinction;
        }
    }
}

TEST(Deposit, GivenInkIsWhatTheTexelsGained) {
    Canvas canvas(1);
    const Mix mix = mix_of(canvas, plain("purple", {{"red", 0.3}, {"blue", 0.6}}));
    double given = 0;
    for (int i = 0; i < 300; ++i)
        given += deposit_over(canvas, random_texels(i, 0, 1), 2e-5, {.mix = mix, .target = 1.8f});
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

TEST(Deposit, StampsOnOneTileLeaveAndGiveWhatTheyDoOneByOne) {
    // Alone on the tile from the second stamp on; from the 20th with another ink; then that one's mixture with the
    // first.
    const Texels tone = random_texels(7, 0.9, 1.1);
    Canvas one_by_one(1), together(1);
    for (Canvas* canvas : {&one_by_one, &together})
        for (const char* name : {"black", "white"}) mix_of(*canvas, plain(name));
    const Mix black = mix_of(together, plain("black")), white = mix_of(together, plain("white"));
    Mix grey = black;
    grey[1] = 1 - (grey[0] = 0.6f);
    TileDeposit deposits(together, 0, kArea, tone);
    double given = 0;
    for (int i = 0; i < 60; ++i) {
        const Texels coverage = i % 5 == 3 ? constant(1) : random_texels(i, 0, 1);
        const DepositParams params{.mix = i < 20   ? black
                                          : i < 40 ? white
                                                   : grey,
                                   .target = 1.8f + 0.01f * static_cast<float>(i),
                                   .capacity = 3,
                                   .extinction = i % 2 == 0 ? 0.7f : 0.0f};
        const DepositLaw law = deposit_law(params, 2e-5);
        given += deposit(one_by_one, {0, coverage, kArea}, params, law, tone);
        deposits.add(coverage, params, law);
    }
    // Both sum the stored differences in double precision.
    EXPECT_NEAR(deposits.finish(), given, 1e-13 * given);
    EXPECT_TRUE(together.same_contents(one_by_one));
    EXPECT_EQ(together.take_dirty(), one_by_one.take_dirty());
}

TEST(Deposit, AnotherInkGoesOnTopUpToTheCapacity) {
    Canvas canvas(1);
    const Mix black = mix_of(canvas, plain("black")), white = mix_of(canvas, plain("white"));
    for (int i = 0; i < 50; ++i) deposit_over(canvas, constant(1), 1e-3, {.mix = black, .target = 2, .capacity = 3});
    const float black_before = (*canvas.plane(0, 0))[5];
    for (int i = 0; i < 50; ++i) deposit_over(canvas, constant(1), 1e-3, {.mix = white, .target = 2, .capacity = 3});
    EXPECT_EQ((*canvas.plane(0, 0))[5], black_before) << "what lies there stays";
    EXPECT_NEAR(black_before, 2, 1e-6);
    EXPECT_NEAR((*canvas.plane(0, 1))[5], 1, 1e-6) << "no more than the capacity in all";
    const double more = deposit_over(canvas, constant(1), 1e-3, {.mix = black, .target = 9, .capacity = 3});
    EXPECT_LE(more, 1e-6 * 1e-8 * kN);
}

TEST(Deposit, NothingWantedTouchesNothing) {
    Canvas canvas(1);
    const Mix mix = mix_of(canvas, plain("black"));
    EXPECT_EQ(deposit_over(canvas, constant(0), 1e-3, {.mix = mix}), 0);
    EXPECT_EQ(deposit_over(canvas, constant(1), 0, {.mix = mix}), 0);
    EXPECT_EQ(deposit_over(canvas, constant(1), 1e-3, {.mix = mix, .target = 0}), 0);
    EXPECT_EQ(deposit_over(canvas, constant(1), 1e-3, {}), 0) << "an empty tuft";
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
        deposit_over(canvas, f, 7e-5, {.mix = mix, .target = 1.8f, .capacity = 1.5f});
        const auto rate = static_cast<float>(-std::expm1(-7e-5 / static_cast<double>(DepositParams{}.transfer_length)));
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

}  // namespace
}  // namespace tuft::ink
