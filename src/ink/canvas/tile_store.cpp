#include "ink/canvas/tile_store.h"

#include "core/simd.h"

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

TUFT_CLONES void add_plane(float* __restrict sum, const float* __restrict w) {
    for (int t = 0; t < atlas::kTileTexels; ++t) sum[t] += w[t];
}

TUFT_CLONES void add_scaled_plane(float* __restrict sum, const float* __restrict w, float factor) {
    for (int t = 0; t < atlas::kTileTexels; ++t) sum[t] += factor * w[t];
}

}  // namespace tuft::ink
