#pragma once

#include <string>

#include "cli/arguments/arguments.h"
#include "render/picture/camera_path.h"
#include "stroke/surface/model.h"

/// \file
/// The camera of `tuft film`. Main thread.
namespace tuft::cli {

/// Throws `UsageError` or `Error` where `camera` (`Film::camera`) names no path; reads a file of key frames:
///
///     [[key]]
///     at = 0.5             # part of the film, 0 … 1, rising
///     azimuth = 30         # degrees; as --view, which is the default
///     elevation = 25
///     zoom = 1             # as --zoom
///     target = [0, 0, 40]  # mm; as --target
///
/// Returns the path for a model.
render::CameraPath camera_path(const std::string& camera, const View& view, const stroke::Model& model);

}  // namespace tuft::cli
