#pragma once

#include <vector>

#include "ink/exchange/deposit.h"
#include "stroke/painting/apply_fill.h"
#include "stroke/surface/flat_texels.h"

/// \file
/// Masked areas of a drawing on texels. Called by `Document` for fills with `Region::outline`.
namespace tuft::stroke {

/// Coverage of square cells of the plane by an area, 0–1: exact along x, from 16 lines a cell along y.
class AreaRaster {
  public:
    /// Cells of about `cell` metres over the bounds of the area; larger ones where there would be more than 2²⁶.
    AreaRaster(const FlatArea& area, double cell) : AreaRaster(area, cell, nullptr) {}
    /// On the cells of another raster: coverages of areas that share an edge then add up to that of both.
    AreaRaster(const FlatArea& area, const AreaRaster& same) : AreaRaster(area, same.cell_, &same) {}

    /// Mean over a square of side `width` metres about a point, from 2 × 2 bilinear samples.
    double mean(const Vec2& point, double width) const;
    const Vec2& low() const { return low_; }
    Vec2 high() const { return low_ + cell_ * Vec2(width_, height_); }

  private:
    AreaRaster(const FlatArea& area, double cell, const AreaRaster* same);
    double at(const Vec2& point) const;

    Vec2 low_{0};
    double cell_ = 1;
    int width_ = 0, height_ = 0;
    std::vector<std::uint8_t> coverage_;  // [width_ height_], 255 is 1
};

/// Returns the coverage of an area whose lines have their drawn width on the surface of `lattice` (`even_rings`).
AreaRaster raster_of(const FlatArea& area, const SurfaceLattice& lattice, double cell);

/// Puts the area of `fill` onto the texels that it covers. With c the coverage of a texel, α the opacity there and w
/// the film of the stop, α c of all ink on the texel is taken away and c w film units of the stop's ink are laid. c of
/// a texel beside one that the area covers includes `FlatArea::under`. Between stops α, w and amounts of pigments are
/// linear. `mixes`: one for each stop, by plane of the canvas; `films`: theirs. `FillResult::met` also counts texels
/// that the mask covers.
FillResult apply_area(const Fill& fill, const PaintTarget& target, const FlatTexels& texels,
                      std::span<const ink::Mix> mixes, std::span<const double> films);

}  // namespace tuft::stroke
