#pragma once

#include <cstdint>
#include <string>

#include "core/geometry/types.h"
#include "core/message.h"
#include "haptic/device/limits.h"

/// \file
/// The force-feedback arm as the servo sees it. haply.h and simulated.h implement it.
namespace tuft::haptic {

/// State of an arm in its own frame, right-handed: x to the right, y away from the person, z up.
struct DeviceState {
    double time = 0;            ///< s, when it arrived; clock of the device
    Vec3 position{0};           ///< m, of the arm's tip
    Vec3 velocity{0};           ///< m/s
    Quat rotation{1, 0, 0, 0};  ///< of the grip; unit. The brush points along rotation * (0, 0, −1)
    std::uint32_t buttons = 0;  ///< one bit each, the first is 1
};

/// What the arm shall do, in its own frame, until the next command.
struct DeviceCommand {
    Vec3 force{0};   ///< N, on the hand
    Vec3 torque{0};  ///< N·m, on the hand; ignored by arms without motors in the wrist
};

/// An arm. `read` and `send` are called by the servo's thread: they never wait, throw or allocate memory.
class Device {
  public:
    virtual ~Device() = default;
    virtual const DeviceLimits& limits() const = 0;
    /// Stores the newest state. Returns false when none has come since the last call.
    virtual bool read(DeviceState& state) noexcept = 0;
    virtual void send(const DeviceCommand& command) noexcept = 0;
    /// One line for a person on what is wrong; empty: all is well. Any thread.
    virtual Message trouble() const { return {}; }
    /// Whether states can still come. Any thread.
    virtual bool open() const { return true; }
};

}  // namespace tuft::haptic
