#pragma once

#include <cstdint>
#include <span>

#include "brush/state/tuft_state.h"
#include "core/geometry/types.h"
#include "core/system/recycled.h"
#include "mesh/triangle_mesh.h"

/// \file
/// Contact patch of a tuft as a small picture in the tangent plane of the contact point: coordinates (u, v) along
/// frame.t and frame.b, metres. `footprint/stamp` maps it to texels.
namespace tuft::footprint {

/// Grey picture of the contact patch. Cell (i, j) has its centre at lo + ((i + 0.5) cell, (j + 0.5) cell). Coverage
/// is the touched fraction of the cell, in [0, 1], and 0 along the border cells.
struct Footprint {
    Frame frame;                      ///< world; n out of the surface, origin on it
    std::uint32_t triangle = kNone;   ///< of the mesh under the origin
    Vec2 lo{0};                       ///< metres, lower corner of cell (0, 0)
    double cell = 0;                  ///< metres
    int width = 0, height = 0;        ///< cells
    Recycled<std::uint8_t> coverage;  ///< [width * height], 255 = 1
    double radius = 0;                ///< metres: no coverage further than this from the origin

    bool empty() const { return coverage.empty(); }
};

/// Plane and resolution of a picture of the contact patch; see `Footprint`.
struct PicturePlane {
    const Frame& frame;              ///< world; n out of the surface, origin on it
    std::uint32_t triangle = kNone;  ///< of the mesh under the origin
    double cell = 0;                 ///< metres, > 0
};

/// Returns a disc of `radius` metres about the origin, antialiased by distance: for benchmarks, tests and round
/// stamps.
Footprint disc(const Frame& frame, std::uint32_t triangle, double radius, double cell);

}  // namespace tuft::footprint
