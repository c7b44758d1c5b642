#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "ink/exchange/deposit_mixed.h"
#include "texels.h"

namespace tuft::ink {
namespace {

constexpr int kWater = kMaxPigments;

/// A tile that covers all of a patch.
TexelPlaces whole_patch() {
    TexelPlaces p;
    for (int t = 0; t < kN; ++t) {
        p.along[t] = static_cast<float>(t / atlas::kTile) * (kAlong - 1) / 15;
        p.across[t] = static_cast<float>(t % atlas::kTile) * (kAcross - 1) / 15;
    }
    return p;
}

HatBasis hats_over(const Texels& coverage) {
    HatBasis hats;
    hat_basis(hats, whole_patch(), coverage);
    return hats;
}

/// Two inks side by side, the second half water, with places of the hair as far as they are.
Reservoir two_inks(double millilitres = 0.5) {
    ReservoirLayout l{.bundles = {}, .cell_ends = {0.5, 1}, .cell_capacities = {0.5, 0.5}};
    for (int k = 0; k < 16; ++k) l.bundles.push_back({(k + 0.5) / 8 - 1, 0});
    Reservoir tuft = make_reservoir(millilitres, l);
    dip(tuft, Mix{1}, {.side = -0.5});
    dip(tuft, Mix{0, 0.5f});
    return tuft;
}

/// Its hair lies straight on a patch of 10 × 8 mm, tip ahead.
std::vector<HairSample> straight_hair(const Reservoir& tuft) {
    std::vector<HairSample> samples;
    for (std::uint32_t k = 0; k < tuft.n_bundles(); ++k)
        for (int i = 0; i <= 10; ++i) samples.push_back({k, {i * 1e-3, 4e-3 * tuft.layout.bundles[k].x}, 0.1 * i, 0.1});
    return samples;
}

ContactGrid patch() {
    const std::array<Vec2, 2> corners{Vec2{0, -4e-3}, Vec2{10e-3, 4e-3}};
    return make_contact_grid(corners, {1, 0});
}

TEST(ContactGrid, SpansThePatchAlongTheHair) {
    const std::array<Vec2, 3> places{Vec2{1, 1}, Vec2{1, 5}, Vec2{-1, 2}};
    const ContactGrid grid = make_contact_grid(places, {0, 1});  // tip towards +v: across runs to −u
    EXPECT_NEAR(grid.at({0, 1}).x, 0, 1e-12);
    EXPECT_NEAR(grid.at({0, 5}).x, kAlong - 1, 1e-12);
    EXPECT_NEAR(grid.at({1, 0}).y, 0, 1e-12);
    EXPECT_NEAR(grid.at({-1, 0}).y, kAcross - 1, 1e-12);
    // Texels get the same coordinates as places of the stamp's plane.
    const Frame frame = make_frame({0.1, 0.2, 0.3}, {0, 0, 1}, {0.6, 0.8, 0});
    atlas::TexelShape shape;
    for (int t = 0; t < kN; ++t) {
        const Vec3f p(frame.to_world({2 * uniform(1, t) - 1, 1 + 4 * uniform(2, t), 0}));
        shape.px[t] = p.x, shape.py[t] = p.y, shape.pz[t] = p.z;
    }
    TexelPlaces out;
    place_texels(out, grid, frame, shape);
    for (int t = 0; t < kN; ++t) {
        const Vec2 expected = grid.at({2 * uniform(1, t) - 1, 1 + 4 * uniform(2, t)});
        EXPECT_NEAR(static_cast<double>(out.along[t]), expected.x, 1e-5) << "float points";
        EXPECT_NEAR(static_cast<double>(out.across[t]), expected.y, 1e-5);
    }
}

TEST(ContactGrid, HatsSumToOneOnCoveredTexelsAndInterpolateLinearly) {
    Texels coverage = random_texels(5, -1, 1);
    for (float& f : coverage) f = std::max(f, 0.0f);
    const HatBasis hats = hats_over(coverage);
    std::array<float, kNodes> ones, slope;
    ones.fill(1);
    for (int n = 0; n < kNodes; ++n) slope[n] = static_cast<float>(2 * (n / kAcross) - 3 * (n % kAcross));
    Texels sum, plane;
    interpolate(sum, hats, ones);
    interpolate(plane, hats, slope);
    const TexelPlaces at = whole_patch();
    for (int t = 0; t < kN; ++t) {
        if (coverage[t] == 0) {
            EXPECT_EQ(sum[t], 0);
            continue;
        }
        EXPECT_NEAR(sum[t], 1, 1e-6);
        EXPECT_NEAR(plane[t], 2 * at.along[t] - 3 * at.across[t], 1e-5);
    }
}

TEST(ContactNodes, EachNodeHasTheHairOverIt) {
    const Reservoir tuft = two_inks();
    const NodeContact nodes = node_contact(tuft, patch(), straight_hair(tuft), {});
    const NodeMixes mixes = mixes_at(tuft, nodes);
    for (int n = 0; n < kNodes; ++n) {
        double parts = 0, mixture = 0;
        for (const auto& s : nodes.of(n)) parts += static_cast<double>(s.part);
        for (int p = 0; p < Reservoir::kPlanes; ++p) mixture += static_cast<double>(mixes[p][n]);
        EXPECT_NEAR(parts, 1, 1e-5) << n;
        EXPECT_NEAR(mixture, 1, 1e-6) << n;
        if (n % kAcross < 3) {
            EXPECT_NEAR(mixes[0][n], 1, 1e-6) << n;
        }
        if (n % kAcross > 4) {
            EXPECT_NEAR(mixes[1][n], 0.5, 1e-6) << n;
            EXPECT_NEAR(mixes[kWater][n], 0.5, 1e-6) << n;
        }
    }
    EXPECT_TRUE(is_mixed(tuft));
    Reservoir one = make_reservoir(0.5, tuft.layout);
    dip(one, Mix{0.3f, 0.1f});
    wipe(one, 0.37, {.depth = 0.4});
    EXPECT_FALSE(is_mixed(one)) << "the same mixture, however much of it";
}

// Hair that touches along one edge of the patch, and at one corner beyond it: ink under a row comes from the hair
// before or behind it, whatever is nearer beside it.
TEST(ContactNodes, WithoutHairARowTakesThatOfItsColumn) {
    const Reservoir tuft = two_inks();
    const ContactGrid grid{.step = {1e-3, 1e-3}};
    const auto at = [](int i, int j) { return Vec2{1e-3 * i, 1e-3 * j}; };
    std::vector<HairSample> samples;
    for (int j = 0; j < kAcross; ++j) samples.push_back({0, at(kAlong - 1, j), 1, 1});
    samples.push_back({1, at(0, kAcross - 1), 1, 1});
    const auto bundle_at = [&](NodesWithoutHair rule, int node) {
        const NodeContact nodes = node_contact(tuft, grid, samples, {}, rule);
        EXPECT_EQ(nodes.of(node).size(), 1u);
        return nodes.of(node)[0].cell / tuft.n_cells();
    };
    for (int i = 0; i + 1 < kAlong; ++i) {
        for (int j = 0; j + 1 < kAcross; ++j)
            EXPECT_EQ(bundle_at(NodesWithoutHair::column, i * kAcross + j), 0u) << i << ' ' << j;
        EXPECT_EQ(bundle_at(NodesWithoutHair::column, i * kAcross + kAcross - 1), i < 2 ? 1u : 0u) << i;
    }
    EXPECT_EQ(bundle_at(NodesWithoutHair::nearest, kAcross - 2), 1u);
}

TEST(ContactNodes, WhatTheNodesGiveAndTakeIsConserved) {
    Reservoir tuft = two_inks();
    const NodeContact nodes = node_contact(tuft, patch(), straight_hair(tuft), {});
    const double whole = tuft.remaining();
    std::array<double, Reservoir::kPlanes> before;
    for (int p = 0; p < Reservoir::kPlanes; ++p) before[p] = tuft.pigment(p);
    std::array<double, kNodes> amounts;
    for (int n = 0; n < kNodes; ++n) amounts[n] = 0.02 * whole * uniform(8, n);
    const NodeContents drawn = draw(tuft, amounts, nodes, {});
    for (int n = 0; n < kNodes; ++n) {
        double sum = 0;
        for (const double v : drawn[n]) sum += v;
        EXPECT_NEAR(sum, amounts[n], 1e-6 * whole) << "float parts";
    }
    EXPECT_EQ(drawn[0][1], 0) << "of the left flank";
    absorb(tuft, drawn, nodes, {});
    for (int p = 0; p < Reservoir::kPlanes; ++p) EXPECT_NEAR(tuft.pigment(p), before[p], 1e-12 * whole) << p;
    // More of a pigment at one node than the hair over it has comes from other hair.
    NodeContents given{};
    given[0][0] = 0.9 * before[0];
    given[kNodes - 1][1] = 0.1 * before[1];
    withdraw_contents(tuft, given, nodes);
    EXPECT_NEAR(tuft.pigment(0), 0.1 * before[0], 1e-12 * whole);
    EXPECT_NEAR(tuft.pigment(1), 0.9 * before[1], 1e-12 * whole);
    for (const auto& cell : tuft.content)
        for (const double v : cell) EXPECT_GE(v, 0);
}

TEST(DepositMixed, DepositsEachInkUnderItsHairAndReportsWhatIsStored) {
    Reservoir tuft = two_inks();
    const NodeContact nodes = node_contact(tuft, patch(), straight_hair(tuft), {});
    const NodeMixes mixes = mixes_at(tuft, nodes);
    Canvas canvas(1);
    for (const char* name : {"left", "right"}) {
        Pigment p;
        p.name = name;
        canvas.add_pigment(p);
    }
    const Texels coverage = random_texels(3, 0.3, 1), area = random_texels(4, 0.5e-8, 1.5e-8);
    const DepositParams params{.target = 1.6f};
    NodeContents given{};
    for (int i = 0; i < 5; ++i)
        deposit_mixed(canvas, {{0, coverage, area}, 0.1e-3}, hats_over(coverage), params, mixes, given);
    for (int p = 0; p < 2; ++p) {
        double stored = 0, booked = 0;
        for (int t = 0; t < kN; ++t)
            stored += static_cast<double>((*canvas.plane(0, p))[t]) * static_cast<double>(area[t]);
        for (const auto& node : given) booked += node[p];
        EXPECT_NEAR(booked / stored, 1, 1e-12);
    }
    for (int row = 0; row < atlas::kTile; ++row) {
        EXPECT_EQ((*canvas.plane(0, 1))[row * atlas::kTile], 0) << "left edge";
        EXPECT_EQ((*canvas.plane(0, 0))[row * atlas::kTile + 15], 0) << "right edge";
        for (int x = 1; x < atlas::kTile; ++x) {
            // From one ink to the other without a step: at most what a hat rises over a texel.
            const auto part = [&](int at) {
                const int t = row * atlas::kTile + at;
                return (*canvas.plane(0, 0))[t] / coverage[t];
            };
            EXPECT_LE(part(x), part(x - 1) + 1e-5f);
            EXPECT_LE(part(x - 1) - part(x), 1.6f * (kAcross - 1) / 15 + 1e-5f);
        }
    }
    EXPECT_GT(given[kAcross - 1][kWater], 0) << "the right ink brings water";
    EXPECT_NEAR(given[kAcross - 1][kWater] / given[kAcross - 1][1], 1, 1e-5) << "as much as pigment";
}

TEST(DepositMixed, EqualsDepositForOneInkAndDoesNotAccumulateForChangingInks) {
    Canvas one(1), mixed(1);
    Pigment pigment;
    pigment.name = "black";
    one.add_pigment(pigment);
    mixed.add_pigment(pigment);
    const Texels coverage = random_texels(3, 0, 1), area = constant(1e-8f);
    DepositParams params{.mix = Mix{0.6f}, .target = 1.6f, .extinction = 2};
    NodeMixes mixes{};
    mixes[0].fill(0.6f);
    mixes[kWater].fill(0.4f);
    NodeContents given{};
    for (int i = 0; i < 4; ++i) {
        deposit(one, {0, coverage, area}, params, deposit_law(params, 0.05e-3));
        deposit_mixed(mixed, {{0, coverage, area}, 0.05e-3}, hats_over(coverage), params, mixes, given);
    }
    for (int t = 0; t < kN; ++t) EXPECT_NEAR((*mixed.plane(0, 0))[t], (*one.plane(0, 0))[t], 2e-6) << t;

    // From one pigment to another in a hundred stamps: of both the whole film, no more.
    pigment.name = "red";
    mixed = Canvas(1);
    for (const char* name : {"black", "red"}) {
        pigment.name = name;
        mixed.add_pigment(pigment);
    }
    params = {.target = 1.5f};
    for (int i = 0; i <= 100; ++i) {
        mixes[0].fill(1 - static_cast<float>(i) / 100);
        mixes[1].fill(static_cast<float>(i) / 100);
        mixes[kWater].fill(0);
        deposit_mixed(mixed, {0, constant(1), area, 0.3e-3}, hats_over(constant(1)), params, mixes, given);
    }
    for (int p = 0; p < 2; ++p) {
        EXPECT_LE((*mixed.plane(0, p))[77], 1.5f * 1.001f);
        EXPECT_GE((*mixed.plane(0, p))[77], 1.5f * 0.97f) << "the last stamp goes exp(-3.75) short";
    }
    // And never above the capacity.
    params.target = 100;
    for (int i = 0; i < 50; ++i)
        deposit_mixed(mixed, {0, constant(1), area, 1e-3}, hats_over(constant(1)), params, mixes, given);
    for (int t = 0; t < kN; ++t)
        EXPECT_LE((*mixed.plane(0, 0))[t] + (*mixed.plane(0, 1))[t], params.capacity * 1.00001f);
}

}  // namespace
}  // namespace tuft::ink
