#pragma once

#include <nlohmann/json_fwd.hpp>

#include "stroke/journal/recorded_stroke.h"

/// \file
/// What the strokes of a trajectory are painted with, as JSON. Called by the sources of motion_files.h only.
namespace tuft::io {

/// Returns brush, ink, seed, settings and so on of a stroke in space, without its samples, and back. Back throws
/// `Error` or `nlohmann::json::exception` for anything else.
nlohmann::json stroke_json(const stroke::RecordedStroke& s);
stroke::RecordedStroke stroke_of(const nlohmann::json& j);

}  // namespace tuft::io
