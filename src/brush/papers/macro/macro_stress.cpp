#include "brush/papers/macro/macro_stress.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tuft::brush::macro {

namespace {

constexpr double kRay = 2 * std::numbers::pi / kRays;
constexpr int kMeanRays = 32;  ///< directions of a mean stress with a turn; a turn is a shift of them

double ray_angle(int k) {
    return kRay * (k + 0.5);
}

/// Squared cosines of `Count` even directions w_k = 2π (k + ½)/Count.
template <int Count>
struct Directions {
    std::array<double, Count> cos2{}, sin2{};

    Directions() {
        for (int k = 0; k < Count; ++k) {
            // Folded into the first quarter, so that mirrored directions have the same bits.
            const int half = k % (Count / 2), quarter = std::min(half, Count / 2 - 1 - half);
            const double w = 2 * std::numbers::pi * (quarter + 0.5) / Count;
            cos2[k] = std::cos(w) * std::cos(w);
            sin2[k] = std::sin(w) * std::sin(w);
        }
    }
    double radius(const Ellipse& e, int k) const { return std::sqrt(e.l * e.l * cos2[k] + e.s * e.s * sin2[k]); }
};

template <int Count>
const Directions<Count>& directions() {
    static const Directions<Count> d;
    return d;
}

bool round_profile(const Ellipse& e) {
    return std::abs(e.l - e.s) <= 1e-12 * e.l;
}

}  // namespace

double pressed_axis(double s, double z, double least) {
    return std::min(s, std::max(z, least));
}

double point_stress(double ratio, const StressLaw& law) {
    const double q = 1 - ratio, pole = std::atan(law.most);
    return std::tan(q <= 0 ? std::max(law.compressed * q, -pole) : std::min(law.stretched * q, pole));
}

double mean_stress(const Ellipse& u, const Ellipse& d, int turn, const StressLaw& law) {
    double sum = 0;
    if (turn == 0) {
        // All quarters are alike.
        for (int k = 0; k < kRays / 4; ++k)
            sum += point_stress(directions<kRays>().radius(u, k) / directions<kRays>().radius(d, k), law);
        return sum / (kRays / 4);
    }
    constexpr int kShift = kMeanRays / 2 / kTurns;
    // Both halves are alike.
    for (int k = 0; k < kMeanRays / 2; ++k) {
        const double undeformed = directions<kMeanRays>().radius(u, (k + kShift * turn) % kMeanRays);
        sum += point_stress(undeformed / directions<kMeanRays>().radius(d, k), law);
    }
    return sum / (kMeanRays / 2);
}

TurnedStress least_stress(const Ellipse& u, const Ellipse& d, const StressLaw& law) {
    TurnedStress best{0, mean_stress(u, d, 0, law)};
    for (int turn = 1; turn <= kTurns / 2 && !round_profile(u); ++turn) {
        const double stress = mean_stress(u, d, turn, law);
        if (std::abs(stress) < std::abs(best.stress)) best = {turn, stress};
    }
    return best;
}

double distensibility(double stress, const StressLaw& law) {
    return 0.5 - std::atan(law.sensitivity * stress) / std::numbers::pi;
}

double recovery_extent(double stress, const RecoveryLaw& law) {
    return std::clamp((law.rigid - stress) / (law.rigid - law.elastic), 0.0, 1.0);
}

double recovery_extent(double stress, const RecoveryLaw& law, double dt) {
    if (!(dt > 0)) return 0;
    return 1 - std::pow(1 - recovery_extent(stress, law), dt / law.time);
}

double StressGroup::share() const {
    return static_cast<double>(std::count(rays.begin(), rays.end(), true)) / kRays;
}

std::vector<StressGroup> stress_groups(const Ellipse& u, const Ellipse& d, double threshold, double least_share,
                                       const StressLaw& law) {
    std::array<double, kRays> stress{};
    for (int k = 0; k < kRays; ++k)
        stress[k] = point_stress(directions<kRays>().radius(u, k) / directions<kRays>().radius(d, k), law);
    const auto above = [&](int k) { return stress[(k + kRays) % kRays] > threshold; };
    std::vector<StressGroup> groups;
    for (int first = 0; first < kRays; ++first) {
        if (!above(first) || above(first - 1)) continue;
        StressGroup group;
        int count = 0;
        for (; count < kRays && above(first + count); ++count) {
            group.rays[(first + count) % kRays] = true;
            group.stress += stress[(first + count) % kRays];
        }
        group.stress /= count;
        if (group.share() >= least_share) groups.push_back(group);
    }
    return groups;
}

GroupEllipse group_ellipse(const Rays& rays, const Ellipse& p) {
    GroupEllipse out;
    // Integrals over each ray's sector of the unit disc, exact: ∫ν² dν = 1/3, ∫ν³ dν = 1/4, area ½ kRay.
    double count = 0, xx = 0, yy = 0, xy = 0;
    for (int k = 0; k < kRays; ++k) {
        if (!rays[k]) continue;
        const double w = ray_angle(k), spread = 0.5 * std::sin(kRay) / kRay;
        count += 1;
        out.centre += (2.0 / 3) * (2 * std::sin(0.5 * kRay) / kRay) * Vec2{p.l * std::cos(w), p.s * std::sin(w)};
        xx += 0.5 * p.l * p.l * (0.5 + spread * std::cos(2 * w));
        yy += 0.5 * p.s * p.s * (0.5 - spread * std::cos(2 * w));
        xy += 0.5 * p.l * p.s * spread * std::sin(2 * w);
    }
    if (count == 0) return out;
    out.centre /= count;
    xx = xx / count - out.centre.x * out.centre.x;
    yy = yy / count - out.centre.y * out.centre.y;
    xy = xy / count - out.centre.x * out.centre.y;
    if (std::abs(xy) > 1e-12 * (xx + yy)) out.turn = 0.5 * std::atan2(2 * xy, xx - yy);
    if (std::abs(out.turn) > 0.25 * std::numbers::pi) out.turn -= std::copysign(0.5 * std::numbers::pi, out.turn);
    const Vec2 l{std::cos(out.turn), std::sin(out.turn)}, s{-l.y, l.x};
    Vec2 lo{0}, hi{0};  // of the bounding box; all sectors meet in the middle
    for (int k = 0; k < kRays; ++k) {
        if (!rays[k]) continue;
        for (const double w : {kRay * k, kRay * (k + 1)}) {
            const Vec2 x{p.l * std::cos(w), p.s * std::sin(w)}, along{glm::dot(x, l), glm::dot(x, s)};
            lo = glm::min(lo, along);
            hi = glm::max(hi, along);
        }
    }
    out.share = count / kRays;
    const double ratio = (hi.x - lo.x) / (hi.y - lo.y);
    out.axes.l = std::sqrt(p.l * p.s * out.share * ratio);
    out.axes.s = out.axes.l / ratio;
    return out;
}

}  // namespace tuft::brush::macro
