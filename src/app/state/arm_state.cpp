#include "app/state/arm_state.h"

#include <utility>

namespace tuft::app {

void connect_arm(ArmState& state, StatusMessage& status) {
    try {
        state.arm = std::make_unique<Arm>(state.settings);
        state.emergency = state.clutched = state.lost = false;
        state.reported = haptic::Fault::none;
    } catch (const Error& error) {
        state.arm.reset();
        show_message(status, error.message());
    }
}

bool post_arm_strokes(ArmState& state, PaintThread& work) {
    ArmStrokes strokes = state.arm->take_strokes(state.paints);
    for (haptic::StrokeCutter::Cut& cut : strokes) {
        if (cut.begins) work.post(state.begin);
        if (!cut.poses.empty()) work.post(ExtendStroke{std::move(cut.poses)});
        if (cut.ends) work.post(EndStroke{});
    }
    return !strokes.empty();
}

bool leave_arm(ArmState& state, PaintThread* work) {
    if (!state.arm) return false;
    state.arm->leave_surface();
    return work && post_arm_strokes(state, *work);
}

void disconnect_arm(ArmState& state, PaintThread* work) {
    leave_arm(state, work);
    state.arm.reset();
}

void stop_forces(ArmState& state) {
    if (!state.arm) return;
    state.emergency = true;
    state.arm->set_control({.emergency = true});
}

void release_forces(ArmState& state) {
    state.emergency = false;
    if (!state.arm) return;
    state.arm->set_control({});
    state.arm->release();
}

}  // namespace tuft::app
