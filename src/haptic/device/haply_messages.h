#pragma once

#include <string>
#include <string_view>

#include "haptic/device/device.h"

/// \file
/// Texts of the Haply Inverse service: WebSocket, port 10001, JSON, metres, m/s, newtons. A client must send a force
/// after each state, even a zero one, or no next state comes. haply.h reads states and writes forces, the server of
/// the simulation the other way round.
///
///     {"inverse3":[{"device_id":"A14","state":{"cursor_position":{"x":0,"y":0,"z":0},"cursor_velocity":{…}}}],
///      "wireless_verse_grip":[{"device_id":"61576","state":{"orientation":{"w":1,"x":0,"y":0,"z":0},
///                                                           "buttons":{"a":false,"b":false,"c":false}}}]}
///     {"inverse3":[{"device_id":"A14","commands":{"set_cursor_force":{"values":{"x":0,"y":0,"z":0}}}}]}
namespace tuft::haptic {

inline constexpr std::size_t kLongestMessage = 65536;  ///< bytes; a state of one arm has less than 2,000

/// A state as it was read. The grip is left as it was where a message has none.
struct HaplyState {
    std::string device;  ///< its id
    DeviceState state;
};

/// Reads the first arm of a message and the first grip, wired or not, into `state`. Returns false for anything that is
/// not a state: broken JSON, wrong types, numbers beyond 1000 m. JSON has no NaN; what spells one is broken.
bool read_haply_state(std::string_view text, HaplyState& state);
std::string haply_state_text(const HaplyState& state);

/// Reads a force command. Returns false where there is none.
bool read_haply_command(std::string_view text, DeviceCommand& command);
std::string haply_command_text(const std::string& device, const DeviceCommand& command);

}  // namespace tuft::haptic
