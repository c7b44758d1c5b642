#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "brush/tuft/foam.h"

/// \file
/// Columns of a sponge against its planes.
namespace tuft::brush {

namespace {

constexpr double kFacesDown = 0.1;    ///< cosine from which skin is the end of a column
constexpr double kLeastCosine = 0.2;  ///< of the axis to the normal: flatter columns count as if so
constexpr double kMostStrain = 0.98;
constexpr double kMostLean = 0.6;      ///< of the height, shear at which the face lets go
constexpr double kNodeRadius = 2e-4;   ///< m, of a node's section: a place of the face, which is thin
constexpr double kStick = 0.3;         ///< of the face's radius, of the stick in the mouth
constexpr double kNodesWithin = 0.85;  ///< of the half-widths

/// A point of the body in its column.
struct Column {
    double depth = 0;  ///< m, of the point from the mouth
    double end = 0;    ///< m, of the column's end
    double area = 0;   ///< m² across the axis that ends here; 0: no end of a column
};

/// Weight of a node's plane at a point.
struct PlaneWeight {
    std::uint32_t node = 0;
    double weight = 0;
};

/// What does not change of a sponge.
struct FoamBody {
    Preset preset;
    std::shared_ptr<const CarriedShape> shape;
    std::vector<Column> columns;              ///< [points]
    std::vector<std::uint32_t> first_weight;  ///< [points + 1]
    std::vector<PlaneWeight> weights;
    std::vector<Vec3> nodes;  ///< [segments + 1] rest, ferrule frame
};

std::vector<Column> columns_of(const CarriedShape& shape) {
    const std::size_t n = shape.rest.size();
    std::vector<Column> out(n);
    std::vector<Vec3> normal(n, Vec3{0});
    for (const auto& t : shape.triangles) {
        const Vec3 &p = shape.rest[t[0]], &q = shape.rest[t[1]], &r = shape.rest[t[2]];
        const Vec3 a = glm::cross(q - p, r - p) / 6.0;
        for (const std::uint32_t v : t) {
            normal[v] += a;
            out[v].area += std::max(0.0, -a.z);
        }
    }
    std::vector<std::uint32_t> ends;
    for (std::uint32_t v = 0; v < n; ++v) {
        out[v].depth = out[v].end = -shape.rest[v].z;
        if (normal[v].z < -kFacesDown * glm::length(normal[v])) ends.push_back(v);
    }
    std::vector<char> is_end(n, 0);
    for (const std::uint32_t v : ends) is_end[v] = 1;
    for (std::uint32_t v = 0; v < n; ++v) {
        if (is_end[v]) continue;
        double best = 1e9;
        for (const std::uint32_t e : ends) {
            const Vec2 off = Vec2(shape.rest[e]) - Vec2(shape.rest[v]);
            const double d = glm::dot(off, off);
            if (d >= best) continue;
            best = d;
            out[v].end = std::max(out[v].depth, out[e].depth);
        }
    }
    return out;
}

/// Places over the face: the middle, then Vogel's spiral; last the mouth.
std::vector<Vec3> make_nodes(const CarriedShape& shape, const std::vector<Column>& columns, int count) {
    const Vec2 middle = 0.5 * (shape.lo + shape.hi), half = kNodesWithin * 0.5 * (shape.hi - shape.lo);
    std::vector<Vec3> out;
    for (int k = 0; k < count; ++k) {
        const double r = count > 1 ? std::sqrt(static_cast<double>(k) / (count - 1)) : 0,
                     w = std::numbers::pi * (3 - std::sqrt(5.0)) * k;
        const Vec2 at = middle + half * (r * Vec2{std::cos(w), std::sin(w)});
        double best = 1e9, depth = 0;
        for (std::size_t v = 0; v < columns.size(); ++v) {
            const Vec2 off = Vec2(shape.rest[v]) - at;
            if (columns[v].area > 0 && glm::dot(off, off) < best) best = glm::dot(off, off), depth = columns[v].depth;
        }
        out.emplace_back(at, -depth);
    }
    out.emplace_back(0, 0, 0);
    return out;
}

/// Weights that sum to one, smooth, of the nodes around each point.
void weigh_nodes(FoamBody& body) {
    const Vec2 size = body.shape->hi - body.shape->lo;
    const std::size_t count = body.nodes.size() - 1;  // without the mouth
    const double reach = 1.3 * std::sqrt(size.x * size.y / static_cast<double>(count));
    for (const Vec3& p : body.shape->rest) {
        body.first_weight.push_back(static_cast<std::uint32_t>(body.weights.size()));
        const std::size_t first = body.weights.size();
        double sum = 0, nearest = 1e9;
        std::uint32_t closest = 0;
        for (std::uint32_t k = 0; k < count; ++k) {
            const double d = glm::distance(Vec2(p), Vec2(body.nodes[k])) / reach;
            if (d < nearest) nearest = d, closest = k;
            if (d >= 1) continue;
            const double w = (1 - d * d) * (1 - d * d);
            body.weights.push_back({k, w});
            sum += w;
        }
        if (!(sum > 1e-6)) {
            body.weights.resize(first);
            body.weights.push_back({closest, 1});
            sum = 1;
        }
        for (std::size_t i = first; i < body.weights.size(); ++i) body.weights[i].weight /= sum;
    }
    body.first_weight.push_back(static_cast<std::uint32_t>(body.weights.size()));
}

struct SkinContact {
    double height = 0;
    Vec3 normal{0, 0, 1};
};

class FoamModel : public SpineModel {
  public:
    explicit FoamModel(std::shared_ptr<const FoamBody> body) : body_(std::move(body)) { straighten(Pose{}); }

    std::unique_ptr<SpineModel> clone() const override { return std::make_unique<FoamModel>(*this); }
    bool assign(const SpineModel& other) override {
        const auto* const foam = dynamic_cast<const FoamModel*>(&other);
        if (foam) *this = *foam;
        return foam != nullptr;
    }
    Recycled<Vec3> nodes() const override { return nodes_; }
    TuftState step(const SpineModelInput& input) override;
    void straighten(const Pose& pose) override;

  private:
    SkinContact contact_at(std::span<const ContactPlane> planes, std::size_t point, const Vec3& p) const;
    void press(const SpineModelInput& input, TuftState& state);
    void lean(const SpineModelInput& input, TuftState& state);
    void make_sections(const SpineModelInput& input, TuftState& state);
    Vec3 rest_at(const Pose& pose, const Vec3& rest, double part) const {
        return pose.position + pose.rotation * rest + part * lean_;
    }
    /// Depth along the axis, metres, of a column's end at that height.
    static double pressed(const Vec3& axis, const SkinContact& contact, double end) {
        const double cosine = std::max(kLeastCosine, -glm::dot(axis, contact.normal));
        return std::clamp(-contact.height / cosine, 0.0, kMostStrain * end);
    }

    std::shared_ptr<const FoamBody> body_;
    Recycled<Vec3> nodes_;
    Pose pose_;
    Vec3 lean_{0};  // m, world: of the face against the mouth, along the surface
    bool touching_ = false;
    double touching_area_ = 0;  // m²
    Vec3 normal_{0, 0, 1};      // of the surface under the contact
};

void FoamModel::straighten(const Pose& pose) {
    lean_ = Vec3{0};
    touching_ = false;
    pose_ = pose;
    nodes_.clear();
    for (const Vec3& n : body_->nodes) nodes_.push_back(rest_at(pose, n, 1));  // without lean also the mouth's
}

SkinContact FoamModel::contact_at(std::span<const ContactPlane> planes, std::size_t point, const Vec3& p) const {
    if (planes.size() == 1) return {height_over(planes[0], p), planes[0].normal};
    SkinContact contact{0, Vec3{0}};
    for (std::uint32_t i = body_->first_weight[point]; i < body_->first_weight[point + 1]; ++i) {
        const auto& [node, weight] = body_->weights[i];
        contact.height += weight * height_over(planes[node], p);
        contact.normal += weight * planes[node].normal;
    }
    const double size = glm::length(contact.normal);
    contact.normal = size > 1e-9 ? contact.normal / size : planes[0].normal;
    return contact;
}

/// Normal forces, and the volume lost. Adds up in the order of the points.
void FoamModel::press(const SpineModelInput& input, TuftState& state) {
    const Preset& p = body_->preset;
    const Vec3 axis = input.pose.axis();
    touching_area_ = 0;
    Vec3 normals{0};
    for (std::size_t v = 0; v < body_->columns.size(); ++v) {
        const Column& column = body_->columns[v];
        if (!(column.area > 0)) continue;
        const Vec3 at = rest_at(input.pose, body_->shape->rest[v], 1);
        const SkinContact contact = contact_at(input.planes, v, at);
        const double depth = pressed(axis, contact, column.end);
        if (!(depth > 0)) continue;
        const double strain = std::min(depth / p.length, kMostStrain);
        const double axial = p.modulus * foam_stress(p.solid, strain) * column.area;
        const Vec3 force = axial / std::max(kLeastCosine, -glm::dot(axis, contact.normal)) * contact.normal;
        state.force += force;
        state.moment += glm::cross(at - depth * axis - input.pose.position, force);
        state.normal_force += glm::length(force);
        state.energy.contact += p.modulus * foam_energy(p.solid, strain) * column.area * p.length;
        state.volume_lost += column.area * depth;
        touching_area_ += column.area;
        normals += column.area * contact.normal;
    }
    if (touching_area_ > 0) normal_ = glm::normalize(normals);
}

/// The face stays where it touches until it slides; returns to the axis in air.
void FoamModel::lean(const SpineModelInput& input, TuftState& state) {
    const Preset& p = body_->preset;
    if (!(touching_area_ > 0)) {
        lean_ = Vec3{0};
        return;
    }
    lean_ -= glm::dot(lean_, normal_) * normal_;
    const double stiffness = 0.5 * p.modulus * touching_area_ / p.length,
                 friction = std::lerp(p.friction_dry, p.friction_wet, input.wetness);
    const double most = std::min(friction * state.normal_force / stiffness, kMostLean * p.length),
                 size = glm::length(lean_);
    if (size > most) {
        lean_ *= most / size;
        state.energy.lost += stiffness * most * (size - most);
    }
    const Vec3 force = stiffness * lean_;
    state.force += force;
    state.moment += glm::cross(p.length * input.pose.axis() + lean_, force);
    state.energy.aside += 0.5 * stiffness * glm::dot(lean_, lean_);
}

void FoamModel::make_sections(const SpineModelInput& input, TuftState& state) {
    const Vec3 axis = input.pose.axis(), e = input.pose.rotation * Vec3{1, 0, 0};
    Branch branch;
    branch.sections.reserve(body_->nodes.size());
    for (std::size_t k = 0; k + 1 < body_->nodes.size(); ++k) {
        Section s{.tangent = axis, .e = e, .m = glm::cross(e, axis), .a = kNodeRadius, .b = kNodeRadius};
        Vec3 at = rest_at(input.pose, body_->nodes[k], 1);
        if (!input.planes.empty()) {
            const ContactPlane& plane = input.planes.size() == 1 ? input.planes[0] : input.planes[k];
            const double depth = pressed(axis, {height_over(plane, at), plane.normal}, -body_->nodes[k].z);
            at -= depth * axis;
        }
        s.centre = at;
        nodes_[k] = at;
        branch.sections.push_back(s);
    }
    const double stick = kStick * body_->preset.radius;
    nodes_.back() = input.pose.position;
    branch.sections.push_back(
        {.centre = nodes_.back(), .tangent = axis, .e = e, .m = glm::cross(e, axis), .a = stick, .b = stick});
    state.branches.push_back(std::move(branch));
}

TuftState FoamModel::step(const SpineModelInput& input) {
    const CarriedShape& shape = *body_->shape;
    TuftState state;
    state.shape.carried = body_->shape;
    const Pose& pose = input.pose;
    if (touching_) {
        const double length = body_->preset.length;
        lean_ -= pose.position + length * pose.axis() - pose_.position - length * pose_.axis();
        lean_ -= glm::dot(lean_, normal_) * normal_;
    }
    if (!input.planes.empty())
        press(input, state);
    else
        touching_area_ = 0;
    lean(input, state);
    make_sections(input, state);
    const Vec3 axis = pose.axis();
    state.shape.position.reserve(shape.rest.size());
    if (!input.planes.empty()) {
        state.shape.height.reserve(shape.rest.size());
        state.shape.normal.reserve(shape.rest.size());
    }
    for (std::size_t v = 0; v < shape.rest.size(); ++v) {
        const Column& column = body_->columns[v];
        const double part = column.end > 0 ? column.depth / column.end : 0;
        const Vec3 at = rest_at(pose, shape.rest[v], part);
        if (input.planes.empty()) {
            state.shape.position.push_back(at);
            continue;
        }
        const SkinContact contact = contact_at(input.planes, v, at);
        double depth = pressed(axis, contact, column.end);
        if (part < 1) {
            const Vec3 end = rest_at(pose, {Vec2(shape.rest[v]), -column.end}, 1);
            depth = pressed(axis, contact_at(input.planes, v, end), column.end);
        }
        state.shape.position.push_back(at - depth * part * axis);
        state.shape.height.push_back(contact.height);
        state.shape.normal.push_back(contact.normal);
    }
    touching_ = touching_area_ > 0;
    pose_ = pose;
    return state;
}

}  // namespace

std::unique_ptr<SpineModel> make_foam_model(const Preset& preset, std::shared_ptr<const CarriedShape> shape) {
    auto body = std::make_shared<FoamBody>();
    body->preset = preset;
    body->columns = columns_of(*shape);
    body->nodes = make_nodes(*shape, body->columns, preset.segments);
    body->shape = std::move(shape);
    weigh_nodes(*body);
    return std::make_unique<FoamModel>(std::move(body));
}

}  // namespace tuft::brush
