#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/types.h"
#include "core/system/progress.h"

/// \file
/// Packing of chart shapes into square pages at the largest scale that fits. Called by `unwrap`.
namespace tuft::atlas {

/// Effort of the search for a layout of one page. quick: the first that fits. coarse: a short search on coarse
/// masks, to compare sets of charts. full: a long search. patient: also rotations by 22.5°, and a repeat while less
/// than 65 % of the page is covered: twice the time, 2 % more of the page.
enum class Search { quick, coarse, full, patient };

/// Options of `pack`.
struct PackOptions {
    std::uint32_t size = 0;      ///< texels per side; 0: as many as `texels_per_unit` needs
    double texels_per_unit = 0;  ///< scale; 0: the largest that fits `size`
    std::uint32_t gutter = 4;    ///< texels free between charts; half of it along the page's edge
    Search search = Search::full;
    std::uint32_t pages = 1;  ///< most pages; above 1, `size` must be given
    ProgressFn progress;      ///< empty: none
};

/// A point p of chart i lies at texel offset + scale (c p.x − s p.y, s p.x + c p.y).
struct Placement {
    double scale = 1, c = 1, s = 0;  ///< texels per unit; cosine and sine of the rotation
    Vec2 offset{0};                  ///< texels, from the corner of the page
};

/// Result of `pack`.
struct Packing {
    bool fits = false;                     ///< with at least 0.1 % of the page covered
    std::uint32_t size = 0;                ///< of the page; when it does not fit, a sufficient one
    std::uint32_t pages = 1;               ///< used pages, or a sufficient number
    std::vector<std::uint32_t> page;       ///< [n_charts] with more than one page allowed
    std::vector<std::uint32_t> too_large;  ///< charts that no page can hold, ascending
    double texels_per_unit = 0;            ///< scale of the charts
    std::vector<Placement> placements;     ///< [n_charts]
};

/// Packs charts; `borders` has one closed simple polygon per chart. Charts smaller than a quarter of a texel are
/// enlarged to that. Masks are bit sets of all cells that a chart touches. Charts are placed largest first, in the
/// best of four directions: that of the lowest centre in a strip as wide as the page. Scale, order and rotations
/// are searched until the strip is a square. Distances between charts are at least `gutter` texels, exactly. With
/// several pages each chart goes to the first with free space. Without a scale, the scale is searched that fills
/// all pages. Offsets are relative to the corner of the chart's page.
Packing pack(const std::vector<std::vector<Vec2>>& borders, const PackOptions& options);

}  // namespace tuft::atlas
