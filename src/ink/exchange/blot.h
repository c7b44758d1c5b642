#pragma once

#include <functional>
#include <unordered_map>

#include "atlas/texels/seam_links.h"
#include "ink/exchange/erase.h"

/// \file
/// Blotting at the edge of an eraser stroke in wet ink. Called by `stroke` at the end of the stroke.
namespace tuft::ink {

/// Tiles as an eraser found them.
using EraseStarts = std::unordered_map<std::uint32_t, EraseStart>;

/// Removes wet ink beyond the eraser's edge: a rim of one or two texels over which the ink has spread since. A wet
/// texel is emptied if it is adjacent to a texel of which at least 98 % was erased, and one of two conditions
/// holds. First: neither it nor any neighbour has more than a third of its former amount. Second: it is in no
/// square of 5 × 5 texels that all have ink. Edges through wet ink that remains are unchanged. The rule is applied
/// twice; the first condition acts over seams too. `before` is called for a slot before it changes. Texels that are
/// not `free` (null: all are) do not change. Returns the removed amounts.
Amounts blot(Canvas& canvas, const atlas::TexelMap& map, const atlas::SeamLinks& seams, const EraseStarts& starts,
             const std::function<bool(std::uint32_t slot, int texel)>& free,
             const std::function<void(std::uint32_t slot)>& before);

}  // namespace tuft::ink
