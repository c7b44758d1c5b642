#include "ink/composite/composite.h"

#include <algorithm>
#include <cmath>

#include "core/simd.h"
#include "ink/canvas/tile_store.h"
#include "ink/elementary.h"
#include "ink/spectra/kubelka_munk.h"

namespace tuft::ink {
namespace {

constexpr int kN = atlas::kTileTexels;
using Texels = std::array<float, kN>;

constexpr float kWetRoughness = 0.05f;  ///< glTF roughness of a film of water

/// `layer` and `over` of kubelka_munk.h for K X and S X per texel, put over R in `r`.
TUFT_CLONES void film_over(float* __restrict r, const float* __restrict k, const float* __restrict s) {
    for (int t = 0; t < kN; ++t) {
        const float y2 = k[t] * (k[t] + 2 * s[t]);
        const float y = std::sqrt(y2);
        const float e = exp_minus(y);
        const float e2 = e * e;
        const float series = 1 - y2 * (0.333333333f - y2 * (0.133333333f - y2 * 0.0539682540f));
        const float ratio = (1 - e2) / ((1 + e2) * (y + 1e-30f));
        const float u = y2 < 0.01f ? series : ratio;
        const float inverse = 1 / (1 + (k[t] + s[t]) * u);
        const float r0 = s[t] * u * inverse;
        const float transmitted = 2 * e / (1 + e2) * inverse;
        const float open = 1 - r0 * r[t];
        r[t] = r0 + transmitted * transmitted * r[t] / (open > 1e-7f ? open : 1e-7f);
    }
}

/// to += (from − to) · part, part in [0, 1].
TUFT_CLONES void blend(float* __restrict to, const float* __restrict from, const float* __restrict part) {
    for (int t = 0; t < kN; ++t) to[t] += (from[t] - to[t]) * part[t];
}

TUFT_CLONES void multiply(float* __restrict to, const float* __restrict by) {
    for (int t = 0; t < kN; ++t) to[t] *= by[t];
}

/// The dry film covers what is below it, microfacets included, within a fraction of a unit.
TUFT_CLONES void blend_roughness(float* __restrict roughness, const float* __restrict weighted,
                                 const float* __restrict film, const float* __restrict part) {
    for (int t = 0; t < kN; ++t) {
        const float covered = (1 - exp_minus(4 * film[t])) * part[t];
        const float mean = weighted[t] / (film[t] > 1e-12f ? film[t] : 1e-12f);
        roughness[t] += (mean - roughness[t]) * covered;
    }
}

/// Part of the surface that a film of water covers.
TUFT_CLONES void wet_part(float* __restrict wet, const float* __restrict water, float per_film) {
    for (int t = 0; t < kN; ++t) wet[t] = 1 - exp_minus((water[t] > 0 ? water[t] : 0) * per_film);
}

/// `saunderson` without k1, k2 = 0.6 times the part of the surface with an interface.
TUFT_CLONES void under_interface(float* __restrict r, const float* __restrict wet, float dry, float k2) {
    for (int t = 0; t < kN; ++t) {
        const float k = k2 * (dry + (1 - dry) * wet[t]);
        r[t] = (1 - k) * r[t] / (1 - k * r[t]);
    }
}

/// Roughness under the substrate's glaze and under water.
TUFT_CLONES void gloss(float* __restrict roughness, const float* __restrict wet, float glaze, float substrate) {
    for (int t = 0; t < kN; ++t) {
        const float dry = roughness[t] + (substrate - roughness[t]) * glaze;
        roughness[t] = dry + (kWetRoughness - dry) * wet[t];
    }
}

struct Luminance {
    float red = 0.212639f, green = 0.715169f, blue = 0.072192f;  // of sRGB
};

/// Into the gamut along the line to the grey of the same luminance.
TUFT_CLONES void into_gamut(float* __restrict red, float* __restrict green, float* __restrict blue, Luminance part_of) {
    for (int t = 0; t < kN; ++t) {
        const float y = part_of.red * red[t] + part_of.green * green[t] + part_of.blue * blue[t];
        const float grey = y > 0 ? (y < 1 ? y : 1) : 0;
        float low = red[t] < green[t] ? red[t] : green[t];
        low = low < blue[t] ? low : blue[t];
        float high = red[t] > green[t] ? red[t] : green[t];
        high = high > blue[t] ? high : blue[t];
        const float for_low = low < 0 ? grey / (grey - low) : 1;
        const float for_high = high > 1 ? (1 - grey) / (high - grey) : 1;
        const float part = for_low < for_high ? for_low : for_high;
        red[t] = grey + (red[t] - grey) * part;
        green[t] = grey + (green[t] - grey) * part;
        blue[t] = grey + (blue[t] - grey) * part;
    }
}

bool empty(const TileFilm& film) {
    return film.opacity <= 0 ||
           std::all_of(film.pigments.begin(), film.pigments.end(), [](const Plane* w) { return !w; });
}

/// Reflectances below the boundary; `bands` is 0 where only the surface is asked for.
struct Reflectances {
    explicit Reflectances(bool with_colour) : bands(with_colour ? kBands : 0) {}
    Texels& operator[](int b) { return r[b]; }

    int bands;
    alignas(64) std::array<Texels, kBands> r;
};

/// Lays one film over the reflectances `r` of what is below it; with `absorbs_only` its S is 0.
void add_film(Reflectances& r, TileAppearance& appearance, const TileFilm& film, std::span<const Pigment> pigments,
              bool absorbs_only = false) {
    alignas(64) Texels k, s, part, thickness{}, rough{}, height{};
    part.fill(film.opacity);
    if (film.mask)
        for (int t = 0; t < kN; ++t) part[t] *= (*film.mask)[t];
    const bool whole = !film.mask && film.opacity >= 1;
    for (int b = 0; b < r.bands; ++b) {
        k.fill(0);
        s.fill(0);
        for (std::size_t p = 0; p < pigments.size(); ++p) {
            if (!film.pigments[p]) continue;
            add_scaled_plane(k.data(), film.pigments[p]->data(), pigments[p].k[b]);
            if (!absorbs_only) add_scaled_plane(s.data(), film.pigments[p]->data(), pigments[p].s[b]);
        }
        if (whole) {
            film_over(r[b].data(), k.data(), s.data());
        } else {
            alignas(64) Texels covered = r[b];
            film_over(covered.data(), k.data(), s.data());
            blend(r[b].data(), covered.data(), part.data());
        }
    }
    if (film.inside) return;
    for (std::size_t p = 0; p < pigments.size(); ++p) {
        if (!film.pigments[p]) continue;
        const float* w = film.pigments[p]->data();
        add_scaled_plane(height.data(), w, pigments[p].height * 1e6f);
        add_scaled_plane(rough.data(), w, pigments[p].roughness);
        add_scaled_plane(thickness.data(), w, 1.0f);
    }
    for (int t = 0; t < kN; ++t) appearance.height[t] += height[t] * part[t];
    blend_roughness(appearance.roughness.data(), rough.data(), thickness.data(), part.data());
}

/// What one user layer has on a tile.
struct TileLayer {
    std::array<TileFilm, kFilms> films;
    std::size_t n_films = 0;
    const Plane* water = nullptr;
    float opacity = 1;
    Blend blend = Blend::normal;
    std::span<const Pigment> pigments;
};

TileLayer layer_of(const Canvas& canvas, std::uint32_t slot, float opacity, Blend blend = Blend::normal) {
    TileLayer layer{.films = {}, .opacity = opacity, .blend = blend, .pigments = canvas.pigments()};
    for (int film = 0; film < kFilms; ++film) {
        if (!canvas.has_film(slot, film)) continue;
        TileFilm& to = layer.films[layer.n_films++];
        for (int p = 0; p < static_cast<int>(canvas.pigments().size()); ++p)
            to.pigments[p] = canvas.film_plane(slot, film, p);
        to.inside = film == kSoakedFilm;
    }
    layer.water = canvas.liquid(slot, Liquid::film);
    return layer;
}

/// Reflectances and appearance of the bare substrate, below the boundary.
void begin_appearance(Reflectances& r, TileAppearance& appearance, const Substrate& substrate) {
    constexpr Interface kInterface{};
    appearance.height.fill(0);
    appearance.roughness.fill(substrate.roughness);
    const Bands bare = bands_of_rgb(substrate.reflectance);
    for (int b = 0; b < r.bands; ++b)
        r[b].fill(static_cast<float>(saunderson_inverse(
            static_cast<double>(bare[b]),
            {.k1 = 0, .k2 = static_cast<double>(static_cast<float>(kInterface.k2) * substrate.interface)}, false)));
}

TUFT_CLONES void cut_to_unit(float* __restrict r) {
    for (int t = 0; t < kN; ++t) r[t] = r[t] > 0 ? (r[t] < 1 ? r[t] : 1) : 0;
}

/// `saunderson_inverse` without k1.
TUFT_CLONES void below_interface(float* __restrict r, float k2) {
    for (int t = 0; t < kN; ++t) r[t] = r[t] / ((1 - k2) + k2 * r[t]);
}

/// The part of `bare` that is left in `colour`, in [0, 1].
TUFT_CLONES void part_left(float* __restrict part, const float* __restrict colour, const float* __restrict bare) {
    for (int t = 0; t < kN; ++t) {
        const float left = colour[t] / (bare[t] > 1e-6f ? bare[t] : 1e-6f);
        part[t] = left > 0 ? (left < 1 ? left : 1) : 0;
    }
}

/// colour += lack · (part of all light, or where there is too much, of this colour's: none is left below 0).
TUFT_CLONES void add_lack(float* __restrict colour, const float* __restrict lack, const float* __restrict own,
                          const float* __restrict all) {
    for (int t = 0; t < kN; ++t) colour[t] += lack[t] * (lack[t] < 0 ? own[t] : all[t]);
}

/// A tile of the base colour: linear sRGB, and what the bands make of it.
struct TileBaseColour {
    alignas(64) std::array<Texels, 3> bare, lack;
};

std::array<Texels, 3> linear_colour(const BaseColour::Tile& tile) {
    const std::array<float, 256>& decoded = linear_of_code();
    std::array<Texels, 3> colour;
    for (int c = 0; c < 3; ++c)
        for (int t = 0; t < kN; ++t) colour[c][t] = decoded[tile.rgb[c][t]];
    return colour;
}

/// Adds what the bands lack of the base colour as far as it is seen.
void add_lost_colour(TileAppearance& appearance, const TileBaseColour& base_colour) {
    alignas(64) Texels colour{}, bare{}, all, own;
    for (int c = 0; c < 3; ++c) {
        add_scaled_plane(colour.data(), appearance.colour[c].data(), 1);
        add_scaled_plane(bare.data(), base_colour.bare[c].data(), 1);
    }
    part_left(all.data(), colour.data(), bare.data());
    for (int c = 0; c < 3; ++c) {
        part_left(own.data(), appearance.colour[c].data(), base_colour.bare[c].data());
        add_lack(appearance.colour[c].data(), base_colour.lack[c].data(), own.data(), all.data());
    }
}

/// Computes the reflectances of the base colour, below the boundary.
void reflect_base(Reflectances& r, TileBaseColour& base_colour, const BaseColour::Tile& tile,
                  const Substrate& substrate) {
    constexpr Interface kInterface{};
    alignas(64) const std::array<Texels, 3> colour = linear_colour(tile);
    for (Texels& bare : base_colour.bare) bare.fill(0);
    for (int b = 0; b < r.bands; ++b) {
        r[b].fill(0);
        for (int c = 0; c < 3; ++c) add_scaled_plane(r[b].data(), colour[c].data(), primary_bands()[c][b]);
        cut_to_unit(r[b].data());
        for (int c = 0; c < 3; ++c) add_scaled_plane(base_colour.bare[c].data(), r[b].data(), band_weights()[c][b]);
        below_interface(r[b].data(), static_cast<float>(kInterface.k2) * substrate.interface);
    }
    into_gamut(base_colour.bare[0].data(), base_colour.bare[1].data(), base_colour.bare[2].data(), {});
    for (int c = 0; c < 3; ++c)
        for (int t = 0; t < kN; ++t) base_colour.lack[c][t] = colour[c][t] - base_colour.bare[c][t];
}

/// Colour and gloss under the boundary of glaze and water. The colour is linear sRGB, cut to its gamut where that is
/// the space wanted.
void finish_appearance(Reflectances& r, TileAppearance& appearance, const Plane* water, const Substrate& substrate,
                       ColourSpace space = ColourSpace::srgb) {
    constexpr Interface kInterface{};
    const auto k2 = static_cast<float>(kInterface.k2);
    alignas(64) Texels wet{};
    if (water) {
        const float grain = std::max(2 * substrate.relief, 1e-7f);
        wet_part(wet.data(), water->data(), static_cast<float>(kFilmUnit) / grain);
    }
    gloss(appearance.roughness.data(), wet.data(), substrate.interface, substrate.roughness);
    if (r.bands == 0) return;
    for (int c = 0; c < 3; ++c) appearance.colour[c].fill(0);
    for (int b = 0; b < r.bands; ++b) {
        if (water || substrate.interface > 0) under_interface(r[b].data(), wet.data(), substrate.interface, k2);
        for (int c = 0; c < 3; ++c) add_scaled_plane(appearance.colour[c].data(), r[b].data(), band_weights()[c][b]);
    }
    if (space == ColourSpace::srgb)
        into_gamut(appearance.colour[0].data(), appearance.colour[1].data(), appearance.colour[2].data(), {});
}

/// From linear sRGB, which may lie outside its gamut, to another space.
void convert(TileAppearance& appearance, ColourSpace space) {
    const Matrix3& matrix = from_linear_srgb(space);
    alignas(64) std::array<Texels, 3> out{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            add_scaled_plane(out[i].data(), appearance.colour[c].data(), static_cast<float>(matrix[i][c]));
    const Matrix3 xyz = xyz_of_linear(space);
    into_gamut(out[0].data(), out[1].data(), out[2].data(),
               {static_cast<float>(xyz[1][0]), static_cast<float>(xyz[1][1]), static_cast<float>(xyz[1][2])});
    for (std::size_t c = 0; c < 3; ++c) std::copy(out[c].begin(), out[c].end(), appearance.colour[c].begin());
}

void add_layer(Reflectances& r, TileAppearance& appearance, const TileLayer& layer) {
    const std::span<const TileFilm> films(layer.films.data(), layer.n_films);
    const auto add_films = [&](Reflectances& to) {
        for (const TileFilm& film : films)
            if (!empty(film)) add_film(to, appearance, film, layer.pigments, layer.blend == Blend::glaze);
    };
    const auto add_all = [&](Reflectances& to) {
        if (layer.blend != Blend::multiply) return add_films(to);
        Reflectances filter(to.bands > 0);
        for (int b = 0; b < to.bands; ++b) filter[b].fill(1);
        add_films(filter);
        for (int b = 0; b < to.bands; ++b) multiply(to[b].data(), filter[b].data());
    };
    if (layer.opacity >= 1) {
        add_all(r);
        return;
    }
    Reflectances with = r;
    alignas(64) Texels part, height = appearance.height, roughness = appearance.roughness;
    part.fill(layer.opacity);
    add_all(with);
    for (int b = 0; b < r.bands; ++b) blend(r[b].data(), with[b].data(), part.data());
    blend(height.data(), appearance.height.data(), part.data());
    blend(roughness.data(), appearance.roughness.data(), part.data());
    appearance.height = height;
    appearance.roughness = roughness;
}

}  // namespace

TileAppearance shade_films(std::span<const TileFilm> films, const Plane* water, std::span<const Pigment> pigments,
                           const Substrate& substrate, bool with_colour) {
    TileAppearance appearance;
    Reflectances r(with_colour);
    begin_appearance(r, appearance, substrate);
    for (const TileFilm& film : films)
        if (!empty(film)) add_film(r, appearance, film, pigments);
    finish_appearance(r, appearance, water, substrate);
    return appearance;
}

TileAppearance shade_tile(const Canvas& canvas, std::uint32_t slot, const Substrate& substrate, bool with_colour) {
    const TileLayer layer = layer_of(canvas, slot, 1);
    return shade_films(std::span(layer.films.data(), layer.n_films), layer.water, layer.pigments, substrate,
                       with_colour);
}

namespace {

/// How a tile is shaded.
struct Shade {
    bool with_colour = true;
    ColourSpace space = ColourSpace::srgb;
    bool base_colour = true;  ///< that of the stack, where it has one
};

/// The whole tile on one substrate.
TileAppearance shade_on(const Stack& stack, std::uint32_t slot, const Substrate& substrate, const Shade& how) {
    const auto [with_colour, space, over_base] = how;
    TileAppearance appearance;
    const BaseColour::Tile* tile =
        with_colour && over_base && stack.has_base_colour() ? &stack.base_colour->tiles[slot] : nullptr;
    Reflectances r(with_colour && (!tile || stack.touched(slot)));
    begin_appearance(r, appearance, substrate);
    TileBaseColour base_colour;
    if (tile && r.bands == 0) {  // bare
        appearance.colour = linear_colour(*tile);
        finish_appearance(r, appearance, nullptr, substrate, space);
        if (space != ColourSpace::srgb) convert(appearance, space);
        return appearance;
    }
    if (tile) reflect_base(r, base_colour, *tile, substrate);
    Plane sum;
    const Plane* water = nullptr;
    for (const LayerView& view : stack.layers) {
        if (!(view.opacity > 0) || !view.canvas->touched(slot)) continue;
        const TileLayer layer = layer_of(*view.canvas, slot, view.opacity, view.blend);
        add_layer(r, appearance, layer);
        if (!layer.water) continue;
        if (!water) sum.fill(0);
        water = &sum;
        add_scaled_plane(sum.data(), layer.water->data(), view.opacity);
    }
    finish_appearance(r, appearance, water, substrate, space);
    if (tile) add_lost_colour(appearance, base_colour);
    if (with_colour && space != ColourSpace::srgb) convert(appearance, space);
    return appearance;
}

void copy_texel(TileAppearance& to, const TileAppearance& from, std::size_t t) {
    for (std::size_t c = 0; c < 3; ++c) to.colour[c][t] = from.colour[c][t];
    to.height[t] = from.height[t];
    to.roughness[t] = from.roughness[t];
}

/// A tile whose texels have several substrates.
TileAppearance shade_mixed(const Stack& stack, std::uint32_t slot, const Substrate& document,
                           const SubstrateMap::Indices& indices, Shade how) {
    TileAppearance mixed;
    std::array<bool, 256> done{};
    for (const std::uint8_t index : indices) {
        if (done[index]) continue;
        done[index] = true;
        how.base_colour = index == 0;
        const TileAppearance one = shade_on(stack, slot, stack.substrates->at(index, document), how);
        for (std::size_t t = 0; t < indices.size(); ++t)
            if (indices[t] == index) copy_texel(mixed, one, t);
    }
    return mixed;
}

}  // namespace

TileAppearance shade_tile(const Stack& stack, std::uint32_t slot, const Substrate& substrate, bool with_colour,
                          ColourSpace space) {
    const Shade how{.with_colour = with_colour, .space = space, .base_colour = true};
    if (!stack.differs(slot)) return shade_on(stack, slot, substrate, how);
    if (const auto mixed = stack.substrates->of_texel.find(slot); mixed != stack.substrates->of_texel.end())
        return shade_mixed(stack, slot, substrate, mixed->second, how);
    return shade_on(stack, slot, stack.substrates->of(slot, substrate),
                    {.with_colour = with_colour, .space = space, .base_colour = false});
}

namespace {
constexpr const char* kBlends[] = {"normal", "glaze", "multiply"};
}

const char* name_of(Blend blend) {
    return kBlends[static_cast<int>(blend)];
}

std::optional<Blend> blend_of(std::string_view name) {
    const auto at = std::find(std::begin(kBlends), std::end(kBlends), name);
    if (at == std::end(kBlends)) return std::nullopt;
    return static_cast<Blend>(at - std::begin(kBlends));
}

bool Stack::touched(std::uint32_t slot) const {
    return std::any_of(layers.begin(), layers.end(), [slot](const LayerView& v) { return v.canvas->touched(slot); });
}

std::vector<std::uint32_t> Stack::touched_slots() const {
    if (layers.size() == 1) return layers[0].canvas->touched_slots();
    std::vector<std::uint32_t> slots;
    for (const LayerView& v : layers) {
        const std::vector<std::uint32_t> more = v.canvas->touched_slots();
        slots.insert(slots.end(), more.begin(), more.end());
    }
    std::sort(slots.begin(), slots.end());
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
    return slots;
}

Rgb colour_of_film(const Ink& ink, const Rgb& background, double film) {
    const Bands under = bands_of_rgb(background);
    Bands seen;
    for (int b = 0; b < kBands; ++b) {
        double k = 0, s = 0;
        for (const InkPart& part : ink.parts) {
            k += part.fraction * static_cast<double>(part.pigment.k[b]);
            s += part.fraction * static_cast<double>(part.pigment.s[b]);
        }
        seen[b] = static_cast<float>(over(layer(k, s, film > 0 ? film : ink.film), static_cast<double>(under[b])));
    }
    return into_gamut(rgb_of_bands(seen));
}

}  // namespace tuft::ink
