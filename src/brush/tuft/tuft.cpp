#include "brush/tuft/tuft.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "brush/tuft/ferrule.h"
#include "brush/tuft/foam.h"
#include "brush/tuft/spine.h"
#include "brush/tuft/wide_tuft.h"
#include "core/error.h"

namespace tuft::brush {

namespace {

constexpr double kDryPlastic = 0.3;  ///< plastic share of dry hair over that of wet hair

std::size_t expected_planes(const Tuft& tuft) {
    std::size_t count = 0;
    for (const Spine& spine : tuft.spines) count += spine.rest.radius.size();
    if (tuft.split) {
        for (const Spine& sub_spine : tuft.sub_spines) count += sub_spine.rest.radius.size();
    }
    return count;
}

/// The force on its way through the wet hair, solved exactly for a force that stays over dt.
void feel(Tuft& tuft, TuftState& state, double dt) {
    const double w = 1 / kDeviceForceTime, t = std::isfinite(dt) ? std::max(0.0, dt) : 0, fade = std::exp(-w * t);
    const Vec3 miss = tuft.device_force - state.force, slope = tuft.device_force_rate + w * miss;
    tuft.device_force = state.force + fade * (miss + t * slope);
    tuft.device_force_rate = fade * (tuft.device_force_rate - w * t * slope);
    state.device_force = tuft.device_force;
}

/// Whether a section of the whole tuft cuts its plane: the papers paint with what lies below the surface, also where
/// their hair has come to rest without force.
bool reaches(const TuftState& state, std::span<const ContactPlane> planes) {
    for (const Branch& branch : state.branches) {
        for (std::size_t k = 0; k < branch.sections.size() && !planes.empty(); ++k) {
            const Section& s = branch.sections[k];
            const ContactPlane& plane = planes.size() == 1 ? planes[0] : planes[std::min(k, planes.size() - 1)];
            const double reach = std::hypot(s.a * glm::dot(s.e, plane.normal), s.b * glm::dot(s.m, plane.normal));
            if (height_over(plane, s.centre) < reach) return true;
        }
    }
    return false;
}

/// The skin of a wide ferrule fills the ferrule's own form. Semi-axes of a model are half its width and thickness;
/// those of a strip are of an ellipse of its area.
void fill_mouth(const Preset& p, TuftState& state) {
    if (!has_one_skin(p)) return;
    const FerruleSpine mouth = single_spine(p);
    const double root_pi = std::sqrt(std::numbers::pi);
    state.wide = state.strips = true;
    for (Branch& branch : state.branches) {
        branch.strip = strip_corners(p, mouth);
        for (Section& s : branch.sections) {
            s.a *= 2 / root_pi;
            s.b *= mouth.thick / (p.radius * root_pi);
        }
    }
}

/// Bends the tuft by its model of the papers, and takes its nodes over into the spine.
TuftState step_model(Tuft& tuft, const Pose& pose, std::span<const ContactPlane> planes, double dt) {
    const double length = tuft.preset.length;
    TuftState state = tuft.model->step({pose, planes, std::isfinite(dt) ? std::max(0.0, dt) : 0, tuft.wetness});
    state.touching = state.normal_force > 0 || reaches(state, planes);
    fill_mouth(tuft.preset, state);
    rod::Memory& m = tuft.trunk().memory;
    m.clamp = clamp_of(tuft.preset, pose);
    const Recycled<Vec3> nodes = tuft.model->nodes();
    for (std::size_t i = 0; i < m.node.size(); ++i) m.node[i] = nodes[nodes.size() - 1 - i] / length;
    for (std::size_t j = 0; j < m.tangent.size(); ++j) {
        const Vec3 d = m.node[j + 1] - m.node[j];
        m.tangent[j] = glm::length(d) > 1e-9 ? glm::normalize(d) : j > 0 ? m.tangent[j - 1] : m.clamp.tangent;
    }
    tuft.pose = pose;
    feel(tuft, state, dt);
    return state;
}

constexpr double kCoheres = 0.25;        ///< of the capacity: ink from which water draws parted hair together
constexpr double kMergingTime = 0.03;    ///< s in which it does
constexpr double kPartingLength = 6e-3;  ///< m of the hand's path in which sub-spines part
constexpr double kMerged = 0.02;         ///< spread at which they are one again

}  // namespace

Tuft make_tuft(const Preset& preset, std::uint64_t seed) {
    check_preset(preset, preset.name.empty() ? "brush" : preset.name);
    Tuft tuft;
    tuft.preset = preset;
    const Profile profile = profile_of(preset);
    if (preset.spines > 1 && !has_one_skin(preset)) {
        tuft.spines = make_spines(preset, profile);
        tuft.beside = make_beside(preset, tuft.spines);
    } else {
        rod::Rod rod = rod::make_rod(profile, preset.segments, 0.25 + 0.75 * preset.hardness);
        rod.plastic_share = preset.plastic_share;
        tuft.spines.push_back(make_spine(preset, rod, clamp_of(preset, {}), 0, 1));
    }
    if (preset.spine == SpineMethod::table) tuft.table = make_table(preset);
    tuft.bundles = make_bundles(preset, seed);
    if (is_foam(preset)) {
        tuft.carried = make_foam(preset, tuft.bundles);
        tuft.model = SpineModelCopy(make_foam_model(preset, tuft.carried));
    } else {
        tuft.model = SpineModelCopy(make_spine_model(preset));
        tuft.carried = embed_geometry(tuft);
    }
    return tuft;
}

Recycled<Vec3> predicted_nodes(const Tuft& tuft, const Pose& pose) {
    Recycled<Vec3> out;
    const Quat turn = tuft.posed ? pose.rotation * glm::conjugate(tuft.pose.rotation) : pose.rotation;
    const auto add = [&](const Spine& spine) {
        const Vec3 root = tuft.pose.position / tuft.preset.length;
        for (std::size_t i = spine.memory.node.size(); i-- > 0;) {
            out.push_back(pose.position + turn * ((spine.memory.node[i] - root) * tuft.preset.length));
        }
    };
    for (const Spine& spine : tuft.spines) add(spine);
    if (tuft.split) {
        for (const Spine& sub_spine : tuft.sub_spines) add(sub_spine);
    }
    return out;
}

Recycled<Vec3> predicted_sides(const Tuft& tuft, const Pose& pose) {
    Recycled<Vec3> out;
    if (!tuft.posed) return out;
    for (const Spine& spine : tuft.spines)
        for (const Vec3& s : spine.sides.position) out.push_back(pose.position + pose.rotation * (spine.rest.root + s));
    return out;
}

namespace {

rod::Clamp clamp_in(const Tuft& tuft, const Spine& spine, const Pose& pose) {
    return tuft.wide() ? spine_clamp(tuft.preset, spine, pose) : clamp_of(tuft.preset, pose);
}

/// Adds what the surface does to one spine, and its branch. `lever`: of its root from the middle of the mouth, metres.
void add_spine(const Preset& p, const Spine& spine, SolvedSpine solved, const Vec3& lever, TuftState& state) {
    const rod::Result& r = solved.result;
    const double newton = p.stiffness / (p.length * p.length), newton_metre = p.stiffness / p.length;
    state.force += r.force * newton;
    state.moment += r.root_moment * newton_metre + glm::cross(lever, r.force * newton);
    state.root_moment += r.moment.front() * newton_metre;
    for (const double f : r.normal_force) state.normal_force += f * newton;
    state.touching = state.normal_force > 0;
    state.energy.bend += r.bend_energy * newton_metre;
    state.energy.contact += r.contact_energy * newton_metre;
    state.energy.aside += spine.sides.energy;
    state.energy.spread += solved.spread_energy;
    state.energy.lost += r.dissipation * newton_metre - solved.aside_gain;
    state.converged = state.converged && r.converged;
    state.work += r.work;
    state.branches.push_back(std::move(solved.branch));
}

/// Notes the shape that was found, for another step to the same pose.
void note_guess(const Tuft& tuft, StepStart& start) {
    start.known = true;
    start.guess.resize(tuft.spines.size());
    for (std::size_t k = 0; k < tuft.spines.size(); ++k) {
        rod::Guess& guess = start.guess[k];
        guess.tangent = tuft.spines[k].memory.tangent;
        guess.force.clear();
        for (const rod::ContactMemory& c : tuft.spines[k].memory.contact) guess.force.push_back(c.force);
    }
    start.pair_force.resize(tuft.beside.size());
    for (std::size_t k = 0; k < tuft.beside.size(); ++k) start.pair_force[k] = tuft.beside[k].memory.normal;
}

/// Bends a tuft of one spine.
TuftState bend_trunk(Tuft& tuft, const Pose& pose, std::span<const ContactPlane> planes, double dt,
                     std::span<const ContactPlane> walls, StepStart* start) {
    const Preset& p = tuft.preset;
    const std::size_t own = tuft.trunk().rest.radius.size();
    SpineStep step{.preset = p,
                   .clamp = clamp_of(p, pose),
                   .rotation = pose.rotation,
                   .planes = planes.size() > 1 ? planes.first(own) : planes,
                   .wetness = tuft.wetness,
                   .dt = dt};
    // The table knows no walls.
    if (p.spine != SpineMethod::table && !walls.empty()) {
        step.walls = walls.first(2 * own);
        step.across = walls.subspan(2 * own);
    }
    PathWork passed;
    if (p.spine == SpineMethod::rod) passed = follow_ferrule(step, tuft.trunk(), tuft.pose, pose, start);
    SolvedSpine solved =
        p.spine == SpineMethod::table
            ? bend_by_table(step, tuft.table, tuft.trunk())
            : solve_spine(step, tuft.trunk(), passed, start && start->known ? &start->guess.front() : nullptr);
    if (start) note_guess(tuft, *start);
    TuftState state;
    add_spine(p, tuft.trunk(), std::move(solved), Vec3{0}, state);
    return state;
}

/// Bends the spines of a wide ferrule together.
TuftState bend_wide(Tuft& tuft, const Pose& pose, std::span<const ContactPlane> planes, double dt,
                    std::span<const ContactPlane> walls, StepStart* start) {
    const Preset& p = tuft.preset;
    SolvedSpines solved = solve_spines(tuft, pose, planes, walls, dt, start);
    if (start) note_guess(tuft, *start);
    TuftState state{.wide = true, .strips = has_broad_side(p)};
    state.work = solved.work;
    double lost = solved.dissipation;
    for (std::size_t k = 0; k < tuft.spines.size(); ++k) {
        Spine& spine = tuft.spines[k];
        lost -= solved.spines[k].result.dissipation;
        solved.spines[k].branch.ink_share = spine.rest.share;
        solved.spines[k].branch.strip = spine.rest.strip;
        solved.spines[k].branch.rest_length = spine.rest.length;
        solved.spines[k].branch.edge_short = spine.rest.edge_short;
        add_spine(p, spine, std::move(solved.spines[k]), pose.rotation * spine.rest.root, state);
    }
    // What hair lost on the way to the last part of this step, and between the spines.
    state.energy.lost += lost * p.stiffness / p.length;
    state.energy.contact += solved.coupling_energy * p.stiffness / p.length;
    const double bridged = std::max(tuft.wetness * solved.film_range, p.hair_diameter);
    // Hair that splays is spread over the gap between two spines, and leaves as many narrow ones as hairs stand side by
    // side in a spine.
    const double thick_over_wide = has_broad_side(p) ? face_over_pitch(p) : 1;
    const double shared = std::sqrt(static_cast<double>(p.bristles) / (p.spines * thick_over_wide));
    for (const Beside& beside : tuft.beside) {
        // Beyond the end of the shorter one its tip says whether the skin goes on.
        const Recycled<double>& gap = beside.gap;
        Recycled<double> width(tuft.spines[beside.first].rest.radius.size());
        for (std::size_t i = 0; i < width.size(); ++i)
            width[width.size() - 1 - i] = gap[std::min(i, gap.size() - 1)] / shared - bridged;
        state.openings.push_back({beside.first, beside.second, std::move(width)});
    }
    return state;
}

}  // namespace

TuftState step(Tuft& tuft, const Pose& pose, std::span<const ContactPlane> planes, double dt,
               std::span<const ContactPlane> walls, StepStart* start) {
    const Preset& p = tuft.preset;
    const std::size_t expected = expected_planes(tuft);
    if (planes.size() > 1 && planes.size() != expected) {
        throw Error(Message("brush: {} contact planes for {} nodes; give one per node, one for all, or none",
                            planes.size(), expected));
    }
    std::size_t sides = 0;
    for (const Spine& spine : tuft.spines) sides += 2 * spine.rest.radius.size();
    if (!walls.empty() && walls.size() != sides && walls.size() != sides + sides / 2) {
        throw Error(Message("brush: {} walls for {} side nodes", walls.size(), sides));
    }
    if (!std::isfinite(glm::dot(pose.position, pose.position)) || std::abs(glm::length(pose.rotation) - 1) > 1e-3) {
        throw Error("brush: the pose is not a place and a unit rotation");
    }
    if (!tuft.posed) {
        // The first pose is where the hand starts: the tuft comes with it, from above.
        for (Spine& spine : tuft.spines) rod::move_with_clamp(spine.memory, clamp_in(tuft, spine, pose));
        if (tuft.model) tuft.model->straighten(pose);
        tuft.pose = pose;
        tuft.posed = true;
    }
    tuft.wetness = std::clamp(tuft.wetness, 0.0, 1.0);
    if (tuft.model) return step_model(tuft, pose, planes, dt);
    // Water between the hairs is what yields; dry hair springs back.
    for (Spine& spine : tuft.spines)
        spine.rod.plastic_share = p.plastic_share * (kDryPlastic + (1 - kDryPlastic) * tuft.wetness);
    const double part = std::isfinite(dt) ? std::max(0.0, dt) : 0,
                 moved = glm::length(pose.position - tuft.pose.position);
    TuftState state = tuft.wide() ? bend_wide(tuft, pose, planes, part, walls, start)
                                  : bend_trunk(tuft, pose, planes, part, walls, start);
    tuft.pose = pose;
    feel(tuft, state, dt);
    if (tuft.carried) place_geometry(tuft, planes, state);
    if (tuft.wide() || tuft.carried) return state;  // it parts between its spines; a geometry keeps together
    const double measure = split_measure(p, tuft.ink_left, state.root_moment);
    if (tuft.split) {
        // Too dry for water to draw it together, it stays split until it is wetted or combed.
        if (measure < p.merge_at && tuft.ink_left > kCoheres)
            tuft.spread *= std::exp(-std::max(dt, 0.0) / kMergingTime);
        else
            tuft.spread = 1 - (1 - tuft.spread) * std::exp(-moved / kPartingLength);
        solve_sub_spines(tuft, planes, state, dt);
        if (measure < p.merge_at && tuft.spread < kMerged) tuft.split = false;
    } else if (measure > p.split_at) {
        split(tuft, state.branches.front());
    }
    return state;
}

void reset(Tuft& tuft) {
    Tuft fresh = make_tuft(tuft.preset, tuft.bundles.seed);
    fresh.wetness = tuft.wetness;
    fresh.ink_left = tuft.ink_left;
    tuft = std::move(fresh);
}

void reshape(Tuft& tuft) {
    for (Spine& spine : tuft.spines) {
        const rod::Clamp clamp = spine.memory.clamp;
        spine.sides.position.clear();
        spine.sides.flank.clear();
        spine.sides.shift.clear();
        spine.sides.slips.clear();
        spine.sides.energy = 0;
        spine.memory = rod::make_memory(spine.rod, clamp);
        spine.one_sided = Vec2{0};
    }
    for (Beside& beside : tuft.beside) {
        beside.memory = {};
        beside.gap.clear();
    }
    if (tuft.model) tuft.model->straighten(tuft.pose);
    tuft.split = false;
    rejoin_hair(tuft.bundles);
}

Vec3 device_force(const Preset& p, const TuftState& state) {
    const double size = glm::length(state.device_force);
    if (size <= 0) return Vec3{0};
    return state.device_force * (std::min(p.force_gain * size, p.force_limit) / size);
}

}  // namespace tuft::brush
