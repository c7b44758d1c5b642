#pragma once

#include "brush/state/tuft_state.h"
#include "contact/contact.h"

namespace tuft::stroke {

/// What a pose moved since the pose before, in the contact frame's (t, b), metres; zero at first contact.
struct ContactMotion {
    Vec2 hand{0};  ///< displacement of the hand
    Vec2 hair{0};  ///< displacement of the hair that touches: lifted hair goes on along its track while the hand stands
};

/// Follows hand and touching hair over the surface, from pose to pose of one stroke. All means are exponential in the
/// distance, so that they do not depend on how finely the motion was sampled.
struct MotionTracker {
    bool touching = false;      ///< at the last pose
    double travel = 0;          ///< metres that the hand has gone while touching
    double speed = 0;           ///< m/s of the hand, over its last 2 mm
    double hair_travel = 0;     ///< metres that hair went over the surface
    double contact_travel = 0;  ///< of them those since it came to touch
    Vec2 hair_direction{0};     ///< unit, of the hair's last motion, contact frame; zero before the first
    Vec3 hand_course{0};  ///< metres, world: the hand's last 2 mm of travel, less what it goes by pressing or lifting
    Vec3 hair_course{0};  ///< likewise of the hair, over 1 mm
    double press_share = 0;  ///< 0–1: how much of the hand's last motion was pressing or lifting
    Vec3 last_position{0};   ///< metres, world: of the ferrule

    /// The next pose whose tuft touches; `dt` seconds since the pose before. Followed by `keep_contact` or
    /// `lose_contact`.
    ContactMotion advance(const brush::Pose& pose, const contact::Result& contact, double dt);
    void keep_contact(const brush::Pose& pose);
    void lose_contact() { touching = false; }
};

}  // namespace tuft::stroke
