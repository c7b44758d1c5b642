#pragma once

#include <array>
#include <functional>

#include "core/random.h"
#include "haptic/device/device.h"

/// \file
/// A simulated arm in a simulated hand, for tests, for machines without an arm, and for the server of
/// `tuft device simulate`.
///
///     (M + m_h) x'' = k_h (x_t − x) + d_h (x_t' − x') + f − c x' − f_c sign(x')
///
/// The hand grips the arm rigidly: mass m_h, spring k_h and damper d_h to where it wants to be, x_t(t). f is the last
/// command that has arrived, limited by the motors, zero 20 ms after the last one. Positions are read in whole counts.
/// Integrated implicitly at 10 kHz; friction stops what it can stop.
namespace tuft::haptic {

/// Impedance of a hand. A pen's grip by default, assumed. Measured whole arms that push against a handle: 0.55 kg,
/// 6.5 N s/m, 135 N/m in the trial that [VanBeek2015] shows; a finger alone: 0.02 kg.
struct HandModel {
    double mass = 0.15;      ///< m_h, kg
    double damping = 5;      ///< d_h, N s/m
    double stiffness = 300;  ///< k_h, N/m
};

/// Where a hand wants to be.
struct HandTarget {
    Vec3 position{0};  ///< m, arm's frame
    Vec3 velocity{0};  ///< m/s
    Quat rotation{1, 0, 0, 0};
    std::uint32_t buttons = 0;
};
using HandPath = std::function<HandTarget(double time)>;

/// The hand and the wire of a simulated arm.
struct SimulationOptions {
    HandModel hand;
    double delay = 0;   ///< s, from a command to the motors
    double jitter = 0;  ///< s, added to it, uniform
    std::uint64_t seed = 1;
};

/// Energies since the beginning, J.
struct ArmEnergy {
    double port = 0;    ///< −∫ f · dx: what the force took from the hand
    double losses = 0;  ///< of friction and damping of the arm
};

/// The arm in the hand, in virtual time.
class SimulatedArm {
  public:
    SimulatedArm(const DeviceLimits& limits, HandPath path, const SimulationOptions& options = {});

    /// Integrates up to `time`, s. Allocates nothing, provided that the path does not.
    void advance(double time);
    double time() const { return static_cast<double>(steps_) * kStep; }
    /// As it is measured.
    DeviceState measure() const;
    /// Gives a command at `time`.
    void command(const DeviceCommand& command, double time);

    const Vec3& position() const { return position_; }
    const Quat& rotation() const { return target_.rotation; }
    /// On the hand at present, N.
    const Vec3& force() const { return force_; }
    const ArmEnergy& energy() const { return energy_; }
    const DeviceLimits& limits() const { return limits_; }

  private:
    static constexpr double kStep = 1e-4;  // s
    struct DelayedForce {
        double arrives = -1;
        Vec3 force{0};
    };

    void step();
    void take_commands(double time);

    DeviceLimits limits_;
    HandPath path_;
    SimulationOptions options_;
    HandTarget target_;
    std::uint64_t steps_ = 0;
    Vec3 position_{0}, velocity_{0}, force_{0};
    double heard_ = -1;
    std::array<DelayedForce, 64> sent_;
    std::size_t n_sent_ = 0, n_taken_ = 0;
    Random random_;
    ArmEnergy energy_;
};

/// The simulated arm as a device that runs by the wall clock.
class SimulatedDevice : public Device {
  public:
    explicit SimulatedDevice(SimulatedArm arm);
    const DeviceLimits& limits() const override { return arm_.limits(); }
    bool read(DeviceState& state) noexcept override;
    void send(const DeviceCommand& command) noexcept override;
    const SimulatedArm& arm() const { return arm_; }

  private:
    double now() const;

    SimulatedArm arm_;
    double begin_;
};

}  // namespace tuft::haptic
