#include <algorithm>
#include <cmath>

#include "atlas/texels/texel_map.h"
#include "core/simd.h"

namespace tuft::atlas {
namespace {

constexpr float kSteps = 65535;
constexpr float kHalf = 0.5f * kSteps;
// Beyond this many clusters their boxes are looked up texel by texel.
constexpr std::size_t kFewClusters = 6;

float fold(float a, float b) {
    return std::copysign(1 - std::abs(b), a);
}

std::array<std::uint16_t, 2> pack_normal(float x, float y, float z) {
    const float sum = std::abs(x) + std::abs(y) + std::abs(z);
    if (!(sum > 0)) return {32768, 32768};
    float u = x / sum, v = y / sum;
    if (z < 0) {
        const float old = u;
        u = fold(u, v);
        v = fold(v, old);
    }
    const auto step = [](float a) {
        return static_cast<std::uint16_t>(std::clamp(kHalf * (1 + a) + 0.5f, 0.0f, kSteps));
    };
    return {step(u), step(v)};
}

struct Axes {
    float* __restrict x;
    float* __restrict y;
    float* __restrict z;
};

[[gnu::always_inline]] inline void unpack_normal(std::uint16_t nu, std::uint16_t nv, float& x, float& y, float& z) {
    const float u = static_cast<float>(int{nu}) * (1 / kHalf) - 1;
    const float v = static_cast<float>(int{nv}) * (1 / kHalf) - 1;
    const float up = 1 - std::abs(u) - std::abs(v);
    const float below = up < 0 ? -up : 0.0f;
    const float fx = u - std::copysign(below, u), fy = v - std::copysign(below, v);
    const float scale = 1 / std::sqrt(fx * fx + fy * fy + up * up);
    x = fx * scale;
    y = fy * scale;
    z = up * scale;
}

TUFT_CLONES void unpack_normals(const PackedShape& p, TexelShape& s) {
#pragma omp simd
    for (int t = 0; t < kTileTexels; ++t) {
        float x, y, z;
        unpack_normal(p.nu[t], p.nv[t], x, y, z);
        s.nx[t] = x;
        s.ny[t] = y;
        s.nz[t] = z;
    }
}

TUFT_CLONES void unpack_axis(const std::uint16_t* __restrict q, const std::uint8_t* __restrict cluster,
                             std::uint8_t which, float lo, float step, float* __restrict p) {
#pragma omp simd
    for (int t = 0; t < kTileTexels; ++t) {
        const float at = lo + step * static_cast<float>(int{q[t]});
        p[t] = cluster[t] == which ? at : p[t];
    }
}

TUFT_CLONES void unpack_axis(const std::uint16_t* __restrict q, float lo, float step, float* __restrict p) {
#pragma omp simd
    for (int t = 0; t < kTileTexels; ++t) p[t] = lo + step * static_cast<float>(int{q[t]});
}

Vec3f unpack_position(const PackedShape& p, const PackedBox& box, int t) {
    return {box.lo.x + box.step * static_cast<float>(int{p.x[t]}),
            box.lo.y + box.step * static_cast<float>(int{p.y[t]}),
            box.lo.z + box.step * static_cast<float>(int{p.z[t]})};
}

}  // namespace

PackedShape pack_shape(const TexelShape& shape, const TexelTile& tile, std::span<PackedBox> boxes) {
    std::array<Vec3f, kNoCluster> hi;
    const float inf = std::numeric_limits<float>::infinity();
    for (std::size_t k = 0; k < boxes.size(); ++k) {
        boxes[k].lo = Vec3f(inf);
        hi[k] = Vec3f(-inf);
    }
    const auto at = [&](int t) { return Vec3f(shape.px[t], shape.py[t], shape.pz[t]); };
    for (int t = 0; t < kTileTexels; ++t) {
        const std::uint8_t k = tile.cluster[t];
        if (k == kNoCluster) continue;
        boxes[k].lo = glm::min(boxes[k].lo, at(t));
        hi[k] = glm::max(hi[k], at(t));
    }
    for (std::size_t k = 0; k < boxes.size(); ++k) {
        const Vec3f size = hi[k] - boxes[k].lo;
        boxes[k].step = std::max({size.x, size.y, size.z}) / kSteps;
    }
    PackedShape p{};
    for (int t = 0; t < kTileTexels; ++t) {
        const std::uint8_t k = tile.cluster[t];
        if (k == kNoCluster) continue;
        const float per_step = boxes[k].step > 0 ? 1 / boxes[k].step : 0;
        const Vec3f q = glm::clamp((at(t) - boxes[k].lo) * per_step + 0.5f, 0.0f, kSteps);
        p.x[t] = static_cast<std::uint16_t>(q.x);
        p.y[t] = static_cast<std::uint16_t>(q.y);
        p.z[t] = static_cast<std::uint16_t>(q.z);
        const auto n = pack_normal(shape.nx[t], shape.ny[t], shape.nz[t]);
        p.nu[t] = n[0];
        p.nv[t] = n[1];
    }
    return p;
}

const TexelShape& shape_of(const TexelMap& map, std::uint32_t slot, TexelShape& buffer) {
    if (map.packed.empty()) return map.shapes[slot];
    const PackedShape& p = map.packed[slot];
    const std::span boxes =
        std::span(map.boxes).subspan(map.cluster_start[slot], map.cluster_start[slot + 1] - map.cluster_start[slot]);
    const auto& cluster = map.tiles[slot].cluster;
    unpack_normals(p, buffer);
    if (boxes.size() > kFewClusters) {
        for (int t = 0; t < kTileTexels; ++t) {
            const Vec3f at = unpack_position(p, boxes[cluster[t] == kNoCluster ? 0 : cluster[t]], t);
            buffer.px[t] = at.x;
            buffer.py[t] = at.y;
            buffer.pz[t] = at.z;
        }
        return buffer;
    }
    // The first box for all, also for texels that no chart covers: else they kept what the buffer held.
    const PackedBox first = boxes.empty() ? PackedBox{} : boxes.front();
    unpack_axis(p.x.data(), first.lo.x, first.step, buffer.px.data());
    unpack_axis(p.y.data(), first.lo.y, first.step, buffer.py.data());
    unpack_axis(p.z.data(), first.lo.z, first.step, buffer.pz.data());
    for (std::size_t k = 1; k < boxes.size(); ++k) {
        const PackedBox& box = boxes[k];
        const auto which = static_cast<std::uint8_t>(k);
        unpack_axis(p.x.data(), cluster.data(), which, box.lo.x, box.step, buffer.px.data());
        unpack_axis(p.y.data(), cluster.data(), which, box.lo.y, box.step, buffer.py.data());
        unpack_axis(p.z.data(), cluster.data(), which, box.lo.z, box.step, buffer.pz.data());
    }
    return buffer;
}

Vec3f TexelMap::position(std::uint32_t slot, int texel) const {
    if (packed.empty()) {
        const TexelShape& s = shapes[slot];
        return {s.px[texel], s.py[texel], s.pz[texel]};
    }
    const std::uint8_t k = tiles[slot].cluster[texel];
    if (k == kNoCluster) return Vec3f{0};
    return unpack_position(packed[slot], boxes[cluster_start[slot] + k], texel);
}

Vec3f TexelMap::normal(std::uint32_t slot, int texel) const {
    if (packed.empty()) {
        const TexelShape& s = shapes[slot];
        return {s.nx[texel], s.ny[texel], s.nz[texel]};
    }
    Vec3f n;
    unpack_normal(packed[slot].nu[texel], packed[slot].nv[texel], n.x, n.y, n.z);
    return n;
}

}  // namespace tuft::atlas
