#include "haptic/device/simulated.h"

#include <algorithm>
#include <cmath>

#include "core/system/clock.h"

namespace tuft::haptic {
namespace {

constexpr double kWatchdog = 0.02;  // s after the last command, after which the motors are off

}  // namespace

SimulatedArm::SimulatedArm(const DeviceLimits& limits, HandPath path, const SimulationOptions& options)
    : limits_(limits), path_(std::move(path)), options_(options), random_(options.seed) {
    target_ = path_(0);
    position_ = target_.position;
    velocity_ = target_.velocity;
}

void SimulatedArm::take_commands(double time) {
    while (n_taken_ < n_sent_ && sent_[n_taken_ % sent_.size()].arrives <= time) {
        const DelayedForce& s = sent_[n_taken_++ % sent_.size()];
        const double size = glm::length(s.force);
        force_ = size > limits_.max_force ? s.force * (limits_.max_force / size) : s.force;
        heard_ = s.arrives;
    }
    if (heard_ >= 0 && time - heard_ > kWatchdog) force_ = Vec3{0};
}

void SimulatedArm::step() {
    const double t = time();
    take_commands(t);
    target_ = path_(t + kStep);
    const HandModel& hand = options_.hand;
    const double h = kStep, M = limits_.mass + hand.mass, c = limits_.damping;
    const double inertia = M + h * (hand.damping + c) + h * h * hand.stiffness;
    const Vec3 pull = hand.stiffness * (target_.position - position_) + hand.damping * target_.velocity + force_;
    Vec3 v = (M * velocity_ + h * pull) / inertia;
    const double speed = glm::length(v), stops = limits_.friction * h / inertia;
    v = speed > stops ? v * (1 - stops / speed) : Vec3{0};
    velocity_ = v;
    position_ += h * v;
    energy_.port -= glm::dot(force_, h * v);
    energy_.losses += h * (limits_.friction * glm::length(v) + c * glm::dot(v, v));
    ++steps_;
}

void SimulatedArm::advance(double time) {
    while (static_cast<double>(steps_ + 1) * kStep <= time + 0.5 * kStep) step();
}

DeviceState SimulatedArm::measure() const {
    const double count = limits_.count;
    const Vec3 read = count > 0 ? Vec3(count * glm::round(position_ / count)) : position_;
    return {.time = time(),
            .position = read,
            .velocity = velocity_,
            .rotation = target_.rotation,
            .buttons = target_.buttons};
}

void SimulatedArm::command(const DeviceCommand& command, double time) {
    if (n_sent_ - n_taken_ == sent_.size()) ++n_taken_;  // flooded: the oldest is lost
    const double last = n_sent_ > n_taken_ ? sent_[(n_sent_ - 1) % sent_.size()].arrives : 0;
    const double jitter = options_.jitter > 0 ? random_.uniform(0, options_.jitter) : 0;
    sent_[n_sent_++ % sent_.size()] = {std::max(last, time + options_.delay + jitter), command.force};
}

SimulatedDevice::SimulatedDevice(SimulatedArm arm) : arm_(std::move(arm)), begin_(clock_seconds()) {}

double SimulatedDevice::now() const {
    return clock_seconds() - begin_;
}

bool SimulatedDevice::read(DeviceState& state) noexcept {
    constexpr double kCatchUp = 0.1;  // s: after a halt of the machine the simulation goes on from there
    const double behind = now() - arm_.time();
    if (behind > kCatchUp) begin_ += behind - kCatchUp;
    arm_.advance(now());
    state = arm_.measure();
    return true;
}

void SimulatedDevice::send(const DeviceCommand& command) noexcept {
    arm_.command(command, now());
}

}  // namespace tuft::haptic
