#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "decal/polygons.h"

/// \file
/// Regions of the plane as the positive part of a function on a grid: their distance and their border, both finer than
/// the grid's cells. Called by outline.h.
namespace tuft::decal {

/// Nodes of a square grid, row by row.
struct Grid {
    Vec2 origin{0};  ///< of node (0, 0), metres
    double cell = 1e-4;
    int width = 0, height = 0;

    std::size_t size() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
    Vec2 node(double x, double y) const { return origin + cell * Vec2(x, y); }
    /// Edge 2 i of node i goes to the right, 2 i + 1 upwards.
    std::size_t edge_right(int x, int y) const { return 2 * index(x, y); }
    std::size_t edge_up(int x, int y) const { return 2 * index(x, y) + 1; }
};

/// A function on a grid.
struct LevelSet {
    std::vector<float> value;  ///< [grid size] positive inside
    /// Parts 0–1 of the way along an edge of the grid at which the function is 0, where linear interpolation of the
    /// values at its ends is not used.
    std::unordered_map<std::size_t, float> crossing = {};
};

/// Returns the distance of each node to the border of the region, metres, positive inside. The border is that of
/// `zero_lines`. Within 4 cells it is the distance to the border's segments, further off that to their ends
/// [Felzenszwalb2012]: a segment is at most √2 cells long, so at d cells that is at most 1 / 4 d of a cell more.
/// Without a border all are ±∞.
std::vector<float> signed_distance(const Grid& grid, const LevelSet& set);

/// Returns the border of the region: its rings, with the inside on their left (marching squares). A region ends at the
/// rim of the grid.
Region zero_lines(const Grid& grid, const LevelSet& set);

}  // namespace tuft::decal
