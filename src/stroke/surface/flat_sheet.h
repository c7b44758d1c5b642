#pragma once

#include "stroke/surface/model.h"

/// \file
/// A flat model with square texels: what a brush is tried or measured on, and the palette.
namespace tuft::stroke {

/// A rectangle of columns × rows quads, two triangles each, in the plane of t and b of `frame`, outward along n.
struct FlatSheet {
    Frame frame;
    Vec2 low{0}, high{0};  ///< metres, corners of the rectangle along t and b
    int columns = 8, rows = 8;
    std::uint32_t texels = 512;  ///< per side of the atlas
    double texel = 1e-4;         ///< metres, side of a texel
    Vec2 corner{0};              ///< metres along t and b, of the atlas's first corner, uv (0, 0)
};

/// Returns the sheet as a model, its texels stored as floats. Texel (i, j) of the atlas has its centre at `corner` +
/// (i + ½, j + ½) `texel`. Throws std::invalid_argument where the rectangle is empty or reaches out of the atlas. Cost:
/// about 50 ms at 512².
Model make_flat_sheet(const FlatSheet& sheet);

}  // namespace tuft::stroke
