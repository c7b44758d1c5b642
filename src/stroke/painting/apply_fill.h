#pragma once

#include <vector>

#include "ink/exchange/deposit.h"
#include "stroke/journal/entry/fill.h"
#include "stroke/painting/paint_target.h"

/// \file
/// Fills and gradients on texels. Called by `Document` for entries with a `Fill`.
namespace tuft::stroke {

/// The inks of a fill by plane of the canvas.
struct FillMixes {
    ink::Mix first{}, second{};
};

/// What a fill did.
struct FillResult {
    std::vector<ink::TileSnapshot> before;  ///< tiles that it may have written to, by slot
    double ink_given = 0;                   ///< film·m²
    bool met = false;                       ///< an area lies on texels, masked ones among them
};

/// Lays the film of `fill` on every texel of its region, weighted by the mask; on the palette the film's water comes
/// with it. Tiles in parallel; the bits do not depend on the number of threads. Throws `Error` as `check_fill` does.
FillResult apply_fill(const Fill& fill, const PaintTarget& target, const FillMixes& mixes);

}  // namespace tuft::stroke
