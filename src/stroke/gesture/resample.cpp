#include "stroke/gesture/resample.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace tuft::stroke {
namespace {

using brush::Pose;

// Pieces a segment is measured in; the chord of an eighth differs from its arc by
// less than 1 % even on a right-angled turn.
constexpr int kPieces = 8;

double pose_distance(const Pose& a, const Pose& b, const ResampleOptions& o) {
    const double dx = glm::distance(a.position, b.position);
    // Chord of the unit quaternions: sin is exact for small angles where acos is not.
    const Quat d = glm::dot(a.rotation, b.rotation) < 0 ? a.rotation + b.rotation : a.rotation - b.rotation;
    const double turn = o.lever * 4.0 * std::asin(std::min(1.0, 0.5 * glm::length(d)));
    const double rest = o.drift * (b.time - a.time);
    return std::sqrt(dx * dx + turn * turn + rest * rest);
}

/// Between knots of the centripetal spline.
double knot(const Vec3& a, const Vec3& b) {
    return std::max(std::sqrt(glm::distance(a, b)), 1e-9);
}

// Barry and Goldman's pyramid for the centripetal spline between p1 and p2.
Vec3 catmull_rom(const Vec3& p0, const Vec3& p1, const Vec3& p2, const Vec3& p3, double s) {
    const double t0 = 0, t1 = t0 + knot(p0, p1), t2 = t1 + knot(p1, p2), t3 = t2 + knot(p2, p3);
    const double t = t1 + s * (t2 - t1);
    const Vec3 a1 = (t1 - t) / (t1 - t0) * p0 + (t - t0) / (t1 - t0) * p1;
    const Vec3 a2 = (t2 - t) / (t2 - t1) * p1 + (t - t1) / (t2 - t1) * p2;
    const Vec3 a3 = (t3 - t) / (t3 - t2) * p2 + (t - t2) / (t3 - t2) * p3;
    const Vec3 b1 = (t2 - t) / (t2 - t0) * a1 + (t - t0) / (t2 - t0) * a2;
    const Vec3 b2 = (t3 - t) / (t3 - t1) * a2 + (t - t1) / (t3 - t1) * a3;
    return (t2 - t) / (t2 - t1) * b1 + (t - t1) / (t2 - t1) * b2;
}

/// Part of the time from b to c that has passed at the part s of the spline between them: Hermite's
/// cubic over the spline's own knots, with the slopes of the parabolas through three of them, no
/// steeper than keeps it rising [Fritsch1980].
double time_between(const Pose& a, const Pose& b, const Pose& c, const Pose& d, double s) {
    constexpr double kSteepest = 3;  // of the mean
    const double h = c.time - b.time;
    if (!(h > 0)) return s;
    const double k0 = knot(a.position, b.position), k1 = knot(b.position, c.position),
                 k2 = knot(c.position, d.position);
    // Slopes of the chords before and after, over that of the chord between.
    const double before = (b.time - a.time) / h * (k1 / k0), after = (d.time - c.time) / h * (k1 / k2);
    const double from = std::clamp((k1 * before + k0) / (k0 + k1), 0.0, kSteepest);
    const double to = std::clamp((k1 * after + k2) / (k1 + k2), 0.0, kSteepest);
    const double r = 1 - s;  // the cubic from 0 to 1, kept to the bit: texels of projects depend on it
    return std::clamp(s * s * (3 - 2 * s) + r * s * (r * from - s * to), 0.0, 1.0);
}

/// Half the rotation vector that turns a into b.
Vec3 half_turn(const Quat& a, const Quat& b) {
    Quat d = glm::conjugate(a) * b;
    if (d.w < 0) d = -d;
    const Vec3 v{d.x, d.y, d.z};
    const double sin = glm::length(v);
    return sin > 0 ? std::atan2(sin, d.w) / sin * v : Vec3{0};
}

Quat turned(const Quat& q, const Vec3& half) {
    const double angle = glm::length(half);
    const Vec3 v = angle > 0 ? std::sin(angle) / angle * half : Vec3{0};
    return q * Quat(std::cos(angle), v.x, v.y, v.z);
}

/// Half the turn in unit time at b on the way a, b, c with h0 and h1 between: that of the parabola.
/// Within the span `h` it turns by no more than twice what both do: samples that follow each other
/// at once with a jump between must not throw the rest about.
Vec3 rate_at(const Quat& a, const Quat& b, const Quat& c, double h0, double h1, double h) {
    const Vec3 first = half_turn(a, b), second = half_turn(b, c);
    const Vec3 rate = (h1 / h0 * first + h0 / h1 * second) / (h0 + h1);
    const double most = 2 * (glm::length(first) + glm::length(second)), turn = h * glm::length(rate);
    return turn > most ? most / turn * rate : rate;
}

/// Cubic path from b to c in time, with the parabolas' rates at its ends: cumulative Bézier form.
Quat rotation_between(const Pose& a, const Pose& b, const Pose& c, const Pose& d, double s) {
    constexpr double kSame = 1e-15;  // of 1 − |cos| between rotations
    const double h = c.time - b.time;
    const bool turns = 1 - std::abs(glm::dot(b.rotation, c.rotation)) > kSame ||
                       1 - std::abs(glm::dot(a.rotation, b.rotation)) > kSame ||
                       1 - std::abs(glm::dot(c.rotation, d.rotation)) > kSame;
    if (!(h > 0) || !turns) return glm::normalize(glm::slerp(b.rotation, c.rotation, s));
    const double h0 = b.time - a.time, h1 = d.time - c.time;
    const Vec3 straight = half_turn(b.rotation, c.rotation) / h;
    const Vec3 from = h0 > 0 ? rate_at(a.rotation, b.rotation, c.rotation, h0, h, h) : straight;
    const Vec3 to = h1 > 0 ? rate_at(b.rotation, c.rotation, d.rotation, h, h1, h) : straight;
    const Quat p = turned(b.rotation, h / 3 * from), q = turned(c.rotation, -h / 3 * to);
    const double r = 1 - s, w1 = 1 - r * r * r, w2 = s * s * (3 - 2 * s), w3 = s * s * s;
    const Quat first = turned(b.rotation, w1 * (h / 3 * from));
    return glm::normalize(turned(turned(first, w2 * half_turn(p, q)), w3 * (h / 3 * to)));
}

/// A pose between b and c, whose neighbours are a and d.
Pose between(const Pose& a, const Pose& b, const Pose& c, const Pose& d, double s) {
    if (s <= 0) return b;
    if (s >= 1) return c;
    Pose p;
    double passed = s;
    if (glm::distance(b.position, c.position) > 1e-9) {
        p.position = catmull_rom(a.position, b.position, c.position, d.position, s);
        passed = time_between(a, b, c, d, s);
    } else {
        p.position = glm::mix(b.position, c.position, s);
    }
    p.rotation = rotation_between(a, b, c, d, passed);
    p.time = b.time + passed * (c.time - b.time);
    return p;
}

/// The path beyond its end at b, where it came from a: straight on, at the same pace.
Pose beyond(const Pose& a, const Pose& b) {
    return {2.0 * b.position - a.position, turned(b.rotation, half_turn(a.rotation, b.rotation)), 2 * b.time - a.time};
}

[[noreturn]] void refuse_length(const ResampleOptions& o) {
    throw Error(Message("the stroke is too long for this model: more than {} steps of {} mm", o.max_poses,
                        fmt::format("{:.3g}", 1e3 * o.step)));
}

}  // namespace

void check_path_length(std::span<const Pose> poses, const ResampleOptions& options) {
    double length = 0;  // of the chords; no curve between their ends is shorter
    for (std::size_t i = 1; i < poses.size(); ++i) {
        Pose next = poses[i];
        next.time = std::max(next.time, poses[i - 1].time);
        length += pose_distance(poses[i - 1], next, options);
    }
    if (length > options.step * static_cast<double>(options.max_poses + 1)) refuse_length(options);
}

Resampler::Resampler(const ResampleOptions& options) : options_(options) {}

void Resampler::emit(const Pose& pose, std::vector<Pose>& out) {
    if (++emitted_ > options_.max_poses) refuse_length(options_);
    out.push_back(pose);
}

// The segment from window_[0] to window_[1], with its neighbours.
void Resampler::emit_segment(const Pose& before, const Pose& after, std::vector<Pose>& out) {
    const Pose& a = window_[0];
    const Pose& b = window_[1];
    Pose last = a;
    for (int k = 1; k <= kPieces; ++k) {
        const double s0 = static_cast<double>(k - 1) / kPieces;
        const double s1 = static_cast<double>(k) / kPieces;
        const Pose next = between(before, a, b, after, s1);
        const double piece = pose_distance(last, next, options_);
        double used = 0;
        while (since_last_ + (piece - used) >= options_.step) {
            used += options_.step - since_last_;
            since_last_ = 0;
            emit(between(before, a, b, after, s0 + (s1 - s0) * std::min(1.0, used / piece)), out);
        }
        since_last_ += piece - used;
        last = next;
    }
    places_.push_back(static_cast<double>(emitted_ - 1) + since_last_ / options_.step);
}

std::vector<double> Resampler::places() const {
    std::vector<double> places;
    for (const std::uint32_t sample : merged_)
        if (sample < places_.size()) places.push_back(places_[sample]);
    return places;
}

void Resampler::push(Pose sample, std::vector<Pose>& out) {
    if (!window_.empty()) {
        sample.time = std::max(sample.time, window_.back().time);
        if (pose_distance(window_.back(), sample, options_) <= 0) {
            merged_.push_back(merged_.back());
            return;
        }
    }
    merged_.push_back(merged_.empty() ? 0 : merged_.back() + 1);
    if (window_.empty()) {
        window_.push_back(sample);
        emit(sample, out);
        places_.push_back(0);
        return;
    }
    window_.push_back(sample);
    // window_: [before] a b after; work on a–b once its follower is here.
    if (has_before_) {
        if (window_.size() < 4) return;
        const Pose before = window_.front();
        window_.pop_front();
        emit_segment(before, window_[2], out);
    } else {
        if (window_.size() < 3) return;
        // A path that starts or ends goes on straight beyond its end.
        emit_segment(beyond(window_[1], window_[0]), window_[2], out);
        has_before_ = true;
    }
}

void Resampler::finish(std::vector<Pose>& out) {
    if (window_.size() >= 2) {
        Pose before;
        if (has_before_) {
            before = window_.front();
            window_.pop_front();
        } else {
            before = beyond(window_[1], window_[0]);
        }
        emit_segment(before, beyond(window_[0], window_[1]), out);
        // The end itself, unless a step fell on it.
        if (since_last_ > 1e-9 * options_.step) emit(window_.back(), out);
    }
    window_.clear();
    has_before_ = false;
    since_last_ = 0;
}

std::vector<Pose> resample(std::span<const Pose> poses, const ResampleOptions& options) {
    std::vector<Pose> out;
    Resampler resampler(options);
    for (const Pose& p : poses) resampler.push(p, out);
    resampler.finish(out);
    return out;
}

}  // namespace tuft::stroke
