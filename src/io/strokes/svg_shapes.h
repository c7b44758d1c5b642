#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// Shapes of an SVG drawing as polylines in user units (SVG 1.1, W3C 2011). Used by `svg.cpp` only.
namespace tuft::io {

using SvgMatrix = glm::dmat3;
using SvgLine = std::vector<Vec2>;

/// Reads numbers, flags and words from an attribute. Commas count as blanks. Throws `Error` with the name of the file
/// for what cannot be read.
class SvgReader {
  public:
    /// Both must outlive this.
    SvgReader(std::string_view text, const std::string& source)
        : at_(text.data()), end_(at_ + text.size()), source_(source) {}

    bool done() { return skip(), at_ == end_; }
    /// The next character; '\0' at the end.
    char peek() { return skip(), at_ < end_ ? *at_ : '\0'; }
    char take() { return *at_++; }
    bool number_next();
    /// Within ±1e9.
    double number();
    /// 0 or 1, as arcs have it.
    bool flag();
    /// Letters up to anything else.
    std::string word();

  private:
    void skip();

    const char *at_, *end_;
    const std::string& source_;
};

SvgMatrix svg_translation(double x, double y);
SvgMatrix svg_scaling(double x, double y);
/// Product of a list of transforms. Throws `Error` for one that is not known.
SvgMatrix svg_transform(const char* text, const std::string& source);

/// Curves as chords that keep within a tolerance. Both functions continue a line that is not empty.
struct SvgCurves {
    static constexpr int kMost = 4096;  ///< chords of one curve

    double growth = 1;     ///< metres per user unit, by the transforms in force
    double tolerance = 0;  ///< metres from curve to chord

    /// Bézier curve with control points b and c to d.
    void cubic(SvgLine& line, const Vec2& b, const Vec2& c, const Vec2& d) const;
    /// Elliptic arc to `end`; `turn` in radians. A radius of 0 gives a straight line.
    void arc(SvgLine& line, double rx, double ry, double turn, bool large, bool sweep, const Vec2& end) const;
};

/// Each subpath of path data, as soon as it is read. Throws `Error` for what cannot be read.
void svg_path(const char* text, const std::string& source, const SvgCurves& curves,
              const std::function<void(const SvgLine&)>& emit);
/// Polyline, or polygon where `closed`.
SvgLine svg_points(const char* text, const std::string& source, bool closed);
/// Empty where the size is not positive. Radii of corners are at most half a side.
SvgLine svg_rectangle(const Vec2& corner, const Vec2& size, const Vec2& radii, const SvgCurves& curves);
/// Empty where a radius is not positive.
SvgLine svg_ellipse(const Vec2& centre, const Vec2& radii, const SvgCurves& curves);

}  // namespace tuft::io
