#include "brush/papers/macro/macro_skeleton.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tuft::brush::macro {

namespace {

constexpr double kBelow = 1e-12;  ///< m, a node so little below is on the surface
constexpr double kPi = std::numbers::pi;

/// The last node from the tip that is below its half space, or none.
std::size_t last_below(std::span<const Vec3> nodes, std::span<const HalfSpace> above) {
    for (std::size_t i = nodes.size(); i-- > 0;)
        if (above[i].height(nodes[i]) < -kBelow) return i;
    return nodes.size();
}

/// Part of `v` along the surface.
Vec3 tangential(const Vec3& v, const Vec3& n) {
    return v - glm::dot(v, n) * n;
}

/// Direction on the surface in which the hair beyond the pivot points.
Vec3 fall_direction(const Vec3& tipward, const Vec3& n, const SkeletonLaw& law) {
    const Vec3 lean = tangential(tipward, n);
    const double size = glm::length(tipward), run = glm::length(lean);
    if (size > 0 && run > law.upright * size) return lean / run;
    const Vec3 aside = tangential(law.aside, n);
    if (glm::length(aside) > 1e-9) return glm::normalize(aside);
    return run > 0 ? lean / run : make_frame({}, n).t;
}

/// Turn about an axis through the pivot that lifts from `along` to the normal.
struct Hinge {
    Vec3 pivot{0}, axis{0, 1, 0};

    Vec3 turned(const Vec3& p, double angle) const { return pivot + glm::angleAxis(angle, axis) * (p - pivot); }
};

/// Least angle >= `from` that brings p out of its half space; `from` where no angle does.
double least_turn(const Hinge& hinge, const Vec3& p, const HalfSpace& space, double from) {
    const Vec3 q = p - hinge.pivot, axial = glm::dot(q, hinge.axis) * hinge.axis;
    const Vec3 flat = q - axial;
    // Height over the half space: c cos φ + s sin φ + rest.
    const double c = glm::dot(flat, space.normal), s = glm::dot(glm::cross(hinge.axis, flat), space.normal);
    const double rest = space.height(hinge.pivot + axial), reach = std::hypot(c, s);
    if (c * std::cos(from) + s * std::sin(from) + rest >= -kBelow || reach <= -rest) return from;
    double angle = std::atan2(s, c) - std::acos(std::clamp(-rest / reach, -1.0, 1.0));
    while (angle < from) angle += 2 * kPi;
    return angle;
}

/// φ_min: the least turn for all nodes beyond the pivot; where there is none up to a half turn, the last tried.
double least_turn_of_all(const Hinge& hinge, std::span<const Vec3> nodes, std::span<const HalfSpace> above) {
    constexpr int kRounds = 8;
    double angle = 0;
    for (int round = 0; round < kRounds; ++round) {
        const double before = angle;
        for (std::size_t i = 0; i < nodes.size(); ++i)
            angle = std::min(least_turn(hinge, nodes[i], above[i], angle), kPi);
        if (angle == before) break;
    }
    return angle;
}

}  // namespace

BentSkeleton deform_skeleton(std::span<const Vec3> nodes, std::span<const double> t, std::span<const HalfSpace> above,
                             const SkeletonLaw& law) {
    BentSkeleton bent{.nodes = {nodes.begin(), nodes.end()}};
    if (above.empty()) return bent;
    const std::size_t below = last_below(nodes, above), count = nodes.size();
    if (below == count) return bent;
    bent.touching = true;
    bent.touch = t[below];
    bent.pivot = above[below].projected(nodes[below]);
    if (below + 1 < count) {
        const double z = above[below].height(nodes[below]), next = above[below].height(nodes[below + 1]);
        const double f = next > z ? std::clamp(z / (z - next), 0.0, 1.0) : 0;
        bent.pivot = glm::mix(nodes[below], nodes[below + 1], f);
        bent.touch = std::lerp(t[below], t[below + 1], f);
    }
    const Vec3& n = above[below].normal;
    const std::size_t outer = below + 1 < count ? below : below - 1;
    const std::span<const Vec3> whole = law.trunk.empty() ? nodes : law.trunk;
    const Vec3 tipward = whole[outer] - whole[outer + 1];
    bent.along = fall_direction(tipward, n, law);
    const Hinge hinge{bent.pivot, glm::normalize(glm::cross(bent.along, n))};
    bent.turn = least_turn_of_all(hinge, nodes.first(below + 1), above.first(below + 1));
    for (std::size_t i = 0; i <= below; ++i) {
        const Vec3 projected = above[i].projected(nodes[i]);
        const Vec3 rotated = above[i].projected(hinge.turned(nodes[i], bent.turn));
        bent.nodes[i] = above[i].projected(glm::mix(projected, rotated, law.rigidity));
    }
    return bent;
}

double arc_half_angle(double ratio) {
    ratio = std::clamp(ratio, 0.0, 1.0);
    // sin α/α falls from 1 at 0 to 0 at π.
    double low = 0, high = kPi;
    for (int i = 0; i < 52; ++i) {
        const double middle = 0.5 * (low + high);
        (std::sin(middle) > ratio * middle ? low : high) = middle;
    }
    return ratio < 1 ? 0.5 * (low + high) : 0;
}

void add_kink(BentSkeleton& bent, std::span<const double> t, std::span<const HalfSpace> above, double length,
              double held) {
    if (!bent.touching || held <= 0 || bent.touch <= 0) return;
    const Vec3 chord = bent.nodes.front() - bent.pivot;
    const double c = glm::length(chord), s = c + held * (length * bent.touch - c);
    if (s <= c * (1 + 1e-9)) return;
    const double alpha = arc_half_angle(c / s), radius = s / (2 * alpha);
    const Vec3 along = c > 1e-12 ? chord / c : bent.along;
    for (std::size_t i = 0; i < bent.nodes.size() && t[i] < bent.touch; ++i) {
        const double f = 1 - t[i] / bent.touch, angle = alpha * (2 * f - 1);
        const double forward = radius * (std::sin(alpha) + std::sin(angle)) - f * c;
        const double up = radius * (std::cos(angle) - std::cos(alpha));
        bent.nodes[i] = above[i].projected(bent.nodes[i] + forward * along + up * above[i].normal);
    }
}

}  // namespace tuft::brush::macro
