#pragma once

#include "io/project/project.h"
#include "stroke/document/document.h"

/// \file
/// How a project's painting is shown: recoloured inks and the previewed substrate. Stored apart from the journal.
/// Called by `cli` and by the paint thread. One thread at a time per project.
namespace tuft::io {

/// Sets the painting's recolouring and shown substrate from the project. Call it after `use_presets`. Throws `Error`.
void apply_recolouring(const Project& project, stroke::Document& painting);

/// Stores the painting's recolouring and shown substrate in the project. Throws `Error`, `ChangedOutside`.
void store_recolouring(Project& project, const stroke::Document& painting);

}  // namespace tuft::io
