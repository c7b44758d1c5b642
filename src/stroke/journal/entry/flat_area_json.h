#pragma once

#include <nlohmann/json_fwd.hpp>

#include "stroke/journal/entry/flat_area.h"

/// \file
/// Areas of a drawing as JSON, for projects and stroke files. Called by fill.cpp. Not installed.
namespace tuft::stroke {

/// Returns an area as JSON, and back. Back throws `Error` where it cannot be read.
nlohmann::json json_of(const FlatArea& area);
FlatArea flat_area_of(const nlohmann::json& json);

}  // namespace tuft::stroke
