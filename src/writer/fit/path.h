#pragma once

#include <cstddef>
#include <vector>

#include "writer/gesture/sides.h"

/// \file
/// Lengths and directions of a path of stations. Called by the parts of the fit.
namespace tuft::writer {

/// Returns the length of the path up to each station, units. [stations]
std::vector<double> lengths_of(const std::vector<Station>& s);

/// Returns the unit direction of the path at a station, from its neighbours.
Vec2 direction_at(const std::vector<Station>& s, std::size_t i);

/// Returns the station that is nearest to a point. O(stations).
std::size_t nearest_station(const std::vector<Station>& s, const Vec2& p);

}  // namespace tuft::writer
