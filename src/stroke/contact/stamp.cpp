#include "stroke/contact/stamp.h"

#include "core/simd.h"

namespace tuft::stroke {

TUFT_CLONES static std::uint32_t sum_of(const std::uint8_t* coverage, int n) {
    std::uint32_t sum = 0;
    for (int i = 0; i < n; ++i) sum += coverage[i];
    return sum;
}

double covered_area(const footprint::Footprint& f) {
    std::size_t sum = 0;
    for (std::size_t row = 0; row < f.coverage.size(); row += static_cast<std::size_t>(f.width))
        sum += sum_of(f.coverage.data() + row, f.width);
    return static_cast<double>(sum) / 255.0 * f.cell * f.cell;
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
