#pragma once

#include "core/system/progress.h"
#include "io/project/project.h"
#include "stroke/painting/painting.h"

/// From a project back to the painting it holds.
namespace tuft::io {

/// Lets the painting use the presets stored in the project.
void use_presets(const Project& project, stroke::Document& painting);

/// Brings the painting to the project's last stroke: by its saved texels where they fit its
/// journal, else by replay.
void restore_strokes(const Project& project, stroke::Document& painting, const ProgressFn& progress);

}  // namespace tuft::io
