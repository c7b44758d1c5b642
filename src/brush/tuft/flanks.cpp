#include "brush/tuft/flanks.h"

#include <algorithm>
#include <cmath>

#include "brush/tuft/tuft_sections.h"
#include "core/ease.h"

namespace tuft::brush {

namespace {

constexpr double kGround = 0.436, kSteep = 0.8;  // sines of 26° and 53° between e and the wall

}  // namespace

Recycled<rod::Wall> flank_walls(const Preset& p, const Spine& spine, const Quat& turn,
                                std::span<const ContactPlane> walls, double wetness) {
    Recycled<rod::Wall> out;
    if (walls.empty() || spine.sides.flank.size() != walls.size() || spine.sides.position.size() != walls.size())
        return out;
    out.resize(walls.size());
    const int n = spine.rod.segments();
    const double soft = side_stiffness(wetness);
    for (std::size_t k = 0; k < walls.size(); ++k) {
        const int node = n - static_cast<int>(k / 2);
        const Vec3 across = spine.sides.position[k / 2 * 2] - spine.sides.position[k / 2 * 2 + 1];
        const double width = glm::length(across);
        if (node == 0 || !(width > 0)) continue;
        const ContactPlane& wall = walls[k];
        const Vec3 outward = (k % 2 == 0 ? 1.0 : -1.0) * (turn * (across / width));
        const double nearing = -glm::dot(outward, wall.normal);
        const double share = smooth_step((nearing - kGround) / (kSteep - kGround));
        if (share <= 0) continue;
        const double along = glm::dot(spine.memory.tangent[node - 1], wall.normal);
        const double a = spine.sides.flank[k], r = spine.rest.radius[node], b = r * r / a;
        const double h =
            std::sqrt(a * a * nearing * nearing + b * b * std::max(0.0, 1 - nearing * nearing - along * along));
        out[k] = {node, wall.origin / p.length, wall.normal, h / p.length, soft * share};
    }
    return out;
}

void add_walls_across(std::span<const rod::Obstacle> across, Recycled<rod::Wall>& walls) {
    walls.resize(2 * across.size());
    for (std::size_t i = 0; i < across.size(); ++i) {
        const rod::Obstacle& o = across[i];
        const double share = i > 0 && o.normal != Vec3{0} ? 1 : 0;
        // Its flanks lie on the two walls that the node itself rests on.
        if (share > 0)
            for (const std::size_t side : {0, 1}) walls[2 * (across.size() - 1 - i) + side].share = 0;
        walls.push_back({static_cast<int>(i), o.origin, o.normal, o.radius, share, o.beyond_origin, o.beyond_normal});
    }
}

}  // namespace tuft::brush
