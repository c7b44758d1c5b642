#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/types.h"
#include "core/system/progress.h"

/// Lays chart shapes side by side in a square page, as large as they fit.
namespace tuft::atlas {

/// How long to look for a good layout of one page: take the first that fits, look a little and
/// on coarse masks (to compare sets of charts), look well, or look with charts turned by 22.5°
/// too, again while less than 65 % of the page are covered: twice the time, 2 % more of the page.
enum class Search { quick, coarse, full, patient };

struct PackOptions {
    std::uint32_t size = 0;      ///< texels per side; 0: as many as `texels_per_unit` needs
    double texels_per_unit = 0;  ///< scale; 0: the largest that fits `size`
    std::uint32_t gutter = 4;    ///< texels free between charts; half of it along the page's edge
    Search search = Search::full;
    std::uint32_t pages = 1;  ///< most pages; above 1, `size` must be given
    ProgressFn progress;
};

/// A point p of chart i lies at texel offset + scale (c p.x − s p.y, s p.x + c p.y).
struct Placement {
    double scale = 1, c = 1, s = 0;
    Vec2 offset{0};
};

struct Packing {
    bool fits = false;                     ///< with at least 0.1 % of the page covered
    std::uint32_t size = 0;                ///< of the page; when it does not fit, one that would
    std::uint32_t pages = 1;               ///< that are used, or would be
    std::vector<std::uint32_t> page;       ///< [n_charts] with more than one page allowed
    std::vector<std::uint32_t> too_large;  ///< charts that no page can hold, ascending
    double texels_per_unit = 0;
    std::vector<Placement> placements;  ///< [n_charts]
};

/// `borders`: one closed simple polygon per chart. Charts smaller than a quarter of
/// a texel are enlarged to that. Bit masks of all cells a chart touches, largest
/// chart first, in four directions each, where its middle comes to lie lowest in a strip as
/// wide as the page; scale, order and turns are searched until the strip is a square. Distances
/// between charts are at least `gutter` texels, exactly. With several pages allowed, each chart
/// comes to the first that has room for it; without a scale, the scale is searched at which all
/// pages are filled. Offsets count from the corner of the chart's own page.
Packing pack(const std::vector<std::vector<Vec2>>& borders, const PackOptions& options);

}  // namespace tuft::atlas
