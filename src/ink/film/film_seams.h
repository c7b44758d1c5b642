#pragma once

#include <cstddef>
#include <span>

#include "ink/film/film_list.h"
#include "ink/film/film_worker.h"

/// \file
/// Flow of the wet film over seams. Internal to the wet film (film.h).
namespace tuft::ink::wet {

/// A tile of the list in a step.
struct SeamTile {
    const TileList& tiles;
    std::span<const Sources> sources;  ///< of the list
    Part part = Part::whole;
    std::size_t index = 0;  ///< of the tile
};
/// Adds the flow over the seams of a tile to dw and ds of `work`, and sets what pigments need in `crossing`. `thin`:
/// less than rim_depth stands on some texel.
void cross_seams(const SeamTile& tile, int pigments, const Step& step, bool thin, Work& work, Crossing& crossing);

/// Of a texel; 0: none.
inline float at(const Plane* plane, int texel) {
    return plane ? (*plane)[texel] : 0;
}

}  // namespace tuft::ink::wet
