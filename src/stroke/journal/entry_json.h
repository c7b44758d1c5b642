#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "stroke/journal/fill.h"
#include "stroke/journal/layers.h"
#include "stroke/journal/mask.h"

/// The parts of a journal's entry as JSON; included by sources of this module only. Readers
/// throw `Error` for wrong types and values.
namespace tuft::stroke {

/// A whole number from 0 to `kNone` - 1, the number `name` of a thing. nlohmann's own conversion from 1e300 is
/// undefined.
std::uint32_t number_of(const nlohmann::json& json, const char* name);

nlohmann::json json_of(const LayerEdit& edit);
LayerEdit layer_edit_of(const nlohmann::json& json);

nlohmann::json json_of(const Fill& fill);
Fill fill_of(const nlohmann::json& json);

nlohmann::json json_of(const MaskEdit& edit);
MaskEdit mask_edit_of(const nlohmann::json& json);

}  // namespace tuft::stroke
