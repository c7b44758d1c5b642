#include "ink/exchange/transfer.h"

#include <gtest/gtest.h>

#include "core/random.h"
#include "ink/film/tile/paste.h"
#include "texels.h"

namespace tuft::ink {
namespace {

constexpr float kArea = 1e-8f;

/// A surface of one tile, a tuft with its surface liquid, and contact with all of the tile.
struct Touching {
    Canvas canvas{1};
    Reservoir tuft;
    SurfaceLiquid liquid;
    Mix purple{}, yellow{};
    DepositParams deposit;
    ContactCells touch;
    std::array<float, kN> coverage, area;
    TexelPlaces places;
    HatBasis hats;

    Touching() : tuft(make_reservoir(0.05)) {
        purple = mix_of(canvas, load_ink("indigo"));
        yellow = mix_of(canvas, load_ink("gamboge"));
        coverage.fill(1);
        area.fill(kArea);
        for (int t = 0; t < kN; ++t) {
            places.along[t] = static_cast<float>(t / atlas::kTile) * (kAlong - 1) / 15;
            places.across[t] = static_cast<float>(t % atlas::kTile) * (kAcross - 1) / 15;
        }
    }
    void wash(float film, const Mix& mix) {
        canvas.touch_liquid(0, Liquid::film).fill(film);
        for (int p = 0; p < kMaxPigments; ++p)
            if (mix[p] > 0) canvas.touch(0, p).fill(film * mix[p]);
    }
    NodeAreas areas() const {
        NodeAreas out{}, of_hats;
        integrate_hats(of_hats, hats, nullptr, area);
        for (int k = 0; k < hats.count; ++k) out[hats.node[k]] = of_hats[k];
        return out;
    }
    NodeContact nodes() const { return node_contact(tuft, {}, {}, touch); }
    void move(double ds, double dt) {
        hat_basis(hats, places, coverage);
        const ContactStep step{.ds = ds, .dt = dt, .stress = 1};
        refresh(liquid, tuft, touch, nodes(), areas(), step);
        const TransferParams p = transfer_params(liquid, tuft, touch, areas(), deposit, step);
        NodeContents given{};
        transfer(canvas, {{0, coverage, area, ds}, places, hats}, p, given);
        for (int node = 0; node < kNodes; ++node)
            for (int k = 0; k < Reservoir::kPlanes; ++k) liquid.content[node][k] -= given[node][k];
    }
    double in_hair(int plane) const {
        double sum = tuft.pigment(plane);
        for (const auto& node : liquid.content) sum += node[plane];
        return sum;
    }
    double on_surface(int plane) const {
        double sum = 0;
        const Plane* w = plane == kMaxPigments ? canvas.liquid(0, Liquid::film) : canvas.plane(0, plane);
        for (int t = 0; w && t < kN; ++t) sum += static_cast<double>((*w)[t]) * static_cast<double>(area[t]);
        if (plane == kMaxPigments)
            for (int p = 0; p < kMaxPigments; ++p) sum -= on_surface(p);
        return sum;
    }
    double all(int plane) const { return in_hair(plane) + on_surface(plane); }
};

TEST(Transfer, KeepsEachPigmentAndTheWater) {
    Touching t;
    dip(t.tuft, t.yellow, {.level = 0.6});
    t.wash(3, t.purple);
    for (int i = 0; i < kN; ++i) t.coverage[i] = static_cast<float>(uniform(7, i) < 0.2 ? 0 : uniform(8, i));
    std::array<double, Reservoir::kPlanes> before;
    for (int p = 0; p < Reservoir::kPlanes; ++p) before[p] = t.all(p);
    const double whole = t.all(0) + t.all(1);
    for (int i = 0; i < 1000; ++i) {
        t.move(0.1e-3, 2e-3);
        for (const auto& node : t.liquid.content)
            for (const double v : node) ASSERT_GE(v, -1e-9 * whole) << "the rounding of the texels";
    }
    for (int p = 0; p < Reservoir::kPlanes; ++p) EXPECT_NEAR(t.all(p), before[p], 1e-9 * whole) << p;
    withdraw(t.liquid, t.tuft, t.touch, t.nodes());
    for (int p = 0; p < Reservoir::kPlanes; ++p) EXPECT_NEAR(t.all(p), before[p], 1e-9 * whole) << p;
}

TEST(Transfer, DoesNotDependOnSampling) {
    std::vector<double> purple;
    for (const int parts : {1, 4, 16}) {
        Touching t;
        dip(t.tuft, t.yellow);
        t.wash(1.8f, t.purple);
        for (int i = 0; i < 10 * parts; ++i) t.move(0.4e-3 / parts, 8e-3 / parts);
        purple.push_back(t.on_surface(0));
    }
    // Exponential forms; what is left is that the liquid changes between touches.
    EXPECT_NEAR(purple[1] / purple[2], 1, 0.02);
    EXPECT_NEAR(purple[0] / purple[2], 1, 0.05);
}

TEST(Transfer, ACleanWetTuftLiftsAndADampOneDries) {
    Touching t;
    dip(t.tuft, Mix{});  // water
    t.wash(1.8f, t.purple);
    const double before = t.on_surface(0);
    for (int i = 0; i < 100; ++i) t.move(0.1e-3, 2e-3);
    EXPECT_LT(t.on_surface(0), 0.3 * before);
    EXPECT_NEAR((*t.canvas.liquid(0, Liquid::film))[0], 1.8, 0.05) << "as much water down as ink up";
    Touching damp;
    dip(damp.tuft, Mix{}, {.level = 0.1});
    damp.deposit.target = 0.2f;
    damp.wash(4, damp.purple);
    for (int i = 0; i < 200; ++i) damp.move(0.1e-3, 2e-3);
    EXPECT_LT((*damp.canvas.liquid(0, Liquid::film))[0], 1.5) << "hair that takes ink up";
}

/// Areas of the nodes under a patch whose width falls from 1 to `end` over its length.
NodeAreas tapered(double end) {
    NodeAreas areas{};
    constexpr int kParts = 3000;
    for (int k = 0; k < kParts; ++k) {
        const double at = (k + 0.5) / kParts * (kAlong - 1), width = 1 + (end - 1) * at / (kAlong - 1);
        for (int i = 0; i < kAlong; ++i) areas[i * kAcross] += std::max(0.0, 1 - std::abs(i - at)) * width / kParts;
    }
    return areas;
}

TEST(Transfer, TheTipOnlyGrazesWhatTheBellyRubs) {
    for (const double f : firmness(tapered(1))) EXPECT_NEAR(f, 1, 1e-6) << "of one width it lies evenly";
    for (const double f : firmness(NodeAreas{})) EXPECT_EQ(f, 1);
    // A leaf that runs out to a point, by its closed form: hats over 1 − x / 3, the outer halves doubled.
    const std::array<double, kAlong> leaf = firmness(tapered(0));
    const double first = 1 - 1.0 / 9, expected[] = {1, 2.0 / 3 / first, 1.0 / 3 / first, 1.0 / 9 / first};
    for (int i = 0; i < kAlong; ++i) EXPECT_NEAR(leaf[i], expected[i], 1e-5) << i;
    // So where all its length passes it rubs little more than half as much as a patch that is as long and wide all
    // over.
    const auto along = [](const std::array<double, kAlong>& f) { return (0.5 * f[0] + f[1] + f[2] + 0.5 * f[3]) / 3; };
    EXPECT_LT(along(leaf), 0.6);
    EXPECT_NEAR(along(firmness(tapered(1))), 1, 1e-6);
}

TEST(Transfer, BundlesRubInStreaksAndNoMoreInTheMean) {
    std::vector<BundleFirmness> bundles;
    for (int k = 0; k < 12; ++k) bundles.push_back({(k + 0.3 + 0.4 * uniform(3, k)) / 12, 0.3 + 0.7 * uniform(4, k)});
    const FurrowDepths rub = rub_of(bundles);
    double mean = 0, least = 9, most = 0;
    for (const float r : rub) {
        mean += static_cast<double>(r) / kFirmnessSamples;
        least = std::min(least, static_cast<double>(r));
        most = std::max(most, static_cast<double>(r));
    }
    EXPECT_NEAR(mean, 1, 1e-6);
    EXPECT_GE(least, 0.4 - 1e-6) << "liquid between the bundles is moved along, too";
    EXPECT_GT(most, 1.2);
    for (const float r : rub_of({})) EXPECT_EQ(r, 1);
}

TEST(Transfer, YellowThroughWetPurpleTakesPurpleAlong) {
    Touching t;
    dip(t.tuft, t.yellow);
    t.wash(1.8f, t.purple);
    for (int i = 0; i < 40; ++i) t.move(0.1e-3, 2e-3);
    const double taken = t.in_hair(0);
    EXPECT_GT(taken, 0);
    // On clean surface it comes off again, most at first.
    Canvas clean(1);
    for (const Pigment& p : t.canvas.pigments()) clean.add_pigment(p);
    t.canvas = clean;
    for (int i = 0; i < 20; ++i) t.move(0.1e-3, 2e-3);
    const double first = t.on_surface(0);
    EXPECT_GT(first, 0.01 * t.on_surface(1));
    for (int i = 0; i < 400; ++i) t.move(0.1e-3, 2e-3);
    t.canvas = clean;
    for (int i = 0; i < 20; ++i) t.move(0.1e-3, 2e-3);
    EXPECT_LT(t.on_surface(0), 0.5 * first);
}

TEST(Transfer, AFullTuftTakesNoMoreAndDryFilmsStay) {
    Touching t;
    dip(t.tuft, t.yellow);
    t.wash(5, t.purple);
    t.canvas.touch_film(0, kFirstDryFilm, 0).fill(1);
    for (int i = 0; i < 300; ++i) {
        t.move(0.1e-3, 2e-3);
        double held = t.tuft.remaining();
        for (int node = 0; node < kNodes; ++node) held += t.liquid.volume(node);
        ASSERT_LE(held, t.tuft.capacity * (1 + 1e-4)) << "the rounding of the texels";
    }
    EXPECT_EQ((*t.canvas.film_plane(0, kFirstDryFilm, 0))[100], 1);
}

TEST(Transfer, OnADrySurfaceItEqualsDeposit) {
    Touching t;
    dip(t.tuft, t.yellow);
    for (int i = 0; i < kN; ++i) t.coverage[i] = static_cast<float>(i) / (kN - 1);
    Canvas other(1);
    DepositParams p = t.deposit;
    p.mix = mix_of(other, load_ink("gamboge"));
    for (int i = 0; i < 40; ++i) {
        t.move(0.1e-3, 2e-3);
        deposit(other, 0, t.coverage, t.area, 0.1e-3, p);
    }
    const int yellow = 1;
    for (int i = 0; i < kN; ++i) EXPECT_NEAR((*t.canvas.plane(0, yellow))[i], (*other.plane(0, 0))[i], 2e-3) << i;
}

}  // namespace
}  // namespace tuft::ink
