#pragma once

#include <array>
#include <bitset>
#include <map>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "ink/composite/composite.h"
#include "render/gl/gl_scene.h"
#include "stroke/document/document.h"

/// \file
/// The shown texture of the model. Paint thread, except `TexelUpdate`, which is plain data.
namespace tuft::app {

/// Changed texels, for the graphics card.
struct TexelUpdate {
    std::optional<render::MapPixels> pixels;  ///< the whole texture; apply it before the tiles
    std::vector<render::TilePixels> tiles;
};

/// The shown texture, updated tile by tile: sRGB colour and coded ink height (`render::code_of_height`). Gutters
/// continue over seams. A coarse texel is the mean of the texels of charts and gutters in it. Bare texels between
/// charts do not count, so lookups on the model show no line at seams up to level 3. At level 4 the gutter of 4 texels
/// is narrower than the 8 texels that a lookup reaches beyond a chart.
class Texture {
  public:
    Texture(const stroke::Document& painting, const ProgressFn& progress = {});

    /// Returns the whole atlas with its mip levels.
    render::MapPixels pixels() const;
    /// Switches the fourth channel between ink height and liquid in and on the surface, in the same unit. Updates all.
    void show_wetness(bool on, const stroke::Document& painting);
    /// Dims the texels outside the mask; null: none.
    void show_veil(const stroke::MaskTexels* mask, const stroke::Document& painting);
    /// Highlighted texels, by slot.
    enum Mark : std::uint8_t { kNotMarked, kInked, kRim };
    using Marks = std::map<std::uint32_t, std::array<std::uint8_t, atlas::kTileTexels>>;
    /// Replaces the highlighting: the inked texels, and a rim of two texels round them. Returns the changed tiles.
    std::vector<render::TilePixels> show_marks(Marks marks, const stroke::Document& painting);
    /// The highlighted texels with their rim.
    const Marks& marks() const { return marks_; }
    /// Updates all texels, after a change of the painting's appearance.
    void refresh_all(const stroke::Document& painting);
    /// Updates slots. Returns the changed tiles.
    std::vector<render::TilePixels> refresh(std::span<const std::uint32_t> slots, const stroke::Document& painting);

  private:
    void find_filled(const atlas::TexelMap& map, const atlas::Gutter& gutter);
    const std::vector<render::GlBox>& boxes_of(std::uint32_t tile, const atlas::TexelMap& map);
    void refresh_heights(std::span<const std::uint32_t> slots, const stroke::Document& painting);
    render::TilePixels tile(std::uint32_t index) const;
    std::vector<render::TilePixels> tiles_at(std::span<const std::uint32_t> indices, const atlas::TexelMap& map);
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
    std::vector<std::bitset<atlas::kTileTexels>> filled_;  ///< by tile: texels of charts and gutters
};

}  // namespace tuft::app
