#include "ink/texels/relief.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/geometry/solid_noise.h"

namespace tuft::ink {
namespace {

/// Noise of one seed with its corners stored over the box of a tile: neighbouring texels share them.
class TileNoise {
  public:
    /// `box`: of all points that are asked for, in cells of the lattice.
    TileNoise(const Box& box, std::uint64_t seed) : seed_(seed), lo_(glm::floor(box.lo)) {
        const Vec3 size = glm::floor(box.hi) - lo_ + 2.0;
        if (!(size.x * size.y * size.z <= kMostCorners)) return;  // of texels that lie apart, or nowhere
        for (int k = 0; k < 3; ++k) size_[k] = static_cast<int>(size[k]);
        corners_.reserve(static_cast<std::size_t>(size_[0] * size_[1] * size_[2]));
        const auto x = static_cast<std::int64_t>(lo_.x), y = static_cast<std::int64_t>(lo_.y),
                   z = static_cast<std::int64_t>(lo_.z);
        for (int k = 0; k < size_[2]; ++k)
            for (int j = 0; j < size_[1]; ++j)
                for (int i = 0; i < size_[0]; ++i) corners_.push_back(solid_noise_corner(x + i, y + j, z + k, seed));
    }

    /// `solid_noise` at the point, to the bit.
    double at(const Vec3& p) const {
        if (corners_.empty()) return solid_noise(p, seed_);
        const Vec3 cell = glm::floor(p), from = cell - lo_;
        const int first =
            static_cast<int>(from.x) + size_[0] * (static_cast<int>(from.y) + size_[1] * static_cast<int>(from.z));
        return blend_corners(p - cell, [&](int i, int j, int k) {
            return corners_[static_cast<std::size_t>(first + i + size_[0] * (j + size_[1] * k))];
        });
    }

  private:
    static constexpr double kMostCorners = 4096;
    std::uint64_t seed_;
    Vec3 lo_;
    int size_[3] = {};
    std::vector<double> corners_;  // empty: too many
};

constexpr double kFine = 0.6;        // part of the octave of half the size
constexpr double kFineShift = 0.37;  // cells
constexpr std::uint64_t kSeed = 17, kFineSeed = 18;

Vec3 to_lattice(const Vec3& point, double length) {
    return point / (2 * std::max(length, 1e-7));
}

double of_unit_rms(double coarse, double fine) {
    return (coarse + kFine * fine) / std::sqrt(kSolidNoiseSquare * (1 + kFine * kFine));
}

}  // namespace

double relief_at(const Vec3& point, double length) {
    const Vec3 p = to_lattice(point, length);
    return of_unit_rms(solid_noise(p, kSeed), solid_noise(2.0 * p + kFineShift, kFineSeed));
}

void relief_of_tile(const atlas::TexelShape& tile, double length, std::span<float, atlas::kTileTexels> out) {
    const auto point = [&](int t) { return to_lattice({tile.px[t], tile.py[t], tile.pz[t]}, length); };
    Box box, fine_box;
    for (int t = 0; t < atlas::kTileTexels; ++t) {
        const Vec3 p = point(t);
        box.add(p);
        fine_box.add(2.0 * p + kFineShift);
    }
    const TileNoise coarse(box, kSeed), fine(fine_box, kFineSeed);
    for (int t = 0; t < atlas::kTileTexels; ++t) {
        const Vec3 p = point(t);
        out[t] = static_cast<float>(of_unit_rms(coarse.at(p), fine.at(2.0 * p + kFineShift)));
    }
}

void expose_relief(std::span<float, atlas::kTileTexels> exposure, std::span<const float, atlas::kTileTexels> relief,
                   float rms, float film) {
    if (!(rms > 0)) return;
    const float scale = 2 / rms, base = 0.5f + film * scale;
    for (int t = 0; t < atlas::kTileTexels; ++t) exposure[t] *= std::clamp(base - 2 * relief[t], 0.0f, 1.0f);
}

}  // namespace tuft::ink
