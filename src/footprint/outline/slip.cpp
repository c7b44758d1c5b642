#include "footprint/outline/slip.h"

#include <algorithm>
#include <cmath>

namespace tuft::footprint {
namespace {

constexpr double kStill = 1e-7;  // metres from stamp to stamp: less is no motion but round-off of hair that sticks

/// Where a trail's hair lies between its cuts.
struct Place {
    Vec2 centre{0}, half{0};
    Vec2 slant{0}, bow{0}, drop{0};  ///< of a strip, see Cut
    double free_side = 1;

    /// Of hair at x in [−1, 1], from where a straight strip has it.
    Vec2 bent(double x) const { return Cut{.slant = slant, .bow = bow, .drop = drop, .free_side = free_side}.bent(x); }
};

Place place_at(const Trail& trail, double along) {
    const Recycled<double>& a = trail.along;  // falls
    const auto after = std::lower_bound(a.begin(), a.end(), along, std::greater<>());
    const std::size_t j = std::clamp<std::size_t>(static_cast<std::size_t>(after - a.begin()), 1, a.size() - 1),
                      i = j - 1;
    const double run = a[i] - a[j], f = run > 1e-12 ? std::clamp((a[i] - along) / run, 0.0, 1.0) : 0;
    const Cut &p = trail.cuts[i], &q = trail.cuts[j];
    const auto half = [&](const Cut& cut) { return trail.strip ? Vec2(cut.broad()) : cut.a * Vec2(cut.e); };
    return {glm::mix(p.centre, q.centre, f), glm::mix(half(p), half(q), f), glm::mix(p.slant, q.slant, f),
            glm::mix(p.bow, q.bow, f),       glm::mix(p.drop, q.drop, f),   p.free_side};
}

/// The trail of the same branch that has most of its hair.
const Trail* same_hair(const Trail& trail, std::span<const Trail> before) {
    const Trail* best = nullptr;
    double most = 0;
    for (const Trail& b : before) {
        if (b.branch != trail.branch || b.cuts.size() < 2) continue;
        const double common =
            std::min(b.along.front(), trail.along.front()) - std::max(b.along.back(), trail.along.back());
        if (common > most) most = common, best = &b;
    }
    return best;
}

}  // namespace

Cut cut_between(const Cut& p, const Cut& q, double f) {
    const auto unit = [](const Vec3& v, const Vec3& otherwise) {
        const double size = glm::length(v);
        return size > 1e-9 ? v / size : otherwise;
    };
    const Vec2 turn = glm::mix(p.turn, q.turn, f);
    return {glm::mix(p.centre, q.centre, f),
            std::lerp(p.z, q.z, f),
            std::lerp(p.a, q.a, f),
            std::lerp(p.b, q.b, f),
            unit(glm::mix(p.e, q.e, f), p.e),
            unit(glm::mix(p.m, q.m, f), p.m),
            glm::dot(turn, turn) > 1e-6 ? glm::normalize(turn) : p.turn,
            glm::mix(p.slant, q.slant, f),
            glm::mix(p.bow, q.bow, f),
            glm::mix(p.drop, q.drop, f),
            p.free_side,
            glm::mix(p.reach, q.reach, f),
            glm::mix(p.ahead_lo, q.ahead_lo, f),
            glm::mix(p.ahead_hi, q.ahead_hi, f)};
}

void change_frame(Recycled<Trail>& trails, const Frame& from, const Frame& to) {
    const auto to_other = [&](const Vec3& v) {
        const Vec3 world = v.x * from.t + v.y * from.b + v.z * from.n;
        return Vec3{glm::dot(world, to.t), glm::dot(world, to.b), glm::dot(world, to.n)};
    };
    for (Trail& trail : trails)
        for (Cut& cut : trail.cuts) {
            cut.centre = Vec2(to.to_local(from.to_world(Vec3(cut.centre, 0))));
            cut.e = to_other(cut.e);
            cut.m = to_other(cut.m);
            cut.slant = Vec2(to_other(Vec3(cut.slant, 0)));
            cut.bow = Vec2(to_other(Vec3(cut.bow, 0)));
            cut.drop = Vec2(to_other(Vec3(cut.drop, 0)));
            cut.ahead_lo = Vec2(to_other(Vec3(cut.ahead_lo, 0)));
            cut.ahead_hi = Vec2(to_other(Vec3(cut.ahead_hi, 0)));
        }
}

TransverseLength::TransverseLength(const TrailPart& part, std::span<const Trail> before, const Vec2& direction) {
    const Trail& trail = part.trail;
    const Trail* was = same_hair(trail, before);
    for (std::size_t i = part.begin; i + 1 < part.end; ++i) {
        const Vec2 run = trail.cuts[i + 1].centre - trail.cuts[i].centre;
        length_ += glm::length(run);
        if (!was) {
            const double across = std::abs(run.x * direction.y - run.y * direction.x);
            for (double& m : measure_) m += across;
            continue;
        }
        // Hair that only now touches goes as its neighbour does.
        const double along =
            std::clamp(0.5 * (trail.along[i] + trail.along[i + 1]), std::max(trail.along.back(), was->along.back()),
                       std::min(trail.along.front(), was->along.front()));
        const Place p = place_at(*was, along), q = place_at(trail, along);
        const Vec2 middle = q.centre - p.centre, spread = q.half - p.half;
        for (std::size_t k = 0; k < kPlaces; ++k) {
            const double x = 2 * static_cast<double>(k) / (kPlaces - 1) - 1;
            const Vec2 moved = middle + x * spread + (q.bent(x) - p.bent(x));
            measure_[k] += std::abs(run.x * moved.y - run.y * moved.x) / (glm::length(moved) + kStill);
            displacement_[k] += glm::length(run) * moved;
        }
    }
}

namespace {

/// Value at x in [-1, 1] of a row of evenly spaced ones.
template <class T, std::size_t N>
T between(const std::array<T, N>& row, double x) {
    const double u = 0.5 * (std::clamp(x, -1.0, 1.0) + 1) * (N - 1);
    const auto k = std::min(static_cast<std::size_t>(u), N - 2);
    return row[k] + (u - static_cast<double>(k)) * (row[k + 1] - row[k]);
}

}  // namespace

double TransverseLength::at(double x) const {
    return between(measure_, x);
}

double TransverseLength::sine_to(double x, const Vec2& direction) const {
    const Vec2 moved = between(displacement_, x);
    const double lengths = glm::length(moved) * glm::length(direction);
    return lengths > 0 ? std::abs(moved.x * direction.y - moved.y * direction.x) / lengths : 0;
}

}  // namespace tuft::footprint
