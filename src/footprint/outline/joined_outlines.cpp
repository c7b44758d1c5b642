#include <algorithm>
#include <cmath>
#include <numbers>

#include "footprint/outline/cuts.h"
#include "footprint/outline/outline_parts.h"
#include "footprint/outline/slip.h"

// Outlines of the spines of a ferrule that ink joins, and of what leapt since the pose before.
namespace tuft::footprint {
namespace {

/// Sections of two or three neighbouring trails at equal parts of their hair, tip side first: the skin between spines
/// goes from tip to tip.
struct Joint {
    Recycled<Recycled<Cut>> side;  ///< [trails][sections]
    Recycled<const Trail*> trail;  ///< [trails]
};

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
Recycled<Joint> joints_of(std::span<const Trail* const> trails) {
    constexpr int kJointSamples = 24;
    Recycled<Joint> out;
    Recycled<Walk> walks;
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
        const double u = std::lerp(tip, root, 0.5 - 0.5 * std::cos(std::numbers::pi * i / (kJointSamples - 1)));
        double widest = -1e9;
        for (Walk& a : walks)
            for (const Trail* b : trails)
                if (const TrailOpening* o = opening_between(*a.trail, *b)) widest = std::max(widest, a.opening(u, *o));
        if (widest <= 0) {
            if (open) out.push_back({Recycled<Recycled<Cut>>(trails.size()), {trails.begin(), trails.end()}});
            for (std::size_t k = 0; k < walks.size(); ++k) out.back().side[k].push_back(walks[k].cut(u));
        }
        open = widest > 0;
    }
    std::erase_if(out, [](const Joint& j) { return j.side.front().size() < 2; });
    return out;
}

/// Adds the skin between two sections side by side; with `ends` also before and behind them.
void add_bridge(const Loops& loops, std::size_t k, std::size_t l, bool ends, Envelope& envelope) {
    envelope.add(loops.extent[k].low, loops.extent[l].low);
    envelope.add(loops.extent[k].high, loops.extent[l].high);
    if (!ends) return;
    const std::span<const Vec2> p = loops[k], q = loops[l];
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
    for (const Recycled<Cut>& side : joint.side) {
        forward += forward_direction(side);
        middle += side[n / 2].centre;
    }
    const PatchFrame patch{middle / static_cast<double>(sides),
                           unit_or(forward, forward_direction(joint.side.front()))};
    Loops loops;
    for (std::size_t k = 0; k < sides; ++k) loops.add(joint.side[k], strip_of(*joint.trail[k]));
    patch.to_patch(loops.corners);
    loops.find_extents();
    const auto [rear, front] = std::minmax_element(loops.corners.begin(), loops.corners.end(), by_x);
    Envelope envelope(rear->x, front->x, points);
    for (std::size_t k = 0; k < sides; ++k) add_loops(loops, k * n, (k + 1) * n, envelope);
    for (std::size_t k = 0; k < sides; ++k)
        for (std::size_t l = k + 1; l < sides; ++l)
            for (std::size_t i = 0; i < n; ++i)
                add_bridge(loops, k * n + i, l * n + i, discs || i == 0 || i + 1 == n, envelope);
    return closed_outline(envelope, patch, {*front, *rear}, points, joint.trail.front()->strip);
}

constexpr double kLeap = 0.15;      // of a patch's extent: what it moves by more, it leaps
constexpr int kSweptSamples = 8;    // sections of a trail that leapt
constexpr double kMostPassed = 24;  // poses of a leap
constexpr double kMostArc = 1.2;    // of the distance of a chord's middle; 1.155 in a ring of six

/// Extent of what of a trail lies under the surface, in a direction of the stamp, metres.
double extent_along(const Trail& trail, const Vec2& direction) {
    const std::size_t last = trail.cuts.size() - 1;
    Loops loops;
    for (const std::size_t i : {std::size_t{0}, last / 2, last}) loops.add({&trail.cuts[i], 1}, strip_of(trail));
    double lo = 1e9, hi = -1e9;
    for (const Vec2& p : loops.corners) {
        lo = std::min(lo, glm::dot(p, direction));
        hi = std::max(hi, glm::dot(p, direction));
    }
    return hi - lo;
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
Recycled<Cut> sections_of(const Trail& trail) {
    Recycled<Cut> out;
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
    loops.find_extents();
    const auto [rear, front] = std::minmax_element(loops.corners.begin(), loops.corners.end(), by_x);
    Envelope envelope(rear->x, front->x, points);
    const std::size_t n = kSweptSamples, sides = 2 * now.size();
    for (std::size_t k = 0; k < sides; ++k) add_loops(loops, k * n, (k + 1) * n, envelope);
    for (std::size_t k = 0; k < sides; ++k)
        for (std::size_t l = k + 1; l < sides; ++l)
            for (std::size_t i = 0; i < n; ++i) add_bridge(loops, k * n + i, l * n + i, true, envelope);
    return closed_outline(envelope, patch, {*front, *rear}, points, now.front()->strip);
}

/// Middle of the roots of the outer spines of a ring where they touch.
Vec2 middle_of_ring(std::span<const Trail> trails) {
    Vec2 sum{0};
    double count = 0;
    for (const Trail& trail : trails)
        if (trail.branch > 0) sum += trail.cuts.back().centre, ++count;
    return sum / std::max(count, 1.0);
}

/// Adds what lies midway between two outer spines of a ring: as far out as they are, where their chord is nearer.
void add_arc(Joint& joint, const Vec2& middle) {
    Recycled<Cut> arc;
    for (std::size_t i = 0; i < joint.side[0].size(); ++i) {
        const Cut &p = joint.side[0][i], &q = joint.side[1][i];
        Cut cut = cut_between(p, q, 0.5);
        const double out = glm::length(cut.centre - middle);
        const double wanted = 0.5 * (glm::distance(p.centre, middle) + glm::distance(q.centre, middle));
        if (out > 0) cut.centre = middle + std::min(wanted / out, kMostArc) * (cut.centre - middle);
        arc.push_back(cut);
    }
    joint.side.push_back(std::move(arc));
    joint.trail.push_back(joint.trail.front());
}

}  // namespace

Recycled<Trail> leapt_trails(std::span<const Trail> trails, const Frame& frame, std::span<const Trail> before,
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
    Recycled<Trail> out(before.begin(), before.end());
    change_frame(out, frame_before, frame);
    return out;
}

Recycled<Trail> trails_passed(std::span<const Trail> trails, std::span<const Trail> before) {
    Recycled<const Trail*> was;
    double steps = 0;  // of a leap each
    for (const Trail& trail : trails) {
        was.push_back(same_branch(trail, before));
        if (!was.back()) continue;
        const Vec2 tip = trail.cuts.front().centre - was.back()->cuts.front().centre,
                   root = trail.cuts.back().centre - was.back()->cuts.back().centre;
        const Vec2 most = glm::length(tip) > glm::length(root) ? tip : root;
        const double way = glm::length(most);
        if (way > 1e-9) steps = std::max(steps, way / (kLeap * extent_along(trail, most / way)));
    }
    Recycled<Trail> out;
    const int poses = static_cast<int>(std::min(std::ceil(steps), kMostPassed));
    for (int pose = 1; pose < poses; ++pose)
        for (std::size_t k = 0; k < trails.size(); ++k) {
            if (!was[k]) continue;
            const double f = static_cast<double>(pose) / poses;
            Trail& trail = out.emplace_back(trails[k]);
            for (std::size_t i = 0; i < trail.cuts.size(); ++i) {
                trail.cuts[i] = cut_between(was[k]->cuts[i], trails[k].cuts[i], f);
                trail.along[i] = std::lerp(was[k]->along[i], trails[k].along[i], f);
            }
        }
    return out;
}

namespace {

/// Outlines of trails, alone and joined.
class Union {
  public:
    Union(std::span<const Trail> trails, int points, std::span<const Trail> before)
        : trails_(trails), before_(before), points_(std::max(points, 4)), middle_(middle_of_ring(trails)) {}

    /// Adds the heel of spines of a row that ink joins, where longer hair meets the surface further from the ferrule
    /// than its neighbours: ink spans the wedge under it.
    void add_heel(std::span<const std::size_t> numbers) {
        if (numbers.size() < 3) return;
        Joint heel;
        for (const std::size_t k : numbers) {
            const Recycled<Cut>& cuts = trails_[k].cuts;
            heel.side.push_back({cuts[(cuts.size() - 1) / 2], cuts.back()});
            heel.trail.push_back(&trails_[k]);
        }
        keep(outline_of(heel, points_));
    }

    /// Returns true where ink joins them somewhere.
    bool join(std::initializer_list<std::size_t> numbers) {
        Recycled<const Trail*> now, was;
        for (const std::size_t k : numbers) now.push_back(&trails_[k]);
        Recycled<Joint> joints = joints_of(now);
        for (Joint& joint : joints) {
            const bool arc = now.size() == 2 && !now[0]->strip && now[0]->branch > 0 && now[1]->branch > 0;
            if (arc) add_arc(joint, middle_);
            keep(outline_of(joint, points_));
        }
        if (joints.empty()) return false;
        for (const Trail* trail : now)
            if (const Trail* b = same_branch(*trail, before_)) was.push_back(b);
        if (was.size() == now.size()) keep(swept_outline(now, was, points_));
        return true;
    }

    /// Adds each trail alone.
    void add_alone() {
        for (const Trail& trail : trails_) {
            const Trail* const now = &trail;
            keep(outline_of(trail, points_));
            if (const Trail* was = same_branch(trail, before_)) keep(swept_outline({&now, 1}, {&was, 1}, points_));
        }
    }

    Recycled<Outline> take() { return std::move(out_); }

  private:
    void keep(Outline outline) {
        if (outline.left.size() >= 3) out_.push_back(std::move(outline));
    }
    std::span<const Trail> trails_, before_;
    int points_;
    Vec2 middle_;
    Recycled<Outline> out_;
};

}  // namespace

Recycled<Outline> outlines_of(std::span<const Trail> trails, int points, std::span<const Trail> before) {
    Union all(trails, points, before);
    all.add_alone();
    Recycled<std::size_t> row;  // of spines joined so far, each to the next
    for (std::size_t a = 0; a < trails.size(); ++a)
        for (std::size_t b = 0; b < trails.size(); ++b) {
            if (!opening_between(trails[a], trails[b])) continue;
            const bool joined = all.join({a, b});
            if (trails[a].strip && joined) {
                if (row.empty() || row.back() != a) {
                    all.add_heel(row);
                    row.assign(1, a);
                }
                row.push_back(b);
            }
            for (std::size_t c = 0; c < trails.size(); ++c)
                if (opening_between(trails[b], trails[c]) && opening_between(trails[a], trails[c])) all.join({a, b, c});
        }
    all.add_heel(row);
    return all.take();
}

}  // namespace tuft::footprint
