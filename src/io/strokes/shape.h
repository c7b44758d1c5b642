#pragma once

#include <span>
#include <vector>

#include "core/geometry/types.h"

/// Flat shapes: what closed rings enclose. Made and inset by the Clipper library (after Vatti
/// 1992).
namespace tuft::io {

using Ring = std::vector<Vec2>;  ///< metres; the last point joins the first

enum class FillRule { nonzero, even_odd };  ///< SVG 1.1, 11.3

/// Rings that neither cross themselves nor each other, area on the left where y points up (on the
/// right where it points down). Places are kept to 2⁻³⁰ of the extent.
class Shape {
  public:
    /// What `rings` enclose by the rule. Empty where that is nothing, a place is not finite, or
    /// there are more than `kMostPoints` points or crossings.
    Shape(std::span<const Ring> rings, FillRule rule);

    const std::vector<Ring>& rings() const { return rings_; }
    bool empty() const { return rings_.empty(); }
    double area() const;       ///< m²
    double perimeter() const;  ///< metres, of all rings
    bool contains(const Vec2& p) const;

    /// Rings without the points that lie within `tolerance` of the way past them (Douglas and
    /// Peucker 1973).
    Shape simplified(double tolerance) const;

    /// What lies more than `d` inside, to `tolerance` of the distance.
    Shape inset(double d, double tolerance) const;

    static constexpr std::size_t kMostPoints = 20'000;

  private:
    Shape() = default;
    std::vector<Ring> rings_;
};

}  // namespace tuft::io
