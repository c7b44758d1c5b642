#include "stroke/contact/motion_tracker.h"

#include <algorithm>
#include <cmath>

#include "core/ease.h"

namespace tuft::stroke {
namespace {

constexpr double kSpeedLength = 2e-3;  // metres of travel over which the hand's speed is taken
constexpr double kHandCourse = 2e-3;   // metres of travel over which the hand's course is taken,
constexpr double kHairCourse = 1e-3;   // and the hair's
constexpr double kAlignLength = 2e-3;  // metres of travel after a press in which hair turns to where it is drawn
// Vertical part of the hand's motion from which on it begins to press or lift, and from which on it does nothing else.
constexpr double kPressFrom = 0.2, kPressFull = 0.5;

}  // namespace

ContactMotion MotionTracker::advance(const brush::Pose& pose, const contact::Result& contact, double dt) {
    const Vec3 step = touching ? pose.position - last_position : Vec3{0};
    if (touching) {
        const double distance = glm::length(step);
        travel += distance;
        if (dt > 0) speed += -std::expm1(-distance / kSpeedLength) * (distance / dt - speed);
    }
    const Vec3 &t = contact.frame.t, &b = contact.frame.b;
    const auto in_frame = [&](const Vec3& v) { return Vec2{glm::dot(v, t), glm::dot(v, b)}; };
    const ContactMotion motion{.hand = in_frame(step), .hair = touching ? in_frame(contact.travel) : Vec2{0}};

    const double slip = glm::length(motion.hair);
    hair_travel += slip;
    contact_travel = touching ? contact_travel + slip : 0;
    if (slip > 0) hair_direction = motion.hair / slip;
    hair_course =
        touching ? std::exp(-slip / kHairCourse) * hair_course + motion.hair.x * t + motion.hair.y * b : Vec3{0};

    const double along = glm::length(motion.hand), up = std::abs(glm::dot(step, contact.frame.n));
    const double presses = up > 0 ? smooth_step((up / (up + along) - kPressFrom) / (kPressFull - kPressFrom)) : 0;
    // Pressed or lifted, a tuft that is held to a line moves to take in or give back its tip lag: that is no course.
    const double counts = 1 - presses * std::min(1.0, glm::length(hand_course) / kHandCourse);
    hand_course = touching ? std::exp(-counts * along / kHandCourse) * hand_course +
                                 counts * (motion.hand.x * t + motion.hand.y * b)
                           : Vec3{0};
    press_share = std::max(presses, touching ? std::exp(-along / kAlignLength) * press_share : 0);
    return motion;
}

void MotionTracker::keep_contact(const brush::Pose& pose) {
    touching = true;
    last_position = pose.position;
}

}  // namespace tuft::stroke
