#pragma once

#include <span>

#include "brush/state/tuft_state.h"
#include "core/system/recycled.h"
#include "footprint/outline/footprint.h"

/// \file
/// Outline of the contact patch of a bent tuft, and its coverage picture. Called by `stroke` for every stamp.
namespace tuft::footprint {

/// Closed curve in the tangent plane of the stamp, metres along frame.t and frame.b,
/// counter-clockwise: a uniform cubic B-spline through the tip point, the cut points of
/// one side, the tail point and the cut points of the other side (variable-stiffness
/// brush paper, section 4.1).
struct Outline {
    Vec2 tip{0};           ///< T: front end
    Vec2 tail{0};          ///< H: rear end
    Recycled<Vec2> left;   ///< cut points from tip to tail
    Recycled<Vec2> right;  ///< their mirror images where the tuft is symmetric
    /// Of strips the points themselves. Of the spline, cyclic: point k of the curve at knot k is (control[k-1] + 4
    /// control[k] + control[k+1]) / 6.
    Recycled<Vec2> control;
};

/// Options of `outlines_of` a tuft.
struct OutlineOptions {
    double film = 0.1e-3;  ///< metres, thickness of the ink film on wet hair; added to every section
    int points = 20;       ///< cut points on each side
};

/// Local contact planes of the nodes of one branch, tip first; see brush::ContactPlane.
using NodePlanes = Recycled<brush::ContactPlane>;

/// Assigns the planes of `brush::predicted_nodes` (whole spine, then sub-spines) to the branches of the tuft. Empty
/// when their number fits no such tuft.
Recycled<NodePlanes> node_planes(const brush::TuftState& tuft, std::span<const brush::ContactPlane> planes);

/// Returns one outline for each touching part of each branch. Section i at height z with semi-axes a along e, b
/// along m is cut where |z| ≤ A = √(a² (e·n)² + b² (m·n)²), at ω± = atan2(b m·n, a e·n) ± acos(−z/A). Upright, the
/// half-width is a √(1 − z²/(b m·n)²). Between nodes the skin is interpolated by cubics, so the outline is
/// continuous while sections enter and leave the surface. Parts below the surface count with their projection onto
/// it. With `planes` (one entry per branch) each node is cut by its own plane and its cut points are placed on the
/// surface by the log map. Without, the plane is that of `frame`.
Recycled<Outline> outlines_of(const brush::TuftState& tuft, const Frame& frame, std::span<const NodePlanes> planes = {},
                              const OutlineOptions& options = {});

/// Four control points in a row, which a span of the curve depends on.
struct CurveSpan {
    Vec2 c0, c1, c2, c3;

    /// Span k of the closed curve, from near control point k to near k + 1. Precondition: there are control points.
    CurveSpan(const Outline& outline, std::size_t k) {
        const Recycled<Vec2>& c = outline.control;
        const std::size_t n = c.size();
        const auto wrapped = [n](std::size_t i) { return i < n ? i : i - n; };  // sooner than a remainder
        const std::size_t next = wrapped(k + 1);
        c0 = c[k > 0 ? k - 1 : n - 1], c1 = c[k], c2 = c[next], c3 = c[wrapped(next + 1)];
    }
    /// The point of the uniform cubic B-spline at the parameter f, 0–1.
    Vec2 at(double f) const {
        const double g = 1 - f;
        return (g * g * g * c0 + (3 * f * f * f - 6 * f * f + 4) * c1 + (3 * g * g * g - 6 * g * g + 4) * c2 +
                f * f * f * c3) /
               6.0;
    }
};

/// Returns points of the curve, `per_span` for each cut point.
Recycled<Vec2> curve_points(const Outline& outline, int per_span = 4);

/// Returns the union of the outlines as a picture with exact area coverage; empty when there is none. `cell` is in
/// metres, about a texel or finer. It is doubled until the picture has at most 4096 cells a side, when a texel is
/// small against the tuft.
Footprint rasterise(std::span<const Outline> outlines, const Frame& frame, std::uint32_t triangle, double cell);

}  // namespace tuft::footprint
