#include <algorithm>

#include "footprint/outline/isa.h"
#include "footprint/stamp/picture_map.h"

// The loops below are compiled once for each instruction set from the same source. They
// hold neither reductions nor calls, and contraction is off, so all give the same bits.

namespace tuft::footprint {
namespace {

using atlas::kTileTexels;

/// Four cells in a row of the picture, read at once from where they lie.
using FourCells [[gnu::may_alias, gnu::aligned(1)]] = std::uint32_t;

constexpr float kOutside = -1e9f;  // cells; in no picture

// A tile is worked on in units of eight texels side by side, a bit each: bit 2 row + half.
constexpr int kUnit = 8, kUnits = kTileTexels / kUnit;
using Units = std::uint32_t;

/// The units of a cluster's rows that lie in some quadrants of the tile.
[[gnu::always_inline]] inline Units units_of(const ClusterFrame& f, unsigned quadrants) {
    constexpr Units kLeft = 0x5555, kRight = 0xaaaa;
    const Units upper = ((quadrants & 1) ? kLeft : 0) | ((quadrants & 2) ? kRight : 0);
    const Units lower = ((quadrants & 4) ? kLeft : 0) | ((quadrants & 8) ? kRight : 0);
    const Units rows = (~Units{0} >> (kUnits - 2 * (f.last_row + 1))) & (~Units{0} << (2 * f.first_row));
    return (upper | lower << (kUnits / 2)) & rows;
}

/// The units of a cluster to be evaluated, and those known to be full. Next to a quadrant that is evaluated
/// in runs of both, a full one is evaluated as well.
template <int lanes>
[[gnu::always_inline]] inline Units part_units(const ClusterFrame& f) {
    const unsigned rows = lanes == 2 * kUnit ? ((f.partial_quadrants | f.partial_quadrants >> 1) & 5u) * 3u : 0u;
    return units_of(f, f.partial_quadrants | (f.full_quadrants & rows));
}

template <int lanes>
[[gnu::always_inline]] inline Units full_units(const ClusterFrame& f) {
    const unsigned rows = lanes == 2 * kUnit ? ((f.partial_quadrants | f.partial_quadrants >> 1) & 5u) * 3u : 0u;
    return units_of(f, f.full_quadrants & ~rows);
}

/// Where runs of `lanes` texels begin that hold given units.
struct Runs {
    std::uint16_t start[kUnits];
    int count;
};

/// One bit for each run.
template <int lanes>
[[gnu::always_inline]] inline Units join_runs(Units units) {
    return lanes == 2 * kUnit ? (units | units >> 1) & 0x55555555u : units;
}

[[gnu::always_inline]] inline Runs runs_of(Units units) {
    Runs runs;
    runs.count = 0;
    for (; units != 0; units &= units - 1)
        runs.start[runs.count++] = static_cast<std::uint16_t>(kUnit * __builtin_ctz(units));
    return runs;
}

/// Input of the kernel, as plain pointers: a standard function called there would not be
/// inlined into code for another instruction set.
struct Task {
    const StampJobs& jobs;
    const ClusterFrame* frames;
    const SubPose* poses;
    const std::uint8_t* cells;
    std::uint32_t n_frames, n_poses;
    const std::uint8_t* cluster;  ///< of the tile, as the rest
    const float *px, *py, *pz, *nx, *ny, *nz;
    Vec2f reach_lo, reach_hi;
};

/// Positions of a tile's texels in the picture, cells.
struct PicturePositions {
    alignas(64) float u[kTileTexels], v[kTileTexels];
};

/// Texel → picture for the texels that are `mine`, or all when `whole`; see `atlas::log_map` for the formula. The
/// others stay as they are, or lie outside when this is the `only` frame.
template <int lanes, bool plane, bool only, bool whole>
[[gnu::always_inline]] inline void map_texels(const Task& task, const ClusterFrame& f, const Runs& runs,
                                              const std::int32_t* __restrict mine, PicturePositions& out) {
    constexpr float least_cos = float(atlas::kLogMapMinCos);
    for (int run = 0; run < runs.count; ++run) {
        const int begin = runs.start[run];
        const float *px = task.px + begin, *py = task.py + begin, *pz = task.pz + begin;
        const float *mx = task.nx + begin, *my = task.ny + begin, *mz = task.nz + begin;
        const std::int32_t* __restrict own = mine + begin;
        float* __restrict to_u = out.u + begin, * __restrict to_v = out.v + begin;
#pragma omp simd
        for (int t = 0; t < lanes; ++t) {
            const MappedTexel at = map_texel<plane>(f, {px[t], py[t], pz[t], mx[t], my[t], mz[t]});
            const bool seen = whole ? at.cos > least_cos : (own[t] != 0) & (at.cos > least_cos);
            if constexpr (only) {
                to_u[t] = seen ? at.u : kOutside;
                to_v[t] = seen ? at.v : kOutside;
            } else {
                to_u[t] = seen ? at.u : to_u[t];
                to_v[t] = seen ? at.v : to_v[t];
            }
        }
    }
}

/// Whether all texels of a tile belong to one cluster.
[[gnu::always_inline]] inline bool is_alone(const std::uint8_t* __restrict id, std::int32_t cluster) {
    const auto wanted = static_cast<std::uint8_t>(cluster);
    std::uint8_t others = 0;
#pragma omp simd reduction(| : others)
    for (int t = 0; t < kTileTexels; ++t) others |= id[t] ^ wanted;
    return others == 0;
}

/// Adds `value` at the texels of a cluster in some units. Numbers are compared as wide as values: compared as bytes,
/// they would be widened after it, in four times as many steps.
template <class T>
[[gnu::always_inline]] inline void add_at_cluster(const std::uint8_t* __restrict id, std::int32_t cluster, Units units,
                                                  T value, T* __restrict out) {
    for (; units != 0; units &= units - 1) {
        const int begin = kUnit * __builtin_ctz(units);
#pragma omp simd
        for (int t = begin; t < begin + kUnit; ++t)
            out[t] += static_cast<std::int32_t>(id[t]) == cluster ? value : T{0};
    }
}

/// Drops the runs that no pose of the picture can reach.
template <int lanes>
[[gnu::always_inline]] inline void drop_outside(const Task& task, Runs& runs, const PicturePositions& at) {
    const float lo_u = task.reach_lo.x, lo_v = task.reach_lo.y;
    const float hi_u = task.reach_hi.x, hi_v = task.reach_hi.y;
    int kept = 0;
    for (int run = 0; run < runs.count; ++run) {
        const std::uint16_t begin = runs.start[run];
        const float *u = at.u + begin, *v = at.v + begin;
        int any = 0;
#pragma omp simd reduction(| : any)
        for (int t = 0; t < lanes; ++t) any |= (u[t] >= lo_u) & (u[t] <= hi_u) & (v[t] >= lo_v) & (v[t] <= hi_v);
        runs.start[kept] = begin;
        kept += any;
    }
    runs.count = kept;
}

/// Scale from coverage, 255 for full, to exposure; and the greatest exposure of each lane.
template <int lanes>
struct ExposureScale {
    float scale;
    float most[lanes];
};

/// Adds the picture's value at each texel, 255 for full coverage; the `last` pose finishes. In three
/// loops, so that no texel waits for another's position in the picture.
template <int lanes, bool last>
[[gnu::always_inline]] inline void add_pose(const Task& task, const SubPose& pose, const Runs& runs,
                                            const PicturePositions& positions, float* __restrict sum,
                                            ExposureScale<lanes>& finish) {
    const StampJobs& jobs = task.jobs;
    const std::uint8_t* __restrict cells = task.cells;
    const int stride = jobs.width + 1;
    // The last coordinates inside: below the number of cells.
    const float last_x = static_cast<float>(jobs.width) * (1 - 1e-6f);
    const float last_y = static_cast<float>(jobs.height) * (1 - 1e-6f);
    const float xu = pose.xu, xv = pose.xv, yu = pose.yu, yv = pose.yv, du = pose.du, dv = pose.dv;
    const float scale = finish.scale;
    float* __restrict most = finish.most;
    alignas(64) std::int32_t cell[kTileTexels];
    alignas(64) std::uint32_t four[kTileTexels];
    alignas(64) float part_x[kTileTexels], part_y[kTileTexels], within[kTileTexels];
    for (int run = 0; run < runs.count; ++run) {
        const float *u = positions.u + runs.start[run], *v = positions.v + runs.start[run];
        const int at = run * lanes;
#pragma omp simd
        for (int t = 0; t < lanes; ++t) {
            const float x = xu * u[t] + xv * v[t] + du, y = yu * u[t] + yv * v[t] + dv;
            const float xp = x > 0.0f ? x : 0.0f, yp = y > 0.0f ? y : 0.0f;
            const float xi = xp < last_x ? xp : last_x, yi = yp < last_y ? yp : last_y;
            // A factor, not a selection: that would become a branch around what follows.
            within[at + t] = ((xi == x) & (yi == y)) ? 1.0f : 0.0f;
            const int i = static_cast<int>(xi), j = static_cast<int>(yi);
            part_x[at + t] = xi - static_cast<float>(i);
            part_y[at + t] = yi - static_cast<float>(j);
            cell[at + t] = j * stride + i;
        }
    }
    const int n = runs.count * lanes;
    // The corners of a square: two cells of a row, and two of the next, read from two cells before them on, since what
    // lies beyond the last cell is not the picture's.
    const std::uint8_t* __restrict next_row = cells + stride - 2;
    for (int t = 0; t < n; ++t) {
        const std::uint32_t low = *reinterpret_cast<const FourCells*>(cells + cell[t]);
        const std::uint32_t high = *reinterpret_cast<const FourCells*>(next_row + cell[t]);
        four[t] = (low & 0x0000ffffu) | (high & 0xffff0000u);
    }
    for (int run = 0; run < runs.count; ++run) {
        float* __restrict to = sum + runs.start[run];
        const int at = run * lanes;
#pragma omp simd
        for (int t = 0; t < lanes; ++t) {
            const std::uint32_t q = four[at + t];
            const float fx = part_x[at + t], fy = part_y[at + t];
            const float q00 = static_cast<float>(static_cast<int>(q & 255));
            const float q10 = static_cast<float>(static_cast<int>((q >> 8) & 255));
            const float q01 = static_cast<float>(static_cast<int>((q >> 16) & 255));
            const float q11 = static_cast<float>(static_cast<int>(q >> 24));
            const float low = q00 + fx * (q10 - q00), high = q01 + fx * (q11 - q01);
            const float value = low + fy * (high - low);
            const float all = to[t] + within[at + t] * value;
            if constexpr (last) {
                const float scaled = all * scale;
                to[t] = scaled < 1.0f ? scaled : 1.0f;
                most[t] = scaled > most[t] ? scaled : most[t];
            } else {
                to[t] = all;
            }
        }
    }
}

/// Finishes runs to which no pose was added.
template <int lanes>
[[gnu::always_inline]] inline void finish_runs(const Runs& runs, float* __restrict exposure,
                                               ExposureScale<lanes>& finish) {
    for (int run = 0; run < runs.count; ++run) {
        float* __restrict e = exposure + runs.start[run];
#pragma omp simd
        for (int t = 0; t < lanes; ++t) {
            const float scaled = e[t] * finish.scale;
            e[t] = scaled < 1.0f ? scaled : 1.0f;
            finish.most[t] = scaled > finish.most[t] ? scaled : finish.most[t];
        }
    }
}

/// Texel → picture for all runs, by the frame of the stamp or those of the clusters.
template <int lanes, bool plane>
[[gnu::always_inline]] inline void map_tile(const Task& task, const Runs& runs, PicturePositions& out) {
    const StampJobs& jobs = task.jobs;
    const std::uint8_t* id = task.cluster;
    alignas(64) std::int32_t mine[kTileTexels];
    if (task.n_frames == 1 && is_alone(id, task.frames[0].cluster)) {
        map_texels<lanes, plane, true, true>(task, jobs.piecewise ? task.frames[0] : jobs.stamp_frame, runs, mine, out);
        return;
    }
    if (!jobs.piecewise) {
        for (int t = 0; t < kTileTexels; ++t) mine[t] = 0;
        for (std::uint32_t k = 0; k < task.n_frames; ++k)
            add_at_cluster(id, task.frames[k].cluster, part_units<lanes>(task.frames[k]), 1, mine);
        map_texels<lanes, plane, true, false>(task, jobs.stamp_frame, runs, mine, out);
        return;
    }
    for (int t = 0; t < kTileTexels; ++t) out.u[t] = out.v[t] = kOutside;
    for (std::uint32_t k = 0; k < task.n_frames; ++k) {
        const ClusterFrame& own = task.frames[k];
        const Units units = part_units<lanes>(own);
        for (int t = 0; t < kTileTexels; ++t) mine[t] = 0;
        add_at_cluster(id, own.cluster, units, 1, mine);
        map_texels<lanes, plane, false, false>(task, own, runs_of(join_runs<lanes>(units)), mine, out);
    }
}

template <int lanes, bool plane>
[[gnu::always_inline]] inline bool evaluate(const Task& task, float* __restrict exposure) {
    const std::uint8_t* id = task.cluster;
    const float whole = 255.0f * static_cast<float>(task.n_poses);
    Units part = 0, full = 0;
    for (std::uint32_t k = 0; k < task.n_frames; ++k) {
        part |= part_units<lanes>(task.frames[k]);
        full |= full_units<lanes>(task.frames[k]);
    }
    if (part == 0 && task.n_frames == 1 && full == ~Units{0} && is_alone(id, task.frames[0].cluster)) {
        const float scaled = whole * (task.jobs.gain / whole), all = scaled < 1.0f ? scaled : 1.0f;
        for (int t = 0; t < kTileTexels; ++t) exposure[t] = all;
        return all > 0.0f;
    }
    for (int t = 0; t < kTileTexels; ++t) exposure[t] = 0;
    for (std::uint32_t k = 0; full != 0 && k < task.n_frames; ++k)
        add_at_cluster(id, task.frames[k].cluster, full_units<lanes>(task.frames[k]), whole, exposure);
    alignas(64) ExposureScale<lanes> finish{task.jobs.gain / whole, {}};
    Units known = join_runs<lanes>(full);
    if (part != 0) {
        PicturePositions positions;
        Runs runs = runs_of(join_runs<lanes>(part));
        map_tile<lanes, plane>(task, runs, positions);
        if (task.n_poses > 1) drop_outside<lanes>(task, runs, positions);
        std::uint32_t k = 0;
        for (; k + 1 < task.n_poses; ++k)
            add_pose<lanes, false>(task, task.poses[k], runs, positions, exposure, finish);
        add_pose<lanes, true>(task, task.poses[k], runs, positions, exposure, finish);
        for (int run = 0; run < runs.count; ++run) known &= ~(Units{1} << (runs.start[run] / kUnit));
    }
    finish_runs(runs_of(known), exposure, finish);
    int any = 0;
    for (int t = 0; t < lanes; ++t) any |= finish.most[t] > 0.0f ? 1 : 0;
    return any != 0;
}

template <int lanes>
[[gnu::always_inline]] inline bool evaluate(const Task& task, float* __restrict exposure) {
    return task.jobs.mapping == Mapping::plane ? evaluate<lanes, true>(task, exposure)
                                               : evaluate<lanes, false>(task, exposure);
}

using Evaluate = bool (*)(const Task&, float* __restrict);

bool evaluate_baseline(const Task& task, float* __restrict exposure) {
    return evaluate<8>(task, exposure);
}

#ifdef TUFT_X86
[[gnu::target(TUFT_AVX2)]] bool evaluate_avx2(const Task& task, float* __restrict exposure) {
    return evaluate<8>(task, exposure);
}

[[gnu::target(TUFT_AVX512)]] bool evaluate_avx512(const Task& task, float* __restrict exposure) {
    return evaluate<16>(task, exposure);
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

bool evaluate_tile(const atlas::TexelMap& texels, const StampJobs& jobs, const TileJob& job, Unpacked& unpacked,
                   std::span<float, kTileTexels> exposure) {
    if (jobs.cells.empty() || jobs.sub_poses.empty()) {
        std::fill(exposure.begin(), exposure.end(), 0.0f);
        return false;
    }
    const atlas::TexelShape* shape = texels.packed.empty() ? &texels.shapes[job.slot] : &unpacked.shape;
    const auto frames = std::span(jobs.frames).subspan(job.first, job.count);
    const bool known =
        std::all_of(frames.begin(), frames.end(), [](const ClusterFrame& f) { return f.partial_quadrants == 0; });
    if (!texels.packed.empty() && !known && unpacked.slot != job.slot) {
        atlas::shape_of(texels, job.slot, unpacked.shape);
        unpacked.slot = job.slot;
    }
    const Task task{jobs,
                    jobs.frames.data() + job.first,
                    jobs.sub_poses.data(),
                    jobs.cells.data(),
                    job.count,
                    static_cast<std::uint32_t>(jobs.sub_poses.size()),
                    texels.tiles[job.slot].cluster.data(),
                    shape->px.data(),
                    shape->py.data(),
                    shape->pz.data(),
                    shape->nx.data(),
                    shape->ny.data(),
                    shape->nz.data(),
                    jobs.reach_lo,
                    jobs.reach_hi};
    return kernel(std::min(jobs.isa, best_isa()))(task, exposure.data());
}

}  // namespace tuft::footprint
