#include <algorithm>
#include <bit>
#include <cmath>

#include "core/random.h"
#include "ink/film/film_tile.h"
#include "ink/simd.h"

// Loops over rows of sixteen that vectorise; faces that are none have conductance 0.
#define TUFT_INLINE inline __attribute__((always_inline))

namespace tuft::ink::wet {
namespace {

constexpr int kLanes = kSide;
constexpr float kLeast = 1e-30f;     // film units: no division by zero in lanes that are dry
constexpr float kMostNear = 8;       // of what smears between two texels, over that of whole texels side by side

TUFT_INLINE float larger(float a, float b) { return a > b ? a : b; }
TUFT_INLINE float smaller(float a, float b) { return a < b ? a : b; }
TUFT_INLINE float positive(float a) { return a > 0 ? a : 0; }
TUFT_INLINE float rate_of(float total, float grip) { return total > 0 ? 1 / larger(larger(total, grip), kLeast) : 0; }

/// One end of a face: what is there, and what of it counts.
struct End {
    float w, s, t, rate, grain, above, free, carrying, z;
};
/// Rows of them.
struct Ends {
    const float *w, *s, *t, *rate, *grain, *above, *free, *carrying, *z;

    TUFT_INLINE End at(int x) const { return {w[x], s[x], t[x], rate[x], grain[x], above[x], free[x], carrying[x], z[x]}; }
};
TUFT_INLINE Ends ends(const Work& o, const Geometry& g, int k) {
    return {&o.w[k], &o.s[k], &o.total[k], &o.rate[k], &g.grain[k], &o.above[k], &o.free[k], &o.carrying[k], &o.z[k]};
}
/// Fibres hold grains back from what seeps.
TUFT_INLINE float passing_of(const Step& p) { return p.pores > 0 ? p.passing : 1; }
TUFT_INLINE End end_of(float w, float s, float grain, float z, const Step& p) {
    const float t = w + s;
    return {w, s, t, rate_of(t, p.grip), grain, positive(w - p.threshold), positive(w - p.hold), w + passing_of(p) * s, z};
}

/// What differs between tiles; all give the same numbers where they apply.
template <bool kPores, bool kDry, bool kRelief>
struct Law {
    static constexpr bool pores = kPores;

    /// Flux of liquid on the surface between two texels, film units · mean area.
    static TUFT_INLINE float film_flux(float g, const End& e0, const End& e1, const Step& p) {
        float above = e0.above + e1.above;  // the mean's double
        float over0 = 0, over1 = 0;  // what may leave an end on relief
        if constexpr (kRelief) over0 = positive(e0.w - p.ridge), over1 = positive(e1.w - p.ridge);
        if constexpr (kDry) {
            const float onto0 = e0.t > 0 ? 0 : p.pin * e0.grain, onto1 = e1.t > 0 ? 0 : p.pin * e1.grain;
            const float held = p.threshold + (onto0 + onto1);
            const float over_held0 = positive(e0.w - held), over_held1 = positive(e1.w - held);
            above = over_held0 + over_held1;
            if constexpr (kRelief) over0 = smaller(over0, over_held0), over1 = smaller(over1, over_held1);
        }
        const float level = (0.5f * p.levelling) * (e0.free + e1.free);
        const float plain = g * smaller((0.5f * p.flow) * above + (above > 0 ? level : 0), p.limit) * (e0.w - e1.w);
        if constexpr (!kRelief) return plain;
        // Down the liquid's own surface, and no more than its upper end has to give.
        const float drop = (e0.w + e0.z) - (e1.w + e1.z), over = drop > 0 ? over0 : over1;
        const float run = smaller((0.5f * p.flow) * above + p.relief * over, p.limit) * drop;
        const float most = p.limit * over;
        return e0.z + e1.z > 0 ? g * larger(smaller(run, most), -most) : plain;
    }

    static TUFT_INLINE float pore_flux(float g, const End& e0, const End& e1, const Step& p) {
        return g * smaller((0.5f * p.flow) * (e0.s + e1.s), p.limit) * (e0.s - e1.s);
    }
};

struct Carriers {
    float a, b;
};
TUFT_INLINE Carriers carriers(float g, float flux, const End& e0, const End& e1, const Step& p) {
    const float exchange = p.mixing * g * smaller(e0.carrying, e1.carrying);
    return {positive(flux) + exchange, smaller(flux, 0) - exchange};
}

/// Sixteen faces.
template <class Law>
TUFT_INLINE void faces(Faces& f, int k, const float* g, const Ends& from, const Ends& to, const Step& p) {
    float *w = &f.w[k], *s = &f.s[k], *a = &f.a[k], *b = &f.b[k];
#pragma GCC ivdep
    for (int x = 0; x < kLanes; ++x) {
        const End e0 = from.at(x), e1 = to.at(x);
        const float fw = Law::film_flux(g[x], e0, e1, p);
        float flux = fw;
        if constexpr (Law::pores) {
            const float fs = Law::pore_flux(g[x], e0, e1, p);
            s[x] = fs;
            flux = fw + p.passing * fs;
        }
        const Carriers c = carriers(g[x], flux, e0, e1, p);
        w[x] = fw;
        a[x] = c.a * e0.rate;
        b[x] = c.b * e1.rate;
    }
}

/// What faces need of the sixteen texels from k on.
TUFT_INLINE void levels(Work& o, int k, const Step& p) {
    const float *w = &o.w[k], *s = &o.s[k], passing = passing_of(p);
    float *total = &o.total[k], *rate = &o.rate[k], *above = &o.above[k], *free = &o.free[k], *carrying = &o.carrying[k];
#pragma GCC ivdep
    for (int x = 0; x < kLanes; ++x) {
        const float t = w[x] + s[x];
        total[x] = t;
        rate[x] = rate_of(t, p.grip);
        above[x] = positive(w[x] - p.threshold);
        free[x] = positive(w[x] - p.hold);
        carrying[x] = w[x] + passing * s[x];
    }
}

TUFT_INLINE void unpack(Work& o, const Geometry& g) {
    for (std::size_t i = 0; i < o.gx.size(); ++i) o.gx[i] = static_cast<float>(g.gx[i]) * kConductanceUnit;
    for (std::size_t i = 0; i < o.gy.size(); ++i) o.gy[i] = static_cast<float>(g.gy[i]) * kConductanceUnit;
    if (!g.gd) return;
    for (std::size_t i = 0; i < o.gup.size(); ++i) {
        const float d = static_cast<float>((*g.gd)[i]) * kDiagonalUnit;
        o.gup[i] = positive(d);
        o.gdown[i] = positive(-d);
    }
}

/// A square has one diagonal at most.
template <class Law>
TUFT_INLINE void all_faces(Work& o, const Geometry& g, const Step& step) {
    const Step p = step;  // where nothing that is written could change it
    unpack(o, g);
    for (int k = 0; k < kField; k += kLanes) levels(o, k, p);
    for (int k = 0; k < kSide * kRow; k += kLanes) faces<Law>(o.x, kRow + k, &o.gx[k], ends(o, g, kRow + k), ends(o, g, kRow + k + 1), p);
    for (int row = -1; row < kSide; ++row) {
        const int k = field_at(0, row);
        faces<Law>(o.y, k, &o.gy[(row + 1) * kSide], ends(o, g, k), ends(o, g, k + kRow), p);
    }
    for (int k = 0; g.ups && k < kSquares; k += kLanes) faces<Law>(o.up, k, &o.gup[k], ends(o, g, k), ends(o, g, k + kRow + 1), p);
    for (int k = 0; g.downs && k < kSquares; k += kLanes) faces<Law>(o.down, k, &o.gdown[k], ends(o, g, k + 1), ends(o, g, k + kRow), p);
}
TUFT_CLONES void faces_wet(Work& o, const Geometry& g, const Step& p) {
    if (p.pores > 0) all_faces<Law<true, false, false>>(o, g, p);
    else all_faces<Law<false, false, false>>(o, g, p);
}
TUFT_CLONES void faces_dry(Work& o, const Geometry& g, const Step& p) {
    if (p.pores > 0) all_faces<Law<true, true, false>>(o, g, p);
    else all_faces<Law<false, true, false>>(o, g, p);
}
TUFT_CLONES void faces_on_relief(Work& o, const Geometry& g, const Step& p) {
    if (p.pores > 0) all_faces<Law<true, true, true>>(o, g, p);
    else all_faces<Law<false, true, true>>(o, g, p);
}

struct Least {
    bool dry, thin;  ///< a texel of a chart has no liquid, less than is over a rim
};
/// Of all texels and those round them.
TUFT_CLONES float least_total(const Work& o) {
    const float *w = o.w.data(), *s = o.s.data();
    alignas(64) float least[kLanes];
    const auto total = [w, s](int column, int row) __attribute__((always_inline)) { return w[field_at(column, row)] + s[field_at(column, row)]; };
    for (int x = 0; x < kLanes; ++x) least[x] = total(x, -1);
    for (int row = 0; row <= kSide; ++row)
        for (int x = 0; x < kLanes; ++x) least[x] = smaller(least[x], total(x, row));
    float all = least[0];
    for (const float l : least) all = smaller(all, l);
    for (int row = -1; row <= kSide; ++row) all = smaller(all, smaller(total(-1, row), total(kSide, row)));
    return all;
}
TUFT_CLONES Least look_for_rims(const Work& o, const Geometry& g, float depth) {
    std::uint32_t dry = 0, thin = 0;
    for (int row = -1; row <= kSide; ++row) {
        std::uint32_t none = 0, little = 0;
        const int k = field_at(-1, row);
        for (int x = 0; x < kSide + 2; ++x) {
            const float total = o.w[k + x] + o.s[k + x];
            none |= static_cast<std::uint32_t>(!(total > 0)) << x;
            little |= static_cast<std::uint32_t>(total < depth) << x;
        }
        dry |= g.valid[static_cast<std::size_t>(row + 1)] & none;
        thin |= g.valid[static_cast<std::size_t>(row + 1)] & little;
    }
    return {dry != 0, thin != 0};
}

/// Into texel k by the four sides, and by the diagonals.
TUFT_INLINE float into(const float* x, const float* y, int k) {
    return (x[k - 1] - x[k]) + (y[k - kRow] - y[k]);
}
TUFT_INLINE float into_up(const float* up, int k) { return up[k - kRow - 1] - up[k]; }
TUFT_INLINE float into_down(const float* down, int k) { return down[k - kRow] - down[k - 1]; }

template <bool kUp, bool kDown>
TUFT_INLINE void diverge(float* __restrict d, const float* __restrict x, const float* __restrict y,
                         const float* __restrict up, const float* __restrict down, const float* __restrict inverse) {
    for (int row = 0; row < kSide; ++row)
        for (int c = 0; c < kSide; ++c) {
            const int k = field_at(c, row);
            float sum = into(x, y, k);
            if constexpr (kUp && kDown) sum += into_up(up, k) + into_down(down, k);
            else if constexpr (kUp) sum += into_up(up, k);
            else if constexpr (kDown) sum += into_down(down, k);
            d[row * kSide + c] = sum * inverse[row * kSide + c];
        }
}
TUFT_CLONES void divergence(float* d, const Work& o, Field Faces::*f, const Geometry& g) {
    const float *x = (o.x.*f).data(), *y = (o.y.*f).data(), *up = (o.up.*f).data(), *down = (o.down.*f).data();
    const float* inverse = g.inverse.data();
    if (g.ups && g.downs) diverge<true, true>(d, x, y, up, down, inverse);
    else if (g.ups) diverge<true, false>(d, x, y, up, down, inverse);
    else if (g.downs) diverge<false, true>(d, x, y, up, down, inverse);
    else diverge<false, false>(d, x, y, up, down, inverse);
}

/// Slope, over a texel, of what stands over the rim: Σ of the sides that go down, both ways squared.
TUFT_CLONES void slope_to_rims(float* __restrict n, const float* __restrict t, const Geometry& g, float depth) {
    const std::uint16_t *gx = g.gx.data(), *gy = g.gy.data();
    for (int row = 0; row < kSide; ++row)
        for (int x = 0; x < kSide; ++x) {
            const int k = field_at(x, row), i = row * kSide + x, side = Geometry::right_of(x, row);
            const float here = smaller(t[k], depth);
            const float right = gx[side] == 0 ? 0.0f : positive(here - t[k + 1]);
            const float left = gx[side - 1] == 0 ? 0.0f : positive(here - t[k - 1]);
            const float up = gy[i + kSide] == 0 ? 0.0f : positive(here - t[k + kRow]);
            const float down = gy[i] == 0 ? 0.0f : positive(here - t[k - kRow]);
            const float across = right + left, along = up + down;
            n[i] = std::sqrt(across * across + along * along);
        }
}

/// a + d, rounded up or down by chance; never below 0.
TUFT_INLINE float sum_of(float a, float d, float noise) {
    const float scale = std::bit_cast<float>(std::bit_cast<std::uint32_t>(a) & 0x7f800000u);
    return positive(a + (d + noise * scale));
}

/// A texel's new liquid, soaking and drying; `air`: what went into the air; `closed`: 1 for texels
/// that had liquid and have none. Returns in `most` the greatest w, s and closed.
TUFT_CLONES void settle(float* __restrict w, float* __restrict s, float* __restrict air,
                        float* __restrict closed, float* __restrict most, const Work& o,
                        const float* __restrict noise, const Step& step) {
    const float soak = step.soak, pores = step.pores, per_pores = pores > 0 ? 1 / pores : 0;
    const float evaporation = step.evaporation, rim = step.rim;
    alignas(64) float most_w[kLanes] = {}, most_s[kLanes] = {}, any[kLanes] = {};
    for (int row = 0; row < kSide; ++row) {
#pragma GCC ivdep
        for (int x = 0; x < kSide; ++x) {
            const int i = row * kSide + x, k = field_at(x, row);
            float w1 = sum_of(o.w[k], o.dw[i], noise[i]), s1 = sum_of(o.s[k], o.ds[i], noise[i]);
            const float room = positive(pores - s1);
            float in = w1 * soak * (room * per_pores);
            // In units of the last place of the larger one, so that both sums are exact.
            const float large = larger(w1, s1);
            in = smaller(smaller((large + in) - large, room), w1);
            w1 -= in;
            s1 += in;
            const float over = positive(s1 - pores);  // by rounding
            s1 -= over;
            w1 += over;
            const float all = evaporation + rim * o.rim_slope[i];
            const float from_w = smaller(w1, all), from_s = smaller(s1, all - from_w);
            w1 -= from_w;
            s1 -= from_s;
            w[i] = w1;
            s[i] = s1;
            air[i] = from_w + from_s;
            closed[i] = o.total[k] > 0 && !(w1 + s1 > 0) ? 1.0f : 0.0f;
            most_w[x] = larger(most_w[x], w1);
            most_s[x] = larger(most_s[x], s1);
            any[x] = larger(any[x], closed[i]);
        }
    }
    for (int lane = 0; lane < kLanes; ++lane) {
        most[0] = larger(most[0], most_w[lane]);
        most[1] = larger(most[1], most_s[lane]);
        most[2] = larger(most[2], any[lane]);
    }
}

/// Σ air times area: in float over a column, whose sixteen numbers are alike. Beside charts there is no air; 0 / 0 there,
/// thrown away or not, is no number, which this file's options forbid (AVX2 then lost other lanes).
TUFT_CLONES double integral(const float* __restrict air, const float* __restrict inverse) {
    alignas(64) float sums[kLanes] = {};
    for (int t = 0; t < kTexels; t += kLanes)
        for (int lane = 0; lane < kLanes; ++lane) sums[lane] += air[t + lane] / larger(inverse[t + lane], kLeast);
    double sum = 0;
    for (const float g : sums) sum += static_cast<double>(g);
    return sum;
}

TUFT_INLINE float carried(const Faces& f, const float* p, int k, int from, int to) {
    return f.a[k] * p[from] + f.b[k] * p[to];
}

/// Each flux is computed from the same numbers for both its texels, upwards once: the row above takes it from `below`.
template <bool kUp, bool kDown, bool kSeams>
TUFT_INLINE void carry(float* __restrict out, const Work& o, const float* __restrict inverse, const float* __restrict noise) {
    const float* p = o.p.data();
    alignas(64) float below[kSide];
    for (int x = 0; x < kSide; ++x) {
        const int k = field_at(x, -1);
        below[x] = carried(o.y, p, k, k, k + kRow);
    }
    for (int row = 0; row < kSide; ++row) {
#pragma GCC ivdep
        for (int x = 0; x < kSide; ++x) {
            const int k = field_at(x, row), i = row * kSide + x;
            const float above = carried(o.y, p, k, k, k + kRow);
            float d = (carried(o.x, p, k - 1, k - 1, k) - carried(o.x, p, k, k, k + 1)) + (below[x] - above);
            below[x] = above;
            float askew = 0;
            if constexpr (kUp) askew = carried(o.up, p, k - kRow - 1, k - kRow - 1, k) - carried(o.up, p, k, k, k + kRow + 1);
            if constexpr (kDown) askew += carried(o.down, p, k - kRow, k - kRow + 1, k) - carried(o.down, p, k - 1, k, k + kRow - 1);
            if constexpr (kUp || kDown) d += askew;
            d *= inverse[i];
            if constexpr (kSeams) d += o.dp[i];
            out[i] = sum_of(p[k], d, noise[i]);
        }
    }
}
template <bool kSeams>
TUFT_INLINE void carry_all(float* __restrict out, const Work& o, const Geometry& g, const float* __restrict noise) {
    const float* inverse = g.inverse.data();
    if (g.ups && g.downs) carry<true, true, kSeams>(out, o, inverse, noise);
    else if (g.ups) carry<true, false, kSeams>(out, o, inverse, noise);
    else if (g.downs) carry<false, true, kSeams>(out, o, inverse, noise);
    else carry<false, false, kSeams>(out, o, inverse, noise);
}
TUFT_CLONES void carry_inside(float* out, const Work& o, const Geometry& g, const float* noise) { carry_all<false>(out, o, g, noise); }
TUFT_CLONES void carry_over_seams(float* out, const Work& o, const Geometry& g, const float* noise) { carry_all<true>(out, o, g, noise); }

TUFT_CLONES void gather_rows(float* __restrict to, const float* above, const float* __restrict here,
                             const float* below) {
    const auto row = [to](int r, const float* from) __attribute__((always_inline)) {
        for (int x = 0; x < kSide; ++x) to[field_at(0, r) + x] = from[x];
    };
    row(-1, above + kTexels - kSide);
    for (int r = 0; r < kSide; ++r) row(r, here + r * kSide);
    row(kSide, below);
}

}  // namespace

void gather(Field& field, const std::array<const float*, 9>& planes) {
    gather_rows(field.data(), planes[1], planes[4], planes[7]);
    constexpr int end = kTexels - kSide;
    field[field_at(-1, -1)] = planes[0][kTexels - 1];
    field[field_at(kSide, -1)] = planes[2][end];
    field[field_at(-1, kSide)] = planes[6][kSide - 1];
    field[field_at(kSide, kSide)] = planes[8][0];
    for (int row = 0; row < kSide; ++row) {
        field[field_at(-1, row)] = planes[3][row * kSide + kSide - 1];
        field[field_at(kSide, row)] = planes[5][row * kSide];
    }
}

bool fluxes(Work& work, const Geometry& g, const Step& step) {
    const float depth = step.rim > 0 ? step.rim_depth : 0, least = least_total(work);
    const Least rims = least > 0 && least >= depth ? Least{} : look_for_rims(work, g, depth);
    (work.on_relief ? faces_on_relief : rims.dry ? faces_dry : faces_wet)(work, g, step);
    if (rims.thin) slope_to_rims(work.rim_slope.data(), work.total.data(), g, step.rim_depth);
    else if (work.sloping) work.rim_slope.fill(0);
    work.sloping = rims.thin;
    return rims.thin;
}

void liquid_changes(Work& work, const Geometry& g, const Step& step) {
    divergence(work.dw.data(), work, &Faces::w, g);
    if (step.pores > 0) divergence(work.ds.data(), work, &Faces::s, g);
    else work.ds.fill(0);
}

void pigment_step(float* p, const Work& work, const Geometry& g, bool seams, std::uint64_t seed) {
    (seams ? carry_over_seams : carry_inside)(p, work, g, dither(seed));
}

Outcome local_step(float* w, float* s, const Work& work, const Geometry& g, const Step& step,
                   std::uint64_t seed, std::array<std::uint8_t, kTexels>& closing) {
    Outcome out;
    alignas(64) std::array<float, kTexels> air, closed;
    std::array<float, 3> most{};
    settle(w, s, air.data(), closed.data(), most.data(), work, dither(seed), step);
    if (step.evaporation > 0 || step.rim > 0) out.evaporated = integral(air.data(), g.inverse.data());
    out.most_w = most[0];
    out.most_s = most[1];
    out.closing = most[2] > 0;
    if (out.closing)
        for (int t = 0; t < kTexels; ++t) closing[t] = closed[t] > 0;
    bool first = false, last = false, left = false, right = false;
    for (int i = 0; i < kSide; ++i) {
        const int end = kTexels - kSide;
        first |= w[i] + s[i] > 0;
        last |= w[end + i] + s[end + i] > 0;
        left |= w[i * kSide] + s[i * kSide] > 0;
        right |= w[i * kSide + kSide - 1] + s[i * kSide + kSide - 1] > 0;
    }
    out.sides = static_cast<std::uint8_t>(first | last << 1 | left << 2 | right << 3);
    return out;
}

TUFT_CLONES float greatest(const float* plane) {
    float most[kLanes] = {};
    for (int t = 0; t < kTexels; t += kLanes)
        for (int lane = 0; lane < kLanes; ++lane) most[lane] = larger(plane[t + lane], most[lane]);
    float all = 0;
    for (const float m : most) all = larger(m, all);
    return all;
}

const float* dither(std::uint64_t seed) {
    constexpr int kOffsets = 1024;
    static const auto table = [] {
        std::array<float, kOffsets + kTexels> t{};
        // Pairs of opposite numbers: no sum over a tile leans to a side.
        for (std::size_t i = 0; i < t.size(); i += 2) {
            t[i] = static_cast<float>(uniform(0x646974, i) - 0.5) * 0x1p-23f;
            t[i + 1] = -t[i];
        }
        return t;
    }();
    return &table[hash_bits(seed, 1) % kOffsets & ~std::uint64_t{1}];
}

SeamFlux seam_flux(float weight, float apart, const std::array<float, 2>& w, const std::array<float, 2>& s,
                   const std::array<float, 2>& grain, const std::array<float, 2>& z, const Step& step) {
    const End e0 = end_of(w[0], s[0], grain[0], z[0], step), e1 = end_of(w[1], s[1], grain[1], z[1], step);
    SeamFlux out;
    out.w = Law<true, true, true>::film_flux(weight, e0, e1, step);
    if (step.pores > 0) out.s = Law<true, true, true>::pore_flux(weight, e0, e1, step);
    Carriers c = carriers(weight, out.w + step.passing * out.s, e0, e1, step);
    // Nearer cells' middles lie farther apart than their texels, by whose distance their amounts differ: they mix more,
    // by no more than what could flow.
    const float near = smaller(larger(1 / larger(apart * apart, kLeast), 1), kMostNear) - 1;
    const float more = 0.5f * smaller(near * std::abs(out.w + step.passing * out.s), step.limit * weight * smaller(e0.t, e1.t));
    c.a += more;
    c.b -= more;
    out.a = c.a * e0.rate;
    out.b = c.b * e1.rate;
    return out;
}

}  // namespace tuft::ink::wet
