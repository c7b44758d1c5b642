#include "contact/columns.h"

namespace tuft::contact {
namespace {

/// Where the column that ends at `node` begins, in the mouth.
Vec3 mouth_of(const brush::Pose& pose, const Vec3& node) {
    const Vec3 axis = pose.axis();
    return node - glm::dot(node - pose.position, axis) * axis;
}

}  // namespace

void move_to_columns(const mesh::SurfaceQuery& surface, const brush::Pose& pose, const NodeContact& root, double length,
                     std::span<Vec3> nodes) {
    const Vec3 axis = pose.axis();
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
        const auto hit = surface.ray(mouth_of(pose, nodes[i]), axis, 0, length);
        if (hit && root.side * glm::dot(hit->face_normal, axis) < 0) nodes[i] = hit->position;
    }
}

Recycled<NodeContact> find_column_contacts(const mesh::SurfaceQuery& surface, const brush::Pose& pose,
                                           const NodeContact& root, std::span<const Vec3> nodes,
                                           const NodeContactOptions& options) {
    Recycled<NodeContact> out;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        Vec3 from = i + 1 < nodes.size() ? mouth_of(pose, nodes[i]) : root.outside;
        const Vec3 aside = from - root.outside;
        const double far = glm::length(aside);
        // A wall beside the ferrule: that side of the mouth is behind it.
        if (far > 0 && surface.ray(root.outside, aside / far, 0, far)) from = root.outside;
        out.push_back(find_node_contact(surface, {nodes[i], from, root.side}, options));
    }
    return out;
}

}  // namespace tuft::contact
