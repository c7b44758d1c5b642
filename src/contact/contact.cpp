#include "contact/contact.h"

#include <algorithm>
#include <cmath>

namespace tuft::contact {
namespace {

using brush::ContactPlane;

// The surface that node `p` meets, on the side of the ferrule's mouth `root`.
ContactPlane node_plane(const mesh::SurfaceQuery& surface, const Vec3& p, const Vec3& root,
                        const Vec3& reference, double reach) {
    const auto q = surface.closest_point(p, reach);
    if (!q) return {root - 1e3 * reach * reference, reference};  // nothing near: far below
    // A wall seen from behind lies beyond the one the tuft came to.
    if (glm::dot(q->normal, reference) > -0.2 && glm::dot(q->face_normal, root - q->position) > 0)
        return {q->position, q->normal};
    if (const auto front = surface.ray(p + reach * reference, -reference, 0, 2 * reach);
        front && glm::dot(front->normal, reference) > 0)
        return {front->position, front->normal};
    return {q->position, reference};
}

// Middle of the part of the tuft that is at the surface: nodes weighted by how deep
// their section lies, so that it moves continuously.
Vec3 contact_centre(const brush::TuftState& tuft, const std::vector<ContactPlane>& planes) {
    Vec3 sum{0};
    double weight = 0;
    std::size_t i = 0;
    for (const brush::Branch& branch : tuft.branches) {
        for (const brush::Section& s : branch.sections) {
            const ContactPlane& plane = planes[std::min(i++, planes.size() - 1)];
            const double z = glm::dot(s.centre - plane.origin, plane.normal);
            const double w = std::max(0.0, std::hypot(s.a * glm::dot(s.e, plane.normal),
                                                      s.b * glm::dot(s.m, plane.normal)) - z + 1e-5);
            sum += w * s.centre;
            weight += w;
        }
    }
    return weight > 0 ? sum / weight : tuft.branches.front().sections.front().centre;
}

}  // namespace

Result step(brush::Tuft& tuft, const brush::Pose& pose, const mesh::SurfaceQuery& surface,
            Memory& memory, double dt, const Options& options) {
    Result result;
    const double length = tuft.preset.length;
    const double reach = 1.5 * length;
    const std::vector<Vec3> nodes = brush::predicted_nodes(tuft, pose);

    // Broad phase: the tuft is within `reach` of its mouth.
    const auto under = surface.closest_point(pose.position, 2 * reach);
    if (!under) {
        result.tuft = brush::step(tuft, pose, {}, dt);
        const auto far = surface.closest_point(nodes.front());
        result.distance = far ? far->distance : std::numeric_limits<double>::infinity();
        memory.normal = Vec3{0};
        return result;
    }
    // The side the tuft is on: where it touched before, else where its mouth is.
    Vec3 reference = memory.normal;
    if (glm::dot(reference, reference) < 0.5)
        reference = glm::dot(under->normal, pose.axis()) < 0.3 ? under->normal : -pose.axis();

    result.planes.reserve(nodes.size());
    for (const Vec3& p : nodes)
        result.planes.push_back(node_plane(surface, p, pose.position, reference, reach));
    result.tuft = brush::step(tuft, pose, result.planes, dt);

    const Vec3 centre = result.tuft.touching ? contact_centre(result.tuft, result.planes)
                                             : result.tuft.branches.front().sections.front().centre;
    if (const auto foot = surface.closest_point(centre, reach)) {
        const bool front = glm::dot(foot->normal, reference) > -0.2;
        const ContactPlane plane =
            front ? ContactPlane{foot->position, foot->normal}
                  : node_plane(surface, centre, pose.position, reference, reach);
        const auto on = front ? foot : surface.closest_point(plane.origin, reach);
        result.triangle = on->triangle;
        result.frame = make_frame(plane.origin, plane.normal, memory.heading);
        result.distance = result.tuft.touching
                              ? 0.0
                              : std::max(0.0, glm::dot(centre - plane.origin, plane.normal));
        if (result.tuft.touching) {
            memory.normal = plane.normal;
            memory.heading = result.frame.t;
        } else {
            memory.normal = Vec3{0};
        }
    }

    const brush::Preset& preset = tuft.preset;
    Vec3 force = preset.force_gain * result.tuft.force;
    if (const double size = glm::length(force); size > preset.force_limit)
        force *= preset.force_limit / size;
    if (!result.tuft.touching && result.triangle != kNone && result.distance < options.tolerance)
        force = options.proximity_force * result.frame.n;
    result.hand_force = force;
    return result;
}

}  // namespace tuft::contact
