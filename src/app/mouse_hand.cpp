#include "app/mouse_hand.h"

#include <algorithm>
#include <cmath>

namespace tuft::app {
namespace {

constexpr double kRise = 0.05;   // seconds in which the pressure follows
constexpr double kLift = 0.06;   // seconds of the lift
constexpr double kFrame = 0.004; // seconds between the poses made between two events

// Part of the way to the goal that a first-order low-pass goes in dt.
double follow(double dt, double constant) { return 1.0 - std::exp(-dt / std::max(constant, 1e-6)); }

}  // namespace

MouseHand::MouseHand(const mesh::SurfaceQuery& surface, const brush::Preset& preset, const HandSettings& settings)
    : surface_(surface), hold_(stroke::hold_options(preset)), settings_(settings) {}

brush::Pose MouseHand::pose_at(const Vec3& point, const Vec3& normal, double pressure, double time) const {
    const Frame f = make_frame(point, normal);
    const double height = hold_.tuft_length +
                          (pressure > 0 ? -pressure * hold_.working_depth : hold_.hover);
    return {.position = point + height * normal,
            .rotation = glm::normalize(glm::quat_cast(Mat3(f.t, f.b, f.n))),
            .time = time};
}

std::vector<brush::Pose> MouseHand::move(const Vec3& origin, const Vec3& direction, double time) {
    std::vector<brush::Pose> poses;
    const auto hit = surface_.ray(origin, direction);
    if (!hit) return poses;
    const Vec3 normal = glm::dot(hit->normal, direction) < 0 ? hit->normal : -hit->normal;
    if (!down_) {
        down_ = true;
        point_ = hit->position;
        normal_ = normal;
        time_ = time;
        poses.push_back(pose_at(point_, normal_, 0, time));
        return poses;
    }
    const double span = std::max(1e-4, time - time_);
    const int steps = std::clamp(static_cast<int>(std::ceil(span / kFrame)), 1, 64);
    const double dt = span / steps;
    for (int i = 0; i < steps; ++i) {
        const Vec3 before = point_;
        point_ += follow(dt, settings_.smoothing) * (hit->position - point_);
        normal_ = glm::normalize(normal_ + follow(dt, settings_.smoothing) * (normal - normal_));
        speed_ += follow(dt, 0.05) * (glm::distance(before, point_) / dt - speed_);
        const double goal = settings_.pressure *
                            (1.0 - settings_.speed_effect * std::min(1.0, speed_ / settings_.fast));
        pressure_ += follow(dt, kRise) * (goal - pressure_);
        time_ += dt;
        // The smoothed point cuts corners of a curved surface: bring it back.
        if (const auto on = surface_.closest_point(point_, 5e-3); on && glm::dot(on->normal, normal_) > 0)
            point_ = on->position;
        poses.push_back(pose_at(point_, normal_, pressure_, time_));
    }
    return poses;
}

std::vector<brush::Pose> MouseHand::lift(double) {
    std::vector<brush::Pose> poses;
    if (!down_) return poses;
    constexpr int steps = 12;
    const double start = pressure_;
    for (int i = 1; i <= steps; ++i) {
        const double s = static_cast<double>(i) / steps;
        time_ += kLift / steps;
        poses.push_back(pose_at(point_, normal_, i == steps ? 0.0 : start * (1 - s), time_));
    }
    down_ = false;
    return poses;
}

}  // namespace tuft::app
