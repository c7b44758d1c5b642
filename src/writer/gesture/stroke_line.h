#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// A centre line, divided into segments at its corners. Each segment has a code for its direction. Called by sides.h.
namespace tuft::writer {

/// A part of a line between two corners.
struct LineSegment {
    std::size_t first = 0, last = 0;  ///< indices of points
    char code = 'H';                  ///< see `segment_code`
    double length = 0;                ///< units, along the line
    double direction = 0;             ///< radians, of its chord, y up
    double bow = 0;                   ///< largest distance of the line to the left of its chord, part of the length
};

/// A centre line as the writer sees it.
struct StrokeLine {
    std::vector<Vec2> points;   ///< units, y up, about `kApart` apart
    std::vector<double> along;  ///< units from the first point. [points]
    std::vector<LineSegment> segments;

    double length() const { return along.back(); }
    /// Returns the codes of all segments, such as "HSP": the class of the stroke.
    std::string stroke_class() const;
    /// Returns the point at a length, linear between points; clamped to the line.
    Vec2 at(double length) const;
    /// Returns the unit direction at a length, from points `reach` units before and after it within the line.
    Vec2 direction(double length, double reach = 12) const;

    static constexpr double kApart = 4;
};

/// Resamples a centre line to 4 units, smooths it three times by (¼ ½ ¼), ends fixed, and splits it at corners: local
/// maxima within ±36 units of the angle between the line 28 units before and after, above 0.75 rad, more than 20 units
/// from the ends. `reach` replaces the 28 units, and the 36 by as many more. Precondition: at least two points.
StrokeLine make_stroke_line(std::span<const Vec2> median, double reach = 28);

/// Point of a polyline, and how far it is.
struct NearestPoint {
    Vec2 point{0};
    double distance = 1e300;
};

/// Returns the point of a polyline that is closest to p. Of fewer than two points: 1e300 away.
NearestPoint nearest_on_line(std::span<const Vec2> line, const Vec2& p);

/// Returns a smooth curve through the points of a polyline, points at most `kApart` units apart: cubic Hermite pieces,
/// with tangents of the circle through three neighbours. Turns above 40° stay corners; straight pieces beside a
/// corner stay straight.
std::vector<Vec2> curve_through(std::span<const Vec2> line);

/// Returns the code of a direction in radians, y up, by degrees: H (橫) −24…20, T (提) 20…80, U 80…150, L 150…192,
/// P (撇) −168…−102, S (豎) −102…−72, N (捺, 點) −72…−24.
char segment_code(double direction);
inline constexpr std::string_view kSegmentCodes = "HTULPSN";

/// Returns the middle of the range of a code, radians.
double code_direction(char code);

}  // namespace tuft::writer
