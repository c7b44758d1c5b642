#pragma once

#include <cstdint>
#include <span>

#include "ink/exchange/contact_grid.h"

/// \file
/// Arguments that the exchanges of one stamp with one tile share. Filled by `stroke` for every tile of every stamp.
namespace tuft::ink {

/// What a stamp covers of one tile. All fields are required; the spans must outlive the call.
struct CoveredTile {
    std::uint32_t slot;
    std::span<const float, atlas::kTileTexels> coverage;  ///< [256] 0–1
    std::span<const float, atlas::kTileTexels> area;      ///< [256] m² of surface per texel, > 0
};

/// One stamp on one tile. All fields are required.
struct StampedTile {
    CoveredTile covered;
    double ds;  ///< metres of travel of the stamp, >= 0
};

/// The same with the contact patch over the tile. The references must outlive the call.
struct ContactTile {
    StampedTile stamp;
    const TexelPlaces& places;  ///< of the texels in the patch
    const HatBasis& hats;       ///< of the patch's nodes over the tile
};

/// Motion of the tuft from the last contact to this one.
struct ContactStep {
    double ds = 0;      ///< metres of travel, >= 0
    double dt = 0;      ///< seconds; negative counts as 0
    double stress = 0;  ///< 0–1, of the tuft on the surface
    double pour = 0;    ///< film units that run off a dripping tuft in this contact, >= 0
};

}  // namespace tuft::ink
