#pragma once

#include "footprint/outline/footprint.h"
#include "footprint/stamp/stamp.h"
#include "ink/exchange/contact_grid.h"
#include "ink/exchange/deposit.h"
#include "ink/exchange/film_tone.h"

/// \file
/// A stamp: a footprint with the ink that it deposits. `StrokeSession` makes stamps; deposit models apply them to
/// texels.
namespace tuft::stroke {

/// The footprint at one pose, with its motion and its ink.
struct Stamp {
    footprint::Footprint footprint;
    footprint::Motion motion;  ///< since the stamp before, in the footprint's frame
    ink::DepositParams ink;
    double ds = 0;          ///< metres of travel that it stands for
    double slides = 0;      ///< part of the hand's way on which foam slides along, 0–1
    double erases = 0;      ///< strength of an eraser, which removes ink; 0: no eraser
    bool leapt = false;     ///< hair leapt since the stamp before; if wet, all that it passed over is in the footprint
    bool by_hair = false;   ///< made of single hairs: the substrate's grain shows where ink does not fill it
    float separation = 0;   ///< part of it that is single hairs, 0–1; 0: one closed patch
    double grain_film = 0;  ///< by hair: metres of ink under the hair above the grain's mean height
    ink::ContactGrid grid;  ///< over the footprint, for ink that varies over it
    ink::FilmTone tone;     ///< film of one ink by place across the hair
    float grain_share = 0;  ///< of `ink::apply_grain`
};

/// Returns the area of a footprint weighted by its coverage, m².
double covered_area(const footprint::Footprint& footprint);

/// Returns the stamp's motion for texels of size `texel` (metres). Edges are soft over one texel: marks of single hairs
/// begin that much within the stamp before, so that they join.
footprint::Motion joined_motion(const Stamp& stamp, double texel);

/// Returns `base` with the options of single hairs: drawn sideways they ink everything that they sweep.
footprint::StampOptions stamp_options(const footprint::StampOptions& base, const Stamp& stamp);

}  // namespace tuft::stroke
