#pragma once

#include <array>
#include <map>
#include <span>
#include <unordered_map>
#include <vector>

#include "ink/composite/composite.h"
#include "render/gl/gl_scene.h"
#include "stroke/painting/painting.h"

namespace tuft::app {

/// What the canvas looks like, kept up to date tile by tile: sRGB colour and the
/// code of the height of its ink (`render::code_of_height`). Gutters are continued over the seams.
class Texture {
  public:
    Texture(const stroke::Document& painting, const ProgressFn& progress = {});

    /// The whole atlas with its levels.
    render::MapPixels pixels() const;
    /// Whether the fourth channel is the liquid that is in and on the surface, in the same unit;
    /// changes it everywhere.
    void show_wetness(bool on, const stroke::Document& painting);
    /// Veils what the mask leaves out; null: nothing.
    void show_veil(const stroke::MaskTexels* mask, const stroke::Document& painting);
    /// Texels to be highlighted, by slot.
    enum Mark : std::uint8_t { kNotMarked, kInked, kRim };
    using Marks = std::map<std::uint32_t, std::array<std::uint8_t, atlas::kTileTexels>>;
    /// Highlights the inked texels, with a rim of two texels round them, in the place of what was highlighted before;
    /// returns every tile that changed by it.
    std::vector<render::TilePixels> show_marks(Marks marks, const stroke::Document& painting);
    /// What is highlighted, with its rim.
    const Marks& marks() const { return marks_; }
    /// Everything anew, for another look of the painting as a whole.
    void refresh_all(const stroke::Document& painting);
    /// Brings slots up to date and returns every tile that changed by it.
    std::vector<render::TilePixels> refresh(std::span<const std::uint32_t> slots, const stroke::Document& painting);
    /// Side of `pixels()`: the atlas's, rounded up to whole tiles.
    std::uint32_t padded_size() const { return padded_; }

  private:
    const std::vector<render::GlBox>& boxes_of(std::uint32_t tile, const atlas::TexelMap& map);
    void refresh_heights(std::span<const std::uint32_t> slots, const stroke::Document& painting);
    render::TilePixels tile(std::uint32_t index) const;
    void continue_over_seams(std::vector<std::uint8_t>& values, std::uint32_t slot,
                             const stroke::Document& painting) const;
    std::array<std::uint8_t, 4> texel(std::size_t x, std::size_t y) const;

    std::uint32_t padded_ = 0;
    bool wetness_ = false;
    ink::AtlasMap<std::uint8_t> colour_;
    std::vector<std::uint8_t> height_;                                     ///< [size²]
    std::unordered_map<std::uint32_t, std::vector<render::GlBox>> boxes_;  ///< by tile, of those that changed so far
    std::vector<std::uint8_t> veil_;                                       ///< [size²], 0–255; empty: none
    Marks marks_;
    std::unordered_map<std::uint32_t, const std::array<std::uint8_t, atlas::kTileTexels>*> marks_of_tile_;
};

}  // namespace tuft::app
