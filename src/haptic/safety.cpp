#include "haptic/safety.h"

#include <algorithm>
#include <cmath>

namespace tuft::haptic {
namespace {

constexpr double kRamp = 500, kPauseFade = 10;    // periods
constexpr std::uint64_t kHeld = 5, kSilent = 18;  // periods; 2 ms are left for the way to the arm
constexpr int kGood = 50;                         // states in a row
constexpr double kMostStep = 0.01;                // m a period: 10 m/s, more than a hand
constexpr std::uint64_t kMostSteps = 2;           // a step over several periods counts as so many at most

bool is_finite(const Vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

Message describe(Fault fault) {
    switch (fault) {
        case Fault::not_finite:
            return "the arm sent a position that is no number";
        case Fault::jump:
            return "the arm's position jumped";
        case Fault::silence:
            return "the arm has stopped sending its position";
        case Fault::paused:
            return "forces are paused";
        case Fault::emergency:
            return "forces were stopped by the emergency key";
        case Fault::none:
            break;
    }
    return {};
}

double trust_at_age(std::uint64_t periods) {
    if (periods <= kHeld) return 1;
    if (periods >= kSilent) return 0;
    return static_cast<double>(kSilent - periods) / static_cast<double>(kSilent - kHeld);
}

void Safety::stop(Fault fault) {
    engaged_ = false;
    pass_ = 0;
    fault_ = fault;
}

Fault Safety::judge(const DeviceState& state, std::uint64_t tick) const {
    const double turn = glm::length(state.rotation);
    if (!is_finite(state.position) || !(std::abs(turn - 1) < 1e-2)) return Fault::not_finite;
    if (!known_) return Fault::none;
    const double periods = static_cast<double>(std::clamp<std::uint64_t>(tick - heard_, 1, kMostSteps));
    return glm::distance(state.position, position_) > kMostStep * periods ? Fault::jump : Fault::none;
}

Verdict Safety::check(std::uint64_t tick, const DeviceState* fresh, bool paused, bool emergency) {
    const double periods = started_ ? static_cast<double>(tick - tick_) : 1;
    if (!started_) heard_ = tick;
    tick_ = tick;
    started_ = true;
    emergency_ = emergency_ || emergency;
    if (fresh) {
        const Fault found = judge(*fresh, tick);
        if (found == Fault::none || found == Fault::jump) {
            position_ = fresh->position;
            known_ = true;
            heard_ = tick;
        }
        good_ = found == Fault::none ? std::min(good_ + 1, kGood) : 0;
        if (found != Fault::none) stop(found);
    }
    const std::uint64_t silent = tick - heard_;
    if (silent >= kSilent) {
        stop(Fault::silence);
        good_ = 0;
        known_ = false;  // where the arm speaks again is where it is
    }
    if (emergency_) stop(Fault::emergency);
    Verdict verdict;
    if (!engaged_ && good_ >= kGood && !paused && !emergency_) {
        engaged_ = verdict.restart = true;
        fault_ = Fault::none;
    } else if (engaged_ && paused) {
        pass_ -= periods / kPauseFade;
        fault_ = Fault::paused;
        if (pass_ <= 0) stop(Fault::paused);
    } else if (engaged_) {
        pass_ = std::min(1.0, pass_ + periods / kRamp);
        fault_ = Fault::none;
    }
    verdict.engaged = engaged_;
    verdict.pass = pass_ * trust_at_age(silent);
    verdict.fault = fault_;
    return verdict;
}

}  // namespace tuft::haptic
