#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/message.h"
#include "haptic/loop.h"
#include "haptic/strokes.h"
#include "haptic/trial.h"

/// \file
/// A force-feedback arm that guides the brush: its device, the 1 kHz loop over the open model, and the strokes that its
/// poses make. Window thread; the loop has threads of its own (haptic/loop.h).
namespace tuft::app {

/// Where the states of the arm come from.
enum class ArmSource { simulated, service, recording };

/// What a person chose. Lengths in the arm's frame.
struct ArmSettings {
    ArmSource source = ArmSource::simulated;
    std::string preset = "inverse3";  ///< figures of the arm, see `haptic::device_presets`
    std::string host = "127.0.0.1";   ///< of the service
    int port = 10001;
    std::filesystem::path recording;
    /// What the hand of a simulated arm does: "pointer" follows the mouse, else a name of `haptic::name_of`.
    std::string hand = "pointer";
    double gain = 0;                          ///< force on the hand over force of the hair; 0: that of the brush
    double most_force = haptic::kForceLimit;  ///< N
    double proximity = 0;                     ///< N on the hand over the last millimetre before the hair touches
    bool restore = false;                     ///< takes the softness of the coupling away, see haptic/law.h
    double scale = 1;                         ///< metres of the brush per metre of the arm
    bool with_view = true;                    ///< the arm's axes turn with the view; else they are the model's
    Vec3 centre{0};                           ///< m, middle of the arm's reach, from calibration
};

/// What the arm feels.
struct ArmScene {
    const mesh::SurfaceQuery* surface = nullptr;  ///< must outlive the loop
    brush::Preset brush;
    Frame start;            ///< m, on the surface: over it the brush begins, 10 mm above it
    Quat axes{1, 0, 0, 0};  ///< from the arm's axes to the model's
};

/// What the poses since the last call mean for the painting, in order.
using ArmStrokes = std::vector<haptic::StrokeCutter::Cut>;

/// An arm that is connected.
class Arm {
  public:
    /// Opens the device. Throws `Error` where a recording cannot be read or the preset is unknown.
    explicit Arm(const ArmSettings& settings);
    ~Arm();

    /// Whether a state has come from the device, so that `feel` can place the brush.
    bool ready();
    /// Begins to feel a scene; another one ends first. On the same surface the tip stays where it was. Precondition:
    /// `ready()`.
    void feel(const ArmScene& scene);
    /// Ends the loop: no force leaves any more. The poses solved so far stay for `take_strokes`.
    void leave();
    /// As `leave`, before the surface goes.
    void leave_surface();
    bool feels() const { return loop_ != nullptr; }

    /// Settings that act while the loop runs: gain, limits, restore, scale.
    void apply(const ArmSettings& settings);
    /// `control.workspace` is set by `set_workspace`, which comes first.
    void set_control(haptic::ServoControl control);
    /// The arm's axes, and the point round which they turn: where the view has them in this frame. `moves`: the brush
    /// goes with it.
    void set_workspace(const Vec3& about, const Quat& axes, bool moves);
    /// Ends an emergency.
    void release();
    /// Of the hair, and the yield stress of the paste in it, Pa, or 0.
    void set_ink(double wetness, double ink_left, double yield_stress);
    /// Where the hand of a simulated arm with the hand "pointer" shall be: root of the brush, m, world.
    void point_to(const Vec3& root, const Quat& rotation);

    const haptic::LoopStatus& poll();  ///< newest status; also `status()` until the next call
    const haptic::LoopStatus& status() const { return status_; }
    /// Strokes begin only while `paints`.
    ArmStrokes take_strokes(bool paints);
    bool in_stroke() const { return cutter_.in_stroke(); }
    /// Drops the stroke in work; the next begins when hair has left the surface.
    void drop_stroke();
    /// Calibration: as the grip is now, the brush is upright on the surface under it.
    void set_upright();
    std::vector<float> recent_forces() const;
    /// Corners of the arm's reach, m, world: x fastest, then y, then z.
    std::array<Vec3, 8> reach() const;
    /// Whether the arm is within 5 mm of the end of its reach.
    bool at_limit() const;

    const haptic::DeviceLimits& limits() const { return device_->limits(); }
    const ArmSettings& settings() const { return settings_; }
    bool follows_pointer() const { return settings_.source == ArmSource::simulated && settings_.hand == "pointer"; }
    /// One line on what is wrong with the device; empty: nothing.
    Message trouble() const { return device_->trouble(); }
    bool open() const { return device_->open(); }

  private:
    struct PointerHand;
    /// Where the workspace stays while its axes turn.
    struct WorkspaceHold {
        Vec3 offset{0};        ///< m, of the workspace from the point that it turns about, in its axes
        bool known = false;    ///< `offset` is
        bool carried = false;  ///< the workspace was moved for it
    };

    void place(const ArmScene& scene);
    void open_simulated();
    haptic::LawOptions law() const;

    ArmSettings settings_;
    std::shared_ptr<PointerHand> hand_;
    std::unique_ptr<haptic::Device> device_;
    std::unique_ptr<haptic::Loop> loop_;
    haptic::StrokeCutter cutter_;
    ArmStrokes left_;  // after `leave`
    haptic::LoopStatus status_;
    haptic::DeviceState first_;
    haptic::Workspace workspace_;
    ArmScene scene_;
    WorkspaceHold hold_;
    int silent_ = 0;  // looks in a row at a loop that is not engaged
    bool known_ = false, dropped_ = false, paints_ = true;
};

}  // namespace tuft::app
