#pragma once

#include <cstdint>

#include "core/geometry/types.h"
#include "core/system/recycled.h"

/// \file
/// Antialiased bands in a coverage picture. hair.h draws the marks of bristles with it.
namespace tuft::footprint {

/// Adds the area coverage of bands to a picture, 255 for a full cell, clamped to 255. Coverage is computed by
/// columns of the picture, or by rows for `steep` bands, which run mostly along the columns. The picture is stored
/// by columns when most bands are steep, otherwise by rows, so that many columns of a band are drawn at once.
class Bands {
  public:
    Bands(int width, int height, bool steep);

    /// Draws a band from p to q (cells) of half-width r at p and s at q. The width is measured along `across`
    /// (unit). The band is steep where `across` lies mostly along the rows.
    void draw(Vec2 p, Vec2 q, double r, double s, const Vec2& across);

    /// Copies the picture, [width * height] by rows.
    void copy_rows(Recycled<std::uint8_t>& level) const;

  private:
    int width_, height_;
    bool steep_;
    Recycled<std::uint8_t> level_;
};

}  // namespace tuft::footprint
