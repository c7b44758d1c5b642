#include "brush/tuft/tuft.h"

#include <algorithm>
#include <cmath>

#include "brush/tuft/spine.h"
#include "core/error.h"

namespace tuft::brush {

namespace {

constexpr double kDryPlastic = 0.3;  ///< plastic share of dry hair over that of wet hair

std::size_t expected_planes(const Tuft& tuft) {
    std::size_t count = tuft.spine.rest_radius.size();
    if (tuft.split) {
        for (const Spine& sub_spine : tuft.sub_spines) count += sub_spine.rest_radius.size();
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

constexpr double kCoheres = 0.25;        ///< of the capacity: ink from which water draws parted hair together
constexpr double kMergingTime = 0.03;    ///< s in which it does
constexpr double kPartingLength = 6e-3;  ///< m of the hand's way in which sub-spines part
constexpr double kMerged = 0.02;         ///< spread at which they are one again

}  // namespace

double rest_radius(const Preset& p, double u) {
    u = std::clamp(u, 0.0, 1.0);
    const double taper = std::pow(std::max(0.0, 1 - std::pow(u, 2.4)), p.tip_power);
    return std::hypot(1.06 * p.radius * taper * (1 - 0.14 * std::pow(1 - u, 6)), p.tip_radius);
}

Profile profile_of(const Preset& p) {
    return {p.alpha, p.beta, p.yield, p.gamma, p.tip_stiffness};
}

Tuft make_tuft(const Preset& preset, std::uint64_t seed) {
    check_preset(preset, preset.name.empty() ? "brush" : preset.name);
    Tuft tuft;
    tuft.preset = preset;
    const Profile profile = profile_of(preset);
    rod::Rod rod = rod::make_rod(profile, preset.segments, 0.25 + 0.75 * preset.hardness);
    rod.plastic_share = preset.plastic_share;
    tuft.spine = make_spine(preset, rod, clamp_of(preset, {}), 0, 1);
    if (preset.spine == SpineMethod::table) tuft.table = make_table(preset);
    tuft.bundles = make_bundles(preset, seed);
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
        for (const Spine& sub_spine : tuft.sub_spines) add(sub_spine);
    }
    return out;
}

std::vector<Vec3> predicted_sides(const Tuft& tuft, const Pose& pose) {
    std::vector<Vec3> out;
    if (!tuft.posed) return out;
    for (const Vec3& s : tuft.spine.side) out.push_back(pose.position + pose.rotation * s);
    return out;
}

TuftState step(Tuft& tuft, const Pose& pose, std::span<const ContactPlane> planes, double dt,
               std::span<const ContactPlane> walls) {
    const Preset& p = tuft.preset;
    const std::size_t expected = expected_planes(tuft);
    if (planes.size() > 1 && planes.size() != expected) {
        throw Error(Message("brush: {} contact planes for {} nodes; give one per node, one for all, or none",
                            planes.size(), expected));
    }
    if (!walls.empty() && walls.size() != 2 * tuft.spine.rest_radius.size()) {
        throw Error(Message("brush: {} walls for {} side nodes", walls.size(), 2 * tuft.spine.rest_radius.size()));
    }
    if (!std::isfinite(glm::dot(pose.position, pose.position)) || std::abs(glm::length(pose.rotation) - 1) > 1e-3) {
        throw Error("brush: the pose is not a place and a unit rotation");
    }
    const rod::Clamp clamp = clamp_of(p, pose);
    if (!tuft.posed) {
        // The first pose is where the hand starts: the tuft comes with it, from above.
        rod::carry_with_clamp(tuft.spine.memory, clamp);
        tuft.pose = pose;
        tuft.posed = true;
    }
    tuft.wetness = std::clamp(tuft.wetness, 0.0, 1.0);
    // Water between the hairs is what yields; dry hair springs back.
    tuft.spine.rod.plastic_share = p.plastic_share * (kDryPlastic + (1 - kDryPlastic) * tuft.wetness);
    const std::size_t own = tuft.spine.rest_radius.size();
    const std::span<const ContactPlane> main_planes = planes.size() > 1 ? planes.first(own) : planes;
    double part = std::isfinite(dt) ? std::max(0.0, dt) : 0;
    Passed passed;
    if (p.spine == SpineMethod::rod)
        passed = approach(p, tuft.spine, tuft.pose, pose, main_planes, walls, tuft.wetness, part);
    Solved solved =
        p.spine == SpineMethod::table
            ? stand_spine(p, tuft.table, tuft.spine, clamp, pose.rotation, main_planes, tuft.wetness)
            : solve_spine(p, tuft.spine, clamp, pose.rotation, main_planes, tuft.wetness, 1, part, walls, passed);
    const double moved = glm::length(pose.position - tuft.pose.position);
    tuft.pose = pose;

    const rod::Result& r = solved.result;
    TuftState state;
    const double newton = p.stiffness / (p.length * p.length), newton_metre = p.stiffness / p.length;
    state.force = r.force * newton;
    state.moment = r.root_moment * newton_metre;
    state.root_moment = r.moment.front() * newton_metre;
    for (const double f : r.normal_force) state.normal_force += f * newton;
    state.touching = state.normal_force > 0;
    state.energy = {.bend = r.bend_energy * newton_metre,
                    .contact = r.contact_energy * newton_metre,
                    .aside = tuft.spine.aside_energy,
                    .spread = solved.spread_energy,
                    .lost = r.dissipation * newton_metre - solved.aside_gain};
    state.converged = r.converged;
    state.iterations = r.iterations;
    state.branches.push_back(std::move(solved.branch));

    feel(tuft, state, dt);

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
    const rod::Clamp clamp = tuft.spine.memory.clamp;
    tuft.spine.side.clear();
    tuft.spine.flank.clear();
    tuft.spine.aside.clear();
    tuft.spine.slips.clear();
    tuft.spine.aside_energy = 0;
    tuft.spine.memory = rod::make_memory(tuft.spine.rod, clamp);
    tuft.spine.one_sided = Vec2{0};
    tuft.split = false;
    gather(tuft.bundles);
}

Vec3 device_force(const Preset& p, const TuftState& state) {
    const double size = glm::length(state.device_force);
    if (size <= 0) return Vec3{0};
    return state.device_force * (std::min(p.force_gain * size, p.force_limit) / size);
}

}  // namespace tuft::brush
