#pragma once

#include <span>
#include <vector>

#include "writer/gesture/cells.h"

/// \file
/// Knuckles: turns of the edge of ink that the wanted area has not, convex ones at swellings and concave ones at necks.
/// A reader sees them where an overlap does not. Called by the fit.
namespace tuft::writer {

/// A local extremum of the curvature of an edge.
struct EdgeTurn {
    Vec2 at{0};            ///< units
    double curvature = 0;  ///< 1/units, positive where the area is convex
};

inline constexpr double kKnuckle = 1.0 / 25;  ///< 1/units, least curvature of a knuckle

/// Returns the coverage of cells: 1 in the area, else 0. [cells]
std::vector<float> coverage_of(const Cells& cells);

/// Returns a coverage smoothed over neighbours by (¼ ½ ¼) in both directions: the edge of a binary area lies between
/// cells. 0 in the outermost cells.
std::vector<float> softened_coverage(const Cells& frame, std::span<const float> coverage);

/// Returns the turns with a curvature above `least`, or below −`least`, of the line at half of a coverage (0–1, [cells
/// of `frame`]), which is smoothed along itself by a Gaussian of 6 units. Cost: 20 µs per 100 units of the line, 10 ns
/// a cell.
std::vector<EdgeTurn> edge_turns(const Cells& frame, std::span<const float> coverage, double least);

/// Returns the turns of ink beyond `kKnuckle` for which the wanted area has none to the same side, of half the
/// curvature, within 30 units. `ink`: coverage [cells of `frame`]; `wanted`: turns of the area beyond half of
/// `kKnuckle`.
std::vector<EdgeTurn> knuckles_of(const Cells& frame, std::span<const float> ink, std::span<const EdgeTurn> wanted);

}  // namespace tuft::writer
