#include "haptic/servo.h"

namespace tuft::haptic {

// The brush stays where it is while the clutch is pressed, and when a workspace turns that does not carry it; so the
// force has no step.
void Servo::place_arm(const ServoControl& control, bool clutched) {
    if (clutched) {
        clutched_ = true;
        return;
    }
    const Workspace& w = control.workspace;
    const bool scaled = w.scale != workspace_.scale;
    if (control.carried && !scaled && !clutched_) {
        workspace_ = placed_ && verdict_.engaged ? workspace_.approached(w) : w;
    } else {
        const bool turned = w.rotation != workspace_.rotation || scaled;
        const bool moved = w.offset != workspace_.offset && verdict_.engaged;
        if (placed_ && (clutched_ || turned || moved))
            shift_ = glm::conjugate(w.rotation) * (arm_ - w.to_world(grip_.position));
        workspace_ = w;
    }
    arm_ = workspace_.to_world(grip_.position) + workspace_.rotation * shift_;
    rotation_ = glm::normalize(workspace_.rotation * grip_.rotation * glm::conjugate(workspace_.grip));
    clutched_ = false;
    placed_ = grip_.known;
}

RootPose Servo::begin(std::uint64_t tick, const DeviceState* fresh, const ServoControl& control) {
    tick_ = tick;
    if (fresh) grip_.buttons = fresh->buttons;
    const bool clutched = control.clutched || (grip_.buttons & control.clutch_buttons) != 0;
    verdict_ = safety_.check(tick, fresh, control.paused || clutched, control.emergency);
    const bool usable = fresh && (verdict_.engaged || verdict_.fault == Fault::paused || !grip_.known);
    if (usable && glm::length(fresh->position) < 1e3) {  // NaN is not less
        grip_.position = fresh->position;
        grip_.rotation = fresh->rotation;
        grip_.known = true;
    }
    place_arm(control, clutched);
    if (verdict_.restart) {
        restart_law(law_, arm_, rotation_);
        restarted_ = tick;
    }
    return {.tick = tick,
            .position = law_.root.position,
            .rotation = rotation_,
            .buttons = grip_.buttons,
            .taken_up = restarted_};
}

ServoOutput Servo::finish(const HairAnswer* newest) {
    ServoOutput out{.root = law_.root.position,
                    .arm = arm_,
                    .device = grip_.position,
                    .fault = verdict_.fault,
                    .pass = verdict_.pass,
                    .engaged = verdict_.engaged};
    if (!verdict_.engaged) return out;
    if (newest && (newest->pose.tick < restarted_ || newest->pose.tick > tick_)) newest = nullptr;
    out.age = newest ? tick_ - newest->pose.tick : 0;
    const LawOutput law = step_law(options_, law_,
                                   {.arm = arm_,
                                    .rotation = rotation_,
                                    .axes = workspace_.rotation,
                                    .hair = newest,
                                    .trust = newest ? trust_at_age(out.age) : 0,
                                    .pass = verdict_.pass});
    out.force = law.force;
    out.root = law.root;
    out.hard = law.hard;
    out.limited = law.limited;
    out.command = {workspace_.to_device(law.force), workspace_.to_device(law.torque)};
    return out;
}

}  // namespace tuft::haptic
