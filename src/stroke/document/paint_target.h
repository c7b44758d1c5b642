#pragma once

#include "ink/canvas/canvas.h"
#include "ink/colour/pigments.h"
#include "stroke/surface/mask_texels.h"
#include "stroke/surface/model.h"

/// \file
/// Where a stroke or a fill leaves its ink. Made by `Document` for each of them.
namespace tuft::stroke {

/// A layer of the model, or the palette.
struct PaintTarget {
    const Model& model;
    const ink::Substrate& substrate;
    ink::Canvas& canvas;
    const MaskTexels* mask = nullptr;  ///< texels that may change; null: all of them
    bool on_palette = false;           ///< ink is always wet there
};

}  // namespace tuft::stroke
