#include "stroke/contact/stamp.h"

#include <algorithm>
#include <span>

#include "core/simd.h"

namespace tuft::stroke {

namespace {

constexpr std::size_t kLanes = 64;
constexpr std::size_t kMostRounds = 257;  // of bytes that a lane of 16 bits holds

/// Sum of at most kMostRounds times kLanes bytes.
TUFT_CLONES std::uint32_t sum_of_lanes(const std::uint8_t* __restrict bytes, std::size_t rounds) {
    std::uint16_t lane[kLanes] = {};
    for (std::size_t k = 0; k < rounds; ++k)
        for (std::size_t t = 0; t < kLanes; ++t) lane[t] = static_cast<std::uint16_t>(lane[t] + bytes[kLanes * k + t]);
    std::uint32_t sum = 0;
    for (const std::uint16_t l : lane) sum += l;
    return sum;
}

std::size_t sum_of(std::span<const std::uint8_t> bytes) {
    std::size_t sum = 0, at = 0;
    while (at + kLanes <= bytes.size()) {
        const std::size_t rounds = std::min(kMostRounds, (bytes.size() - at) / kLanes);
        sum += sum_of_lanes(bytes.data() + at, rounds);
        at += kLanes * rounds;
    }
    for (; at < bytes.size(); ++at) sum += bytes[at];
    return sum;
}

}  // namespace

double covered_area(const footprint::Footprint& f) {
    return static_cast<double>(sum_of(f.coverage)) / 255.0 * f.cell * f.cell;
}

footprint::Motion joined_motion(const Stamp& stamp, double texel) {
    footprint::Motion motion = stamp.motion;
    const double distance = glm::length(motion.shift);
    if (stamp.separation > 0 && distance > 0)
        motion.shift *= 1 + static_cast<double>(stamp.separation) * texel / distance;
    return motion;
}

footprint::StampOptions stamp_options(const footprint::StampOptions& base, const Stamp& stamp) {
    footprint::StampOptions options = base;
    options.max_weight = stamp.separation;
    return options;
}

}  // namespace tuft::stroke
