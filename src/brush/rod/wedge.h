#pragma once

#include <cmath>

#include "core/geometry/types.h"

/// \file
/// Distance from a surface of two planes with its edge or corner rounded. Used by the rod's contact and by
/// `height_over`. Its functions are inline: the rod's contact calls them for every piece of hair near an edge.
namespace tuft::brush {

/// Distance of a point from the surface, negative inside, and its derivatives. Any unit of length.
struct Distance {
    double z = 0;
    Vec3 slope{0};    ///< ∂z/∂x
    double bend = 0;  ///< ∂²z/∂x² = bend · across acrossᵀ
    Vec3 across{0};
};

/// Two planes, each through `origin` with its unit normal out of the object.
struct Wedge {
    Vec3 origin[2]{Vec3{0}, Vec3{0}}, normal[2]{Vec3{0}, Vec3{0}};
};

/// Returns the distance from a convex edge rounded by ρ: the distance from both planes moved in by ρ, less ρ. Over
/// a face this is the distance from its plane. In front of the edge it is the distance from a line, and its
/// gradient turns from one normal to the other. ρ is `rounding`. It is smaller at sharp edges, so that the rounding
/// removes at most 0.41 ρ, as at an edge of 90°.
Distance edge_distance(const Wedge& wedge, double rounding, const Vec3& x);

/// A convex edge with what all distances from it share.
struct RoundedEdge {
    Wedge wedge;
    double rounding = 0;   ///< ρ, as it acts at this edge
    double c = 1;          ///< cosine between both normals
    double per_apart = 0;  ///< 1/(1 − c²); 0 where both planes are one
    Vec3 ridge{0};         ///< unit, along the edge
};
RoundedEdge round_edge(const Wedge& wedge, double rounding);

/// From the ridge of the planes moved in by ρ, a point lies at u n0 + v n1 across the edge. It is in front of the edge
/// where both are positive, `far` from the ridge.
struct InFrontOfEdge {
    double u = 0, v = 0, far = 0;  ///< far: 0 where it is not

    /// `z0`, `z1`: heights over both planes.
    InFrontOfEdge(const RoundedEdge& e, double z0, double z1) {
        const double in0 = z0 + e.rounding, in1 = z1 + e.rounding;
        u = (in0 - e.c * in1) * e.per_apart;
        v = (in1 - e.c * in0) * e.per_apart;
        if (u > 0 && v > 0) far = std::sqrt(u * u + v * v + 2 * e.c * u * v);
        if (far <= 1e-12) far = 0;
    }
};

inline Distance edge_distance(const RoundedEdge& e, const Vec3& x) {
    const Wedge& w = e.wedge;
    const double z0 = glm::dot(x - w.origin[0], w.normal[0]), z1 = glm::dot(x - w.origin[1], w.normal[1]);
    const InFrontOfEdge f(e, z0, z1);
    if (f.far > 0) {
        const Vec3 n = (f.u * w.normal[0] + f.v * w.normal[1]) / f.far;
        return {f.far - e.rounding, n, 1 / f.far, glm::cross(e.ridge, n)};
    }
    return z0 > z1 ? Distance{z0, w.normal[0]} : Distance{z1, w.normal[1]};
}

/// Height of a point over an edge: the z of `edge_distance`, and the plane whose distance it is; -1: in front of the
/// edge.
struct EdgeHeight {
    double z = 0;
    int face = -1;
};
inline EdgeHeight edge_height(const RoundedEdge& e, const Vec3& x) {
    const Wedge& w = e.wedge;
    const double z0 = glm::dot(x - w.origin[0], w.normal[0]), z1 = glm::dot(x - w.origin[1], w.normal[1]);
    const InFrontOfEdge f(e, z0, z1);
    if (f.far > 0) return {f.far - e.rounding, -1};
    return z0 > z1 ? EdgeHeight{z0, 0} : EdgeHeight{z1, 1};
}

/// Distance of a line x + s d from an edge, as a function of s.
struct LineDistance {
    double z = 0, slope = 0, bend = 0;  ///< and its first and second derivative
};

/// A line over a rounded edge: its heights over both planes are linear, so that a distance costs a root at most.
class LineOverEdge {
  public:
    /// `direction` may have any length.
    LineOverEdge(const RoundedEdge& edge, const Vec3& x, const Vec3& direction) : edge_(edge) {
        for (int i = 0; i < 2; ++i) {
            height_[i] = glm::dot(x - edge.wedge.origin[i], edge.wedge.normal[i]);
            climb_[i] = glm::dot(direction, edge.wedge.normal[i]);
        }
        across_ = (climb_[0] * climb_[0] + climb_[1] * climb_[1] - 2 * edge.c * climb_[0] * climb_[1]) * edge.per_apart;
    }
    LineDistance at(double s) const {
        const double z0 = height_[0] + s * climb_[0], z1 = height_[1] + s * climb_[1];
        const InFrontOfEdge f(edge_, z0, z1);
        if (f.far > 0) {
            const double slope = (f.u * climb_[0] + f.v * climb_[1]) / f.far;
            return {f.far - edge_.rounding, slope, (across_ - slope * slope) / f.far};
        }
        return z0 > z1 ? LineDistance{z0, climb_[0], 0} : LineDistance{z1, climb_[1], 0};
    }

  private:
    const RoundedEdge& edge_;
    double height_[2], climb_[2];  // over both planes, and their slopes
    double across_ = 0;            // square of the direction's part across the edge
};

/// Returns the distance from a concave corner: the smaller of both distances. Where they differ by less than
/// `rounding` it is rounded, by at most a quarter of `rounding`.
Distance corner_distance(const Wedge& wedge, double rounding, const Vec3& x);

}  // namespace tuft::brush
