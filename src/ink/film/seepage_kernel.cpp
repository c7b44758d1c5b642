#include <algorithm>

#include "core/simd.h"
#include "ink/elementary.h"
#include "ink/film/seepage.h"

// Loops over rows of sixteen that vectorise; faces that are none have conductance 0.
#define TUFT_INLINE inline __attribute__((always_inline))

namespace tuft::ink::wet {
namespace {

constexpr int kLanes = kSide;
constexpr float kMostCarried = 0.95f;  // of a texel's pigments, in one step
constexpr float kLeast = 1e-30f;

TUFT_INLINE float cube(float s) {
    return s * s * s;
}
/// One stage of what goes through a face, see `Seepage`.
TUFT_INLINE float next_through(float flow, float through, float before, const SeepStage& c) {
    return c.now * (through + flow) - c.before * before;
}

/// Of all texels and those round them, and from where on.
TUFT_CLONES void find_heads(float* __restrict head, const float* __restrict s, const float* __restrict open,
                            const SeepStage& stage) {
    const float per_pores = stage.per_pores, flow = stage.flow;
    for (int k = 0; k < kField; ++k) {
        const float saturation = positive(s[k]) * per_pores;
        head[k] = open[k] * (flow * cube(saturation));
    }
}

TUFT_CLONES void stage_of_sides(SeepFaces& to, const SeepFaces& from, const float* __restrict head,
                                const float* __restrict open, const Geometry& g, const SeepStage& stage) {
    const SeepStage c = stage;
    for (int i = 0; i < kSide * kRow; ++i) {
        const int k = kRow + i;
        const float conductance =
            static_cast<float>(g.gx[static_cast<std::size_t>(i)]) * kConductanceUnit * (open[k] * open[k + 1]);
        to.x[k] = next_through(conductance * (head[k] - head[k + 1]), from.x[k], to.x[k], c);
    }
    for (int row = -1; row < kSide; ++row)
        for (int x = 0; x < kSide; ++x) {
            const int k = field_at(x, row);
            const float conductance = static_cast<float>(g.gy[static_cast<std::size_t>((row + 1) * kSide + x)]) *
                                      kConductanceUnit * (open[k] * open[k + kRow]);
            to.y[k] = next_through(conductance * (head[k] - head[k + kRow]), from.y[k], to.y[k], c);
        }
}

/// Rising ones go from k to k + kRow + 1, falling ones from k + 1 to k + kRow.
TUFT_CLONES void stage_of_diagonals(SeepFaces& to, const SeepFaces& from, const float* __restrict head,
                                    const float* __restrict open, const Geometry& g, const SeepStage& stage) {
    const SeepStage c = stage;
    const std::int16_t* diagonals = g.gd->data();
    for (int k = 0; k < kSquares; ++k) {
        const float d = static_cast<float>(diagonals[k]) * kDiagonalUnit;
        const float rising = positive(d) * (open[k] * open[k + kRow + 1]) * (head[k] - head[k + kRow + 1]);
        const float falling = positive(-d) * (open[k + 1] * open[k + kRow]) * (head[k + 1] - head[k + kRow]);
        to.diagonal[k] = next_through(rising + falling, from.diagonal[k], to.diagonal[k], c);
    }
}

/// What the faces bring to a texel.
template <bool kDiagonals>
TUFT_INLINE float brought(const SeepFaces& f, const std::int16_t* d, int k) {
    float sum = (f.x[k - 1] - f.x[k]) + (f.y[k - kRow] - f.y[k]);
    if constexpr (kDiagonals) {
        const auto rising = [&](int i) { return d[i] > 0 ? f.diagonal[i] : 0; };
        const auto falling = [&](int i) { return d[i] < 0 ? f.diagonal[i] : 0; };
        sum += (rising(k - kRow - 1) - rising(k)) + (falling(k - kRow) - falling(k - 1));
    }
    return sum;
}
template <bool kDiagonals>
TUFT_INLINE void add_up(float* __restrict out, const SeepFaces& f, const Geometry& g) {
    const std::int16_t* d = kDiagonals ? g.gd->data() : nullptr;
    for (int row = 0; row < kSide; ++row)
        for (int x = 0; x < kSide; ++x) out[row * kSide + x] = brought<kDiagonals>(f, d, field_at(x, row));
}
TUFT_CLONES void add_up_sides(float* out, const SeepFaces& f, const Geometry& g) {
    add_up<false>(out, f, g);
}
TUFT_CLONES void add_up_all(float* out, const SeepFaces& f, const Geometry& g) {
    add_up<true>(out, f, g);
}
void sum_of_faces(float* out, const SeepFaces& f, const Geometry& g) {
    (g.gd ? add_up_all : add_up_sides)(out, f, g);
}

/// Draws in from the surface, by the saturations before the stage.
TUFT_CLONES void stage_of_soaking(float* __restrict to, const float* __restrict from, const float* __restrict film,
                                  const float* __restrict s, const SeepStage& stage) {
    const SeepStage c = stage;
    for (int row = 0; row < kSide; ++row)
        for (int x = 0; x < kSide; ++x) {
            const int i = row * kSide + x;
            const float empty = positive(1 - positive(s[field_at(x, row)]) * c.per_pores);
            to[i] = next_through(c.soak * positive(film[i] - from[i]) * empty, from[i], to[i], c);
        }
}

/// Returns the least amount, at most 0.
TUFT_CLONES float take_amounts(float* __restrict s, const float* __restrict start, const float* __restrict soaked,
                               const float* __restrict sum, const float* __restrict beyond,
                               const float* __restrict inverse) {
    alignas(64) float least[kLanes] = {};
    for (int i = 0; i < kTexels; i += kLanes)
        for (int x = 0; x < kLanes; ++x) {
            const float v = (start[i + x] + soaked[i + x]) + (sum[i + x] - beyond[i + x]) * inverse[i + x];
            s[i + x] = v;
            least[x] = smaller(least[x], v);
        }
    float out = least[0];
    for (int x = 0; x < kLanes; ++x) out = smaller(out, least[x]);
    return out;
}

/// What leaves a texel through its faces.
TUFT_CLONES void leaving_through_sides(float* __restrict out, const SeepFaces& f) {
    for (int row = 0; row < kSide; ++row)
        for (int x = 0; x < kSide; ++x) {
            const int k = field_at(x, row);
            out[row * kSide + x] =
                (positive(f.x[k]) + positive(-f.x[k - 1])) + (positive(f.y[k]) + positive(-f.y[k - kRow]));
        }
}
TUFT_CLONES void leaving_through_diagonals(float* __restrict out, const SeepFaces& f, const Geometry& g) {
    const std::int16_t* d = g.gd->data();
    for (int row = 0; row < kSide; ++row)
        for (int x = 0; x < kSide; ++x) {
            const int k = field_at(x, row);
            const auto rising = [&](int i) { return d[i] > 0 ? f.diagonal[i] : 0; };
            const auto falling = [&](int i) { return d[i] < 0 ? f.diagonal[i] : 0; };
            out[row * kSide + x] += (positive(rising(k)) + positive(-rising(k - kRow - 1))) +
                                    (positive(falling(k - 1)) + positive(-falling(k - kRow)));
        }
}
TUFT_CLONES void carried_of(float* __restrict carried, const float* __restrict rate, const float* __restrict leaving,
                            const float* __restrict inverse) {
    for (int i = 0; i < kTexels; ++i) {
        const float most = kMostCarried / larger(leaving[i] * inverse[i], kLeast);
        carried[i] = smaller(rate[i], most);
    }
}

TUFT_CLONES void carry_over_sides(Work& work, const SeepFaces& f, const float* __restrict carried) {
    for (int i = 0; i < kSide * kRow; ++i) {
        const int k = kRow + i;
        work.x.a[k] = positive(f.x[k]) * carried[k];
        work.x.b[k] = smaller(f.x[k], 0) * carried[k + 1];
    }
    for (int row = -1; row < kSide; ++row)
        for (int x = 0; x < kSide; ++x) {
            const int k = field_at(x, row);
            work.y.a[k] = positive(f.y[k]) * carried[k];
            work.y.b[k] = smaller(f.y[k], 0) * carried[k + kRow];
        }
}
TUFT_CLONES void carry_over_diagonals(Work& work, const SeepFaces& f, const Geometry& g,
                                      const float* __restrict carried) {
    const std::int16_t* d = g.gd->data();
    for (int k = 0; k < kSquares; ++k) {
        const float rising = d[k] > 0 ? f.diagonal[k] : 0, falling = d[k] < 0 ? f.diagonal[k] : 0;
        work.up.a[k] = positive(rising) * carried[k];
        work.up.b[k] = smaller(rising, 0) * carried[k + kRow + 1];
        work.down.a[k] = positive(falling) * carried[k + 1];
        work.down.b[k] = smaller(falling, 0) * carried[k + kRow];
    }
}

}  // namespace

void seep_stage(SeepTile& tile, const Field& s, const Geometry& g, const SeepStage& stage) {
    const auto from = static_cast<std::size_t>(stage.from), to = 1 - from;
    Field head;
    find_heads(head.data(), s.data(), tile.open.data(), stage);
    stage_of_sides(tile.faces[to], tile.faces[from], head.data(), tile.open.data(), g, stage);
    if (g.gd) stage_of_diagonals(tile.faces[to], tile.faces[from], head.data(), tile.open.data(), g, stage);
    alignas(64) std::array<float, kTexels> sum;
    sum_of_faces(sum.data(), tile.faces[to], g);
    if (tile.fed) stage_of_soaking(tile.soaked[to].data(), tile.soaked[from].data(), tile.film, s.data(), stage);
    tile.least = take_amounts(tile.s[to].data(), tile.start, tile.soaked[to].data(), sum.data(), tile.beyond.data(),
                              g.inverse.data());
}

void seep_over_link(SeepLink& link, float s0, float s1, const SeepStage& stage) {
    const auto head = [&](float s) { return stage.flow * cube(positive(s) * stage.per_pores); };
    const auto from = static_cast<std::size_t>(stage.from);
    link.through[1 - from] =
        next_through(link.weight * (head(s0) - head(s1)), link.through[from], link.through[1 - from], stage);
}

void limit_carried(SeepTile& tile, const Geometry& g, int last, const Plane& rate) {
    const auto at = static_cast<std::size_t>(last);
    const SeepFaces& faces = tile.faces[at];
    alignas(64) std::array<float, kTexels> leaving;
    leaving_through_sides(leaving.data(), faces);
    if (g.gd) leaving_through_diagonals(leaving.data(), faces, g);
    for (const SeepLink& l : tile.links) leaving[l.texel] += positive(l.through[at]) + l.smeared;
    carried_of(tile.carried.data(), rate.data(), leaving.data(), g.inverse.data());
}

void seepage_flow(Work& work, const SeepTile& tile, const Geometry& g, int last, const Field& carried) {
    const auto at = static_cast<std::size_t>(last);
    const SeepFaces& faces = tile.faces[at];
    sum_of_faces(work.ds.data(), faces, g);
    for (int i = 0; i < kTexels; ++i) {
        const float in = g.inverse[i] > 0 ? tile.soaked[at][static_cast<std::size_t>(i)] / g.inverse[i] : 0;
        work.dw[i] = -in;
        work.ds[i] += in;
    }
    carry_over_sides(work, faces, carried.data());
    if (g.gd) carry_over_diagonals(work, faces, g, carried.data());
    for (int k = 0; k < kField; ++k) work.total[k] = work.w[k] + work.s[k];
    for (const SeepLink& l : tile.links) work.ds[l.texel] -= l.through[at];
}

}  // namespace tuft::ink::wet
