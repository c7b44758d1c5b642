#include "footprint/outline/outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "footprint/outline/cuts.h"

namespace tuft::footprint {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kDirections = 24;  // points of a whole section's shadow

const std::array<Vec2, kDirections>& directions() {
    static const auto table = [] {
        std::array<Vec2, kDirections> t;
        for (int k = 0; k < kDirections; ++k)
            t[k] = {std::cos(2 * kPi * k / kDirections), std::sin(2 * kPi * k / kDirections)};
        return t;
    }();
    return table;
}

/// Adds the corners of the shadow of the part of a section that lies below the surface, in order:
/// first and last are its cut points Q±, unless all of it lies below.
void add_shadow(const Cut& cut, std::vector<Vec2>& corners) {
    const double p = cut.a * cut.e.z, q = cut.b * cut.m.z, height = std::sqrt(p * p + q * q);
    const double level = height > 0 ? std::clamp(-cut.z / height, -1.0, 1.0) : (cut.z <= 0 ? 1 : -1);
    const double cos_f = height > 0 ? p / height : 1, sin_f = height > 0 ? q / height : 0;
    const double sin_l = std::sqrt(std::max(0.0, 1 - level * level));
    // Q± at φ ± acos(level); below the surface is what lies between them on the far side.
    const Vec2 from{cos_f * level - sin_f * sin_l, sin_f * level + cos_f * sin_l};
    const Vec2 to{cos_f * level + sin_f * sin_l, sin_f * level - cos_f * sin_l};
    if (level < 1) corners.push_back(cut.at(from.x, from.y));
    const auto below = [&](int k) {
        const Vec2& w = directions()[k];
        return level >= 1 || w.x * cos_f + w.y * sin_f < level;
    };
    // They are taken in order from Q+ on: from where those below the surface begin.
    int first = 0;
    while (first < kDirections && !(below(first) && !below((first + kDirections - 1) % kDirections))) ++first;
    if (first == kDirections)
        first = static_cast<int>(std::ceil(std::atan2(from.y, from.x) * kDirections / (2 * kPi))) + kDirections;
    for (int k = 0; k < kDirections; ++k) {
        const int at = (first + k) % kDirections;
        if (below(at)) corners.push_back(cut.at(directions()[at].x, directions()[at].y));
    }
    if (level < 1) corners.push_back(cut.at(to.x, to.y));
}

Vec2 unit_or(const Vec2& v, const Vec2& other) {
    const double length = glm::length(v);
    return length > 1e-12 ? v / length : other;
}

/// Direction of the footprint from tail to tip: from end to end of the touching spine; for
/// one that stands, the trace of its bending plane.
Vec2 forward_direction(const std::vector<Cut>& cuts) {
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

/// Upper and lower edge of a region over evenly turned abscissae between its two ends.
class Envelope {
  public:
    Envelope(double lo, double hi, int n) : x_(n), top_(n, -kFar), bottom_(n, kFar) {
        for (int j = 0; j < n; ++j) x_[j] = 0.5 * (lo + hi) - 0.5 * (hi - lo) * std::cos(kPi * (j + 1) / (n + 1));
    }

    void add(Vec2 p, Vec2 q) {
        if (p.x > q.x) std::swap(p, q);
        const int n = static_cast<int>(x_.size());
        while (at_ > 0 && x_[at_ - 1] >= p.x) --at_;
        while (at_ < n && x_[at_] < p.x) ++at_;
        for (int j = at_; j < n && x_[j] <= q.x; ++j) {
            const double f = q.x > p.x ? (x_[j] - p.x) / (q.x - p.x) : 0;
            const double y = p.y + f * (q.y - p.y);
            top_[j] = std::max(top_[j], y);
            bottom_[j] = std::min(bottom_[j], y);
        }
    }

    bool covered(int j) const { return top_[j] >= bottom_[j]; }
    Vec2 top(int j) const { return {x_[j], top_[j]}; }
    Vec2 bottom(int j) const { return {x_[j], bottom_[j]}; }

  private:
    static constexpr double kFar = 1e9;
    std::vector<double> x_, top_, bottom_;
    int at_ = 0;
};

/// Solves (c[k-1] + 4 c[k] + c[k+1]) / 6 = p[k], cyclic, by elimination with one bordering
/// unknown (the last).
std::vector<Vec2> spline_control(const std::vector<Vec2>& p) {
    const int n = static_cast<int>(p.size());
    if (n < 3) return p;
    // Rows 0 … n−2 with c[n−1] moved to the right: c = y − c[n−1] w.
    std::vector<double> diagonal(n - 1, 4), w(n - 1, 0);
    std::vector<Vec2> y(p.begin(), p.end() - 1);
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
    std::vector<Vec2> c(n);
    c[n - 1] = (6.0 * p[n - 1] - y[0] - y[n - 2]) / (4 - w[0] - w[n - 2]);
    for (int k = 0; k < n - 1; ++k) c[k] = y[k] - w[k] * c[n - 1];
    return c;
}

}  // namespace

Outline outline_of(const Trail& trail, int points) {
    const std::vector<Cut>& cuts = trail.cuts;
    const std::size_t n = cuts.size();
    points = std::max(points, 4);
    const Vec2 forward = forward_direction(cuts), left{-forward.y, forward.x};
    const Vec2 middle = cuts[n / 2].centre;
    std::vector<Vec2> corners;
    std::vector<std::size_t> first{0};  // corner of each section, and the end
    corners.reserve(n * (kDirections + 2));
    first.reserve(n + 1);
    for (const Cut& cut : cuts) {
        add_shadow(cut, corners);
        first.push_back(corners.size());
    }
    Vec2 front{-1e9, 0}, rear{1e9, 0};
    for (Vec2& q : corners) {
        q = {glm::dot(q - middle, forward), glm::dot(q - middle, left)};
        if (q.x > front.x) front = q;
        if (q.x < rear.x) rear = q;
    }
    Envelope envelope(rear.x, front.x, points);
    const auto by_y = [](const Vec2& a, const Vec2& b) { return a.y < b.y; };
    Vec2 low_before{0}, high_before{0};
    for (std::size_t k = 0; k < n; ++k) {
        const std::span<const Vec2> s(corners.data() + first[k], first[k + 1] - first[k]);
        for (std::size_t i = 0; i + 1 < s.size(); ++i) envelope.add(s[i], s[i + 1]);
        envelope.add(s.back(), s.front());
        const auto [low, high] = std::minmax_element(s.begin(), s.end(), by_y);
        if (k > 0) {
            envelope.add(low_before, *low);
            envelope.add(high_before, *high);
        }
        low_before = *low;
        high_before = *high;
    }
    const auto to_stamp = [&](const Vec2& q) { return middle + q.x * forward + q.y * left; };
    Outline outline;
    outline.tip = to_stamp(front);
    outline.tail = to_stamp(rear);
    outline.left.reserve(points);
    outline.right.reserve(points);
    for (int j = points - 1; j >= 0; --j) {
        if (!envelope.covered(j)) continue;
        outline.left.push_back(to_stamp(envelope.top(j)));
        outline.right.push_back(to_stamp(envelope.bottom(j)));
    }
    std::vector<Vec2> closed;
    closed.reserve(2 * outline.left.size() + 2);
    closed.push_back(outline.tip);
    closed.insert(closed.end(), outline.left.begin(), outline.left.end());
    closed.push_back(outline.tail);
    closed.insert(closed.end(), outline.right.rbegin(), outline.right.rend());
    outline.control = spline_control(closed);
    return outline;
}

std::vector<NodePlanes> node_planes(const brush::TuftState& tuft, std::span<const brush::ContactPlane> planes) {
    const auto& branches = tuft.branches;
    if (planes.size() == 1) {
        std::vector<NodePlanes> same;
        same.reserve(branches.size());
        for (const brush::Branch& b : branches) same.emplace_back(b.sections.size(), planes[0]);
        return same;
    }
    if (branches.size() == 1 && planes.size() >= branches[0].sections.size())
        return {NodePlanes(planes.begin(), planes.begin() + branches[0].sections.size())};
    if (branches.size() < 2) return {};
    // The middle branch ends in the whole spine's root; its outer nodes are the sub_spine's.
    const std::size_t trunk = branches[branches.size() / 2].sections.size();
    const std::size_t sub_spine = branches[0].sections.size();
    if (trunk < sub_spine || planes.size() != trunk + branches.size() * sub_spine) return {};
    std::vector<NodePlanes> dealt;
    for (std::size_t k = 0; k < branches.size(); ++k) {
        const auto own = planes.subspan(trunk + k * sub_spine, sub_spine);
        dealt.emplace_back(own.begin(), own.end());
        if (k != branches.size() / 2) continue;
        dealt.back().pop_back();
        dealt.back().insert(dealt.back().end(), planes.begin() + sub_spine - 1, planes.begin() + trunk);
    }
    return dealt;
}

std::vector<Outline> outline(const brush::TuftState& tuft, const Frame& frame, std::span<const NodePlanes> planes,
                             const OutlineOptions& options) {
    std::vector<Outline> outlines;
    for (const Trail& trail : trails(tuft, frame, planes, 0, options.film)) {
        Outline o = outline_of(trail, options.points);
        if (o.left.size() >= 3) outlines.push_back(std::move(o));
    }
    return outlines;
}

std::vector<Vec2> curve_points(const Outline& outline, int per_span) {
    const auto& c = outline.control;
    const int n = static_cast<int>(c.size());
    std::vector<Vec2> points;
    if (n < 3) return points;
    points.reserve(static_cast<std::size_t>(n) * per_span);
    for (int k = 0; k < n; ++k) {
        const Vec2 &c0 = c[(k + n - 1) % n], &c1 = c[k], &c2 = c[(k + 1) % n], &c3 = c[(k + 2) % n];
        for (int i = 0; i < per_span; ++i) {
            const double f = double(i) / per_span, g = 1 - f;
            points.push_back((g * g * g * c0 + (3 * f * f * f - 6 * f * f + 4) * c1 +
                              (3 * g * g * g - 6 * g * g + 4) * c2 + f * f * f * c3) /
                             6.0);
        }
    }
    return points;
}

}  // namespace tuft::footprint
