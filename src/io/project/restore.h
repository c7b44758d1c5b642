#pragma once

#include "core/system/progress.h"
#include "io/project/project.h"
#include "stroke/document/document.h"

/// \file
/// Restores the painting of a project. Called by `cli` and by the studio's paint thread. One thread at a time per
/// project.
namespace tuft::io {

/// Adds the presets stored in the project to the painting. Throws `Error` for a damaged preset.
void use_presets(const Project& project, stroke::Document& painting);

/// Brings the painting to the state after the project's last stroke. It uses the saved texels where they fit the
/// journal, else replays. Throws `Error`, `Cancelled`.
void restore_strokes(const Project& project, stroke::Document& painting, const ProgressFn& progress);

}  // namespace tuft::io
