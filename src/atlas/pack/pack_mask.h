#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// Masks of charts for the packer: runs of cells. Internal to atlas/pack.
namespace tuft::atlas {

/// Cells `first` to `last` of a row, both included.
struct Run {
    std::uint32_t row, first, last;
    bool operator==(const Run&) const = default;
};

/// Sets the bits of cells `first` to `last`, both included, in a row of words.
inline void set_cells(std::uint64_t* row, std::size_t first, std::size_t last) {
    for (std::size_t w = first / 64; w <= last / 64; ++w) {
        std::uint64_t m = ~std::uint64_t{0};
        if (w == first / 64) m &= ~std::uint64_t{0} << (first % 64);
        if (w == last / 64) m &= ~std::uint64_t{0} >> (63 - last % 64);
        row[w] |= m;
    }
}

/// The cells that a chart touches, as runs in rows.
struct Mask {
    std::vector<Run> runs;                ///< in the order they are tested
    std::uint32_t width = 0, height = 0;  ///< cells
    double c = 1, s = 0;                  ///< cosine and sine of the rotation
    Vec2 corner{0};                       ///< of the rotated, scaled chart, texels
    double middle = 0;                    ///< mean row of the cells
    std::uint64_t hash = 0;               ///< of the runs
};

/// A chart's border and its orientation in its smallest rectangle.
struct Shape {
    const std::vector<Vec2>* border = nullptr;
    double angle = 0;   ///< radians, turns the longer side of the smallest rectangle onto x
    double area = 0;    ///< of the polygon, unit²
    double extent = 0;  ///< longer side of the rectangle, unit
};

/// Returns the shape of a closed simple polygon, which must outlive it.
Shape make_shape(const std::vector<Vec2>& border);

/// All cells of side `cell` texels that the shape touches when it is turned by `angle`
/// and scaled, from the lower left corner of its box on; with `all` also those cells turned
/// by one, two and three quarters of a circle.
std::vector<Mask> make_masks(const Shape& shape, double scale, double angle, double cell, bool all);

}  // namespace tuft::atlas
