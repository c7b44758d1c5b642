#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "writer/glyphs/glyph.h"

/// \file
/// Areas in square cells, in the plane of a character. Called by sides.h and the fit. Units, y up.
namespace tuft::writer {

/// Cells of an area. Cell (i, j) has its centre at lo + ((i + ½) cell, (j + ½) cell).
struct Cells {
    Vec2 lo{0};
    double cell = 2;                   ///< units
    int width = 0, height = 0;         ///< cells
    std::vector<std::uint8_t> inside;  ///< [width * height] 1: in the area

    Vec2 centre(int i, int j) const { return lo + cell * Vec2(i + 0.5, j + 0.5); }
    bool at(int i, int j) const {
        return i >= 0 && j >= 0 && i < width && j < height && inside[std::size_t(j) * width + i] != 0;
    }
    bool contains(const Vec2& p) const {
        const Vec2 at_cell = glm::floor((p - lo) / cell);
        return at(static_cast<int>(at_cell.x), static_cast<int>(at_cell.y));
    }
    std::size_t count() const;
};

/// Returns empty cells over the box of all points of `rings` with `margin` units around it.
Cells cells_over(std::span<const Ring> rings, double cell, double margin);

/// Adds the area of `rings` (nonzero rule, all rings together) to cells: those whose centre lies inside.
void fill(Cells& cells, std::span<const Ring> rings);

/// Returns the distance of each cell's centre to the nearest centre outside of the area, units; 0 outside. [cells]
/// Exact Euclidean distance [Felzenszwalb2012], O(cells).
std::vector<float> clearances(const Cells& cells);

/// Returns the boundaries of cells as closed lines through corners of cells, the area on the left, smoothed over
/// `passes` neighbours by (¼ ½ ¼).
std::vector<Ring> boundaries(const Cells& cells, int passes);

}  // namespace tuft::writer
