#pragma once

#include "brush/state/tuft_state.h"
#include "contact/contact.h"

/// \file
/// Motion of hand and hair over the surface. `StrokeSession` advances it; stamps and deposit models read it.

namespace tuft::stroke {

/// Displacements since the pose before, metres, (t, b) of the contact frame; zero at first contact.
struct ContactMotion {
    Vec2 hand{0};  ///< of the ferrule
    Vec2 hair{0};  ///< of the touching hair: while it is lifted it moves on along its track though the hand rests
};

/// Follows hand and touching hair from pose to pose of one stroke. Means are exponential in distance, so that they do
/// not depend on the sampling rate.
struct MotionTracker {
    bool touching = false;      ///< at the last pose
    double travel = 0;          ///< path of the hand while touching, metres
    double speed = 0;           ///< of the hand, mean over 2 mm, m/s
    double hair_travel = 0;     ///< path of the hair over the surface, metres
    double contact_travel = 0;  ///< the same since the hair last began to touch, metres
    Vec2 hair_direction{0};     ///< unit, of the hair's last motion, contact frame; zero before the first
    Vec3 hand_course{0};     ///< displacement of the hand, mean over 2 mm, without pressing and lifting; metres, world
    Vec3 hair_course{0};     ///< the same of the hair, over 1 mm
    double press_share = 0;  ///< part of the hand's last motion that was pressing or lifting, 0–1
    Vec3 last_position{0};   ///< of the ferrule, metres, world

    /// Advances to the next pose whose tuft touches, `dt` seconds after the pose before. The caller then calls
    /// `keep_contact` or `lose_contact`.
    ContactMotion advance(const brush::Pose& pose, const contact::Result& contact, double dt);
    void keep_contact(const brush::Pose& pose);
    void lose_contact() { touching = false; }
};

}  // namespace tuft::stroke
