#include "brush/papers/space/frames.h"

#include <algorithm>

namespace tuft::brush {

namespace {

constexpr double kNoLength = 1e-9;  ///< m, segment without a direction
constexpr double kBent = 0.02;      ///< radians in all: a bend that has an axis

/// Unit tangents of the nodes, tip first, and of the segments: element k is that between nodes k and k + 1.
struct Tangents {
    std::vector<Vec3> node, segment;
};

Tangents tangents_of(std::span<const Vec3> nodes, const Vec3& axis) {
    const std::size_t count = nodes.size();
    Tangents t{std::vector<Vec3>(count, axis), std::vector<Vec3>(count, axis)};
    for (std::size_t k = count - 1; k-- > 0;) {
        const Vec3 d = nodes[k] - nodes[k + 1];
        const double l = glm::length(d);
        t.segment[k] = l > kNoLength ? d / l : t.segment[k + 1];
    }
    for (std::size_t k = 0; k < count; ++k) {
        const Vec3& outer = k > 0 ? t.segment[k - 1] : t.segment[0];
        const Vec3 sum = t.segment[k] + outer;
        t.node[k] = glm::length(sum) > 1e-6 ? glm::normalize(sum) : outer;
    }
    return t;
}

/// The part of `v` normal to unit `t`, as a unit vector; of any direction where there is none.
Vec3 normal_part(const Vec3& v, const Vec3& t) {
    Vec3 e = v - glm::dot(v, t) * t;
    if (glm::length(e) < 1e-9) e = glm::cross(t, Vec3{0.36, 0.48, 0.8});
    return glm::normalize(e);
}

}  // namespace

const ContactPlane& plane_of(std::span<const ContactPlane> planes, std::size_t k) {
    return planes.size() == 1 ? planes[0] : planes[k];
}

Recycled<Section> frame_sections(std::span<const Vec3> nodes, const Vec3& axis, std::size_t at, const Vec3& wide) {
    const std::vector<Vec3> t = tangents_of(nodes, axis).node;
    Recycled<Section> out(nodes.size());
    std::vector<Vec3> e(nodes.size());
    e[at] = normal_part(wide, t[at]);
    for (std::size_t k = at + 1; k < e.size(); ++k) e[k] = parallel_transport(e[k - 1], t[k - 1], t[k]);
    for (std::size_t k = at; k-- > 0;) e[k] = parallel_transport(e[k + 1], t[k + 1], t[k]);
    for (std::size_t k = 0; k < out.size(); ++k) {
        out[k].centre = nodes[k];
        out[k].tangent = t[k];
        out[k].e = normal_part(e[k], t[k]);
        out[k].m = glm::cross(out[k].e, t[k]);
    }
    return out;
}

WideAxis find_wide_axis(std::span<const Vec3> nodes, const Vec3& axis, std::span<const ContactPlane> planes,
                        std::span<const double> radius, const Vec3& kept) {
    const Tangents t = tangents_of(nodes, axis);
    WideAxis best{nodes.size() - 1, kept};
    double most = 0;
    for (std::size_t k = 0; k + 1 < nodes.size() && !planes.empty(); ++k) {
        const ContactPlane& plane = plane_of(planes, k);
        const Vec3 across = glm::cross(t.node[k], plane.normal);
        const double near = 1 - height_over(plane, nodes[k]) / std::max(radius[k], kNoLength);
        const double weight = std::min(near, 1.0) * glm::length(across) * glm::length(nodes[k] - nodes[k + 1]);
        if (near > 0 && weight > most) {
            most = weight;
            best = {k, across};
        }
    }
    if (most <= 0) {
        Vec3 bend{0};
        for (std::size_t k = nodes.size() - 1; k-- > 0;) bend += glm::cross(t.segment[k + 1], t.segment[k]);
        if (glm::length(bend) > kBent) best.direction = bend;
    }
    best.direction = normal_part(best.direction, t.node[best.at]);
    Vec3 there = kept;
    for (std::size_t k = nodes.size() - 1; k-- > best.at;) there = parallel_transport(there, t.node[k + 1], t.node[k]);
    if (glm::dot(there, best.direction) < 0) best.direction = -best.direction;
    return best;
}

}  // namespace tuft::brush
