#include <cmath>

#include "ink/composite/composite.h"
#include "ink/spectra/kubelka_munk.h"
#include "stroke/painting/painting.h"

/// What a painting does with its palette.
namespace tuft::stroke {

Palette& Document::plate() {
    if (!palette_) palette_ = std::make_unique<Palette>();
    return *palette_;
}

const Model& Document::target_model(const Stroke& entry) {
    return entry.layer == kPaletteLayer ? plate().model : *model_;
}

const ink::Substrate& Document::substrate_of(const Stroke& entry) const {
    return entry.layer == kPaletteLayer ? palette_->substrate : substrate_;
}

Pick Document::pick_palette(const Vec3& point) {
    const LayerTexels texels{kPaletteLayer, &canvas(kPaletteLayer)};
    return pick_at(point, plate().model, std::span(&texels, 1));
}

std::vector<std::uint32_t> Document::take_palette_dirty() {
    return palette_ ? palette_->canvas.take_dirty() : std::vector<std::uint32_t>{};
}

std::vector<LayerTexels> Document::all_canvases() const {
    std::vector<LayerTexels> all = canvases();
    if (palette_ && !palette_->canvas.touched_slots().empty()) all.push_back({kPaletteLayer, &palette_->canvas});
    return all;
}

namespace {

constexpr int kFirstColumn = static_cast<int>((kPaletteTexels * kPaletteTexel - kPaletteWidth) / 2 / kPaletteTexel);
constexpr int kFirstRow = 16;  // of texels that the plate covers

}  // namespace

void refresh(PalettePicture& picture, const Document& painting) {
    const ink::Rgb bare = palette_substrate().reflectance;
    picture.rgb.resize(3 * static_cast<std::size_t>(picture.width * picture.height));
    for (std::size_t i = 0; i < picture.rgb.size(); ++i)
        picture.rgb[i] = static_cast<std::uint8_t>(std::lround(255 * ink::srgb_encode(bare[i % 3])));
    if (painting.palette()) refresh(picture, painting, painting.palette()->touched_slots());
}

void refresh(PalettePicture& picture, const Document& painting, std::span<const std::uint32_t> slots) {
    if (picture.rgb.empty()) return refresh(picture, painting);
    const Palette& palette = *painting.palette_;
    const atlas::TexelMap& map = palette.model.texels;
    for (const std::uint32_t slot : slots) {
        const ink::TileAppearance look = ink::shade_tile(palette.canvas, slot, palette.substrate);
        const int tile = static_cast<int>(map.tile_of_slot[slot]), per_side = static_cast<int>(map.tiles_per_side);
        for (int t = 0; t < atlas::kTileTexels; ++t) {
            const int x = tile % per_side * atlas::kTile + t % atlas::kTile - kFirstColumn;
            const int y = picture.height - 1 - (tile / per_side * atlas::kTile + t / atlas::kTile - kFirstRow);
            if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) continue;
            for (std::size_t c = 0; c < 3; ++c)
                picture.rgb[3 * static_cast<std::size_t>(y * picture.width + x) + c] = static_cast<std::uint8_t>(
                    std::lround(255 * ink::srgb_encode(look.colour[c][static_cast<std::size_t>(t)])));
        }
    }
}

void Document::wash(const Stroke& entry) {
    Undo undo{.stroke_id = entry.id};
    ink::Canvas& canvas = this->canvas(kPaletteLayer);
    LayerTiles& before = undo.before.emplace_back(LayerTiles{.layer = kPaletteLayer, .tiles = {}});
    for (const std::uint32_t slot : canvas.touched_slots()) before.tiles.push_back(canvas.snapshot(slot));
    canvas.clear();
    keep_undo(std::move(undo));
}

}  // namespace tuft::stroke
