#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "render/picture/picture.h"

/// \file
/// Material at a point of the mesh, for the product pictures.
namespace tuft::render {

/// Material at a hit: body reflectance (linear RGB), coat roughness, and the slope of the
/// ink's relief as the vector to subtract from the normal.
struct Material {
    Vec3f albedo{0.8f};
    float roughness = 0;  ///< of the coat, 0–1
    Vec3f slope{0};
};

inline constexpr std::uint32_t kMapTile = 16;  ///< texels along the side of a tile of the maps

/// Tiles of the colour map that were read, each once: row · tiles per side + column.
struct TileReads {
    std::vector<std::uint32_t> tiles;

    void add(std::uint32_t tile) {
        if (std::find(tiles.begin(), tiles.end(), tile) == tiles.end()) tiles.push_back(tile);
    }
};

/// Constant data of a picture's appearance, checked once.
class MaterialReader {
  public:
    /// Throws `Error` when a map does not have size² texels or the UVs do not fit the mesh.
    MaterialReader(const mesh::TriangleMesh& mesh, const Appearance& appearance);

    /// `reads` takes the tiles of the colour map that the result depends on; null: none are recorded.
    Vec3f albedo(std::uint32_t triangle, float b1, float b2, TileReads* reads = nullptr) const;
    Material read(std::uint32_t triangle, float b1, float b2, TileReads* reads = nullptr) const;
    /// Returns the fraction of light from a small lamp in direction `to_light` (unit; `normal` is the surface's)
    /// that the relief lets through: 0 in the shadow of higher ink, soft over the lamp's radius `blur` (radians).
    /// Looks up to 3 mm away, within the chart.
    float unshaded(std::uint32_t triangle, float b1, float b2, const Vec3f& normal, const Vec3f& to_light,
                   float blur) const;
    bool coated() const { return appearance_.finish == Finish::porcelain; }

  private:
    Vec2f uv(std::uint32_t triangle, float b1, float b2) const;
    Vec3f relief(std::uint32_t triangle, const Vec2f& at) const;
    float height(const Vec2f& at) const;  ///< metres, bilinear

    const mesh::TriangleMesh& mesh_;
    const Appearance& appearance_;
    Vec3f body_{0.8f};
    float roughness_ = 0;
    float srgb_[256];
};

/// sRGB code value in [0, 1] of a linear value and back (IEC 61966-2-1).
float encode_srgb(float linear);
float decode_srgb(float code);

}  // namespace tuft::render
