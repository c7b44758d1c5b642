#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "core/system/parallel.h"
#include "sheet.h"
#include "stroke/document/document.h"

/// Strokes painted with the brush models of the papers.
namespace tuft::stroke {
namespace {

class SpineModels : public testing::TestWithParam<brush::SpineMethod> {};

/// Whether the paper of a model has a head of this form.
bool knows(brush::SpineMethod spine, const brush::Preset& p) {
    if (brush::is_foam(p) || p.geometry) return false;
    const bool flat = brush::has_broad_side(p) && p.splay == 0 && p.slant == 0;
    return p.spines == 1 || (flat && spine != brush::SpineMethod::macro);
}

TEST_P(SpineModels, PaintWithEveryBrushOfTheirFormsAndReplayToTheSameBits) {
    const Model model = sheet({}, 384);
    for (const std::string& name : brush::list_presets()) {
        const brush::Preset preset = brush::load_preset(name);
        PaintStroke stroke = line(name, 0.15 * preset.length, {}, 0.06, 100);
        stroke.settings.spine = GetParam();
        set_thread_count(1);
        Document painting(model);
        if (!knows(GetParam(), preset)) {
            EXPECT_THROW(painting.paint(stroke), Error) << name;
            EXPECT_TRUE(painting.journal().empty()) << name;
            continue;
        }
        if (preset.spines > 1 && name != "flat-12" && name != "filbert-12") continue;  // bent in tests/brush
        const StrokeReport report = painting.paint(stroke);
        EXPECT_TRUE(report.touched()) << name;
        EXPECT_GT(report.ink_given, 0) << name;
        // Ink that leaves the tuft is ink that came out of it: rounding of some thousand stamps.
        EXPECT_NEAR((report.ink_given + report.ink_left) / (preset.capacity * ink::kFilmPerVolume), 1, 1e-9) << name;
        set_thread_count(4);
        Document again(model);
        again.replay(painting.journal().entries());
        EXPECT_EQ(again.layers().canvas().hash(), painting.layers().canvas().hash()) << name;
        if (preset.spines > 1) continue;  // the rod's five spines take seconds
        Document other(model);
        stroke.settings.spine = brush::SpineMethod::rod;
        other.paint(stroke);
        EXPECT_NE(other.layers().canvas().hash(), painting.layers().canvas().hash()) << name << " was bent by the rod";
    }
    set_thread_count(0);
}

// A drawing, laid on the sheet and led by the tip lag of the model: the line lies where the path is.
TEST_P(SpineModels, DrawAFlatLineWhereItsPathIs) {
    const Model model = sheet({}, 384);
    PaintStroke stroke = line("wolf-small", 0);
    stroke.settings.spine = GetParam();
    stroke.trace.flat = true;
    for (std::size_t i = 0; i < stroke.trace.samples.size(); ++i) {
        StrokeSample& s = stroke.trace.samples[i];
        s = {.time = s.time, .position = {s.position.x, 0, 0}, .pressure = 0.3};
    }
    Document painting(model);
    painting.paint(stroke);
    double sum = 0, aside = 0;
    for (const std::uint32_t slot : painting.layers().canvas().touched_slots()) {
        const ink::Plane* plane = painting.layers().canvas().plane(slot, 0);
        for (int t = 0; plane && t < atlas::kTileTexels; ++t) {
            if (model.texels.tiles[slot].area[t] <= 0) continue;
            sum += (*plane)[t];
            aside += (*plane)[t] * model.texels.position(slot, t).y;
        }
    }
    ASSERT_GT(sum, 0);
    EXPECT_NEAR(aside / sum, 0, kSide / 384);  // a texel
}

INSTANTIATE_TEST_SUITE_P(OfThePapers, SpineModels,
                         testing::Values(brush::SpineMethod::macro, brush::SpineMethod::chain,
                                         brush::SpineMethod::truss),
                         [](const auto& at) {
                             return std::string(brush::kSpineWords[static_cast<std::size_t>(at.param)]);
                         });

}  // namespace
}  // namespace tuft::stroke
