#include "stroke/session/forecast.h"

#include <algorithm>
#include <utility>

#include "core/system/parallel.h"

namespace tuft::stroke {
namespace {

constexpr std::size_t kPartPoses = 32;    // a hundredth of a second of bending
constexpr std::size_t kPartsAhead = 3;    // bound the poses in memory
constexpr std::size_t kClosedAtOnce = 8;  // poses whose footprints are computed in parallel, as a batch of stamps is

bool same(const brush::Pose& a, const brush::Pose& b) {
    return a.position == b.position && a.rotation == b.rotation && a.time == b.time;
}

double seconds_between(std::span<const brush::Pose> path, std::size_t i) {
    return i > 0 ? path[i].time - path[i - 1].time : 0.0;
}

}  // namespace

StrokeForecast::StrokeForecast(brush::Tuft tuft, std::vector<brush::Pose> path, const mesh::SurfaceQuery& surface,
                               const Options& options)
    : surface_(surface),
      options_(options),
      path_(std::move(path)),
      parts_((path_.size() + kPartPoses - 1) / kPartPoses),
      hair_(std::move(tuft)) {
    hair_.wetness = 1;
    hair_.ink_left = kWetFullness;
    hair_.bundles = {};  // no part of bending
    if (!parts_.empty()) parts_.front().hair = hair_;
}

// Hair that painted before comes through the air, as in a session.
contact::Result StrokeForecast::bend(brush::Tuft& hair, contact::Memory& memory, std::size_t i) const {
    if (i == 0 && hair.posed) brush::step(hair, path_[i], {}, 0);
    return contact::step(hair, path_[i], surface_, memory, seconds_between(path_, i), options_.contact);
}

void StrokeForecast::compute_part(std::size_t k, bool closes) {
    if (hair_.split) return;
    Part& part = parts_[k];
    if (k > 0) part.hair = hair_, part.memory = memory_;
    const std::size_t begin = k * kPartPoses, end = std::min(begin + kPartPoses, path_.size());
    part.poses.reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
        PoseForecast forecast{.pose = path_[i], .contact = {}, .hair = {}};
        forecast.contact = bend(hair_, memory_, i);
        if (hair_.split) return;
        if (touches(forecast.contact)) {
            forecast.hair = find_hair(hair_, forecast.contact, last_);
            if (closes) close_hair(forecast.hair, forecast.contact, options_.closed);
        }
        last_.store(hair_, forecast.pose, forecast.hair, forecast.contact);
        part.poses.push_back(std::move(forecast));
    }
}

void StrokeForecast::compute() {
    for (std::size_t k = 0; k < parts_.size() && !hair_.split; ++k) compute_part(k, true);
}

void StrokeForecast::compute_ahead() {
    ahead_ = std::make_unique<WorkAhead>(parts_.size(), kPartsAhead, [this](std::size_t k) { compute_part(k, false); });
    ahead_->begin();
}

// Footprints do not depend on each other: the threads that deposit compute them.
void StrokeForecast::close_together(Part& part, std::size_t from) const {
    const std::size_t n = std::min(kClosedAtOnce, part.poses.size() - from);
    parallel_for(n, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            PoseForecast& pose = part.poses[from + i];
            if (touches(pose.contact)) close_hair(pose.hair, pose.contact, options_.closed);
        }
    });
}

PoseForecast* StrokeForecast::next(const brush::Pose& pose, const brush::Tuft& hair, bool closes) {
    if (next_ == path_.size() || hair.wetness != 1) return nullptr;
    const std::size_t k = next_ / kPartPoses, at = next_ % kPartPoses;
    if (ahead_) ahead_->wait(k);
    Part& part = parts_[k];
    if (at >= part.poses.size() || !same(part.poses[at].pose, pose)) return nullptr;
    if (at == 0 && k > 0) parts_[k - 1] = {};
    if (ahead_ && closes && at % kClosedAtOnce == 0) close_together(part, at);
    ++next_;
    return &part.poses[at];
}

void StrokeForecast::catch_up(brush::Tuft& hair, contact::Memory& memory) {
    ahead_.reset();
    brush::Tuft bent;
    if (next_ == path_.size()) {
        bent = std::move(hair_);
        memory = memory_;
    } else {
        const std::size_t k = next_ > 0 ? (next_ - 1) / kPartPoses : 0;  // computed, and the last not released
        bent = std::move(parts_[k].hair);
        memory = parts_[k].memory;
        for (std::size_t i = k * kPartPoses; i < next_; ++i) bend(bent, memory, i);
    }
    bent.bundles = std::move(hair.bundles);
    bent.wetness = hair.wetness;
    bent.ink_left = hair.ink_left;
    hair = std::move(bent);
}

}  // namespace tuft::stroke
