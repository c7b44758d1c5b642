#include <algorithm>
#include <bit>
#include <cmath>

#include "core/random.h"
#include "ink/film_tile.h"
#include "ink/simd.h"

// One flat loop per quantity over the whole field, so that they vectorise; faces that are none
// have conductance 0.
namespace tuft::ink::wet {
namespace {

constexpr int kLanes = 16;

inline float larger(float a, float b) { return a > b ? a : b; }
inline float smaller(float a, float b) { return a < b ? a : b; }
inline float positive(float a) { return a > 0 ? a : 0; }

/// Flux of liquid on the surface between two texels, film units · mean area.
inline float film_flux(float g, float w0, float w1, float t0, float t1, float grain0, float grain1,
                       const Step& p) {
    const float onto0 = t0 > 0 ? 0 : p.pin * grain0, onto1 = t1 > 0 ? 0 : p.pin * grain1;
    const float held = p.threshold + (onto0 + onto1);
    const float above = 0.5f * (positive(w0 - held) + positive(w1 - held));
    const float free = 0.5f * (positive(w0 - p.hold) + positive(w1 - p.hold));
    return g * smaller(p.flow * above + (above > 0 ? p.levelling * free : 0), p.limit) * (w0 - w1);
}

inline float pore_flux(float g, float s0, float s1, const Step& p) {
    return g * smaller(p.flow * (0.5f * (s0 + s1)), p.limit) * (s0 - s1);
}

/// Of weight: upwind, cubic in the thickness.
inline float weight_flux(float slope, float w0, float w1, float t0, float t1, float grain0,
                         float grain1, const Step& p) {
    const float from = slope > 0 ? w0 : w1;
    const float onto = (slope > 0 ? t1 : t0) > 0 ? 0 : 2 * p.pin * (slope > 0 ? grain1 : grain0);
    const float free = positive(from - (p.hold + onto));
    const float speed = p.weight * (free * free) * slope;
    return (speed > p.run ? p.run : (speed < -p.run ? -p.run : speed)) * from;
}

struct Carriers {
    float a, b;
};
inline Carriers carriers(float g, float flux, float t0, float t1, const Step& p) {
    const float exchange = p.mixing * g * smaller(t0, t1);
    return {positive(flux) + exchange, -positive(-flux) - exchange};
}

TUFT_CLONES void totals(float* __restrict t, const float* __restrict w, const float* __restrict s) {
    for (int k = 0; k < kPadded; ++k) t[k] = w[k] + s[k];
}

template <int kStep>
inline __attribute__((always_inline)) void film_faces(float* __restrict f, const float* __restrict g,
                                                      const float* __restrict w,
                                                      const float* __restrict t,
                                                      const float* __restrict grain, const Step& p) {
    for (int k = 0; k < kField; ++k)
        f[k] = film_flux(g[k], w[k], w[k + kStep], t[k], t[k + kStep], grain[k], grain[k + kStep], p);
}
template <int kStep>
inline __attribute__((always_inline)) void pore_faces(float* __restrict f, const float* __restrict g,
                                                      const float* __restrict s, const Step& p) {
    for (int k = 0; k < kField; ++k) f[k] = pore_flux(g[k], s[k], s[k + kStep], p);
}
template <int kStep>
inline __attribute__((always_inline)) void weight_faces(float* __restrict f, const float* __restrict slope,
                                                        const float* __restrict w,
                                                        const float* __restrict t,
                                                        const float* __restrict grain, const Step& p) {
    for (int k = 0; k < kField; ++k)
        f[k] += weight_flux(slope[k], w[k], w[k + kStep], t[k], t[k + kStep], grain[k], grain[k + kStep], p);
}
template <int kStep>
inline __attribute__((always_inline)) void carrier_faces(float* __restrict a, float* __restrict b,
                                                         const float* __restrict g,
                                                         const float* __restrict fw,
                                                         const float* __restrict fs,
                                                         const float* __restrict t, const Step& p) {
    for (int k = 0; k < kField; ++k) {
        const Carriers c = carriers(g[k], fw[k] + fs[k], t[k], t[k + kStep], p);
        a[k] = c.a;
        b[k] = c.b;
    }
}

TUFT_CLONES void faces_x(Work& o, const Geometry& g, const Step& p) {
    film_faces<1>(o.fw_x.data(), g.gx.data(), o.w.data(), o.total.data(), g.grain.data(), p);
}
TUFT_CLONES void faces_y(Work& o, const Geometry& g, const Step& p) {
    film_faces<kRow>(o.fw_y.data(), g.gy.data(), o.w.data(), o.total.data(), g.grain.data(), p);
}
TUFT_CLONES void pores_xy(Work& o, const Geometry& g, const Step& p) {
    pore_faces<1>(o.fs_x.data(), g.gx.data(), o.s.data(), p);
    pore_faces<kRow>(o.fs_y.data(), g.gy.data(), o.s.data(), p);
}
TUFT_CLONES void weight_x(Work& o, const Geometry& g, const Slopes& slopes, const Step& p) {
    weight_faces<1>(o.fw_x.data(), slopes.x.data(), o.w.data(), o.total.data(), g.grain.data(), p);
}
TUFT_CLONES void weight_y(Work& o, const Geometry& g, const Slopes& slopes, const Step& p) {
    weight_faces<kRow>(o.fw_y.data(), slopes.y.data(), o.w.data(), o.total.data(), g.grain.data(), p);
}
TUFT_CLONES void carriers_xy(Work& o, const Geometry& g, const Step& p) {
    carrier_faces<1>(o.ax.data(), o.bx.data(), g.gx.data(), o.fw_x.data(), o.fs_x.data(), o.total.data(), p);
    carrier_faces<kRow>(o.ay.data(), o.by.data(), g.gy.data(), o.fw_y.data(), o.fs_y.data(), o.total.data(), p);
}

/// A square has one diagonal at most: from k to k + 19 where gd > 0, else from k + 1 to k + 18.
TUFT_CLONES void diagonals(float* __restrict fw, float* __restrict fs, float* __restrict a,
                           float* __restrict b, const float* __restrict gd,
                           const float* __restrict w, const float* __restrict s,
                           const float* __restrict t, const float* __restrict grain, const Step& p) {
    for (int k = 0; k < kField; ++k) {
        const bool up = gd[k] > 0;
        const float g = up ? gd[k] : -gd[k];
        const float w0 = up ? w[k] : w[k + 1], w1 = up ? w[k + kRow + 1] : w[k + kRow];
        const float s0 = up ? s[k] : s[k + 1], s1 = up ? s[k + kRow + 1] : s[k + kRow];
        const float t0 = up ? t[k] : t[k + 1], t1 = up ? t[k + kRow + 1] : t[k + kRow];
        const float n0 = up ? grain[k] : grain[k + 1], n1 = up ? grain[k + kRow + 1] : grain[k + kRow];
        fw[k] = film_flux(g, w0, w1, t0, t1, n0, n1, p);
        fs[k] = pore_flux(g, s0, s1, p);
        const Carriers c = carriers(g, fw[k] + fs[k], t0, t1, p);
        a[k] = c.a;
        b[k] = c.b;
    }
}

TUFT_CLONES void divergence(float* __restrict d, const float* __restrict fx, const float* __restrict fy,
                            const float* __restrict inverse) {
    for (int row = 0; row < kSide; ++row) {
        const int k0 = (row + 1) * kRow + 1;
        for (int x = 0; x < kSide; ++x) {
            const int k = k0 + x;
            d[row * kSide + x] = ((fx[k - 1] - fx[k]) + (fy[k - kRow] - fy[k])) * inverse[row * kSide + x];
        }
    }
}

/// What diagonals bring: out of k and into k + 19, or out of k + 1 and into k + 18.
TUFT_CLONES void diagonal_divergence(float* __restrict d, const float* __restrict f,
                                     const float* __restrict gd, const float* __restrict inverse) {
    for (int row = 0; row < kSide; ++row) {
        const int k0 = (row + 1) * kRow + 1;
        for (int x = 0; x < kSide; ++x) {
            const int k = k0 + x;
            const float low = gd[k] > 0 ? -f[k] : 0, high = gd[k - kRow - 1] > 0 ? f[k - kRow - 1] : 0;
            const float right = gd[k - 1] < 0 ? -f[k - 1] : 0, left = gd[k - kRow] < 0 ? f[k - kRow] : 0;
            d[row * kSide + x] += ((low + high) + (right + left)) * inverse[row * kSide + x];
        }
    }
}

TUFT_CLONES void count_dry(float* __restrict n, const float* __restrict t, const float* __restrict gx,
                           const float* __restrict gy) {
    for (int row = 0; row < kSide; ++row) {
        const int k0 = (row + 1) * kRow + 1;
        for (int x = 0; x < kSide; ++x) {
            const int k = k0 + x;
            const float right = t[k + 1] > 0 || !(gx[k] > 0) ? 0.0f : 1.0f;
            const float left = t[k - 1] > 0 || !(gx[k - 1] > 0) ? 0.0f : 1.0f;
            const float up = t[k + kRow] > 0 || !(gy[k] > 0) ? 0.0f : 1.0f;
            const float down = t[k - kRow] > 0 || !(gy[k - kRow] > 0) ? 0.0f : 1.0f;
            n[row * kSide + x] = (right + left) + (up + down);
        }
    }
}

TUFT_CLONES void divide(float* __restrict c, const float* __restrict p, const float* __restrict t) {
    for (int k = 0; k < kPadded; ++k) {
        const float whole = t[k] > 0 ? t[k] : 1;
        c[k] = t[k] > 0 ? p[k] / whole : 0;
    }
}

template <int kStep>
inline __attribute__((always_inline)) void carried(float* __restrict f, const float* __restrict a,
                                                   const float* __restrict b, const float* __restrict c) {
    for (int k = 0; k < kField; ++k) f[k] = a[k] * c[k] + b[k] * c[k + kStep];
}
TUFT_CLONES void carried_xy(float* __restrict x, float* __restrict y, const Work& o) {
    carried<1>(x, o.ax.data(), o.bx.data(), o.c.data());
    carried<kRow>(y, o.ay.data(), o.by.data(), o.c.data());
}
TUFT_CLONES void carried_d(float* __restrict f, const float* __restrict a, const float* __restrict b,
                           const float* __restrict c, const float* __restrict gd) {
    for (int k = 0; k < kField; ++k) {
        const float c0 = gd[k] > 0 ? c[k] : c[k + 1], c1 = gd[k] > 0 ? c[k + kRow + 1] : c[k + kRow];
        f[k] = a[k] * c0 + b[k] * c1;
    }
}

/// a + d, rounded up or down by chance; never below 0.
inline float sum_of(float a, float d, float noise) {
    const float scale = std::bit_cast<float>(std::bit_cast<std::uint32_t>(a) & 0x7f800000u);
    return positive(a + (d + noise * (scale * 0x1p-23f)));
}

/// A texel's new liquid, soaking and drying; `air`: what went into the air.
TUFT_CLONES void settle(float* __restrict w, float* __restrict s, float* __restrict air,
                        const float* __restrict w_field, const float* __restrict s_field,
                        const float* __restrict dw, const float* __restrict ds,
                        const float* __restrict dry, const float* __restrict inverse,
                        const float* __restrict noise, const Step& step) {
    const float soak = step.soak, pores = step.pores, per_pores = pores > 0 ? 1 / pores : 0;
    const float evaporation = step.evaporation, rim = step.rim;
    for (int row = 0; row < kSide; ++row)
        for (int x = 0; x < kSide; ++x) {
            const int i = row * kSide + x, k = (row + 1) * kRow + 1 + x;
            float w1 = sum_of(w_field[k], dw[i], noise[i]), s1 = sum_of(s_field[k], ds[i], noise[i]);
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
            const float all = evaporation + rim * dry[i] * inverse[i];
            const float from_w = smaller(w1, all), from_s = smaller(s1, all - from_w);
            w[i] = w1 - from_w;
            s[i] = s1 - from_s;
            air[i] = from_w + from_s;
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

/// Greatest liquids, and in `closed` 1 for texels that had liquid and have none.
TUFT_CLONES void extremes(float* __restrict most, const float* __restrict w, const float* __restrict s,
                          const float* __restrict total, float* __restrict closed) {
    float most_w[kLanes] = {}, most_s[kLanes] = {}, any[kLanes] = {};
    for (int row = 0; row < kSide; ++row)
        for (int x = 0; x < kSide; ++x) {
            const int i = row * kSide + x;
            most_w[x] = larger(most_w[x], w[i]);
            most_s[x] = larger(most_s[x], s[i]);
            const float was = total[(row + 1) * kRow + 1 + x] > 0 ? 1.0f : 0.0f;
            const float is = w[i] + s[i] > 0 ? 1.0f : 0.0f;
            closed[i] = was * (1 - is);
            any[x] = larger(any[x], closed[i]);
        }
    for (int lane = 0; lane < kLanes; ++lane) {
        most[0] = larger(most[0], most_w[lane]);
        most[1] = larger(most[1], most_s[lane]);
        most[2] = larger(most[2], any[lane]);
    }
}

TUFT_CLONES void add_dithered(float* __restrict p, const float* __restrict field, const float* __restrict dp,
                              const float* __restrict noise) {
    for (int row = 0; row < kSide; ++row)
        for (int x = 0; x < kSide; ++x) {
            const int i = row * kSide + x;
            p[i] = sum_of(field[(row + 1) * kRow + 1 + x], dp[i], noise[i]);
        }
}

}  // namespace

void fluxes(Work& work, const Geometry& g, const Slopes* slopes, const Step& step) {
    totals(work.total.data(), work.w.data(), work.s.data());
    faces_x(work, g, step);
    faces_y(work, g, step);
    if (step.pores > 0) {
        pores_xy(work, g, step);
    } else {
        work.fs_x.fill(0);
        work.fs_y.fill(0);
    }
    if (slopes) {
        weight_x(work, g, *slopes, step);
        weight_y(work, g, *slopes, step);
    }
    carriers_xy(work, g, step);
    if (g.diagonals)
        diagonals(work.fw_d.data(), work.fs_d.data(), work.ad.data(), work.bd.data(), g.gd.data(),
                  work.w.data(), work.s.data(), work.total.data(), g.grain.data(), step);
}

void liquid_changes(Work& work, const Geometry& g) {
    divergence(work.dw.data(), work.fw_x.data(), work.fw_y.data(), g.inverse.data());
    divergence(work.ds.data(), work.fs_x.data(), work.fs_y.data(), g.inverse.data());
    if (g.diagonals) {
        diagonal_divergence(work.dw.data(), work.fw_d.data(), g.gd.data(), g.inverse.data());
        diagonal_divergence(work.ds.data(), work.fs_d.data(), g.gd.data(), g.inverse.data());
    }
    count_dry(work.dry_neighbours.data(), work.total.data(), g.gx.data(), g.gy.data());
}

void concentrations(Work& work, const Field& p) { divide(work.c.data(), p.data(), work.total.data()); }

void pigment_changes(Work& work, const Geometry& g) {
    alignas(64) Field x, y;
    carried_xy(x.data(), y.data(), work);
    divergence(work.dp.data(), x.data(), y.data(), g.inverse.data());
    if (g.diagonals) {
        carried_d(x.data(), work.ad.data(), work.bd.data(), work.c.data(), g.gd.data());
        diagonal_divergence(work.dp.data(), x.data(), g.gd.data(), g.inverse.data());
    }
}

Outcome local_step(float* w, float* s, const Work& work, const Geometry& g, const Step& step,
                   std::uint64_t seed, std::uint8_t* closing) {
    Outcome out;
    alignas(64) std::array<float, kTexels> air, closed;
    settle(w, s, air.data(), work.w.data(), work.s.data(), work.dw.data(), work.ds.data(),
           work.dry_neighbours.data(), g.inverse.data(), dither(seed), step);
    out.evaporated = integral(air.data(), g.inverse.data());
    std::array<float, 3> most{};
    extremes(most.data(), w, s, work.total.data(), closed.data());
    out.most_w = most[0];
    out.most_s = most[1];
    out.closing = most[2] > 0;
    if (out.closing)
        for (int t = 0; t < kTexels; ++t) closing[t] = closed[t] > 0;
    for (int i = 0; i < kSide; ++i) {
        const int last = kTexels - kSide;
        out.sides |= w[i] + s[i] > 0 ? 1 : 0;
        out.sides |= w[last + i] + s[last + i] > 0 ? 2 : 0;
        out.sides |= w[i * kSide] + s[i * kSide] > 0 ? 4 : 0;
        out.sides |= w[i * kSide + kSide - 1] + s[i * kSide + kSide - 1] > 0 ? 8 : 0;
    }
    return out;
}

void add_pigment(float* p, const Work& work, const Field& before, std::uint64_t seed) {
    add_dithered(p, before.data(), work.dp.data(), dither(seed));
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

SeamFlux seam_flux(float weight, float slope, const std::array<float, 2>& w,
                   const std::array<float, 2>& s, const std::array<float, 2>& grain,
                   const Step& step) {
    const float t0 = w[0] + s[0], t1 = w[1] + s[1];
    SeamFlux out;
    out.w = film_flux(weight, w[0], w[1], t0, t1, grain[0], grain[1], step);
    if (slope != 0) out.w += weight_flux(slope, w[0], w[1], t0, t1, grain[0], grain[1], step);
    if (step.pores > 0) out.s = pore_flux(weight, s[0], s[1], step);
    const Carriers c = carriers(weight, out.w + out.s, t0, t1, step);
    out.a = c.a;
    out.b = c.b;
    return out;
}

}  // namespace tuft::ink::wet
