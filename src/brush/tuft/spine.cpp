#include "brush/tuft/spine.h"

#include <algorithm>
#include <cmath>

#include "brush/rod/rod_points.h"
#include "brush/tuft/flanks.h"
#include "brush/tuft/tuft_sections.h"
#include "brush/tuft/upright_hair.h"

namespace tuft::brush {

namespace {

constexpr double kOnset = 5e-5;       ///< m, fuzz of the tuft's side
constexpr double kStraight = 1e-4;    ///< 1 - cos of a bend that is none yet, 0.8°
constexpr double kSeed = 0.05;        ///< radians, bend that grows if the load is beyond buckling
constexpr double kEndFriction = 0.2;  ///< of the fold of hair ends that carries the tip along
constexpr int kContactPoints = 6;     ///< per segment: a patch then grows smoothly with depth

void set_time(const Preset& p, double dt, rod::Law& law) {
    law.joints.damping = dt > 0 ? p.damping / dt : 0;
    law.joints.recovery = p.recovery > 0 ? dt / p.recovery : 0;
}

}  // namespace

rod::Law law_of(const Preset& p, double wetness, double share, double dt) {
    const double unit = p.stiffness / std::pow(p.length, 4);
    rod::Law law;
    law.points_per_segment = kContactPoints;
    law.normal.stiffness = p.transverse_stiffness / unit / share;
    law.normal.core_stiffness = p.core_stiffness * law.normal.stiffness;
    law.normal.core_start = p.core_start;
    law.normal.onset = kOnset / p.length;
    law.friction.end_share = kEndFriction;
    law.edge = kEdgeRounding / p.length;
    law.normal.end_compliance = p.end_compliance / p.length;
    set_time(p, dt, law);
    law.adhesion.strength = wetness * p.adhesion / (unit * p.length) / share;
    law.adhesion.range = p.adhesion_range / p.length;
    law.friction.coefficient = p.friction_dry + (p.friction_wet - p.friction_dry) * wetness;
    law.friction.grain = p.grain;
    law.friction.with_hair = p.with_hair;
    law.friction.pore_grip = p.pore_grip;
    law.friction.stick_stiffness = p.stick * law.normal.stiffness;
    law.limits.tolerance = 1e-6;
    law.limits.max_iterations = 60;
    law.limits.max_passes = 8;
    return law;
}

namespace {

/// Energy of the bend s² of a straight rod, B0/L.
double unit_bend(const rod::Rod& rod) {
    double s = 0, before = 0, sum = 0;
    for (std::size_t j = 0; j < rod.length.size(); ++j) {
        s += rod.length[j];
        sum += 0.5 * rod.stiffness[j] * (s * s - before) * (s * s - before);
        before = s * s;
    }
    return sum;
}

}  // namespace

void break_symmetry(const Preset& p, Spine& spine, const Pose& from, const Pose& to,
                    std::span<const ContactPlane> planes, const StraightHair& upright) {
    if (planes.empty()) return;
    const Vec3 axis = spine.memory.clamp.tangent;
    for (const Vec3& t : spine.memory.tangent) {
        if (glm::dot(t, axis) < 1 - kStraight) return;
    }
    const ContactPlane& at_tip = planes.front();
    const double along = glm::dot(to.axis(), at_tip.normal);
    const double under = spine.rest.radius.back() - glm::dot(upright.tip - at_tip.origin, at_tip.normal);
    if (along > -0.9999 || under < 0) return;
    Vec3 aside = from.position - to.position;
    aside -= glm::dot(aside, to.axis()) * to.axis();
    const Quat back = from.rotation * glm::conjugate(to.rotation);
    aside = glm::length(aside) > 1e-3 * glm::length(to.position - from.position) + 1e-9 ? glm::normalize(back * aside)
                                                                                        : from.rotation * upright.aside;
    if (upright.taken != Vec3{0}) aside = upright.taken;
    // Bend angle ε s² that takes the tip back up to the surface: the tip rises by L ε²/10. But buckling
    // makes no energy: it holds what the contact held and what the hand does in the step.
    double angle = std::clamp(std::sqrt(10 * under / p.length), kSeed, 0.6);
    const double needed = angle * angle * unit_bend(spine.rod);
    const double there = 2 * std::max(0.0, spine.pressed);
    if (needed > there) angle = std::max(kSeed, angle * std::sqrt(there / needed));
    double s = 0;
    for (std::size_t j = 0; j < spine.memory.tangent.size(); ++j) {
        s += spine.rod.length[j];
        spine.memory.tangent[j] = glm::normalize(axis + std::tan(angle * s * s) * aside);
    }
}

namespace {

/// Planes of a spine's nodes (tip first) as obstacles of its rod (root first).
Recycled<rod::Obstacle> obstacles_of(const Preset& p, const Spine& spine, std::span<const ContactPlane> planes) {
    return obstacles_from(p, spine, planes, [&](std::size_t i, const Vec3&) { return spine.rest.radius[i]; });
}

/// Walls beside a spine and across from it where its ferrule is turned by `rotation`.
Recycled<rod::Wall> walls_of(const SpineStep& step, const Spine& spine, const Quat& rotation) {
    Recycled<rod::Wall> out = flank_walls(step.preset, spine, rotation, step.walls, step.wetness);
    if (!step.across.empty()) add_walls_across(obstacles_of(step.preset, spine, step.across), out);
    return out;
}

}  // namespace

rod::Clamp clamp_of(const Preset& p, const Pose& pose) {
    return {pose.position / p.length, pose.axis(), pose.rotation * Vec3{1, 0, 0}};
}

Spine make_spine(const Preset& p, const rod::Rod& rod, const rod::Clamp& clamp, double xi0, double share) {
    Spine spine;
    spine.rod = rod;
    spine.memory = rod::make_memory(rod, clamp);
    double s = xi0;
    for (int i = 0; i <= rod.segments(); ++i) {
        spine.rest.radius.push_back(rest_radius(p, s) / std::sqrt(share));
        if (i < rod.segments()) s += rod.length[i];
    }
    return spine;
}

SolvedSpine finish_spine(const SpineStep& step, Spine& spine, SolvedRod rod, const Neighbours& neighbours) {
    SolvedSpine out{std::move(rod.result), {}};
    const std::span<const rod::Obstacle> met = out.result.met.empty() ? rod.obstacles : out.result.met;
    SectionOutput sections = make_sections({step.preset, spine, out.result, met, rod.node, step.rotation, step.wetness,
                                            step.share, step.walls, neighbours, rod.along, rod.broad});
    spine.sides.position = std::move(sections.sides);
    spine.sides.flank = std::move(sections.flank);
    spine.sides.direction = sections.wide;
    spine.sides.shift = std::move(sections.aside);
    spine.sides.slips = std::move(sections.slips);
    out.spread_energy = sections.spread_energy;
    out.aside_gain = sections.aside_energy - spine.sides.energy;
    spine.sides.energy = sections.aside_energy;
    out.branch.sections = std::move(sections.sections);
    return out;
}

SolvedSpine solve_spine(const SpineStep& step, Spine& spine, const PathWork& passed, const rod::Guess* guess) {
    const Preset& p = step.preset;
    const rod::Law law = law_of(p, step.wetness, step.share, step.dt);
    const Recycled<rod::Obstacle> obstacles = obstacles_of(p, spine, step.planes);
    rod::Result result =
        rod::solve(spine.rod, spine.memory, step.clamp,
                   {.obstacles = obstacles, .law = law, .walls = walls_of(step, spine, step.rotation), .guess = guess});
    spine.pressed = result.contact_energy;
    result.dissipation += passed.dissipation;
    result.work += passed.work;
    for (std::size_t i = 0; i < passed.slip.size(); ++i) result.slip[i] += passed.slip[i];
    const Recycled<Vec3> node = rod::curve_nodes(spine.rod, spine.memory.node);
    return finish_spine(step, spine, {std::move(result), node, obstacles});
}

namespace {

/// Largest move of the ferrule in one solve, in lengths, turns counted at one length: hair
/// that stands nearly straight must be followed closely, or it falls to the wrong side.
constexpr double kCareful = 0.006, kOrdinary = 0.03;
constexpr double kLaid = 0.8;      ///< bend from which the hair lies as it will, radians
constexpr double kTeleport = 0.5;  ///< lengths; a further jump is no motion to follow
constexpr int kMaxParts = 8;
constexpr int kPassesOnTheWay = 2;  ///< over the normal forces; the last part passes on until they settle

}  // namespace

int count_substeps(const Preset& p, const Pose& from, const Pose& to, double bend) {
    const double turned = 2 * std::acos(std::min(1.0, std::abs(glm::dot(from.rotation, to.rotation))));
    const double moved = glm::length(to.position - from.position) / p.length + turned;
    if (moved >= kTeleport) return 1;
    const double largest = bend < kLaid ? kCareful : kOrdinary;
    return std::clamp(static_cast<int>(std::ceil(moved / largest)), 1, kMaxParts);
}

namespace {

/// Upright hair's end and where straight hair points at a pose.
StraightHair upright_at(const Preset& p, const Pose& pose) {
    return {.tip = pose.position + p.length * pose.axis()};
}

/// Moves the spine to just before the last of `parts` parts of the motion. Returns the pose where that part begins.
Pose follow_parts(const SpineStep& step, Spine& spine, const Pose& from, const Pose& to, int parts, PathWork& passed) {
    const Preset& p = step.preset;
    rod::Law law = law_of(p, step.wetness, 1, 0);
    law.limits.max_iterations = std::max(30, law.limits.max_iterations / parts);
    law.limits.max_passes = kPassesOnTheWay;
    set_time(p, step.dt, law);
    Pose last = from;
    for (int k = 1; k < parts; ++k) {
        const Pose pose = interpolate(from, to, static_cast<double>(k) / parts);
        turn_with_spread(p, spine, last, pose, step.planes);
        break_symmetry(p, spine, last, pose, step.planes, upright_at(p, pose));
        const rod::Result r = rod::solve(spine.rod, spine.memory, clamp_of(p, pose),
                                         {.obstacles = obstacles_of(p, spine, step.planes),
                                          .law = law,
                                          .walls = walls_of(step, spine, pose.rotation)});
        spine.pressed = r.contact_energy;
        passed.dissipation += r.dissipation;
        passed.work += r.work;
        passed.slip.resize(r.slip.size(), Vec3{0});
        for (std::size_t i = 0; i < r.slip.size(); ++i) passed.slip[i] += r.slip[i];
        last = pose;
    }
    return last;
}

}  // namespace

PathWork follow_ferrule(SpineStep& step, Spine& spine, const Pose& from, const Pose& to, StepStart* start) {
    const Preset& p = step.preset;
    PathWork passed;
    if (step.planes.empty()) return passed;
    Pose last = from;
    if (start && start->known && start->in_parts) {
        spine = start->spines.front();
        last = start->from;
        step.dt = start->dt;
        passed.dissipation = start->dissipation;
        passed.slip = start->slip.front();
    } else {
        const double bend =
            std::acos(std::clamp(glm::dot(spine.memory.tangent.back(), spine.memory.clamp.tangent), -1.0, 1.0));
        const int parts = count_substeps(p, from, to, bend);
        step.dt /= parts;
        last = follow_parts(step, spine, from, to, parts, passed);
        if (start) start->in_parts = parts > 1;
        if (start && parts > 1) {
            start->spines.assign(1, spine);
            start->from = last;
            start->dt = step.dt;
            start->dissipation = passed.dissipation;
            start->slip.assign(1, passed.slip);
        }
    }
    turn_with_spread(p, spine, last, to, step.planes);
    break_symmetry(p, spine, last, to, step.planes, upright_at(p, to));
    return passed;
}

namespace {

/// Unit direction across the clamp in which the tip bends: where it is, seen from the clamp's axis.
Vec3 bending_side(const rod::Clamp& clamp, const Vec3& root_before, const Vec3& tip_before) {
    Vec3 side = tip_before - clamp.position;
    side -= glm::dot(side, clamp.tangent) * clamp.tangent;
    side = glm::length(side) > 1e-9 ? glm::normalize(side) : clamp.side;
    const Vec3 moved_by = clamp.position - root_before;
    if (glm::dot(side, moved_by) > 0.999 * glm::length(moved_by) && glm::length(moved_by) > 1e-9) {
        // Pushed straight ahead of the hand a tractrix balances; the hair gives way to one side.
        side = glm::normalize(side + 0.03 * glm::cross(clamp.tangent, side));
    }
    return side;
}

/// Adds the reaction R of the surface at the tip: lever × R is the root moment of the table. Friction is μ R against
/// the slip of the tip.
void add_reaction(const Spine& spine, const Recycled<rod::Obstacle>& obstacles, double root_moment, double friction,
                  const Vec3& tip_before, rod::Result& r) {
    const rod::Memory& m = spine.memory;
    const rod::Obstacle& o = obstacles.back();
    Vec3 lever = m.node.back() - m.clamp.position;
    lever -= glm::dot(lever, o.normal) * o.normal;
    const double reaction = root_moment / std::max(glm::length(lever), 0.1);
    Vec3 slip = m.node.back() - tip_before;
    slip -= glm::dot(slip, o.normal) * o.normal;
    const double moved = glm::length(slip);
    r.force = reaction * o.normal;
    if (moved > 1e-9) r.force -= friction * reaction / moved * slip;
    r.root_moment = glm::cross(m.node.back() - m.clamp.position, r.force);
    // Where the side of the tuft lies on the surface it shares the load.
    double sum = 0;
    for (std::size_t i = 1; i < m.node.size(); ++i) {
        const rod::Obstacle& at = obstacles[i];
        const double depth = at.radius - glm::dot(m.node[i] - at.origin, at.normal);
        r.normal_force[i] = spine.rod.weight[i] * std::max(0.0, depth);
        sum += r.normal_force[i];
    }
    for (double& f : r.normal_force) f *= sum > 0 ? reaction / sum : 0;
}

}  // namespace

SolvedSpine bend_by_table(const SpineStep& step, const QueryTable& table, Spine& spine) {
    const Preset& p = step.preset;
    const rod::Clamp& clamp = step.clamp;
    const rod::Law law = law_of(p, step.wetness, 1, 0);
    const Recycled<rod::Obstacle> obstacles = obstacles_of(p, spine, step.planes);
    rod::Memory& m = spine.memory;
    const Vec3 root_before = m.clamp.position;
    const Vec3 tip_before = rod::nodes(spine.rod, m).back();
    rod::move_with_clamp(m, clamp);
    const std::size_t n = m.tangent.size();
    rod::Result r;
    r.converged = true;
    r.moment.assign(n, 0);
    r.normal_force.assign(n + 1, 0);
    r.contact_force.assign(n + 1, Vec3{0});
    const auto take_shape = [&](const TableRow& row, const Vec3& side) {
        for (std::size_t i = 0; i <= n; ++i) {
            const Vec2 b = row.nodes[n - i] / p.length;
            m.node[i] = clamp.position + b.x * clamp.tangent + b.y * side;
        }
        for (std::size_t j = 0; j < n; ++j) m.tangent[j] = glm::normalize(m.node[j + 1] - m.node[j]);
    };
    const Vec3 side = bending_side(clamp, root_before, tip_before);
    if (obstacles.empty()) {
        take_shape(table.rows.front(), side);
        return finish_spine(step, spine, {std::move(r), m.node, obstacles});
    }
    const rod::Obstacle& o = obstacles.back();
    const double root = glm::dot(clamp.position - o.origin, o.normal) * p.length;
    const double moment = touching_moment(table, root, {glm::dot(clamp.tangent, o.normal), glm::dot(side, o.normal)});
    const TableRow row = look_up(table, moment);
    take_shape(row, side);
    if (moment > 0) {
        const double unit = p.stiffness / p.length;
        for (std::size_t j = 0; j < n; ++j) r.moment[j] = row.moments[n - j] / unit;
        add_reaction(spine, obstacles, moment / unit, law.friction.coefficient, tip_before, r);
    }
    return finish_spine(step, spine, {std::move(r), m.node, obstacles});
}

}  // namespace tuft::brush
