#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.h"
#include "sheet.h"

namespace tuft::stroke {
namespace {

const std::string kBrush = "wolf-small";
const char* const kInks[] = {"indigo", "gamboge", "cinnabar"};
constexpr int kPigments = 3;

/// A short stroke somewhere on 12 × 12 mm, in any direction.
PaintStroke dab(int i, const std::string& ink) {
    const auto u = [&](std::uint64_t what) { return uniform(hash_bits(11, what), static_cast<std::uint64_t>(i)); };
    const double turn = 2 * std::numbers::pi * u(0);
    PaintStroke s;
    s.trace.flat = false;
    s.brush = kBrush;
    s.ink = ink;
    s.settings.dip = DipMode::persistent;
    s.settings.film = i % 4 ? FilmModel::still : FilmModel::wet;
    s.settings.spacing = 6;
    const Vec3 motion{2e-3 * std::cos(turn), 2e-3 * std::sin(turn), 0};
    const Vec3 start{12e-3 * (u(1) - 0.5), 12e-3 * (u(2) - 0.5), brush::load_preset(kBrush).length};
    constexpr int kSamples = 8;
    for (int k = 0; k <= kSamples; ++k) {
        const double f = static_cast<double>(k) / kSamples;
        StrokeSample p;
        p.time = 0.06 * f;
        p.position = start + f * motion;
        p.position.z += 0.5e-3 - 3e-3 * std::sin(std::numbers::pi * f);
        s.trace.samples.push_back(p);
    }
    return s;
}

BrushAction brush_action(const BrushChange& what, const std::string& ink) {
    return {.what = what, .brush = kBrush, .ink = ink, .dip = DipMode::persistent};
}

TEST(Conservation, AThousandStrokesKeepEachPigment) {
    const Model model = sheet({}, 512);  // texels of 0.12 mm; a footprint covers hundreds
    Document painting(model, {.substrate = "bisque", .undo_bytes = 1});
    std::array<double, kPigments> supplied{};
    const auto in_hair = [&](int p) {
        const BrushInHand* held = painting.brushes().find(kBrush);
        return held ? held->reservoir.pigment(p) : 0;
    };
    // What a dip brings and a rag takes is counted where it happens: in the hair.
    const auto tend = [&](const JournalEntry& entry) {
        std::array<double, kPigments> before;
        for (int p = 0; p < kPigments; ++p) before[p] = in_hair(p);
        painting.paint(entry);
        for (int p = 0; p < kPigments; ++p) supplied[p] += in_hair(p) - before[p];
    };
    std::string ink = kInks[0];
    std::size_t touched = 0;
    for (int i = 0; i < 1000; ++i) {
        if (i % 20 == 0) {
            ink = kInks[i / 20 % kPigments];
            tend(brush_action(Wipe{.depth = 0.6, .amount = 0.5}, ink));
            tend(brush_action(Dip{.depth = 0.5, .side = i % 40 ? 0.5 : 0.0}, ink));
        }
        if (i % 100 == 99) painting.paint(Dry{i == 999 ? 0 : 0.3});
        touched += painting.paint(dab(i, ink)).touched();
    }
    EXPECT_EQ(touched, 1000u);
    for (int p = 0; p < kPigments; ++p) {
        const double on_sheet = painting.layers().canvas().total(model.texels, p);
        EXPECT_GT(on_sheet, 0.01 * supplied[p]) << "a part of it worth the name";
        EXPECT_NEAR((on_sheet + in_hair(p)) / supplied[p], 1, 1e-5) << kInks[p];
    }
}

/// A flat that is dipped whole in one ink, wiped, and dipped with one corner in another lays both down at once; of
/// each, what is on the sheet and in the hair is what the dips brought.
TEST(Conservation, ADoubleLoadedFlatKeepsBothInks) {
    const std::string flat = "flat-12";
    const Model model = sheet();
    Document painting(model, {.substrate = "porcelain", .undo_bytes = 1});
    const auto in_hair = [&](int p) { return painting.brushes().find(flat)->reservoir.pigment(p); };
    const auto act = [&](const BrushChange& what, const char* ink) {
        painting.paint(BrushAction{.what = what, .brush = flat, .ink = ink, .dip = DipMode::persistent});
    };
    act(Dip{}, kInks[0]);
    act(Wipe{.amount = 0.4}, kInks[0]);
    act(Dip{.side = 0.5}, kInks[1]);
    const std::array supplied{in_hair(0), in_hair(1)};
    ASSERT_GT(supplied[0], 0);
    ASSERT_GT(supplied[1], 0);
    PaintStroke s;
    s.trace.flat = false;
    s.brush = flat;
    s.ink = kInks[0];
    s.settings.dip = DipMode::persistent;
    s.settings.film = FilmModel::still;
    const double length = brush::load_preset(flat).length;
    for (int k = 0; k <= 40; ++k) {
        StrokeSample p;
        p.time = 0.01 * k;
        p.position = {0, 6e-3 - 3e-4 * k, length + 0.5e-3 - 5e-3 * std::sin(std::numbers::pi * k / 40)};
        s.trace.samples.push_back(p);
    }
    EXPECT_TRUE(painting.paint(s).touched());
    for (int p = 0; p < 2; ++p) {
        const double on_sheet = painting.layers().canvas().total(model.texels, p);
        // Texels are of single precision: 6e-8 of each, thousands of them alike in sign at most.
        EXPECT_NEAR((on_sheet + in_hair(p)) / supplied[p], 1, 1e-6) << kInks[p];
        EXPECT_GT(on_sheet, 0) << kInks[p];
    }
}

}  // namespace
}  // namespace tuft::stroke
