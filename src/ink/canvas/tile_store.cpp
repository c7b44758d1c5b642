#include "ink/canvas/tile_store.h"

#include "ink/simd.h"

namespace tuft::ink {
namespace {

constexpr int kLanes = 16;
static_assert(atlas::kTile % kLanes == 0);

}  // namespace

TUFT_CLONES double store_change(float* __restrict w, const float* __restrict dw, float part,
                                const float* __restrict area, int n) {
    double sum[kLanes] = {};
    for (int t = 0; t < n; t += kLanes) {
        for (int lane = 0; lane < kLanes; ++lane) {
            const float before = w[t + lane];
            const float after = before + part * dw[t + lane];
            w[t + lane] = after;
            sum[lane] +=
                (static_cast<double>(after) - static_cast<double>(before)) * static_cast<double>(area[t + lane]);
        }
    }
    double total = 0;
    for (const double s : sum) total += s;
    return total;
}

}  // namespace tuft::ink
