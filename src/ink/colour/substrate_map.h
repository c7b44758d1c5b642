#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "atlas/texels/texel_map.h"
#include "ink/colour/pigments.h"

/// \file
/// Substrates of a model whose parts are of different materials. `stroke` makes the map; composite.h and strokes read
/// it.
namespace tuft::ink {

/// Substrate of each texel of a model. Index 0 is the document's substrate, index i is `others[i − 1]`. Reading is safe
/// in several threads.
struct SubstrateMap {
    using Indices = std::array<std::uint8_t, atlas::kTileTexels>;

    std::vector<Substrate> others;              ///< at most 255
    std::vector<std::uint8_t> of_slot;          ///< [n_slots] index of most texels of the tile
    std::map<std::uint32_t, Indices> of_texel;  ///< by slot, of tiles with several

    const Substrate& at(std::uint8_t index, const Substrate& document) const {
        return index == 0 ? document : others[index - 1u];
    }
    /// Returns the substrate of most texels of a tile.
    const Substrate& of(std::uint32_t slot, const Substrate& document) const { return at(of_slot[slot], document); }
    /// Whether a texel of the tile has another substrate than the document's.
    bool differs(std::uint32_t slot) const { return of_slot[slot] != 0 || of_texel.contains(slot); }
};

}  // namespace tuft::ink
