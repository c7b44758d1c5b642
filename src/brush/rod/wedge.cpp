#include "brush/rod/wedge.h"

#include <algorithm>
#include <cmath>

namespace tuft::brush {

Distance edge_distance(const Wedge& w, double rounding, const Vec3& x) {
    const double c = glm::dot(w.normal[0], w.normal[1]), apart = 1 - c * c;
    // Sharper than 90°, the ridge would lie ρ (√(2/(1+c)) - 1) under the edge.
    if (c < 0) rounding *= (std::sqrt(2.0) - 1) / (std::sqrt(2 / std::max(1 + c, 1e-9)) - 1);
    const double z0 = glm::dot(x - w.origin[0], w.normal[0]), in0 = z0 + rounding;
    const double z1 = glm::dot(x - w.origin[1], w.normal[1]), in1 = z1 + rounding;
    if (apart > 1e-9) {
        // From the ridge of the planes moved in, the point lies at u n0 + v n1 across the edge.
        const double u = (in0 - c * in1) / apart, v = (in1 - c * in0) / apart;
        if (u > 0 && v > 0) {
            const Vec3 away = u * w.normal[0] + v * w.normal[1];
            const double far = glm::length(away);
            if (far > 1e-12) {
                const Vec3 n = away / far;
                const Vec3 along = glm::cross(w.normal[0], w.normal[1]);
                return {far - rounding, n, 1 / far, glm::cross(along, n) / std::sqrt(apart)};
            }
        }
    }
    return z0 > z1 ? Distance{z0, w.normal[0]} : Distance{z1, w.normal[1]};
}

Distance corner_distance(const Wedge& w, double rounding, const Vec3& x) {
    const double z0 = glm::dot(x - w.origin[0], w.normal[0]);
    const double z1 = glm::dot(x - w.origin[1], w.normal[1]), apart = z1 - z0;
    const double w0 = std::clamp(0.5 + 0.5 * apart / rounding, 0.0, 1.0);
    const double round = std::max(0.0, rounding - std::abs(apart));
    Distance out{(apart > 0 ? z0 : z1) - round * round / (4 * rounding), w0 * w.normal[0] + (1 - w0) * w.normal[1]};
    if (round > 0) {
        out.bend = -1 / (2 * rounding);
        out.across = w.normal[0] - w.normal[1];
    }
    return out;
}

}  // namespace tuft::brush
