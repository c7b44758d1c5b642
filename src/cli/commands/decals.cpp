#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/commands/placing_guide.h"
#include "cli/steps/commands.h"
#include "cli/steps/steps.h"
#include "core/error.h"
#include "core/files/extension.h"
#include "core/text/counted.h"
#include "core/text/units.h"
#include "io/sheet/painted_sheet.h"
#include "io/sheet/sheet_files.h"

/// `tuft decals`: sheets of film from a project.
namespace tuft::cli {
namespace {

/// The mask whose areas are cut out, or 0.
std::uint32_t mask_of(const Decals& a, const stroke::Document& painting) {
    if (a.mask.empty()) return 0;
    const stroke::MaskTable& table = painting.masks().table();
    if (const stroke::Mask* mask = table.find(a.mask)) return mask->id;
    std::vector<std::string> names;
    for (const stroke::Mask& m : table.masks) names.push_back(m.name);
    throw UsageError(a.project.string() + ": has no mask '" + a.mask + "'" +
                     did_you_mean(nearest_name(a.mask, names)).text());
}

decal::SheetOptions sheet_options(const Decals& a, Console& console) {
    decal::SheetOptions options;
    options.max_strain = a.max_strain;
    options.bleed = kMillimetre * a.bleed_mm;
    options.overlap = kMillimetre * a.overlap_mm;
    options.join = kMillimetre * a.join_mm;
    options.least_fragment = kMillimetre * kMillimetre * a.least_fragment_mm2;
    options.least_piece = kMillimetre * kMillimetre * a.least_piece_mm2;
    options.page = kMillimetre * a.print.page_mm;
    options.upright = a.print.grain == "up";
    options.pixel = 0.0254 / a.print.dpi;
    options.strain_map = a.print.strain_map;
    options.prints = lower_extension(a.output) != ".dxf";
    options.outlines = a.print.outlines;
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
            {"strain", piece.strain},
            {"outlined", piece.outlined}};
}

void check_request(const Decals& a) {
    check_extension(a.output, {".pdf", ".svg", ".dxf"});
    if (a.print.plates && lower_extension(a.output) != ".pdf" && !a.print.outlines)
        throw UsageError("--plates: plates are separations, which only a .pdf has; with --outlines they are layers");
    if (a.print.outlines && !a.mask.empty())
        throw UsageError("--outlines: those of what is painted; the outline of a mask is its cut line");
    check_output(a.output);
    if (!a.guide.empty()) check_folder(a.guide);
}

/// Names the option that leaves slivers out, where there are some.
void print_slivers(const decal::Sheet& sheet) {
    constexpr double kSmall = 5e-5;  // m² of paint
    std::size_t n = 0;
    double paint = 0;
    for (const decal::Piece& piece : sheet.pieces)
        if (decal::is_sliver(piece, kSmall)) ++n, paint += piece.paint_area;
    if (n > 0)
        fmt::print("{} with {:.1f} mm2 of paint in all on far more film (--least-piece 50 leaves out such)\n",
                   counted(n, "small piece"), paint * 1e6);
}

/// Says which inks have outlines, and what has none.
void print_outlined(const Decals& a, const decal::Sheet& sheet) {
    for (const decal::SheetInk& ink : sheet.inks) fmt::print("outlines of ink {}\n", ink.name);
    const auto mixed = static_cast<std::size_t>(
        std::ranges::count_if(sheet.pieces, [](const decal::Piece& piece) { return !piece.outlined; }));
    if (mixed > 0)
        fmt::print("{} of several inks {} (--plates outlines each pigment)\n", counted(mixed, "piece"),
                   lower_extension(a.output) == ".dxf" ? "without outlines" : "as pictures");
}

void print_result(const Decals& a, const decal::Sheet& sheet, const std::vector<std::string>& wrote) {
    const std::size_t pages = static_cast<std::size_t>(std::count_if(
        sheet.pages.begin(), sheet.pages.end(), [](const decal::Page& page) { return !page.strain_map; }));
    if (a.common.json) {
        nlohmann::json j{
            {"project", a.project.string()},
            {"wrote", wrote},
            {"pages", pages},
            {"max_strain", sheet.max_strain},
            {"left_out", {{"fragments", sheet.left_out.fragments}, {"paint_mm2", sheet.left_out.paint_area * 1e6}}},
            {"pieces", nlohmann::json::array()},
            {"plates", nlohmann::json::array()},
            {"inks", nlohmann::json::array()}};
        for (const decal::Piece& piece : sheet.pieces) j["pieces"].push_back(piece_json(piece));
        for (const decal::Plate& plate : sheet.plates)
            j["plates"].push_back({{"name", plate.name}, {"full_film_units", plate.full}});
        for (const decal::SheetInk& ink : sheet.inks) j["inks"].push_back(ink.name);
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
    if (sheet.left_out.fragments > 0)
        fmt::print("left out: {} with {:.1f} mm2 of paint (--least-fragment 0 lays them)\n",
                   counted(sheet.left_out.fragments, "fragment"), sheet.left_out.paint_area * 1e6);
    print_slivers(sheet);
    if (a.print.outlines) print_outlined(a, sheet);
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
    const decal::Sheet sheet =
        io::make_painted_sheet(painting, {.mask = mask_of(a, painting),
                                          .plates = a.print.plates,
                                          .space = *ink::colour_space_named(a.print.colour_space),
                                          .sheet = sheet_options(a, console)});
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
