#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/random.h"
#include "core/simd.h"
#include "ink/elementary.h"
#include "ink/film/tile/film_tile.h"

// Loops over rows of sixteen that vectorise; faces that are none have conductance 0.
#define TUFT_INLINE inline __attribute__((always_inline))

namespace tuft::ink::wet {
namespace {

constexpr int kLanes = kSide;
constexpr float kLeast = 1e-30f;  // film units: no division by zero in lanes that are dry
constexpr float kMostNear = 8;    // of what smears between two texels, over that of whole texels side by side

TUFT_INLINE std::uint16_t smaller_of(std::uint16_t a, std::uint16_t b) {
    return a < b ? a : b;
}
TUFT_INLINE float rate_of(float total, float grip) {
    return total > 0 ? 1 / larger(larger(total, grip), kLeast) : 0;
}

/// One end of a face: what is there, and what of it counts.
struct End {
    float w, s, t, rate, grain, above, free, carrying, z;
    std::uint16_t flow_area;
};
/// Rows of them.
struct Ends {
    const float *w, *s, *t, *rate, *grain, *above, *free, *carrying, *z;
    const std::uint16_t* flow_area;

    TUFT_INLINE End at(int x) const {
        return {w[x], s[x], t[x], rate[x], grain[x], above[x], free[x], carrying[x], z[x], flow_area[x]};
    }
};
TUFT_INLINE Ends ends(const Work& o, const Geometry& g, int k) {
    return {&o.w[k],     &o.s[k],    &o.total[k],    &o.rate[k], &g.grain[k],
            &o.above[k], &o.free[k], &o.carrying[k], &o.z[k],    &g.flow_area[static_cast<std::size_t>(k)]};
}
/// Fibres hold grains back from what seeps.
TUFT_INLINE float passing_of(const Step& p) {
    return p.pores > 0 ? p.passing : 1;
}
TUFT_INLINE End end_of(float w, float s, float grain, float z, const Step& p) {
    const float t = w + s;
    return {
        w, s, t, rate_of(t, p.grip), grain, positive(w - p.threshold), positive(w - p.retained), w + passing_of(p) * s,
        z, 0};
}

/// What differs between tiles; all give the same numbers where they apply.
template <bool kDry, bool kRelief, bool kLimited>
struct Law {
    /// Conductance g times how much flows.
    static TUFT_INLINE float limited_flow(float g, float flow, float most, const Step& p) {
        if constexpr (kLimited) return smaller(g * flow, most);
        return g * smaller(flow, p.limit.flow);
    }

    /// At most so much of what a texel has leaves it through a face.
    static TUFT_INLINE float most_of(const End& e0, const End& e1, float share, const Step& p) {
        return kLimited ? share * p.limit.most * static_cast<float>(smaller_of(e0.flow_area, e1.flow_area)) : 0;
    }

    /// Flux of liquid on the surface between two texels, film units · mean area.
    static TUFT_INLINE float film_flux(float g, const End& e0, const End& e1, float most, const Step& p) {
        float above = e0.above + e1.above;  // the mean's double
        float over0 = 0, over1 = 0;         // what may leave an end on relief
        if constexpr (kRelief) over0 = positive(e0.w - p.ridge), over1 = positive(e1.w - p.ridge);
        if constexpr (kDry) {
            const float onto0 = e0.t > 0 ? 0 : p.pin * e0.grain, onto1 = e1.t > 0 ? 0 : p.pin * e1.grain;
            const float retained = p.threshold + (onto0 + onto1);
            const float over_retained0 = positive(e0.w - retained), over_retained1 = positive(e1.w - retained);
            above = over_retained0 + over_retained1;
            if constexpr (kRelief) over0 = smaller(over0, over_retained0), over1 = smaller(over1, over_retained1);
        }
        const float level = (0.5f * p.levelling) * (e0.free + e1.free);
        const float plain = limited_flow(g, (0.5f * p.flow) * above + (above > 0 ? level : 0), most, p) * (e0.w - e1.w);
        if constexpr (!kRelief) return plain;
        // Down the liquid's own surface, and no more than its upper end has to give.
        const float drop = (e0.w + e0.z) - (e1.w + e1.z), over = drop > 0 ? over0 : over1;
        const float run = smaller((0.5f * p.flow) * above + p.relief * over, p.limit.flow) * drop,
                    all = p.limit.flow * over;
        float down = g * larger(smaller(run, all), -all);
        if constexpr (kLimited) down = larger(smaller(down, most * over), -(most * over));
        return e0.z + e1.z > 0 ? down : plain;
    }
};

struct Carriers {
    float a, b;
};
TUFT_INLINE Carriers carriers(float g, float flux, const End& e0, const End& e1, const Step& p) {
    const float exchange = p.mixing * g * smaller(e0.carrying, e1.carrying);
    return {positive(flux) + exchange, smaller(flux, 0) - exchange};
}

/// Faces' conductances as `Geometry` holds them: of sides, of diagonals that rise and that fall.
struct Straight {
    static constexpr float share = 1;
    static TUFT_INLINE float unpack(std::uint16_t g) { return static_cast<float>(g) * kConductanceUnit; }
};
struct Rising {
    static constexpr float share = 0.5f;
    static TUFT_INLINE float unpack(std::int16_t g) { return positive(static_cast<float>(g) * kDiagonalUnit); }
};
struct Falling {
    static constexpr float share = 0.5f;
    static TUFT_INLINE float unpack(std::int16_t g) { return positive(-(static_cast<float>(g) * kDiagonalUnit)); }
};

/// Flow through a face, and the pigment that it carries by unit of each end's concentration.
struct FaceFlow {
    float film, a, b;
};

template <class Law, class Kind>
TUFT_INLINE FaceFlow face_flow(float g, const End& e0, const End& e1, const Step& p) {
    const float most = Law::most_of(e0, e1, Kind::share, p);
    const float film = Law::film_flux(g, e0, e1, most, p);
    const Carriers c = carriers(g, film, e0, e1, p);
    return {film, c.a * e0.rate, c.b * e1.rate};
}

/// Sixteen faces between two rows of texels, from texel k on; their flows go into o.through.
template <class Law, class Kind, class Packed>
TUFT_INLINE void faces(Work& o, Faces& f, int k, const Packed* g, const std::array<Ends, 2>& rows, const Step& p) {
    float *w = &o.through[k], *a = &f.a[k], *b = &f.b[k];
    const Ends from = rows[0], to = rows[1];
#pragma GCC ivdep
    for (int x = 0; x < kLanes; ++x) {
        const FaceFlow flow = face_flow<Law, Kind>(Kind::unpack(g[x]), from.at(x), to.at(x), p);
        w[x] = flow.film;
        a[x] = flow.a;
        b[x] = flow.b;
    }
}

/// Faces at the upper sides of a row, and the sum of the flows into its texels through their four sides.
template <class Law, bool kFirst>
TUFT_INLINE void row_of_faces(Work& o, int row, const Geometry& g, float* below, const Step& p) {
    const int k = field_at(0, row);
    const Ends from = ends(o, g, k), to = ends(o, g, k + kRow);
    const std::uint16_t* conductance = &g.gy[(row + 1) * kSide];
    const float* x_w = &o.through[k];
    float *a = &o.y.a[k], *b = &o.y.b[k];
    float* dw = o.dw.data() + row * kSide;
#pragma GCC ivdep
    for (int x = 0; x < kLanes; ++x) {
        const FaceFlow flow = face_flow<Law, Straight>(Straight::unpack(conductance[x]), from.at(x), to.at(x), p);
        a[x] = flow.a;
        b[x] = flow.b;
        if constexpr (!kFirst) dw[x] = (x_w[x - 1] - x_w[x]) + (below[x] - flow.film);
        below[x] = flow.film;
    }
}

/// Adds the flows through the faces of one kind of diagonal: into texel k from k + `first`, out of it at k + `second`.
template <class Law, class Kind>
TUFT_INLINE void diagonals(Work& o, Faces& f, const Geometry& g, int first, int second, const Step& p) {
    for (int k = 0; k < kSquares; k += kLanes)
        faces<Law, Kind>(o, f, k, &(*g.gd)[static_cast<std::size_t>(k)],
                         {ends(o, g, k + first), ends(o, g, k + second)}, p);
    for (int row = 0; row < kSide; ++row) {
        const int k = field_at(0, row);
        const float* w = &o.through[k];
        float* dw = o.dw.data() + row * kSide;
#pragma GCC ivdep
        for (int x = 0; x < kLanes; ++x) dw[x] += w[x - second] - w[x - first];
    }
}

/// A square has one diagonal at most.
template <class Law>
TUFT_INLINE void all_faces(Work& o, const Geometry& g, const Step& step) {
    const Step p = step;  // where nothing that is written could change it
    for (int k = 0; k < kSide * kRow; k += kLanes)
        faces<Law, Straight>(o, o.x, kRow + k, &g.gx[static_cast<std::size_t>(k)],
                             {ends(o, g, kRow + k), ends(o, g, kRow + k + 1)}, p);
    alignas(64) float below[kLanes];
    row_of_faces<Law, true>(o, -1, g, below, p);
    for (int row = 0; row < kSide; ++row) row_of_faces<Law, false>(o, row, g, below, p);
    if (g.ups) diagonals<Law, Rising>(o, o.up, g, 0, kRow + 1, p);
    if (g.downs) diagonals<Law, Falling>(o, o.down, g, 1, kRow, p);
}
template <bool kDry, bool kRelief>
TUFT_INLINE void faces_of(Work& o, const Geometry& g, const Step& p) {
    all_faces<Law<kDry, kRelief, false>>(o, g, p);
}
template <bool kDry, bool kRelief>
TUFT_INLINE void limited_faces_of(Work& o, const Geometry& g, const Step& p) {
    all_faces<Law<kDry, kRelief, true>>(o, g, p);
}
TUFT_CLONES void faces_wet(Work& o, const Geometry& g, const Step& p) {
    faces_of<false, false>(o, g, p);
}
TUFT_CLONES void faces_dry(Work& o, const Geometry& g, const Step& p) {
    faces_of<true, false>(o, g, p);
}
TUFT_CLONES void faces_on_relief(Work& o, const Geometry& g, const Step& p) {
    faces_of<true, true>(o, g, p);
}
TUFT_CLONES void limited_faces_wet(Work& o, const Geometry& g, const Step& p) {
    limited_faces_of<false, false>(o, g, p);
}
TUFT_CLONES void limited_faces_dry(Work& o, const Geometry& g, const Step& p) {
    limited_faces_of<true, false>(o, g, p);
}
TUFT_CLONES void limited_faces_on_relief(Work& o, const Geometry& g, const Step& p) {
    limited_faces_of<true, true>(o, g, p);
}

/// What faces need of all texels and those round them; returns the least liquid.
TUFT_CLONES float levels(Work& o, const Step& step) {
    const Step p = step;
    const float passing = passing_of(p);
    alignas(64) float least[kLanes];
    for (float& l : least) l = o.w[0] + o.s[0];
    constexpr int kAll = kRow * kRow / kLanes * kLanes;
    for (int k = 0; k < kField; k += kLanes) {
        const float *w = &o.w[k], *s = &o.s[k];
        float *total = &o.total[k], *rate = &o.rate[k], *above = &o.above[k], *free = &o.free[k],
              *carrying = &o.carrying[k];
#pragma GCC ivdep
        for (int x = 0; x < kLanes; ++x) {
            const float t = w[x] + s[x];
            total[x] = t;
            rate[x] = rate_of(t, p.grip);
            above[x] = positive(w[x] - p.threshold);
            free[x] = positive(w[x] - p.retained);
            carrying[x] = w[x] + passing * s[x];
            if (k < kAll) least[x] = smaller(least[x], t);
        }
    }
    float all = least[0];
    for (const float l : least) all = smaller(all, l);
    for (int k = kAll; k < kRow * kRow; ++k) all = smaller(all, o.total[k]);
    return all;
}

struct Least {
    bool dry, thin;  ///< a texel of a chart has no liquid, less than is over a rim
};
TUFT_CLONES Least find_rims(const Work& o, const Geometry& g, float depth) {
    std::uint32_t dry = 0, thin = 0;
    for (int row = -1; row <= kSide; ++row) {
        std::uint32_t none = 0, little = 0;
        const int k = field_at(-1, row);
        for (int x = 0; x < kSide + 2; ++x) {
            const float total = o.total[k + x];
            none |= static_cast<std::uint32_t>(!(total > 0)) << x;
            little |= static_cast<std::uint32_t>(total < depth) << x;
        }
        dry |= g.valid[static_cast<std::size_t>(row + 1)] & none;
        thin |= g.valid[static_cast<std::size_t>(row + 1)] & little;
    }
    return {dry != 0, thin != 0};
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

struct Settled {
    float most_w = 0, most_s = 0, least = 0;  ///< the last: of both together
    double air = 0;                           ///< what went into the air, film units · mean area
};
/// Texels' new liquid, drying. Beside charts there is no air; 0 / 0 there, thrown away or not, is no
/// number, which this file's options forbid (AVX2 then lost other lanes).
TUFT_CLONES Settled settle(float* __restrict w, float* __restrict s, const Work& o, const float* __restrict inverse,
                           const float* __restrict noise, const float* __restrict factor, const Step& step) {
    const float pores = step.pores;
    const float evaporation = step.drying.evaporation, rim = step.drying.rim;
    alignas(64) float most_w[kLanes] = {}, most_s[kLanes] = {}, air[kLanes] = {}, least[kLanes];
    for (float& l : least) l = std::numeric_limits<float>::max();
    for (int row = 0; row < kSide; ++row) {
#pragma GCC ivdep
        for (int x = 0; x < kSide; ++x) {
            const int i = row * kSide + x, k = field_at(x, row);
            float w1 = sum_of(o.w[k], o.dw[i] * inverse[i], noise[i]),
                  s1 = sum_of(o.s[k], o.ds[i] * inverse[i], noise[i]);
            const float over = positive(s1 - pores);  // by rounding
            s1 -= over;
            w1 += over;
            const float all = (evaporation + rim * o.rim_slope[i]) * factor[i];
            const float from_w = smaller(w1, all), from_s = smaller(s1, all - from_w);
            // What goes is what is less after it: sums are rounded.
            const float w2 = w1 - from_w, s2 = s1 - from_s;
            air[x] += ((w1 - w2) + (s1 - s2)) / larger(inverse[i], kLeast);
            w1 = w2;
            s1 = s2;
            w[i] = w1;
            s[i] = s1;
            const float total = w1 + s1;
            least[x] = smaller(least[x], total);
            most_w[x] = larger(most_w[x], w1);
            most_s[x] = larger(most_s[x], s1);
        }
    }
    Settled out{.least = least[0]};
    for (int lane = 0; lane < kLanes; ++lane) {
        out.most_w = larger(out.most_w, most_w[lane]);
        out.most_s = larger(out.most_s, most_s[lane]);
        out.least = smaller(out.least, least[lane]);
        out.air += static_cast<double>(air[lane]);
    }
    return out;
}

/// Whether a texel had liquid and has none.
TUFT_CLONES bool any_closed(const float* w, const float* s, const Work& o) {
    float closed[kLanes] = {};
    for (int row = 0; row < kSide; ++row)
        for (int x = 0; x < kSide; ++x) {
            const int i = row * kSide + x;
            const float was = o.total[field_at(x, row)], is = w[i] + s[i];
            closed[x] = larger(closed[x], was > 0 && !(is > 0) ? 1.0f : 0.0f);
        }
    float any = 0;
    for (const float c : closed) any = larger(any, c);
    return any > 0;
}

TUFT_INLINE float pigment_flow(const Faces& f, const float* p, int k, int from, int to) {
    return f.a[k] * p[from] + f.b[k] * p[to];
}

/// Each flux is computed from the same numbers for both its texels, upwards once: the row above takes it from `below`.
/// (Written down and read again one to the side, they would be twice as slow.)
template <bool kUp, bool kDown, bool kSeams>
TUFT_INLINE void transport(float* __restrict out, const Work& o, const float* __restrict inverse,
                           const float* __restrict noise) {
    const float* p = o.p.data();
    alignas(64) float below[kSide];
    for (int x = 0; x < kSide; ++x) {
        const int k = field_at(x, -1);
        below[x] = pigment_flow(o.y, p, k, k, k + kRow);
    }
    for (int row = 0; row < kSide; ++row) {
#pragma GCC ivdep
        for (int x = 0; x < kSide; ++x) {
            const int k = field_at(x, row), i = row * kSide + x;
            const float above = pigment_flow(o.y, p, k, k, k + kRow);
            float d = (pigment_flow(o.x, p, k - 1, k - 1, k) - pigment_flow(o.x, p, k, k, k + 1)) + (below[x] - above);
            below[x] = above;
            if constexpr (kUp)
                d += pigment_flow(o.up, p, k - kRow - 1, k - kRow - 1, k) - pigment_flow(o.up, p, k, k, k + kRow + 1);
            if constexpr (kDown)
                d += pigment_flow(o.down, p, k - kRow, k - kRow + 1, k) -
                     pigment_flow(o.down, p, k - 1, k, k + kRow - 1);
            if constexpr (kSeams) d += o.dp[i];
            out[i] = sum_of(p[k], d * inverse[i], noise[i]);
        }
    }
}
template <bool kSeams>
TUFT_INLINE void transport_all(float* __restrict out, const Work& o, const Geometry& g, const float* __restrict noise) {
    const float* inverse = g.inverse.data();
    if (g.ups && g.downs)
        transport<true, true, kSeams>(out, o, inverse, noise);
    else if (g.ups)
        transport<true, false, kSeams>(out, o, inverse, noise);
    else if (g.downs)
        transport<false, true, kSeams>(out, o, inverse, noise);
    else
        transport<false, false, kSeams>(out, o, inverse, noise);
}
TUFT_CLONES void transport_inside(float* out, const Work& o, const Geometry& g, const float* noise) {
    transport_all<false>(out, o, g, noise);
}
TUFT_CLONES void transport_over_seams(float* out, const Work& o, const Geometry& g, const float* noise) {
    transport_all<true>(out, o, g, noise);
}

template <bool kLimited>
TUFT_INLINE void seam_faces(SeamLanes& l, const Step& step) {
    using Here = Law<true, true, kLimited>;
    const Step p = step;
#pragma GCC ivdep
    for (int x = 0; x < kLanes; ++x) {
        const End e0 = end_of(l.w[0][x], l.s[0][x], l.grain[0][x], l.z[0][x], p),
                  e1 = end_of(l.w[1][x], l.s[1][x], l.grain[1][x], l.z[1][x], p);
        const float g = l.weight[x], most = p.limit.most_of_link * l.flow_area[x],
                    w = Here::film_flux(g, e0, e1, most, p);
        const Carriers c = carriers(g, w, e0, e1, p);
        // Nearer cells' middles lie farther apart than their texels, by whose distance their amounts differ: they mix
        // more, by no more than what could flow.
        const float near = smaller(larger(1 / larger(l.apart[x] * l.apart[x], kLeast), 1), kMostNear) - 1;
        const float more = 0.5f * smaller(near * std::abs(w), p.limit.flow * g * smaller(e0.t, e1.t));
        l.through[x] = w;
        l.a[x] = (c.a + more) * e0.rate;
        l.b[x] = (c.b - more) * e1.rate;
    }
}
TUFT_CLONES void sixteen_seams(SeamLanes& l, const Step& p) {
    seam_faces<false>(l, p);
}
TUFT_CLONES void sixteen_limited_seams(SeamLanes& l, const Step& p) {
    seam_faces<true>(l, p);
}

TUFT_CLONES void gather_rows(float* __restrict to, const std::array<const float*, 9>& planes) {
    constexpr int kEnd = kTexels - kSide;
    const auto row = [to](int r, const float* left, const float* here, const float* right)
        __attribute__((always_inline)) {
        float* at = to + field_at(0, r);
        at[-1] = *left;
        std::memcpy(at, here, kSide * sizeof(float));
        at[kSide] = *right;
    };
    row(-1, planes[0] + kTexels - 1, planes[1] + kEnd, planes[2] + kEnd);
    for (int r = 0; r < kSide; ++r)
        row(r, planes[3] + r * kSide + kSide - 1, planes[4] + r * kSide, planes[5] + r * kSide);
    row(kSide, planes[6] + kSide - 1, planes[7], planes[8]);
}

}  // namespace

void gather_field(Field& field, const std::array<const float*, 9>& planes) {
    gather_rows(field.data(), planes);
}

void rim_slopes(float* slope, const Field& total, const Geometry& g, float depth) {
    slope_to_rims(slope, total.data(), g, depth);
}

bool fluxes(Work& work, const Geometry& g, const Step& step) {
    const float depth = step.drying.rim > 0 ? step.drying.rim_depth : 0, least = levels(work, step);
    const Least rims = least > 0 && least >= depth ? Least{} : find_rims(work, g, depth);
    if (step.limit.most > 0)
        (work.on_relief ? limited_faces_on_relief : rims.dry ? limited_faces_dry : limited_faces_wet)(work, g, step);
    else
        (work.on_relief ? faces_on_relief : rims.dry ? faces_dry : faces_wet)(work, g, step);
    work.ds.fill(0);
    if (rims.thin)
        slope_to_rims(work.rim_slope.data(), work.total.data(), g, step.drying.rim_depth);
    else if (work.sloping)
        work.rim_slope.fill(0);
    work.sloping = rims.thin;
    return rims.thin;
}

void pigment_step(float* p, const Work& work, const Geometry& g, bool seams, std::uint64_t seed) {
    (seams ? transport_over_seams : transport_inside)(p, work, g, dither(seed));
}

Outcome local_step(const LocalFilms& films, const Work& work, const Geometry& g, const Step& step, std::uint64_t seed) {
    static const auto kAlike = [] {
        Plane ones;
        ones.fill(1);
        return ones;
    }();
    float *w = films.w, *s = films.s;
    const Settled settled =
        settle(w, s, work, g.inverse.data(), dither(seed), films.drying ? films.drying : kAlike.data(), step);
    Outcome out{.most_w = settled.most_w, .most_s = settled.most_s, .evaporated = settled.air};
    if (settled.least > 0) {
        out.sides = 15;
        return out;
    }
    const auto wet = [w, s](int i) { return w[i] + s[i] > 0; };
    out.closing = any_closed(w, s, work);
    for (int i = 0; out.closing && i < kTexels; ++i) films.closing[i] = work.total[field_of(i)] > 0 && !wet(i);
    bool first = false, last = false, left = false, right = false;
    for (int i = 0; i < kSide; ++i) {
        first |= wet(i);
        last |= wet(kTexels - kSide + i);
        left |= wet(i * kSide);
        right |= wet(i * kSide + kSide - 1);
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

void seam_fluxes(std::span<SeamLanes> lanes, const Step& step) {
    for (SeamLanes& l : lanes) (step.limit.most > 0 ? sixteen_limited_seams : sixteen_seams)(l, step);
}

}  // namespace tuft::ink::wet
