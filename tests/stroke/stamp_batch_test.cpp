#include "stroke/deposit/stamp_batch.h"

#include <gtest/gtest.h>

#include "core/system/allocations.h"
#include "core/system/parallel.h"
#include "ink/exchange/deposit.h"
#include "sheet.h"

namespace tuft::stroke {
namespace {

// A disc of `texels` across, moved by three texels since the one before.
Stamp disc(const Model& model, const ink::DepositParams& ink, int texels, double x) {
    const double texel = model.texels.texel_size;
    const auto at = model.query->closest_point({x, 0, 0});
    Stamp stamp;
    footprint::Footprint& f = stamp.footprint;
    f.frame = make_frame(at->position, at->normal, {1, 0, 0});
    f.triangle = at->triangle;
    f.cell = texel;
    f.width = f.height = texels + 4;
    f.lo = Vec2(-0.5 * f.width * texel);
    f.radius = 0.5 * (texels + 1) * texel;
    for (int j = 0; j < f.height; ++j)
        for (int i = 0; i < f.width; ++i) {
            const double r = std::hypot(i + 0.5 - 0.5 * f.width, j + 0.5 - 0.5 * f.height);
            f.coverage.push_back(static_cast<std::uint8_t>(255 * std::clamp(0.5 + 0.5 * texels - r, 0.0, 1.0)));
        }
    stamp.motion.shift = {3 * texel, 0};
    stamp.ds = 3 * texel;
    stamp.ink = ink;
    return stamp;
}

TEST(StampBatch, PlansAndDepositsWithoutAllocationsOnceItIsWarm) {
    set_thread_count(1);
    const Model model = sheet();
    const ink::Substrate substrate = ink::load_substrate("porcelain");
    ink::Canvas canvas(model.texels.n_slots());
    const ink::Ink carbon = ink::load_ink("carbon");
    const ink::DepositParams params{.mix = ink::mix_of(canvas, carbon), .extinction = ink::extinction_of(carbon)};
    PlanScratchPool scratch;
    StampTarget target(model, canvas, substrate, {}, scratch);
    StampBatch batch(target, {});
    double first = 0;
    for (int repeat = 0; repeat < 4; ++repeat) {
        std::vector<Stamp> stamps;
        for (std::size_t k = 0; k < StampBatch::kStamps; ++k)
            stamps.push_back(disc(model, params, 40, 3 * model.texels.texel_size * static_cast<double>(k)));
        const std::uint64_t before = allocations_of_this_thread();
        for (Stamp& stamp : stamps) batch.add(std::move(stamp));
        const double given = batch.flush();
        if (repeat == 0) first = given;
        EXPECT_GT(given, 0);
        if (repeat > 0) {
            EXPECT_EQ(allocations_of_this_thread() - before, 0u) << repeat;
        }
    }
    EXPECT_GT(first, 0);
    set_thread_count(0);
}

// Of three runs over the same place the last finds tiles, buffers and blocks as the second left them. A pose in twenty
// may find a new tile beside the line, or let a list grow. Wet ink is not among them: its film spreads.
TEST(Stamps, AWarmStrokeMakesNoAllocationForAStamp) {
    set_thread_count(1);
    const Model model = sheet();
    struct Case {
        const char *brush, *ink;
    };
    for (const auto& [brush, ink] :
         {Case{"wolf-medium", "carbon"}, Case{"bright-12", "carbon"}, Case{"sword-8", "carbon"},
          Case{"leaf-28", "carbon"}, Case{"mixed-medium", "titanium-white-paste"},
          Case{"flat-12", "titanium-white-paste"}}) {
        PaintStroke stroke = line(brush, 0.2 * brush::load_preset(brush).length);
        stroke.ink = ink;
        const std::vector<StrokeSample> way = stroke.trace.samples;
        const double span = way.back().time + 0.01;
        for (int run = 1; run < 3; ++run)
            for (StrokeSample s : way) {
                s.time += run * span;
                stroke.trace.samples.push_back(s);
            }
        Document painting(model);
        std::vector<std::uint64_t> made;
        made.reserve(100000);
        std::uint64_t before = 0;
        painting.watch_poses([&](const StrokeSession&, double part) {
            const std::uint64_t now = allocations_of_this_thread();
            if (part > 0.7) made.push_back(now - before);
            before = now;
        });
        painting.paint(stroke);
        ASSERT_GT(made.size(), 50u) << brush << " " << ink;
        std::ranges::sort(made);
        EXPECT_EQ(made[made.size() * 19 / 20 - 1], 0u) << brush << " " << ink;
    }
    set_thread_count(0);
}

}  // namespace
}  // namespace tuft::stroke
