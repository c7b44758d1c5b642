#pragma once

#include <cstdint>
#include <vector>

#include "stroke/journal/fill.h"
#include "stroke/surface/model.h"

namespace tuft::stroke {

/// For each chart of the atlas whether it is filled, [n_charts].
std::vector<std::uint8_t> charts_of(const Fill& fill, const Model& model);

}  // namespace tuft::stroke
