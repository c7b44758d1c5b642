#pragma once

#include <memory>
#include <string>

#include "app/input/arm.h"
#include "app/paint/paint_thread.h"
#include "app/widgets/status_message.h"

/// \file
/// The force-feedback arm and what a person wants of it. Window thread.
namespace tuft::app {

/// Bounds of what a person can choose.
inline constexpr double kMostArmGain = 40, kLeastArmScale = 0.1, kMostArmScale = 2;
inline constexpr double kMostArmProximity = 0.3;  // N

/// Of `ArmState::regrips_until`: from the next frame on.
inline constexpr double kRegripsSoon = -1;

/// State of the arm and its panel.
struct ArmState {
    ArmSettings settings;
    bool shown = false;        ///< the panel
    bool focused = true;       ///< the window has the focus; without it no force leaves
    bool paused = false;       ///< by the person
    bool clutched = false;     ///< by the panel; the grip's first button does so too
    bool emergency = false;    ///< until it is released
    bool on_palette = false;   ///< the brush is on the palette and not on the model
    std::unique_ptr<Arm> arm;  ///< null: none is connected
    BeginStroke begin;         ///< the next stroke
    bool paints = false;       ///< strokes may begin
    double regrips_until = 0;  ///< seconds on the window's clock, while axes or scale change; or `kRegripsSoon`
    double rate = 0;           ///< periods a second of the loop, over the last half second
    haptic::Fault reported = haptic::Fault::none;  ///< to the person
    bool lost = false;                             ///< the connection, reported to the person

    bool in_stroke() const { return arm && arm->in_stroke(); }
};

/// Opens the device of the settings. A fault goes into the status line.
void connect_arm(ArmState& state, StatusMessage& status);
/// Ends the stroke in work and closes the device.
void disconnect_arm(ArmState& state, PaintThread* work);
/// Ends the loop and the stroke in work before the model goes. Returns whether anything was painted since the last
/// `post_arm_strokes`.
bool leave_arm(ArmState& state, PaintThread* work);
/// No force from now on, until it is released; the stroke in work ends where it is.
void stop_forces(ArmState& state);
void release_forces(ArmState& state);
/// Sends the poses that were solved since the last call to the paint thread: what was felt is what is painted. Returns
/// whether there were any.
bool post_arm_strokes(ArmState& state, PaintThread& work);

}  // namespace tuft::app
