#include "brush/rod/wedge.h"

#include <algorithm>
#include <cmath>

namespace tuft::brush {

RoundedEdge round_edge(const Wedge& w, double rounding) {
    RoundedEdge out{.wedge = w, .rounding = rounding, .c = glm::dot(w.normal[0], w.normal[1])};
    const double c = out.c, apart = 1 - c * c;
    // Sharper than 90°, the ridge would lie ρ (√(2/(1+c)) - 1) under the edge.
    if (c < 0) out.rounding *= (std::sqrt(2.0) - 1) / (std::sqrt(2 / std::max(1 + c, 1e-9)) - 1);
    if (apart > 1e-9) {
        out.per_apart = 1 / apart;
        out.ridge = glm::cross(w.normal[0], w.normal[1]) / std::sqrt(apart);
    }
    return out;
}

Distance edge_distance(const Wedge& wedge, double rounding, const Vec3& x) {
    return edge_distance(round_edge(wedge, rounding), x);
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
