#pragma once

#include <algorithm>

#include "core/geometry/types.h"

namespace tuft {

/// Part of the way from a to b, in [0, 1], at which the segment comes nearest to p; 0 where a = b.
template <class Vec>
auto nearest_part(const Vec& a, const Vec& b, const Vec& p) {
    using Real = typename Vec::value_type;
    const Vec way = b - a;
    const Real length2 = glm::dot(way, way);
    return length2 > 0 ? std::clamp(glm::dot(p - a, way) / length2, Real(0), Real(1)) : Real(0);
}

/// Distance of p from the segment a–b.
template <class Vec>
auto segment_distance(const Vec& a, const Vec& b, const Vec& p) {
    return glm::length((p - a) - nearest_part(a, b, p) * (b - a));
}

}  // namespace tuft
