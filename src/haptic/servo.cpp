#include "haptic/servo.h"

namespace tuft::haptic {

// The brush stays where it is while the clutch is held, and when the workspace turns; so the force has no step.
void Servo::place_arm(const ServoControl& control) {
    if (control.clutched) {
        clutched_ = true;
        return;
    }
    const Workspace& w = control.workspace;
    const bool turned = w.rotation != workspace_.rotation || w.scale != workspace_.scale;
    const bool moved = w.offset != workspace_.offset && verdict_.engaged;
    if (placed_ && (clutched_ || turned || moved)) shift_ = arm_ - w.to_world(device_);
    workspace_ = w;
    arm_ = w.to_world(device_) + shift_;
    clutched_ = false;
    placed_ = known_;
}

RootPose Servo::begin(std::uint64_t tick, const DeviceState* fresh, const ServoControl& control) {
    tick_ = tick;
    verdict_ = safety_.check(tick, fresh, control.paused || control.clutched, control.emergency);
    const bool usable = fresh && (verdict_.engaged || verdict_.fault == Fault::paused || !known_);
    if (usable && glm::length(fresh->position) < 1e3) {  // NaN is not less
        device_ = fresh->position;
        buttons_ = fresh->buttons;
        if (!control.clutched) rotation_ = glm::normalize(control.workspace.rotation * fresh->rotation);
        known_ = true;
    }
    place_arm(control);
    if (verdict_.restart) {
        restart_law(law_, arm_, rotation_);
        restarted_ = tick;
    }
    return {.tick = tick, .position = law_.root, .rotation = rotation_, .buttons = buttons_, .taken_up = restarted_};
}

ServoOutput Servo::finish(const HairAnswer* newest) {
    ServoOutput out{.root = law_.root, .fault = verdict_.fault, .pass = verdict_.pass, .engaged = verdict_.engaged};
    if (!verdict_.engaged) return out;
    if (newest && (newest->pose.tick < restarted_ || newest->pose.tick > tick_)) newest = nullptr;
    out.age = newest ? tick_ - newest->pose.tick : 0;
    const LawOutput law = step_law(options_, law_,
                                   {.arm = arm_,
                                    .rotation = rotation_,
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
