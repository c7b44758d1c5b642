#include "motion/retime.h"

#include <algorithm>
#include <cmath>

namespace tuft::motion {
namespace {

constexpr double kNoLength = 1e-9;   // metres
constexpr double kLeastTime = 1e-3;  // seconds, of a segment
constexpr double kSlack = 1 - 1e-6;  // of the limits, for rounding

struct Segment {
    Vec3 direction{0};
    double length = 0, speed = 0, time = 0;  // `time`: of a segment without length

    bool moves() const { return length > kNoLength; }
};

}  // namespace

double angle_between(const Quat& a, const Quat& b) {
    return 2 * std::acos(std::min(1.0, std::abs(glm::dot(a, b))));
}

void retime(std::vector<Waypoint>& points, const Limits& limits, std::span<const double> pace) {
    if (points.empty()) return;
    std::vector<Segment> segments(points.size() - 1);
    for (std::size_t i = 0; i < segments.size(); ++i) {
        Segment& s = segments[i];
        const Vec3 d = points[i + 1].pose.position - points[i].pose.position;
        s.length = glm::length(d);
        s.time =
            std::max({kLeastTime, pace.empty() ? 0 : pace[i],
                      angle_between(points[i].pose.rotation, points[i + 1].pose.rotation) / (kSlack * limits.turn)});
        if (!s.moves()) continue;
        s.direction = d / s.length;
        s.speed = std::min(kSlack * limits.speed, s.length / s.time);
    }
    const double a = kSlack * limits.acceleration;
    for (std::size_t i = 1; i < segments.size(); ++i) {
        Segment &before = segments[i - 1], &after = segments[i];
        const double bend = glm::length(after.direction - before.direction);
        if (!before.moves() || !after.moves() || !(bend > 0)) continue;
        const double most = std::sqrt(0.25 * a * (before.length + after.length) / bend);
        before.speed = std::min(before.speed, most);
        after.speed = std::min(after.speed, most);
    }
    // The fastest segment of length l beside one of length k and speed v.
    const auto fastest = [&](double l, double k, double v) { return 0.5 * (v + std::sqrt(v * v + a * (l + k))); };
    double length = 0, speed = 0;
    for (Segment& s : segments) {
        if (s.moves()) s.speed = std::min(s.speed, fastest(s.length, length, speed));
        length = s.length, speed = s.speed;
    }
    length = speed = 0;
    for (auto s = segments.rbegin(); s != segments.rend(); ++s) {
        if (s->moves()) s->speed = std::min(s->speed, fastest(s->length, length, speed));
        length = s->length, speed = s->speed;
    }
    double time = 0;
    points[0].pose.time = 0;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        time += segments[i].moves() ? segments[i].length / segments[i].speed : segments[i].time;
        points[i + 1].pose.time = time;
    }
}

}  // namespace tuft::motion
