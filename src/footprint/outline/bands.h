#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/types.h"

namespace tuft::footprint {

/// Adds bands to a picture of cells with the area of each that they cover, 255 for all of it, up to
/// 255: by the columns of the picture, or its rows for `steep` bands, which run rather along those.
/// The picture is kept by columns where most are steep, else by rows, so that many columns of a
/// band are drawn at once.
class Bands {
  public:
    Bands(int width, int height, bool steep);

    /// From p to q (cells), of half width r at p and s at q, measured along `across` (unit); steep
    /// where that lies rather along the rows.
    void draw(Vec2 p, Vec2 q, double r, double s, const Vec2& across);

    /// The picture, [width * height] by rows.
    void rows(std::vector<std::uint8_t>& level) const;

  private:
    int width_, height_;
    bool steep_;
    std::vector<std::uint8_t> level_;
};

}  // namespace tuft::footprint
