#include <algorithm>

#include "ink/film/film_tile.h"
#include "ink/simd.h"

namespace tuft::ink::wet {
namespace {

constexpr float kMostOfBlock =
    2;  // conductance of a face: from block to block a sixteenth of that, 1/8
constexpr float kLeastPart = 0.1f;   // of what the driest texel of a block has, through a face
constexpr int kRound = kBlocks + 2;  // with those beside

/// What the blocks of a tile and those beside it hold in the mean; 0: not wet all over, or at a
/// seam.
struct Means {
    std::array<float, kRound * kRound> mean{}, least{};

    static constexpr std::size_t at(int column, int row) {
        return static_cast<std::size_t>((row + 1) * kRound + column + 1);
    }
    /// The same bits for the tile itself and for those beside it.
    void set(int column, int row, const float* s, int stride) {
        std::array<float, kBlock> sum{}, low{};
        for (int x = 0; x < kBlock; ++x) sum[x] = low[x] = s[x];
        for (int y = 1; y < kBlock; ++y)
            for (int x = 0; x < kBlock; ++x) {
                const float v = s[y * stride + x];
                sum[x] += v;
                low[x] = v < low[x] ? v : low[x];
            }
        const float lowest = std::min(std::min(low[0], low[1]), std::min(low[2], low[3]));
        if (!(lowest > 0)) return;
        mean[at(column, row)] = ((sum[0] + sum[1]) + (sum[2] + sum[3])) / (kBlock * kBlock);
        least[at(column, row)] = lowest;
    }
};

Means means_of(const Field& liquid, const Beside& beside) {
    Means m;
    const auto whole = [](std::uint16_t blocks, int column, int row) {
        return blocks >> (row * kBlocks + column) & 1;
    };
    for (int row = 0; row < kBlocks; ++row)
        for (int column = 0; column < kBlocks; ++column)
            if (whole(beside.here, column, row))
                m.set(column, row, &liquid[field_at(column * kBlock, row * kBlock)], kRow);
    constexpr int kLast = kBlocks - 1;
    for (int i = 0; i < kBlocks; ++i) {
        const std::array<std::array<int, 4>, 4> sides{
            {{kLast, i, -1, i}, {0, i, kBlocks, i}, {i, kLast, i, -1}, {i, 0, i, kBlocks}}};
        for (std::size_t side = 0; side < 4; ++side) {
            const auto& [column, row, to_column, to_row] = sides[side];
            if (beside.liquid[side] && whole(beside.blocks[side], column, row))
                m.set(to_column, to_row,
                      beside.liquid[side] + row * kBlock * kSide + column * kBlock, kSide);
        }
    }
    return m;
}

/// What flows: how easily, over its mean depth.
struct Medium {
    float flow, threshold, levelling, hold, most;

    float flow_at(float depth) const {
        return flow * std::max(depth - threshold, 0.0f) + levelling * std::max(depth - hold, 0.0f);
    }
};

/// Through the four texels' parts of the face between two blocks. Whether anything goes.
bool through_face(std::array<float, kBlock>& flux, const Means& m, std::size_t from, std::size_t to,
                  const std::array<std::uint16_t, kBlock>& conductance,
                  const std::array<std::uint16_t, kBlock>& room, const Medium& p) {
    const float least = std::min(m.least[from], m.least[to]);
    if (!(least > 0)) return false;
    const float flow = 0.5f * (p.flow_at(m.mean[from]) + p.flow_at(m.mean[to])),
                drop = (m.mean[from] - m.mean[to]) / kBlock;
    const float most = kLeastPart * least;
    float any = 0;
    for (int i = 0; i < kBlock; ++i) {
        const float k = (static_cast<float>(conductance[i]) * kConductanceUnit) * flow;
        float held_back = k - p.most * static_cast<float>(room[i]);
        held_back = held_back > 0 ? held_back : 0;
        held_back = held_back < kMostOfBlock ? held_back : kMostOfBlock;
        float f = held_back * drop;
        f = f < most ? f : most;
        f = f > -most ? f : -most;
        flux[i] = f;
        any = held_back > any ? held_back : any;
    }
    return any > 0;
}

/// Through the faces of the blocks: of rows the upright ones, of columns those that lie.
struct Fluxes {
    std::array<std::array<std::array<float, kBlock>, kBlocks>, kBlocks + 1> across{},
        along{};  ///< [face][block][texel]
    bool any = false;
};

Fluxes fluxes_of(const Means& m, const Geometry& g, const Medium& p) {
    Fluxes f;
    std::array<std::uint16_t, kBlock> conductance, room;
    const auto room_at = [&](int k, int l) {
        return std::min(g.room[static_cast<std::size_t>(k)], g.room[static_cast<std::size_t>(l)]);
    };
    for (int face = 0; face <= kBlocks; ++face)
        for (int block = 0; block < kBlocks; ++block) {
            const int before = face * kBlock - 1, first = block * kBlock;
            for (int i = 0; i < kBlock; ++i) {
                const int k = field_at(before, first + i);
                conductance[i] =
                    g.gx[static_cast<std::size_t>(Geometry::right_of(before, first + i))];
                room[i] = room_at(k, k + 1);
            }
            f.any |= through_face(f.across[face][block], m, Means::at(face - 1, block),
                                  Means::at(face, block), conductance, room, p);
            for (int i = 0; i < kBlock; ++i) {
                const int k = field_at(first + i, before);
                conductance[i] = g.gy[static_cast<std::size_t>((before + 1) * kSide + first + i)];
                room[i] = room_at(k, k + kRow);
            }
            f.any |= through_face(f.along[face][block], m, Means::at(block, face - 1),
                                  Means::at(block, face), conductance, room, p);
        }
    return f;
}

/// Sixteen faces from texel k to k + `to`.
inline __attribute__((always_inline)) void carry(Faces& f, int k, int to, const float* flux,
                                                 const float* rate, float passing) {
    float *a = &f.a[k], *b = &f.b[k];
    const float *from = rate + k, *onto = from + to;
#pragma GCC ivdep
    for (int x = 0; x < kSide; ++x) {
        const float part = flux[x] * passing;
        a[x] += (part > 0 ? part : 0) * from[x];
        b[x] += (part < 0 ? part : 0) * onto[x];
    }
}

/// Between the faces of a block what flows changes evenly, so that all its texels gain or lose as
/// much.
TUFT_CLONES void spread(Work& work, float* d, const Fluxes& f, float passing) {
    alignas(64) std::array<float, kSide + 1> across;
    alignas(64) std::array<float, kSide> last{}, along;
    for (int row = -1; row < kSide; ++row) {
        const int face = (row + 1) / kBlock, part = (row + 1) % kBlock;
        const float* first = f.along[face][0].data();
        const float* second = f.along[part == 0 ? face : face + 1][0].data();
        for (int x = 0; x < kSide; ++x)
            along[x] = first[x] + (second[x] - first[x]) * (static_cast<float>(part) / kBlock);
        carry(work.y, field_at(0, row), kRow, along.data(), work.rate.data(), passing);
        if (row >= 0) {
            const int block = row / kBlock, i = row % kBlock;
            for (int b = 0; b < kBlocks; ++b) {
                const float from = f.across[b][block][i], change = f.across[b + 1][block][i] - from;
                for (int x = 0; x < kBlock; ++x)
                    across[b * kBlock + x] = from + change * (static_cast<float>(x) / kBlock);
            }
            across[kSide] = f.across[kBlocks][block][i];
            carry(work.x, field_at(-1, row), 1, across.data(), work.rate.data(), passing);
            const int k = field_at(kSide - 1, row);
            work.x.a[k] += std::max(across[kSide] * passing, 0.0f) * work.rate[k];
            work.x.b[k] += std::min(across[kSide] * passing, 0.0f) * work.rate[k + 1];
            float* into = d + row * kSide;
#pragma GCC ivdep
            for (int x = 0; x < kSide; ++x)
                into[x] += (across[x] - across[x + 1]) + (last[x] - along[x]);
        }
        last = along;
    }
}

}  // namespace

void film_block_flow(Work& work, const Geometry& g, const Beside& beside, const Step& p) {
    const Fluxes fluxes =
        fluxes_of(means_of(work.w, beside), g, {p.flow, p.threshold, p.levelling, p.hold, p.most});
    if (fluxes.any) spread(work, work.dw.data(), fluxes, 1);
}

void pore_block_flow(Work& work, const Geometry& g, const Beside& beside, const Step& p) {
    const Fluxes fluxes = fluxes_of(means_of(work.s, beside), g, {p.flow, 0, 0, 0, p.most});
    if (fluxes.any) spread(work, work.ds.data(), fluxes, p.passing);
}

}  // namespace tuft::ink::wet
