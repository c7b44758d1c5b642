#include "stroke/session/forecast.h"

#include <utility>

namespace tuft::stroke {
namespace {

bool same(const brush::Pose& a, const brush::Pose& b) {
    return a.position == b.position && a.rotation == b.rotation && a.time == b.time;
}

double seconds_between(std::span<const brush::Pose> path, std::size_t i) {
    return i > 0 ? path[i].time - path[i - 1].time : 0.0;
}

}  // namespace

StrokeForecast::StrokeForecast(brush::Tuft tuft, std::span<const brush::Pose> path, const mesh::SurfaceQuery& surface,
                               const Options& options)
    : surface_(surface), options_(options), start_(std::move(tuft)), path_(path.begin(), path.end()) {
    start_.wetness = 1;
    start_.ink_left = kWetFullness;
    end_ = start_;
    LastHair last;
    for (std::size_t i = 0; i < path_.size(); ++i) {
        PoseForecast forecast{.pose = path_[i], .contact = {}, .hair = {}};
        forecast.contact =
            contact::step(end_, path_[i], surface_, end_memory_, seconds_between(path_, i), options_.contact);
        if (end_.split) break;
        if (touches(forecast.contact)) {
            forecast.hair = find_hair(end_, forecast.contact, last);
            close_hair(forecast.hair, forecast.contact, options_.closed);
        }
        last.store(end_, forecast.pose, forecast.hair, forecast.contact);
        poses_.push_back(std::move(forecast));
    }
}

PoseForecast* StrokeForecast::next(const brush::Pose& pose, const brush::Tuft& hair) {
    if (next_ == poses_.size() || hair.wetness != 1 || !same(poses_[next_].pose, pose)) return nullptr;
    return &poses_[next_++];
}

brush::Tuft StrokeForecast::bend_to(std::size_t end, contact::Memory& memory) const {
    brush::Tuft tuft = start_;
    for (std::size_t i = 0; i < end; ++i)
        contact::step(tuft, path_[i], surface_, memory, seconds_between(path_, i), options_.contact);
    return tuft;
}

void StrokeForecast::catch_up(brush::Tuft& hair, contact::Memory& memory) {
    memory = {};
    brush::Tuft bent;
    if (next_ == path_.size()) {
        bent = std::move(end_);
        memory = end_memory_;
    } else {
        bent = bend_to(next_, memory);
    }
    bent.bundles = std::move(hair.bundles);
    bent.wetness = hair.wetness;
    bent.ink_left = hair.ink_left;
    hair = std::move(bent);
}

}  // namespace tuft::stroke
