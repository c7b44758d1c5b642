#pragma once

#include <array>
#include <vector>

#include "haptic/servo.h"

/// \file
/// Whether an arm that nobody holds is safe to take up: what it measures at rest, and how force comes and goes on it.
/// The servo of the loop runs with a hair that presses by 20 mN, which is less than the friction of any known arm and
/// which an energy tank without a hand can lend: an arm that hangs still stays where it is. 20 mN is also the most that
/// the servo may give, wherever the arm goes meanwhile.
///
/// Force is what this program asks the arm for. No arm says when its motors have followed.
namespace tuft::haptic {

/// What goes wrong on purpose.
enum class TrialFault { silence, not_finite, jump, pause, emergency };
inline constexpr TrialFault kTrialFaults[] = {TrialFault::silence, TrialFault::not_finite, TrialFault::jump,
                                              TrialFault::pause, TrialFault::emergency};

/// Makes the fault of a state and of what a person wants. Returns whether the state is heard.
bool make_fault(TrialFault fault, DeviceState& state, ServoControl& control);

/// Figures of an arm that nobody holds.
struct ArmFigures {
    double states_per_period = 0;  ///< share of the periods at rest in which a state came
    double count = 0;              ///< m, least change of a coordinate at rest; 0: none was seen
    double noise = 0;              ///< m, farthest that a position at rest was from their mean
    double greatest_force = 0;     ///< N, that left
    double ramp = 0;               ///< s, from when the arm is first picked up to 95 % of the greatest force
    double largest_step = 0;       ///< N, of |Δf| in a period beyond k_max |Δx|, while all is well
    /// Periods from each of `kTrialFaults` to no force for good; −1: not measured, or it did not end within 100.
    std::array<int, std::size(kTrialFaults)> stop{-1, -1, -1, -1, -1};
    double moved = 0;  ///< m, farthest that the arm was from where it stood
};

/// One line where these are the figures of an arm that must not be taken up, or are not complete; else empty.
Message finding_of(const ArmFigures& figures);

/// The check, one period of 1 ms after the other, 6 s in all; no clock, no thread.
class ArmCheck {
  public:
    explicit ArmCheck(const DeviceLimits& limits);

    /// The state that came in this period, or null. `tick` grows, by more than one where a period was missed. Returns
    /// what to send.
    DeviceCommand step(std::uint64_t tick, const DeviceState* fresh);
    /// No force leaves any more.
    bool done() const { return at_ == std::size(kTrialFaults); }
    /// `finding_of` the figures, once it is done.
    Message finding() const { return done() ? finding_of(figures()) : Message{}; }
    ArmFigures figures() const;

  private:
    enum class Phase { rest, force, fault, quiet };

    void watch(const DeviceState* fresh);
    void end_rest();
    ServoOutput press(const DeviceState* fresh);
    void see_force(const ServoOutput& out);
    void see_stop(const ServoOutput& out);
    void begin(Phase phase);
    void next();

    LawOptions law_;
    Servo servo_;
    ArmFigures figures_;
    Phase phase_ = Phase::rest;
    std::size_t at_ = 0;           // of kTrialFaults
    std::uint64_t tick_ = 0;       // of this period
    std::uint64_t began_ = 0;      // first period of the phase; 0: the next one
    std::uint64_t picked_up_ = 0;  // period in which the servo took the arm up; 0: not yet
    std::uint64_t ended_ = 0;      // first period of a fault from which on there is no force; 0: there is
    std::vector<Vec3> places_;     // m, at rest
    std::vector<float> rise_;      // N, since the arm was first picked up
    Vec3 stood_{0}, position_{0}, before_{0}, force_{0};
};

}  // namespace tuft::haptic
