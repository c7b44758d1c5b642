#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/types.h"

namespace tuft::atlas {

/// A flat piece of mesh cut in halves across its longer side again and again (nested dissection,
/// George 1973).
struct Dissection {
    static constexpr std::uint32_t kNoParent = ~0u;

    /// The vertices along a cut, or of a part that is not cut further.
    struct Node {
        std::uint32_t begin = 0, end = 0;  ///< in `order`
        std::uint32_t parent = kNoParent;  ///< the cut that made this part; a later one in `nodes`
    };
    /// Vertices in an order of elimination: those along a cut after those of both its sides. A
    /// factor of a matrix on the mesh's edges has O(n log n) entries then.
    std::vector<std::uint32_t> order;
    std::vector<Node> nodes;  ///< by `begin`; each vertex in one
};

/// `at`: places of vertices; `faces`: corners, those from `at.size()` on are left out. Where the
/// places do not part the mesh well, since it lies on itself, the steps along edges from one end
/// do.
Dissection dissect(std::span<const Vec2> at, std::span<const std::array<std::uint32_t, 3>> faces);

}  // namespace tuft::atlas
