#include "brush/tuft/ferrule.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "brush/tuft/tuft.h"

namespace tuft::brush {

namespace {

constexpr int kSlices = 4096;  ///< of the mouth, for areas: error 1e-6 for q ≥ 2

/// Length of the hair at s = x/a over the tuft's.
double length_at(const Preset& p, double s) {
    const double toe = p.toe * (1 - std::sqrt(std::max(0.0, 1 - s * s)));
    const double slant = 0.5 * p.slant * (1 - s);
    return 1 - (toe + slant) / p.length;
}

}  // namespace

double mouth_height(const Preset& p, double s) {
    return std::pow(std::max(0.0, 1 - std::pow(std::abs(s), p.corner)), 1 / p.corner);
}

std::vector<Vec2> mouth_outline(const Preset& p) {
    constexpr int kPoints = 64;  // a point at each end of both axes
    std::vector<Vec2> out;
    if (p.spines <= 1) return out;
    const auto power = [&](double x) { return std::copysign(std::pow(std::abs(x), 2 / p.corner), x); };
    for (int i = 0; i < kPoints; ++i) {
        const double t = 2 * std::numbers::pi * i / kPoints;
        out.push_back({0.5 * p.width * power(std::cos(t)), p.radius * power(std::sin(t))});
    }
    return out;
}

std::vector<FerruleSpine> ferrule_spines(const Preset& p) {
    if (p.spines <= 1) return {FerruleSpine{.pitch = 2 * p.radius, .thick = 2 * p.radius}};
    const double a = 0.5 * p.width;
    const auto height = [&](int i) { return mouth_height(p, 2 * (i + 0.5) / kSlices - 1); };
    double area = 0;
    for (int i = 0; i < kSlices; ++i) area += height(i);
    std::vector<FerruleSpine> out(p.spines);
    double below = 0;
    int slice = 0;
    for (int k = 0; k < p.spines; ++k) {
        FerruleSpine& spine = out[k];
        spine.from = k > 0 ? out[k - 1].to : -1;
        double own = 0, moment = 0;
        const double wanted = area * (k + 1) / p.spines;
        for (; slice < kSlices && (below < wanted || k + 1 == p.spines); ++slice) {
            const double h = height(slice);
            below += h;
            own += h;
            moment += h * (2 * (slice + 0.5) / kSlices - 1);
        }
        spine.to = k + 1 == p.spines ? 1 : 2.0 * slice / kSlices - 1;
        const double s = moment / own;
        spine.x = a * s;
        spine.share = own / area;
        spine.lean = p.splay * s;
        spine.length = length_at(p, s);
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
        if (p.slant == 0) r.length = l.length;
        if (k == p.spines - 1 - k) l.x = l.lean = 0;
    }
    return out;
}

double widening(const Preset& p, double along) {
    return p.width > 0 ? 1 + along * std::sin(p.splay) / (0.5 * p.width) : 1;
}

Vec2 rest_half_widths(const Preset& p, const FerruleSpine& spine, double u) {
    const double wide = widening(p, u * p.length), root_pi = std::sqrt(std::numbers::pi);
    const double taper = rest_radius(p, std::min(1.0, u / spine.length)) / p.radius;
    return {spine.pitch * wide / root_pi, spine.thick / wide * taper / root_pi};
}

}  // namespace tuft::brush
