#pragma once

#include <functional>
#include <unordered_map>

#include "atlas/texels/seam_links.h"
#include "ink/exchange/erase.h"

namespace tuft::ink {

/// Tiles as an eraser found them.
using EraseStarts = std::unordered_map<std::uint32_t, EraseStart>;

/// What an eraser draws off beyond its edge: wet ink hangs together, so a rim of a texel or two that the ink had
/// spread over meanwhile goes with what was erased. A wet texel is emptied if it lies next to one of which at least
/// 98 % were erased, and either neither it nor any neighbour has more than a third of what was there, or it is in no
/// square of 5 × 5 texels that all have ink: edges through wet ink that stays are left as they are. Twice; the former
/// over seams too. `before` is called for a slot before it changes; texels
/// that are not `free` (null: all are) stay. Returns what was taken away.
Amounts blot(Canvas& canvas, const atlas::TexelMap& map, const atlas::SeamLinks& seams, const EraseStarts& starts,
             const std::function<bool(std::uint32_t slot, int texel)>& free,
             const std::function<void(std::uint32_t slot)>& before);

}  // namespace tuft::ink
