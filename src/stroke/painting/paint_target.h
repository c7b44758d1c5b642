#pragma once

#include "ink/canvas/canvas.h"
#include "ink/colour/pigments.h"
#include "ink/colour/substrate_map.h"
#include "stroke/surface/mask_texels.h"
#include "stroke/surface/model.h"

/// \file
/// Where a stroke or a fill leaves its ink. Made by `Document` for each of them.
namespace tuft::stroke {

/// A layer of the model, or the palette.
struct PaintTarget {
    const Model& model;
    const mesh::SurfaceQuery& surface;  ///< of what is visible of it
    const ink::Substrate& substrate;
    ink::Canvas& canvas;
    const MaskTexels* mask = nullptr;               ///< texels that may change; null: all of them
    const ink::SubstrateMap* substrates = nullptr;  ///< of the texels; null: `substrate` everywhere
    bool on_palette = false;                        ///< ink is always wet there

    /// Film units that stay on a texel of a tile.
    float capacity(std::uint32_t slot) const {
        return substrates ? substrates->of(slot, substrate).capacity : substrate.capacity;
    }
};

}  // namespace tuft::stroke
