#pragma once

#include <string>

#include "atlas/atlas.h"
#include "core/message.h"

/// \file
/// Check of an atlas that a project file brings. Called by `io`.
namespace tuft::atlas {

/// Returns why an atlas cannot be painted on, empty when it can. Faults are UVs that are not finite, off the atlas
/// or the triangle's page, mirrored, or that overlap. Cost: about 0.1 s at 4096².
Message fault_of(const Atlas& atlas);

}  // namespace tuft::atlas
