#include "brush/papers/truss_model.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "brush/papers/space/frames.h"
#include "brush/papers/truss_force.h"
#include "brush/preset/rest_shape.h"
#include "brush/rod/profile.h"
#include "core/ease.h"

namespace tuft::brush::truss {

namespace {

constexpr int kShortSteps = 400;      ///< of one step of the brush, at most
constexpr int kSkinLevels = 3;        ///< refinements of the skin
constexpr double kNudge = 1e-3;       ///< of the length, of a point on its unstable balance
constexpr double kTrails = 1e-6;      ///< of the length, a motion with a direction
constexpr double kInkFilm = 1e-5;     ///< m, a section this far off the surface still carries load
constexpr double kHandleOver = 40;    ///< k2/k1
constexpr double kDragOver = 1;       ///< k_t/k1, s/m
constexpr double kLeastAlong = 0.02;  ///< of the length: least l_p, where the head lies along the surface

constexpr double kLeaves = 0.3;    ///< u up to which sections turn from the ferrule's plane across the hair
constexpr double kSteepest = 0.2;  ///< cosine between hair and section

/// Heights u of the rings of the control mesh; a toe is the last ring, a point closes behind the one before.
constexpr std::array<double, 7> kRingHeights{0, 0.25, 0.5, 0.75, 0.9, 0.97, 1};
/// Widths of a filbert's rings over that of its base: the toe spans the two inner trusses [X].
constexpr std::array<double, 7> kFilbertWidths{1, 1, 1, 1, 0.8, 0.55, 0.25};

std::vector<RingShape> ring_shapes(const Preset& p, const Shape& shape) {
    std::vector<RingShape> rings;
    const double root = rest_radius(p, 0);
    const bool round = shape.kind == Kind::round;
    for (std::size_t k = 0; k < kRingHeights.size() - (round ? 1 : 0); ++k) {
        const double taper = rest_radius(p, kRingHeights[k]) / root;
        const double width = round ? taper : shape.kind == Kind::filbert ? kFilbertWidths[k] : 1;
        rings.push_back({kRingHeights[k], shape.half_width * width, shape.half_thickness * taper});
    }
    return rings;
}

/// Sections of the skin at the nodes, tip first.
std::vector<SkinSection> node_sections(const Preset& p, const Shape& shape, const Truss& truss) {
    const std::vector<SkinSection> fine = skin_sections(truss, ring_shapes(p, shape), kSkinLevels);
    std::vector<SkinSection> out;
    double u = 0;
    out.push_back(section_at(fine, u));
    for (const double l : spine_segments(p.segments, 0.25 + 0.75 * p.hardness)) {
        u += l;
        out.push_back(section_at(fine, u));
    }
    std::reverse(out.begin(), out.end());
    out.front() = fine.back();
    return out;
}

/// Turns a section from across the hair to the plane of the ferrule, all of it at the root: the skin's rings are
/// parallel to the base, so that none comes out of the ferrule at an angle.
void lean_to_ferrule(Section& s, const Vec3& axis, double u) {
    const Vec3 mixed = glm::mix(axis, s.tangent, smooth_step(u / kLeaves));
    if (u >= kLeaves || glm::length(mixed) < kSteepest) return;
    const Vec3 tangent = u > 0 ? glm::normalize(mixed) : axis, e = parallel_transport(s.e, s.tangent, tangent);
    s.tangent = tangent;
    s.e = glm::normalize(e - glm::dot(e, tangent) * tangent);
    s.m = glm::cross(s.e, s.tangent);
}

class TrussModel final : public SpineModel {
  public:
    TrussModel(const Preset& preset, const Shape& shape)
        : preset_(preset),
          shape_(shape),
          truss_(make_truss(shape, preset.stiffness)),
          skin_(node_sections(preset, shape, truss_)) {
        straighten({});
    }

    std::unique_ptr<SpineModel> clone() const override { return std::make_unique<TrussModel>(*this); }
    Recycled<Vec3> nodes() const override { return {nodes_.begin(), nodes_.end()}; }
    TuftState step(const SpineModelInput& input) override;
    void straighten(const Pose& pose) override;

  private:
    double friction(double wetness) const { return std::lerp(preset_.friction_dry, preset_.friction_wet, wetness); }
    StepContact step_contact(const SpineModelInput& input) const;
    void nudge(const SpineModelInput& input, const StepContact& contact);
    void move(const SpineModelInput& input);
    Vec3 contact_force(const SpineModelInput& input) const;
    Recycled<Section> make_sections(const SpineModelInput& input);
    void share_load(const SpineModelInput& input, TuftState& state) const;

    Preset preset_;
    Shape shape_;
    Truss truss_;
    std::vector<SkinSection> skin_;
    std::vector<Vec3> particles_;  // metres, world
    std::vector<Vec3> nodes_;
    Pose pose_;
    Vec3 wide_{1, 0, 0};  // e at the root of the last step, ferrule frame
    Vec3 aside_{0};       // unit, against the hand's last motion; zero: none yet
};

void TrussModel::straighten(const Pose& pose) {
    particles_.clear();
    for (const Vec3& p : truss_.rest) particles_.push_back(pose.position + pose.rotation * p);
    pose_ = pose;
    wide_ = Vec3{1, 0, 0};
    aside_ = Vec3{0};
    nodes_.clear();
    for (const SkinSection& s : skin_) nodes_.push_back(s.centre(particles_));
}

StepContact TrussModel::step_contact(const SpineModelInput& input) const {
    StepContact contact{{}, friction(input.wetness)};
    for (int j = 0; j < truss_.count && !input.planes.empty(); ++j)
        contact.below.push_back(half_space_of(input.planes.front(), particles_[truss_.base_count() + j]));
    return contact;
}

/// A point pressed straight down balances; the hair falls behind the hand's motion.
void TrussModel::nudge(const SpineModelInput& input, const StepContact& contact) {
    if (contact.below.empty()) return;
    const Vec3& n = contact.below.front().normal;
    const Vec3 moved = input.pose.position - pose_.position, along = moved - glm::dot(moved, n) * n;
    if (glm::length(along) > kTrails * preset_.length) aside_ = -glm::normalize(along);
    const Vec3 to = aside_ != Vec3{0} ? aside_ : input.pose.rotation * Vec3{1, 0, 0};
    for (int j = 0; j < truss_.count; ++j) {
        const int i = truss_.base_count() + j;
        const Vec3 at_rest = input.pose.position + input.pose.rotation * truss_.rest[i];
        const Vec3 off = particles_[i] - at_rest, across = off - glm::dot(off, pose_.axis()) * pose_.axis();
        if (contact.below[j].height(at_rest) < 0 && glm::length(across) < kNudge * preset_.length)
            particles_[i] += kNudge * preset_.length * (to - glm::dot(to, n) * n);
    }
}

void TrussModel::move(const SpineModelInput& input) {
    const std::vector<Vec3> before(particles_.begin(), particles_.begin() + truss_.base_count());
    const StepContact contact = step_contact(input);
    nudge(input, contact);
    // Four edges meet at a point, and the springs to its neighbours.
    const double stiffest = truss_.stiffness * (4 + std::min(2, truss_.count - 1));
    const double wanted = std::ceil(input.dt * stiffest / truss_.drag);
    const int steps = static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(kShortSteps)));
    const std::vector<double> matrix = step_matrix(truss_, input.dt / steps);
    for (int k = 1; k <= steps; ++k) {
        for (int i = 0; i < truss_.base_count(); ++i) {
            const Vec3 after = input.pose.position + input.pose.rotation * truss_.rest[i];
            particles_[i] = k == steps ? after : glm::mix(before[i], after, static_cast<double>(k) / steps);
        }
        move_points(truss_, matrix, contact, particles_);
    }
    limit_stretch(truss_, contact, particles_);
}

/// The force law of 4.2 to 4.4, newtons, world.
Vec3 TrussModel::contact_force(const SpineModelInput& input) const {
    if (input.planes.empty()) return Vec3{0};
    const Vec3 axis = input.pose.axis(), point = input.pose.position + preset_.length * axis;
    const HalfSpace space = half_space_of(input.planes.front(), point);
    const double cosine = std::clamp(-glm::dot(axis, space.normal), -1.0, 1.0);
    const double along = preset_.length * std::max(cosine, kLeastAlong);
    const double k1 = preset_.stiffness / (preset_.length * preset_.length);
    const double normal = head_force(-space.height(point), along, std::acos(cosine), {k1, kHandleOver * k1});
    if (!(input.dt > 0)) return normal * space.normal;
    const Vec3 v = (input.pose.position - pose_.position) / input.dt;
    const Vec3 drag = kDragOver * k1 * (v - glm::dot(v, space.normal) * space.normal);
    const double size = glm::length(drag), most = friction(input.wetness) * normal;
    return normal * space.normal - (size > most ? most / size : 1.0) * drag;
}

Recycled<Section> TrussModel::make_sections(const SpineModelInput& input) {
    std::vector<double> radius;
    for (std::size_t k = 0; k < skin_.size(); ++k) {
        nodes_[k] = skin_[k].centre(particles_);
        radius.push_back(skin_[k].semi_axis(truss_.rest, {0, 1, 0}));
        if (!input.planes.empty() && k + 1 < skin_.size())
            nodes_[k] = half_space_of(plane_of(input.planes, k), nodes_[k]).projected(nodes_[k]);
    }
    nodes_.back() = input.pose.position;
    const Vec3 axis = input.pose.axis(), broad = input.pose.rotation * Vec3{1, 0, 0};
    WideAxis wide{nodes_.size() - 1, broad};
    if (shape_.kind == Kind::round)
        wide = find_wide_axis(nodes_, axis, input.planes, radius, input.pose.rotation * wide_);
    Recycled<Section> sections = frame_sections(nodes_, axis, wide.at, wide.direction);
    for (std::size_t k = 0; k < sections.size(); ++k) {
        Section& s = sections[k];
        const Vec3 along = k + 1 < sections.size() ? s.tangent : axis;
        lean_to_ferrule(s, axis, skin_[k].u);
        // A cut of the skin by the section's plane: its ring, projected along the hair.
        const double slope = 1 / std::max(glm::dot(along, s.tangent), kSteepest);
        const Vec3 e = s.e - slope * glm::dot(along, s.e) * s.tangent,
                   m = s.m - slope * glm::dot(along, s.m) * s.tangent;
        s.a = std::max(skin_[k].semi_axis(particles_, e), preset_.tip_radius);
        s.b = std::max(skin_[k].semi_axis(particles_, m), preset_.tip_radius);
    }
    wide_ = glm::conjugate(input.pose.rotation) * sections.back().e;
    return sections;
}

/// Spreads the normal force over the sections that touch, and the springs' moments along the hair.
void TrussModel::share_load(const SpineModelInput& input, TuftState& state) const {
    Recycled<Section>& sections = state.branches.front().sections;
    const std::vector<Vec3> force = spring_forces(truss_, particles_);
    for (int j = 0; j < truss_.count; ++j) {
        const int i = truss_.base_count() + j;
        for (Section& s : sections) s.moment += glm::length(glm::cross(particles_[i] - s.centre, force[i]));
    }
    state.root_moment = sections.back().moment;
    if (!(state.normal_force > 0)) return;
    std::vector<double> weight(sections.size(), 0), length(sections.size(), 0);
    double sum = 0;
    Vec3 middle{0};
    for (std::size_t k = 0; k < sections.size(); ++k) {
        const Section& s = sections[k];
        const HalfSpace space = half_space_of(plane_of(input.planes, k), s.centre);
        const double reach = std::hypot(s.a * glm::dot(s.e, space.normal), s.b * glm::dot(s.m, space.normal));
        for (const std::size_t other : {k > 0 ? k - 1 : k, std::min(k + 1, sections.size() - 1)})
            length[k] += 0.5 * preset_.length * std::abs(skin_[k].u - skin_[other].u);
        weight[k] = std::max(0.0, reach + kInkFilm - space.height(s.centre)) * length[k];
        sum += weight[k];
        middle += weight[k] * s.centre;
    }
    if (!(sum > 0)) {
        // All of it is at the point.
        weight.front() = sum = 1;
        middle = sections.front().centre;
    }
    for (std::size_t k = 0; k < sections.size(); ++k)
        sections[k].pressure = state.normal_force * weight[k] / sum / length[k];
    state.moment = glm::cross(middle / sum - input.pose.position, state.force);
}

TuftState TrussModel::step(const SpineModelInput& input) {
    move(input);
    TuftState state;
    state.branches.push_back({make_sections(input), 1});
    state.force = contact_force(input);
    if (!input.planes.empty()) state.normal_force = glm::dot(state.force, input.planes.front().normal);
    state.energy.bend = spring_energy(truss_, particles_);
    share_load(input, state);
    pose_ = input.pose;
    return state;
}

}  // namespace

}  // namespace tuft::brush::truss

namespace tuft::brush {

std::unique_ptr<SpineModel> make_truss_model(const Preset& preset) {
    const double radius = rest_radius(preset, 0);
    return std::make_unique<truss::TrussModel>(preset, truss::Shape{truss::Kind::round, preset.length, radius, radius});
}

std::unique_ptr<SpineModel> make_truss_model(const Preset& preset, truss::Kind kind, double width, double thickness) {
    return std::make_unique<truss::TrussModel>(preset, truss::Shape{kind, preset.length, 0.5 * width, 0.5 * thickness});
}

}  // namespace tuft::brush
