#pragma once

#include <vector>

#include "decal/polygons.h"

/// \file
/// Nesting of pieces of film on pages at true size, by the bit masks of atlas/pack. Called by sheet.h.
namespace tuft::decal {

/// A piece in the orientations that it may take.
struct NestItem {
    std::vector<Ring> shapes;  ///< one simple ring for each orientation, metres
};

/// Where an item lies: a point p of shape `orientation` lies at p + offset on page `page`.
struct NestPlace {
    bool fits = false;  ///< false: larger than a page in every orientation
    std::size_t page = 0, orientation = 0;
    Vec2 offset{0};  ///< metres, from the lower left corner of the free area
};

/// Places items on pages whose free area is `area` metres wide and high; `area.y` 0: a roll, one page without end.
/// Items go largest first to the first page with room, there where their upper edge is lowest. Between two items stay
/// at least `gap` metres. Cells are 0.5 mm, or 1/2000 of the width. [n_items]
std::vector<NestPlace> nest(const std::vector<NestItem>& items, const Vec2& area, double gap);

}  // namespace tuft::decal
