#include "stroke/session/forecast.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "core/system/parallel.h"

namespace tuft::stroke {
namespace {

constexpr std::size_t kPartPoses = 32;  // a hundredth of a second of bending
constexpr std::size_t kHandPoses = 4;   // of a hand that paints: its ink waits for the first part
constexpr std::size_t kPartsAhead = 3;  // bound the poses in memory
// Of parts whose poses hold the cells of their footprints, too: 0.25 MB of a stamp 256 texels wide.
constexpr std::size_t kClosedPoses = 8, kClosedAhead = 1;
constexpr std::size_t kClosedAtOnce = 8;  // poses whose footprints are computed in parallel, as a batch of stamps is
// Up to so many threads the one that bends ahead also computes the footprints: else it waits, and those who deposit ink
// have them to do.
constexpr int kThreadsForOneCloser = 2;

template <class T>
std::size_t bytes_of(const Recycled<T>& all) {
    return std::bit_ceil(all.capacity() * sizeof(T));  // as blocks are
}

std::size_t bytes_of_trails(const Recycled<footprint::Trail>& trails) {
    std::size_t bytes = bytes_of(trails);
    for (const footprint::Trail& trail : trails) {
        bytes += bytes_of(trail.cuts) + bytes_of(trail.along);
        for (const footprint::TrailOpening& opening : trail.openings) bytes += bytes_of(opening.width);
    }
    return bytes;
}

/// Bytes that a pose holds, but for what is small.
std::size_t bytes_of_pose(const PoseForecast& pose) {
    std::size_t bytes = sizeof pose + bytes_of(pose.contact.planes) + bytes_of_trails(pose.hair.trails) +
                        bytes_of_trails(pose.hair.leapt);
    for (const brush::Branch& branch : pose.contact.tuft.branches) bytes += bytes_of(branch.sections);
    for (const auto& planes : pose.contact.branch_planes) bytes += bytes_of(planes);
    for (const footprint::Outline& o : pose.hair.outlines)
        bytes += bytes_of(o.left) + bytes_of(o.right) + bytes_of(o.control);
    if (pose.hair.closed) bytes += bytes_of(pose.hair.closed->coverage);
    return bytes;
}

bool same(const brush::Pose& a, const brush::Pose& b) {
    return a.position == b.position && a.rotation == b.rotation && a.time == b.time;
}

}  // namespace

StrokeForecast::StrokeForecast(brush::Tuft tuft, std::vector<brush::Pose> path, const mesh::SurfaceQuery& surface,
                               const Options& options)
    : surface_(surface), options_(options), path_(std::move(path)), hair_(std::move(tuft)) {
    hair_.wetness = 1;
    hair_.ink_left = kWetFullness;
    const std::uint64_t seed = hair_.bundles.seed;
    hair_.bundles = {};         // no part of bending
    hair_.bundles.seed = seed;  // of the edge and the tone of wet hair
    cut_path(kPartPoses);
}

void StrokeForecast::cut_path(std::size_t part_poses) {
    part_poses_ = part_poses;
    parts_.clear();
    parts_.resize((path_.size() + part_poses - 1) / part_poses);
    next_ = 0;
    if (parts_.empty()) return;
    parts_.front().hair = hair_;
    parts_.front().memory = memory_;
}

double StrokeForecast::seconds_before(std::size_t i) const {
    if (i == 0 && !earlier_) return 0;
    return path_[i].time - (i > 0 ? path_[i - 1].time : *earlier_);
}

// Hair that painted before comes through the air, as in a session.
contact::Result StrokeForecast::bend(brush::Tuft& hair, contact::Memory& memory, std::size_t i) const {
    if (i == 0 && !earlier_ && hair.posed) brush::step(hair, path_[i], {}, 0);
    return contact::step(hair, path_[i], surface_, memory, seconds_before(i), options_.contact);
}

void StrokeForecast::compute_part(std::size_t k, bool closes) {
    if (hair_.split) return;
    Part& part = parts_[k];
    if (k > 0) part.hair = hair_, part.memory = memory_;
    const std::size_t begin = k * part_poses_, end = std::min(begin + part_poses_, path_.size());
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

StrokeForecast::~StrokeForecast() {
    ahead_.reset();
    for (Part& part : parts_) release(part);
}

void StrokeForecast::release(Part& part) {
    if (budget_) budget_->held -= part.bytes;
    part = {};
}

void StrokeForecast::compute_within_budget() {
    Part& part = parts_[computed_];
    compute_part(computed_++, closes_);
    for (const PoseForecast& pose : part.poses) part.bytes += bytes_of_pose(pose);
    budget_->held += part.bytes;
}

void StrokeForecast::compute(bool closes, ForecastBudget& budget) {
    budget_ = &budget;
    closes_ = closes;
    while (computed_ < parts_.size() && !hair_.split && (computed_ == 0 || budget.held < budget.most))
        compute_within_budget();
}

void StrokeForecast::compute_ahead() {
    const bool closes = thread_count() <= kThreadsForOneCloser;
    if (closes) cut_path(kClosedPoses);
    ahead_ = std::make_unique<WorkAhead>(parts_.size(), closes ? kClosedAhead : kPartsAhead,
                                         [this, closes](std::size_t k) { compute_part(k, closes); });
    ahead_->begin();
}

void StrokeForecast::follow(std::vector<brush::Pose> poses) {
    if (poses.empty() || hair_.split) return;
    ahead_.reset();
    if (!path_.empty()) earlier_ = path_.back().time;
    path_ = std::move(poses);
    cut_path(kHandPoses);
    if (parts_.size() == 1) return compute_part(0, false);
    ahead_ =
        std::make_unique<WorkAhead>(parts_.size(), parts_.size(), [this](std::size_t k) { compute_part(k, false); });
    ahead_->begin();
}

// Footprints do not depend on each other: the threads that deposit compute them.
void StrokeForecast::close_together(Part& part, std::size_t from) const {
    const std::size_t n = std::min(kClosedAtOnce, part.poses.size() - from);
    const auto is_open = [](const PoseForecast& pose) { return touches(pose.contact) && !pose.hair.closed; };
    if (std::ranges::none_of(std::span(part.poses).subspan(from, n), is_open)) return;
    parallel_for(n, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            PoseForecast& pose = part.poses[from + i];
            if (is_open(pose)) close_hair(pose.hair, pose.contact, options_.closed);
        }
    });
}

PoseForecast* StrokeForecast::next(const brush::Pose& pose, const brush::Tuft& hair, bool closes) {
    if (next_ == path_.size() || hair.wetness != 1) return nullptr;
    const std::size_t k = next_ / part_poses_, at = next_ % part_poses_;
    if (ahead_) ahead_->wait(k);
    while (budget_ && computed_ <= k && !hair_.split) compute_within_budget();
    Part& part = parts_[k];
    if (at >= part.poses.size() || !same(part.poses[at].pose, pose)) return nullptr;
    if (at == 0 && k > 0) release(parts_[k - 1]);
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
        const std::size_t k = next_ > 0 ? (next_ - 1) / part_poses_ : 0;  // computed, and the last not released
        bent = std::move(parts_[k].hair);
        memory = parts_[k].memory;
        for (std::size_t i = k * part_poses_; i < next_; ++i) bend(bent, memory, i);
    }
    bent.bundles = std::move(hair.bundles);
    bent.wetness = hair.wetness;
    bent.ink_left = hair.ink_left;
    hair = std::move(bent);
}

}  // namespace tuft::stroke
