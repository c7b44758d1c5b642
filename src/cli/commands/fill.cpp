#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/steps/commands.h"
#include "cli/steps/steps.h"
#include "core/text/units.h"
#include "stroke/journal/tables.h"

namespace tuft::cli {
namespace {

Vec3 metres(const std::vector<double>& mm) {
    return kMillimetre * Vec3(mm[0], mm[1], mm[2]);
}

stroke::Fill fill_of(const FillWork& a, stroke::Document& painting) {
    stroke::Fill fill{.ink = a.ink};
    if (a.palette) fill.layer = stroke::kPaletteLayer;
    if (a.palette && !(a.layer.empty() && a.mask.empty())) throw UsageError("the palette has neither layers nor masks");
    fill.film = a.film >= 0 ? a.film : painting.materials().ink(a.ink).film;
    fill.to_film = fill.film;
    if (!a.to_ink.empty()) fill.to_film = painting.materials().ink(a.to_ink).film;
    if (a.to_film >= 0) fill.to_film = a.to_film;
    fill.to_ink = a.to_ink;
    if (!a.from_mm.empty()) {
        fill.gradient = a.round ? stroke::Gradient::round : stroke::Gradient::along;
        fill.from = metres(a.from_mm);
        fill.to = metres(a.to_mm);
    } else if (!a.to_ink.empty() || a.to_film >= 0) {
        throw UsageError("a gradient needs --from and --to");
    }
    if (!a.part_mm.empty()) fill.region = stroke::Region::part, fill.at = metres(a.part_mm);
    if (!a.chart_mm.empty()) fill.region = stroke::Region::chart, fill.at = metres(a.chart_mm);
    return fill;
}

}  // namespace

int run(const FillWork& a) {
    Console console(a.common.quiet);
    const auto project = open_project(a.project, io::Access::write, console);
    for (const std::vector<double>* point : {&a.part_mm, &a.chart_mm})
        if (!point->empty())
            check_on_surface(project->model, metres(*point), point == &a.part_mm ? "--part" : "--chart");
    stroke::Document painting(project->model);
    restore(*project, painting, console);
    std::vector<stroke::JournalEntry> entries =
        stroke::onto_named_layers({stroke::JournalEntry(fill_of(a, painting))}, painting.layers().table(), a.layer);
    stroke::keep_to_named_masks(entries, painting.masks().table(), a.mask);
    find_presets(painting, entries);
    stroke::StrokeReport report;
    std::vector<stroke::JournalEntry> done;
    for (const stroke::JournalEntry& entry : entries) {
        report = painting.paint(entry);
        done.push_back(painting.journal().entries().back());
    }
    put_presets(project->file, painting, entries);
    project->file.append(done);
    project->file.save_canvases(stroke::all_canvases(painting), done.back().id);
    console.clear();
    const double volume = report.ink_given * ink::kFilmUnit * 1e9;
    if (a.common.json)
        print_json(nlohmann::json{{"project", a.project.string()},
                                  {"id", done.back().id},
                                  {"pigment_mm3", volume},
                                  {"canvas_hash", fmt::format("{:016x}", painting.layers().hash())}});
    else
        fmt::print("filled with {:.1f} mm3 of pigment\n", volume);
    return 0;
}

}  // namespace tuft::cli
