#pragma once

#include <cstdint>
#include <vector>

#include "stroke/journal/entry/fill.h"
#include "stroke/surface/model.h"

/// \file
/// Charts that a fill covers. Called by painting/apply_fill.h.

namespace tuft::stroke {

/// Returns for each chart of the atlas whether it is filled, 0 or 1. [n_charts] `surface`: of the visible parts.
std::vector<std::uint8_t> charts_of(const Fill& fill, const Model& model, const mesh::SurfaceQuery& surface);

}  // namespace tuft::stroke
