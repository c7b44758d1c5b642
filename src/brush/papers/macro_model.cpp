#include "brush/papers/macro_model.h"

#include <algorithm>
#include <cmath>

#include "brush/papers/macro/macro_cluster.h"
#include "brush/papers/space/frames.h"
#include "brush/preset/rest_shape.h"

namespace tuft::brush::macro {

namespace {

constexpr double kEndOn = 0.1;   ///< of r: depth of contact of hair that stands on its end
constexpr double kMoves = 1e-6;  ///< of the length, a motion with a direction
constexpr int kMostMacros = 10;  ///< 1/least_share

/// Part of a motion along the surface, as a unit vector; zero for a rest.
Vec3 direction_along(const Vec3& motion, const Vec3& n, double least) {
    const Vec3 along = motion - glm::dot(motion, n) * n;
    const double size = glm::length(along);
    return size > least ? along / size : Vec3{0};
}

class MacroModel final : public SpineModel {
  public:
    explicit MacroModel(const Preset& preset)
        : preset_(preset), profile_(profile_of(preset)), row_(make_hair_row(preset)), law_(make_macro_law(preset)) {
        straighten({});
    }

    std::unique_ptr<SpineModel> clone() const override { return std::make_unique<MacroModel>(*this); }
    Recycled<Vec3> nodes() const override { return {nodes_.begin(), nodes_.end()}; }
    TuftState step(const SpineModelInput& input) override;
    void straighten(const Pose& pose) override;

  private:
    Collision collision_of(const SpineModelInput& input);
    std::vector<Vec3> mean_nodes() const;
    void bend(Collision& collision, double dt);
    void split_all(const Collision& collision, double wetness);
    TuftState make_state(const Collision& collision, double wetness) const;
    void load(const HairMacro& macro, const Collision& c, double wetness, Branch& branch, TuftState& state) const;
    void note_nodes(const TuftState& state);

    Preset preset_;
    Profile profile_;
    HairRow row_;
    MacroLaw law_;
    std::vector<MacroCluster> clusters_;
    Pose pose_;
    Vec2 across_{1, 0};  // of the first split, ferrule frame
    Vec3 aside_{0};      // unit, against the hand's last motion over the surface, world; zero: none yet
    std::vector<Vec3> nodes_;
};

void MacroModel::straighten(const Pose& pose) {
    clusters_.assign(1, {make_macro(row_, pose), {}});
    pose_ = pose;
    aside_ = Vec3{0};
    nodes_.clear();
    for (const double t : row_.t) nodes_.push_back(pose.position + (1 - t) * row_.length * pose.axis());
}

Collision MacroModel::collision_of(const SpineModelInput& input) {
    Collision c{.pose = input.pose, .planes = input.planes};
    const Vec3 n = input.planes.empty() ? -input.pose.axis() : input.planes.front().normal;
    c.push = direction_along(input.pose.position - pose_.position, n, kMoves * row_.length);
    if (c.push != Vec3{0}) aside_ = -c.push;
    // Hair that was never moved falls to the ferrule's x.
    c.aside = aside_ != Vec3{0} ? aside_ : input.pose.rotation * Vec3{1, 0, 0};
    return c;
}

/// Mean of all macros, weighted by their hair.
std::vector<Vec3> MacroModel::mean_nodes() const {
    std::vector<Vec3> mean(row_.t.size(), Vec3{0});
    for (const HairMacro& macro : macros_of(clusters_, across_, pose_)) {
        const std::vector<Vec3> nodes = nodes_of(macro.skeleton, row_);
        for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += macro.rest.share * nodes[i];
    }
    return mean;
}

void MacroModel::bend(Collision& collision, double dt) {
    release_copies(clusters_, collision, pose_);
    for (MacroCluster& cluster : clusters_) {
        move_rigidly(cluster.primitive, pose_, collision.pose);
        recover(cluster.primitive, collision.pose, law_, dt);
    }
    pose_ = collision.pose;
    const std::vector<Vec3> trunk = mean_nodes();
    collision.trunk = trunk;
    for (MacroCluster& cluster : clusters_) {
        collide(cluster.primitive, row_, law_, collision);
        distend(cluster.primitive, row_, law_);
    }
    collision.trunk = {};
}

void MacroModel::split_all(const Collision& collision, double wetness) {
    const double threshold = law_.split_threshold(wetness);
    for (int round = 0; round < kMostMacros; ++round) {
        std::vector<HairMacro> whole;
        bool changed = false;
        for (const HairMacro& macro : macros_of(clusters_, across_, pose_)) {
            std::vector<HairMacro> parts = split(macro, row_, law_, threshold, collision);
            if (parts.empty()) {
                whole.push_back(macro);
                continue;
            }
            if (clusters_.size() == 1 && clusters_.front().copies.empty()) {
                const Vec2 away = parts.back().rest.offset - parts.front().rest.offset;
                if (glm::length(away) > 0) across_ = glm::normalize(away);
            }
            changed = true;
            for (HairMacro& part : parts) {
                distend(part, row_, law_);
                whole.push_back(std::move(part));
            }
        }
        if (!changed) return;
        clusters_ = cluster_of(std::move(whole), pose_, row_.length);
    }
}

TuftState MacroModel::step(const SpineModelInput& input) {
    Collision collision = collision_of(input);
    bend(collision, input.dt);
    split_all(collision, input.wetness);
    TuftState state = make_state(collision, input.wetness);
    note_nodes(state);
    return state;
}

TuftState MacroModel::make_state(const Collision& collision, double wetness) const {
    TuftState state;
    for (const HairMacro& macro : macros_of(clusters_, across_, pose_)) {
        Branch branch{macro_sections(macro, row_, law_, pose_, collision.planes), macro.rest.share};
        // All branches are seen from the side of the first.
        if (!state.branches.empty() && glm::dot(branch.sections.back().e, state.branches[0].sections.back().e) < 0)
            for (Section& s : branch.sections) {
                s.e = -s.e;
                s.m = -s.m;
            }
        load(macro, collision, wetness, branch, state);
        state.branches.push_back(std::move(branch));
    }
    state.work.iterations = static_cast<int>(clusters_.size());
    return state;
}

/// Pressures and moments of a branch, and its part of the forces.
void MacroModel::load(const HairMacro& macro, const Collision& c, double wetness, Branch& branch,
                      TuftState& state) const {
    const double mu = std::lerp(preset_.friction_dry, preset_.friction_wet, wetness);
    for (std::size_t i = 0; i < branch.sections.size(); ++i) {
        Section& s = branch.sections[i];
        const double stiffness = preset_.stiffness * bending_stiffness(profile_, 1 - row_.t[i]);
        s.moment = macro.rest.share * stiffness * curvature(macro.skeleton, row_.t[i]);
        if (c.planes.empty()) continue;
        const ContactPlane& plane = plane_of(c.planes, i);
        const double lean = glm::length(glm::cross(s.tangent, plane.normal));
        const double depth = row_.radius[i] * std::max(lean, kEndOn) - std::max(0.0, height_over(plane, s.centre));
        if (depth <= 0) continue;
        s.pressure = macro.rest.share * preset_.transverse_stiffness * depth;
        const double normal = s.pressure * row_.weight[i] * row_.length;
        const Vec3 force = normal * (plane.normal - mu * c.push);
        state.normal_force += normal;
        state.force += force;
        state.moment += glm::cross(s.centre - c.pose.position, force);
    }
    state.root_moment += branch.sections.back().moment;
}

/// The trunk: the mean of all macros, weighted by their hair.
void MacroModel::note_nodes(const TuftState& state) {
    std::fill(nodes_.begin(), nodes_.end(), Vec3{0});
    for (const Branch& branch : state.branches)
        for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_[i] += branch.ink_share * branch.sections[i].centre;
    if (state.branches.size() > 1) nodes_.back() = pose_.position;
}

}  // namespace

}  // namespace tuft::brush::macro

namespace tuft::brush {

std::unique_ptr<SpineModel> make_macro_model(const Preset& preset) {
    return std::make_unique<macro::MacroModel>(preset);
}

}  // namespace tuft::brush
