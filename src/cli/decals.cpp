#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "atlas/texels/gutter.h"
#include "cli/commands.h"
#include "cli/placing_guide.h"
#include "cli/steps.h"
#include "core/error.h"
#include "core/text/counted.h"
#include "core/text/units.h"
#include "ink/spectra/srgb.h"
#include "io/image/icc_profile.h"
#include "io/sheet/sheet_files.h"

/// `tuft decals`: sheets of film from a project.
namespace tuft::cli {
namespace {

constexpr float kFullCoverage = 0.05f;  // film units, half a micrometre: from here on a texel counts as painted
constexpr float kLeastPlate = 1e-3f;    // film units: a pigment with less is no plate

std::string format_of(const Decals& a) {
    std::string extension = a.output.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

constexpr int kSpread = 3;  // texels

struct Maps {
    ink::AtlasMap<float> coverage, amounts;
    ink::AtlasMap<std::uint8_t> colour;
};

ink::AtlasMap<float> coverage_of_mask(const Decals& a, const stroke::Document& painting) {
    const stroke::MaskTable& table = painting.masks().table();
    const stroke::Mask* mask = table.find(a.mask);
    if (!mask) {
        std::vector<std::string> names;
        for (const stroke::Mask& m : table.masks) names.push_back(m.name);
        throw UsageError(a.project.string() + ": has no mask '" + a.mask + "'" +
                         did_you_mean(nearest_name(a.mask, names)).text());
    }
    const stroke::MaskTexels& texels = painting.masks().texels(mask->id);
    const atlas::TexelMap& map = painting.model().texels;
    ink::AtlasMap<float> coverage{map.size, 1, std::vector<float>(std::size_t{map.size} * map.size, 0)};
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot) {
        const std::uint32_t tile = map.tile_of_slot[slot];
        const std::size_t x0 = tile % map.tiles_per_side * atlas::kTile, y0 = tile / map.tiles_per_side * atlas::kTile;
        for (std::size_t t = 0; t < atlas::kTileTexels; ++t) {
            const std::size_t x = x0 + t % atlas::kTile, y = y0 + t / atlas::kTile;
            if (x < map.size && y < map.size && map.tiles[slot].cluster[t] != atlas::kNoCluster)
                coverage.texels[y * map.size + x] = texels.coverage(slot, static_cast<int>(t)) / 255.0f;
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

Maps make_decal_maps(const Decals& a, const stroke::Document& painting) {
    Maps maps;
    const ink::Stack stack = painting.appearance().stack();
    ink::ComposeOptions compose = painting.appearance().compose_options();
    compose.space = *ink::colour_space_named(a.colour_space);
    const bool painted = !painting.layers().pigments().empty() && !stack.layers.empty();
    if (!painted && (a.mask.empty() || a.plates))
        throw Error(a.project.string(), "nothing is painted: there is no film to cut");
    if (a.mask.empty() || a.plates) maps.amounts = ink::compose_amounts(stack, painting.model().texels, compose);
    maps.coverage = a.mask.empty() ? coverage_of_paint(maps.amounts) : coverage_of_mask(a, painting);
    if (!a.plates) maps.amounts = {};
    if (format_of(a) == ".dxf") return maps;
    maps.colour = ink::compose_srgb8(stack, painting.model().texels, painting.appearance().substrate(), compose);
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

decal::SheetOptions sheet_options(const Decals& a, Console& console) {
    decal::SheetOptions options;
    options.max_strain = a.max_strain;
    options.bleed = kMillimetre * a.bleed_mm;
    options.overlap = kMillimetre * a.overlap_mm;
    options.join = kMillimetre * a.join_mm;
    options.page = kMillimetre * a.page_mm;
    options.upright = a.grain == "up";
    options.pixel = 0.0254 / a.dpi;
    options.strain_map = a.strain_map;
    options.prints = format_of(a) != ".dxf";
    options.title = a.project.stem().string();
    options.progress = console.progress();
    return options;
}

nlohmann::json piece_json(const decal::Piece& piece) {
    const Vec2 size = decal::box_of(piece.film).size() / kMillimetre;
    return {{"number", piece.number},
            {"page", piece.page + 1},
            {"size_mm", {size.x, size.y}},
            {"film_mm2", decal::area_of(piece.film) * 1e6},
            {"paint_mm2", piece.paint_area * 1e6},
            {"strain", piece.strain}};
}

void check_request(const Decals& a) {
    check_extension(a.output, {".pdf", ".svg", ".dxf"});
    if (a.plates && format_of(a) != ".pdf") throw UsageError("--plates: plates are separations, which only a .pdf has");
    check_output(a.output);
    if (a.guide.empty()) return;
    std::error_code ec;
    if (!std::filesystem::is_directory(a.guide, ec)) check_output(a.guide);
}

void print_result(const Decals& a, const decal::Sheet& sheet, const std::vector<std::string>& wrote) {
    const std::size_t pages = static_cast<std::size_t>(std::count_if(
        sheet.pages.begin(), sheet.pages.end(), [](const decal::Page& page) { return !page.strain_map; }));
    if (a.common.json) {
        nlohmann::json j{{"project", a.project.string()},
                         {"wrote", wrote},
                         {"pages", pages},
                         {"max_strain", sheet.max_strain},
                         {"pieces", nlohmann::json::array()},
                         {"plates", nlohmann::json::array()}};
        for (const decal::Piece& piece : sheet.pieces) j["pieces"].push_back(piece_json(piece));
        for (const decal::Plate& plate : sheet.plates)
            j["plates"].push_back({{"name", plate.name}, {"full_film_units", plate.full}});
        print_json(j);
        return;
    }
    double strain = 0, film = 0;
    for (const decal::Piece& piece : sheet.pieces) {
        strain = std::max(strain, piece.strain);
        film += decal::area_of(piece.film);
    }
    fmt::print("{} on {}, {:.1f} cm2 of film, strained by {:.2f} % at most\n", counted(sheet.pieces.size(), "piece"),
               counted(pages, "page"), film * 1e4, 100 * strain);
    for (const decal::Plate& plate : sheet.plates)
        fmt::print("plate {}: 100 % is {:.2f} film units\n", plate.name, plate.full);
    for (const std::string& path : wrote) fmt::print("wrote {}\n", path);
}

}  // namespace

int run(const Decals& a) {
    check_request(a);
    Console console(a.common.quiet);
    const auto project = open_project(a.project, io::Access::read, console);
    stroke::Document painting(project->model);
    restore(*project, painting, console);
    show_layers(painting, a.layers);
    apply_recolouring(project->file, painting, a.recolouring, console);
    Maps maps = make_decal_maps(a, painting);
    std::vector<decal::Plate> plates;
    if (a.plates) plates = find_plates(maps.amounts, painting);
    decal::PrintSource source{.corner_uvs = project->model.atlas.corner_uvs,
                              .coverage = {},
                              .colour = &maps.colour,
                              .amounts = a.plates ? &maps.amounts : nullptr,
                              .full = {},
                              .texel = project->model.atlas.texel_size};
    source.coverage = [&](std::uint32_t triangle, const decal::Weights& weights) {
        float value = 0;
        decal::sample(maps.coverage, decal::uv_of(source.corner_uvs, triangle, weights), &value);
        return double{value};
    };
    for (const decal::Plate& plate : plates) source.full.push_back(static_cast<float>(plate.full));
    decal::Sheet sheet = decal::make_sheet(*project->model.mesh, source, sheet_options(a, console));
    sheet.plates = std::move(plates);
    sheet.profile = io::icc_profile(*ink::colour_space_named(a.colour_space));
    std::vector<std::string> wrote;
    for (const auto& path : io::write_sheet(a.output, sheet)) wrote.push_back(path.string());
    if (!a.guide.empty())
        for (const auto& path : write_placing_guide(a.guide, {*project, painting, sheet}, console))
            wrote.push_back(path.string());
    console.clear();
    print_result(a, sheet, wrote);
    return 0;
}

}  // namespace tuft::cli
