#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "atlas/texels/texel_map.h"

/// \file
/// Base colour of a model: the colours of its file, under the ink. `stroke` makes it once per model; composite.h
/// reads it.
namespace tuft::ink {

/// Colour of the bare surface per texel, sRGB-encoded, in slots of the texel map.
struct BaseColour {
    struct Tile {
        alignas(64) std::array<std::array<std::uint8_t, atlas::kTileTexels>, 3> rgb;
    };
    std::vector<Tile> tiles;  ///< [n_slots]; empty: the substrate's colour everywhere

    bool empty() const { return tiles.empty(); }
};

/// Bakes the colours of the mesh's materials and vertices at the texels' centres; products and means are in linear
/// light. A picture is read bilinearly from the mip-map level (means of 2 × 2) with pixels as large as texels. It
/// wraps, or clamps where all UVs of a triangle lie in [0, 1], so that colours of the opposite edge do not bleed
/// in. Empty for a mesh without colours. The same bits for any number of threads. Cost: about 0.5 s at 4096² on two
/// threads.
BaseColour base_colour_of(const mesh::TriangleMesh& mesh, const atlas::Atlas& atlas, const atlas::TexelMap& map);

}  // namespace tuft::ink
