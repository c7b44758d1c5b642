#pragma once

#include <cstdint>

#include "core/ease.h"
#include "core/geometry/types.h"
#include "core/random.h"

/// \file
/// Value noise in space, for grain that is a function of position alone. `ink` uses it for the height of the substrate,
/// `footprint` for the edge of wet ink on it.
namespace tuft {

/// Returns the value at a corner of the unit lattice, uniform in [−1, 1). The lattice repeats after 2²¹ cells: a
/// kilometre with cells of half a millimetre.
inline double solid_noise_corner(std::int64_t x, std::int64_t y, std::int64_t z, std::uint64_t seed) {
    const auto key = (static_cast<std::uint64_t>(x) & 0x1fffff) | (static_cast<std::uint64_t>(y) & 0x1fffff) << 21 |
                     (static_cast<std::uint64_t>(z) & 0x1fffff) << 42;
    return 2 * uniform(seed, key) - 1;
}

/// Returns the noise at a point: corner(i, j, k) of the cell round it, 0 or 1 each, blended by 3f² − 2f³ along x, then
/// y, then z.
template <class Corner>
double blend_corners(const Vec3& part_of_cell, Corner&& corner) {
    const Vec3 g = fade(part_of_cell);
    const auto along_x = [&](int j, int k) {
        const double a = corner(0, j, k);
        return a + g.x * (corner(1, j, k) - a);
    };
    const auto along_y = [&](int k) {
        const double a = along_x(0, k);
        return a + g.y * (along_x(1, k) - a);
    };
    const double a = along_y(0);
    return a + g.z * (along_y(1) - a);
}

/// Returns the noise of `seed` at a point, in cells of the lattice; in [−1, 1], mean square ⅓ (26/35)³.
inline double solid_noise(const Vec3& p, std::uint64_t seed) {
    const Vec3 cell = glm::floor(p);
    const auto x = static_cast<std::int64_t>(cell.x), y = static_cast<std::int64_t>(cell.y),
               z = static_cast<std::int64_t>(cell.z);
    return blend_corners(p - cell, [&](int i, int j, int k) { return solid_noise_corner(x + i, y + j, z + k, seed); });
}

/// Mean square of `solid_noise`.
inline constexpr double kSolidNoiseSquare = 0.1366399;

}  // namespace tuft
