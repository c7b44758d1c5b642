#pragma once

#include "core/geometry/types.h"

/// \file
/// Distance from a surface of two planes with its edge or corner rounded. Used by the rod's contact and by
/// `height_over`.
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
Distance edge_distance(const RoundedEdge& edge, const Vec3& x);

/// Distance of a line x + s d from an edge, as a function of s.
struct LineDistance {
    double z = 0, slope = 0, bend = 0;  ///< and its first and second derivative
};

/// A line over a rounded edge: its heights over both planes are linear, so that a distance costs a root at most.
class LineOverEdge {
  public:
    /// `direction` may have any length.
    LineOverEdge(const RoundedEdge& edge, const Vec3& x, const Vec3& direction);
    LineDistance at(double s) const;

  private:
    const RoundedEdge& edge_;
    double height_[2], climb_[2];  // over both planes, and their slopes
    double across_ = 0;            // square of the direction's part across the edge
};

/// Returns the distance from a concave corner: the smaller of both distances. Where they differ by less than
/// `rounding` it is rounded, by at most a quarter of `rounding`.
Distance corner_distance(const Wedge& wedge, double rounding, const Vec3& x);

}  // namespace tuft::brush
