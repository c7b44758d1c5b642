#include "brush/tuft/upright_hair.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "core/ease.h"

namespace tuft::brush {

namespace {

using Complex = std::complex<double>;

constexpr double kBuiltIn = 0.05;                ///< |w| of a tuft as it is bound: its ends do not lie quite evenly
constexpr double kTurnsAt = 0.15, kDrawn = 0.5;  ///< |w|, see upright_hair.h
constexpr double kElsewhere = 0.4;               ///< radians: hair no further from its mean its friction turns
constexpr double kLeastReach = 0.02;             ///< of the length, ρ at the first touch

Vec3 second_side(const rod::Clamp& c) {
    return glm::cross(c.tangent, c.side);
}

/// Across the clamp's axis.
Complex across(const rod::Clamp& c, const Vec3& v) {
    return {glm::dot(v, c.side), glm::dot(v, second_side(c))};
}

/// Hair in the air over a surface: how one-sided it will be when it touches, as a part of its taper.
Complex free_side(const Preset& p, const Spine& spine, const Vec3& normal) {
    const rod::Clamp& c = spine.memory.clamp;
    // The end slides down the slope that the surface has across the axis, or goes where it is bent to.
    const Complex lean = across(c, normal), bend = across(c, spine.memory.tangent.back());
    const Complex side = (bend - lean) * (p.length / p.radius);
    const double size = std::abs(side);
    return size < kBuiltIn ? Complex(kBuiltIn, 0) : side / std::max(size, 1.0);
}

}  // namespace

void turn_with_spread(const Preset& p, Spine& spine, const Pose& from, const Pose& to,
                      std::span<const ContactPlane> planes) {
    rod::Memory& m = spine.memory;
    bool touching = false;
    for (const rod::ContactMemory& c : m.contact) touching = touching || c.touching;
    if (planes.empty()) return;
    if (!touching) {
        const Complex side = free_side(p, spine, planes.front().normal);
        spine.one_sided = {side.real(), side.imag()};
        return;
    }
    const Complex tip = across(m.clamp, m.node.back() - m.clamp.position);
    Complex w(spine.one_sided.x, spine.one_sided.y);
    Vec3 moved = (to.position - from.position) / p.length;
    moved -= glm::dot(moved, planes.front().normal) * planes.front().normal;
    const double reach = std::max(std::abs(tip), kLeastReach);
    const Complex u = -across(m.clamp, moved) / (2 * reach);
    // In the disc's own measure a step is a translation, however long.
    const double size = std::abs(u);
    if (size > 0) {
        const Complex shift = std::tanh(size) * u / size;
        w = (w + shift) / (1.0 + std::conj(shift) * w);
    }
    const double side = std::abs(w);
    const double off = side > 0 && std::abs(tip) > 1e-6 ? std::arg(w / tip) : 0;
    if (size > 0 && side > kTurnsAt && side < kDrawn && std::abs(off) > kElsewhere) rod::turn_about_clamp(m, off);
    if (side > kDrawn) w /= side;
    spine.one_sided = {w.real(), w.imag()};
}

UprightHair upright_hair_of(const Tuft& tuft, const ContactPlane& tip) {
    UprightHair foot;
    const Preset& p = tuft.preset;
    const double down = -glm::dot(tuft.pose.axis(), tip.normal);
    const double height = glm::dot(tuft.pose.position - tip.origin, tip.normal);
    if (tuft.split || has_broad_side(p) || tuft.wide() || p.spine == SpineMethod::table || !(down > 0.1) ||
        !(height > 0) || height >= down * p.length)
        return foot;
    foot.centre = tuft.pose.position + height / down * tuft.pose.axis();
    foot.radius = rest_radius(p, height / down / p.length);
    const double side = glm::length(tuft.trunk().one_sided);
    foot.share = smooth_step((kDrawn - side) / (kDrawn - kBuiltIn));
    return foot;
}

}  // namespace tuft::brush
