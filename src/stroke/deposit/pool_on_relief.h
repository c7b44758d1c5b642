#pragma once

#include <functional>

#include "atlas/texels/seam_links.h"
#include "stroke/deposit/stamp_target.h"

namespace tuft::stroke {

/// After a stroke of thin ink over thick dry paint: the ink runs off the ridges and stands in the furrows
/// (ink/texels/pool.h). Nothing happens, and `seams` is not asked for, where no such paint lies on the tiles that were
/// written to.
void pool_on_relief(StampTarget& target, const ink::Ink& ink, const std::function<const atlas::SeamLinks&()>& seams);

}  // namespace tuft::stroke
