#pragma once

#include "stroke/pointer/pointer_input.h"

/// \file
/// The pointer that holds a brush, by its names in the window. The window brings the aims; what they become is decided
/// in `stroke/pointer`, for both programs.
namespace tuft::app {

using stroke::Aim;
using stroke::aim_at;
using stroke::AimedSurface;
using stroke::BrushTipLag;
using stroke::pen_depth;
using stroke::PointerInput;
using stroke::PointerSettings;
using stroke::StrokeStep;

}  // namespace tuft::app
