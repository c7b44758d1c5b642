#include <algorithm>

#include "atlas/log_map.h"
#include "footprint/stamp.h"

// The loops below are compiled once for each instruction set from the same source. They
// hold neither reductions nor calls, and contraction is off, so all give the same bits.

#if defined(__x86_64__) || defined(__i386__)
#define TUFT_X86 1
#ifdef __clang__
#define TUFT_AVX512 "avx512f,avx512vl,avx512bw,avx512dq"
#else
#define TUFT_AVX512 "avx512f,avx512vl,avx512bw,avx512dq,prefer-vector-width=512"
#endif
#endif

namespace tuft::footprint {
namespace {

using atlas::kTile;
using atlas::kTileTexels;
using atlas::TexelShape;
using atlas::TexelTile;

/// Neighbouring words of the picture, read at once from where they lie.
using TwoPairs [[gnu::may_alias, gnu::aligned(2)]] = std::uint32_t;

constexpr float kOutside = -1e9f;  // cells; in no picture

/// The part of a tile that one piece covers.
struct Rows {
    int begin, end;  ///< texels
};

/// Texel → picture, in cells, for the texels that are `mine`; see `atlas::log_map` for the formula.
/// The others stay as they are, or lie outside when this is the `only` frame.
template <bool plane, bool only>
[[gnu::always_inline]] inline void map_texels(const TexelShape& shape, const PieceFrame& f, Rows rows,
                                              const std::int32_t* __restrict mine,
                                              float* __restrict fu, float* __restrict fv) {
    const float ox = f.origin[0], oy = f.origin[1], oz = f.origin[2];
    const float nx = f.normal[0], ny = f.normal[1], nz = f.normal[2];
    const float ux = f.tu[0], uy = f.tu[1], uz = f.tu[2], u0 = f.u0;
    const float vx = f.tv[0], vy = f.tv[1], vz = f.tv[2], v0 = f.v0;
    constexpr auto& q = atlas::kLogMapSeries;
    constexpr float q0 = float(0.5 * q[0]), q1 = float(0.5 * q[1]), q2 = float(0.5 * q[2]);
    constexpr float q3 = float(0.5 * q[3]), q4 = float(0.5 * q[4]), q5 = float(0.5 * q[5]);
    constexpr float q6 = float(0.5 * q[6]), q7 = float(0.5 * q[7]);
    constexpr float least_cos = float(atlas::kLogMapMinCos);
    const float *px = shape.px.data(), *py = shape.py.data(), *pz = shape.pz.data();
    const float *mx = shape.nx.data(), *my = shape.ny.data(), *mz = shape.nz.data();
#pragma omp simd
    for (int t = rows.begin; t < rows.end; ++t) {
        const float dx = px[t] - ox, dy = py[t] - oy, dz = pz[t] - oz;
        const float c = mx[t] * nx + my[t] * ny + mz[t] * nz;
        const float nd = nx * dx + ny * dy + nz * dz;
        const float inside = c > least_cos ? c : 0.0f;
        float h;
        if constexpr (plane) {
            const float slope = inside > 0.05f ? inside : 0.05f;
            h = -nd / slope;
        } else {
            const float md = mx[t] * dx + my[t] * dy + mz[t] * dz;
            const float x = 1 - inside;
            const float half_series =
                ((((((q7 * x + q6) * x + q5) * x + q4) * x + q3) * x + q2) * x + q1) * x + q0;
            h = half_series * (md - nd) - (md + nd) / (2 + 2 * inside);
        }
        const float u =
            u0 + (dx * ux + dy * uy + dz * uz) + h * (mx[t] * ux + my[t] * uy + mz[t] * uz);
        const float v =
            v0 + (dx * vx + dy * vy + dz * vz) + h * (mx[t] * vx + my[t] * vy + mz[t] * vz);
        const bool seen = (mine[t] != 0) & (c > least_cos);
        if constexpr (only) {
            fu[t] = seen ? u : kOutside;
            fv[t] = seen ? v : kOutside;
        } else {
            fu[t] = seen ? u : fu[t];
            fv[t] = seen ? v : fv[t];
        }
    }
}

template <bool only>
[[gnu::always_inline]] inline void map_texels(const TexelShape& shape, const PieceFrame& f, Rows rows,
                                              bool plane, const std::int32_t* __restrict mine,
                                              float* __restrict fu, float* __restrict fv) {
    if (plane) map_texels<true, only>(shape, f, rows, mine, fu, fv);
    else map_texels<false, only>(shape, f, rows, mine, fu, fv);
}

/// Adds one to `mine` at the texels of a piece.
[[gnu::always_inline]] inline void mark(const TexelTile& tile, int piece, Rows rows,
                                        std::int32_t* __restrict mine) {
    const std::uint8_t* id = tile.piece.data();
#pragma omp simd
    for (int t = rows.begin; t < rows.end; ++t) mine[t] += id[t] == piece ? 1 : 0;
}

/// The rows that some pose of the picture may reach.
[[gnu::always_inline]] inline Rows rows_in_picture(const StampJobs& jobs, Rows rows,
                                                   const float* __restrict fu,
                                                   const float* __restrict fv) {
    const float lo_u = jobs.reach_lo[0], lo_v = jobs.reach_lo[1];
    const float hi_u = jobs.reach_hi[0], hi_v = jobs.reach_hi[1];
    Rows hit{rows.end, rows.begin};
    for (int row = rows.begin; row < rows.end; row += kTile) {
        int any = 0;
#pragma omp simd reduction(| : any)
        for (int t = row; t < row + kTile; ++t)
            any |= (fu[t] >= lo_u) & (fu[t] <= hi_u) & (fv[t] >= lo_v) & (fv[t] <= hi_v);
        if (any == 0) continue;
        hit.begin = std::min(hit.begin, row);
        hit.end = row + kTile;
    }
    return hit;
}

/// Adds the picture's value at each texel, 255 for full coverage.
[[gnu::always_inline]] inline void gather(const StampJobs& jobs, const SubPose& pose, Rows rows,
                                          const float* __restrict fu, const float* __restrict fv,
                                          float* __restrict sum) {
    const std::uint16_t* __restrict pairs = jobs.pairs.data();
    const int stride = jobs.width + 1;
    // The last coordinates inside: below the number of cells.
    const float last_x = static_cast<float>(jobs.width) * (1 - 1e-6f);
    const float last_y = static_cast<float>(jobs.height) * (1 - 1e-6f);
    const float xu = pose.xu, xv = pose.xv, yu = pose.yu, yv = pose.yv, du = pose.du, dv = pose.dv;
#pragma omp simd
    for (int t = rows.begin; t < rows.end; ++t) {
        const float x = xu * fu[t] + xv * fv[t] + du, y = yu * fu[t] + yv * fv[t] + dv;
        const float xp = x > 0.0f ? x : 0.0f, yp = y > 0.0f ? y : 0.0f;
        const float xi = xp < last_x ? xp : last_x, yi = yp < last_y ? yp : last_y;
        // A factor, not a selection: that would become a branch around the gather.
        const float inside = ((xi == x) & (yi == y)) ? 1.0f : 0.0f;
        const int i = static_cast<int>(xi), j = static_cast<int>(yi);
        const float fx = xi - static_cast<float>(i), fy = yi - static_cast<float>(j);
        const std::uint32_t q = *reinterpret_cast<const TwoPairs*>(pairs + (j * stride + i));
        const float q00 = static_cast<float>(static_cast<int>(q & 255));
        const float q01 = static_cast<float>(static_cast<int>((q >> 8) & 255));
        const float q10 = static_cast<float>(static_cast<int>((q >> 16) & 255));
        const float q11 = static_cast<float>(static_cast<int>(q >> 24));
        const float low = q00 + fx * (q10 - q00), high = q01 + fx * (q11 - q01);
        const float value = low + fy * (high - low);
        sum[t] += inside * value;
    }
}

[[gnu::always_inline]] inline bool evaluate(const TexelTile& tile, const TexelShape& shape,
                                            const StampJobs& jobs, const TileJob& job, float* __restrict exposure) {
    alignas(64) float fu[kTileTexels], fv[kTileTexels], sum[kTileTexels] = {};
    alignas(64) std::int32_t mine[kTileTexels] = {}, full[kTileTexels] = {};
    const bool plane = jobs.mapping == Mapping::plane;
    const auto rows_of = [](const PieceFrame& f) {
        return Rows{f.first_row * kTile, (f.last_row + 1) * kTile};
    };
    Rows all{kTileTexels, 0}, covered{kTileTexels, 0};
    for (std::uint32_t k = job.first; k < job.first + job.count; ++k) {
        const PieceFrame& own = jobs.frames[k];
        const Rows rows = rows_of(own);
        Rows& range = own.full ? covered : all;
        range = {std::min(range.begin, rows.begin), std::max(range.end, rows.end)};
        if (own.full || !jobs.piecewise) mark(tile, own.piece, rows, own.full ? full : mine);
    }
    if (all.begin < all.end) {
        if (jobs.piecewise) {
            for (int t = all.begin; t < all.end; ++t) fu[t] = fv[t] = kOutside;
            for (std::uint32_t k = job.first; k < job.first + job.count; ++k) {
                const PieceFrame& own = jobs.frames[k];
                if (own.full) continue;
                const Rows rows = rows_of(own);
                std::fill(mine + rows.begin, mine + rows.end, 0);
                mark(tile, own.piece, rows, mine);
                map_texels<false>(shape, own, rows, plane, mine, fu, fv);
            }
        } else {
            map_texels<true>(shape, jobs.stamp_frame, all, plane, mine, fu, fv);
        }
        const Rows hit = rows_in_picture(jobs, all, fu, fv);
        for (const SubPose& pose : jobs.sub_poses) gather(jobs, pose, hit, fu, fv, sum);
    }
    const float whole = 255.0f * static_cast<float>(jobs.sub_poses.size());
#pragma omp simd
    for (int t = covered.begin; t < covered.end; ++t) sum[t] += full[t] != 0 ? whole : 0.0f;
    const float scale = jobs.gain / (255.0f * static_cast<float>(jobs.sub_poses.size()));
    int any = 0;
#pragma omp simd reduction(| : any)
    for (int t = 0; t < kTileTexels; ++t) {
        const float e = sum[t] * scale;
        exposure[t] = e < 1.0f ? e : 1.0f;
        any |= e > 0.0f ? 1 : 0;
    }
    return any != 0;
}

using Evaluate = bool (*)(const TexelTile&, const TexelShape&, const StampJobs&, const TileJob&,
                          float* __restrict);

bool evaluate_baseline(const TexelTile& tile, const TexelShape& shape, const StampJobs& jobs,
                       const TileJob& job, float* __restrict sum) {
    return evaluate(tile, shape, jobs, job, sum);
}

#ifdef TUFT_X86
[[gnu::target("avx2,tune=haswell")]] bool evaluate_avx2(const TexelTile& tile,
                                                        const TexelShape& shape,
                                                        const StampJobs& jobs, const TileJob& job,
                                                        float* __restrict sum) {
    return evaluate(tile, shape, jobs, job, sum);
}

[[gnu::target(TUFT_AVX512)]] bool evaluate_avx512(const TexelTile& tile, const TexelShape& shape,
                                                  const StampJobs& jobs, const TileJob& job,
                                                  float* __restrict sum) {
    return evaluate(tile, shape, jobs, job, sum);
}
#endif

Evaluate kernel(Isa isa) {
#ifdef TUFT_X86
    if (isa == Isa::avx512) return evaluate_avx512;
    if (isa == Isa::avx2) return evaluate_avx2;
#endif
    (void)isa;
    return evaluate_baseline;
}

}  // namespace

Isa best_isa() {
#ifdef TUFT_X86
    static const Isa best = [] {
        __builtin_cpu_init();
        if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
            __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq"))
            return Isa::avx512;
        return __builtin_cpu_supports("avx2") ? Isa::avx2 : Isa::baseline;
    }();
    return best;
#else
    return Isa::baseline;
#endif
}

bool evaluate_tile(const atlas::TexelMap& texels, const StampJobs& jobs, const TileJob& job,
                   Unpacked& unpacked, std::span<float, kTileTexels> exposure) {
    if (jobs.pairs.empty() || jobs.sub_poses.empty()) {
        std::fill(exposure.begin(), exposure.end(), 0.0f);
        return false;
    }
    const TexelShape* shape = texels.packed.empty() ? &texels.shapes[job.slot] : &unpacked.shape;
    const auto frames = std::span(jobs.frames).subspan(job.first, job.count);
    const bool known = std::all_of(frames.begin(), frames.end(), [](const PieceFrame& f) { return f.full; });
    if (!texels.packed.empty() && !known && unpacked.slot != job.slot) {
        atlas::shape_of(texels, job.slot, unpacked.shape);
        unpacked.slot = job.slot;
    }
    return kernel(std::min(jobs.isa, best_isa()))(texels.tiles[job.slot], *shape, jobs, job,
                                                  exposure.data());
}

}  // namespace tuft::footprint
