#pragma once

#include <array>
#include <span>
#include <vector>

#include "writer/gesture/cells.h"
#include "writer/gesture/stroke_line.h"

/// \file
/// Distances from a stroke's centre line to its edge: measured on an outline, or predicted (side_table.h). The area and
/// the brush's path follow from them. Units, y up.
namespace tuft::writer {

inline constexpr std::size_t kKnots = 16, kFan = 5;
/// Places of the knots, part of a segment's length.
inline constexpr std::array<double, kKnots> kKnotPlaces{0,   .03, .07, .12, .18, .26, .35, .45,
                                                        .55, .65, .74, .82, .88, .93, .97, 1};
/// Directions of the rays of a fan, degrees from the outward direction of an end, anticlockwise.
inline constexpr std::array<double, kFan> kFanDegrees{60, 30, 0, -30, -60};

/// Distances from the centre line to the edge, units.
struct StrokeSides {
    std::vector<std::array<double, kKnots>> left, right;  ///< [segments] along the normal; at corners the bisector
    std::array<double, kFan> head{}, tail{};              ///< along the rays of the fans
};

/// Measures the sides of a line within an outline (nonzero rule), at most 130 units, fans at most 70. 0 where the line
/// lies outside. Cost: knots × points of the outline.
StrokeSides measure_sides(const StrokeLine& line, std::span<const Ring> outline);

/// Returns the area between the sides, linear along the line between knots: quads of at most 12 units and the two fans,
/// each a ring.
std::vector<Ring> area_of(const StrokeLine& line, const StrokeSides& sides);

/// A place of the path of a brush and the half width of its ink there.
struct Station {
    Vec2 centre{0};
    double half = 0;

    bool operator==(const Station&) const = default;
};

/// Returns the path of a brush through an area: the middle between the sides, smoothed, continued along the end
/// directions by the middle rays of the fans, in stations `kStationsApart` apart. The half width is that of the sides,
/// at most the clearance of the place within `area`. With `corners`, the path is moved out at corners as far as ink as
/// wide as both arms of the corner reaches the outer edge.
std::vector<Station> make_stations(const StrokeLine& line, const StrokeSides& sides, const Cells& area,
                                   bool corners = true);
inline constexpr double kStationsApart = 8;  ///< units

/// Returns stations evenly about `apart` units apart, linear between the given ones.
std::vector<Station> resample_stations(std::span<const Station> stations, double apart);

}  // namespace tuft::writer
