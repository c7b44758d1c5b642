#include "haptic/arm_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tuft::haptic {
namespace {

constexpr std::uint64_t kRest = 1000, kPress = 700, kFault = 100, kQuiet = 100;  // periods
constexpr std::uint64_t kPatience = 2000;  // periods in which an arm is to be picked up
constexpr double kPush = 0.02;             // N
constexpr double kLeastPush = 0.005;       // N
constexpr double kMostPush = 1.001 * kPush;
constexpr double kLeastRamp = 0.4;      // s, of the half second in which force comes
constexpr std::uint64_t kStays = 40;    // periods without force that are an end; an arm is picked up after 50
constexpr double kStandsWithin = 0.02;  // m: somebody holds the arm, or it falls
constexpr int kSlowest = 20;            // periods
constexpr double kRisen = 0.95;

}  // namespace

bool make_fault(TrialFault fault, DeviceState& state, ServoControl& control) {
    if (fault == TrialFault::not_finite) state.position.x = std::numeric_limits<double>::quiet_NaN();
    if (fault == TrialFault::jump) state.position.x += 0.05;
    control.paused = fault == TrialFault::pause;
    control.emergency = fault == TrialFault::emergency;
    return fault != TrialFault::silence;
}

ArmCheck::ArmCheck(const DeviceLimits& limits) : law_{.limits = limits, .gain = 1, .most_force = kPush}, servo_(law_) {
    places_.reserve(kRest);
}

// Where the arm stands, while it gets no force. One that has not spoken until now gets none at all.
void ArmCheck::end_rest() {
    if (places_.empty()) {
        at_ = std::size(kTrialFaults);
        return;
    }
    Vec3 mean{0};
    for (const Vec3& p : places_) mean += p / static_cast<double>(places_.size());
    double least = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < places_.size(); ++i) {
        figures_.noise = std::max(figures_.noise, glm::distance(places_[i], mean));
        for (int c = 0; i > 0 && c < 3; ++c)
            if (const double d = std::abs(places_[i][c] - places_[i - 1][c]); d > 0) least = std::min(least, d);
    }
    if (least < std::numeric_limits<double>::max()) figures_.count = least;
    figures_.states_per_period = static_cast<double>(places_.size()) / kRest;
    stood_ = mean;
}

void ArmCheck::watch(const DeviceState* fresh) {
    before_ = position_;
    if (!fresh || !std::isfinite(glm::length(fresh->position))) return;
    position_ = fresh->position;
    if (phase_ == Phase::rest)
        places_.push_back(position_);
    else
        figures_.moved = std::max(figures_.moved, glm::distance(position_, stood_));
}

void ArmCheck::begin(Phase phase) {
    phase_ = phase;
    began_ = ended_ = 0;
    if (phase != Phase::force) return;
    servo_ = Servo(law_);
    picked_up_ = 0;
    force_ = Vec3{0};
}

void ArmCheck::next() {
    ++at_;
    begin(Phase::quiet);
}

ServoOutput ArmCheck::press(const DeviceState* fresh) {
    DeviceState state = fresh ? *fresh : DeviceState{};
    ServoControl control;
    bool heard = fresh != nullptr;
    if (phase_ == Phase::fault && !make_fault(kTrialFaults[at_], state, control)) heard = false;
    const HairAnswer answer{
        .pose = servo_.begin(tick_, heard ? &state : nullptr, control), .force = {0, 0, kPush}, .touching = true};
    return servo_.finish(&answer);
}

// While all is well: how the force rises.
void ArmCheck::see_force(const ServoOutput& out) {
    const double size = glm::length(out.force);
    const double step =
        glm::distance(out.force, force_) - law_.limits.max_stiffness * glm::distance(position_, before_);
    figures_.largest_step = std::max(figures_.largest_step, step);
    force_ = out.force;
    if (!out.engaged) picked_up_ = 0;  // states fail to come
    if (out.engaged && picked_up_ == 0) picked_up_ = tick_;
    if (at_ == 0 && out.engaged) {
        if (picked_up_ == tick_) rise_.clear();
        rise_.resize(tick_ - picked_up_ + 1, static_cast<float>(size));
    }
    if (picked_up_ == 0 ? tick_ - began_ > kPatience : tick_ - picked_up_ >= kPress) {
        if (picked_up_ == 0) return next();
        begin(Phase::fault);
    }
}

// A force that an empty tank holds back for a period has not been stopped.
void ArmCheck::see_stop(const ServoOutput& out) {
    const bool stopped = out.command.force == Vec3{0} && (!out.engaged || out.pass == 0);
    if (!stopped) ended_ = 0;
    if (stopped && ended_ == 0) ended_ = tick_;
    const bool stays = stopped && tick_ - ended_ >= kStays;
    if (!stays && tick_ - began_ < kFault) return;
    if (stopped && glm::length(force_) > kLeastPush) figures_.stop[at_] = static_cast<int>(ended_ - began_);
    next();
}

DeviceCommand ArmCheck::step(std::uint64_t tick, const DeviceState* fresh) {
    if (done()) return {};
    tick_ = tick;
    if (began_ == 0) began_ = tick;
    watch(fresh);
    if (figures_.moved > kStandsWithin) at_ = std::size(kTrialFaults);
    if (done()) return {};
    if (phase_ == Phase::force || phase_ == Phase::fault) {
        const ServoOutput out = press(fresh);
        figures_.greatest_force = std::max(figures_.greatest_force, glm::length(out.command.force));
        phase_ == Phase::force ? see_force(out) : see_stop(out);
        return out.command;
    }
    if (tick - began_ + 1 < (phase_ == Phase::rest ? kRest : kQuiet)) return {};
    if (phase_ == Phase::rest) end_rest();
    if (done()) return {};
    begin(Phase::force);
    return {};
}

ArmFigures ArmCheck::figures() const {
    ArmFigures figures = figures_;
    const auto greatest = std::max_element(rise_.begin(), rise_.end());
    for (std::size_t i = 0; i < rise_.size() && figures.ramp == 0; ++i)
        if (rise_[i] >= kRisen * *greatest) figures.ramp = kPeriod * static_cast<double>(i);
    return figures;
}

Message finding_of(const ArmFigures& figures) {
    if (figures.states_per_period == 0) return "the arm sends no position";
    if (figures.greatest_force > kMostPush) return "the arm was given more force than the check allows";
    if (figures.moved > kStandsWithin) return "the arm moves: let it hang or stand still, hands off";
    if (figures.greatest_force < kLeastPush) return "the arm was given no force: its position does not hold still";
    for (const int periods : figures.stop) {
        if (periods < 0) return "a stop could not be measured: positions come too late, or do not hold still";
        if (periods >= kSlowest) return "a force took 20 ms or longer to end";
    }
    if (figures.ramp < kLeastRamp || figures.largest_step > kPush)
        return "force came at once instead of over half a second";
    return {};
}

}  // namespace tuft::haptic
