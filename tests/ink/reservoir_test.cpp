#include "ink/exchange/reservoir.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "core/random.h"
#include "texels.h"

namespace tuft::ink {
namespace {

using Content = Reservoir::Content;

Ink plain(const std::string& name, double fraction = 1) {
    Ink ink;
    ink.name = name;
    InkPart part;
    part.pigment.name = name;
    part.fraction = fraction;
    ink.parts.push_back(part);
    return ink;
}

ReservoirLayout layout_of(int bundles) {
    ReservoirLayout l{.bundles = {},
                      .cell_ends = {0.4, 0.7, 0.9, 1},
                      .cell_capacities = {0.5, 0.3, 0.15, 0.05},
                      .refill_time = 0.3,
                      .side_time = 3};
    for (int k = 0; k < bundles; ++k) {
        const double r = std::sqrt((k + 0.5) / bundles), w = 2.4 * k;
        l.bundles.push_back({r * std::cos(w), r * std::sin(w)});
    }
    return l;
}

constexpr Mix kBlack{1}, kThin{0, 0.5f};
constexpr std::size_t kCells = 4;

/// A tuft whose cells hold different amounts of two inks.
Reservoir uneven(int bundles = 24) {
    Reservoir tuft = make_reservoir(0.5, layout_of(bundles));
    for (std::size_t i = 0; i < tuft.content.size(); ++i) {
        const double q = tuft.cell_capacity[i] * uniform(3, i), part = uniform(4, i);
        tuft.content[i][0] = q * part;
        tuft.content[i][1] = 0.5 * q * (1 - part);
        tuft.content[i][kMaxPigments] = 0.5 * q * (1 - part);
    }
    return tuft;
}

Content planes_of(const Reservoir& tuft) {
    Content sum{};
    for (const Content& c : tuft.content)
        for (int p = 0; p < Reservoir::kPlanes; ++p) sum[p] += c[p];
    return sum;
}

void expect_same(const Content& a, const Content& b, double whole, const char* what) {
    // 1e-12 of the whole: sums of a few thousand doubles.
    for (int p = 0; p < Reservoir::kPlanes; ++p) EXPECT_NEAR(a[p], b[p], 1e-12 * whole) << what << p;
}

void expect_sound(const Reservoir& tuft) {
    for (std::size_t i = 0; i < tuft.content.size(); ++i) {
        for (const double v : tuft.content[i]) EXPECT_GE(v, 0) << i;
        EXPECT_LE(tuft.saturation(i), 1 + 1e-12) << i;
    }
}

/// Touches some cells near the tip, unevenly.
ContactCells some_touch(const Reservoir& tuft, std::uint64_t seed) {
    ContactCells touch(tuft.content.size(), 0);
    for (std::size_t i = 0; i < touch.size(); ++i)
        if (i % kCells >= 2 && uniform(seed, i) < 0.3) touch[i] = static_cast<float>(uniform(seed + 1, i));
    const float sum = std::accumulate(touch.begin(), touch.end(), 0.0f);
    for (float& t : touch) t /= sum;
    return touch;
}

TEST(Reservoir, DippingFillsUpAndMixes) {
    Canvas canvas(1);
    const Mix black = mix_of(canvas, plain("black")), thin = mix_of(canvas, plain("white", 0.5));
    Reservoir tuft = make_reservoir(0.6);
    EXPECT_NEAR(tuft.capacity, 0.06, 1e-15) << "1 mL is 0.1 film·m²";
    EXPECT_NEAR(dip(tuft, black), 0.06, 1e-15);
    take(tuft, 0.03);
    EXPECT_NEAR(tuft.fullness(), 0.5, 1e-15);
    EXPECT_NEAR(dip(tuft, thin), 0.03, 1e-15);
    EXPECT_NEAR(tuft.mix()[0], 0.5, 1e-7);
    EXPECT_NEAR(tuft.mix()[1], 0.25, 1e-7);
    EXPECT_NEAR(tuft.water(), 0.015, 1e-15);
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
            const DepositParams p =
                stamp_deposit(tuft, ink, {.moment_factor = 0.5, .width = width, .area = width * width}, substrate);
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
        const Texels coverage = random_texels(i, 0, 1);
        double given = 0;
        for (std::uint32_t slot = 0; slot < 4; ++slot)
            given += deposit(canvas, {(i / 25 + slot) % kSlots, coverage, area}, params, deposit_law(params, 1e-4));
        take(tuft, given);
    }
    double on_texels = 0;
    for (std::uint32_t slot = 0; slot < kSlots; ++slot)
        for (int t = 0; t < kN && canvas.touched(slot); ++t)
            on_texels += static_cast<double>(area[t]) * static_cast<double>((*canvas.plane(slot, 0))[t]);
    EXPECT_GT(on_texels, 0.9 * start) << "the test wants a brush that runs dry";
    EXPECT_GE(tuft.remaining(), 0);
    EXPECT_NEAR(on_texels + tuft.remaining(), start, 1e-6 * start);
}

TEST(Reservoir, CellCapacitiesAddUpToTheCapacityAndABadLayoutIsRefused) {
    const Reservoir tuft = make_reservoir(0.5, layout_of(40));
    EXPECT_NEAR(std::accumulate(tuft.cell_capacity.begin(), tuft.cell_capacity.end(), 0.0), tuft.capacity,
                1e-12 * tuft.capacity);
    ReservoirLayout bad = layout_of(4);
    bad.cell_capacities[0] = 0.4;
    EXPECT_THROW(make_reservoir(0.5, bad), Error);
    bad = layout_of(4);
    std::swap(bad.cell_ends[0], bad.cell_ends[1]);
    EXPECT_THROW(make_reservoir(0.5, bad), Error);
    EXPECT_THROW(make_reservoir(0.5, layout_of(0)), Error);
    Reservoir none = make_reservoir(0, layout_of(8));  // holds nothing and does nothing
    EXPECT_EQ(dip(none, kBlack), 0);
    flow(none, 1);
    EXPECT_EQ(none.fullness(), 0);
}

TEST(Reservoir, FlowKeepsEveryPigmentAndTheWater) {
    Reservoir tuft = uneven();
    const Content before = planes_of(tuft);
    for (int i = 0; i < 300; ++i) flow(tuft, 0.001 + 0.02 * uniform(9, i));
    expect_same(planes_of(tuft), before, tuft.capacity, "plane ");
    expect_sound(tuft);
}

TEST(Reservoir, InkMovesFromTheWetRootToTheDryTipAndSettlesEven) {
    Reservoir tuft = make_reservoir(0.5, layout_of(12));
    dip(tuft, kBlack);
    wipe(tuft, 1, {.depth = 0.1});  // the last cell of four
    const std::size_t tip = kCells - 1;
    ASSERT_EQ(tuft.saturation(tip), 0);
    const double even = tuft.fullness();
    double before = 0;
    for (int i = 0; i < 100; ++i) {
        flow(tuft, 0.02);
        EXPECT_GE(tuft.saturation(tip), before - 1e-15) << "rises steadily";
        before = tuft.saturation(tip);
    }
    // One cell alone with τ = 0.3 s: 1 − e^{−t/τ} of the change, less what the cell above lacks by then.
    Reservoir short_time = make_reservoir(0.5, layout_of(12));
    dip(short_time, kBlack);
    wipe(short_time, 1, {.depth = 0.1});
    flow(short_time, 0.03);
    EXPECT_NEAR(short_time.saturation(tip), 1 - std::exp(-0.1), 0.01) << "first order in the step";
    flow(tuft, 100);
    for (std::size_t i = 0; i < tuft.content.size(); ++i) EXPECT_NEAR(tuft.saturation(i), even, 1e-6) << i;
}

TEST(Reservoir, FlowDoesNotDependOnHowTimeIsDivided) {
    Reservoir once = uneven(), often = uneven();
    flow(once, 0.5);
    for (int i = 0; i < 400; ++i) flow(often, 0.00125);
    for (std::size_t i = 0; i < once.content.size(); ++i)
        for (int p = 0; p < Reservoir::kPlanes; ++p) EXPECT_EQ(once.content[i][p], often.content[i][p]) << i;
}

TEST(Reservoir, FlowToNowGoesOnByEvenParts) {
    const Reservoir start = uneven();
    Reservoir whole = start, parts = start;
    flow(whole, 0.005);
    double most = 0;  // change of a cell's saturation in a whole step
    for (std::size_t i = 0; i < start.content.size(); ++i)
        most = std::max(most, std::abs(whole.saturation(i) - start.saturation(i)));
    ASSERT_GT(most, 0.01);
    for (int k = 0; k < 10; ++k) {
        const Reservoir before = parts;
        flow(parts, 0.0005, FlowTo::now);
        EXPECT_EQ(parts.unspent, 0);
        for (std::size_t i = 0; i < start.content.size(); ++i)
            EXPECT_LE(std::abs(parts.saturation(i) - before.saturation(i)), 0.1 * most * (1 + 1e-9))
                << "differences only shrink";
    }
    // Euler: the error of a step is half its square, for cells that fill within some 40 ms.
    for (std::size_t i = 0; i < start.content.size(); ++i)
        EXPECT_NEAR(parts.saturation(i), whole.saturation(i), 0.15 * most) << i;
    expect_same(planes_of(parts), planes_of(start), start.capacity, "plane ");
}

TEST(Reservoir, HalfTheStepMakesHalfTheError) {
    // Against the closed form of two cells: the difference falls by e^{−t (g/r1 + g/r2)}.
    ReservoirLayout l{.bundles = {Vec2{0}},
                      .cell_ends = {0.5, 1},
                      .cell_capacities = {0.8, 0.2},
                      .refill_time = 0.3,
                      .mix_time = 1e9};
    Reservoir tuft = make_reservoir(0.5, l);
    dip(tuft, kBlack, {.depth = 0.5});
    flow(tuft, 0.3);
    const double difference = tuft.saturation(1) - tuft.saturation(0);
    EXPECT_NEAR(difference, std::exp(-0.3 / 0.3 * (1 + 0.2 / 0.8)), 0.02) << "Euler, 30 steps: 2 %";
}

TEST(Reservoir, TouchingCellsGiveTheirOwnMixtureAndNothingIsLost) {
    Reservoir tuft = uneven();
    double whole = tuft.remaining();
    Content all_taken{};
    const Content before = planes_of(tuft);
    for (int i = 0; i < 400; ++i) {
        const ContactCells touch = some_touch(tuft, i);
        const double want = 2e-4 * uniform(77, i);
        const double left = tuft.remaining();
        const Content taken = take(tuft, want, touch);
        double sum = 0;
        for (int p = 0; p < Reservoir::kPlanes; ++p) {
            all_taken[p] += taken[p];
            sum += taken[p];
        }
        EXPECT_NEAR(sum, std::min(want, left), 1e-14);
    }
    Content together = planes_of(tuft);
    for (int p = 0; p < Reservoir::kPlanes; ++p) together[p] += all_taken[p];
    expect_same(together, before, whole, "plane ");
    expect_sound(tuft);
    take(tuft, 2 * whole, some_touch(tuft, 1));
    EXPECT_NEAR(tuft.remaining(), 0, 1e-15);
}

TEST(Reservoir, AbsorptionFromTheSurfaceKeepsTheSumAndFillsTheTouchingCellsFirst) {
    Reservoir tuft = uneven();
    const ContactCells touch = some_touch(tuft, 5);
    const Content before = planes_of(tuft);
    const double free = free_capacity(tuft, touch);
    Content lifted{};
    lifted[2] = 0.3 * free;
    lifted[kMaxPigments] = 0.2 * free;
    absorb(tuft, lifted, touch);
    expect_sound(tuft);
    EXPECT_GT(mix_at(tuft, touch)[2], tuft.mix()[2]) << "the hair that touched holds it";
    lifted[2] = 2 * tuft.capacity;  // more than there is room for
    absorb(tuft, lifted, touch);
    Content expected = before;
    expected[2] += 0.3 * free + 2 * tuft.capacity;
    expected[kMaxPigments] += 2 * 0.2 * free;
    expect_same(planes_of(tuft), expected, 3 * tuft.capacity, "plane ");
}

TEST(Reservoir, AShallowDipLoadsAGradientThatSpreadsSlowly) {
    Reservoir tuft = make_reservoir(0.5, layout_of(16));
    dip(tuft, kThin, {.level = 0.7});
    EXPECT_NEAR(tuft.fullness(), 0.7, 1e-12);
    const double taken = dip(tuft, kBlack, {.depth = 0.2});
    // The last cell and a half: of free capacities 0.05 and 0.15 · ½ the missing 0.3.
    EXPECT_NEAR(taken / tuft.capacity, 0.3 * (0.05 + 0.5 * 0.15), 1e-12);
    ContactCells tip(tuft.content.size(), 0), root(tuft.content.size(), 0);
    for (std::size_t i = 0; i < tip.size(); ++i)
        (i % kCells == kCells - 1 ? tip : root)[i] = i % kCells == 3 || i % kCells == 0 ? 1.0f / 16 : 0;
    EXPECT_NEAR(mix_at(tuft, tip)[0], 0.3, 1e-6) << "0.3 of black on 0.7 of thin";
    EXPECT_EQ(mix_at(tuft, root)[0], 0);
    flow(tuft, 2);
    EXPECT_GT(mix_at(tuft, tip)[0], 0.1) << "still there after two seconds";
    EXPECT_GT(mix_at(tuft, tip)[0], 5 * mix_at(tuft, root)[0]);
}

TEST(Reservoir, WhatItsHairDoesNotHoldRunsOffADrippingTuft) {
    Canvas canvas(1);
    const Mix black = mix_of(canvas, plain("black"));
    const Drain drain{.length = 0.04, .radius = 4e-3, .slope = 0.5};
    Reservoir full = make_reservoir(0.5), wet = full;
    dip(full, black);
    EXPECT_EQ(drained_volume(full, drain, 1), 0);
    dip(wet, black, {.level = 1.1});
    EXPECT_NEAR(wet.remaining() / wet.capacity, 1.1, 1e-12);
    // 50 mm³ on 503 mm²: a film of 0.0995 mm, ρ g δ³ / 3 μ = 1610 mm²/s, halved, round 25.1 mm.
    const double at_once = drained_volume(wet, drain, 1e-6) / 1e-6 * kFilmUnit;
    EXPECT_NEAR(at_once, 0.5 * 9810 * std::pow(0.05e-6 / 5.0265e-4, 3) / (3 * 2e-3) * 0.0251327, 1e-3 * at_once);
    EXPECT_NEAR(at_once * 1e9, 20.2, 0.1) << "mm³ a second";
    // A second at once, and in steps that are taken from the tuft.
    const double all = drained_volume(wet, drain, 1);
    double sum = 0;
    for (int i = 0; i < 100; ++i) {
        const double part = drained_volume(wet, drain, 0.01);
        take(wet, part);
        sum += part;
    }
    EXPECT_NEAR(sum / all, 1, 1e-9);
    EXPECT_GT(wet.remaining(), wet.capacity);
}

TEST(Reservoir, WipingTakesTheInkOfTheTouchedCells) {
    Reservoir tuft = make_reservoir(0.5, layout_of(16));
    dip(tuft, kBlack);
    EXPECT_NEAR(wipe(tuft, 0.5) / tuft.capacity, 0.5, 1e-12);
    EXPECT_NEAR(tuft.fullness(), 0.5, 1e-12);
    EXPECT_NEAR(wipe(tuft, 1, {.depth = 0.3}) / tuft.capacity, 0.5 * 0.2, 1e-12);
    EXPECT_EQ(tuft.saturation(kCells - 1), 0);
    EXPECT_NEAR(tuft.saturation(0), 0.5, 1e-12);
}

}  // namespace
}  // namespace tuft::ink
