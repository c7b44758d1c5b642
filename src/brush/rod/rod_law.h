#pragma once

#include "brush/rod/law.h"

/// \file
/// Contact law of one point: normal force, adhesion and their potentials. Internal to the rod solver.
namespace tuft::brush::rod {

/// Normal force at an indentation: potential, force and stiffness.
struct NormalForce {
    double energy = 0, force = 0, stiffness = 0;
};

/// Returns a spring of stiffness k on x > 0. Its stiffness rises linearly from 0 over `onset`.
inline NormalForce ramp(double k, double x, double onset) {
    if (x < onset) return {k * x * x * x / (6 * onset), 0.5 * k * x * x / onset, k * x / onset};
    const double y = x - 0.5 * onset;
    return {0.5 * k * y * y + k * onset * onset / 24, k * y, k};
}

/// Returns the normal force of a node that is `depth` below its plane.
inline NormalForce normal_force(const NormalLaw& law, double weight, double radius, double depth, double multiplier) {
    if (law.hard) {
        const double k = law.stiffness * weight, force = multiplier + k * depth;
        if (force <= 0) return {-multiplier * multiplier / (2 * k), 0, 0};
        return {(force * force - multiplier * multiplier) / (2 * k), force, k};
    }
    if (depth <= 0) return {};
    NormalForce out = ramp(law.stiffness * weight, depth, law.onset);
    const double packed = depth - law.core_start * radius;
    if (packed > 0) {
        const NormalForce core = ramp(law.core_stiffness * weight, packed, law.onset);
        out.energy += core.energy;
        out.force += core.force;
        out.stiffness += core.stiffness;
    }
    return out;
}

/// Returns the adhesion of the wet film at `gap` (negative: indented). Its potential is 0 at the end of its range.
inline NormalForce adhesion(const AdhesionLaw& law, double weight, double gap) {
    if (law.strength <= 0 || gap >= law.range) return {};
    const double pull = law.strength * weight, range = law.range;
    if (gap <= 0) return {pull * (gap - range / 3), pull, 0};
    const double u = 1 - gap / range;
    return {-pull * range / 3 * u * u * u, pull * u * u, -2 * pull * u / range};
}

}  // namespace tuft::brush::rod
