#include "haptic/device/limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/error.h"

namespace tuft::haptic {
namespace {

constexpr std::array kPresets{
    DeviceLimits{.name = "touch",
                 .title = "3D Systems Touch",
                 .max_force = 3.3,
                 .max_stiffness = 400,
                 .workspace = {0.16, 0.07, 0.12},
                 .friction = 0.20,
                 .count = 55e-6,
                 .mass = 0.05,
                 .damping = 0.1,
                 .coupling = 320},
    DeviceLimits{.name = "inverse3",
                 .title = "Haply Inverse3",
                 .max_force = 8,
                 .max_stiffness = 2000,
                 .workspace = {0.20, 0.20, 0.20},
                 .friction = 0.20,
                 .count = 20e-6,
                 .mass = 0.15,
                 .damping = 0.1,
                 .coupling = 1600},
    DeviceLimits{.name = "falcon",
                 .title = "Novint Falcon",
                 .max_force = 8,
                 .max_stiffness = 3000,
                 .workspace = {0.10, 0.10, 0.10},
                 .friction = 0.40,
                 .count = 60e-6,
                 .mass = 0.25,
                 .damping = 0.1,
                 .coupling = 2000},
    DeviceLimits{.name = "omega.6",
                 .title = "Force Dimension omega.6",
                 .max_force = 12,
                 .max_stiffness = 5000,
                 .workspace = {0.16, 0.16, 0.11},
                 .friction = 0.15,
                 .count = 10e-6,
                 .mass = 0.20,
                 .damping = 0.1,
                 .coupling = 2000},
};

}  // namespace

std::span<const DeviceLimits> device_presets() {
    return kPresets;
}

const DeviceLimits& device_preset(std::string_view name) {
    for (const DeviceLimits& preset : kPresets)
        if (preset.name == name) return preset;
    std::string names;
    for (const DeviceLimits& preset : kPresets) names += (names.empty() ? "" : ", ") + std::string(preset.name);
    throw Error(Message("unknown device '{}'; there are: {}", name, names));
}

double coupling_for_delay(const DeviceLimits& limits, double delay) {
    constexpr double kWithoutDelay = 4000, kHalving = 1e-3;  // N/m, s
    return std::min(limits.coupling, kWithoutDelay * std::exp2(-std::max(0.0, delay) / kHalving));
}

}  // namespace tuft::haptic
