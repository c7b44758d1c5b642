#pragma once

#include <span>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// Flat areas bounded by closed rings. Union and inset are by the Clipper library (after [Vatti1992]). Called by
/// area_lines.cpp. Any thread.
namespace tuft::io {

using Ring = std::vector<Vec2>;  ///< metres; closed: the last point is joined to the first

enum class FillRule { nonzero, even_odd };  ///< SVG 1.1, 11.3

/// Rings that cross neither themselves nor each other. The area is on their left where y points up, on their right
/// where y points down. Coordinates are rounded to 2⁻³⁰ of the extent.
class Shape {
  public:
    /// The area that `rings` enclose by the rule. Empty where there is none, where a point is not finite, and for more
    /// than `kMostPoints` points or crossings.
    Shape(std::span<const Ring> rings, FillRule rule);

    const std::vector<Ring>& rings() const { return rings_; }
    bool empty() const { return rings_.empty(); }
    /// Whether it is empty for too many points or crossings, its own or of a shape that it was made from.
    bool too_large() const { return too_large_; }
    double area() const;       ///< m²
    double perimeter() const;  ///< metres, of all rings
    /// Whether a point lies in the shape.
    bool contains(const Vec2& p) const;

    /// Returns the shape without points that lie within `tolerance` metres of the simplified ring
    /// [Douglas1973].
    Shape simplified(double tolerance) const;

    /// Returns the part more than `d` metres inside. `tolerance`: largest error of the distance, metres.
    Shape inset(double d, double tolerance) const;

    /// Returns the points within `d` metres of the shape, corners round to `tolerance` metres.
    Shape grown(double d, double tolerance) const;

    /// Return what lies in both shapes, and what lies in this one alone. Empty for more than `kMostPoints` points or
    /// crossings.
    Shape intersected(const Shape& other) const;
    Shape without(const Shape& other) const;

    static constexpr std::size_t kMostPoints = 20'000;

  private:
    Shape() = default;
    /// Moves the outline by `d` metres outwards (1) or inwards (-1).
    Shape moved_outline(double d, int outward, double tolerance) const;
    template <class Operation>
    Shape combined(const Shape& other, Operation operation) const;

    std::vector<Ring> rings_;
    bool too_large_ = false;
};

}  // namespace tuft::io
