#include "footprint/outline/outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "footprint/outline/cuts.h"
#include "footprint/outline/slip.h"

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

/// The same of a strip: its corners at the scale at which it meets the surface when the ellipse does, cut by it.
void add_strip_shadow(const Cut& cut, std::span<const Vec2> strip, std::vector<Vec2>& corners) {
    const Vec3 e = cut.a * cut.e, m = cut.b * cut.m;
    const Vec3 broad = cut.turn.x * e + cut.turn.y * m, thick = cut.turn.x * m - cut.turn.y * e;
    double reach = 0;
    for (const Vec2& c : strip) reach = std::max(reach, -(c.x * broad.z + c.y * thick.z));
    const double half = cut.half_height(), z = half > 0 ? cut.z * reach / half : cut.z;
    const auto height = [&](const Vec2& c) { return z + c.x * broad.z + c.y * thick.z; };
    const auto point = [&](const Vec2& c) { return cut.centre + c.x * Vec2(broad) + c.y * Vec2(thick); };
    const std::size_t before = corners.size();
    for (std::size_t k = 0; k < strip.size(); ++k) {
        const Vec2 &c = strip[k], &next = strip[(k + 1) % strip.size()];
        const double p = height(c), q = height(next);
        if (p <= 0) corners.push_back(point(c));
        if ((p <= 0) != (q <= 0)) corners.push_back(glm::mix(point(c), point(next), p / (p - q)));
    }
    if (corners.size() == before) corners.push_back(cut.centre);  // it only just touches
}

/// Corners of a trail's strip; none of a disc.
std::span<const Vec2> strip_of(const Trail& trail) {
    constexpr double k = Trail::kStripChord;
    static constexpr Vec2 kRectangle[4] = {{k, k}, {-k, k}, {-k, -k}, {k, -k}};
    if (!trail.strip) return {};
    return trail.corners.empty() ? std::span<const Vec2>(kRectangle) : std::span<const Vec2>(trail.corners);
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

namespace {

/// Shadows of sections on the surface, one loop of corners each.
struct Loops {
    std::vector<Vec2> corners;
    std::vector<std::size_t> first{0};  ///< corner of each loop, and the end

    /// `strip`: corners of the hair's sections; empty: ellipses.
    void add(std::span<const Cut> cuts, std::span<const Vec2> strip) {
        corners.reserve(corners.size() + cuts.size() * (strip.empty() ? kDirections + 2 : strip.size() + 2));
        for (const Cut& cut : cuts) {
            if (strip.empty())
                add_shadow(cut, corners);
            else
                add_strip_shadow(cut, strip, corners);
            first.push_back(corners.size());
        }
    }
    std::size_t size() const { return first.size() - 1; }
    std::span<const Vec2> operator[](std::size_t k) const {
        return {corners.data() + first[k], first[k + 1] - first[k]};
    }
};

/// Coordinates along and across a patch.
struct PatchFrame {
    Vec2 middle{0}, forward{1, 0};

    Vec2 left() const { return {-forward.y, forward.x}; }
    void to_patch(std::vector<Vec2>& points) const {
        for (Vec2& q : points) q = {glm::dot(q - middle, forward), glm::dot(q - middle, left())};
    }
    Vec2 to_stamp(const Vec2& q) const { return middle + q.x * forward + q.y * left(); }
};

bool by_y(const Vec2& a, const Vec2& b) {
    return a.y < b.y;
}
bool by_x(const Vec2& a, const Vec2& b) {
    return a.x < b.x;
}

/// Adds the loops of one trail, each with the skin to the next.
void add_loops(const Loops& loops, std::size_t begin, std::size_t end, Envelope& envelope) {
    Vec2 low_before{0}, high_before{0};
    for (std::size_t k = begin; k < end; ++k) {
        const std::span<const Vec2> s = loops[k];
        for (std::size_t i = 0; i + 1 < s.size(); ++i) envelope.add(s[i], s[i + 1]);
        envelope.add(s.back(), s.front());
        const auto [low, high] = std::minmax_element(s.begin(), s.end(), by_y);
        if (k > begin) {
            envelope.add(low_before, *low);
            envelope.add(high_before, *high);
        }
        low_before = *low;
        high_before = *high;
    }
}

/// Two ends of an outline, patch frame.
struct Ends {
    Vec2 front{0}, rear{0};
};

/// The outline of an envelope. With `edges` its control points are its own: the spline through them would swing beyond
/// the straight ends of strips.
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
    std::vector<Vec2> closed;
    closed.reserve(2 * outline.left.size() + 2);
    closed.push_back(outline.tip);
    closed.insert(closed.end(), outline.left.begin(), outline.left.end());
    closed.push_back(outline.tail);
    closed.insert(closed.end(), outline.right.rbegin(), outline.right.rend());
    outline.control = edges ? closed : spline_control(closed);
    return outline;
}

}  // namespace

Outline outline_of(const Trail& trail, int points) {
    const std::vector<Cut>& cuts = trail.cuts;
    points = std::max(points, 4);
    const PatchFrame patch{cuts[cuts.size() / 2].centre, forward_direction(cuts)};
    Loops loops;
    loops.add(cuts, strip_of(trail));
    patch.to_patch(loops.corners);
    Vec2 front{-1e9, 0}, rear{1e9, 0};
    for (const Vec2& q : loops.corners) {
        if (q.x > front.x) front = q;
        if (q.x < rear.x) rear = q;
    }
    Envelope envelope(rear.x, front.x, points);
    add_loops(loops, 0, loops.size(), envelope);
    return closed_outline(envelope, patch, {front, rear}, points, trail.strip);
}

namespace {

/// Sections of two or three neighbouring trails at equal parts of their hair, tip side first: the skin between spines
/// goes from tip to tip.
struct Joint {
    std::vector<std::vector<Cut>> side;  ///< [trails][sections]
    std::vector<const Trail*> trail;     ///< [trails]
};

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
            glm::dot(turn, turn) > 1e-6 ? glm::normalize(turn) : p.turn};
}

constexpr double kPast = 0.02;  ///< of the hair, that one of two joined ends may touch further

/// A trail that is looked at from its tip to its root.
struct Walk {
    const Trail* trail = nullptr;
    std::size_t from = 0;  ///< cut from which on the next place lies

    /// The section at the part u of the trail's own hair.
    Cut cut(double u) {
        const double f = step_to(u);
        return cut_between(trail->cuts[from], trail->cuts[from + 1], f);
    }
    double opening(double u, const TrailOpening& to) {
        const double f = step_to(u);
        return std::lerp(to.width[from], to.width[from + 1], f);
    }

  private:
    double step_to(double u) {
        const double along = u * trail->length;
        // The round end of discs lies beyond all hair.
        if (const double past = along - trail->along.front(); past > 0 && !trail->strip) {
            const auto at = std::upper_bound(trail->along.rbegin(), trail->along.rend(), trail->along.front() - 1e-12);
            const auto end = static_cast<double>(std::max<std::ptrdiff_t>(trail->along.rend() - at, 2) - 1);
            const double place = end * (1 - std::min(1.0, past / kPast));
            from = std::min(static_cast<std::size_t>(place), trail->cuts.size() - 2);
            return std::min(1.0, place - static_cast<double>(from));
        }
        while (from + 2 < trail->cuts.size() && trail->along[from + 1] > along) ++from;
        const double run = trail->along[from] - trail->along[from + 1];
        return run > 0 ? std::clamp((trail->along[from] - along) / run, 0.0, 1.0) : 0;
    }
};

const TrailOpening* opening_between(const Trail& a, const Trail& b) {
    for (const TrailOpening& o : a.openings)
        if (o.branch == b.branch) return &o;
    return nullptr;
}

/// The stretches over which all of the given neighbouring trails are joined, of where all touch.
std::vector<Joint> joints_of(std::span<const Trail* const> trails) {
    constexpr int kJointSamples = 24;
    std::vector<Joint> out;
    std::vector<Walk> walks;
    double tip = 1e9, root = -1e9;
    for (const Trail* t : trails) {
        walks.push_back({t});
        tip = std::min(tip, t->along.front() / t->length);
        root = std::max(root, t->along.back() / t->length);
    }
    tip += kPast;
    root -= kPast;
    bool open = true;
    for (int i = 0; i < kJointSamples && root < tip; ++i) {
        const double u = std::lerp(tip, root, 0.5 - 0.5 * std::cos(kPi * i / (kJointSamples - 1)));
        double widest = -1e9;
        for (Walk& a : walks)
            for (const Trail* b : trails)
                if (const TrailOpening* o = opening_between(*a.trail, *b)) widest = std::max(widest, a.opening(u, *o));
        if (widest <= 0) {
            if (open) out.push_back({std::vector<std::vector<Cut>>(trails.size()), {trails.begin(), trails.end()}});
            for (std::size_t k = 0; k < walks.size(); ++k) out.back().side[k].push_back(walks[k].cut(u));
        }
        open = widest > 0;
    }
    std::erase_if(out, [](const Joint& j) { return j.side.front().size() < 2; });
    return out;
}

/// Adds the skin between two sections side by side; with `ends` also before and behind them.
void add_bridge(std::span<const Vec2> p, std::span<const Vec2> q, bool ends, Envelope& envelope) {
    const auto [p_low, p_high] = std::minmax_element(p.begin(), p.end(), by_y);
    const auto [q_low, q_high] = std::minmax_element(q.begin(), q.end(), by_y);
    envelope.add(*p_low, *q_low);
    envelope.add(*p_high, *q_high);
    if (!ends) return;
    const auto [p_rear, p_front] = std::minmax_element(p.begin(), p.end(), by_x);
    const auto [q_rear, q_front] = std::minmax_element(q.begin(), q.end(), by_x);
    envelope.add(*p_rear, *q_rear);
    envelope.add(*p_front, *q_front);
}

/// Outline of joined stretches and of all that lies between them.
Outline outline_of(const Joint& joint, int points) {
    const std::size_t n = joint.side.front().size(), sides = joint.side.size();
    const bool discs = !joint.trail.front()->strip;  // any of them may reach furthest
    Vec2 forward{0}, middle{0};
    for (const std::vector<Cut>& side : joint.side) {
        forward += forward_direction(side);
        middle += side[n / 2].centre;
    }
    const PatchFrame patch{middle / static_cast<double>(sides),
                           unit_or(forward, forward_direction(joint.side.front()))};
    Loops loops;
    for (std::size_t k = 0; k < sides; ++k) loops.add(joint.side[k], strip_of(*joint.trail[k]));
    patch.to_patch(loops.corners);
    const auto [rear, front] = std::minmax_element(loops.corners.begin(), loops.corners.end(), by_x);
    Envelope envelope(rear->x, front->x, points);
    for (std::size_t k = 0; k < sides; ++k) add_loops(loops, k * n, (k + 1) * n, envelope);
    for (std::size_t k = 0; k < sides; ++k)
        for (std::size_t l = k + 1; l < sides; ++l)
            for (std::size_t i = 0; i < n; ++i)
                add_bridge(loops[k * n + i], loops[l * n + i], discs || i == 0 || i + 1 == n, envelope);
    return closed_outline(envelope, patch, {*front, *rear}, points, joint.trail.front()->strip);
}

}  // namespace

namespace {

constexpr double kLeap = 0.4;     // of a patch's extent: what it moves by more, it leaps
constexpr int kSweptSamples = 8;  // sections of a trail that leapt

/// Extent of a trail in a direction of the stamp, metres.
double extent_along(const Trail& trail, const Vec2& direction) {
    const Cut& c = trail.cuts[trail.cuts.size() / 2];
    const Vec2 run = trail.cuts.front().centre - trail.cuts.back().centre;
    return std::abs(glm::dot(run, direction)) +
           2 * std::hypot(c.a * glm::dot(Vec2(c.e), direction), c.b * glm::dot(Vec2(c.m), direction));
}

/// The trail of the same branch that is nearest in `before`; null: there is none.
const Trail* same_branch(const Trail& trail, std::span<const Trail> before) {
    const Trail* best = nullptr;
    double nearest = 1e9;
    for (const Trail& b : before) {
        if (b.branch != trail.branch) continue;
        const double off = std::abs(b.along.front() - trail.along.front());
        if (off < nearest) nearest = off, best = &b;
    }
    return best;
}

/// Sections from end to end of a trail, evenly in their number.
std::vector<Cut> sections_of(const Trail& trail) {
    std::vector<Cut> out;
    const std::size_t last = trail.cuts.size() - 1;
    for (int i = 0; i < kSweptSamples; ++i)
        out.push_back(trail.cuts[last * static_cast<std::size_t>(i) / (kSweptSamples - 1)]);
    return out;
}

/// Outline of trails at two poses and of all that lies between them, seen along the longest way that one went.
Outline swept_outline(std::span<const Trail* const> now, std::span<const Trail* const> before, int points) {
    Loops loops;
    Vec2 way{0}, middle{0};
    const auto add = [&](const Trail& trail) { loops.add(sections_of(trail), strip_of(trail)); };
    for (std::size_t k = 0; k < now.size(); ++k) {
        add(*now[k]);
        add(*before[k]);
        const Cut &p = before[k]->cuts.front(), &q = now[k]->cuts.front();
        if (glm::length(q.centre - p.centre) > glm::length(way)) way = q.centre - p.centre;
        middle += (p.centre + q.centre) / (2.0 * static_cast<double>(now.size()));
    }
    const PatchFrame patch{middle, unit_or(way, forward_direction(now.front()->cuts))};
    patch.to_patch(loops.corners);
    const auto [rear, front] = std::minmax_element(loops.corners.begin(), loops.corners.end(), by_x);
    Envelope envelope(rear->x, front->x, points);
    const std::size_t n = kSweptSamples, sides = 2 * now.size();
    for (std::size_t k = 0; k < sides; ++k) add_loops(loops, k * n, (k + 1) * n, envelope);
    for (std::size_t k = 0; k < sides; ++k)
        for (std::size_t l = k + 1; l < sides; ++l)
            for (std::size_t i = 0; i < n; ++i) add_bridge(loops[k * n + i], loops[l * n + i], true, envelope);
    return closed_outline(envelope, patch, {*front, *rear}, points, now.front()->strip);
}

}  // namespace

std::vector<Trail> leapt_trails(std::span<const Trail> trails, const Frame& frame, std::span<const Trail> before,
                                const Frame& frame_before, const Vec2& hand) {
    bool leapt = false;
    for (const Trail& trail : trails) {
        const Trail* was = same_branch(trail, before);
        if (!was) continue;
        const auto moved = [&](const Cut& from, const Cut& to) {
            return to.centre - Vec2(frame.to_local(frame_before.to_world(Vec3(from.centre, 0)))) - hand;
        };
        const Vec2 tip = moved(was->cuts.front(), trail.cuts.front()),
                   root = moved(was->cuts.back(), trail.cuts.back());
        const Vec2 most = glm::length(tip) > glm::length(root) ? tip : root;
        const double way = glm::length(most);
        leapt = leapt || (way > 1e-9 && way > kLeap * extent_along(trail, most / way));
    }
    if (!leapt) return {};
    std::vector<Trail> out(before.begin(), before.end());
    change_frame(out, frame_before, frame);
    return out;
}

std::vector<Outline> outlines_of(std::span<const Trail> trails, int points, std::span<const Trail> before) {
    points = std::max(points, 4);
    std::vector<Outline> out;
    const auto keep = [&](Outline outline) {
        if (outline.left.size() >= 3) out.push_back(std::move(outline));
    };
    const auto join = [&](std::initializer_list<const Trail*> joined) {
        const std::vector<Joint> joints = joints_of({joined.begin(), joined.size()});
        for (const Joint& joint : joints) keep(outline_of(joint, points));
        if (joints.empty() || before.empty()) return;
        std::vector<const Trail*> was;
        for (const Trail* trail : joined)
            if (const Trail* b = same_branch(*trail, before)) was.push_back(b);
        if (was.size() == joined.size()) keep(swept_outline({joined.begin(), joined.size()}, was, points));
    };
    for (const Trail& trail : trails) {
        keep(outline_of(trail, points));
        if (const Trail* was = same_branch(trail, before)) {
            const Trail* const now = &trail;
            keep(swept_outline({&now, 1}, {&was, 1}, points));
        }
    }
    for (const Trail& a : trails) {
        for (const Trail& b : trails) {
            if (!opening_between(a, b)) continue;
            join({&a, &b});
            for (const Trail& c : trails)
                if (opening_between(b, c) && opening_between(a, c)) join({&a, &b, &c});
        }
    }
    return out;
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
    if (tuft.wide) {
        std::vector<NodePlanes> own;
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

std::vector<Outline> outlines_of(const brush::TuftState& tuft, const Frame& frame, std::span<const NodePlanes> planes,
                                 const OutlineOptions& options) {
    return outlines_of(find_trails(tuft, frame, planes, 1, options.film), options.points);
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
