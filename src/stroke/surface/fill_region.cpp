#include "stroke/surface/fill_region.h"

#include <algorithm>

#include "core/error.h"

namespace tuft::stroke {

std::vector<std::uint8_t> charts_of(const Fill& fill, const Model& model, const mesh::SurfaceQuery& surface) {
    const std::vector<std::uint32_t>& chart = model.atlas.triangle_chart;
    std::vector<std::uint8_t> filled(model.atlas.n_charts, fill.region == Region::all);
    if (fill.region == Region::all) return filled;
    const auto at = surface.closest_point(fill.at);
    if (!at) throw Error("there is no surface to fill");
    filled[chart[at->triangle]] = 1;
    if (fill.region == Region::chart) return filled;
    std::vector<std::uint8_t> seen(model.mesh->n_triangles(), 0);
    std::vector<std::uint32_t> open{at->triangle};
    seen[at->triangle] = 1;
    while (!open.empty()) {
        const std::uint32_t triangle = open.back();
        open.pop_back();
        filled[chart[triangle]] = 1;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t next = model.mesh->neighbours[3 * std::size_t{triangle} + k];
            if (next == kNone || seen[next]) continue;
            seen[next] = 1;
            open.push_back(next);
        }
    }
    return filled;
}

}  // namespace tuft::stroke
