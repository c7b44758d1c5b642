#include <algorithm>
#include <bit>
#include <cmath>

#include "core/random.h"
#include "ink/film_tile.h"
#include "ink/simd.h"

// Loops over rows of sixteen that vectorise; faces that are none have conductance 0.
#define TUFT_INLINE inline __attribute__((always_inline))

namespace tuft::ink::wet {
namespace {

constexpr int kLanes = kSide;
constexpr float kLeast = 1e-30f;     // film units: no division by zero in lanes that are dry

TUFT_INLINE float larger(float a, float b) { return a > b ? a : b; }
TUFT_INLINE float smaller(float a, float b) { return a < b ? a : b; }
TUFT_INLINE float positive(float a) { return a > 0 ? a : 0; }
TUFT_INLINE float rate_of(float total, float grip) { return total > 0 ? 1 / larger(larger(total, grip), kLeast) : 0; }

/// One end of a face.
struct End {
    float w, s, t, rate, grain;
};
/// Rows of them.
struct Ends {
    const float *w, *s, *t, *rate, *grain;

    TUFT_INLINE End at(int x) const { return {w[x], s[x], t[x], rate[x], grain[x]}; }
};
TUFT_INLINE Ends ends(const Work& o, const Geometry& g, int k) {
    return {&o.w[k], &o.s[k], &o.total[k], &o.rate[k], &g.grain[k]};
}

/// What differs between tiles; all give the same numbers where they apply.
template <bool kPores, bool kDry>
struct Law {
    static constexpr bool pores = kPores;

    /// Flux of liquid on the surface between two texels, film units · mean area.
    static TUFT_INLINE float film_flux(float g, const End& e0, const End& e1, const Step& p) {
        float held = p.threshold;
        if constexpr (kDry) {
            const float onto0 = e0.t > 0 ? 0 : p.pin * e0.grain, onto1 = e1.t > 0 ? 0 : p.pin * e1.grain;
            held = held + (onto0 + onto1);
        }
        const float above = 0.5f * (positive(e0.w - held) + positive(e1.w - held));
        const float free = 0.5f * (positive(e0.w - p.hold) + positive(e1.w - p.hold));
        return g * smaller(p.flow * above + (above > 0 ? p.levelling * free : 0), p.limit) * (e0.w - e1.w);
    }

    static TUFT_INLINE float pore_flux(float g, const End& e0, const End& e1, const Step& p) {
        return g * smaller(p.flow * (0.5f * (e0.s + e1.s)), p.limit) * (e0.s - e1.s);
    }
};

struct Carriers {
    float a, b;
};
TUFT_INLINE Carriers carriers(float g, float flux, float t0, float t1, const Step& p) {
    const float exchange = p.mixing * g * smaller(t0, t1);
    return {positive(flux) + exchange, -positive(-flux) - exchange};
}
/// Fibres hold grains back from what seeps.
TUFT_INLINE Carriers carriers(float g, float fw, float fs, const End& e0, const End& e1, const Step& p) {
    return carriers(g, fw + p.passing * fs, e0.w + p.passing * e0.s, e1.w + p.passing * e1.s, p);
}

/// Faces side by side.
template <class Law, int kFaces>
TUFT_INLINE void faces(float* w, float* s, float* a, float* b, const float* g, const Ends& from, const Ends& to, const Step& p) {
#pragma GCC ivdep
    for (int x = 0; x < kFaces; ++x) {
        const End e0 = from.at(x), e1 = to.at(x);
        const float fw = Law::film_flux(g[x], e0, e1, p);
        Carriers c;
        if constexpr (Law::pores) {
            const float fs = Law::pore_flux(g[x], e0, e1, p);
            s[x] = fs;
            c = carriers(g[x], fw, fs, e0, e1, p);
        } else c = carriers(g[x], fw, e0.t, e1.t, p);
        w[x] = fw;
        a[x] = c.a * e0.rate;
        b[x] = c.b * e1.rate;
    }
}

TUFT_INLINE void unpack(Work& o, const Geometry& g) {
    float* x = &o.gx[field_at(-8, 0)];
    for (int i = 0; i < kSide * kRow; ++i) x[i] = static_cast<float>(g.gx[i]) * kConductanceUnit;
    for (int row = -1; row < kSide; ++row)
        for (int c = 0; c < kSide; ++c)
            o.gy[field_at(c, row)] = static_cast<float>(g.gy[(row + 1) * kSide + c]) * kConductanceUnit;
    if (!g.gd) return;
    const std::int16_t* d = g.gd->data();
    for (int k = 0; k < kField; ++k) o.gd[k] = static_cast<float>(d[k]) * kDiagonalUnit;
}

template <class Law>
TUFT_INLINE void straight_faces(Work& o, const Geometry& g, const Step& p) {
    for (int row = 0; row < kSide; ++row) {
        const int k = field_at(-8, row);
        faces<Law, kRow>(&o.x.w[k], &o.x.s[k], &o.x.a[k], &o.x.b[k], &o.gx[k], ends(o, g, k), ends(o, g, k + 1), p);
    }
    for (int row = -1; row < kSide; ++row) {
        const int k = field_at(0, row);
        faces<Law, kSide>(&o.y.w[k], &o.y.s[k], &o.y.a[k], &o.y.b[k], &o.gy[k], ends(o, g, k), ends(o, g, k + kRow), p);
    }
}

/// A square has one diagonal at most: from k to k + 25 where gd > 0, else from k + 1 to k + 24.
template <class Law>
TUFT_INLINE void diagonal_faces(Work& o, const Geometry& g, const Step& p) {
    const float* gd = o.gd.data();
    for (int row = -1; row < kSide; ++row) {
        const int k0 = field_at(-1, row);
        const Ends low = ends(o, g, k0), right = ends(o, g, k0 + 1), left = ends(o, g, k0 + kRow),
                   high = ends(o, g, k0 + kRow + 1);
#pragma GCC ivdep
        for (int x = 0; x < kRow; ++x) {
            const float d = gd[k0 + x];
            const bool up = d > 0;
            const auto one = [up](float a, float b) __attribute__((always_inline)) { return up ? a : b; };
            const End l = low.at(x), r = right.at(x), u = left.at(x), h = high.at(x);
            const End e0{one(l.w, r.w), one(l.s, r.s), one(l.t, r.t), one(l.rate, r.rate), one(l.grain, r.grain)};
            const End e1{one(h.w, u.w), one(h.s, u.s), one(h.t, u.t), one(h.rate, u.rate), one(h.grain, u.grain)};
            const float size = up ? d : -d;
            const float fw = Law::film_flux(size, e0, e1, p);
            Carriers c;
            if constexpr (Law::pores) {
                const float fs = Law::pore_flux(size, e0, e1, p);
                o.up.s[k0 + x] = up ? fs : 0;
                o.down.s[k0 + x] = up ? 0 : fs;
                c = carriers(size, fw, fs, e0, e1, p);
            } else c = carriers(size, fw, e0.t, e1.t, p);
            const float a = c.a * e0.rate, b = c.b * e1.rate;
            o.up.w[k0 + x] = up ? fw : 0;
            o.down.w[k0 + x] = up ? 0 : fw;
            o.up.a[k0 + x] = up ? a : 0;
            o.down.a[k0 + x] = up ? 0 : a;
            o.up.b[k0 + x] = up ? b : 0;
            o.down.b[k0 + x] = up ? 0 : b;
        }
    }
}

template <class Law>
TUFT_INLINE void all_faces(Work& o, const Geometry& g, const Step& p) {
    unpack(o, g);
    straight_faces<Law>(o, g, p);
    if (g.gd) diagonal_faces<Law>(o, g, p);
}
TUFT_CLONES void faces_wet(Work& o, const Geometry& g, const Step& p) {
    if (p.pores > 0) all_faces<Law<true, false>>(o, g, p);
    else all_faces<Law<false, false>>(o, g, p);
}
TUFT_CLONES void faces_dry(Work& o, const Geometry& g, const Step& p) {
    if (p.pores > 0) all_faces<Law<true, true>>(o, g, p);
    else all_faces<Law<false, true>>(o, g, p);
}

struct Least {
    bool dry, thin;  ///< a texel of a chart has no liquid, less than is over a rim
};
/// total and rate, and what there is least of.
TUFT_CLONES Least totals(Work& o, const Geometry& g, float grip, float depth) {
#pragma GCC ivdep
    for (int k = 7; k < kField; ++k) {
        const float t = o.w[k] + o.s[k];
        o.total[k] = t;
        o.rate[k] = rate_of(t, grip);
    }
    std::uint32_t dry = 0, thin = 0;
    for (int row = -1; row <= kSide; ++row) {
        std::uint32_t none = 0, little = 0;
        const int k = field_at(-1, row);
        for (int x = 0; x < kSide + 2; ++x) {
            none |= static_cast<std::uint32_t>(!(o.total[k + x] > 0)) << x;
            little |= static_cast<std::uint32_t>(o.total[k + x] < depth) << x;
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
TUFT_INLINE float into_askew(const float* up, const float* down, int k) {
    return (up[k - kRow - 1] - up[k]) + (down[k - kRow] - down[k - 1]);
}

TUFT_CLONES void divergence(float* __restrict d, const float* __restrict x, const float* __restrict y,
                            const float* __restrict inverse) {
    for (int row = 0; row < kSide; ++row)
        for (int c = 0; c < kSide; ++c)
            d[row * kSide + c] = into(x, y, field_at(c, row)) * inverse[row * kSide + c];
}
TUFT_CLONES void divergence_askew(float* __restrict d, const float* __restrict x, const float* __restrict y,
                                  const float* __restrict up, const float* __restrict down,
                                  const float* __restrict inverse) {
    for (int row = 0; row < kSide; ++row)
        for (int c = 0; c < kSide; ++c) {
            const int k = field_at(c, row);
            d[row * kSide + c] = (into(x, y, k) + into_askew(up, down, k)) * inverse[row * kSide + c];
        }
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
    return positive(a + (d + noise * (scale * 0x1p-23f)));
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

TUFT_CLONES double integral(const float* __restrict air, const float* __restrict inverse) {
    double sums[kLanes] = {};
    for (int t = 0; t < kTexels; t += kLanes)
        for (int lane = 0; lane < kLanes; ++lane) {
            const float area = inverse[t + lane] > 0 ? 1 / inverse[t + lane] : 0;
            sums[lane] += static_cast<double>(air[t + lane] * area);
        }
    double sum = 0;
    for (const double g : sums) sum += g;
    return sum;
}

TUFT_INLINE float carried(const float* a, const float* b, const float* p, int k, int from, int to) {
    return a[k] * p[from] + b[k] * p[to];
}

/// Each flux is computed for both its texels, from the same numbers.
template <bool kAskew, bool kSeams>
TUFT_INLINE void carry(float* __restrict out, const Work& o, const float* __restrict inverse,
                       const float* __restrict noise) {
    const float* p = o.p.data();
    const auto side = [p](const Faces& f, int k, int from, int to) __attribute__((always_inline)) {
        return carried(f.a.data(), f.b.data(), p, k, from, to);
    };
    for (int row = 0; row < kSide; ++row) {
#pragma GCC ivdep
        for (int x = 0; x < kSide; ++x) {
            const int k = field_at(x, row), i = row * kSide + x;
            float d = (side(o.x, k - 1, k - 1, k) - side(o.x, k, k, k + 1)) +
                      (side(o.y, k - kRow, k - kRow, k) - side(o.y, k, k, k + kRow));
            if constexpr (kAskew)
                d += (side(o.up, k - kRow - 1, k - kRow - 1, k) - side(o.up, k, k, k + kRow + 1)) +
                     (side(o.down, k - kRow, k - kRow + 1, k) - side(o.down, k - 1, k, k + kRow - 1));
            d *= inverse[i];
            if constexpr (kSeams) d += o.dp[i];
            out[i] = sum_of(p[k], d, noise[i]);
        }
    }
}
TUFT_CLONES void carry_straight(float* __restrict out, const Work& o, const float* __restrict inverse,
                                const float* __restrict noise, bool seams) {
    if (seams) carry<false, true>(out, o, inverse, noise);
    else carry<false, false>(out, o, inverse, noise);
}
TUFT_CLONES void carry_askew(float* __restrict out, const Work& o, const float* __restrict inverse,
                             const float* __restrict noise, bool seams) {
    if (seams) carry<true, true>(out, o, inverse, noise);
    else carry<true, false>(out, o, inverse, noise);
}

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
    const Least least = totals(work, g, step.grip, step.rim > 0 ? step.rim_depth : 0);
    (least.dry ? faces_dry : faces_wet)(work, g, step);
    if (least.thin) slope_to_rims(work.rim_slope.data(), work.total.data(), g, step.rim_depth);
    else work.rim_slope.fill(0);
    return least.thin;
}

void liquid_changes(Work& work, const Geometry& g, const Step& step) {
    const float* inverse = g.inverse.data();
    const auto change = [&](std::array<float, kTexels>& d, Field Faces::*f) {
        if (g.gd)
            divergence_askew(d.data(), (work.x.*f).data(), (work.y.*f).data(), (work.up.*f).data(),
                             (work.down.*f).data(), inverse);
        else divergence(d.data(), (work.x.*f).data(), (work.y.*f).data(), inverse);
    };
    change(work.dw, &Faces::w);
    if (step.pores > 0) change(work.ds, &Faces::s);
    else work.ds.fill(0);
}

void pigment_step(float* p, const Work& work, const Geometry& g, bool seams, std::uint64_t seed) {
    (g.gd ? carry_askew : carry_straight)(p, work, g.inverse.data(), dither(seed), seams);
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
            t[i] = static_cast<float>(uniform(0x646974, i) - 0.5);
            t[i + 1] = -t[i];
        }
        return t;
    }();
    return &table[hash_bits(seed, 1) % kOffsets & ~std::uint64_t{1}];
}

SeamFlux seam_flux(float weight, float apart, const std::array<float, 2>& w, const std::array<float, 2>& s,
                   const std::array<float, 2>& grain, const Step& step) {
    const End e0{w[0], s[0], w[0] + s[0], 0, grain[0]}, e1{w[1], s[1], w[1] + s[1], 0, grain[1]};
    SeamFlux out;
    out.w = Law<true, true>::film_flux(weight, e0, e1, step);
    if (step.pores > 0) out.s = Law<true, true>::pore_flux(weight, e0, e1, step);
    Carriers c = carriers(weight, out.w, out.s, e0, e1, step);
    const float more = 0.5f * (smaller(larger(1 / larger(apart, kLeast), 1), 2) - 1) * std::abs(out.w + step.passing * out.s);
    c.a += more;
    c.b -= more;
    out.a = c.a * rate_of(e0.t, step.grip);
    out.b = c.b * rate_of(e1.t, step.grip);
    return out;
}

}  // namespace tuft::ink::wet
