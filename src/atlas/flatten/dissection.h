#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// Nested dissection of a graph whose vertices lie in the plane. Called by flatten/ldlt.cpp.
namespace tuft::atlas {

/// The neighbours of n vertices in compressed rows: those of v are `neighbours[start[v]]` to `neighbours[start[v +
/// 1]]`. Each edge is stored at both ends.
struct Neighbours {
    std::vector<std::uint32_t> start;  ///< [n + 1]
    std::vector<std::uint32_t> neighbours;
};

/// An order of elimination in parts. No edge joins two parts of which neither is an ancestor of the other.
struct Dissection {
    /// Vertices `order[first]` to `order[first + n − 1]`, n ≥ 1. Its `n_children` children end right before it, each
    /// after its own descendants.
    struct Part {
        std::uint32_t first = 0, n = 0, n_children = 0;
    };
    std::vector<std::uint32_t> order;  ///< [n] vertices
    std::vector<Part> parts;           ///< children before parents
};

/// Halves the vertices across the longer side of their bounding box, again and again [George1973]. Those of one half
/// that have neighbours in the other are a part of their own, the parent of both; halves of a few vertices are parts.
/// `at` [n]: where the vertices lie; any numbers give a valid order, edges that are short a good one. Vertices at one
/// place are halved in the order of a breadth-first search. Of meshes of n vertices whose edges are short the factors
/// have about 4 n log₂ n entries or fewer, 2.7 n log₂ n for 10,000. Cost: n log n.
Dissection dissect(const Neighbours& graph, std::span<const Vec2> at);

}  // namespace tuft::atlas
