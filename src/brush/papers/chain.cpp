#include "brush/papers/chain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "brush/papers/chain_lateral.h"
#include "brush/papers/chain_solver.h"
#include "brush/papers/space/frames.h"
#include "brush/papers/space/lattice.h"
#include "brush/preset/rest_shape.h"

namespace tuft::brush {

namespace {

constexpr double kPoreLead = 5e-5;                        ///< m, l_0 [X]
constexpr double kLeastSlant = 0.02;                      ///< sin 1° [X]
constexpr double kSmoothing = 1e-5;                       ///< m, ε [X]
constexpr double kDryPlastic = 0.3, kDryCohesion = 0.7;   ///< [X]
constexpr double kCohesion = 0.03;                        ///< of k_c [X]
constexpr double kBendLength = 0.045;                     ///< of the length [X]
constexpr double kSpreading = 0.5;                        ///< σ [X]
constexpr double kLateralLoad = 0.25;                     ///< of the spine node's normal force [X]
constexpr double kLeastWidth = 0.4;                       ///< of r: hair cannot pass through itself [X]
constexpr double kFlatCurvature = std::numbers::pi / 2;   ///< over L
constexpr double kStraight = 1e-3;                        ///< radians of all joints: no bend yet
constexpr double kUpright = 0.9999;                       ///< cosine
constexpr double kCentroid = 4 / (3 * std::numbers::pi);  ///< of a half disc over its radius
constexpr int kLatticeDegree = 8;                         ///< [X]

/// Half-width at rest of a wide ferrule's hair at the part u of its length: that of the mouth where the hair reaches.
double rest_half_width(const Preset& p, double u) {
    const double past = p.toe > 0 ? std::clamp(1 - (1 - u) * p.length / p.toe, 0.0, 1.0) : 0;
    return std::max(0.5 * p.width * std::sqrt(1 - past * past), p.tip_radius);
}

/// One chain with what it keeps from step to step, in units of L and B0 over the number of spines.
struct OneSpine {
    Vec3 offset{0};                ///< m, of its root, ferrule frame
    std::vector<Vec2> bend;        ///< [n]
    std::vector<Vec2> rest;        ///< [n] ρ of the last step
    std::vector<Vec3> node;        ///< [n+1] m, world
    std::vector<double> pressure;  ///< [n+1]
};

/// Root frame of a chain: the third column is the ferrule's axis.
Mat3 root_frame(const Pose& pose) {
    return {pose.rotation * Vec3{1, 0, 0}, pose.rotation * Vec3{0, -1, 0}, pose.axis()};
}

Vec3 tangential(const Vec3& v, const Vec3& normal) {
    return v - glm::dot(v, normal) * normal;
}

class ChainModel final : public SpineModel {
  public:
    ChainModel(const Preset& preset, const ChainOptions& options);
    std::unique_ptr<SpineModel> clone() const override { return std::make_unique<ChainModel>(*this); }
    Recycled<Vec3> nodes() const override;
    TuftState step(const SpineModelInput& input) override;
    void straighten(const Pose& pose) override;

  private:
    std::vector<ChainContact> contacts_of(const OneSpine& spine, const SpineModelInput& input,
                                          std::span<const Vec3> carried) const;
    ChainFriction friction_of(std::span<const Vec3> carried, const SpineModelInput& input, double length) const;
    ChainPore pore_of(const OneSpine& spine, std::span<const Vec3> carried, const SpineModelInput& input) const;
    std::vector<Vec2> plastic_part(const OneSpine& spine, double wetness) const;
    std::vector<Vec2> first_guess(const OneSpine& spine, const SpineModelInput& input,
                                  std::span<const Vec3> carried) const;
    ChainSolution solve(OneSpine& spine, const SpineModelInput& input) const;
    void add_forces(const ChainSolution& solution, const OneSpine& spine, TuftState& state) const;
    double moment_of(std::size_t joint) const;
    /// Of half the mouth, over its half-width: a half disc, or half of a flat.
    double centroid() const { return has_broad_side(preset_) ? 0.5 : kCentroid; }
    double least_height(std::size_t node) const {
        return node + 1 < minor_.size() ? options_.effective_radius * minor_[node] : 0;
    }
    Recycled<Section> sections_of(const SpineModelInput& input, const std::vector<OneSpine>& before);
    void spread(Recycled<Section>& sections, const SpineModelInput& input, const std::vector<OneSpine>& before);
    void carry_with_lattice(Recycled<Section>& sections) const;

    Preset preset_;
    ChainOptions options_;
    ChainSpine chain_;
    std::vector<double> at_, radius_, minor_;  ///< [n+1] m: arc length, rest radius, minor radius of the last step
    std::vector<double> half_width_;           ///< [n+1] m at rest: of a round tuft the radius
    std::vector<double> flat_;                 ///< [n] radians, of a joint of hair bent evenly from upright to flat
    std::vector<OneSpine> spines_;
    std::array<std::vector<double>, 2> lateral_;  ///< [n+1] m, d of the last step: along e, against it
    Pose pose_;
    Vec3 wide_{1, 0, 0};  ///< ferrule frame
};

ChainModel::ChainModel(const Preset& preset, const ChainOptions& options) : preset_(preset), options_(options) {
    const std::vector<double> lengths = spine_segments(preset.segments, 0.25 + 0.75 * preset.hardness);
    chain_ = make_chain_spine(profile_of(preset), lengths, options.exponent);
    double s = 0;
    for (std::size_t i = 0; i <= lengths.size(); ++i) {
        at_.push_back(s * preset.length);
        radius_.push_back(rest_radius(preset, s));
        half_width_.push_back(has_broad_side(preset) ? rest_half_width(preset, s) : radius_.back());
        if (i == lengths.size()) break;
        const double width = i > 0 ? 0.5 * (lengths[i - 1] + lengths[i]) : 0.5 * lengths[0];
        flat_.push_back(width * kFlatCurvature);
        s += lengths[i];
    }
    spines_.resize(options.spines == 2 ? 2 : 1);
    if (spines_.size() == 2) {
        spines_[0].offset = {-centroid() * half_width_[0], 0, 0};
        spines_[1].offset = {centroid() * half_width_[0], 0, 0};
    }
    straighten({});
}

void ChainModel::straighten(const Pose& pose) {
    pose_ = pose;
    wide_ = {1, 0, 0};
    minor_ = radius_;
    for (OneSpine& spine : spines_) spine.rest.assign(flat_.size(), Vec2{0});
    for (std::vector<double>& side : lateral_) {
        side = radius_;
        for (double& d : side) d *= 1 - options_.effective_radius;
    }
    for (OneSpine& spine : spines_) {
        spine.bend.assign(flat_.size(), Vec2{0});
        spine.pressure.assign(radius_.size(), 0);
        spine.node.clear();
        const Vec3 root = pose.position + pose.rotation * spine.offset;
        for (const double s : at_) spine.node.push_back(root + s * pose.axis());
    }
}

Recycled<Vec3> ChainModel::nodes() const {
    Recycled<Vec3> out;
    for (std::size_t i = radius_.size(); i-- > 0;)
        out.push_back(spines_.size() == 1 ? spines_[0].node[i] : 0.5 * (spines_[0].node[i] + spines_[1].node[i]));
    return out;
}

/// In units of L from the pose's place.
std::vector<ChainContact> ChainModel::contacts_of(const OneSpine& spine, const SpineModelInput& input,
                                                  std::span<const Vec3> carried) const {
    std::vector<ChainContact> out;
    const std::size_t count = radius_.size();
    const double length = preset_.length;
    for (std::size_t i = 1; i < count && !input.planes.empty(); ++i) {
        const ContactPlane& plane = plane_of(input.planes, count - 1 - i);
        ChainContact c;
        c.plane = plane;
        c.plane.origin = (plane.origin - input.pose.position) / length;
        c.plane.beyond_origin = (plane.beyond_origin - input.pose.position) / length;
        const double least = least_height(i);
        c.radius = least / length;
        c.normal = plane.normal;
        c.normal_force = spine.pressure[i];
        Vec3 touched = spine.node[i];
        const double before = height_over(plane, touched) - least, now = height_over(plane, carried[i]) - least;
        if (spine.pressure[i] <= 0 && before > 0 && now < 0)
            touched = glm::mix(touched, carried[i], before / (before - now));
        c.touched = (touched - input.pose.position) / length;
        out.push_back(c);
    }
    return out;
}

ChainFriction ChainModel::friction_of(std::span<const Vec3> carried, const SpineModelInput& input,
                                      double length) const {
    ChainFriction f;
    f.coefficient = std::lerp(preset_.friction_dry, preset_.friction_wet, input.wetness);
    f.grain = preset_.grain;
    f.with_hair = preset_.with_hair;
    f.smoothing = kSmoothing / length;
    const std::size_t n = carried.size() - 1;
    const Vec3 tip = glm::normalize(carried[n] - carried[n - 1]);
    const Vec3 along = tangential(tip, plane_of(input.planes, 0).normal);
    if (glm::length(along) > kLeastSlant) f.along = glm::normalize(along);
    return f;
}

ChainPore ChainModel::pore_of(const OneSpine& spine, std::span<const Vec3> carried,
                              const SpineModelInput& input) const {
    ChainPore pore;
    const std::size_t n = carried.size() - 1;
    const ContactPlane& plane = plane_of(input.planes, 0);
    const Vec3 tip = glm::normalize(carried[n] - carried[n - 1]);
    const Vec3 along = tangential(tip, plane.normal);
    const double slant = glm::length(along), down = -glm::dot(tip, plane.normal);
    const double height = std::max(0.0, height_over(plane, spine.node[n]));
    if (!options_.pores || down <= 0 || slant < kLeastSlant || height > radius_[n]) return pore;
    pore.active = true;
    pore.direction = along / slant;
    pore.tip = (spine.node[n] - input.pose.position) / preset_.length;
    pore.reach = (kPoreLead + height * slant / down) / preset_.length;
    return pore;
}

std::vector<Vec2> ChainModel::plastic_part(const OneSpine& spine, double wetness) const {
    const double share = options_.plastic_angle * preset_.plastic_share * std::lerp(kDryPlastic, 1.0, wetness);
    std::vector<Vec2> rest;
    for (std::size_t j = 0; j < flat_.size(); ++j) {
        const double size = glm::length(spine.bend[j]), most = share * flat_[j];
        rest.push_back(size > most ? most / size * spine.bend[j] : spine.bend[j]);
    }
    return rest;
}

/// Straight hair pressed along its axis could fall to any side, and no constraint has a slope: it is bent behind the
/// hand's motion, or to the ferrule's x-axis when the hand only presses, until its tip is up again [X].
std::vector<Vec2> ChainModel::first_guess(const OneSpine& spine, const SpineModelInput& input,
                                          std::span<const Vec3> carried) const {
    std::vector<Vec2> guess = spine.bend;
    if (input.planes.empty()) return guess;
    const ContactPlane& plane = plane_of(input.planes, 0);
    const Vec3 axis = input.pose.axis();
    double bend = 0;
    for (const Vec2& w : guess) bend += glm::length(w);
    const double under = -height_over(plane, carried.back());
    if (bend > kStraight || under <= 0 || glm::dot(axis, plane.normal) > -kUpright) return guess;
    const Vec3 moved = input.pose.position - pose_.position;
    Vec3 aside = -tangential(moved, axis);
    const bool pressed = glm::length(aside) < 1e-3 * glm::length(moved) + 1e-9;
    aside = pressed ? input.pose.rotation * Vec3{1, 0, 0} : glm::normalize(aside);
    const Mat3 frame = root_frame(input.pose);
    const Vec3 about = glm::cross(axis, aside);
    // Softer joints bend more; sin of the mean slope lifts the tip.
    const double angle = std::clamp(std::sqrt(10 * under / preset_.length), 0.05, 0.6);
    double sum = 0;
    std::vector<double> soft;
    for (const double k : chain_.coefficient) {
        soft.push_back(std::pow(k, -1 / (chain_.exponent - 1)));
        sum += soft.back();
    }
    for (std::size_t j = 0; j < guess.size(); ++j)
        guess[j] = angle * soft[j] / sum * Vec2{glm::dot(about, frame[0]), glm::dot(about, frame[1])};
    return guess;
}

ChainSolution ChainModel::solve(OneSpine& spine, const SpineModelInput& input) const {
    const double length = preset_.length;
    const Mat3 frame = root_frame(input.pose);
    const Vec3 root = input.pose.rotation * spine.offset;
    std::vector<Vec3> carried = chain_nodes(chain_, root / length, frame, spine.bend);
    for (Vec3& x : carried) x = input.pose.position + length * x;
    const std::vector<ChainContact> contact = contacts_of(spine, input, carried);
    spine.rest = plastic_part(spine, input.wetness);
    ChainProblem problem;
    problem.root = root / length;
    problem.frame = frame;
    problem.rest = spine.rest;
    problem.before = spine.bend;
    problem.change_weight = options_.change_weight;
    problem.contact = contact;
    problem.edge_rounding = kEdgeRounding / length;
    if (!contact.empty()) {
        problem.friction = friction_of(carried, input, length);
        problem.pore = pore_of(spine, carried, input);
    }
    ChainSolution solution = solve_chain(chain_, first_guess(spine, input, carried), problem);
    spine.bend = solution.bend;
    spine.pressure = solution.pressure;
    for (std::size_t i = 0; i < spine.node.size(); ++i) spine.node[i] = input.pose.position + length * solution.node[i];
    return solution;
}

/// Bending moment of a joint, mean of the spines, B0/L.
double ChainModel::moment_of(std::size_t joint) const {
    double sum = 0;
    for (const OneSpine& spine : spines_) {
        const double size = glm::length(spine.bend[joint] - spine.rest[joint]);
        sum += chain_.coefficient[joint] * chain_.exponent * std::pow(size, chain_.exponent - 1);
    }
    return sum / static_cast<double>(spines_.size());
}

void ChainModel::add_forces(const ChainSolution& solution, const OneSpine& spine, TuftState& state) const {
    const double share = 1.0 / static_cast<double>(spines_.size()), length = preset_.length;
    const double newton = share * preset_.stiffness / (length * length), joule = newton * length;
    for (std::size_t i = 0; i < solution.force.size(); ++i) {
        state.force += newton * solution.force[i];
        state.moment += glm::cross(spine.node[i] - pose_.position, newton * solution.force[i]);
        state.normal_force += newton * solution.pressure[i];
    }
    state.energy.bend += joule * solution.bend_energy;
    state.energy.lost += joule * std::max(0.0, solution.dissipation);
    state.converged = state.converged && solution.converged;
    state.work.iterations += solution.iterations;
}

TuftState ChainModel::step(const SpineModelInput& input) {
    const std::vector<OneSpine> before = spines_;
    std::vector<ChainSolution> solutions;
    for (OneSpine& spine : spines_) solutions.push_back(solve(spine, input));
    pose_ = input.pose;
    TuftState state;
    for (std::size_t k = 0; k < spines_.size(); ++k) add_forces(solutions[k], spines_[k], state);
    state.root_moment = moment_of(0) * preset_.stiffness / preset_.length;
    state.branches.push_back({sections_of(input, before), 1});
    return state;
}

Recycled<Section> ChainModel::sections_of(const SpineModelInput& input, const std::vector<OneSpine>& before) {
    const Recycled<Vec3> node = nodes();
    const std::vector<double> tip_first(minor_.rbegin(), minor_.rend());
    const Vec3 axis = input.pose.axis();
    WideAxis wide = find_wide_axis(node, axis, input.planes, tip_first, input.pose.rotation * wide_);
    if (spines_.size() == 2) wide = {node.size() - 1, input.pose.rotation * Vec3{1, 0, 0}};
    Recycled<Section> sections = frame_sections(node, axis, wide.at, wide.direction);
    wide_ = glm::conjugate(input.pose.rotation) * sections.back().e;
    const std::size_t count = sections.size();
    const double share = 1.0 / static_cast<double>(spines_.size()), length = preset_.length;
    for (std::size_t i = 0; i < count; ++i) {
        Section& s = sections[count - 1 - i];
        double pressure = 0;
        for (const OneSpine& spine : spines_) pressure += share * spine.pressure[i];
        const double width = 0.5 * (at_[std::min(i + 1, count - 1)] - at_[i > 0 ? i - 1 : 0]);
        s.pressure = pressure * preset_.stiffness / (length * length) / width;
        s.moment = i + 1 < count ? moment_of(i) * preset_.stiffness / length : 0;
    }
    if (spines_.size() == 2)
        carry_with_lattice(sections);
    else
        spread(sections, input, before);
    for (std::size_t i = 0; i < count; ++i) minor_[i] = sections[count - 1 - i].b;
    return sections;
}

/// Nodes with lateral nodes of their own, from root to tip: every second one, and the tip.
std::vector<std::size_t> lateral_nodes(std::size_t count) {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i + 1 < count; i += 2) out.push_back(i);
    out.push_back(count - 1);
    return out;
}

void ChainModel::spread(Recycled<Section>& sections, const SpineModelInput& input,
                        const std::vector<OneSpine>& before) {
    const std::size_t count = sections.size();
    const double length = preset_.length, newton = preset_.stiffness / (length * length);
    const double mu = 2 * (1 - preset_.grain) * std::lerp(preset_.friction_dry, preset_.friction_wet, input.wetness);
    const std::vector<std::size_t> solved = lateral_nodes(count);
    std::array<std::vector<double>, 2> major;
    for (std::size_t side = 0; side < 2; ++side) {
        LateralChain row;
        row.stretch = kCohesion * preset_.transverse_stiffness * std::lerp(kDryCohesion, 1.0, input.wetness);
        row.bend_length = kBendLength * length;
        row.reference = preset_.radius;
        row.exponent = options_.exponent;
        row.smoothing = kSmoothing;
        for (const std::size_t i : solved) {
            const double r = radius_[i], own = options_.effective_radius * minor_[i];
            const std::size_t joint = std::min(i, count - 2);
            const double part = 0.5 * (at_[joint + 1] - at_[joint > 0 ? joint - 1 : 0]) / length;
            const double curvature = glm::length(spines_[0].bend[joint]) / part;
            const double spreads = i > 0 ? kSpreading * r * curvature / kFlatCurvature : 0;
            row.at.push_back(at_[i]);
            row.outer.push_back((1 - options_.effective_radius) * r);
            row.rest.push_back(std::min(r - own + spreads, preset_.flatten_max * r));
            // Where it would be had it stayed: the spine's motion along e comes off its distance.
            const Vec3& e = sections[count - 1 - i].e;
            const double motion = glm::dot(spines_[0].node[i] - before[0].node[i], e);
            row.stuck.push_back(lateral_[side][i] - (side == 0 ? motion : -motion));
            const bool touched = i > 0 && before[0].pressure[i] > 0;
            row.drag.push_back(touched ? mu * kLateralLoad * spines_[0].pressure[i] * newton : 0);
        }
        const std::vector<double> d = solve_lateral_chain(row);
        major[side].resize(count);
        for (std::size_t k = 0; k + 1 < solved.size(); ++k) {
            for (std::size_t i = solved[k]; i <= solved[k + 1]; ++i) {
                const double f = (at_[i] - row.at[k]) / (row.at[k + 1] - row.at[k]);
                const auto ratio = [&](std::size_t q) {
                    const double r = radius_[solved[q]];
                    return std::clamp((d[q] + options_.effective_radius * minor_[solved[q]]) / r, kLeastWidth,
                                      preset_.flatten_max);
                };
                major[side][i] = radius_[i] * std::lerp(ratio(k), ratio(k + 1), f);
                lateral_[side][i] = major[side][i] - options_.effective_radius * minor_[i];
            }
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        Section& s = sections[count - 1 - i];
        s.a = 0.5 * (major[0][i] + major[1][i]);
        s.b = radius_[i] * radius_[i] / s.a;
        s.centre += 0.5 * (major[0][i] - major[1][i]) * s.e;
    }
}

void ChainModel::carry_with_lattice(Recycled<Section>& sections) const {
    const std::size_t count = sections.size();
    std::array<std::vector<Vec3>, 2> outward, across;
    std::vector<double> at;
    for (std::size_t i = 0; i < count; ++i) {
        const Section& s = sections[count - 1 - i];
        at.push_back(at_[i] / preset_.length);
        for (std::size_t k = 0; k < 2; ++k) {
            // At rest the spines are at the centroids of two halves of the root's section, the lattice is its square.
            const double out = half_width_[0] * (1 - centroid());
            outward[k].push_back((k == 0 ? -out : out) * s.e);
            across[k].push_back(radius_[0] * s.m);
        }
    }
    const LatticeSpines spines{
        at, {spines_[0].node, spines_[1].node}, {outward[0], outward[1]}, {across[0], across[1]}};
    const Lattice lattice = span_lattice(spines, kLatticeDegree);
    for (std::size_t i = 0; i < count; ++i) {
        Section& s = sections[count - 1 - i];
        const double wide = half_width_[i], half = 0.5 * wide / half_width_[0];
        s.centre = lattice_point(lattice, 0.5, 0.5, at[i]);
        const Vec3 e = lattice_point(lattice, 0.5 + half, 0.5, at[i]) - lattice_point(lattice, 0.5 - half, 0.5, at[i]);
        s.a = std::clamp(0.5 * glm::dot(e, s.e), kLeastWidth * wide, preset_.flatten_max * wide);
        s.b = radius_[i] * wide / s.a;
    }
}

}  // namespace

std::unique_ptr<SpineModel> make_chain_model(const Preset& preset, const ChainOptions& options) {
    return std::make_unique<ChainModel>(preset, options);
}

}  // namespace tuft::brush
