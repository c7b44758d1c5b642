#pragma once

#include <string>

#include "atlas/atlas.h"
#include "core/message.h"

/// \file
/// Check of an atlas that was stored: by a project (`io`) or in the cache of prepared models (`stroke`).
namespace tuft::atlas {

/// Returns why an atlas cannot be painted on, empty when it can. Faults are sizes, pages and charts that no
/// atlas has, and UVs that are not finite, off the atlas or the triangle's page, mirrored, or that overlap. Cost: about
/// 0.1 s at 4096².
Message fault_of(const Atlas& atlas);

}  // namespace tuft::atlas
