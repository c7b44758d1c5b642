#include "ink/texels/relief.h"

#include <algorithm>
#include <cmath>

#include "core/noise.h"
#include "core/random.h"

namespace tuft::ink {
namespace {

/// Noise between values at the corners of unit cubes.
double lumps(const Vec3& p, std::uint64_t seed) {
    const Vec3 cell = glm::floor(p), f = p - cell, g = fade(f);
    const auto x = static_cast<std::int64_t>(cell.x), y = static_cast<std::int64_t>(cell.y),
               z = static_cast<std::int64_t>(cell.z);
    const auto value = [&](int i, int j, int k) {
        // Three whole numbers of 21 bits: lattices of a kilometre at a millimetre.
        const auto key = (static_cast<std::uint64_t>(x + i) & 0x1fffff) |
                         (static_cast<std::uint64_t>(y + j) & 0x1fffff) << 21 |
                         (static_cast<std::uint64_t>(z + k) & 0x1fffff) << 42;
        return 2 * uniform(seed, key) - 1;
    };
    const auto along_x = [&](int j, int k) { return value(0, j, k) + g.x * (value(1, j, k) - value(0, j, k)); };
    const auto along_y = [&](int k) { return along_x(0, k) + g.y * (along_x(1, k) - along_x(0, k)); };
    return along_y(0) + g.z * (along_y(1) - along_y(0));
}

// Mean square of values in [-1, 1] blended so: ⅓ (26/35)³; and of both octaves.
constexpr double kOneOctave = 0.1366399;
constexpr double kFine = 0.6;  // part of the octave of half the size

}  // namespace

double relief_at(const Vec3& point, double length) {
    const Vec3 p = point / (2 * std::max(length, 1e-7));
    const double sum = lumps(p, 17) + kFine * lumps(2.0 * p + 0.37, 18);
    return sum / std::sqrt(kOneOctave * (1 + kFine * kFine));
}

void relief_of_tile(const atlas::TexelShape& tile, double length, std::span<float, atlas::kTileTexels> out) {
    for (int t = 0; t < atlas::kTileTexels; ++t)
        out[t] = static_cast<float>(relief_at({tile.px[t], tile.py[t], tile.pz[t]}, length));
}

void expose_relief(std::span<float, atlas::kTileTexels> exposure, std::span<const float, atlas::kTileTexels> relief,
                   float rms, float film) {
    if (!(rms > 0)) return;
    const float scale = 2 / rms, base = 0.5f + film * scale;
    for (int t = 0; t < atlas::kTileTexels; ++t) exposure[t] *= std::clamp(base - 2 * relief[t], 0.0f, 1.0f);
}

}  // namespace tuft::ink
