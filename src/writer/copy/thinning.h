#pragma once

#include "writer/gesture/cells.h"

/// \file
/// Thinning of an area to lines of one cell. Called by skeleton.cpp.
namespace tuft::writer {

/// Thins an area in place to lines that touch by edges or corners of cells [Guo1989]; parts stay connected.
/// Cost: cells of the area × its half width in cells.
void thin(Cells& cells);

}  // namespace tuft::writer
