#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "atlas/texels/texel_map.h"

/// The colours a model brings along, as the ground that ink lies on.
namespace tuft::ink {

/// Colour of the bare surface per texel, sRGB-encoded, in slots of the texel map.
struct BaseColour {
    struct Tile {
        alignas(64) std::array<std::array<std::uint8_t, atlas::kTileTexels>, 3> rgb;
    };
    std::vector<Tile> tiles;  ///< [n_slots]; empty: the substrate's colour everywhere

    bool empty() const { return tiles.empty(); }
};

/// The colours of the mesh's materials and vertices at the texels' centres, products and means
/// in linear light. A picture is read bilinearly, from the level of its mip-map (means of 2 × 2)
/// whose pixels are as large as texels, round its ends or up to them: where all UVs of a triangle
/// lie in [0, 1], colours of the opposite end stay out. Empty for a mesh without colours. The same
/// bits for any number of threads; about 0.5 s at 4096² on two.
BaseColour base_colour_of(const mesh::TriangleMesh& mesh, const atlas::Atlas& atlas, const atlas::TexelMap& map);

}  // namespace tuft::ink
