#include "footprint/outline/cuts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "atlas/texels/log_map.h"
#include "core/cubic.h"
#include "core/ease.h"
#include "footprint/outline/outline_parts.h"

namespace tuft::footprint {

EllipseAxes ellipse_of(const Vec3& broad, const Vec3& thick, const Vec2& turn) {
    using std::numbers::pi;
    const double own = std::atan2(-turn.y, turn.x);
    const double across = 2 * glm::dot(broad, thick), more = glm::dot(broad, broad) - glm::dot(thick, thick);
    double angle = 0.5 * std::atan2(across, more);
    angle += 0.5 * pi * std::round((own - angle) / (0.5 * pi));
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * broad + s * thick, c * thick - s * broad, {c, -s}};
}

namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kSearchSteps = 4;                // per segment, to find where the surface meets the surface
constexpr double kTurns = 0.3, kTurned = 0.7;  // squared sine of a strip's turn from which on it ends across e
constexpr int kSamples = 48;                   // sections taken from a stretch that touches

/// Places of the samples of a stretch, 0–1, close together at both ends.
const std::array<double, kSamples>& sample_places() {
    static const auto table = [] {
        std::array<double, kSamples> t;
        for (int i = 0; i < kSamples; ++i) t[i] = 0.5 - 0.5 * std::cos(kPi * i / (kSamples - 1));
        return t;
    }();
    return table;
}

Cut cut_of(const brush::Section& s, const Frame& frame, const brush::ContactPlane* plane, double film) {
    const Vec3 normal = plane ? plane->normal : frame.n;
    const Vec3 origin = plane ? plane->origin : frame.origin;
    Cut cut;
    cut.z = glm::dot(s.centre - origin, normal);
    cut.a = s.a + film;
    cut.b = s.b + film;
    const Vec3 foot = s.centre - cut.z * normal;
    Frame local = frame;
    if (plane && glm::dot(normal, frame.n) > atlas::kLogMapMinCos) {
        cut.centre = atlas::log_map(frame, foot, normal);
        local.n = normal;
        local.t = parallel_transport(frame.t, frame.n, normal);
        local.b = glm::cross(local.n, local.t);
    } else {
        cut.centre = Vec2(frame.to_local(foot));
    }
    const auto components = [&](const Vec3& v) {
        return Vec3{glm::dot(v, local.t), glm::dot(v, local.b), glm::dot(v, local.n)};
    };
    cut.e = components(s.e);
    cut.m = components(s.m);
    cut.turn = s.turn;
    return cut;
}

/// Slope of a monotone cubic at a node that keeps to the flatter side [Fritsch1984].
double cautious_slope(double before, double after, double h_before, double h_after) {
    if (!(before * after > 0)) return 0;
    const double w1 = 2 * h_after + h_before, w2 = h_after + 2 * h_before;
    return (w1 + w2) / (w1 / before + w2 / after);
}

/// The surface of a branch between its nodes: node parameter 0 (tip) … n − 1 (root).
class BranchSurface {
  public:
    BranchSurface(const brush::Branch& branch, bool strip, const Frame& frame, const NodePlanes* planes, double film) {
        const auto& sections = branch.sections;
        const auto plane = [&](std::size_t i) { return planes && i < planes->size() ? &(*planes)[i] : nullptr; };
        add_cap(sections.front(), strip, frame, plane(0), film);
        cap_ = nodes_.size();
        for (std::size_t i = 0; i < sections.size(); ++i) {
            if (i > 0) steps_.push_back(glm::length(sections[i].centre - sections[i - 1].centre));
            nodes_.push_back(cut_of(sections[i], frame, plane(i), film));
        }
        for (double& h : steps_) h = std::max(h, 1e-9);
        from_tip_.assign(nodes_.size(), 0);
        for (std::size_t i = 1; i < nodes_.size(); ++i)
            from_tip_[i] = from_tip_[i - 1] + (i > cap_ ? steps_[i - 1] : 0);
        set_slopes();
    }

    /// Parameter of section i of the branch.
    double at_section(std::size_t i) const { return double(cap_ + i); }

    /// A value of the sections at a place, linear between them, where the lesser of both is finite.
    double value_at(double s, std::span<const double> of_section) const {
        const double at = std::clamp(s - double(cap_), 0.0, double(of_section.size() - 1));
        const auto i = std::min(static_cast<std::size_t>(at), of_section.size() - 1);
        const double p = of_section[i], q = of_section[std::min(i + 1, of_section.size() - 1)], f = at - double(i);
        return f > 0 ? (std::isfinite(p) && std::isfinite(q) ? std::lerp(p, q, f) : std::max(p, q)) : p;
    }

    /// Metres of hair between the tip and a place.
    double from_tip(double s) const {
        const std::size_t i = std::min(static_cast<std::size_t>(std::max(s, 0.0)), from_tip_.size() - 1);
        if (i + 1 >= from_tip_.size()) return from_tip_.back();
        return from_tip_[i] + (s - double(i)) * (from_tip_[i + 1] - from_tip_[i]);
    }

    /// Place that lies `metres` of hair from the tip; inverse of `from_tip`.
    double place(double metres) const {
        const auto next =
            std::upper_bound(from_tip_.begin() + static_cast<std::ptrdiff_t>(cap_), from_tip_.end(), metres);
        if (next == from_tip_.end() || cap_ + 1 >= from_tip_.size()) return end();
        const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(next - from_tip_.begin(), cap_ + 1)) - 1;
        const double run = from_tip_[i + 1] - from_tip_[i];
        return double(i) + (run > 0 ? std::clamp((metres - from_tip_[i]) / run, 0.0, 1.0) : 0);
    }

    double end() const { return nodes_.empty() ? 0 : double(nodes_.size() - 1); }

    Cut at(double s) const {
        if (nodes_.size() == 1) return nodes_[0];
        const auto last = static_cast<int>(nodes_.size()) - 2;
        const int i = std::clamp(static_cast<int>(s), 0, last);
        const double f = std::clamp(s - i, 0.0, 1.0), h = steps_[i];
        const Cut &p = nodes_[i], &q = nodes_[i + 1];
        const Slope &g = slopes_[i], &k = slopes_[i + 1];
        Cut cut;
        cut.centre = hermite(p.centre, q.centre, g.centre, k.centre, h, f);
        cut.z = hermite(p.z, q.z, g.z, k.z, h, f);
        cut.a = hermite(p.a, q.a, g.a, k.a, h, f);
        cut.b = hermite(p.b, q.b, g.b, k.b, h, f);
        cut.e = between(p.e, q.e, f);
        cut.m = between(p.m, q.m, f);
        const Vec2 turn = glm::mix(p.turn, q.turn, f);
        cut.turn = glm::dot(turn, turn) > 1e-6 ? glm::normalize(turn) : p.turn;
        return cut;
    }

    /// The same as `at(s).overlap()`, to the bit, without the rest of the cut.
    double overlap_at(double s) const {
        if (nodes_.size() == 1) return nodes_[0].overlap();
        const auto last = static_cast<int>(nodes_.size()) - 2;
        const int i = std::clamp(static_cast<int>(s), 0, last);
        const double f = std::clamp(s - i, 0.0, 1.0), h = steps_[i];
        const Cut &p = nodes_[i], &q = nodes_[i + 1];
        const Slope &g = slopes_[i], &k = slopes_[i + 1];
        const double a = hermite(p.a, q.a, g.a, k.a, h, f), b = hermite(p.b, q.b, g.b, k.b, h, f);
        const double e = z_between(p.e, q.e, f), m = z_between(p.m, q.m, f);
        return std::sqrt(a * a * e * e + b * b * m * m) - hermite(p.z, q.z, g.z, k.z, h, f);
    }

  private:
    struct Slope {
        Vec2 centre{0};
        double z = 0, a = 0, b = 0;
    };

    /// Closes a blunt tip by half an ellipsoid; the edge of a strip by half a cylinder, as wide as the strip, which is
    /// thinner than wide.
    void add_cap(const brush::Section& tip, bool strip, const Frame& frame, const brush::ContactPlane* plane,
                 double film) {
        // Whether e is across the strip, 0–1.
        const double turned =
            strip && tip.a < tip.b ? smooth_step((tip.turn.y * tip.turn.y - kTurns) / (kTurned - kTurns)) : 0;
        const double r = strip ? std::lerp(tip.b, tip.a, turned) + film : std::sqrt((tip.a + film) * (tip.b + film));
        if (!(r > 1e-7)) return;
        static constexpr std::array<double, 5> kAhead{1, 0.98, 0.9, 0.7, 0.4};
        for (std::size_t k = 0; k < kAhead.size(); ++k) {
            brush::Section ring = tip;
            const double shrink = std::sqrt(1 - kAhead[k] * kAhead[k]);
            ring.centre += kAhead[k] * r * tip.tangent;
            nodes_.push_back(cut_of(ring, frame, plane, film));
            nodes_.back().a *= std::lerp(1.0, shrink, strip ? turned : 1);
            nodes_.back().b *= std::lerp(shrink, 1.0, turned);
            steps_.push_back((kAhead[k] - (k + 1 < kAhead.size() ? kAhead[k + 1] : 0)) * r);
        }
    }

    static Vec3 between(const Vec3& p, const Vec3& q, double f) {
        const Vec3 v = (1 - f) * p + f * q;
        const double length = glm::length(v);
        return length > 1e-9 ? v / length : p;
    }

    static double z_between(const Vec3& p, const Vec3& q, double f) {
        const Vec3 v = (1 - f) * p + f * q;
        const double length = glm::length(v);
        return length > 1e-9 ? v.z / length : p.z;
    }

    void set_slopes() {
        const std::size_t n = nodes_.size();
        slopes_.resize(n);
        const auto rate = [&](std::size_t i, auto get) { return (get(nodes_[i + 1]) - get(nodes_[i])) / steps_[i]; };
        const auto z = [](const Cut& c) { return c.z; };
        const auto a = [](const Cut& c) { return c.a; };
        const auto b = [](const Cut& c) { return c.b; };
        const auto centre = [](const Cut& c) { return c.centre; };
        for (std::size_t i = 0; i < n && n > 1; ++i) {
            if (i == 0 || i == n - 1) {
                const std::size_t j = i == 0 ? 0 : n - 2;
                slopes_[i] = {rate(j, centre), rate(j, z), rate(j, a), rate(j, b)};
                continue;
            }
            const double h0 = steps_[i - 1], h1 = steps_[i];
            const auto slope = [&](auto get, auto law) { return law(rate(i - 1, get), rate(i, get), h0, h1); };
            slopes_[i].centre = parabola_slope(rate(i - 1, centre), rate(i, centre), h0, h1);
            if (i <= cap_) {
                // The point's round end goes over into long stretches.
                slopes_[i].z = slope(z, cautious_slope);
                slopes_[i].a = slope(a, cautious_slope);
                slopes_[i].b = slope(b, cautious_slope);
            } else {
                slopes_[i].z = slope(z, monotone_slope);
                slopes_[i].a = slope(a, monotone_slope);
                slopes_[i].b = slope(b, monotone_slope);
            }
        }
    }

    Recycled<Cut> nodes_;
    Recycled<double> steps_;
    Recycled<Slope> slopes_;
    Recycled<double> from_tip_;
    std::size_t cap_ = 0;  // nodes that close the tip
};

/// Where a spine's hair would be if it were straight.
struct StraightHair {
    double pressed = 0;  ///< metres of its tip below the surface where the spine's tip is
    Vec2 foot{0};        ///< metres, (u, v), of its tip
};
StraightHair straight_hair(std::span<const brush::Section> sections, const NodePlanes* planes, const Frame& frame) {
    double length = 0;
    for (std::size_t i = 1; i < sections.size(); ++i)
        length += glm::distance(sections[i].centre, sections[i - 1].centre);
    const bool own = planes && !planes->empty();
    const Vec3 normal = own ? planes->front().normal : frame.n, origin = own ? planes->front().origin : frame.origin;
    const Vec3 tip = sections.back().centre + length * sections.back().tangent;
    return {glm::dot(origin - tip, normal), Vec2(frame.to_local(tip))};
}

/// Part [begin, end] of the surface that touches.
struct Stretch {
    double begin = 0, end = 0;
};

/// Parameter between `out` (not touching) and `in` (touching) where the tuft meets the surface.
double find_meeting_point(const BranchSurface& surface, double out, double in) {
    for (int i = 0; i < 26; ++i) {
        const double middle = 0.5 * (out + in);
        (surface.overlap_at(middle) >= 0 ? in : out) = middle;
    }
    return in;
}

Recycled<Stretch> touching_stretches(const BranchSurface& surface) {
    Recycled<Stretch> found;
    const int n = static_cast<int>(surface.end()) * kSearchSteps;
    bool before = false;
    for (int i = 0; i <= n; ++i) {
        const double s = double(i) / kSearchSteps;
        const bool now = surface.overlap_at(s) >= 0;
        if (now && !before)
            found.push_back({i == 0 ? 0 : find_meeting_point(surface, double(i - 1) / kSearchSteps, s), s});
        if (now) found.back().end = s;
        if (!now && before) found.back().end = find_meeting_point(surface, s, double(i - 1) / kSearchSteps);
        before = now;
    }
    return found;
}

constexpr double kLanded = 0.5;  // of a spine's overlap, that its neighbour touches with when it has wholly landed
// Of its length, by which a neighbour's hair differs at most, and from which on they do not lie side by side.
constexpr double kSideBySide = 0.12, kApart = 0.2;
constexpr double kOfOneLength = 0.01;  // of its length, by which hair of one length at rest differs where it is bent
constexpr double kFarthest = 3;        // times its half width, that a strip touches to one side
// Part of a strip's broad axis on the surface, and cosine between it and the line to the neighbour, up to which the
// strip stands on its edge, and from which on it lies beside the neighbour.
constexpr double kStandsAside = 0.6, kLiesBeside = 0.8;

/// How far a strip touches towards a neighbour, and to which side.
struct TouchingPart {
    double over_half = 1, side = 0;
};

// Between two spines, both of which are solved, hair of a toe stands ahead from a sine of its strip to its hair on, and
// wholly from another; by so many half widths of a strip at most.
constexpr double kGapAslant = 0.8, kGapAbreast = 0.97, kGapAhead = 8;

/// Direction of a section's hair on the surface, unit; zero where it stands.
Vec2 hair_on_surface(const Cut& cut) {
    const Vec2 hair(glm::cross(cut.e, cut.m));
    const double size = glm::length(hair);
    return size > 1e-9 ? hair / size : Vec2{0};
}

/// `own`: section of the strip; `other`: of the neighbour at the same part of its hair, above the surface.
TouchingPart touching_part(const Cut& own, const Cut& other) {
    const Vec3 broad = own.broad();
    const Vec2 flat(broad), to_neighbour = other.centre - own.centre;
    const double half = Cut::kStripChord * glm::length(flat), distance = glm::length(to_neighbour);
    if (!(half > 1e-9) || !(distance > 1e-9)) return {};
    const double along = glm::dot(to_neighbour, flat) / glm::length(flat), touching = std::max(own.overlap(), 0.0);
    const double end = touching / std::max(touching - other.overlap(), 1e-12) * std::abs(along) / half;
    const double lies = glm::length(flat) / glm::length(broad);
    const double part = smooth_step((lies - kStandsAside) / (kLiesBeside - kStandsAside)) *
                        smooth_step((std::abs(along) / distance - kStandsAside) / (kLiesBeside - kStandsAside));
    return {std::lerp(1.0, std::min(end, kFarthest), part), along};
}

/// The neighbour that an outermost strip would have on its free side, by what is on its other side.
Cut extrapolate_cut(const Cut& own, const Cut& inner) {
    Cut cut = own;
    cut.centre += own.centre - inner.centre;
    cut.z = own.half_height() - 2 * own.overlap() + inner.overlap();
    return cut;
}

/// Bounds strips by where the underside between them and a neighbour that has not landed leaves the surface.
class RowLanding {
  public:
    RowLanding(Recycled<Trail>& trails, std::span<const Stretch> stretches, std::span<const BranchSurface> surfaces,
               std::span<const brush::Branch> branches, std::span<const StraightHair> straight)
        : trails_(trails),
          stretches_(stretches),
          surfaces_(surfaces),
          branches_(branches),
          straight_(straight),
          most_(surfaces.size(), -1.0) {
        for (const Trail& trail : trails)
            for (const Cut& cut : trail.cuts)
                largest_overlap(trail.branch) = std::max(largest_overlap(trail.branch), cut.overlap());
    }

    /// Trail k on the side of a neighbour.
    void bound(std::size_t k, int neighbour) {
        if (is_beside_toe(k, neighbour)) {
            bound_by_length(k, neighbour);
            return;
        }
        // Also beside a part of the neighbour that touches: it goes over into its own width as that lands.
        bound(k, neighbour, kFarthest, std::max(largest_overlap(neighbour), 0.0) / overlap_of(k),
              [](const Cut&, const Cut& beside) { return beside; });
    }
    /// Trail k, an outermost one, on its free side.
    void bound_beyond(std::size_t k, int inner) {
        if (largest_overlap(inner) >= 0)
            bound(k, inner, 1, overlap_of(k) / std::max(largest_overlap(inner), 1e-12), extrapolate_cut);
    }

  private:
    /// Whether a neighbour of trail k is in the air because its hair is shorter.
    bool is_beside_toe(std::size_t k, int neighbour) {
        const auto other = static_cast<std::size_t>(neighbour), own = static_cast<std::size_t>(trails_[k].branch);
        const double shorter = 1 - branches_[other].rest_length / branches_[own].rest_length;
        return largest_overlap(neighbour) < 0 && shorter > 0 && shorter < kSideBySide &&
               straight_[other].pressed < straight_[own].pressed;
    }

    /// Ends trail k where hair between it and a shorter neighbour would just touch if it were straight, at the foot of
    /// that hair: what touches so little is hardly bent.
    void bound_by_length(std::size_t k, int neighbour) {
        const StraightHair &own = straight_[static_cast<std::size_t>(trails_[k].branch)],
                           &other = straight_[static_cast<std::size_t>(neighbour)];
        const double thick = trails_[k].cuts.front().half_height(), touching = own.pressed + thick;
        const double part = std::clamp(touching / std::max(own.pressed - other.pressed, 1e-9), 0.0, 1.0);
        const Vec2 end = glm::mix(own.foot, other.foot, part);
        for (Cut& cut : trails_[k].cuts) {
            const Vec3 broad = cut.broad();
            const Vec2 flat(broad), hair = hair_on_surface(cut);
            const double size = glm::length(flat), half = Cut::kStripChord * size;
            if (!(half > 1e-9)) continue;
            const double across = std::abs(flat.x * hair.y - flat.y * hair.x) / size;
            const double lies = smooth_step((size / glm::length(broad) - kStandsAside) / (kLiesBeside - kStandsAside)) *
                                smooth_step((across - kGapAslant) / (kGapAbreast - kGapAslant));
            const bool hi = glm::dot(other.foot - own.foot, flat) > 0;
            const double over_half = std::abs(glm::dot(end - cut.centre, flat)) / (size * half);
            (hi ? cut.reach.y : cut.reach.x) = std::lerp(1.0, std::min(over_half, kFarthest), lies);
            const double ahead = glm::dot(end - cut.centre, hair);
            (hi ? cut.ahead_hi : cut.ahead_lo) = lies * std::clamp(ahead, -kGapAhead * half, kGapAhead * half) * hair;
        }
    }

    template <class OtherCut>
    void bound(std::size_t k, int neighbour, double farthest, double landed_part, OtherCut other_of) {
        const auto branch = static_cast<std::size_t>(neighbour),
                   own_branch = static_cast<std::size_t>(trails_[k].branch);
        const BranchSurface &surface = surfaces_[branch], &own_surface = surfaces_[own_branch];
        const double length = surface.from_tip(surface.end()), own_length = own_surface.from_tip(1e9);
        // Hair of one length at rest lies side by side at equal parts, of other lengths at equal distances from the
        // ferrule. Bent lengths, between centres of sections, differ from pose to pose.
        const bool one_length = branches_[branch].rest_length == branches_[own_branch].rest_length;
        const double longer = length - own_length;
        const double length_difference =
            one_length ? smooth_step(std::abs(longer) / (kOfOneLength * length))
                       : smooth_step((std::abs(longer) / length - kSideBySide) / (kApart - kSideBySide));
        const double landed = std::max(smooth_step(landed_part / kLanded), length_difference);
        if (landed >= 1) return;
        for (std::size_t i = 0; i < trails_[k].cuts.size(); ++i) {
            Cut& own = trails_[k].cuts[i];
            const double s = std::lerp(stretches_[k].begin, stretches_[k].end, sample_places()[i]);
            const double beside =
                one_length ? std::min(s, surface.end()) : surface.place(own_surface.from_tip(s) + longer);
            const Cut other = other_of(own, surface.at(beside));
            if (other.overlap() >= 0) continue;
            const TouchingPart to = touching_part(own, other);
            (to.side < 0 ? own.reach.x : own.reach.y) = std::lerp(std::min(to.over_half, farthest), 1.0, landed);
        }
    }
    double& largest_overlap(int branch) { return most_[static_cast<std::size_t>(branch)]; }
    double overlap_of(std::size_t k) { return std::max(largest_overlap(trails_[k].branch), 1e-12); }

    Recycled<Trail>& trails_;
    std::span<const Stretch> stretches_;
    std::span<const BranchSurface> surfaces_;
    std::span<const brush::Branch> branches_;
    std::span<const StraightHair> straight_;
    Recycled<double> most_;  // overlap of each branch, metres; −1: it does not touch
};

void bound_strips(RowLanding landing, std::span<const Trail> trails, std::span<const brush::Opening> neighbours) {
    for (std::size_t k = 0; k < trails.size(); ++k) {
        Recycled<int> beside;
        for (const brush::Opening& pair : neighbours)
            if (pair.first == trails[k].branch || pair.second == trails[k].branch)
                beside.push_back(pair.first == trails[k].branch ? pair.second : pair.first);
        for (const int branch : beside) landing.bound(k, branch);
        if (beside.size() == 1) landing.bound_beyond(k, beside.front());
    }
}

}  // namespace

Recycled<Trail> find_trails(const brush::TuftState& tuft, const Frame& frame, std::span<const NodePlanes> planes,
                            double length, double film) {
    Recycled<Trail> found;
    Recycled<Stretch> stretches;
    Recycled<BranchSurface> surfaces;
    const std::size_t count = tuft.branches.size();
    surfaces.reserve(count);
    const bool row = tuft.strips && count > 1;
    const Recycled<brush::Branch> bound = row ? bound_on_edge(tuft, frame, planes) : Recycled<brush::Branch>{};
    const Recycled<brush::Branch>& branches = row ? bound : tuft.branches;
    Recycled<StraightHair> straight(count);
    for (std::size_t k = 0; k < count; ++k) {
        const auto& sections = branches[k].sections;
        if (sections.size() < 2) continue;
        if (row) straight[k] = straight_hair(sections, k < planes.size() ? &planes[k] : nullptr, frame);
        const BranchSurface& surface = surfaces.emplace_back(
            branches[k], tuft.strips, frame, k < planes.size() ? &planes[k] : nullptr, std::max(film, 0.0));
        // The middle one of several branches goes on as the trunk.
        const bool carries = count > 1 && k == count / 2 && !tuft.wide;
        const double trunk = carries ? surface.at_section(tuft.branches[0].sections.size() - 1) : 1e9;
        // The hair of a wide ferrule differs in length.
        const double whole = tuft.wide && length > 0 ? surface.from_tip(surface.end()) / length : 1;
        for (const Stretch& stretch : touching_stretches(surface)) {
            Trail trail{.branch = static_cast<int>(k),
                        .cuts = {},
                        .along = {},
                        .length = whole,
                        .strip = tuft.strips,
                        .corners = tuft.branches[k].strip,
                        .edge_short = tuft.branches[k].edge_short,
                        .pressed = straight[k].pressed,
                        .foot = straight[k].foot};
            for (const brush::Opening& opening : tuft.openings)
                if (opening.first == trail.branch) trail.openings.push_back({opening.second, {}});
            trail.cuts.reserve(kSamples);
            trail.along.reserve(kSamples);
            for (const double f : sample_places()) {
                const double s = stretch.begin + f * (stretch.end - stretch.begin);
                trail.cuts.push_back(surface.at(s));
                trail.along.push_back(length > 0 ? whole - surface.from_tip(s) / length : 0);
                if (s < trunk) trail.trunk = trail.cuts.size();
                std::size_t next = 0;
                for (const brush::Opening& opening : tuft.openings)
                    if (opening.first == trail.branch)
                        trail.openings[next++].width.push_back(surface.value_at(s, opening.width));
            }
            found.push_back(std::move(trail));
            stretches.push_back(stretch);
        }
    }
    if (tuft.strips && surfaces.size() == count)
        bound_strips({found, stretches, surfaces, tuft.branches, straight}, found, tuft.openings);
    return found;
}

namespace {

constexpr double kTrackStep = 2.5e-5;  // metres between positions of a track
constexpr double kAboutAsWide = 0.1;   // of the widest section's half width
// Slope at which hair on the surface leaves a lifted tuft: friction holds it sideways, about that.
constexpr double kFanSlope = 0.35;
constexpr double kNarrowest = 0.2;  // of its width, the narrowest that a section becomes

/// Width at a position, linear between two of the track; `otherwise` where the track has none.
double width_at(const HairTracks::Track& track, double position, double otherwise) {
    const double at = position / kTrackStep - static_cast<double>(track.first), cell = std::floor(at);
    const auto value = [&](double i) {
        if (i < 0 || i >= static_cast<double>(track.width.size())) return otherwise;
        const float v = track.width[static_cast<std::size_t>(i)];
        return v < 0 ? otherwise : static_cast<double>(v);
    };
    return std::lerp(value(cell), value(cell + 1), at - cell);
}

/// Extends the track to the positions numbered lo to hi.
void reserve_positions(HairTracks::Track& track, long long lo, long long hi) {
    if (track.width.empty()) track.first = lo;
    if (lo < track.first) {
        track.width.insert(track.width.begin(), static_cast<std::size_t>(track.first - lo), -1.0f);
        track.first = lo;
    }
    const auto size = static_cast<std::size_t>(hi - track.first + 1);
    if (size > track.width.size()) track.width.resize(size, -1.0f);
}

/// Spreads cuts [begin, end) of a trail: those up to the widest are where the tuft is, and so is what never touched.
void follow_track(Trail& trail, std::size_t begin, std::size_t end, HairTracks::Track& track,
                  const SpreadOptions& options) {
    const auto position = [&](std::size_t i) { return options.slid - trail.along[i] * options.length; };
    std::size_t widest = end - 1;
    for (std::size_t i = end - 1; i-- > begin;)
        if (trail.cuts[i].a > trail.cuts[widest].a) widest = i;
    // Where it is about as wide: the widest section of all steps from node to node as the tuft is lifted.
    double weight = 0, front = 0;
    for (std::size_t i = begin; i < end; ++i) {
        const double run = position(std::min(i + 1, end - 1)) - position(i > begin ? i - 1 : begin);
        const double w = run * std::exp((trail.cuts[i].a / trail.cuts[widest].a - 1) / kAboutAsWide);
        weight += w;
        front += w * position(i);
    }
    front = weight > 0 ? front / weight : position(widest);
    const auto number = [](double p) { return static_cast<long long>(std::floor(p / kTrackStep)); };
    const long long last = number(position(end - 1)) + 1;
    reserve_positions(track, number(position(begin)), last);
    std::size_t i = begin;
    for (long long k = number(position(begin)); k <= last; ++k) {
        const double at = static_cast<double>(k) * kTrackStep;
        while (i + 2 < end && position(i + 1) < at) ++i;
        const double run = position(i + 1) - position(i);
        const double f = run > 0 ? std::clamp((at - position(i)) / run, 0.0, 1.0) : 0;
        float& width = track.width[static_cast<std::size_t>(k - track.first)];
        if (track.front_width >= 0 && at >= track.front && at < front) {
            const double g = (at - track.front) / (front - track.front);
            width = static_cast<float>(std::lerp(track.front_width, trail.cuts[widest].a, g));
        } else if (width < 0 || at >= front)
            width = static_cast<float>(std::lerp(trail.cuts[i].a, trail.cuts[i + 1].a, f));
    }
    track.front = front;
    track.front_width = trail.cuts[widest].a;
    if (options.amount == 0) return;
    for (std::size_t k = begin; k < end && position(k) < front; ++k) {
        Cut& cut = trail.cuts[k];
        const double width =
            std::min(width_at(track, position(k), cut.a), trail.cuts[widest].a + kFanSlope * (front - position(k)));
        const double grow = std::max(1 + options.amount * (width / std::max(cut.a, 1e-9) - 1), kNarrowest);
        cut.a *= grow;
        cut.b /= grow;
        // The same part of its height is on the surface.
        cut.z *= cut.z > 0 ? 1 / grow : 1;
    }
}

}  // namespace

void spread_trails(Recycled<Trail>& trails, HairTracks& tracks, const SpreadOptions& options) {
    for (Trail& trail : trails) {
        const auto own = 2 * static_cast<std::size_t>(trail.branch);
        if (tracks.tracks.size() < own + 2) tracks.tracks.resize(own + 2);
        const std::size_t trunk = std::min(trail.trunk, trail.cuts.size());
        if (trunk > 1) follow_track(trail, 0, trunk, tracks.tracks[own], options);
        if (trail.cuts.size() > trunk + 1)
            follow_track(trail, trunk, trail.cuts.size(), tracks.tracks[own + 1], options);
    }
}

void gather_trails(Recycled<Trail>& trails, double part) {
    for (Trail& trail : trails)
        for (Cut& cut : trail.cuts) {
            cut.a *= part;
            cut.b /= part;
        }
}

}  // namespace tuft::footprint
