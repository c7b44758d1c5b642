#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// Shapes of an SVG drawing as polylines in user units (SVG 1.1, W3C 2011). Called by svg.cpp only. Any thread.
namespace tuft::io {

using SvgMatrix = glm::dmat3;
using SvgLine = std::vector<Vec2>;

/// Reads numbers, flags and words from an attribute. Commas count as blanks. Throws `Error` with the name of the file
/// for anything else.
class SvgReader {
  public:
    /// Both must outlive this.
    SvgReader(std::string_view text, const std::string& source)
        : at_(text.data()), end_(at_ + text.size()), source_(source) {}

    bool done() { return skip(), at_ == end_; }
    /// Returns the next character without consuming it; '\0' at the end.
    char peek() { return skip(), at_ < end_ ? *at_ : '\0'; }
    char take() { return *at_++; }
    bool number_next();
    /// Reads a number within ±1e9.
    double number();
    /// Reads a flag of an arc: 0 or 1, blanks optional.
    bool flag();
    /// Reads letters up to any other character.
    std::string word();

  private:
    void skip();

    const char *at_, *end_;
    const std::string& source_;
};

/// Return a translation and a scaling.
SvgMatrix svg_translation(double x, double y);
SvgMatrix svg_scaling(double x, double y);
/// Returns the product of a list of transforms. Throws `Error` for an unknown one.
SvgMatrix svg_transform(const char* text, const std::string& source);

/// An elliptic arc from the last point of a line (SVG 1.1, 8.3.8).
struct SvgArc {
    Vec2 radii{0};                      ///< user units, >= 0
    double turn = 0;                    ///< radians, of the ellipse's x axis
    bool large = false, sweep = false;  ///< the larger of both arcs; towards positive angles
    Vec2 end{0};                        ///< user units
};

/// Approximates curves by chords within a tolerance. Both functions append to `line`, which must not be empty.
struct SvgCurves {
    static constexpr int kMost = 4096;  ///< chords of one curve at most

    double growth = 1;     ///< metres per user unit, transforms included
    double tolerance = 0;  ///< metres, largest distance from curve to chord

    /// Appends a Bézier curve with control points b and c to d.
    void cubic(SvgLine& line, const Vec2& b, const Vec2& c, const Vec2& d) const;
    /// Appends an elliptic arc. A radius of 0 gives a straight line.
    void arc(SvgLine& line, const SvgArc& arc) const;
};

/// Calls `emit` with each subpath of path data as soon as it is read. Throws `Error` for invalid data, after `emit` got
/// what comes before the fault.
void svg_path(const char* text, const std::string& source, const SvgCurves& curves,
              const std::function<void(const SvgLine&)>& emit);
/// Returns each point of the lines with the angle of its direction, radians: that of the bisector at a corner.
std::vector<std::pair<Vec2, double>> svg_vertices(const std::vector<SvgLine>& lines);
/// Returns the points of a polyline, or of a polygon with `closed`.
SvgLine svg_points(const char* text, const std::string& source, bool closed);
/// Returns a rectangle; empty where the size is not positive. `radii` of the corners are limited to half a side.
SvgLine svg_rectangle(const Vec2& corner, const Vec2& size, const Vec2& radii, const SvgCurves& curves);
/// Returns an ellipse; empty where a radius is not positive.
SvgLine svg_ellipse(const Vec2& centre, const Vec2& radii, const SvgCurves& curves);

}  // namespace tuft::io
