#include "mesh/material.h"

#include <cmath>

namespace tuft::mesh {

std::uint32_t udim_at(std::span<const Vec2f> uvs) {
    constexpr double kColumns = 10, kRows = 100;
    Vec2 sum(0);
    for (const Vec2f& uv : uvs) sum += Vec2(uv);
    const Vec2 at = glm::floor(sum / static_cast<double>(uvs.size()));
    if (!(at.x >= 0 && at.x < kColumns && at.y >= 0 && at.y < kRows)) return 0;
    return 1001 + static_cast<std::uint32_t>(at.x + kColumns * at.y);
}

}  // namespace tuft::mesh
