#include "brush/papers/macro/hair_macro.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "brush/papers/space/frames.h"
#include "brush/preset/rest_shape.h"
#include "brush/rod/profile.h"

namespace tuft::brush::macro {

namespace {

constexpr double kFinestRadius = 1e-6;  ///< m, of the tuft's point
constexpr double kLies = 10;            ///< weight of the lying hair in the fit of the skeleton [X]
constexpr double kTipLies = 3000;       ///< the same of its tip [X]
constexpr double kStands = 1e-3;        ///< sine of the lean below which a profile cannot be level

Vec3 to_world(const Pose& pose, const Vec3& p) {
    return pose.position + pose.rotation * p;
}

/// Frames of the nodes: e is the ferrule's x, transported along the skeleton.
Recycled<Section> frames_of(std::span<const Vec3> nodes, const Pose& pose) {
    return frame_sections(nodes, pose.axis(), nodes.size() - 1, pose.rotation * Vec3{1, 0, 0});
}

double widening_at(const HairMacro& m, double t, const MacroLaw& law) {
    return std::clamp(value(m.widening, t), m.rest.axes.l, law.flattest * m.rest.axes.l);
}

/// Profile at t in units of r.
Ellipse profile_at(const HairMacro& m, double t, const MacroLaw& law, double growth) {
    const double widening = widening_at(m, t, law);
    return {growth * widening, growth * m.rest.share / widening};
}

/// The angle nearest to `reference` among `angle` + k π.
double nearest_half_turn(double angle, double reference) {
    return angle + std::numbers::pi * std::round((reference - angle) / std::numbers::pi);
}

/// What (5.4) asks of the profiles, along the nodes.
struct Flattening {
    std::vector<double> least_widening;  ///< λ
    std::vector<double> turn;            ///< θ
    bool touching = false;
};

/// Profiles below their surface: level, and flattened as far as it takes.
Flattening flattening_of(const HairMacro& m, const HairRow& row, const MacroLaw& law, std::span<const Section> frames,
                         std::span<const HalfSpace> above) {
    const std::size_t count = frames.size();
    Flattening f{std::vector<double>(count, m.rest.axes.l), std::vector<double>(count), false};
    double turn = value(m.turn, 0);
    for (std::size_t i = 0; i < count; ++i) {
        const Section& s = frames[i];
        const Vec3& n = above[i].normal;
        const Vec3 level = glm::cross(s.tangent, n);
        const double lean = glm::length(level), z = std::max(0.0, above[i].height(s.centre));
        const double minor = profile_at(m, row.t[i], law, 1).s;
        f.turn[i] = turn;
        if (lean < kStands || z > minor * lean * row.radius[i]) continue;
        turn = nearest_half_turn(std::atan2(glm::dot(level, s.m), glm::dot(level, s.e)),
                                 f.touching ? turn : value(m.turn, row.t[i]));
        f.touching = true;
        f.turn[i] = turn;
        // Hair that stands is not pressed flat: the lean scales how far.
        const double least = m.rest.axes.s * (1 - (1 - 1 / law.flattest) * lean);
        const double pressed = pressed_axis(minor, z / (lean * row.radius[i]), least);
        f.least_widening[i] = m.rest.share / pressed;
    }
    return f;
}

void flatten(HairMacro& m, const HairRow& row, const MacroLaw& law, const Pose& pose,
             std::span<const ContactPlane> planes) {
    const std::vector<Vec3> nodes = nodes_of(m.skeleton, row);
    const std::vector<HalfSpace> above = half_spaces(planes, nodes);
    if (above.empty()) return;
    const Flattening f = flattening_of(m, row, law, frames_of(nodes, pose), above);
    if (!f.touching) return;
    std::vector<double> target;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        target.push_back(std::max(f.least_widening[i], value(m.widening, row.t[i])));
    // The ferrule holds its hair together, and less so the further the hair is from it.
    m.widening = fit_spline({row.t, row.weight, target, f.least_widening, m.rest.axes.l, true});
    m.turn = fit_spline({row.t, row.weight, f.turn});
}

double friction_hold(const HairMacro& m, const MacroLaw& law, const Vec3& along, const Vec3& push) {
    return (1 - recovery_extent(std::abs(m.stress), law.recovery)) * std::max(0.0, glm::dot(along, push));
}

CurveSpline fitted(const HairRow& row, std::span<const Vec3> nodes, std::span<const HalfSpace> above, const Vec3& root,
                   const Vec3& direction) {
    return fit_curve({row.t, row.weight, nodes, above, root, direction, row.length});
}

/// The fit of (5.3f). Four control points cannot follow the bend where the hair comes to lie. What lies weighs more,
/// and its tip most, so that the lying hair does not rise again towards the tip.
CurveSpline fitted_to_contact(const HairRow& row, const BentSkeleton& bent, std::span<const HalfSpace> above,
                              const Vec3& root, const Vec3& direction) {
    std::vector<double> weight = row.weight;
    for (std::size_t i = 0; i < weight.size() && row.t[i] < bent.touch; ++i) weight[i] *= i == 0 ? kTipLies : kLies;
    return fit_curve({row.t, weight, bent.nodes, above, root, direction, row.length});
}

}  // namespace

std::vector<Vec3> nodes_of(const CurveSpline& skeleton, const HairRow& row) {
    std::vector<Vec3> nodes;
    nodes.reserve(row.t.size());
    for (const double t : row.t) nodes.push_back(value(skeleton, t));
    return nodes;
}

HairRow make_hair_row(const Preset& p) {
    HairRow row{.length = p.length};
    std::vector<double> segment = spine_segments(p.segments, 0.25 + 0.75 * p.hardness);
    std::reverse(segment.begin(), segment.end());
    double t = 0;
    for (std::size_t i = 0; i <= segment.size(); ++i) {
        const double before = i > 0 ? segment[i - 1] : 0, after = i < segment.size() ? segment[i] : 0;
        if (i == segment.size()) t = 1;
        row.t.push_back(t);
        row.weight.push_back(0.5 * (before + after));
        row.radius.push_back(std::max(rest_radius(p, 1 - t), kFinestRadius));
        t += after;
    }
    return row;
}

MacroLaw make_macro_law(const Preset& p) {
    MacroLaw law;
    law.rigidity = p.hardness;
    law.flattest = std::max(1.0, p.flatten_max);
    return law;
}

HairMacro make_macro(const HairRow& row, const Pose& pose) {
    HairMacro m;
    for (int k = 0; k < 4; ++k) m.rest.skeleton[k] = Vec3{0, 0, -row.length * (3 - k) / 3.0};
    return at_rest(m, pose);
}

HairMacro at_rest(const HairMacro& macro, const Pose& pose) {
    HairMacro m;
    m.rest = macro.rest;
    for (int k = 0; k < 4; ++k) m.skeleton[k] = to_world(pose, m.rest.skeleton[k]);
    m.widening.fill(m.rest.axes.l);
    m.turn.fill(m.rest.turn);
    return m;
}

void move_rigidly(HairMacro& m, const Pose& from, const Pose& to) {
    const Quat back = glm::conjugate(from.rotation);
    for (Vec3& p : m.skeleton) p = to_world(to, back * (p - from.position));
}

void recover(HairMacro& m, const Pose& pose, const MacroLaw& law, double dt) {
    const double x = recovery_extent(std::abs(m.stress), law.recovery, dt);
    if (x <= 0) return;
    const HairMacro rest = at_rest(m, pose);
    for (int k = 0; k < 4; ++k) {
        m.skeleton[k] = x < 1 ? glm::mix(m.skeleton[k], rest.skeleton[k], x) : rest.skeleton[k];
        m.widening[k] += x * (rest.widening[k] - m.widening[k]);
        if (!m.rest.round()) m.turn[k] += x * (nearest_half_turn(rest.turn[k], m.turn[k]) - m.turn[k]);
    }
}

void collide(HairMacro& m, const HairRow& row, const MacroLaw& law, const Collision& c) {
    const std::vector<Vec3> nodes = nodes_of(m.skeleton, row);
    const std::vector<HalfSpace> above = half_spaces(c.planes, nodes);
    BentSkeleton bent =
        deform_skeleton(nodes, row.t, above, {.rigidity = law.rigidity, .aside = c.aside, .trunk = c.trunk});
    m.touching = bent.touching;
    if (bent.touching) {
        add_kink(bent, row.t, above, row.length, friction_hold(m, law, bent.along, c.push));
        m.skeleton = fitted_to_contact(row, bent, above, to_world(c.pose, m.rest.skeleton[3]), c.pose.axis());
    }
    flatten(m, row, law, c.pose, c.planes);
}

namespace {

/// τ of each profile without growth.
std::vector<int> profile_turns(const HairMacro& m, const HairRow& row, const MacroLaw& law) {
    std::vector<int> turns;
    turns.reserve(row.t.size());
    for (const double t : row.t) turns.push_back(least_stress(m.rest.axes, profile_at(m, t, law, 1), law.stress).turn);
    return turns;
}

double stress_at(const HairMacro& m, const HairRow& row, const MacroLaw& law, std::span<const int> turns,
                 double growth) {
    double sum = 0;
    for (std::size_t i = 0; i < row.t.size(); ++i)
        sum += row.weight[i] * mean_stress(m.rest.axes, profile_at(m, row.t[i], law, growth), turns[i], law.stress);
    return sum;
}

}  // namespace

double macro_stress(const HairMacro& m, const HairRow& row, const MacroLaw& law, double growth) {
    return stress_at(m, row, law, profile_turns(m, row, law), growth);
}

void distend(HairMacro& m, const HairRow& row, const MacroLaw& law) {
    const std::vector<int> turns = profile_turns(m, row, law);
    const auto excess = [&](double g) { return g - 2 * distensibility(stress_at(m, row, law, turns, g), law.stress); };
    constexpr int kMost = 60;
    constexpr double kClose = 1e-10;
    double low = 1e-3, high = 2, at_low = excess(low), at_high = excess(high), g = 1, at = excess(1);
    int side = 0;
    for (int i = 0; i < kMost && std::abs(at) > kClose && high - low > kClose; ++i) {
        // Regula falsi; an end that stays twice counts half (Illinois).
        (at < 0 ? low : high) = g;
        (at < 0 ? at_low : at_high) = at;
        const int now = at < 0 ? -1 : 1;
        if (i > 0 && now == side) (now < 0 ? at_high : at_low) *= 0.5;
        side = now;
        g = (low * at_high - high * at_low) / (at_high - at_low);
        at = excess(g);
    }
    m.growth = g;
    m.stress = stress_at(m, row, law, turns, g);
}

Recycled<Section> macro_sections(const HairMacro& m, const HairRow& row, const MacroLaw& law, const Pose& pose,
                                 std::span<const ContactPlane> planes) {
    std::vector<Vec3> nodes = nodes_of(m.skeleton, row);
    const std::vector<HalfSpace> above = half_spaces(planes, nodes);
    // What the solver left below, a rounding, and all of it where the root is below.
    for (std::size_t i = 0; i + 1 < nodes.size() && !above.empty(); ++i) nodes[i] = above[i].projected(nodes[i]);
    Recycled<Section> sections = frames_of(nodes, pose);
    for (std::size_t i = 0; i < sections.size(); ++i) {
        Section& s = sections[i];
        const double turn = value(m.turn, row.t[i]);
        s.e = glm::normalize(std::cos(turn) * s.e + std::sin(turn) * s.m);
        s.m = glm::cross(s.e, s.tangent);
        const Ellipse profile = profile_at(m, row.t[i], law, m.growth);
        s.a = row.radius[i] * profile.l;
        s.b = row.radius[i] * profile.s;
    }
    return sections;
}

namespace {

/// The profile with the highest point stress, and its groups.
struct WorstProfile {
    std::size_t node = 0;
    std::vector<StressGroup> groups;
};

WorstProfile worst_profile(const HairMacro& m, const HairRow& row, const MacroLaw& law, double threshold) {
    WorstProfile worst;
    double most = threshold;
    for (std::size_t i = 0; i < row.t.size(); ++i) {
        const std::vector<StressGroup> groups = stress_groups(m.rest.axes, profile_at(m, row.t[i], law, m.growth),
                                                              threshold, law.least_share / m.rest.share, law.stress);
        double highest = 0;
        for (const StressGroup& g : groups) highest = std::max(highest, g.stress);
        if (highest <= most * (1 + 1e-9)) continue;
        most = highest;
        worst = {i, groups};
    }
    return worst;
}

/// Rays of the groups of highest stress, and what remains; nothing when that is too little.
std::vector<Rays> divide(const WorstProfile& worst, double least_share) {
    double most = 0;
    for (const StressGroup& g : worst.groups) most = std::max(most, g.stress);
    std::vector<Rays> parts;
    StressGroup rest;
    rest.rays.fill(true);
    for (const StressGroup& g : worst.groups) {
        if (g.stress < most * (1 - 1e-9)) continue;
        parts.push_back(g.rays);
        for (int k = 0; k < kRays; ++k) rest.rays[k] = rest.rays[k] && !g.rays[k];
    }
    if (parts.empty() || rest.share() < least_share) return {};
    parts.push_back(rest.rays);
    return parts;
}

/// Undeformed part: the same sectors of the undeformed profile, whose l lies at `turn`.
MacroRest part_at_rest(const MacroRest& parent, const Rays& rays, const HairRow& row, double turn) {
    const GroupEllipse g = group_ellipse(rays, parent.axes);
    MacroRest rest;
    const Vec2 l{std::cos(turn), std::sin(turn)}, s{-l.y, l.x};
    rest.offset = parent.offset + g.centre.x * l + g.centre.y * s;
    rest.axes = g.axes;
    rest.share = parent.share * g.share;
    rest.turn = turn + g.turn;
    std::vector<Vec3> nodes;
    for (std::size_t i = 0; i < row.t.size(); ++i)
        nodes.emplace_back(row.radius[i] * rest.offset, -row.length * (1 - row.t[i]));
    rest.skeleton = fitted(row, nodes, {}, nodes.back(), {0, 0, -1});
    return rest;
}

HairMacro part_of(const HairMacro& parent, const Rays& rays, const HairRow& row, const MacroLaw& law,
                  const Collision& c, double turn) {
    HairMacro m;
    m.rest = part_at_rest(parent.rest, rays, row, turn);
    m.growth = parent.growth;
    m.stress = parent.stress;
    m.touching = parent.touching;
    const Recycled<Section> sections = macro_sections(parent, row, law, c.pose, c.planes);
    std::vector<Vec3> nodes;
    std::vector<double> widening, turns;
    for (std::size_t i = 0; i < row.t.size(); ++i) {
        const Section& s = sections[i];
        const GroupEllipse g = group_ellipse(rays, profile_at(parent, row.t[i], law, 1));
        const Vec2 from_centre = parent.growth * row.radius[i] * g.centre;
        nodes.push_back(s.centre + from_centre.x * s.e + from_centre.y * s.m);
        widening.push_back(g.axes.l);
        turns.push_back(value(parent.turn, row.t[i]) + g.turn);
    }
    m.widening = fit_spline({.t = row.t, .weight = row.weight, .target = widening, .root = m.rest.axes.l});
    m.turn = fit_spline({row.t, row.weight, turns});
    m.skeleton = fitted(row, nodes, half_spaces(c.planes, nodes), to_world(c.pose, m.rest.skeleton[3]), c.pose.axis());
    return m;
}

}  // namespace

std::vector<HairMacro> split(const HairMacro& macro, const HairRow& row, const MacroLaw& law, double threshold,
                             const Collision& collision) {
    const WorstProfile worst = worst_profile(macro, row, law, threshold);
    std::vector<HairMacro> parts;
    // A circle has no axes of its own: those of the deformed profile are its.
    const double turn = macro.rest.round() ? value(macro.turn, row.t[worst.node]) : macro.rest.turn;
    for (const Rays& rays : divide(worst, law.least_share / macro.rest.share))
        parts.push_back(part_of(macro, rays, row, law, collision, turn));
    const Vec2 l{std::cos(turn), std::sin(turn)};
    std::stable_sort(parts.begin(), parts.end(), [&](const HairMacro& a, const HairMacro& b) {
        return glm::dot(a.rest.offset, l) < glm::dot(b.rest.offset, l);
    });
    return parts;
}

}  // namespace tuft::brush::macro
