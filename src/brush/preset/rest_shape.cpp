#include "brush/preset/rest_shape.h"

#include <algorithm>
#include <cmath>

namespace tuft::brush {

double rest_radius(const Preset& p, double u) {
    u = std::clamp(u, 0.0, 1.0);
    if (is_foam(p)) {
        const double over = (u - 1) * p.length + p.rim;
        return over > 0 ? p.radius - p.rim + std::sqrt(std::max(0.0, p.rim * p.rim - over * over)) : p.radius;
    }
    const double taper = std::pow(std::max(0.0, 1 - std::pow(u, 2.4)), p.tip_power);
    return std::hypot(1.06 * p.radius * taper * (1 - 0.14 * std::pow(1 - u, 6)), p.tip_radius);
}

Profile profile_of(const Preset& p) {
    return {p.alpha, p.beta, p.yield, p.gamma, p.tip_stiffness};
}

}  // namespace tuft::brush
