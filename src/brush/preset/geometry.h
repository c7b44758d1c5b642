#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// Geometry of a tuft: the resting shape of its hair as a closed triangle mesh or as polylines. A preset holds it
/// (preset.h); `brush/tuft` embeds it in the lattice of the spines.
///
/// The format is OBJ: `v x y z`, `f` (polygons, triangulated as fans), `l` (polylines). All other keys are ignored.
/// Ferrule frame, millimetres: x along the broad side, the mouth of the ferrule at z = 0, the tip at z = −length.
namespace tuft::brush {

/// Either triangles or lines; never both.
struct Geometry {
    std::vector<Vec3> points;                             ///< millimetres, ferrule frame
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< closed, counter-clockwise from outside
    std::vector<std::vector<std::uint32_t>> lines;        ///< hairs, root first or tip first

    Box bounds() const;  ///< millimetres
};

/// Limits of a geometry; a file beyond them is refused.
inline constexpr std::size_t kMostGeometryBytes = std::size_t{4} << 20;
inline constexpr std::size_t kMostPoints = 20000, kMostTriangles = 40000;
inline constexpr double kLargestGeometry = 300;  ///< mm from the middle of the mouth

/// Parses OBJ text. Throws `Error` with `source` and line for text that is not OBJ, an index without a point, a number
/// that is not finite or beyond `kLargestGeometry`, more than the limits above, faces and lines mixed or neither, a
/// surface that is not closed or not consistently oriented, a surface turned inside out, or a line of one point.
Geometry parse_geometry(std::string_view text, const std::string& source);

/// Reads the geometry `name` beside a brush file in `folder`. Throws `Error` like `parse_geometry`, and where the name
/// leads out of the folder, by itself or by a symbolic link.
Geometry read_geometry(const std::filesystem::path& folder, const std::string& name, const std::string& source);

/// Returns the geometry as OBJ text. `parse_geometry` reads the same geometry back, with 9 digits of each number.
std::string geometry_text(const Geometry& geometry);

/// Returns the geometry with all lengths times `factor`.
Geometry scaled(const Geometry& geometry, double factor);

}  // namespace tuft::brush
