#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/ease.h"
#include "footprint/outline/cuts.h"
#include "footprint/outline/outline_parts.h"

// Hair that stands: strips of a row on its edge, and the ends of a tuft that is pressed straight down.
namespace tuft::footprint {
namespace {

// Cosine from the normal of the surface to a broad axis from which on a strip begins to stand on its edge, and from
// which on it does.
constexpr double kBeginsEdge = 0.6, kIsEdge = 0.8;
constexpr double kLeastPart = 0.25;  // of its half width, that a strip is narrowed to

/// Half axes of a section's hair, metres.
struct HairAxes {
    Vec3 broad, thick;

    explicit HairAxes(const brush::Section& s)
        : broad(s.turn.x * s.a * s.e + s.turn.y * s.b * s.m), thick(s.turn.x * s.b * s.m - s.turn.y * s.a * s.e) {}

    /// Gives a section the ellipse of these axes, whose own differ least from what they were.
    void set(brush::Section& s) const {
        const auto [e, m, turn] = ellipse_of(broad, thick, s.turn);
        const double a = glm::length(e), b = glm::length(m);
        if (!(std::min(a, b) > 1e-9)) return;
        s.a = a;
        s.b = b;
        s.e = e / a;
        s.m = m / b;
        s.turn = turn;
    }
};

}  // namespace

Recycled<brush::Branch> bound_on_edge(const brush::TuftState& tuft, const Frame& frame,
                                      std::span<const NodePlanes> planes) {
    Recycled<brush::Branch> out(tuft.branches.begin(), tuft.branches.end());
    for (std::size_t k = 0; k < out.size(); ++k) {
        const Recycled<brush::Section>& own = tuft.branches[k].sections;
        for (std::size_t i = 0; i < own.size(); ++i) {
            const bool plane = k < planes.size() && i < planes[k].size();
            const Vec3 normal = plane ? planes[k][i].normal : frame.n;
            HairAxes axes(own[i]);
            const double half = glm::length(axes.broad);
            if (!(half > 1e-9)) continue;
            const Vec3 broad = axes.broad / half;
            const double on_edge =
                smooth_step((std::abs(glm::dot(broad, normal)) - kBeginsEdge) / (kIsEdge - kBeginsEdge));
            if (on_edge <= 0) continue;
            double up = half, down = half;  // along the broad axis and against it
            for (const brush::Opening& pair : tuft.openings) {
                if (pair.first != static_cast<int>(k) && pair.second != static_cast<int>(k)) continue;
                const Recycled<brush::Section>& beside =
                    tuft.branches[pair.first == static_cast<int>(k) ? pair.second : pair.first].sections;
                const std::size_t from_root = own.size() - i;
                if (from_root > beside.size()) continue;
                const Vec3 to = beside[beside.size() - from_root].centre - own[i].centre;
                double& side = glm::dot(to, broad) > 0 ? up : down;
                // At the height that is midway, where the hair between both spines is.
                const double midway =
                    0.5 * std::abs(glm::dot(to, normal) / glm::dot(broad, normal)) / Trail::kStripChord;
                side = std::min(side, std::lerp(half, std::clamp(midway, kLeastPart * half, half), on_edge));
            }
            if (up + down >= 2 * half) continue;
            brush::Section& s = out[k].sections[i];
            const double part = 0.5 * (up + down) / half;
            s.centre += 0.5 * Trail::kStripChord * (up - down) * broad;
            axes.broad *= part;
            axes.set(s);
        }
    }
    return out;
}

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
