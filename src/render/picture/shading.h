#pragma once

#include <array>
#include <cstdint>

#include "render/picture/light_buffer.h"

/// \file
/// Colour of one pixel of a product picture, of which the light is known. Called by picture_series.h.
namespace tuft::render {

/// What a pixel's colour depends on. All that is referred to must outlive it.
struct Shading {
    const Scene& scene;  ///< its material is the paint that reflects light onto other surfaces
    const LightCache& cache;
    const Camera& camera;
    const LightBuffer& buffer;
    const PictureOptions& options;
    const MaterialReader& seen;  ///< the paint that is seen
    float pixel_angle = 0;       ///< radians
};

/// sRGB code values, 8 bits.
using PixelCode = std::array<std::uint8_t, 3>;

/// Returns the mean colour of pixel (x, y) as sRGB code values in [0, 1]. `on_edge`: its middle differs from that of a
/// pixel beside it. It depends on nothing but the arguments and the texels of the tiles in `reads`.
Vec3f shade_pixel(const Shading& shading, bool on_edge, int x, int y, TileReads* reads = nullptr);

/// Returns the colour of the ray through the middle of pixel (x, y) as sRGB code values in [0, 1]. Likewise.
Vec3f shade_middle(const Shading& shading, int x, int y, TileReads* reads = nullptr);

/// Rounds code values in [0, 1] with a dither that the pixel's number fixes.
PixelCode pixel_code(const Vec3f& code, std::uint64_t seed, std::size_t pixel);

}  // namespace tuft::render
