#include <algorithm>
#include <cmath>
#include <numbers>

#include "footprint/outline/cuts.h"

namespace tuft::footprint {
namespace {

constexpr double kPressed = 1.25;        // radii of standing hair that it covers when its ends are pressed down
constexpr int kTowards = 8, kRound = 6;  // cuts from the tuft to its foot, and round that

/// Half of the width of what of a section that stands across the surface lies under it.
double half_width(const Cut& cut) {
    const double height = cut.half_height();
    if (cut.z <= 0) return cut.a;
    return cut.z < height ? cut.a * std::sqrt(1 - cut.z * cut.z / (height * height)) : 0;
}

}  // namespace

void cover_upright_hair(Recycled<Trail>& trails, const brush::UprightHair& foot, const Frame& frame, double film) {
    if (trails.empty() || !(foot.share > 0)) return;
    Trail& trail = trails.back();
    Recycled<Cut>& cuts = trail.cuts;
    if (cuts.size() < 2 || trail.trunk < cuts.size()) return;
    std::size_t widest = 0;
    double half = 0;
    for (std::size_t i = 0; i < cuts.size(); ++i) {
        const double h = half_width(cuts[i]);
        if (h > half) {
            half = h;
            widest = i;
        }
    }
    const Vec2 tail = cuts.back().centre, from = cuts[widest].centre;
    const Vec2 to = tail + foot.share * (Vec2(frame.to_local(foot.centre)) - tail);
    if (glm::dot(to - tail, tail - cuts.front().centre) <= 0) return;  // the tuft lies over it
    const double length = glm::length(to - from), end = foot.share * (kPressed * foot.radius + std::max(film, 0.0));
    if (!(length > 1e-7)) return;
    const Vec2 ahead = (to - from) / length;
    const auto width_at = [&](const Vec2& p) {
        return std::lerp(half, end, std::clamp(glm::dot(p - from, ahead) / length, 0.0, 1.0));
    };
    for (std::size_t i = widest + 1; i < cuts.size(); ++i) {
        const double need = width_at(cuts[i].centre);
        if (half_width(cuts[i]) >= need) continue;
        cuts[i].a = need;
        cuts[i].z = 0;
    }
    // Hair that lies on the surface, across the path.
    Cut cut = cuts.back();
    const double turn = glm::dot(Vec2(cut.e), Vec2{-ahead.y, ahead.x}) < 0 ? -1 : 1;
    cut.e = turn * Vec3{-ahead.y, ahead.x, 0};
    cut.m = {0, 0, cut.m.z < 0 ? -1 : 1};
    cut.z = 0;
    const auto add = [&](const Vec2& centre, double a) {
        cut.centre = centre;
        cut.a = a;
        cuts.push_back(cut);
        trail.along.push_back(trail.along.back());
    };
    for (int i = 1; i <= kTowards; ++i) {
        const Vec2 p = glm::mix(tail, to, double(i) / kTowards);
        add(p, width_at(p));
    }
    for (int i = 1; i <= kRound; ++i) {
        const double w = 0.5 * std::numbers::pi * i / kRound;
        add(to + end * std::sin(w) * ahead, std::max(end * std::cos(w), 1e-6));
    }
    trail.trunk = cuts.size();
}

}  // namespace tuft::footprint
