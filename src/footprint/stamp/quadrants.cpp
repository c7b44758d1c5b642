#include "footprint/stamp/quadrants.h"

#include <array>
#include <cmath>

#include "footprint/stamp/picture_map.h"
#include "footprint/stamp/walk.h"

namespace tuft::footprint {
namespace {

constexpr float kEverywhere = 1e9f;  // cells

constexpr int texel(int row, int column) {
    return row * atlas::kTile + column;
}

/// By quadrant: the two texels next to the middle, then the corners.
constexpr std::array<std::array<int, 6>, kQuadrants> kTexels = [] {
    std::array<std::array<int, 6>, kQuadrants> t{};
    for (int q = 0; q < kQuadrants; ++q) {
        const int first = texel(8 * (q / 2), 8 * (q % 2));
        t[q] = {first + texel(3, 3), first + texel(4, 4), first,
                first + texel(0, 7), first + texel(7, 0), first + texel(7, 7)};
    }
    return t;
}();

/// Centres of the quadrants, and half of each diagonal, squared.
struct QuadrantCentres {
    float x[kQuadrants], y[kQuadrants], z[kQuadrants], nx[kQuadrants], ny[kQuadrants], nz[kQuadrants];
    float radius2[kQuadrants];
};

/// position(t) and normal(t): of a texel.
template <class Position, class Normal>
QuadrantCentres quadrants_of(Position position, Normal normal) {
    QuadrantCentres out;
    for (int q = 0; q < kQuadrants; ++q) {
        const auto& t = kTexels[q];
        const Vec3f middle = 0.5f * (position(t[0]) + position(t[1])), n = 0.5f * (normal(t[0]) + normal(t[1]));
        out.x[q] = middle.x;
        out.y[q] = middle.y;
        out.z[q] = middle.z;
        out.nx[q] = n.x;
        out.ny[q] = n.y;
        out.nz[q] = n.z;
        float most = 0;
        for (int k = 2; k < 6; ++k) {
            const Vec3f to = position(t[k]) - middle;
            most = std::max(most, glm::dot(to, to));
        }
        out.radius2[q] = most;
    }
    return out;
}

QuadrantCentres quadrants_of(const atlas::TexelMap& texels, std::uint32_t slot) {
    if (!texels.packed.empty())
        return quadrants_of([&](int t) { return texels.position(slot, t); },
                            [&](int t) { return texels.normal(slot, t); });
    const atlas::TexelShape& s = texels.shapes[slot];
    return quadrants_of(
        [&](int t) {
            return Vec3f{s.px[t], s.py[t], s.pz[t]};
        },
        [&](int t) {
            return Vec3f{s.nx[t], s.ny[t], s.nz[t]};
        });
}

}  // namespace

bool add_quadrants(const ClusterFrame& frame, std::int32_t cluster, const atlas::TexelMap& texels, std::uint32_t slot,
                   const SweptDisplacement& displacement, Discs& discs) {
    const std::uint8_t* id = texels.tiles[slot].cluster.data();
    for (const auto& quadrant : kTexels)
        for (const int t : quadrant)
            if (id[t] != cluster) return false;
    const QuadrantCentres p = quadrants_of(texels, slot);
    float u[kQuadrants], v[kQuadrants], cos[kQuadrants];
#pragma omp simd
    for (int k = 0; k < kQuadrants; ++k) {
        const MappedTexel at = map_texel<false>(frame, {p.x[k], p.y[k], p.z[k], p.nx[k], p.ny[k], p.nz[k]});
        u[k] = at.u;
        v[k] = at.v;
        cos[k] = at.cos;
    }
    // Cells a metre: the longer of the frame's axes.
    const float scale = kClusterSlack * std::sqrt(std::max(glm::dot(frame.tu, frame.tu), glm::dot(frame.tv, frame.tv)));
    const float half_length = glm::length(displacement.half_shift);
    for (int k = 0; k < kQuadrants; ++k) {
        const float r = scale * std::sqrt(p.radius2[k]);
        const Vec2f position = Vec2f{u[k], v[k]} + displacement.half_shift;
        const float swing = displacement.turn * (glm::length(position + displacement.zero) + half_length + r);
        discs.add(position, cos[k] > 0 ? r + half_length + swing + displacement.extra + 1.5f : kEverywhere);
    }
    return true;
}

void classify_quadrants(const Discs& discs, std::size_t first, ClusterFrame& frame) {
    frame.partial_quadrants = 0;
    for (int k = 0; k < kQuadrants; ++k) {
        const Cover cover = discs.cover(first + k);
        if (cover == Cover::mixed) frame.partial_quadrants |= 1 << k;
        if (cover == Cover::full) frame.full_quadrants |= 1 << k;
    }
}

}  // namespace tuft::footprint
