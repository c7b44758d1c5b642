#include "footprint/outline/outline.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include "footprint/outline/cuts.h"
#include "footprint/outline/outline_parts.h"

namespace tuft::footprint {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kDirections = 24;  // points of a whole section's shadow
constexpr int kBentPieces = 6;   // of each broad side of a strip that bends

/// Cosines and sines of evenly spaced directions.
struct Directions {
    std::array<double, kDirections> cos, sin;
};

const Directions& directions() {
    static const auto table = [] {
        Directions t;
        for (int k = 0; k < kDirections; ++k) {
            t.cos[k] = std::cos(2 * kPi * k / kDirections);
            t.sin[k] = std::sin(2 * kPi * k / kDirections);
        }
        return t;
    }();
    return table;
}

/// A bit for each direction.
using DirectionSet = std::uint32_t;
constexpr DirectionSet kAllDirections = (DirectionSet{1} << kDirections) - 1;

/// The directions whose component along (cos, sin) is below `level`.
DirectionSet directions_below(const Directions& of, double cos, double sin, double level) {
    std::array<double, kDirections> along;
    for (int k = 0; k < kDirections; ++k) along[k] = of.cos[k] * cos + of.sin[k] * sin;
    DirectionSet set = 0;
    for (int k = 0; k < kDirections; ++k) set |= static_cast<DirectionSet>(along[k] < level) << k;
    return set;
}

/// Adds the corners of the shadow of the part of a section that lies below the surface, in order:
/// first and last are its cut points Q±, unless all of it lies below.
void add_shadow(const Cut& of, Recycled<Vec2>& corners) {
    const Cut cut = of;  // which no corner overwrites
    const Directions& table = directions();
    const double p = cut.a * cut.e.z, q = cut.b * cut.m.z, height = std::sqrt(p * p + q * q);
    const double level = height > 0 ? std::clamp(-cut.z / height, -1.0, 1.0) : (cut.z <= 0 ? 1 : -1);
    const double cos_f = height > 0 ? p / height : 1, sin_f = height > 0 ? q / height : 0;
    const double sin_l = std::sqrt(std::max(0.0, 1 - level * level));
    // Q± at φ ± acos(level); below the surface is what lies between them on the far side.
    const Vec2 from{cos_f * level - sin_f * sin_l, sin_f * level + cos_f * sin_l};
    const Vec2 to{cos_f * level + sin_f * sin_l, sin_f * level - cos_f * sin_l};
    if (level < 1) corners.push_back(cut.at(from.x, from.y));
    const DirectionSet below = level >= 1 ? kAllDirections : directions_below(table, cos_f, sin_f, level);
    // They are taken in order from Q+ on: from where those below the surface begin.
    const DirectionSet begins = below & ~(below << 1 | below >> (kDirections - 1));
    int at = 0;
    if (begins != 0)
        at = std::countr_zero(begins);
    else if (below != 0)
        at = (static_cast<int>(std::ceil(std::atan2(from.y, from.x) * kDirections / (2 * kPi))) + kDirections) %
             kDirections;
    for (int k = 0; k < kDirections && below != 0; ++k) {
        if (below >> at & 1) corners.push_back(cut.at(table.cos[at], table.sin[at]));
        at = at + 1 < kDirections ? at + 1 : 0;
    }
    if (level < 1) corners.push_back(cut.at(to.x, to.y));
}

/// A place in a strip's section, and where it lies between the strip's edges, see Cut::bent.
struct StripPlace {
    Vec2 at{0};
    double s = 0, bow = 0;
};

StripPlace strip_place(const Vec2& at) {
    const double s = std::clamp(at.x / Cut::kStripChord, -1.0, 1.0);
    return {at, s, 1 - s * s};
}

/// Corners of a strip in order; with `pieces` > 1 its broad sides in as many pieces.
Recycled<StripPlace> strip_places(std::span<const Vec2> strip, int pieces) {
    Recycled<StripPlace> places;
    places.reserve(strip.size() + 2 * static_cast<std::size_t>(pieces));
    for (std::size_t k = 0; k < strip.size(); ++k) {
        const Vec2 &c = strip[k], &next = strip[k + 1 < strip.size() ? k + 1 : 0];
        const int n = std::abs(next.x - c.x) > 0.5 * Trail::kStripChord ? pieces : 1;
        places.push_back(strip_place(c));
        for (int i = 1; i < n; ++i) places.push_back(strip_place(glm::mix(c, next, double(i) / n)));
    }
    return places;
}

/// Corners of the part of a strip that touches, see Cut::reach.
Recycled<Vec2> touching_part(std::span<const Vec2> strip, const Vec2& reach) {
    Recycled<Vec2> part;
    part.reserve(strip.size());
    for (const Vec2& c : strip) {
        const double x = c.x * (c.x < 0 ? reach.x : reach.y);
        part.push_back({std::max(std::min(x, reach.y * Cut::kStripChord), -reach.x * Cut::kStripChord), c.y});
    }
    return part;
}

/// The same of a strip: its corners at the scale at which it meets the surface when the ellipse does, cut by it.
/// `places`: of the part of `strip` that touches, in pieces where the cut is bent.
void add_strip_shadow(const Cut& cut, std::span<const Vec2> strip, std::span<const StripPlace> places,
                      Recycled<Vec2>& corners) {
    const Vec3 broad = cut.broad(), thick = cut.thick();
    double reach = 0;
    for (const Vec2& c : strip) reach = std::max(reach, -(c.x * broad.z + c.y * thick.z));
    const double half = cut.half_height(), z = half > 0 ? cut.z * reach / half : cut.z;
    const bool bent = cut.is_bent(), drops = cut.drop != Vec2{0}, ahead = cut.has_ahead();
    const Vec2 across(broad), through(thick), centre = cut.centre, slant = cut.slant, bow = cut.bow;
    const auto height = [&](const StripPlace& p) { return z + p.at.x * broad.z + p.at.y * thick.z; };
    const auto point = [&](const StripPlace& p) {
        Vec2 middle = bent ? centre + (p.s * slant + p.bow * bow) : centre;
        if (drops) middle += Cut::drop_part(p.s * cut.free_side) * cut.drop;
        if (ahead) middle += cut.ahead(p.at.x);
        return middle + p.at.x * across + p.at.y * through;
    };
    const std::size_t before = corners.size(), n = places.size();
    corners.resize(before + 2 * n);  // as many as there can be
    Vec2* to = corners.data() + before;
    const double first = height(places[0]);
    double p = first;
    for (std::size_t k = 0; k < n; ++k) {
        const StripPlace& next = places[k + 1 < n ? k + 1 : 0];
        const double q = k + 1 < n ? height(next) : first;
        if (p <= 0) *to++ = point(places[k]);
        if ((p <= 0) != (q <= 0)) *to++ = glm::mix(point(places[k]), point(next), p / (p - q));
        p = q;
    }
    if (to == corners.data() + before) *to++ = centre;  // it only just touches
    corners.resize(static_cast<std::size_t>(to - corners.data()));
}

/// Solves (c[k-1] + 4 c[k] + c[k+1]) / 6 = p[k], cyclic, by elimination with one bordering
/// unknown (the last).
Recycled<Vec2> spline_control(const Recycled<Vec2>& p) {
    const int n = static_cast<int>(p.size());
    if (n < 3) return p;
    // Rows 0 … n−2 with c[n−1] moved to the right: c = y − c[n−1] w.
    Recycled<double> diagonal(n - 1, 4), w(n - 1, 0);
    Recycled<Vec2> y(p.begin(), p.end() - 1);
    for (Vec2& v : y) v *= 6;
    w[0] += 1;
    w[n - 2] += 1;
    for (int k = 1; k < n - 1; ++k) {
        const double f = 1 / diagonal[k - 1];
        diagonal[k] -= f;
        w[k] -= f * w[k - 1];
        y[k] -= f * y[k - 1];
    }
    for (int k = n - 2; k >= 0; --k) {
        if (k < n - 2) {
            w[k] -= w[k + 1];
            y[k] -= y[k + 1];
        }
        w[k] /= diagonal[k];
        y[k] /= diagonal[k];
    }
    Recycled<Vec2> c(n);
    c[n - 1] = (6.0 * p[n - 1] - y[0] - y[n - 2]) / (4 - w[0] - w[n - 2]);
    for (int k = 0; k < n - 1; ++k) c[k] = y[k] - w[k] * c[n - 1];
    return c;
}

}  // namespace

Recycled<NodePlanes> node_planes(const brush::TuftState& tuft, std::span<const brush::ContactPlane> planes) {
    const auto& branches = tuft.branches;
    if (planes.size() == 1) {
        Recycled<NodePlanes> same;
        same.reserve(branches.size());
        for (const brush::Branch& b : branches) same.emplace_back(b.sections.size(), planes[0]);
        return same;
    }
    if (branches.size() == 1 && planes.size() >= branches[0].sections.size())
        return {NodePlanes(planes.begin(), planes.begin() + branches[0].sections.size())};
    if (branches.size() < 2) return {};
    if (tuft.wide) {
        Recycled<NodePlanes> own;
        std::size_t first = 0;
        for (const brush::Branch& b : branches) {
            if (planes.size() < first + b.sections.size()) return {};
            const auto part = planes.subspan(first, b.sections.size());
            own.emplace_back(part.begin(), part.end());
            first += b.sections.size();
        }
        return own;
    }
    // The middle branch ends in the whole spine's root; its outer nodes are the sub_spine's.
    const std::size_t trunk = branches[branches.size() / 2].sections.size();
    const std::size_t sub_spine = branches[0].sections.size();
    if (trunk < sub_spine || planes.size() != trunk + branches.size() * sub_spine) return {};
    Recycled<NodePlanes> dealt;
    for (std::size_t k = 0; k < branches.size(); ++k) {
        const auto own = planes.subspan(trunk + k * sub_spine, sub_spine);
        dealt.emplace_back(own.begin(), own.end());
        if (k != branches.size() / 2) continue;
        dealt.back().pop_back();
        dealt.back().insert(dealt.back().end(), planes.begin() + sub_spine - 1, planes.begin() + trunk);
    }
    return dealt;
}

Vec2 unit_or(const Vec2& v, const Vec2& other) {
    const double length = glm::length(v);
    return length > 1e-12 ? v / length : other;
}

std::span<const Vec2> strip_of(const Trail& trail) {
    constexpr double k = Trail::kStripChord;
    static constexpr Vec2 kRectangle[4] = {{k, k}, {-k, k}, {-k, -k}, {k, -k}};
    if (!trail.strip) return {};
    return trail.corners.empty() ? std::span<const Vec2>(kRectangle) : std::span<const Vec2>(trail.corners);
}

Vec2 forward_direction(const Recycled<Cut>& cuts) {
    const Vec2 run = cuts.front().centre - cuts.back().centre;
    Vec2 side{0};
    double width = 0;
    for (const Cut& c : cuts) {
        side += Vec2(c.e);
        width += c.a / double(cuts.size());
    }
    Vec2 across = unit_or({side.y, -side.x}, {0, 0});
    if (glm::dot(across, run) < 0) across = -across;
    return unit_or(run + 0.25 * width * across, {1, 0});
}

void Loops::add(std::span<const Cut> cuts, std::span<const Vec2> strip) {
    corners.reserve(corners.size() + cuts.size() * (strip.empty() ? kDirections + 2 : strip.size() + 2 * kBentPieces));
    first.reserve(first.size() + cuts.size());
    Recycled<StripPlace> straight, in_pieces, bounded;
    for (const Cut& cut : cuts) {
        if (strip.empty()) {
            add_shadow(cut, corners);
        } else {
            const int pieces = cut.is_bent() ? kBentPieces : 1;
            Recycled<StripPlace>& places = cut.reach != Vec2(1) ? bounded : cut.is_bent() ? in_pieces : straight;
            if (&places == &bounded)
                bounded = strip_places(touching_part(strip, cut.reach), pieces);
            else if (places.empty())
                places = strip_places(strip, pieces);
            add_strip_shadow(cut, strip, places, corners);
        }
        first.push_back(corners.size());
    }
}

void Loops::find_extents() {
    extent.reserve(size());
    for (std::size_t k = extent.size(); k < size(); ++k) {
        const std::span<const Vec2> s = (*this)[k];
        Vec2 least = s[0], most = s[0];
        for (const Vec2& p : s) least = glm::min(least, p), most = glm::max(most, p);
        std::size_t low = 0, high = s.size() - 1;  // the first of the lowest, the last of the highest
        while (low + 1 < s.size() && s[low].y != least.y) ++low;
        while (high > 0 && s[high].y != most.y) --high;
        extent.push_back({s[low], s[high], least.x, most.x});
    }
}

void add_loops(const Loops& loops, std::size_t begin, std::size_t end, Envelope& envelope) {
    for (std::size_t k = begin; k < end; ++k) {
        const std::span<const Vec2> s = loops[k];
        const LoopExtent& extent = loops.extent[k];
        if (envelope.meets(extent.rear, extent.front)) {
            for (std::size_t i = 0; i + 1 < s.size(); ++i) envelope.add(s[i], s[i + 1]);
            envelope.add(s.back(), s.front());
        }
        if (k == begin) continue;
        envelope.add(loops.extent[k - 1].low, extent.low);
        envelope.add(loops.extent[k - 1].high, extent.high);
    }
}

Outline closed_outline(const Envelope& envelope, const PatchFrame& patch, const Ends& ends, int points, bool edges) {
    Outline outline;
    outline.tip = patch.to_stamp(ends.front);
    outline.tail = patch.to_stamp(ends.rear);
    outline.left.reserve(points);
    outline.right.reserve(points);
    for (int j = points - 1; j >= 0; --j) {
        if (!envelope.covered(j)) continue;
        outline.left.push_back(patch.to_stamp(envelope.top(j)));
        outline.right.push_back(patch.to_stamp(envelope.bottom(j)));
    }
    Recycled<Vec2> closed;
    closed.reserve(2 * outline.left.size() + 2);
    closed.push_back(outline.tip);
    closed.insert(closed.end(), outline.left.begin(), outline.left.end());
    closed.push_back(outline.tail);
    closed.insert(closed.end(), outline.right.rbegin(), outline.right.rend());
    outline.control = edges ? closed : spline_control(closed);
    return outline;
}

Outline outline_of(const Trail& trail, int points) {
    const Recycled<Cut>& cuts = trail.cuts;
    points = std::max(points, 4);
    const PatchFrame patch{cuts[cuts.size() / 2].centre, forward_direction(cuts)};
    Loops loops;
    loops.add(cuts, strip_of(trail));
    patch.to_patch(loops.corners);
    loops.find_extents();
    Vec2 front{-1e9, 0}, rear{1e9, 0};
    for (const Vec2& q : loops.corners) {
        if (q.x > front.x) front = q;
        if (q.x < rear.x) rear = q;
    }
    Envelope envelope(rear.x, front.x, points);
    add_loops(loops, 0, loops.size(), envelope);
    return closed_outline(envelope, patch, {front, rear}, points, trail.strip);
}

Recycled<Outline> outlines_of(const brush::TuftState& tuft, const Frame& frame, std::span<const NodePlanes> planes,
                              const OutlineOptions& options) {
    Recycled<Trail> trails = find_trails(tuft, frame, planes, 1, options.film);
    fill_rows(trails);
    return outlines_of(trails, options.points);
}

Recycled<Vec2> curve_points(const Outline& outline, int per_span) {
    const std::size_t n = outline.control.size();
    Recycled<Vec2> points;
    if (n < 3) return points;
    points.reserve(n * static_cast<std::size_t>(per_span));
    // As CurveSpan::at, with the weights of each place computed once.
    Recycled<std::array<double, 4>> weights;
    for (int i = 0; i < per_span; ++i) {
        const double f = double(i) / per_span, g = 1 - f;
        weights.push_back({g * g * g, 3 * f * f * f - 6 * f * f + 4, 3 * g * g * g - 6 * g * g + 4, f * f * f});
    }
    for (std::size_t k = 0; k < n; ++k) {
        const CurveSpan span(outline, k);
        for (const auto& [w0, w1, w2, w3] : weights)
            points.push_back((w0 * span.c0 + w1 * span.c1 + w2 * span.c2 + w3 * span.c3) / 6.0);
    }
    return points;
}

}  // namespace tuft::footprint
