#pragma once

#include <cstdint>
#include <vector>

#include "atlas/atlas.h"

/// \file
/// Picture of an atlas for `tuft unwrap`.
namespace tuft::atlas {

/// Picture of an atlas.
struct AtlasPicture {
    std::uint32_t width = 0, height = 0;  ///< pixels
    std::vector<std::uint8_t> rgb;        ///< [3 width height], top row first
};

/// Size of the picture of an atlas.
struct AtlasPictureOptions {
    std::uint32_t side = 1024;  ///< pixels along each of the two squares
};

/// Two squares: on the left the charts, each in its colour, darker along its border; on
/// the right the stretch of every triangle relative to the mean texel size: blue where
/// texels are 20 % smaller than on average, white at the mean, red 20 % larger (the
/// larger singular value of the map from UV to surface).
AtlasPicture draw_atlas(const mesh::TriangleMesh& mesh, const Atlas& atlas, const AtlasPictureOptions& options = {});

}  // namespace tuft::atlas
