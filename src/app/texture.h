#pragma once

#include <span>
#include <vector>

#include "ink/composite.h"
#include "render/gl_scene.h"
#include "stroke/painting.h"

namespace tuft::app {

/// What the canvas looks like, kept up to date tile by tile: sRGB colour and the film's
/// height in units of 0.1 µm (cut at 25.5 µm). Gutters are continued over the seams.
class Texture {
  public:
    Texture(const stroke::Painting& painting, const ProgressFn& progress = {});

    /// The whole atlas with its levels.
    render::MapPixels pixels() const;
    /// Whether the fourth channel is the liquid that is in and on the surface, in the same unit;
    /// changes it everywhere.
    void show_wetness(bool on, const stroke::Painting& painting);
    /// Brings slots up to date and returns every tile that changed by it.
    std::vector<render::TilePixels> refresh(std::span<const std::uint32_t> slots, const stroke::Painting& painting);
    /// Side of `pixels()`: the atlas's, rounded up to whole tiles.
    std::uint32_t padded_size() const { return padded_; }

  private:
    void refresh_heights(std::span<const std::uint32_t> slots, const stroke::Painting& painting);
    render::TilePixels tile(std::uint32_t index) const;

    std::uint32_t padded_ = 0;
    bool wetness_ = false;
    ink::AtlasMap<std::uint8_t> colour_;
    std::vector<std::uint8_t> height_;  ///< [size²]
};

}  // namespace tuft::app
