#include "brush/tuft/ferrule.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "brush/tuft/tuft.h"

namespace tuft::brush {

namespace {

constexpr int kSlices = 4096;  ///< of the mouth, for areas: error 1e-6 for q ≥ 2

/// Length of the hair at s = x/a over the tuft's. `outermost`: s of the last spine.
double length_at(const Preset& p, double s, double outermost) {
    const double toe = p.toe * (1 - std::sqrt(std::max(0.0, 1 - s * s)));
    const double slant = 0.5 * p.slant * (1 - s / outermost);
    return 1 - (toe + slant) / p.length;
}

constexpr double kRootPi = 1.7724538509055160;

/// Radius of the middle disc of a ring over R.
double middle_of_ring(const Preset& p) {
    return 1 / std::sqrt(static_cast<double>(p.spines));
}

/// Distance of the outer spines of a ring from the middle over R: centroid of a sector.
double ring_radius(const Preset& p) {
    const double inner = middle_of_ring(p), half = std::numbers::pi / (p.spines - 1);
    return 2.0 / 3 * std::sin(half) / half * (1 - inner * inner * inner) / (1 - inner * inner);
}

/// Spine k of a ring: 0 in the middle, the others from +x on anticlockwise.
FerruleSpine ring_spine(const Preset& p, int k) {
    const double inner = middle_of_ring(p);
    FerruleSpine out;
    out.share = 1.0 / p.spines;
    out.pitch = out.thick = kRootPi * inner * p.radius;
    if (k > 0) {
        const double s = ring_radius(p);
        const double turn = 2 * std::numbers::pi * (k - 1) / (p.spines - 1);
        out.x = p.radius * s * std::cos(turn);
        out.y = p.radius * s * std::sin(turn);
        out.length = 1 - p.toe * (1 - std::sqrt(1 - s * s)) / p.length;
    }
    return out;
}

}  // namespace

double mouth_height(const Preset& p, double s) {
    return std::pow(std::max(0.0, 1 - std::pow(std::abs(s), p.corner)), 1 / p.corner);
}

std::vector<Vec2> mouth_outline(const Preset& p) {
    constexpr int kPoints = 64;  // a point at each end of both axes
    std::vector<Vec2> out;
    if (!has_broad_side(p)) return out;
    const auto power = [&](double x) { return std::copysign(std::pow(std::abs(x), 2 / p.corner), x); };
    for (int i = 0; i < kPoints; ++i) {
        const double t = 2 * std::numbers::pi * i / kPoints;
        out.push_back({0.5 * p.width * power(std::cos(t)), p.radius * power(std::sin(t))});
    }
    return out;
}

std::vector<FerruleSpine> ferrule_spines(const Preset& p) {
    if (p.spines <= 1) return {FerruleSpine{.pitch = 2 * p.radius, .thick = 2 * p.radius}};
    if (!has_broad_side(p)) {
        std::vector<FerruleSpine> ring;
        for (int k = 0; k < p.spines; ++k) ring.push_back(ring_spine(p, k));
        return ring;
    }
    const double a = 0.5 * p.width;
    std::array<double, kSlices> heights;  // left as right
    for (int i = 0; 2 * i < kSlices; ++i)
        heights[i] = heights[kSlices - 1 - i] = mouth_height(p, 2 * (i + 0.5) / kSlices - 1);
    double area = 0;
    for (const double height : heights) area += height;
    std::vector<FerruleSpine> out(p.spines);
    double below = 0;
    int slice = 0;
    for (int k = 0; k < p.spines; ++k) {
        FerruleSpine& spine = out[k];
        spine.from = k > 0 ? out[k - 1].to : -1;
        double own = 0, moment = 0;
        const double wanted = area * (k + 1) / p.spines;
        for (; slice < kSlices && (below < wanted || k + 1 == p.spines); ++slice) {
            const double h = heights[slice];
            below += h;
            own += h;
            moment += h * (2 * (slice + 0.5) / kSlices - 1);
        }
        spine.to = k + 1 == p.spines ? 1 : 2.0 * slice / kSlices - 1;
        const double s = moment / own;
        spine.x = a * s;
        spine.share = own / area;
        spine.lean = p.splay * s;
        spine.pitch = a * (spine.to - spine.from);
        spine.thick = 2 * p.radius * own * (2.0 / kSlices) / (spine.to - spine.from);
    }
    // A mouth that is its own mirror image has spines that are, to the bit.
    for (int k = 0; 2 * k < p.spines; ++k) {
        FerruleSpine &l = out[k], &r = out[p.spines - 1 - k];
        r.x = -l.x;
        r.lean = -l.lean;
        r.share = l.share;
        r.pitch = l.pitch;
        r.thick = l.thick;
        r.to = -l.from;
        r.from = -l.to;
        if (k == p.spines - 1 - k) l.x = l.lean = 0;
    }
    for (FerruleSpine& spine : out) spine.length = length_at(p, spine.x / a, out.back().x / a);
    if (p.toe > 0)
        for (FerruleSpine* outermost : {&out.front(), &out.back()}) {
            const double s = outermost->x / a;
            outermost->edge_short = p.toe * std::sqrt(std::max(0.0, 1 - s * s));
        }
    return out;
}

HairLengths::HairLengths(const Preset& p) : preset_(p) {
    if (p.slant > 0) outermost_ = 2 * ferrule_spines(p).back().x / p.width;
}

double HairLengths::at(double s) const {
    return std::min(1.0, length_at(preset_, s, outermost_));
}

FerruleSpine single_spine(const Preset& p) {
    double area = 0;
    for (const FerruleSpine& spine : ferrule_spines(p)) area += spine.pitch * spine.thick;
    return {.pitch = p.width, .thick = area / p.width};
}

Recycled<Vec2> strip_corners(const Preset& p, const FerruleSpine& spine) {
    constexpr double kEven = 0.01;  // of the thickness, change over a strip that is none
    constexpr int kCuts = 6;
    Recycled<Vec2> upper;
    if (!has_broad_side(p)) return upper;
    const Vec2 unit{spine.pitch / kRootPi, spine.thick / kRootPi};
    const auto add = [&](double s, double h) {
        upper.push_back(Vec2{0.5 * p.width * s - spine.x, p.radius * h} / unit);
    };
    const double from = mouth_height(p, spine.from), to = mouth_height(p, spine.to);
    const bool middle = spine.from < 0 && spine.to > 0;
    if (std::max({from, to, middle ? 1.0 : 0.0}) - std::min(from, to) < kEven) {
        add(spine.to, to);
        add(spine.from, from);
    } else {
        // Evenly in the angle of the superellipse, x = cos^{2/q}, y = sin^{2/q}.
        const auto angle = [&](double s) { return std::acos(std::copysign(std::pow(std::abs(s), 0.5 * p.corner), s)); };
        const auto power = [&](double x) { return std::copysign(std::pow(std::abs(x), 2 / p.corner), x); };
        for (int i = 0; i <= kCuts; ++i) {
            const double t = std::lerp(angle(spine.to), angle(spine.from), static_cast<double>(i) / kCuts);
            add(power(std::cos(t)), power(std::sin(t)));
        }
    }
    Recycled<Vec2> out = upper;
    for (auto at = upper.rbegin(); at != upper.rend(); ++at)
        if (at->y > 1e-9) out.push_back({at->x, -at->y});
    return out;
}

std::vector<FerruleNeighbours> ferrule_neighbours(const Preset& p) {
    std::vector<FerruleNeighbours> out;
    if (has_broad_side(p)) {
        for (int k = 0; k + 1 < p.spines; ++k) out.push_back({k, k + 1});
        return out;
    }
    const std::vector<FerruleSpine> spines = ferrule_spines(p);
    const int around = p.spines - 1;
    const double inner = p.radius * middle_of_ring(p);
    const auto add = [&](int first, int second, double face) {
        const Vec2 d{spines[second].x - spines[first].x, spines[second].y - spines[first].y};
        out.push_back({first, second, glm::normalize(d), face});
    };
    for (int k = 1; k <= around && p.spines > 1; ++k) {
        add(0, k, 2 * std::numbers::pi * inner / around);
        add(k, k % around + 1, p.radius - inner);
    }
    return out;
}

double face_over_pitch(const Preset& p) {
    if (has_broad_side(p)) return 2 * p.radius * p.spines / p.width;
    const double inner = middle_of_ring(p), spoke = 2 * std::numbers::pi * inner / (p.spines - 1), rim = 1 - inner;
    return 0.5 * (spoke + rim) / ring_radius(p);
}

double widening(const Preset& p, double along) {
    return p.width > 0 ? 1 + along * std::sin(p.splay) / (0.5 * p.width) : 1;
}

Vec2 rest_half_widths(const Preset& p, const FerruleSpine& spine, double u) {
    const double wide = widening(p, u * p.length), root_pi = std::sqrt(std::numbers::pi);
    const double taper = rest_radius(p, std::min(1.0, u / spine.length)) / p.radius;
    if (!has_broad_side(p)) return taper / root_pi * Vec2{spine.pitch, spine.thick};
    return {spine.pitch * wide / root_pi, spine.thick / wide * taper / root_pi};
}

}  // namespace tuft::brush
