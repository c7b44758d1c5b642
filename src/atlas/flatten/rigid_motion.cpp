#include "atlas/flatten/rigid_motion.h"

#include <cmath>

namespace tuft::atlas {

RigidMotion fit_motion(std::span<const std::array<Vec2, 2>> pairs) {
    RigidMotion m;
    if (pairs.empty()) return m;
    Vec2 mean_p(0), mean_q(0);
    for (const auto& [p, q] : pairs) {
        mean_p += p;
        mean_q += q;
    }
    mean_p /= double(pairs.size());
    mean_q /= double(pairs.size());
    double c = 0, s = 0;
    for (const auto& [p, q] : pairs) {
        const Vec2 u = p - mean_p, v = q - mean_q;
        c += glm::dot(u, v);
        s += u.y * v.x - u.x * v.y;
    }
    const double norm = std::hypot(c, s);
    if (norm > 0) {
        m.c = c / norm;
        m.s = s / norm;
    }
    m.shift = mean_p - Vec2(m.c * mean_q.x - m.s * mean_q.y, m.s * mean_q.x + m.c * mean_q.y);
    return m;
}

}  // namespace tuft::atlas
