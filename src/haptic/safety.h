#pragma once

#include <cstdint>

#include "core/message.h"
#include "haptic/device/device.h"

/// \file
/// Whether force may leave, and how much of it. Pure: time is the number of the period. `Servo` asks it before each
/// step of the law.
///
/// - Force rises over 0.5 s after the arm is picked up, that is after 50 good states in a row.
/// - A state that is not finite, or more than 10 mm from the last one per period, ends it at once.
/// - Without a state it stays for 5 ms and is zero after 18 ms.
/// - A pause, also when the window loses focus, fades it out over 10 ms.
/// - An emergency ends it at once, until `release`.
namespace tuft::haptic {

enum class Fault { none, not_finite, jump, silence, paused, emergency };

/// One line for a person.
Message describe(Fault fault);

/// 1 up to 5 periods of age, 0 from 18 on: for answers of the solver and states of the device.
double trust_at_age(std::uint64_t periods);

/// What safety allows in one period.
struct Verdict {
    bool engaged = false;       ///< the law runs
    bool restart = false;       ///< and begins here, in the air
    double pass = 0;            ///< of the force, 0–1
    Fault fault = Fault::none;  ///< why it is less than 1, beside the ramp
};

/// Decides in each period whether force may leave.
class Safety {
  public:
    /// `fresh`: the state that came in this period, or null.
    Verdict check(std::uint64_t tick, const DeviceState* fresh, bool paused, bool emergency);
    /// Ends an emergency.
    void release() { emergency_ = false; }

  private:
    void stop(Fault fault);
    Fault judge(const DeviceState& state, std::uint64_t tick) const;

    bool started_ = false, known_ = false, engaged_ = false, emergency_ = false;
    std::uint64_t tick_ = 0, heard_ = 0;
    int good_ = 0;  // states in a row
    double pass_ = 0;
    Vec3 position_{0};
    Fault fault_ = Fault::none;
};

}  // namespace tuft::haptic
