#pragma once

#include "footprint/outline/footprint.h"
#include "footprint/stamp/stamp.h"
#include "ink/exchange/contact_grid.h"
#include "ink/exchange/deposit.h"

/// \file
/// One stamp: a footprint with the ink it brings. The session makes stamps, deposit models put them onto texels.
namespace tuft::stroke {

struct Stamp {
    footprint::Footprint footprint;
    footprint::Motion motion;  ///< since the stamp before, in the footprint's frame
    ink::DepositParams ink;
    double ds = 0;          ///< metres of travel it stands for
    double erases = 0;      ///< strength of an eraser, which takes ink instead; 0: it is none
    bool by_hair = false;   ///< drawn by single hairs: the surface's grain shows where it is not filled
    float separation = 0;   ///< 0–1: how much of it is single hairs; 0: one closed patch
    double grain_film = 0;  ///< for `by_hair`: metres of ink under the hair over the grain's mean height
    ink::ContactGrid grid;  ///< over the footprint, for ink that is not the same all over it
};

/// m² of a footprint, by its coverage.
double covered_area(const footprint::Footprint& footprint);

/// The stamp's motion as it is put onto texels of the size `texel` (metres). The edges of a picture are soft over a
/// texel: single hairs begin that much within the stamp before, so that their marks join.
footprint::Motion joined_motion(const Stamp& stamp, double texel);

/// `base` with what single hairs need: drawn sideways they ink all that they pass over.
footprint::StampOptions stamp_options(const footprint::StampOptions& base, const Stamp& stamp);

}  // namespace tuft::stroke
