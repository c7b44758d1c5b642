#pragma once

#include <functional>

#include "atlas/texels/seam_links.h"
#include "stroke/deposit/stamp_target.h"

/// \file
/// Thin ink on thick dry paint. Called by deposit models at the end of a stroke.

namespace tuft::stroke {

/// Lets ink of the stroke run off ridges and stand in furrows of dry paint below it (ink/texels/pool.h), on the tiles
/// that were written to. Does nothing, and does not call `seams`, without such paint there.
void pool_on_relief(StampTarget& target, const ink::Ink& ink, const std::function<const atlas::SeamLinks&()>& seams);

}  // namespace tuft::stroke
