#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/geometry/types.h"

/// \file
/// Figures of force-feedback arms: what an arm can bear, and how stiff the law may be on it. The law (law.h) and the
/// simulated arm (simulated.h) read them.
namespace tuft::haptic {

inline constexpr double kPeriod = 1e-3;     ///< T, s: period of the law
inline constexpr double kForceLimit = 7.9;  ///< N, of any device: the limit of the papers' arm [Huang2018]

/// One arm. Forces in newtons, lengths in metres, all at the tip of the arm.
struct DeviceLimits {
    std::string_view name;
    std::string_view title;
    double max_force = 0;      ///< N, published
    double max_stiffness = 0;  ///< k_max, N/m, published
    double max_torque = 0;     ///< N·m; 0: the arm has no motors in its wrist
    Vec3 workspace{0};         ///< m, extents along x, y, z, published
    double friction = 0;       ///< f_c, N, Coulomb friction, assumed
    double count = 0;          ///< m, quantisation of the position, published or assumed
    double mass = 0;           ///< kg, apparent, assumed
    double damping = 0;        ///< N s/m, viscous, assumed
    double coupling = 0;       ///< K, N/m, of the virtual coupling
};

/// The known arms. Touch: 3.3 N, 55 µm (3D Systems data sheet). Falcon: 8 N, 60 µm (Novint data sheet). omega.6: 12 N,
/// 10 µm (Force Dimension data sheet). Inverse3: 8 N, 2 N/mm. k_max of the first three is the greatest stiffness
/// without oscillation in published measurements. Masses, friction and damping are assumed.
std::span<const DeviceLimits> device_presets();

/// Throws `Error` for an unknown name.
const DeviceLimits& device_preset(std::string_view name);

/// Returns the stiffness of the coupling for a delay of the whole loop, s: min(K, 4000 N/m · 2^(−delay / 1 ms)). The
/// tank pairs a force with the place where it was computed and cannot see a delay. With 3 ms omega.6 at 2,000 N/m
/// returns 0.4 mJ in a contact, at 500 N/m nothing.
double coupling_for_delay(const DeviceLimits& limits, double delay);

}  // namespace tuft::haptic
