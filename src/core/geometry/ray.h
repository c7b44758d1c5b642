#pragma once

#include "core/geometry/types.h"

/// \file
/// A half-line. The window's camera makes rays, and a pointer aims along them.
namespace tuft {

struct Ray {
    Vec3 origin{0};           ///< metres, world
    Vec3 direction{0, 1, 0};  ///< unit
};

}  // namespace tuft
