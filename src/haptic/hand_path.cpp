#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/ease.h"
#include "haptic/trial.h"

namespace tuft::haptic {
namespace {

using std::numbers::pi;

constexpr double kAir = 1.0;     // s before the hand moves: safety lets the force in over half of it
constexpr double kAbove = 4e-3;  // m of the tip over the surface meanwhile

Quat upright(const Vec3& n) {
    const Vec3 axis = glm::cross(Vec3{0, 0, 1}, n);
    const double s = glm::length(axis);
    if (s < 1e-12) return n.z > 0 ? Quat{1, 0, 0, 0} : Quat{0, 1, 0, 0};
    return glm::angleAxis(std::atan2(s, n.z), axis / s);
}

/// Place of the root over the surface: height of the tip above it at rest, displacement along t and b, lean about b.
struct Posture {
    double height = 0, along = 0, across = 0, lean = 0;
};

/// Down from the air over `in` s, s seconds there, and up again.
double down_and_up(double t, double in, double stay) {
    return smooth_step(t / in) * (1 - smooth_step((t - in - stay) / in));
}

/// Path over final speed of what speeds up evenly over kStart from t = 0 on, s.
double started(double t) {
    constexpr double kStart = 0.025;  // s
    if (t <= 0) return 0;
    return t < kStart ? t * t / (2 * kStart) : t - kStart / 2;
}

Posture posture(HandMotion motion, double t, double length) {
    const double w = std::max(0.0, t - kAir);
    const auto to_depth = [&](double part) { return kAbove + part * length; };
    switch (motion) {
        case HandMotion::press:
            return {.height = kAbove - to_depth(0.4) * down_and_up(w, 1.0, 0.4), .lean = 0.1};
        case HandMotion::press_fast:
            return {.height = kAbove - to_depth(0.4) * down_and_up(std::fmod(w, 1.0), 0.12, 0.3)};
        case HandMotion::drag:
            return {.height = kAbove - to_depth(0.25) * smooth_step(w / 0.4),
                    .along = 0.02 * std::sin(2 * pi * 0.5 * w) * smooth_step(w / 0.2),
                    .lean = 0.2};
        case HandMotion::circles: {
            const double in = smooth_step(w / 0.5);
            return {.height = kAbove - to_depth(0.25) * in,
                    .along = in * 0.01 * std::cos(2 * pi * w),
                    .across = in * 0.01 * std::sin(2 * pi * w),
                    .lean = 0.15};
        }
        case HandMotion::taps: {
            constexpr double kSwing = 0.012, kSpeed = 0.5;  // m, m/s at the middle, where the tip lands
            return {.height = -kSwing * std::sin(kSpeed / kSwing * w) * smooth_step(w / 0.2) +
                              kAbove * (1 - smooth_step(w / 0.2))};
        }
        case HandMotion::rocking:
            return {.height = kAbove - to_depth(0.3) * smooth_step(w / 0.4),
                    .lean = 15 * pi / 180 * std::sin(2 * pi * w) * smooth_step(w)};
        case HandMotion::rest:
            return {.height = kAbove - to_depth(0.3) * smooth_step(w / 0.5), .lean = 0.1};
        case HandMotion::hit: {
            // The root, a tuft's length above the tip, comes down at 0.5 m/s and goes on to 5 mm behind the surface.
            constexpr double kSpeed = 0.5;  // m/s
            const double now = std::fmod(w, 1.0), depth = length + kAbove + 5e-3;
            const double fall = kSpeed * (started(now) - started(now - depth / kSpeed));
            return {.height = kAbove - fall * (1 - smooth_step((now - 0.5) / 0.3))};
        }
        case HandMotion::slide: {
            const double slid = std::max(0.0, w - 0.8);
            return {.height = kAbove - (length + kAbove + 1e-3) * smooth_step(w / 0.8),
                    .along = 0.03 * std::sin(2 * pi * 0.5 * slid) * smooth_step(slid / 0.2),
                    .lean = 0.3};
        }
    }
    return {};
}

}  // namespace

std::string_view name_of(HandMotion motion) {
    constexpr std::string_view kNames[] = {"press",   "press-fast", "drag", "circles", "taps",
                                           "rocking", "rest",       "hit",  "slide"};
    return kNames[static_cast<int>(motion)];
}

bool is_tap(HandMotion motion) {
    return motion == HandMotion::taps || motion == HandMotion::hit;
}

HandPath hand_path(HandMotion motion, const TrialPlace& place, const brush::Preset& brush, std::uint64_t seed) {
    const Frame f = place.frame;
    const double length = brush.length, heading = seed ? 2 * pi * uniform(seed, 1) : 0;
    const double faster = seed ? 0.7 + 0.6 * uniform(seed, 2) : 1;
    const Vec3 b = glm::cross(f.n, f.t), t = std::cos(heading) * f.t + std::sin(heading) * b, s = glm::cross(f.n, t);
    const Vec3 from =
        f.origin + (seed ? 2e-3 * (uniform(seed, 3) - 0.5) * t + 2e-3 * (uniform(seed, 4) - 0.5) * s : Vec3{0});
    const auto at = [=](double time) {
        const Posture p = posture(motion, kAir + (time - kAir) * faster, length);
        const Quat q = glm::angleAxis(p.lean, s) * upright(f.n);
        // The tip stays where it is while the holder leans about it.
        const Vec3 tip = from + p.along * t + p.across * s + p.height * f.n;
        return HandTarget{.position = tip + length * (q * Vec3{0, 0, 1}), .rotation = q};
    };
    return [=](double time) {
        constexpr double h = 1e-4;  // s
        HandTarget target = at(time);
        target.velocity = (at(time + h).position - at(time - h).position) / (2 * h);
        return target;
    };
}

TrialPlace place_above(const mesh::SurfaceQuery& surface, std::string name) {
    const Box& box = surface.mesh().bounds;
    const Vec3 above = box.centre() + Vec3{0, 0, box.diagonal()};
    auto hit = surface.ray(above, {0, 0, -1});
    if (!hit) hit = surface.closest_point(above);
    return {std::move(name), make_frame(hit->position, hit->normal, Vec3{1, 0, 0})};
}

TrialPlace place_at_edge(const mesh::SurfaceQuery& surface, std::string name, bool groove) {
    const Box& box = surface.mesh().bounds;
    const double top = box.centre().z + box.diagonal(), half = 0.5 * (box.hi.x - box.lo.x);
    constexpr int kSteps = 400;
    Frame best = place_above(surface, "").frame;
    double sharpest = 1;
    std::optional<mesh::SurfacePoint> before;
    for (int i = 0; i <= kSteps; ++i) {
        const Vec3 from{box.centre().x + half * i / kSteps, box.centre().y, top};
        const auto hit = surface.ray(from, {0, 0, -1});
        if (!hit) break;
        if (before) {
            const double turn = glm::dot(before->face_normal, hit->face_normal);
            const Vec3 n = before->face_normal + hit->face_normal;
            const bool convex = glm::dot(hit->position - before->position, hit->face_normal - before->face_normal) > 0;
            if (turn < sharpest && n.z > 0 && convex == !groove) {
                sharpest = turn;
                best = make_frame(0.5 * (before->position + hit->position), glm::normalize(n), Vec3{1, 0, 0});
            }
        }
        before = hit;
    }
    return {std::move(name), best};
}

}  // namespace tuft::haptic
