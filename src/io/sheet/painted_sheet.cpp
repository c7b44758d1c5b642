#include "io/sheet/painted_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "atlas/texels/gutter.h"
#include "core/error.h"
#include "core/system/parallel.h"
#include "ink/spectra/srgb.h"
#include "io/image/icc_profile.h"

namespace tuft::io {
namespace {

constexpr float kFullCoverage = 0.05f;  // film units, half a micrometre: from here on a texel counts as painted
constexpr float kBare = 0.05f;          // of the thickest film round it: a texel with less counts as bare
constexpr float kLeastPlate = 1e-3f;    // film units: a pigment with less is no plate
constexpr int kSpread = 3;              // texels

struct Maps {
    ink::AtlasMap<float> coverage, amounts;
    ink::AtlasMap<std::uint8_t> colour;
    std::vector<ink::AtlasMap<std::uint8_t>> plates;  // coverage by each, of 255
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

/// Film on each texel, film units.
std::vector<float> film_of(const ink::AtlasMap<float>& amounts) {
    std::vector<float> film;
    const auto n = static_cast<std::size_t>(amounts.channels);
    film.reserve(amounts.texels.size() / n);
    for (std::size_t i = 0; i < amounts.texels.size(); i += n) {
        float sum = 0;
        for (std::size_t p = 0; p < n; ++p) sum += amounts.texels[i + p];
        film.push_back(sum);
    }
    return film;
}

/// Coverage by paint, and for each texel on the edge of paint the thickest one round it.
struct PaintCoverage {
    ink::AtlasMap<float> coverage;
    std::vector<std::pair<std::size_t, std::size_t>> edge;  // texel and the one that it is a part of
};

/// Paint covers a texel where there is any. Beside a bare texel the film is that of a part of the texel, so the part is
/// what it has of the thickest film round it.
PaintCoverage coverage_of_film(const std::vector<float>& film, std::uint32_t size) {
    const std::size_t n = size;
    PaintCoverage paint{{size, 1, std::vector<float>(film.size(), 0)}, {}};
    std::vector<std::vector<std::pair<std::size_t, std::size_t>>> edges(n);
    parallel_for(n, 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y)
            for (std::size_t x = 0; x < n; ++x) {
                const std::size_t i = y * n + x;
                if (!(film[i] > 0)) continue;
                float least = film[i];
                std::size_t thickest = i;
                for (std::size_t v = y > 0 ? y - 1 : 0; v <= y + 1 && v < n; ++v)
                    for (std::size_t u = x > 0 ? x - 1 : 0; u <= x + 1 && u < n; ++u) {
                        least = std::min(least, film[v * n + u]);
                        if (film[v * n + u] > film[thickest]) thickest = v * n + u;
                    }
                const bool edge = thickest != i && least < kBare * film[thickest];
                const float full = edge ? std::max(kFullCoverage, film[thickest]) : kFullCoverage;
                paint.coverage.texels[i] = std::min(film[i] / full, 1.0f);
                if (edge) edges[y].emplace_back(i, thickest);
            }
    });
    for (const auto& row : edges) paint.edge.insert(paint.edge.end(), row.begin(), row.end());
    return paint;
}

/// Gives texels on the edge of paint the colour of the paint that covers a part of them.
void sharpen_edges(ink::AtlasMap<std::uint8_t>& colour, const PaintCoverage& paint) {
    const std::vector<std::uint8_t> before = colour.texels;
    for (const auto& [texel, thickest] : paint.edge)
        std::copy_n(before.begin() + static_cast<std::ptrdiff_t>(3 * thickest), 3,
                    colour.texels.begin() + static_cast<std::ptrdiff_t>(3 * texel));
}

Maps make_maps(const stroke::Document& painting, const SheetRequest& request) {
    Maps maps;
    const ink::Stack stack = painting.appearance().stack();
    const atlas::TexelMap& texels = painting.model().texels;
    ink::ComposeOptions compose = painting.appearance().compose_options();
    compose.space = request.space;
    const bool painted = !painting.layers().pigments().empty() && !stack.layers.empty();
    if (!painted && (!request.mask || request.plates)) throw Error("nothing is painted: there is no film to cut");
    const bool outlines = request.sheet.outlines && !request.mask;
    if (!request.mask || request.plates) maps.amounts = ink::compose_amounts(stack, texels, compose);
    PaintCoverage paint;
    if (request.mask)
        paint.coverage = coverage_of_mask(request.mask, painting);
    else
        paint = coverage_of_film(film_of(maps.amounts), maps.amounts.size);
    if (!request.plates && !outlines) maps.amounts = {};
    if (request.sheet.prints || outlines) {
        maps.colour = ink::compose_srgb8(stack, texels, painting.appearance().substrate(), compose);
        sharpen_edges(maps.colour, paint);
        decal::spread_colours(maps.colour, paint.coverage, kSpread);
    }
    maps.coverage = std::move(paint.coverage);
    return maps;
}

/// Coverage by a pigment, of 255.
ink::AtlasMap<std::uint8_t> plate_coverage(const ink::AtlasMap<float>& amounts, std::size_t channel) {
    const auto n = static_cast<std::size_t>(amounts.channels);
    std::vector<float> film;
    film.reserve(amounts.texels.size() / n);
    for (std::size_t i = channel; i < amounts.texels.size(); i += n) film.push_back(amounts.texels[i]);
    const ink::AtlasMap<float> coverage = coverage_of_film(film, amounts.size).coverage;
    ink::AtlasMap<std::uint8_t> plate{amounts.size, 1, {}};
    plate.texels.reserve(coverage.texels.size());
    for (const float c : coverage.texels) plate.texels.push_back(static_cast<std::uint8_t>(std::lround(255 * c)));
    return plate;
}

/// "carbon black", or of a mix "indigo 70 + gamboge 30", in hundredths.
std::string name_of_mix(const std::vector<double>& mix, const std::vector<decal::Plate>& pigments) {
    constexpr double kNamed = 0.02;
    std::string name;
    const bool pure = std::ranges::count_if(mix, [](double part) { return part >= kNamed; }) == 1;
    for (std::size_t m = 0; m < mix.size(); ++m) {
        if (mix[m] < kNamed) continue;
        name += (name.empty() ? "" : " + ") + pigments[m].name;
        if (!pure) name += fmt::format(" {:.0f}", 100 * mix[m]);
    }
    return name;
}

/// A coded colour of a space as one of sRGB, cut to its gamut.
std::array<double, 3> srgb_of(const std::array<double, 3>& colour, ink::ColourSpace space) {
    if (space == ink::ColourSpace::srgb) return colour;
    ink::Rgb linear{};
    for (std::size_t c = 0; c < 3; ++c) {
        const auto stored = static_cast<float>(colour[c]);
        linear[c] = ink::data_of(space).linear ? stored : ink::srgb_decode(stored);
    }
    const ink::Rgb cut = ink::into_gamut(ink::transform(ink::to_linear_srgb(space), linear), ink::ColourSpace::srgb);
    return {ink::srgb_encode(cut[0]), ink::srgb_encode(cut[1]), ink::srgb_encode(cut[2])};
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
    const bool outlines = request.sheet.outlines && !request.mask;
    std::vector<decal::Plate> plates;
    if (request.plates || outlines) plates = find_plates(maps.amounts, painting);
    decal::PrintSource source{.corner_uvs = model.atlas.corner_uvs,
                              .coverage = {},
                              .colour = &maps.colour,
                              .amounts = plates.empty() ? nullptr : &maps.amounts,
                              .full = {},
                              .plates = {},
                              .texel = model.atlas.texel_size};
    source.coverage = [&](std::uint32_t triangle, const decal::Weights& weights) {
        float value = 0;
        decal::sample(maps.coverage, decal::uv_of(source.corner_uvs, triangle, weights), &value);
        return double{value};
    };
    for (const decal::Plate& plate : plates) source.full.push_back(static_cast<float>(plate.full));
    if (request.plates && outlines) {
        for (std::size_t p = 0; p < plates.size(); ++p) maps.plates.push_back(plate_coverage(maps.amounts, p));
        for (const auto& map : maps.plates)
            source.plates.push_back([&](std::uint32_t triangle, const decal::Weights& weights) {
                float value = 0;
                decal::sample(map, decal::uv_of(source.corner_uvs, triangle, weights), &value);
                return double{value} / 255;
            });
    }
    decal::SheetOptions options = request.sheet;
    options.outlines = outlines;
    decal::Sheet sheet = decal::make_sheet(*model.mesh, source, options);
    for (decal::SheetInk& ink : sheet.inks) {
        ink.name = name_of_mix(ink.mix, plates);
        ink.srgb = srgb_of(ink.colour, request.space);
    }
    if (request.plates) {
        if (outlines)
            for (const decal::Plate& plate : plates) sheet.inks.push_back({.name = plate.name, .colour = plate.colour});
        sheet.plates = std::move(plates);
    }
    sheet.profile = icc_profile(request.space);
    return sheet;
}

}  // namespace tuft::io
