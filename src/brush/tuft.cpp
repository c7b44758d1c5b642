#include "brush/tuft.h"

#include <algorithm>
#include <cmath>

#include "brush/tuft_sections.h"
#include "core/error.h"

namespace tuft::brush {

namespace {

constexpr double kBranchPoint = 2.0 / 3;  ///< share of the length below which the tuft never splits
constexpr int kTwigs = 3;
constexpr double kOnset = 5e-5;    ///< m, fuzz of the tuft's side
constexpr int kContactPoints = 3;  ///< per segment: a patch then grows smoothly with depth

rod::Clamp clamp_of(const Preset& p, const Pose& pose) {
    return {pose.position / p.length, pose.axis(), pose.rotation * Vec3{1, 0, 0}};
}

/// The preset's contact law in units of L and B0.
rod::Law law_of(const Preset& p, double wetness, double share) {
    const double unit = p.stiffness / std::pow(p.length, 4);
    rod::Law law;
    law.points_per_segment = kContactPoints;
    law.stiffness = p.transverse_stiffness / unit / share;
    law.core_stiffness = p.core_stiffness * law.stiffness;
    law.core_start = p.core_start;
    law.onset = kOnset / p.length;
    law.adhesion = wetness * p.adhesion / (unit * p.length) / share;
    law.adhesion_range = p.adhesion_range / p.length;
    law.friction = p.friction_dry + (p.friction_wet - p.friction_dry) * wetness;
    law.grain = p.grain;
    law.with_hair = p.with_hair;
    law.pore_grip = p.pore_grip;
    law.stick_stiffness = p.stick * law.stiffness;
    law.tolerance = 1e-6;
    law.max_iterations = 60;
    law.max_passes = 8;
    return law;
}

/// Index, from the root, of the node where sub-spines leave.
int branch_node(const rod::Rod& rod) {
    double s = 0;
    int i = 0;
    while (i + 2 < rod.segments() && s + 0.5 * rod.length[i] < kBranchPoint) s += rod.length[i++];
    return i;
}

/// Nearly straight hair pressed along its axis could fall to any side: it falls behind the
/// hand's motion, or to the ferrule's x-axis when the hand only presses.
void break_symmetry(const Preset& p, Spine& spine, const Pose& from, const Pose& to,
                    std::span<const ContactPlane> planes) {
    if (planes.empty()) return;
    const Vec3 axis = spine.memory.clamp.tangent;
    for (const Vec3& t : spine.memory.tangent) {
        if (glm::dot(t, axis) < 1 - 1e-7) return;
    }
    const ContactPlane& at_tip = planes.front();
    const Vec3 tip = to.position + p.length * to.axis();
    const double along = glm::dot(to.axis(), at_tip.normal);
    if (along > -0.9999 || glm::dot(tip - at_tip.origin, at_tip.normal) > 0) return;
    Vec3 aside = from.position - to.position;
    aside -= glm::dot(aside, to.axis()) * to.axis();
    const Quat back = from.rotation * glm::conjugate(to.rotation);
    aside = glm::length(aside) > 1e-3 * glm::length(to.position - from.position) + 1e-9
                ? glm::normalize(back * aside)
                : from.rotation * Vec3{1, 0, 0};
    // Bend angle ε s² that takes the tip back up to the surface: the tip rises by L ε²/10.
    const double under = -glm::dot(tip - at_tip.origin, at_tip.normal) / p.length;
    const double angle = std::clamp(std::sqrt(10 * under), 0.02, 0.6);
    double s = 0;
    for (std::size_t j = 0; j < spine.memory.tangent.size(); ++j) {
        s += spine.rod.length[j];
        spine.memory.tangent[j] = glm::normalize(axis + std::tan(angle * s * s) * aside);
    }
}

Spine make_spine(const Preset& p, const rod::Rod& rod, const rod::Clamp& clamp, double xi0,
                 double share) {
    Spine spine;
    spine.rod = rod;
    spine.memory = rod::make_memory(rod, clamp);
    double s = xi0;
    for (int i = 0; i <= rod.segments(); ++i) {
        spine.rest_radius.push_back(rest_radius(p, s) / std::sqrt(share));
        if (i < rod.segments()) s += rod.length[i];
    }
    return spine;
}

/// Planes of a spine's nodes (tip first) as obstacles of its rod (root first).
std::vector<rod::Obstacle> obstacles_of(const Preset& p, const Spine& spine,
                                        std::span<const ContactPlane> planes) {
    const std::size_t count = spine.rest_radius.size();
    std::vector<rod::Obstacle> out;
    if (planes.empty()) return out;
    out.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const ContactPlane& plane = planes.size() == 1 ? planes[0] : planes[count - 1 - i];
        out[i] = {plane.origin / p.length, plane.normal, spine.rest_radius[i] / p.length};
    }
    return out;
}

struct Solved {
    rod::Result result;
    Branch branch;
};

Solved with_sections(const Preset& p, Spine& spine, rod::Result result, const Quat& turn,
                     std::span<const rod::Obstacle> obstacles, const rod::Law& law, double share) {
    const double film = law.adhesion > 0 ? law.adhesion_range * p.length : 0;
    Solved out{std::move(result), {}};
    SectionOutput sections = make_sections({p, spine, out.result, obstacles, turn, film, share});
    spine.wide = sections.wide;
    out.branch.sections = std::move(sections.sections);
    return out;
}

Solved solve_spine(const Preset& p, Spine& spine, const rod::Clamp& clamp, const Quat& turn,
                   std::span<const ContactPlane> planes, const rod::Law& law, double share) {
    const std::vector<rod::Obstacle> obstacles = obstacles_of(p, spine, planes);
    rod::Result result = rod::solve(spine.rod, spine.memory, clamp, obstacles, law);
    return with_sections(p, spine, std::move(result), turn, obstacles, law, share);
}

/// Largest move of the ferrule in one solve, in lengths, turns counted at one length: hair
/// that stands nearly straight must be followed closely, or it falls to the wrong side.
constexpr double kCareful = 0.006, kOrdinary = 0.03;
constexpr double kLaid = 0.8;    ///< bend from which the hair lies as it will, radians
constexpr double kTeleport = 0.5;///< lengths; a further jump is no motion to follow
constexpr int kMaxParts = 8;

Pose between(const Pose& a, const Pose& b, double t) {
    return {glm::mix(a.position, b.position, t), glm::slerp(a.rotation, b.rotation, t),
            a.time + t * (b.time - a.time)};
}

/// Follows the ferrule from `from` to just before `to` in parts small enough.
void approach(const Preset& p, Spine& spine, const Pose& from, const Pose& to,
              std::span<const ContactPlane> planes, rod::Law law) {
    if (planes.empty()) return;
    const double turned = 2 * std::acos(std::min(1.0, std::abs(glm::dot(from.rotation, to.rotation))));
    const double moved = glm::length(to.position - from.position) / p.length + turned;
    const double bend = std::acos(std::clamp(glm::dot(spine.memory.tangent.back(), spine.memory.clamp.tangent), -1.0, 1.0));
    int parts = 1;
    if (moved < kTeleport) {
        const double largest = bend < kLaid ? kCareful : kOrdinary;
        parts = std::clamp(static_cast<int>(std::ceil(moved / largest)), 1, kMaxParts);
    }
    law.max_iterations = std::max(30, law.max_iterations / parts);
    Pose last = from;
    for (int k = 1; k < parts; ++k) {
        const Pose pose = between(from, to, static_cast<double>(k) / parts);
        break_symmetry(p, spine, last, pose, planes);
        rod::solve(spine.rod, spine.memory, clamp_of(p, pose), obstacles_of(p, spine, planes), law);
        last = pose;
    }
    break_symmetry(p, spine, last, to, planes);
}

/// The spine from the query table: bent in the plane of the holder and the tip's last place,
/// so that the tip follows the hand as a tractrix, by the moment that puts the tip on the plane.
Solved stand_spine(const Preset& p, const QueryTable& table, Spine& spine, const rod::Clamp& clamp,
                   const Quat& turn, std::span<const ContactPlane> planes, const rod::Law& law) {
    const std::vector<rod::Obstacle> obstacles = obstacles_of(p, spine, planes);
    rod::Memory& m = spine.memory;
    const Vec3 root_before = m.clamp.position;
    const Vec3 tip_before = rod::nodes(spine.rod, m).back();
    rod::carry(m, clamp);
    const std::size_t n = m.tangent.size();
    rod::Result r;
    r.converged = true;
    r.moment.assign(n, 0);
    r.normal_force.assign(n + 1, 0);
    r.contact_force.assign(n + 1, Vec3{0});
    const auto lay = [&](const TableRow& row, const Vec3& side) {
        for (std::size_t i = 0; i <= n; ++i) {
            const Vec2 b = row.nodes[n - i] / p.length;
            m.node[i] = clamp.position + b.x * clamp.tangent + b.y * side;
        }
        for (std::size_t j = 0; j < n; ++j) m.tangent[j] = glm::normalize(m.node[j + 1] - m.node[j]);
    };
    Vec3 side = tip_before - clamp.position;
    side -= glm::dot(side, clamp.tangent) * clamp.tangent;
    side = glm::length(side) > 1e-9 ? glm::normalize(side) : clamp.side;
    const Vec3 moved_by = clamp.position - root_before;
    if (glm::dot(side, moved_by) > 0.999 * glm::length(moved_by) && glm::length(moved_by) > 1e-9) {
        // Pushed straight ahead of the hand a tractrix balances; the hair gives way to one side.
        side = glm::normalize(side + 0.03 * glm::cross(clamp.tangent, side));
    }
    if (obstacles.empty()) {
        lay(table.rows.front(), side);
        return with_sections(p, spine, std::move(r), turn, obstacles, law, 1);
    }
    const rod::Obstacle& o = obstacles.back();
    const double root = glm::dot(clamp.position - o.origin, o.normal);
    const double moment = standing_moment(table, [&](const TableRow& row) {
        const Vec2 tip = row.nodes.front() / p.length;
        return root + tip.x * glm::dot(clamp.tangent, o.normal) + tip.y * glm::dot(side, o.normal);
    });
    const TableRow row = look_up(table, moment);
    lay(row, side);
    if (moment > 0) {
        const double unit = p.stiffness / p.length;
        for (std::size_t j = 0; j < n; ++j) r.moment[j] = row.moments[n - j] / unit;
        Vec3 lever = m.node.back() - clamp.position;
        lever -= glm::dot(lever, o.normal) * o.normal;
        const double reaction = moment / unit / std::max(glm::length(lever), 0.1);
        Vec3 slip = m.node.back() - tip_before;
        slip -= glm::dot(slip, o.normal) * o.normal;
        const double moved = glm::length(slip);
        r.force = reaction * o.normal;
        if (moved > 1e-9) r.force -= law.friction * reaction / moved * slip;
        r.root_moment = glm::cross(m.node.back() - clamp.position, r.force);
        // Where the side of the tuft lies on the surface it shares the load.
        double sum = 0;
        for (std::size_t i = 1; i <= n; ++i) {
            const rod::Obstacle& at = obstacles[i];
            const double depth = at.radius - glm::dot(m.node[i] - at.origin, at.normal);
            r.normal_force[i] = spine.rod.weight[i] * std::max(0.0, depth);
            sum += r.normal_force[i];
        }
        for (double& f : r.normal_force) f *= sum > 0 ? reaction / sum : 0;
    }
    return with_sections(p, spine, std::move(r), turn, obstacles, law, 1);
}

/// SP of the bifurcation rule: ξ k (1 - Z_i/Z), with k the root moment over the moment of
/// a tuft that lies flat.
double split_measure(const Preset& p, double ink_left, double root_moment) {
    const double flat = 0.6 * p.stiffness / p.length;
    return p.split_factor * std::min(1.0, root_moment / flat) * (1 - std::clamp(ink_left, 0.0, 1.0));
}

rod::Clamp twig_clamp(const Tuft& tuft, int k, int index) {
    const rod::Memory& m = tuft.spine.memory;
    const int inner = std::max(0, k - 1);
    const Vec3 t = m.tangent[inner];
    Vec3 e = tuft.pose.rotation * tuft.spine.wide;
    e = parallel_transport(e, tuft.pose.axis(), t);
    e = glm::normalize(e - glm::dot(e, t) * t);
    const double yaw = tuft.preset.split_yaw * (index - 0.5 * (kTwigs - 1));
    rod::Clamp clamp;
    clamp.position = m.node[k];
    clamp.tangent = std::cos(yaw) * t + std::sin(yaw) * e;
    clamp.side = std::cos(yaw) * e - std::sin(yaw) * t;
    return clamp;
}

void split(Tuft& tuft) {
    const int k = branch_node(tuft.spine.rod);
    double xi = 0;
    for (int j = 0; j < k; ++j) xi += tuft.spine.rod.length[j];
    for (int index = 0; index < kTwigs; ++index) {
        const rod::Clamp clamp = twig_clamp(tuft, k, index);
        const rod::Rod part = rod::outer_part(tuft.spine.rod, k, kTwigs);
        Spine twig = make_spine(tuft.preset, part, clamp, xi, kTwigs);
        const double yaw = tuft.preset.split_yaw * (index - 0.5 * (kTwigs - 1));
        Vec3 up = glm::cross(tuft.pose.rotation * tuft.spine.wide, tuft.pose.axis());
        up = parallel_transport(up, tuft.pose.axis(), clamp.tangent);
        const Quat turn = glm::angleAxis(-yaw, glm::normalize(up));
        for (int j = 0; j < part.segments(); ++j) {
            twig.memory.tangent[j] = glm::normalize(turn * tuft.spine.memory.tangent[k + j]);
            twig.memory.joint[j] = tuft.spine.memory.joint[k + j];
        }
        twig.memory.node = rod::nodes(part, twig.memory);
        tuft.twigs[index] = std::move(twig);
    }
    tuft.split = true;
}

/// Solves the sub-spines on the bent trunk and puts them in place of the last third.
void solve_twigs(Tuft& tuft, std::span<const ContactPlane> planes, TuftState& state) {
    const Preset& p = tuft.preset;
    const int k = branch_node(tuft.spine.rod);
    const rod::Law law = law_of(p, tuft.wetness, kTwigs);
    const std::vector<Section> whole = std::move(state.branches.front().sections);
    state.branches.clear();
    std::size_t next = whole.size();
    for (int index = 0; index < kTwigs; ++index) {
        Spine& twig = tuft.twigs[index];
        const std::size_t count = twig.rest_radius.size();
        std::span<const ContactPlane> own = planes;
        if (planes.size() > 1) own = planes.subspan(next, count);
        next += count;
        const rod::Clamp clamp = twig_clamp(tuft, k, index);
        Solved solved = solve_spine(p, twig, clamp, tuft.pose.rotation, own, law, kTwigs);
        state.iterations += solved.result.iterations;
        state.converged = state.converged && solved.result.converged;
        Branch branch = std::move(solved.branch);
        branch.ink_share = 1.0 / kTwigs;
        if (index == kTwigs / 2) {
            // The middle one carries the trunk.
            branch.sections.pop_back();
            branch.sections.insert(branch.sections.end(), whole.begin() + static_cast<long>(count) - 1,
                                   whole.end());
        }
        state.branches.push_back(std::move(branch));
    }
}

std::size_t expected_planes(const Tuft& tuft) {
    std::size_t count = tuft.spine.rest_radius.size();
    if (tuft.split) {
        for (const Spine& twig : tuft.twigs) count += twig.rest_radius.size();
    }
    return count;
}

}  // namespace

double rest_radius(const Preset& p, double u) {
    u = std::clamp(u, 0.0, 1.0);
    const double taper = std::pow(std::max(0.0, 1 - std::pow(u, 2.4)), p.tip_power);
    return std::hypot(1.06 * p.radius * taper * (1 - 0.14 * std::pow(1 - u, 6)), p.tip_radius);
}

Profile profile_of(const Preset& p) {
    return {p.alpha, p.beta, p.yield, p.gamma, p.tip_stiffness};
}

Tuft make_tuft(const Preset& preset) {
    check_preset(preset, preset.name.empty() ? "brush" : preset.name);
    Tuft tuft;
    tuft.preset = preset;
    const Profile profile = profile_of(preset);
    rod::Rod rod = rod::make_rod(profile, preset.segments, 0.25 + 0.75 * preset.hardness);
    rod.plastic_share = preset.plastic_share;
    tuft.spine = make_spine(preset, rod, clamp_of(preset, {}), 0, 1);
    if (preset.spine == SpineMethod::table) tuft.table = make_table(preset);
    return tuft;
}

std::vector<Vec3> predicted_nodes(const Tuft& tuft, const Pose& pose) {
    std::vector<Vec3> out;
    const Quat turn = tuft.posed ? pose.rotation * glm::conjugate(tuft.pose.rotation) : pose.rotation;
    const auto add = [&](const Spine& spine) {
        const Vec3 root = tuft.spine.memory.clamp.position;
        for (std::size_t i = spine.memory.node.size(); i-- > 0;) {
            out.push_back(pose.position + turn * ((spine.memory.node[i] - root) * tuft.preset.length));
        }
    };
    add(tuft.spine);
    if (tuft.split) {
        for (const Spine& twig : tuft.twigs) add(twig);
    }
    return out;
}

TuftState step(Tuft& tuft, const Pose& pose, std::span<const ContactPlane> planes, double /*dt*/) {
    const Preset& p = tuft.preset;
    const std::size_t expected = expected_planes(tuft);
    if (planes.size() > 1 && planes.size() != expected) {
        throw Error("brush: " + std::to_string(planes.size()) + " contact planes for " +
                    std::to_string(expected) + " nodes; give one per node, one for all, or none");
    }
    const rod::Clamp clamp = clamp_of(p, pose);
    if (!tuft.posed) {
        // The first pose is where the hand starts: the tuft comes with it, from above.
        rod::carry(tuft.spine.memory, clamp);
        tuft.pose = pose;
        tuft.posed = true;
    }
    const std::size_t own = tuft.spine.rest_radius.size();
    const std::span<const ContactPlane> main_planes = planes.size() > 1 ? planes.first(own) : planes;
    const rod::Law law = law_of(p, tuft.wetness, 1);
    if (p.spine == SpineMethod::rod) approach(p, tuft.spine, tuft.pose, pose, main_planes, law);
    Solved solved = p.spine == SpineMethod::table
                        ? stand_spine(p, tuft.table, tuft.spine, clamp, pose.rotation, main_planes, law)
                        : solve_spine(p, tuft.spine, clamp, pose.rotation, main_planes, law, 1);
    tuft.pose = pose;

    const rod::Result& r = solved.result;
    TuftState state;
    const double newton = p.stiffness / (p.length * p.length), newton_metre = p.stiffness / p.length;
    state.force = r.force * newton;
    state.moment = r.root_moment * newton_metre;
    state.root_moment = r.moment.front() * newton_metre;
    for (const double f : r.normal_force) state.normal_force += f * newton;
    state.touching = state.normal_force > 0;
    state.converged = r.converged;
    state.iterations = r.iterations;
    state.branches.push_back(std::move(solved.branch));

    const double measure = split_measure(p, tuft.ink_left, state.root_moment);
    if (tuft.split) {
        solve_twigs(tuft, planes, state);
        if (measure < p.merge_at) tuft.split = false;
    } else if (measure > p.split_at) {
        split(tuft);
    }
    return state;
}

void reset(Tuft& tuft) {
    Tuft fresh = make_tuft(tuft.preset);
    fresh.wetness = tuft.wetness;
    fresh.ink_left = tuft.ink_left;
    tuft = std::move(fresh);
}

void reshape(Tuft& tuft) {
    const rod::Clamp clamp = tuft.spine.memory.clamp;
    tuft.spine.memory = rod::make_memory(tuft.spine.rod, clamp);
    tuft.split = false;
}

Vec3 hand_force(const Preset& p, const TuftState& state) {
    const double size = glm::length(state.force);
    if (size <= 0) return Vec3{0};
    return state.force * (std::min(p.force_gain * size, p.force_limit) / size);
}

}  // namespace tuft::brush
