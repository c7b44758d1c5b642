#include <algorithm>
#include <cmath>
#include <limits>

#include "core/simd.h"
#include "ink/elementary.h"
#include "ink/film/tension.h"

// Loops over rows of sixteen that vectorise; faces that are none have conductance 0.
#define TUFT_INLINE inline __attribute__((always_inline))

namespace tuft::ink::wet {
namespace {

constexpr float kThin = 1e-30f;        // film units: no division by zero in lanes that are dry
constexpr float kMostOfTexel = 0.12f;  // through a side, half of it through a corner: of 4 and 4, 0.72
constexpr float kMostOfLinks = 0.25f;  // over a seam; 0.4 of the above through the texel's other sides
/// Curvature of ripples: Σ of two differences over the thickness, of texels, blocks of 2 × 2 and of 4 × 4 in a row.
struct Limits {
    float texels, pairs, blocks;
};
// Ripples of 4 to 160 texels level down to an amplitude of 1 %. Nobody sees so little in an ink. Beside contact lines,
// which draw liquid in as they dry, ripples of 4 to 40 texels level down to 3 to 10 %.
constexpr Limits kInside{5e-3f, 2e-3f, 2.5e-4f}, kBesideRims{0.1f, 6e-2f, 3e-2f};

TUFT_INLINE float conductance_of(std::uint16_t g) {
    return static_cast<float>(g) * kConductanceUnit;
}

/// Σ over the neighbours of a row's cell x of what `face` has there times `q`.
template <int N>
struct Row {
    const float *left, *below, *above;
    const float *up0, *up1, *down0, *down1;  // squares: above right, below left; above left, below right

    TUFT_INLINE float sum(const float* q, int x) const {
        constexpr int kRow = Grid<N>::kRow;
        return (left[x] * q[x - 1] + left[x + 1] * q[x + 1]) + (below[x] * q[x - kRow] + above[x] * q[x + kRow]);
    }
    TUFT_INLINE float diagonals(const float* q, int x) const {
        constexpr int kRow = Grid<N>::kRow;
        return (up0[x] * q[x + kRow + 1] + up1[x] * q[x - kRow - 1]) +
               (down0[x] * q[x + kRow - 1] + down1[x] * q[x - kRow + 1]);
    }
    TUFT_INLINE float all(int x) const { return (left[x] + left[x + 1]) + (below[x] + above[x]); }
    TUFT_INLINE float all_diagonals(int x) const { return (up0[x] + up1[x]) + (down0[x] + down1[x]); }
};
template <int N>
TUFT_INLINE Row<N> row_of(const float* x_faces, const float* y_faces, const float* up, const float* down, int row) {
    constexpr int kRow = Grid<N>::kSquareRow;
    Row<N> r{x_faces + row * kRow, y_faces + row * N, y_faces + (row + 1) * N, nullptr, nullptr, nullptr, nullptr};
    if (!up) return r;
    r.up0 = up + (row + 1) * kRow + 1, r.up1 = up + row * kRow;
    r.down0 = down + (row + 1) * kRow, r.down1 = down + row * kRow + 1;
    return r;
}

template <int N, bool kSquares>
TUFT_INLINE void half_sweep(Grid<N>& g, int colour) {
    const auto* squares = g.squares.get();
    for (int row = 0; row < N; ++row) {
        const Row<N> c = row_of<N>(g.cx.data(), g.cy.data(), kSquares ? squares->c_up.data() : nullptr,
                                   kSquares ? squares->c_down.data() : nullptr, row);
        const Row<N> m = row_of<N>(g.mx.data(), g.my.data(), kSquares ? squares->m_up.data() : nullptr,
                                   kSquares ? squares->m_down.data() : nullptr, row);
        float *v = &g.v[static_cast<std::size_t>(Grid<N>::at(0, row))],
              *p = &g.p[static_cast<std::size_t>(Grid<N>::at(0, row))];
        const auto i0 = static_cast<std::size_t>(row * N);
        const float *f = &g.f[i0], *e = &g.e[i0], *inverse = &g.inverse[i0], *all_c = &g.conductances[i0],
                    *all_m = &g.mobilities[i0], *beyond_v = &g.beyond_v[i0], *beyond_p = &g.beyond_p[i0];
#pragma GCC ivdep
        for (int x = 0; x < N; ++x) {
            float s = c.sum(v, x), q = m.sum(p, x);
            if constexpr (kSquares) s += c.diagonals(v, x), q += m.diagonals(p, x);
            const float from_v = (s * inverse[x] + beyond_v[x]) - e[x], from_p = (q * inverse[x] + beyond_p[x]) + f[x];
            const float next = (from_p + all_m[x] * from_v) / (1 + all_m[x] * all_c[x]);
            const bool turn = ((x + row) & 1) == colour;
            const float next_p = all_c[x] * next - from_v;
            v[x] = turn ? next : v[x];
            p[x] = turn ? next_p : p[x];
        }
    }
}
template <int N>
TUFT_INLINE void sweep(Grid<N>& g) {
    for (int colour = 0; colour < 2; ++colour)
        if (g.squares)
            half_sweep<N, true>(g, colour);
        else
            half_sweep<N, false>(g, colour);
}
TUFT_CLONES void sweep16(Grid<16>& g) {
    sweep(g);
}
TUFT_CLONES void sweep8(Grid<8>& g) {
    sweep(g);
}

template <int N>
struct Residual {
    alignas(64) std::array<float, N * N> f, e;
};
/// What is missing of f and e; the greatest of the first.
template <int N, bool kSquares>
TUFT_INLINE float residual(const Grid<N>& g, Residual<N>& r) {
    const auto* squares = g.squares.get();
    alignas(64) float most[N] = {};
    for (int row = 0; row < N; ++row) {
        const Row<N> c = row_of<N>(g.cx.data(), g.cy.data(), kSquares ? squares->c_up.data() : nullptr,
                                   kSquares ? squares->c_down.data() : nullptr, row);
        const Row<N> m = row_of<N>(g.mx.data(), g.my.data(), kSquares ? squares->m_up.data() : nullptr,
                                   kSquares ? squares->m_down.data() : nullptr, row);
        const auto k0 = static_cast<std::size_t>(Grid<N>::at(0, row)), i0 = static_cast<std::size_t>(row * N);
        const float *v = &g.v[k0], *p = &g.p[k0];
        const float *f = &g.f[i0], *e = &g.e[i0], *inverse = &g.inverse[i0], *all_c = &g.conductances[i0],
                    *all_m = &g.mobilities[i0], *beyond_v = &g.beyond_v[i0], *beyond_p = &g.beyond_p[i0];
        float *to_f = &r.f[i0], *to_e = &r.e[i0];
#pragma GCC ivdep
        for (int x = 0; x < N; ++x) {
            float s = c.sum(v, x), q = m.sum(p, x);
            if constexpr (kSquares) s += c.diagonals(v, x), q += m.diagonals(p, x);
            const bool open = inverse[x] > 0;
            const float of_f = ((f[x] - v[x]) - all_m[x] * p[x]) + (q * inverse[x] + beyond_p[x]);
            const float of_e = ((e[x] - p[x]) + all_c[x] * v[x]) - (s * inverse[x] + beyond_v[x]);
            to_f[x] = open ? of_f : 0;
            to_e[x] = open ? of_e : 0;
            most[x] = larger(most[x], std::abs(to_f[x]));
        }
    }
    float all = 0;
    for (int x = 0; x < N; ++x) all = larger(all, most[x]);
    return all;
}
template <int N>
TUFT_INLINE float residual_of(const Grid<N>& g, Residual<N>& r) {
    return g.squares ? residual<N, true>(g, r) : residual<N, false>(g, r);
}
TUFT_CLONES float residual16(const Grid<16>& g, Residual<16>& r) {
    return residual_of(g, r);
}
TUFT_CLONES float residual8(const Grid<8>& g, Residual<8>& r) {
    return residual_of(g, r);
}

TUFT_INLINE LinkFlow carried(float mobility, float p0, float p1, float most, float rate0, float rate1) {
    const float flow = larger(smaller(mobility * (p0 - p1), most), -most);
    return {flow, positive(flow) * rate0, smaller(flow, 0) * rate1};
}
TUFT_INLINE float most_of(const Work& o, const Geometry& g, int k, int l) {
    const std::uint16_t a = g.flow_area[static_cast<std::size_t>(k)], b = g.flow_area[static_cast<std::size_t>(l)];
    return (kMostOfTexel * kFlowAreaUnit) * static_cast<float>(a < b ? a : b) * smaller(o.w[k], o.w[l]);
}

/// Sixteen faces in a row, the first of which lies between texels k + `first` and k + `second`.
struct FaceRow {
    const float* mobility;  ///< [16]
    int k = 0, first = 0, second = 0;
    float share = 1;  ///< of a texel's liquid that may go through a face
};

/// Flows through a row of faces under the pressures p, into `through`.
TUFT_INLINE void faces(Work& o, Faces& f, const Geometry& g, const float* p, const FaceRow& row) {
    const auto [mobility, k, first, second, share] = row;
    float *a = &f.a[k], *b = &f.b[k], *through = &o.through[k];
#pragma GCC ivdep
    for (int x = 0; x < kSide; ++x) {
        const int from = k + first + x, to = k + second + x;
        const LinkFlow c =
            carried(mobility[x], p[from], p[to], share * most_of(o, g, from, to), o.rate[from], o.rate[to]);
        through[x] = c.flow;
        a[x] = c.a;
        b[x] = c.b;
    }
}
/// Adds what came through faces into texel k from k + `in`, less what went at k + `out`.
TUFT_INLINE void add_flow(Work& o, int in, int out) {
    for (int row = 0; row < kSide; ++row) {
        const float* w = &o.through[field_at(0, row)];
        float* dw = o.dw.data() + row * kSide;
#pragma GCC ivdep
        for (int x = 0; x < kSide; ++x) dw[x] += w[x + in] - w[x + out];
    }
}

TUFT_CLONES void flow_by_tension(Work& o, const Geometry& g, const Grid<16>& t, float grip) {
    for (int k = 0; k < kField; k += kSide)
#pragma GCC ivdep
        for (int x = 0; x < kSide; ++x) {
            const float total = o.w[k + x] + o.s[k + x];
            o.total[k + x] = total;
            o.rate[k + x] = total > 0 ? 1 / larger(larger(total, grip), kThin) : 0;
        }
    o.dw.fill(0);
    o.ds.fill(0);
    const float* p = t.p.data();
    alignas(64) float first[kSide] = {};
    for (int row = 0; row < kSide; ++row) {
        faces(o, o.x, g, p, {&t.mx[static_cast<std::size_t>(row * (kSide + 1) + 1)], field_at(0, row), 0, 1, 1});
        first[0] = t.mx[static_cast<std::size_t>(row * (kSide + 1))];
        const int k = field_at(-1, row);
        const LinkFlow c = carried(first[0], p[k], p[k + 1], most_of(o, g, k, k + 1), o.rate[k], o.rate[k + 1]);
        o.x.a[k] = c.a;
        o.x.b[k] = c.b;
        o.through[k] = c.flow;
    }
    add_flow(o, -1, 0);
    for (int row = -1; row < kSide; ++row)
        faces(o, o.y, g, p, {&t.my[static_cast<std::size_t>((row + 1) * kSide)], field_at(0, row), 0, kRow, 1});
    add_flow(o, -kRow, 0);
    if (!g.gd) return;
    const auto diagonals = [&](Faces & f, const std::array<float, (kSide + 1) * (kSide + 1)>& mobility, int from,
                               int to) __attribute__((always_inline)) {
        for (int row = -1; row < kSide; ++row) {
            const float* m = &mobility[static_cast<std::size_t>((row + 1) * (kSide + 1))];
            const int k = field_at(-1, row);
            faces(o, f, g, p, {m + 1, k + 1, from, to, 0.5f});
            const LinkFlow c = carried(m[0], p[k + from], p[k + to], 0.5f * most_of(o, g, k + from, k + to),
                                       o.rate[k + from], o.rate[k + to]);
            f.a[k] = c.a;
            f.b[k] = c.b;
            o.through[k] = c.flow;
        }
        add_flow(o, -to, -from);
    };
    if (g.ups) diagonals(o.up, t.squares->m_up, 0, kRow + 1);
    if (g.downs) diagonals(o.down, t.squares->m_down, 1, kRow);
}

/// 1 where liquid is thicker than `held` on a texel and the four beside it; then of those that all five are so: near
/// the tile's edge as far as is known.
TUFT_CLONES void open_field(std::array<float, kTexels>& open, const Field& w, float held) {
    alignas(64) std::array<float, (kSide + 2) * kRow> once;
    once.fill(1);
    for (int row = 0; row < kSide; ++row) {
        const float* at = &w[field_at(0, row)];
        float* o = &once[field_at(0, row)];
#pragma GCC ivdep
        for (int x = 0; x < kSide; ++x) {
            const float low =
                smaller(at[x], smaller(smaller(at[x - 1], at[x + 1]), smaller(at[x - kRow], at[x + kRow])));
            o[x] = low > held ? 1.0f : 0.0f;
        }
    }
    for (int row = 0; row < kSide; ++row) {
        const float* at = &once[field_at(0, row)];
        float* o = &open[row * kSide];
#pragma GCC ivdep
        for (int x = 0; x < kSide; ++x) o[x] = at[x] * ((at[x - 1] * at[x + 1]) * (at[x - kRow] * at[x + kRow]));
    }
}

/// Whether three of N × N amounts in a row, all open, are more curved than `limit`.
template <int N, bool kAllOpen>
TUFT_INLINE bool curved(const float* w, const float* open, int row_length, float limit) {
    alignas(64) float most[N] = {};
    const auto bend = [&](float before, float here, float after) {
        return std::abs((before - here) + (after - here)) - limit * here;
    };
    for (int row = 0; row < N; ++row) {
        const float *at = w + row * row_length, *o = open + row * N;
#pragma GCC ivdep
        for (int x = 1; x < N - 1; ++x) {
            const float over = bend(at[x - 1], at[x], at[x + 1]);
            most[x] = larger(most[x], kAllOpen ? over : over * (o[x] * (o[x - 1] * o[x + 1])));
        }
        if (row == 0 || row == N - 1) continue;
#pragma GCC ivdep
        for (int x = 0; x < N; ++x) {
            const float over = bend(at[x - row_length], at[x], at[x + row_length]);
            most[x] = larger(most[x], kAllOpen ? over : over * (o[x] * (o[x - N] * o[x + N])));
        }
    }
    float all = 0;
    for (const float m : most) all = larger(all, m);
    return all > 0;
}
template <int N, bool kAllOpen>
TUFT_INLINE void halve(float* w, float* open, const float* from, const float* from_open, int row_length) {
    for (int row = 0; row < N; ++row)
#pragma GCC ivdep
        for (int x = 0; x < N; ++x) {
            const float* at = from + 2 * row * row_length + 2 * x;
            const float* o = from_open + 2 * row * 2 * N + 2 * x;
            w[row * N + x] = 0.25f * ((at[0] + at[1]) + (at[row_length] + at[row_length + 1]));
            if constexpr (!kAllOpen) open[row * N + x] = (o[0] * o[1]) * (o[2 * N] * o[2 * N + 1]);
        }
}

template <bool kAllOpen>
TUFT_INLINE bool any_curved(const Field& w, const float* open, const Limits& limits) {
    alignas(64) std::array<float, kTexels / 4> half, half_open{};
    alignas(64) std::array<float, kTexels / 16> quarter, quarter_open{};
    const float* texels = &w[field_at(0, 0)];
    if (curved<16, kAllOpen>(texels, open, kRow, limits.texels)) return true;
    halve<8, kAllOpen>(half.data(), half_open.data(), texels, open, kRow);
    if (curved<8, kAllOpen>(half.data(), half_open.data(), 8, limits.pairs)) return true;
    halve<4, kAllOpen>(quarter.data(), quarter_open.data(), half.data(), half_open.data(), 8);
    return curved<4, kAllOpen>(quarter.data(), quarter_open.data(), 4, limits.blocks);
}
TUFT_CLONES float least_of(const Field& w) {
    alignas(64) float least[kSide];
    for (int x = 0; x < kSide; ++x) least[x] = w[field_at(x, 0)];
    for (int row = 0; row < kSide; ++row)
        for (int x = 0; x < kSide; ++x) least[x] = smaller(least[x], w[field_at(x, row)]);
    float all = least[0];
    for (const float l : least) all = smaller(all, l);
    return all;
}
TUFT_CLONES bool any_curved_inside(const Field& w, const Limits& limits) {
    return any_curved<true>(w, nullptr, limits);
}
TUFT_CLONES bool any_curved_of(const Field& w, const std::array<float, kTexels>& open, const Limits& limits) {
    return any_curved<false>(w, open.data(), limits);
}
bool is_valid(const Geometry& g, int column, int row) {
    return g.valid[static_cast<std::size_t>(row + 1)] >> (column + 1) & 1;
}

/// Whether a texel beside the tile, but of a chart, has no more than `held`.
bool ends_beside(const Field& w, const Geometry& g, float held) {
    const auto thin = [&](int column, int row) {
        return is_valid(g, column, row) && !(w[field_at(column, row)] > held);
    };
    for (int i = 0; i < kSide; ++i)
        if (thin(i, -1) || thin(i, kSide) || thin(-1, i) || thin(kSide, i)) return true;
    return false;
}

}  // namespace

Ripples find_ripples(const Field& w, const Geometry& g, float held) {
    constexpr std::uint32_t kAll = (1u << (kSide + 2)) - 1;
    if (std::all_of(g.valid.begin(), g.valid.end(), [](std::uint32_t row) { return row == kAll; })) {
        if (!(least_of(w) > held)) {
            alignas(64) std::array<float, kTexels> open;
            open_field(open, w, held);
            return {any_curved_of(w, open, kBesideRims), false, true};
        }
        const bool any = any_curved_inside(w, kInside);
        return {any && any_curved_inside(w, kBesideRims), any, ends_beside(w, g, held)};
    }
    // Beside charts, where no contact line is, it is as thick as can be.
    Field thick = w;
    for (int row = -1; row <= kSide; ++row)
        for (int x = -1; x <= kSide; ++x)
            if (!is_valid(g, x, row)) thick[field_at(x, row)] = std::numeric_limits<float>::max();
    alignas(64) std::array<float, kTexels> open;
    open_field(open, thick, held);
    for (int row = 0; row < kSide; ++row)
        for (int x = 0; x < kSide; ++x) open[row * kSide + x] = is_valid(g, x, row) ? open[row * kSide + x] : 0;
    const bool rims = !(least_of(thick) > held) || ends_beside(w, g, held);
    return {any_curved_of(w, open, kBesideRims), !rims && any_curved_of(w, open, kInside), rims};
}

void tension_flow(Work& work, const Geometry& g, const Grid<16>& grid, float grip) {
    flow_by_tension(work, g, grid, grip);
}

LinkFlow flow_over_link(const TensionLink& link, const std::array<float, 2>& w, const std::array<float, 2>& p,
                        const std::array<float, 2>& rate) {
    return carried(link.mobility, p[0], p[1], kMostOfLinks * link.area * smaller(w[0], w[1]), rate[0], rate[1]);
}

void open_texels(TensionTile& tile, const Geometry& g, float factor) {
    const float held = tile.held;
    for (int row = 0; row < kSide; ++row)
        for (int x = 0; x < kSide; ++x) {
            const int k = field_at(x, row), side = Geometry::right_of(x, row), i = row * kSide + x;
            const float *w = &tile.w[static_cast<std::size_t>(k)], here = *w;
            const auto thick = [&](std::uint16_t conductance, int to) { return conductance == 0 || w[to] > held; };
            const bool open = here > held && g.inverse[i] > 0 && thick(g.gx[side], 1) && thick(g.gx[side - 1], -1) &&
                              thick(g.gy[i + kSide], kRow) && thick(g.gy[i], -kRow);
            tile.mobility[static_cast<std::size_t>(k)] = open ? factor * (here * here * here) : 0;
        }
}

void hold_rims(TensionTile& tile, const Geometry& g) {
    alignas(64) std::array<float, kTexels> next;
    const float* m = tile.mobility.data();
    for (int row = 0; row < kSide; ++row)
        for (int x = 0; x < kSide; ++x) {
            const int k = field_at(x, row), side = Geometry::right_of(x, row), i = row * kSide + x;
            const auto open = [&](std::uint16_t conductance, int to) { return conductance == 0 || m[k + to] > 0; };
            next[i] =
                open(g.gx[side], 1) && open(g.gx[side - 1], -1) && open(g.gy[i + kSide], kRow) && open(g.gy[i], -kRow)
                    ? m[k]
                    : 0;
        }
    for (int i = 0; i < kTexels; ++i) tile.inner[i] = next[i];
}

void set_faces(TensionTile& tile, const Geometry& g) {
    Grid<16>& t = tile.grid;
    const float *w = tile.w.data(), *m = tile.mobility.data();
    const auto face = [&](float c, int k, int l, float& conductance, float& mobility) {
        const bool open = m[k] > 0 && m[l] > 0;
        conductance = open ? c : 0;
        mobility = conductance * (0.5f * (m[k] + m[l]));
    };
    for (int row = 0; row < kSide; ++row)
        for (int x = -1; x < kSide; ++x) {
            const auto i = static_cast<std::size_t>(row * (kSide + 1) + x + 1);
            const int k = field_at(x, row);
            face(conductance_of(g.gx[Geometry::right_of(x, row)]), k, k + 1, t.cx[i], t.mx[i]);
        }
    for (int row = -1; row < kSide; ++row)
        for (int x = 0; x < kSide; ++x) {
            const auto i = static_cast<std::size_t>((row + 1) * kSide + x);
            const int k = field_at(x, row);
            face(conductance_of(g.gy[i]), k, k + kRow, t.cy[i], t.my[i]);
        }
    if (!g.gd)
        t.squares.reset();
    else if (!t.squares)
        t.squares = std::make_unique<Grid<16>::Squares>();
    for (int row = -1; g.gd && row < kSide; ++row)
        for (int x = -1; x < kSide; ++x) {
            const auto i = static_cast<std::size_t>((row + 1) * (kSide + 1) + x + 1);
            const int k = field_at(x, row);
            const float d =
                static_cast<float>((*g.gd)[static_cast<std::size_t>(Geometry::corner_of(x, row))]) * kDiagonalUnit;
            face(positive(d), k, k + kRow + 1, t.squares->c_up[i], t.squares->m_up[i]);
            face(positive(-d), k + 1, k + kRow, t.squares->c_down[i], t.squares->m_down[i]);
        }
    for (int row = 0; row < kSide; ++row)
        for (int x = 0; x < kSide; ++x) {
            const int k = field_at(x, row), i = row * kSide + x;
            const bool open = m[k] > 0;
            t.inverse[i] = open ? g.inverse[i] : 0;
            t.area[i] = open ? 1 / g.inverse[i] : 0;
            const float here = w[k];
            const std::size_t side = static_cast<std::size_t>(row * (kSide + 1) + x);
            float bend = (t.cx[side] * (here - w[k - 1]) + t.cx[side + 1] * (here - w[k + 1])) +
                         (t.cy[i] * (here - w[k - kRow]) + t.cy[i + kSide] * (here - w[k + kRow]));
            if (g.gd) {
                const auto& q = *t.squares;
                const std::size_t own = static_cast<std::size_t>((row + 1) * (kSide + 1) + x + 1);
                bend += q.c_up[own] * (here - w[k + kRow + 1]) + q.c_up[own - kSide - 2] * (here - w[k - kRow - 1]);
                bend +=
                    q.c_down[own - 1] * (here - w[k + kRow - 1]) + q.c_down[own - kSide - 1] * (here - w[k - kRow + 1]);
            }
            t.e[i] = bend * t.inverse[i];
            t.f[i] = 0;
        }
    t.v.fill(0);
    t.p.fill(0);
}

template <int N>
void sum_faces(Grid<N>& g, std::span<const TensionLink> links, float scale) {
    for (int row = 0; row < N; ++row) {
        const auto* squares = g.squares.get();
        const Row<N> c = row_of<N>(g.cx.data(), g.cy.data(), squares ? squares->c_up.data() : nullptr,
                                   squares ? squares->c_down.data() : nullptr, row);
        const Row<N> m = row_of<N>(g.mx.data(), g.my.data(), squares ? squares->m_up.data() : nullptr,
                                   squares ? squares->m_down.data() : nullptr, row);
        for (int x = 0; x < N; ++x) {
            const auto i = static_cast<std::size_t>(row * N + x);
            g.conductances[i] = (c.all(x) + (squares ? c.all_diagonals(x) : 0)) * g.inverse[i];
            g.mobilities[i] = (m.all(x) + (squares ? m.all_diagonals(x) : 0)) * g.inverse[i];
        }
    }
    g.beyond_v.fill(0);
    g.beyond_p.fill(0);
    constexpr int kPart = kSide / N;
    for (const TensionLink& l : links) {
        const auto i = static_cast<std::size_t>(l.texel / kSide / kPart * N + l.texel % kSide / kPart);
        g.conductances[i] += scale * l.conductance * g.inverse[i];
        g.mobilities[i] += scale * l.mobility * g.inverse[i];
    }
}

template <int N>
void coarsen(const Grid<2 * N>& fine, Grid<N>& coarse) {
    constexpr int kFine = 2 * N;
    const auto mean = [](const auto& q, int i, int j) {
        return 0.5f * (q[static_cast<std::size_t>(i)] + q[static_cast<std::size_t>(j)]);
    };
    for (int row = 0; row < N; ++row)
        for (int x = -1; x < N; ++x) {
            const auto i = static_cast<std::size_t>(row * (N + 1) + x + 1);
            const int k = 2 * row * (kFine + 1) + 2 * x + 2;
            coarse.cx[i] = mean(fine.cx, k, k + kFine + 1);
            coarse.mx[i] = mean(fine.mx, k, k + kFine + 1);
        }
    for (int row = -1; row < N; ++row)
        for (int x = 0; x < N; ++x) {
            const auto i = static_cast<std::size_t>((row + 1) * N + x);
            const int k = (2 * row + 2) * kFine + 2 * x;
            coarse.cy[i] = mean(fine.cy, k, k + 1);
            coarse.my[i] = mean(fine.my, k, k + 1);
        }
    if (!fine.squares)
        coarse.squares.reset();
    else if (!coarse.squares)
        coarse.squares = std::make_unique<typename Grid<N>::Squares>();
    for (int row = -1; fine.squares && row < N; ++row)
        for (int x = -1; x < N; ++x) {
            const auto i = static_cast<std::size_t>((row + 1) * (N + 1) + x + 1),
                       k = static_cast<std::size_t>((2 * row + 2) * (kFine + 1) + 2 * x + 2);
            coarse.squares->c_up[i] = fine.squares->c_up[k], coarse.squares->m_up[i] = fine.squares->m_up[k];
            coarse.squares->c_down[i] = fine.squares->c_down[k], coarse.squares->m_down[i] = fine.squares->m_down[k];
        }
    for (int row = 0; row < N; ++row)
        for (int x = 0; x < N; ++x) {
            const auto i = static_cast<std::size_t>(row * N + x), k = static_cast<std::size_t>(2 * row * kFine + 2 * x);
            coarse.area[i] = (fine.area[k] + fine.area[k + 1]) + (fine.area[k + kFine] + fine.area[k + kFine + 1]);
            coarse.inverse[i] = coarse.area[i] > 0 ? 1 / coarse.area[i] : 0;
        }
}

template <int N>
void relax(Grid<N>& grid) {
    if constexpr (N == 16)
        sweep16(grid);
    else if constexpr (N == 8)
        sweep8(grid);
    else
        sweep(grid);
}

template <int N>
float restrict_residual(const Grid<2 * N>& fine, Grid<N>& coarse) {
    constexpr int kFine = 2 * N;
    Residual<kFine> r;
    float most = 0;
    if constexpr (kFine == 16)
        most = residual16(fine, r);
    else if constexpr (kFine == 8)
        most = residual8(fine, r);
    else
        most = residual_of(fine, r);
    for (int row = 0; row < N; ++row)
        for (int x = 0; x < N; ++x) {
            const auto i = static_cast<std::size_t>(row * N + x), k = static_cast<std::size_t>(2 * row * kFine + 2 * x);
            const auto weighted = [&](const auto& q) {
                return ((q[k] * fine.area[k] + q[k + 1] * fine.area[k + 1]) +
                        (q[k + kFine] * fine.area[k + kFine] + q[k + kFine + 1] * fine.area[k + kFine + 1])) *
                       coarse.inverse[i];
            };
            coarse.f[i] = weighted(r.f);
            coarse.e[i] = weighted(r.e);
        }
    coarse.v.fill(0);
    coarse.p.fill(0);
    coarse.beyond_v.fill(0);
    coarse.beyond_p.fill(0);
    return most;
}

template <int N>
void prolong(const Grid<N>& coarse, Grid<2 * N>& fine) {
    constexpr int kFine = 2 * N;
    for (int row = 0; row < N; ++row)
        for (int x = 0; x < N; ++x) {
            const auto k = static_cast<std::size_t>(Grid<N>::at(x, row));
            const auto side = static_cast<std::size_t>(row * (N + 1) + x), i = static_cast<std::size_t>(row * N + x);
            const auto open = [](float c) { return c > 0 ? 0.25f : 0.0f; };
            const std::array across{open(coarse.cx[side]), open(coarse.cx[side + 1])},
                along{open(coarse.cy[i]), open(coarse.cy[i + N])};
            const auto spread = [&](const auto& from, auto& to) {
                const float here = from[k];
                const std::array dx{across[0] * (from[k - 1] - here), across[1] * (from[k + 1] - here)},
                    dy{along[0] * (from[k - Grid<N>::kRow] - here), along[1] * (from[k + Grid<N>::kRow] - here)};
                for (int part = 0; part < 4; ++part) {
                    const int column = 2 * x + (part & 1), line = 2 * row + (part >> 1);
                    if (fine.area[static_cast<std::size_t>(line * kFine + column)] > 0)
                        to[static_cast<std::size_t>(Grid<kFine>::at(column, line))] +=
                            here + (dx[static_cast<std::size_t>(part & 1)] + dy[static_cast<std::size_t>(part >> 1)]);
                }
            };
            spread(coarse.v, fine.v);
            spread(coarse.p, fine.p);
        }
}

#define TUFT_GRID(N)                                                           \
    template void sum_faces<N>(Grid<N>&, std::span<const TensionLink>, float); \
    template void relax<N>(Grid<N>&);
TUFT_GRID(16)
TUFT_GRID(8)
TUFT_GRID(4)
TUFT_GRID(2)
TUFT_GRID(1)
#undef TUFT_GRID
#define TUFT_GRIDS(N)                                                  \
    template void coarsen<N>(const Grid<2 * N>&, Grid<N>&);            \
    template float restrict_residual<N>(const Grid<2 * N>&, Grid<N>&); \
    template void prolong<N>(const Grid<N>&, Grid<2 * N>&);
TUFT_GRIDS(8)
TUFT_GRIDS(4)
TUFT_GRIDS(2)
TUFT_GRIDS(1)
#undef TUFT_GRIDS

}  // namespace tuft::ink::wet
