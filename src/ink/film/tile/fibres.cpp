#include "ink/film/tile/fibres.h"

#include <algorithm>
#include <cmath>

#include "core/ease.h"
#include "core/random.h"
#include "ink/elementary.h"

namespace tuft::ink::wet {
namespace {

constexpr std::uint64_t kGrainSeed = 0x66696c6d, kFibreSeed = 0x66696272;
constexpr double kFlocsRms = 0.437;  // of the octaves' sum
constexpr double kLeastEase = -2, kMostEase = 1.2;

// Bast fibres of raw paper are 2 to 3 mm long and 0.01 mm thick, those of straw 1 mm; they lie in bundles.
constexpr double kShortest = 0.5e-3, kLongest = 1e-3;  // half the length, metres
constexpr double kWidth = 0.15e-3;                     // half of where a bundle draws, metres
constexpr double kBend = 0.35;                         // most sagitta, of half the length
constexpr double kDepth = 0.5e-3;                      // metres: so far off the surface a fibre's middle counts
constexpr double kCell = 1.35e-3;                      // metres: further than any reaches
constexpr int kPerCell = 16;
constexpr double kOfTexel = 0.7;               // of a texel: what it adds to the width
constexpr double kLeastUpright = 0.05;         // (1 − (n·d)²) below which a fibre stands on end and is none
constexpr double kMean = 0.462, kRms = 0.475;  // of the sum over fibres on fine texels
constexpr double kWidest = 6 * kWidth;         // texels on which no fibre shows

double lattice(std::int64_t x, std::int64_t y, std::int64_t z) {
    const auto bits = [](std::int64_t v) { return static_cast<std::uint64_t>(v) & 0x1fffff; };
    return uniform(kGrainSeed, bits(x) << 42 | bits(y) << 21 | bits(z));
}

/// exp(x), the same bits everywhere.
double exponential(double x) {
    const auto e = static_cast<double>(exp_minus(static_cast<float>(std::abs(x))));
    return x > 0 ? 1 / e : e;
}

/// Clouds of fibres and pores as sponges and papers have them: noise of mean 0 and rms 1 in octaves.
double flocs(const Vec3& position) {
    const double sum = 0.5 * place_noise(position, 2 * kGrainLength) + 0.8 * place_noise(position, kGrainLength) +
                       0.8 * place_noise(position, 0.5 * kGrainLength) +
                       0.6 * place_noise(position, 0.25 * kGrainLength);
    return std::clamp(sum / kFlocsRms, kLeastEase, kMostEase);
}

/// (1 − q)² of a square q.
double hump(double q) {
    return q < 1 ? (1 - q) * (1 - q) : 0;
}

}  // namespace

double place_noise(const Vec3& position, double length) {
    const Vec3 p = position / length, floor = glm::floor(p), f = p - floor;
    const Vec3 s = fade(f);
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
        const double weight = (i ? s.x : 1 - s.x) * (j ? s.y : 1 - s.y) * (k ? s.z : 1 - s.z);
        sum += weight * lattice(static_cast<std::int64_t>(floor.x) + i, static_cast<std::int64_t>(floor.y) + j,
                                static_cast<std::int64_t>(floor.z) + k);
    }
    return 2 * sum - 1;
}

Fibres::Fibres(double texel_size)
    : width_(std::hypot(kWidth, kOfTexel * texel_size)), strength_(texel_size < kWidest ? kWidth / width_ / kRms : 0) {}

const std::vector<Fibres::Fibre>& Fibres::near(const Vec3& position) {
    const Vec3 floor = glm::floor(position / kCell);
    const Cell cell{static_cast<std::int64_t>(floor.x), static_cast<std::int64_t>(floor.y),
                    static_cast<std::int64_t>(floor.z)};
    Near& near = near_[static_cast<std::size_t>((cell[0] & 1) | (cell[1] & 1) << 1 | (cell[2] & 1) << 2)];
    if (near.known && near.cell == cell) return near.fibres;
    near.known = true;
    near.cell = cell;
    near.fibres.clear();
    for (int around = 0; around < 27; ++around) {
        const Cell at{cell[0] + around % 3 - 1, cell[1] + around / 3 % 3 - 1, cell[2] + around / 9 - 1};
        std::uint64_t key = 0;
        for (const std::int64_t i : at) key = key << 21 | (static_cast<std::uint64_t>(i) & 0x1fffff);
        Random random(hash_bits(kFibreSeed, key));
        for (int i = 0; i < kPerCell; ++i) {
            Vec3 middle, direction;
            for (int k = 0; k < 3; ++k)
                middle[k] = kCell * (static_cast<double>(at[static_cast<std::size_t>(k)]) + random.uniform());
            do
                for (int k = 0; k < 3; ++k) direction[k] = random.uniform(-1, 1);
            while (glm::dot(direction, direction) > 1 || glm::dot(direction, direction) < 1e-3);
            const double half = random.uniform(kShortest, kLongest), bend = random.uniform(-kBend, kBend);
            near.fibres.push_back({middle, glm::normalize(direction), half, bend});
        }
    }
    return near.fibres;
}

double Fibres::at(const Vec3& position, const Vec3& normal) {
    if (!(strength_ > 0)) return 0;
    double sum = 0;
    for (const Fibre& f : near(position)) {
        const Vec3 from = position - f.middle;
        const double height = glm::dot(from, normal), depth = hump(height * height / (kDepth * kDepth));
        if (!(depth > 0)) continue;
        const double rise = glm::dot(f.direction, normal), flat = 1 - rise * rise;
        if (flat < kLeastUpright) continue;
        const double length = std::sqrt(flat), half = f.half * length;
        const double along = (glm::dot(from, f.direction) - height * rise) / length, part = along / half;
        const double ends = hump(part * part * part * part);
        if (!(ends > 0)) continue;
        const double across = glm::dot(from, glm::cross(normal, f.direction)) / length - f.bend * half * part * part;
        sum += depth * ends * hump(across * across / (width_ * width_));
    }
    return strength_ * sum - kMean / kRms;
}

EaseOfFlow::EaseOfFlow(const FlowMedium& medium, double texel_size)
    : unevenness_(medium.unevenness),
      of_clouds_(std::sqrt(1 - medium.fibrous)),
      of_fibres_(std::sqrt(medium.fibrous)),
      fibres_(texel_size) {}

double EaseOfFlow::root_at(const Vec3& position, const Vec3& normal) {
    if (!(unevenness_ > 0)) return 1;
    const double noise =
        of_clouds_ * flocs(position) + (of_fibres_ > 0 ? of_fibres_ * fibres_.at(position, normal) : 0);
    return exponential(0.5 * unevenness_ * std::clamp(noise, kLeastEase, kMostEase));  // the fastest sets the steps
}

}  // namespace tuft::ink::wet
