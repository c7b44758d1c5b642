#pragma once

#include "io/project/project.h"
#include "stroke/document/document.h"

/// How a project's work is shown: kept beside how it was painted.
namespace tuft::io {

/// Shows the painting as the project says. Its inks must be in use already.
void apply_recolouring(const Project& project, stroke::Document& painting);

/// Stores how the painting is shown.
void store_looks(Project& project, const stroke::Document& painting);

}  // namespace tuft::io
