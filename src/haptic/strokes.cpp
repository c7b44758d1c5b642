#include "haptic/strokes.h"

#include "haptic/device/limits.h"

namespace tuft::haptic {

brush::Pose StrokeCutter::pose_of(const SolvedPose& solved) const {
    const RootPose& p = solved.pose;
    return {p.position, p.rotation, static_cast<double>(p.tick - begin_) * kPeriod};
}

StrokeCutter::Cut StrokeCutter::add(const SolvedPose& solved) {
    constexpr std::uint64_t kAir = 50;  // periods
    Cut cut;
    const bool elsewhere = known_ && solved.pose.taken_up != last_.pose.taken_up;
    if (in_stroke_ && elsewhere) {
        cut.ends = true;
        in_stroke_ = false;
        known_ = false;
        last_ = solved;
        return cut;
    }
    if (elsewhere) known_ = false;
    if (solved.touching) touched_ = solved.pose.tick;
    if (!in_stroke_ && solved.touching) {
        in_stroke_ = cut.begins = true;
        begin_ = known_ ? last_.pose.tick : solved.pose.tick;
        if (known_) cut.poses.push_back(pose_of(last_));
    }
    if (in_stroke_) {
        cut.poses.push_back(pose_of(solved));
        if (solved.pose.tick - touched_ >= kAir) {
            cut.ends = true;
            in_stroke_ = false;
        }
    }
    last_ = solved;
    known_ = true;
    return cut;
}

}  // namespace tuft::haptic
