#pragma once

#include "atlas/texels/log_map.h"
#include "footprint/stamp/stamp.h"

/// \file
/// Map from a texel to its position in a footprint's picture. Shared by the stamp kernel and the planner.
namespace tuft::footprint {

/// A texel's centre, metres, and unit normal, world.
struct TexelPoint {
    float px, py, pz, nx, ny, nz;
};

/// A position in the picture, cells, and the dot product of the texel's normal with the frame's.
struct MappedTexel {
    float u, v, cos;
};

/// Computes the log map of `atlas::log_map` in single precision, or with `plane` the paper's projection. Where `cos` ≤
/// kLogMapMinCos the position is undefined. Inlined for any instruction set, with the same bits in all.
template <bool plane>
[[gnu::always_inline]] inline MappedTexel map_texel(const ClusterFrame& f, const TexelPoint& texel) {
    constexpr auto& q = atlas::kLogMapSeries;
    constexpr float q0 = float(0.5 * q[0]), q1 = float(0.5 * q[1]), q2 = float(0.5 * q[2]);
    constexpr float q3 = float(0.5 * q[3]), q4 = float(0.5 * q[4]), q5 = float(0.5 * q[5]);
    constexpr float q6 = float(0.5 * q[6]), q7 = float(0.5 * q[7]);
    const float nx = f.normal.x, ny = f.normal.y, nz = f.normal.z;
    const float mx = texel.nx, my = texel.ny, mz = texel.nz;
    const float dx = texel.px - f.origin.x, dy = texel.py - f.origin.y, dz = texel.pz - f.origin.z;
    const float c = mx * nx + my * ny + mz * nz;
    const float nd = nx * dx + ny * dy + nz * dz;
    const float inside = c > float(atlas::kLogMapMinCos) ? c : 0.0f;
    float h;
    if constexpr (plane) {
        const float slope = inside > 0.05f ? inside : 0.05f;
        h = -nd / slope;
    } else {
        const float md = mx * dx + my * dy + mz * dz;
        const float x = 1 - inside;
        const float half_series = ((((((q7 * x + q6) * x + q5) * x + q4) * x + q3) * x + q2) * x + q1) * x + q0;
        h = half_series * (md - nd) - (md + nd) / (2 + 2 * inside);
    }
    const float u = f.u0 + (dx * f.tu.x + dy * f.tu.y + dz * f.tu.z) + h * (mx * f.tu.x + my * f.tu.y + mz * f.tu.z);
    const float v = f.v0 + (dx * f.tv.x + dy * f.tv.y + dz * f.tv.z) + h * (mx * f.tv.x + my * f.tv.y + mz * f.tv.z);
    return {u, v, c};
}

}  // namespace tuft::footprint
