#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// Colours of a model's faces as its file states them, before any ink. Readers fill them; `ink` bakes them into the
/// base colour.
namespace tuft::mesh {

/// A texture image, mapped by UVs; row 0 is at the top (v = 1).
struct Picture {
    std::string name;         ///< for people
    std::vector<char> bytes;  ///< the encoded file: PNG, JPEG or TIFF
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;  ///< [3 width * height] sRGB-encoded, opaque
};

/// A picture on one tile of the plane of UVs: the unit square at (column, row) with the UDIM number 1001 + column + 10
/// row, column below 10.
struct PictureTile {
    std::uint32_t udim = 1001;
    std::shared_ptr<const Picture> picture;
};

/// Returns the UDIM number of the tile that the mean of the UVs lies on; 0 beside all tiles.
std::uint32_t udim_at(std::span<const Vec2f> uvs);

/// Colour of a group of faces: the product of colour, picture and vertex colours in linear light.
struct Material {
    Vec3f colour{1};                         ///< sRGB-encoded, in [0, 1]
    std::shared_ptr<const Picture> picture;  ///< null: none
    bool tinted = false;  ///< vertex colours apply also where there is a picture (glTF); otherwise only without one
    /// Ascending; empty: `picture` is repeated over all UVs. Else `picture` is that of the first tile, and a face on a
    /// tile that is not here has none.
    std::vector<PictureTile> tiles = {};
};

}  // namespace tuft::mesh
