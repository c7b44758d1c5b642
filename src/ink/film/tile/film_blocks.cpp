#include <algorithm>

#include "core/simd.h"
#include "ink/film/tile/film_tile.h"

namespace tuft::ink::wet {
namespace {

constexpr float kMostOfBlock = 2;    // conductance of a face: from block to block a sixteenth of that, 1/8
constexpr float kLeastPart = 0.1f;   // of what the driest texel of a block has, through a face
constexpr int kRound = kBlocks + 2;  // with those beside

/// What the blocks of a tile and those beside it hold in the mean; 0: not wet all over, or at a
/// seam.
struct Means {
    std::array<float, kRound * kRound> mean{}, least{}, flow{};

    static constexpr std::size_t at(int column, int row) {
        return static_cast<std::size_t>((row + 1) * kRound + column + 1);
    }
    /// Of a block whose columns hold `sum` and `low`: the same bits for the tile itself and for
    /// those beside it.
    void set(int column, int row, const float* sum, const float* low) {
        const float lowest = std::min(std::min(low[0], low[1]), std::min(low[2], low[3]));
        if (!(lowest > 0)) return;
        mean[at(column, row)] = ((sum[0] + sum[1]) + (sum[2] + sum[3])) / (kBlock * kBlock);
        least[at(column, row)] = lowest;
    }
};

inline __attribute__((always_inline)) float smaller(float a, float b) {
    return a < b ? a : b;
}
inline __attribute__((always_inline)) float larger(float a, float b) {
    return a > b ? a : b;
}

/// Sums and least of four rows of `kColumns`.
template <int kColumns>
inline __attribute__((always_inline)) void columns_of(float* __restrict sum, float* __restrict low, const float* s,
                                                      int stride) {
    for (int x = 0; x < kColumns; ++x) {
        const float a = s[x], b = s[stride + x], c = s[2 * stride + x], d = s[3 * stride + x];
        sum[x] = ((a + b) + c) + d;
        low[x] = smaller(d, smaller(c, smaller(b, a)));
    }
}
TUFT_CLONES void columns_of_tile(float* __restrict sum, float* __restrict low, const float* s) {
    for (int row = 0; row < kBlocks; ++row)
        columns_of<kSide>(sum + row * kSide, low + row * kSide, s + field_at(0, row * kBlock), kRow);
}

Means means_of(const Field& liquid, const TileNeighbours& beside) {
    Means m;
    const auto whole = [](std::uint16_t blocks, int column, int row) { return blocks >> (row * kBlocks + column) & 1; };
    alignas(64) std::array<float, kBlocks * kSide> sum, low;
    columns_of_tile(sum.data(), low.data(), liquid.data());
    for (int row = 0; row < kBlocks; ++row)
        for (int column = 0; column < kBlocks; ++column)
            if (whole(beside.here, column, row))
                m.set(column, row, &sum[row * kSide + column * kBlock], &low[row * kSide + column * kBlock]);
    constexpr int kLast = kBlocks - 1;
    for (int i = 0; i < kBlocks; ++i) {
        const std::array<std::array<int, 4>, 4> sides{
            {{kLast, i, -1, i}, {0, i, kBlocks, i}, {i, kLast, i, -1}, {i, 0, i, kBlocks}}};
        for (std::size_t side = 0; side < 4; ++side) {
            const auto& [column, row, to_column, to_row] = sides[side];
            if (!beside.liquid[side] || !whole(beside.blocks[side], column, row)) continue;
            columns_of<kBlock>(sum.data(), low.data(), beside.liquid[side] + row * kBlock * kSide + column * kBlock,
                               kSide);
            m.set(to_column, to_row, sum.data(), low.data());
        }
    }
    return m;
}

/// What flows: how easily, over its mean depth.
struct Medium {
    float flow, threshold, levelling, retained, most;

    float flow_at(float depth) const {
        return flow * std::max(depth - threshold, 0.0f) + levelling * std::max(depth - retained, 0.0f);
    }
};

/// Blocks' values at the sixteen texels of a row of them.
struct Row {
    alignas(64) std::array<float, kSide> mean, least, flow;
};

/// Through the faces of the blocks: of rows the upright ones, of columns those that lie.
struct Fluxes {
    alignas(64) std::array<std::array<float, kSide>, kBlocks + 1> across, along;  ///< [face][texel]
    bool any = false;
};

/// Through the sixteen texels' parts of the faces between two rows of blocks. Returns the greatest
/// conductance that was held back.
TUFT_CLONES float through_faces(float* __restrict flux, const Row& from, const Row& to,
                                const std::uint16_t* __restrict conductance, const std::uint16_t* __restrict flow_area,
                                float most) {
    alignas(64) float any[kSide];
    for (int x = 0; x < kSide; ++x) {
        const float least = smaller(from.least[x], to.least[x]);
        const float flow = 0.5f * (from.flow[x] + to.flow[x]), drop = (from.mean[x] - to.mean[x]) / kBlock;
        const float k = (static_cast<float>(conductance[x]) * kConductanceUnit) * flow;
        const float over = larger(k - most * static_cast<float>(flow_area[x]), 0);
        const float limited = least > 0 ? smaller(over, kMostOfBlock) : 0, limit = kLeastPart * least;
        const float f = larger(smaller(limited * drop, limit), -limit);
        flux[x] = least > 0 ? f : 0;
        any[x] = limited;
    }
    float all = 0;
    for (int x = 0; x < kSide; ++x) all = larger(all, any[x]);
    return all;
}

Fluxes fluxes_of(Means m, const Geometry& g, const Medium& p) {
    Fluxes f;
    if (std::none_of(m.least.begin(), m.least.end(), [](float l) { return l > 0; })) return f;
    for (std::size_t i = 0; i < m.mean.size(); ++i) m.flow[i] = p.flow_at(m.mean[i]);
    const auto fill = [&](Row& row, int block, std::size_t at) {
        std::fill_n(row.mean.begin() + block * kBlock, kBlock, m.mean[at]);
        std::fill_n(row.least.begin() + block * kBlock, kBlock, m.least[at]);
        std::fill_n(row.flow.begin() + block * kBlock, kBlock, m.flow[at]);
    };
    std::array<Row, 2> across, along;
    alignas(64) std::array<std::uint16_t, kSide> conductance, flow_area;
    const auto flow_area_at = [&](int k, int l) {
        return std::min(g.flow_area[static_cast<std::size_t>(k)], g.flow_area[static_cast<std::size_t>(l)]);
    };
    const auto fill_both = [&](int to, int line) {
        for (int block = 0; block < kBlocks; ++block) {
            fill(across[static_cast<std::size_t>(to)], block, Means::at(line, block));
            fill(along[static_cast<std::size_t>(to)], block, Means::at(block, line));
        }
    };
    fill_both(1, -1);
    for (int face = 0; face <= kBlocks; ++face) {
        const int before = face * kBlock - 1, from = (face + 1) % 2, to = face % 2;
        fill_both(to, face);
        for (int row = 0; row < kSide; ++row) {
            const int k = field_at(before, row);
            conductance[row] = g.gx[static_cast<std::size_t>(Geometry::right_of(before, row))];
            flow_area[row] = flow_area_at(k, k + 1);
        }
        const auto at = static_cast<std::size_t>(face);
        f.any |= through_faces(f.across[at].data(), across[from], across[to], conductance.data(), flow_area.data(),
                               p.most) > 0;
        for (int column = 0; column < kSide; ++column)
            flow_area[column] = flow_area_at(field_at(column, before), field_at(column, before + 1));
        f.any |= through_faces(f.along[at].data(), along[from], along[to],
                               &g.gy[static_cast<std::size_t>((before + 1) * kSide)], flow_area.data(), p.most) > 0;
    }
    return f;
}

/// Sixteen faces from texel k to k + `to`.
inline __attribute__((always_inline)) void transport(Faces& f, int k, int to, const float* flux, const float* rate) {
    float *a = &f.a[k], *b = &f.b[k];
    const float *from = rate + k, *onto = from + to;
#pragma GCC ivdep
    for (int x = 0; x < kSide; ++x) {
        a[x] += (flux[x] > 0 ? flux[x] : 0) * from[x];
        b[x] += (flux[x] < 0 ? flux[x] : 0) * onto[x];
    }
}

/// Between the faces of a block what flows changes evenly, so that all its texels gain or lose as
/// much.
TUFT_CLONES void spread(Work& work, const Fluxes& f) {
    alignas(64) std::array<float, kSide + 1> across;
    alignas(64) std::array<float, kSide> last{}, along;
    for (int row = -1; row < kSide; ++row) {
        const int face = (row + 1) / kBlock, part = (row + 1) % kBlock;
        const float* first = f.along[face].data();
        const float* second = f.along[part == 0 ? face : face + 1].data();
        for (int x = 0; x < kSide; ++x)
            along[x] = first[x] + (second[x] - first[x]) * (static_cast<float>(part) / kBlock);
        transport(work.y, field_at(0, row), kRow, along.data(), work.rate.data());
        if (row >= 0) {
            for (int b = 0; b < kBlocks; ++b) {
                const float from = f.across[b][row], change = f.across[b + 1][row] - from;
                for (int x = 0; x < kBlock; ++x)
                    across[b * kBlock + x] = from + change * (static_cast<float>(x) / kBlock);
            }
            across[kSide] = f.across[kBlocks][row];
            transport(work.x, field_at(-1, row), 1, across.data(), work.rate.data());
            const int k = field_at(kSide - 1, row);
            work.x.a[k] += std::max(across[kSide], 0.0f) * work.rate[k];
            work.x.b[k] += std::min(across[kSide], 0.0f) * work.rate[k + 1];
            float* into = work.dw.data() + row * kSide;
#pragma GCC ivdep
            for (int x = 0; x < kSide; ++x) into[x] += (across[x] - across[x + 1]) + (last[x] - along[x]);
        }
        last = along;
    }
}

}  // namespace

void film_block_flow(Work& work, const Geometry& g, const TileNeighbours& beside, const Step& p) {
    const Fluxes fluxes =
        fluxes_of(means_of(work.w, beside), g, {p.flow, p.threshold, p.levelling, p.retained, p.limit.most});
    if (fluxes.any) spread(work, fluxes);
}

}  // namespace tuft::ink::wet
