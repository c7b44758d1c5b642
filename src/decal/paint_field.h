#pragma once

#include "decal/level_set.h"
#include "decal/print_surface.h"

/// \file
/// The paint of a panel on a grid over its plane. Called by outline.h.
namespace tuft::decal {

/// What is painted on a panel and on the strip beyond its seams.
struct PaintField {
    LevelSet painted;         ///< positive where the coverage is above a half somewhere in the node's cell
    std::vector<float> mean;  ///< [grid size] coverage of the node's cell, of the panel's own triangles alone
    bool any = false;         ///< whether something is painted
};

/// Samples the coverage about each node a texel apart, at most 5 × 5 in a cell. `texel` is in metres. The border of
/// `painted` is where the coverage is a half, by bisection to 1/64 of a cell, or where the surface ends. A line of
/// paint that passes between nodes is as wide as its samples, each a square. What lies off the grid is passed over.
PaintField find_paint(const PrintSurface& surface, const CoverageFn& coverage, const Grid& grid, double texel);

/// Returns the sum of `coverage` times the cell's area over the nodes in a region, m².
double paint_inside(const Grid& grid, const std::vector<float>& coverage, const Region& region);

}  // namespace tuft::decal
