#include "stroke/layers/palette.h"

#include <cmath>

#include "ink/composite/composite.h"
#include "ink/spectra/kubelka_munk.h"
#include "stroke/surface/flat_sheet.h"

namespace tuft::stroke {
namespace {

constexpr double kPoolEdge = 25;  // film units that stand at the rim of a pool on glaze
constexpr Vec2 kCorner{kPaletteTexels / 2 * kPaletteTexel, 0.049};  // uv (0, 0) lies at − this

// Of the texels that the plate covers.
constexpr int kFirstColumn = static_cast<int>((kPaletteTexels * kPaletteTexel - kPaletteWidth) / 2 / kPaletteTexel);
constexpr int kFirstRow = 16;

}  // namespace

Model make_palette() {
    const Vec2 corner = 0.5 * Vec2(kPaletteWidth, kPaletteHeight);
    return make_flat_sheet({.frame = {},
                            .low = -corner,
                            .high = corner,
                            .columns = 12,
                            .rows = 9,
                            .texels = kPaletteTexels,
                            .texel = kPaletteTexel,
                            .corner = -kCorner});
}

ink::Substrate palette_substrate() {
    return {
        .name = "palette",
        .title = "Palette of glazed porcelain",
        .reflectance = {0.86f, 0.86f, 0.85f},
        .roughness = 0.1f,
        .capacity = 200,
        .interface = 1,
        .relief = 1e-6f,
        .relief_length = 40e-6f,
        .wetting = {.absorbency = 0, .pores = 0, .diffusion = 1e-10f, .threshold = 0.1f, .edge = 0, .evaporation = 0}};
}

ink::FilmParams palette_film() {
    ink::FilmParams params = ink::film_params(palette_substrate(), Vec3{0});
    params.pin = kPoolEdge;
    params.drying.evaporation = 0;
    params.drying.rim_evaporation = 0;
    params.drying.stain = 0;
    return params;
}

Palette::Plate::Plate()
    : model(make_palette()),
      substrate(palette_substrate()),
      params(palette_film()),
      canvas(model.texels.n_slots()),
      seams(atlas::build_seam_links(*model.mesh, model.atlas, model.texels)),
      film(std::make_unique<ink::WetFilm>(model.texels, seams)) {}

Palette::Plate& Palette::made() const {
    if (!plate_) plate_ = std::make_unique<Plate>();
    return *plate_;
}

Palette::Plate& Palette::plate() {
    return made();
}

ink::Canvas& Palette::canvas_with(const std::vector<ink::Pigment>& pigments) {
    ink::Canvas& canvas = plate().canvas;
    for (std::size_t p = canvas.pigments().size(); p < pigments.size(); ++p) canvas.add_pigment(pigments[p]);
    return canvas;
}

void Palette::clear() {
    if (plate_) plate_->canvas.clear();
}

void Palette::forget_pigments(std::size_t n) {
    if (plate_) plate_->canvas.forget_pigments(n);
}

std::vector<std::uint32_t> Palette::take_dirty() {
    return plate_ ? plate_->canvas.take_dirty() : std::vector<std::uint32_t>{};
}

void refresh(PalettePicture& picture, const Palette& palette) {
    const ink::Rgb bare = palette_substrate().reflectance;
    picture.rgb.resize(3 * static_cast<std::size_t>(picture.width * picture.height));
    for (std::size_t i = 0; i < picture.rgb.size(); ++i)
        picture.rgb[i] = static_cast<std::uint8_t>(std::lround(255 * ink::srgb_encode(bare[i % 3])));
    if (palette.canvas()) refresh(picture, palette, palette.canvas()->touched_slots());
}

void refresh(PalettePicture& picture, const Palette& palette, std::span<const std::uint32_t> slots) {
    if (picture.rgb.empty()) return refresh(picture, palette);
    const atlas::TexelMap& map = palette.model().texels;
    const ink::Substrate substrate = palette_substrate();
    for (const std::uint32_t slot : slots) {
        const ink::TileAppearance appearance = ink::shade_tile(*palette.canvas(), slot, substrate);
        for (std::uint32_t t = 0; t < atlas::kTileTexels; ++t) {
            const atlas::TexelPlace at = atlas::texel_place(map, slot, t);
            const int x = static_cast<int>(at.x) - kFirstColumn;
            const int y = picture.height - 1 - (static_cast<int>(at.y) - kFirstRow);
            if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) continue;
            for (std::size_t c = 0; c < 3; ++c)
                picture.rgb[3 * static_cast<std::size_t>(y * picture.width + x) + c] =
                    static_cast<std::uint8_t>(std::lround(255 * ink::srgb_encode(appearance.colour[c][t])));
        }
    }
}

}  // namespace tuft::stroke
