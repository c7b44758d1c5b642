#include "io/sheet/painted_sheet.h"

#include <algorithm>

#include "atlas/texels/gutter.h"
#include "core/error.h"
#include "ink/spectra/srgb.h"
#include "io/image/icc_profile.h"

namespace tuft::io {
namespace {

constexpr float kFullCoverage = 0.05f;  // film units, half a micrometre: from here on a texel counts as painted
constexpr float kLeastPlate = 1e-3f;    // film units: a pigment with less is no plate
constexpr int kSpread = 3;              // texels

struct Maps {
    ink::AtlasMap<float> coverage, amounts;
    ink::AtlasMap<std::uint8_t> colour;
};

ink::AtlasMap<float> coverage_of_mask(std::uint32_t mask, const stroke::Document& painting) {
    const stroke::MaskTexels& texels = painting.masks().texels(mask);
    const atlas::TexelMap& map = painting.model().texels;
    ink::AtlasMap<float> coverage{map.size, 1, std::vector<float>(std::size_t{map.size} * map.size, 0)};
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot) {
        for (std::uint32_t t = 0; t < atlas::kTileTexels; ++t) {
            const atlas::TexelPlace at = atlas::texel_place(map, slot, t);
            if (at.x < map.size && at.y < map.size && map.tiles[slot].cluster[t] != atlas::kNoCluster)
                coverage.texels[static_cast<std::size_t>(at.y * map.size + at.x)] =
                    texels.coverage(slot, static_cast<int>(t)) / 255.0f;
        }
    }
    atlas::fill_gutter(painting.appearance().compose_options().seams->gutter, map, 1, coverage.texels);
    return coverage;
}

ink::AtlasMap<float> coverage_of_paint(const ink::AtlasMap<float>& amounts) {
    ink::AtlasMap<float> coverage{amounts.size, 1, {}};
    const auto n = static_cast<std::size_t>(amounts.channels);
    coverage.texels.reserve(std::size_t{amounts.size} * amounts.size);
    for (std::size_t i = 0; i < amounts.texels.size(); i += n) {
        float sum = 0;
        for (std::size_t p = 0; p < n; ++p) sum += amounts.texels[i + p];
        coverage.texels.push_back(std::clamp(sum / kFullCoverage, 0.0f, 1.0f));
    }
    return coverage;
}

Maps make_maps(const stroke::Document& painting, const SheetRequest& request) {
    Maps maps;
    const ink::Stack stack = painting.appearance().stack();
    const atlas::TexelMap& texels = painting.model().texels;
    ink::ComposeOptions compose = painting.appearance().compose_options();
    compose.space = request.space;
    const bool painted = !painting.layers().pigments().empty() && !stack.layers.empty();
    if (!painted && (!request.mask || request.plates)) throw Error("nothing is painted: there is no film to cut");
    if (!request.mask || request.plates) maps.amounts = ink::compose_amounts(stack, texels, compose);
    maps.coverage = request.mask ? coverage_of_mask(request.mask, painting) : coverage_of_paint(maps.amounts);
    if (!request.plates) maps.amounts = {};
    if (!request.sheet.prints) return maps;
    maps.colour = ink::compose_srgb8(stack, texels, painting.appearance().substrate(), compose);
    decal::spread_colours(maps.colour, maps.coverage, kSpread);
    return maps;
}

/// Keeps the pigments of which there is something; a tint of 100 % is the most of each anywhere.
std::vector<decal::Plate> find_plates(ink::AtlasMap<float>& amounts, const stroke::Document& painting) {
    const std::vector<ink::Pigment>& pigments = painting.layers().pigments();
    const auto n = static_cast<std::size_t>(amounts.channels);
    std::vector<float> most(n, 0);
    for (std::size_t i = 0; i < amounts.texels.size(); ++i) most[i % n] = std::max(most[i % n], amounts.texels[i]);
    std::vector<std::size_t> used;
    std::vector<decal::Plate> plates;
    const auto& white = painting.appearance().substrate().reflectance;
    for (std::size_t p = 0; p < n; ++p) {
        if (most[p] < kLeastPlate) continue;
        used.push_back(p);
        ink::Ink alone;
        alone.name = pigments[p].name;
        alone.parts = {{pigments[p], 1.0f}};
        const ink::Rgb rgb = ink::colour_of_film(alone, {white[0], white[1], white[2]}, most[p]);
        plates.push_back({.name = pigments[p].name,
                          .colour = {ink::srgb_encode(rgb[0]), ink::srgb_encode(rgb[1]), ink::srgb_encode(rgb[2])},
                          .full = most[p]});
    }
    ink::AtlasMap<float> kept{amounts.size, static_cast<int>(used.size()), {}};
    kept.texels.reserve(amounts.texels.size() / n * used.size());
    for (std::size_t i = 0; i < amounts.texels.size(); i += n)
        for (const std::size_t p : used) kept.texels.push_back(amounts.texels[i + p]);
    amounts = std::move(kept);
    return plates;
}

}  // namespace

decal::Sheet make_painted_sheet(const stroke::Document& painting, const SheetRequest& request) {
    const stroke::Model& model = painting.model();
    Maps maps = make_maps(painting, request);
    std::vector<decal::Plate> plates;
    if (request.plates) plates = find_plates(maps.amounts, painting);
    decal::PrintSource source{.corner_uvs = model.atlas.corner_uvs,
                              .coverage = {},
                              .colour = &maps.colour,
                              .amounts = request.plates ? &maps.amounts : nullptr,
                              .full = {},
                              .texel = model.atlas.texel_size};
    source.coverage = [&](std::uint32_t triangle, const decal::Weights& weights) {
        float value = 0;
        decal::sample(maps.coverage, decal::uv_of(source.corner_uvs, triangle, weights), &value);
        return double{value};
    };
    for (const decal::Plate& plate : plates) source.full.push_back(static_cast<float>(plate.full));
    decal::Sheet sheet = decal::make_sheet(*model.mesh, source, request.sheet);
    sheet.plates = std::move(plates);
    sheet.profile = icc_profile(request.space);
    return sheet;
}

}  // namespace tuft::io
