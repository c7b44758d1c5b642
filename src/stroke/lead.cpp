#include "stroke/lead.h"

#include <algorithm>
#include <cmath>

#include "brush/sweep.h"
#include "stroke/placement.h"

namespace tuft::stroke {
namespace {

constexpr double kUpright = 0.05, kLeans = 0.15;  // radians

/// Where x lies between the grid's values, held to its ends.
template <std::size_t N>
std::pair<std::size_t, double> cell_of(const std::array<double, N>& grid, double x) {
    std::size_t i = 0;
    while (i + 2 < N && x >= grid[i + 1]) ++i;
    return {i, std::clamp((x - grid[i]) / (grid[i + 1] - grid[i]), 0.0, 1.0)};
}

}  // namespace

const std::vector<Vec2>& LeanedLead::node(std::size_t i, std::size_t j) {
    std::vector<Vec2>& leads = nodes_[i * kAcross.size() + j];
    if (leads.empty()) {
        for (const double part : kDepths) {
            const brush::LinePlace place =
                brush::line_place(preset_, part * working_depth(preset_), {kAlong[i], kAcross[j]});
            leads.push_back({place.behind, -place.aside});
        }
    }
    return leads;
}

Vec2 LeanedLead::of_node(std::size_t i, std::size_t j, double depth) {
    const double part = depth / working_depth(preset_);
    if (part < kDepths[0]) return part / kDepths[0] * node(i, j)[0];
    const auto [k, f] = cell_of(kDepths, part);
    return glm::mix(node(i, j)[k], node(i, j)[k + 1], f);
}

Vec2 LeanedLead::at(double depth, const Vec2& lean) {
    const double s = std::clamp((glm::length(lean) - kUpright) / (kLeans - kUpright), 0.0, 1.0);
    if (s <= 0 || depth <= 0) return Vec2{0};
    const auto [i, f] = cell_of(kAlong, lean.x);
    const auto [j, g] = cell_of(kAcross, std::abs(lean.y));
    Vec2 leaned{0};
    for (const auto& [a, wa] : {std::pair{i, 1 - f}, std::pair{i + 1, f}})
        for (const auto& [b, wb] : {std::pair{j, 1 - g}, std::pair{j + 1, g}})
            if (wa * wb > 0) leaned += wa * wb * of_node(a, b, depth);
    // Leaning to the other side is the mirror image.
    if (lean.y < 0) leaned.y = -leaned.y;
    constexpr std::size_t kUprightNode = 3;
    static_assert(kAlong[kUprightNode] == 0 && kAcross[0] == 0);
    return s * s * (3 - 2 * s) * (leaned - of_node(kUprightNode, 0, depth));
}

}  // namespace tuft::stroke
