#pragma once

#include "haptic/device/device.h"
#include "haptic/device/workspace.h"
#include "haptic/hair_answer.h"
#include "haptic/law.h"
#include "haptic/safety.h"

/// \file
/// One period of the servo, without clock or thread: safety, workspace and law in their order. The loop (loop.h) calls
/// it by the wall clock, the trial (trial.h) in virtual time, a replay (recording.h) by recorded periods; the same
/// inputs give the same bits.
namespace tuft::haptic {

/// What a person wants of the servo in this period.
struct ServoControl {
    bool paused = false;     ///< also: the window lost its focus
    bool emergency = false;  ///< latched until `Servo::release`
    bool clutched = false;   ///< the arm moves without the brush
    /// The brush goes with a workspace that turns or moves, as it does with the view; else it stays where it is.
    bool carried = false;
    std::uint32_t clutch_buttons = 0;  ///< of the grip: while one of them is pressed, as `clutched`
    /// Its offset counts only while no force is on; after a change of scale the brush stays where it is.
    Workspace workspace;
};

/// Result of one period of the servo.
struct ServoOutput {
    DeviceCommand command;  ///< in the arm's frame
    Vec3 force{0};          ///< N, on the hand, world
    Vec3 root{0};           ///< y, m, of the next pose
    Vec3 arm{0};            ///< x, m, world
    Vec3 device{0};         ///< m, arm's frame: the same place
    Fault fault = Fault::none;
    double pass = 0;                                      ///< 0–1, share of the force that safety lets out
    bool engaged = false, hard = false, limited = false;  ///< see `Verdict`, `LawOutput`
    std::uint64_t age = 0;                                ///< periods of the answer that was used
};

/// The servo between two periods.
class Servo {
  public:
    explicit Servo(const LawOptions& law) : options_(law) {}

    /// Takes the arm's state, null when none came, and returns the pose to solve. Not engaged: nothing to solve.
    RootPose begin(std::uint64_t tick, const DeviceState* fresh, const ServoControl& control);
    bool engaged() const { return verdict_.engaged; }
    /// Whether the arm moved without the brush in this period.
    bool clutched() const { return clutched_; }
    /// Ends the period with the newest answer, or null.
    ServoOutput finish(const HairAnswer* newest);

    void release() { safety_.release(); }
    void set_options(const LawOptions& options) { options_ = options; }
    const LawOptions& options() const { return options_; }
    const LawState& law() const { return law_; }

  private:
    /// The grip as the arm last reported it, in the arm's frame.
    struct Grip {
        bool known = false;
        Vec3 position{0};  // m
        Quat rotation{1, 0, 0, 0};
        std::uint32_t buttons = 0;
    };

    void place_arm(const ServoControl& control, bool clutched);

    LawOptions options_;
    LawState law_;
    Safety safety_;
    Verdict verdict_;
    Workspace workspace_;
    Grip grip_;
    Vec3 arm_{0};    // m, world
    Vec3 shift_{0};  // m, in the workspace's axes, by clutch and turns of the workspace
    Quat rotation_{1, 0, 0, 0};
    std::uint64_t tick_ = 0, restarted_ = 0;
    bool placed_ = false, clutched_ = false;
};

}  // namespace tuft::haptic
