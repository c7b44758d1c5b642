#include "stroke/resample.h"

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
    const Quat d = glm::dot(a.rotation, b.rotation) < 0 ? a.rotation + b.rotation
                                                        : a.rotation - b.rotation;
    const double turn = o.lever * 4.0 * std::asin(std::min(1.0, 0.5 * glm::length(d)));
    const double rest = o.drift * (b.time - a.time);
    return std::sqrt(dx * dx + turn * turn + rest * rest);
}

// Barry and Goldman's pyramid for the centripetal spline between p1 and p2.
Vec3 catmull_rom(const Vec3& p0, const Vec3& p1, const Vec3& p2, const Vec3& p3, double s) {
    const auto knot = [](const Vec3& a, const Vec3& b) {
        return std::max(std::sqrt(glm::distance(a, b)), 1e-9);
    };
    const double t0 = 0, t1 = t0 + knot(p0, p1), t2 = t1 + knot(p1, p2), t3 = t2 + knot(p2, p3);
    const double t = t1 + s * (t2 - t1);
    const Vec3 a1 = (t1 - t) / (t1 - t0) * p0 + (t - t0) / (t1 - t0) * p1;
    const Vec3 a2 = (t2 - t) / (t2 - t1) * p1 + (t - t1) / (t2 - t1) * p2;
    const Vec3 a3 = (t3 - t) / (t3 - t2) * p2 + (t - t2) / (t3 - t2) * p3;
    const Vec3 b1 = (t2 - t) / (t2 - t0) * a1 + (t - t0) / (t2 - t0) * a2;
    const Vec3 b2 = (t3 - t) / (t3 - t1) * a2 + (t - t1) / (t3 - t1) * a3;
    return (t2 - t) / (t2 - t1) * b1 + (t - t1) / (t2 - t1) * b2;
}

Pose between(const Pose& a, const Pose& b, const Vec3& before, const Vec3& after, double s) {
    if (s <= 0) return a;
    if (s >= 1) return b;
    Pose p;
    p.position = glm::distance(a.position, b.position) > 1e-9
                     ? catmull_rom(before, a.position, b.position, after, s)
                     : glm::mix(a.position, b.position, s);
    p.rotation = glm::normalize(glm::slerp(a.rotation, b.rotation, s));
    p.time = a.time + s * (b.time - a.time);
    return p;
}

}  // namespace

Resampler::Resampler(const ResampleOptions& options) : options_(options) {}

void Resampler::emit(const Pose& pose, std::vector<Pose>& out) {
    if (++emitted_ > options_.max_poses)
        throw Error("the stroke is too long: more than " + std::to_string(options_.max_poses) +
                    " steps of " + std::to_string(options_.step * 1e3) + " mm");
    out.push_back(pose);
}

// The segment from window_[0] to window_[1], with its neighbours' positions.
void Resampler::emit_segment(const Vec3& before, const Vec3& after, std::vector<Pose>& out) {
    const Pose& a = window_[0];
    const Pose& b = window_[1];
    Pose last = a;
    for (int k = 1; k <= kPieces; ++k) {
        const double s0 = static_cast<double>(k - 1) / kPieces;
        const double s1 = static_cast<double>(k) / kPieces;
        const Pose next = between(a, b, before, after, s1);
        const double piece = pose_distance(last, next, options_);
        double used = 0;
        while (since_last_ + (piece - used) >= options_.step) {
            used += options_.step - since_last_;
            since_last_ = 0;
            emit(between(a, b, before, after, s0 + (s1 - s0) * std::min(1.0, used / piece)), out);
        }
        since_last_ += piece - used;
        last = next;
    }
}

void Resampler::push(Pose sample, std::vector<Pose>& out) {
    if (!window_.empty()) {
        sample.time = std::max(sample.time, window_.back().time);
        if (pose_distance(window_.back(), sample, options_) <= 0) return;
    }
    if (window_.empty()) {
        window_.push_back(sample);
        emit(sample, out);
        return;
    }
    window_.push_back(sample);
    // window_: [before] a b after; work on a–b once its follower is here.
    if (has_before_) {
        if (window_.size() < 4) return;
        const Vec3 before = window_.front().position;
        window_.pop_front();
        emit_segment(before, window_[2].position, out);
    } else {
        if (window_.size() < 3) return;
        // A path that starts or ends goes on straight beyond its end.
        emit_segment(2.0 * window_[0].position - window_[1].position, window_[2].position, out);
        has_before_ = true;
    }
}

void Resampler::finish(std::vector<Pose>& out) {
    if (window_.size() >= 2) {
        Vec3 before;
        if (has_before_) {
            before = window_.front().position;
            window_.pop_front();
        } else {
            before = 2.0 * window_[0].position - window_[1].position;
        }
        emit_segment(before, 2.0 * window_[1].position - window_[0].position, out);
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
