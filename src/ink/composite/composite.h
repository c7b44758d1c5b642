#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "atlas/texels/gutter.h"
#include "core/system/progress.h"
#include "ink/canvas/canvas.h"
#include "ink/colour/base_colour.h"
#include "ink/colour/substrate_map.h"
#include "ink/composite/blend.h"
#include "ink/spectra/colour_space.h"
#include "ink/spectra/srgb.h"

/// \file
/// Appearance from pigment amounts: colour, height and roughness of tiles, and maps of the whole atlas. Called by
/// `stroke` for export, by `app` for every changed tile.
namespace tuft::ink {

/// Colour and surface of one tile, planar, texel t = row * 16 + column.
struct alignas(64) TileAppearance {
    std::array<std::array<float, atlas::kTileTexels>, 3> colour;  ///< linear sRGB, in [0, 1]
    std::array<float, atlas::kTileTexels> height;                 ///< micrometres above the substrate
    std::array<float, atlas::kTileTexels> roughness;              ///< glTF perceptual roughness
};

/// One film on a tile: one dried film, or one user layer.
struct TileFilm {
    std::array<const Plane*, kMaxPigments> pigments{};  ///< amounts, film units; null: none
    const Plane* mask = nullptr;                        ///< 0–1 per texel; null: 1 everywhere
    float opacity = 1;                                  ///< of the whole film, 0–1
    bool inside = false;                                ///< soaked into the substrate: the surface is unchanged
};

/// Computes colour, height and roughness of a stack of films, the lowest first. In each band, beginning with the
/// substrate,
///
///     R ← R + o (R0 + T² R / (1 − R0 R) − R)      for each film, o = opacity · mask,
///
/// with R0 and T of the mixed film, K = Σ w_p K_p and S = Σ w_p S_p (`layer`, `over` of kubelka_munk.h). Where the
/// top is glossy, the air boundary reflects light back into the films (Saunderson):
///
///     R' = (1 − k) R / (1 − k R),   k = 0.6 g,   g = i + (1 − i)(1 − exp(−w h / 2ζ)),
///
/// with i the substrate's `interface`, w its `water` on top in film units h, ζ the relief. The reflection at the
/// outside of the boundary (k1) is left to the renderer: glTF reflects those 4 % itself. The substrate's
/// reflectance lies below the boundary and is chosen so that the bare dry surface has its given colour.
///
/// `water` may be null: dry. Without `with_colour` only height and roughness are computed. Roughness goes from the
/// substrate's to the films', back to the substrate's under its glaze, and to that of a wet surface. Agrees with
/// the scalar formulas to 2e-6; same bits on every instruction set. Cost: about 0.3 µs per film and band.
TileAppearance shade_films(std::span<const TileFilm> films, const Plane* water, std::span<const Pigment> pigments,
                           const Substrate& substrate, bool with_colour = true);

/// Returns the appearance of a slot of the canvas: its films from the soaked one to the open one, and the liquid on
/// top.
TileAppearance shade_tile(const Canvas& canvas, std::uint32_t slot, const Substrate& substrate,
                          bool with_colour = true);

/// Returns the colour of one film of an ink, `film` units thick (0: the film of a full brush), over a matte background:
/// for palettes and charts.
Rgb colour_of_film(const Ink& ink, const Rgb& background, double film = 0);

/// One visible user layer.
struct LayerView {
    const Canvas* canvas = nullptr;  ///< of the same texel map as all others
    float opacity = 1;               ///< 0–1
    Blend blend = Blend::normal;
};

/// The visible user layers, the lowest first.
struct Stack {
    std::vector<LayerView> layers;
    /// Base colours below the layers in place of the substrate's reflectance; null or empty: the substrate.
    const BaseColour* base_colour = nullptr;
    /// Substrates of the model's parts in place of the call's; null: the call's everywhere. A part with a
    /// substrate of its own has no base colour.
    const SubstrateMap* substrates = nullptr;

    Stack(const Canvas& canvas) : layers{{&canvas}} {}
    explicit Stack(std::vector<LayerView> views) : layers(std::move(views)) {}

    bool has_base_colour() const { return base_colour && !base_colour->empty(); }
    /// Whether a texel of the tile has another substrate than the call's.
    bool differs(std::uint32_t slot) const { return substrates && substrates->differs(slot); }
    /// Whether some canvas holds ink or liquid on a tile.
    bool touched(std::uint32_t slot) const;
    std::vector<std::uint32_t> touched_slots() const;  ///< of any layer, ascending
};

/// Returns the appearance of a slot with its layers, each of opacity o: in each band
///
///     R ← R + o (R_with − R),
///
/// with R_with as above, all films of the layer over R, or as its `Blend` defines; height and roughness likewise.
/// Opacity mixes colours and does not scale amounts: a film hides exponentially, so half the amount of a black ink
/// is still black, while half the opacity shall look half covered. Opacity 1 gives the same bits as all films in
/// one canvas. The water on top is the sum over the layers, weighted by o.
///
/// Over a base colour the substrate's reflectance is, per texel, the smooth spectrum of that colour. What its bands
/// lack of a saturated colour (`bands_of_rgb`) is added in proportion to the visibility of the base, so bare texels
/// have the base colour exactly.
///
/// `colour` is linear RGB of `space`, cut to that gamut alone.
TileAppearance shade_tile(const Stack& stack, std::uint32_t slot, const Substrate& substrate, bool with_colour = true,
                          ColourSpace space = ColourSpace::srgb);

/// A map over the whole atlas, rows from v = 0 upwards, channels interleaved.
template <class T>
struct AtlasMap {
    std::uint32_t size = 0;  ///< texels per side
    int channels = 0;
    std::vector<T> texels;  ///< [size * size * channels]
};

/// Gutter taps, and for each slot the gutter texels that depend on it.
struct GutterPlan {
    atlas::Gutter gutter;
    std::vector<std::uint32_t> first_of_slot;  ///< [n_slots + 1] into `entries`
    std::vector<std::uint32_t> entries;        ///< indices into `gutter.texels`, ascending per slot
};

/// Built once for a model; `atlas.gutter` texels wide. About 0.3 s.
GutterPlan plan_gutter(const mesh::TriangleMesh& mesh, const atlas::Atlas& atlas, const atlas::TexelMap& map);

/// Options of the maps.
struct ComposeOptions {
    std::uint32_t gutter = 4;  ///< texels round the charts that are filled with the nearest texel's value
    /// If given, the gutter continues over the seams, so that bilinear lookups on both sides of a seam agree. Must
    /// outlive the call.
    const GutterPlan* seams = nullptr;
    ProgressFn progress = {};
    ColourSpace space = ColourSpace::srgb;  ///< of colours; `compose_srgb8` has its primaries and the curve of sRGB
};

/// Base colour, sRGB-encoded 8 bit (3 channels). Texels far from any chart have the
/// substrate's colour. Over a base colour all texels of charts are drawn, not those with ink only.
AtlasMap<std::uint8_t> compose_srgb8(const Stack& stack, const atlas::TexelMap& map, const Substrate& substrate,
                                     const ComposeOptions& options = {});
/// Base colour, linear RGB of `options.space`.
AtlasMap<float> compose_linear(const Stack& stack, const atlas::TexelMap& map, const Substrate& substrate,
                               const ComposeOptions& options = {});
/// Film units of each pigment in all films of a texel, layers weighted by opacity. One channel per pigment, in the
/// order of the canvas with the most pigments. Memory: 4 bytes per texel and pigment, and once more for one
/// pigment.
AtlasMap<float> compose_amounts(const Stack& stack, const atlas::TexelMap& map, const ComposeOptions& options = {});
/// glTF perceptual roughness (1 channel).
AtlasMap<float> compose_roughness(const Stack& stack, const atlas::TexelMap& map, const Substrate& substrate,
                                  const ComposeOptions& options = {});
/// Height of the film, micrometres (1 channel).
AtlasMap<float> compose_height(const Stack& stack, const atlas::TexelMap& map, const ComposeOptions& options = {});
/// glTF occlusion (255), roughness, metallic in R, G, B, 8 bit linear.
AtlasMap<std::uint8_t> compose_orm8(const Stack& stack, const atlas::TexelMap& map, const Substrate& substrate,
                                    const ComposeOptions& options = {});

/// Part of the light that passes each texel (1 channel, 8 bit linear): the substrate's transmission, hidden by ink. Has
/// no texels where no substrate lets light pass.
AtlasMap<std::uint8_t> compose_transmission8(const Stack& stack, const atlas::TexelMap& map, const Substrate& substrate,
                                             const ComposeOptions& options = {});
/// Whether any substrate of the stack lets light pass.
bool has_transmission(const Stack& stack, const Substrate& substrate);

/// Updates the tiles of `slots`, and the gutter texels that depend on them, in a map made by `compose_srgb8` with
/// the same arguments.
void refresh_srgb8(AtlasMap<std::uint8_t>& image, std::span<const std::uint32_t> slots, const Stack& stack,
                   const atlas::TexelMap& map, const Substrate& substrate, const ComposeOptions& options = {});
/// The same in a map made by `compose_linear`.
void refresh_linear(AtlasMap<float>& image, std::span<const std::uint32_t> slots, const Stack& stack,
                    const atlas::TexelMap& map, const Substrate& substrate, const ComposeOptions& options = {});
/// Returns the tiles of the atlas (row · tiles per side + column) in which a refresh of `slots` changes texels, gutters
/// included, ascending.
std::vector<std::uint32_t> refreshed_tiles(std::span<const std::uint32_t> slots, const atlas::TexelMap& map,
                                           const ComposeOptions& options = {});

}  // namespace tuft::ink
