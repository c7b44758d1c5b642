#include <algorithm>
#include <cmath>

#include "brush/tuft/spine.h"

namespace tuft::brush {

namespace {

constexpr double kBranchPoint = 2.0 / 3;  ///< share of the length below which the tuft never splits

/// Index, from the root, of the node where sub-spines leave.
int branch_node(const rod::Rod& rod) {
    double s = 0;
    int i = 0;
    while (i + 2 < rod.segments() && s + 0.5 * rod.length[i] < kBranchPoint) s += rod.length[i++];
    return i;
}

double outer_length(const rod::Rod& rod, int k) {
    double s = 0;
    for (int j = k; j < rod.segments(); ++j) s += rod.length[j];
    return s;
}

/// Place of a sub-spine beside the trunk's axis, in lengths: at first they fill its width.
double beside(const Tuft& tuft, int index) {
    const double n = tuft.preset.split_into;
    return tuft.branch_width / tuft.preset.length * (1 - 1 / std::sqrt(n)) * (2 * index / (n - 1) - 1);
}

/// Yaw of a sub-spine: at first they meet in the tuft's tip.
double yaw_of(const Tuft& tuft, int k, int index) {
    const double closed = -beside(tuft, index) / outer_length(tuft.trunk().rod, k);
    const double parted = tuft.preset.split_yaw * (index - 0.5 * (tuft.preset.split_into - 1));
    return closed + tuft.spread * (parted - closed);
}

rod::Clamp sub_spine_clamp(const Tuft& tuft, int k, int index) {
    const rod::Memory& m = tuft.trunk().memory;
    const int inner = std::max(0, k - 1);
    const Vec3 t = m.tangent[inner];
    Vec3 e = tuft.pose.rotation * tuft.trunk().sides.direction;
    e = parallel_transport(e, tuft.pose.axis(), t);
    e = glm::normalize(e - glm::dot(e, t) * t);
    const double yaw = yaw_of(tuft, k, index);
    rod::Clamp clamp;
    clamp.position = m.node[k] + beside(tuft, index) * e;
    clamp.tangent = std::cos(yaw) * t + std::sin(yaw) * e;
    clamp.side = std::cos(yaw) * e - std::sin(yaw) * t;
    return clamp;
}

}  // namespace

namespace {

void note_width(Tuft& tuft, const Recycled<Section>& whole) {
    tuft.branch_width = whole[whole.size() - 1 - static_cast<std::size_t>(branch_node(tuft.trunk().rod))].a;
}

}  // namespace

double split_measure(const Preset& p, double ink_left, double root_moment) {
    const double flat = 0.6 * p.stiffness / p.length;
    return p.split_factor * std::min(1.0, root_moment / flat) * (1 - std::clamp(ink_left, 0.0, 1.0));
}

void split(Tuft& tuft, const Branch& whole) {
    tuft.spread = 0;
    note_width(tuft, whole.sections);
    const int k = branch_node(tuft.trunk().rod), count = tuft.preset.split_into;
    double xi = 0;
    for (int j = 0; j < k; ++j) xi += tuft.trunk().rod.length[j];
    tuft.sub_spines.resize(static_cast<std::size_t>(count));
    for (int index = 0; index < count; ++index) {
        const rod::Clamp clamp = sub_spine_clamp(tuft, k, index);
        const rod::Rod part = rod::outer_part(tuft.trunk().rod, k, count);
        Spine sub_spine = make_spine(tuft.preset, part, clamp, xi, count);
        const double yaw = yaw_of(tuft, k, index);
        Vec3 up = glm::cross(tuft.pose.rotation * tuft.trunk().sides.direction, tuft.pose.axis());
        up = parallel_transport(up, tuft.pose.axis(), clamp.tangent);
        const Quat turn = glm::angleAxis(-yaw, glm::normalize(up));
        for (int j = 0; j < part.segments(); ++j) {
            sub_spine.memory.tangent[j] = glm::normalize(turn * tuft.trunk().memory.tangent[k + j]);
            sub_spine.memory.joint[j] = tuft.trunk().memory.joint[k + j];
        }
        sub_spine.memory.node = rod::nodes(part, sub_spine.memory);
        tuft.sub_spines[index] = std::move(sub_spine);
    }
    tuft.split = true;
}

void solve_sub_spines(Tuft& tuft, std::span<const ContactPlane> planes, TuftState& state, double dt) {
    const Preset& p = tuft.preset;
    const int k = branch_node(tuft.trunk().rod), count_all = static_cast<int>(tuft.sub_spines.size());
    const Recycled<Section> whole = std::move(state.branches.front().sections);
    note_width(tuft, whole);
    state.branches.clear();
    std::size_t next = whole.size();
    for (int index = 0; index < count_all; ++index) {
        Spine& sub_spine = tuft.sub_spines[index];
        const std::size_t count = sub_spine.rest.radius.size();
        std::span<const ContactPlane> own = planes;
        if (planes.size() > 1) own = planes.subspan(next, count);
        next += count;
        const rod::Clamp clamp = sub_spine_clamp(tuft, k, index);
        const Section& trunk = whole[whole.size() - 1 - static_cast<std::size_t>(k)];
        const double part = 1 / std::sqrt(static_cast<double>(count_all));
        sub_spine.rest.root_width = part * trunk.a;
        SolvedSpine solved = solve_spine({.preset = p,
                                          .clamp = clamp,
                                          .rotation = tuft.pose.rotation,
                                          .planes = own,
                                          .wetness = tuft.wetness,
                                          .share = static_cast<double>(count_all),
                                          .dt = dt},
                                         sub_spine);
        state.work += solved.result.work;
        state.converged = state.converged && solved.result.converged;
        Branch branch = std::move(solved.branch);
        branch.ink_share = 1.0 / count_all;
        // Seen from the same side as the trunk that it goes on from.
        if (glm::dot(branch.sections.back().e, whole[count - 1].e) < 0) {
            for (Section& section : branch.sections) {
                section.e = -section.e;
                section.m = -section.m;
            }
        }
        // It begins as the strip of the trunk that it took its hair from.
        Section& root = branch.sections.back();
        root = trunk;
        const double same = glm::dot(clamp.side, trunk.e) < 0 ? -1 : 1;
        root.centre += same * p.length * beside(tuft, index) * trunk.e;
        root.a *= part;
        root.b *= part;
        if (index == count_all / 2) {
            // The middle one carries the trunk.
            branch.sections.pop_back();
            branch.sections.insert(branch.sections.end(), whole.begin() + static_cast<long>(count) - 1, whole.end());
        }
        state.branches.push_back(std::move(branch));
    }
}

}  // namespace tuft::brush
