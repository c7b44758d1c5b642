#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <span>

#include "cli/commands/revision.h"
#include "cli/steps/commands.h"
#include "cli/steps/steps.h"
#include "core/error.h"
#include "core/text/counted.h"
#include "core/text/text.h"
#include "core/text/units.h"
#include "ink/composite/filament.h"
#include "ink/composite/match.h"
#include "io/export/export_layers.h"
#include "io/export/export_maps.h"
#include "io/export/print_3mf.h"
#include "io/image/image.h"
#include "io/model/read_model.h"
#include "io/project/restore.h"
#include "io/strokes/inkml.h"
#include "stroke/journal/recorded_journal.h"

/// Commands that start from a project: replay, export, render.
namespace tuft::cli {
namespace {

std::filesystem::path numbered(const std::filesystem::path& path, int index, int count) {
    const int digits = static_cast<int>(std::to_string(count - 1).size());
    return path.parent_path() /
           fmt::format("{}-{:0{}}{}", path.stem().string(), index, digits, path.extension().string());
}

/// The map a picture shall hold: the one asked for, or the one the file is called.
std::string map_name(const Export& a) {
    const std::string extension = a.output.extension().string(), stem = a.output.stem().string();
    const bool picture = extension == ".png" || extension == ".exr";
    if (!a.map.empty() && !picture)
        throw UsageError("--map: a map is written as .png or .exr, not as '" + extension + "'");
    std::string name = a.map;
    for (const std::string& known : io::map_names())
        if (name.empty() && stem == known) name = known;
    if (name == "pigments" && extension == ".png")
        throw UsageError(a.output.string() + ": pigment amounts need an .exr file");
    if (name == "layers" && extension == ".png")
        throw UsageError(a.output.string() + ": layers need an .exr or .ora file");
    if (name == "palette" && extension != ".png")
        throw UsageError(a.output.string() + ": a picture of the palette is a .png file");
    return name.empty() ? "base-colour" : name;
}

void check_colour_space(const Export& a, const std::string& map) {
    if (a.colour_space.empty()) return;
    const std::string extension = a.output.extension().string();
    const bool picture = extension == ".png" || extension == ".exr";
    if (extension != ".ora" && !(picture && (map == "base-colour" || map == "layers")))
        throw UsageError("--colour-space: only base colours and layers have one; a model's textures are sRGB");
    const bool linear = ink::data_of(*ink::colour_space_named(a.colour_space)).linear;
    if (linear && (extension == ".ora" || (extension == ".png" && a.bits != 16)))
        throw UsageError("--colour-space: linear colours need an .exr file, or a .png with --bits 16");
}

std::vector<ink::Filament> filaments_of(const Export& a) {
    if (a.filaments.empty()) return {};
    if (a.output.extension() != ".3mf") throw UsageError("--filaments: only a .3mf file has filaments");
    if (std::filesystem::path(a.filaments).extension() == ".toml") return ink::load_filaments(a.filaments);
    std::vector<ink::Filament> filaments;
    for (std::size_t at = 0; at <= a.filaments.size();) {
        const std::size_t end = std::min(a.filaments.find(',', at), a.filaments.size());
        const std::string hex = a.filaments.substr(at, end - at);
        const std::optional<ink::Rgb> colour = ink::colour_of_hex(hex.starts_with('#') ? hex : "#" + hex);
        if (!colour) throw UsageError("--filaments: '" + excerpt(hex) + "' is not a colour such as #c03020");
        filaments.push_back({.name = hex, .colour = *colour});
        at = end + 1;
    }
    if (filaments.size() > ink::kMostFilaments)
        throw UsageError(fmt::format("--filaments: at most {}", ink::kMostFilaments));
    return filaments;
}

int print_in_filaments(const Export& a, const std::vector<ink::Filament>& filaments, const stroke::Document& painting,
                       Console& console) {
    const stroke::Model& model = painting.model();
    const stroke::Appearance& shown = painting.appearance();
    const io::PaintedTriangles painted = io::paint_triangles(
        *model.mesh, model.atlas,
        ink::compose_linear(shown.stack(), model.texels, shown.substrate(), shown.compose_options()),
        {.filaments = filaments,
         .wall = kMillimetre * a.wall_mm,
         .detail = kMillimetre * a.detail_mm,
         .progress = console.progress()});
    const auto& beside = model.mesh->neighbours;
    io::write_painted_3mf(a.output, painted, filaments, std::find(beside.begin(), beside.end(), kNone) == beside.end());
    console.clear();
    if (a.common.json)
        print_json(nlohmann::json{{"project", a.project.string()},
                                  {"wrote", a.output.string()},
                                  {"triangles", painted.triangles.size()},
                                  {"mean_delta_e_2000", painted.mean_delta_e}});
    else
        fmt::print("{} in {}, mean colour difference {:.2f} (CIEDE2000)\nwrote {}\n",
                   counted(painted.triangles.size(), "triangle"), counted(filaments.size(), "filament"),
                   painted.mean_delta_e, a.output.string());
    return 0;
}

int write_strokes(const Export& a, Console& console) {
    const std::vector<stroke::JournalEntry> entries =
        io::Project::open(a.project, open_options(io::Access::read, console)).strokes();
    const stroke::RecordedJournal written = stroke::record(entries);
    if (written.strokes.empty()) throw Error(a.project.string(), "there are no strokes to write");
    io::write_inkml(a.output, written.strokes, a.project.stem().string());
    if (written.left_out > 0)
        console.note(fmt::format("warning: {} changes of layers and masks are not in a stroke file", written.left_out));
    if (a.common.json)
        print_json(nlohmann::json{{"project", a.project.string()},
                                  {"wrote", a.output.string()},
                                  {"traces", written.strokes.size()},
                                  {"left_out", written.left_out}});
    else
        fmt::print("wrote {}\n", a.output.string());
    return 0;
}

}  // namespace

stroke::Model replay_model(const Replay& a, OpenProject& project, Console& console) {
    Surface surface = a.surface;
    if (surface.pages == 0) surface.pages = project.model.atlas.pages;
    if (!a.model.empty()) {
        if (surface.atlas_size == 0 && surface.texel_size_mm == 0) surface.atlas_size = project.model.atlas.page_size();
        FileFrame former = project.frame;
        if (!former.unit_overrides && io::states_unit(project.source)) former.unit.clear();  // says nothing of others
        Loaded revised = load_model(a.model, surface, console, &former);
        project.frame = revised.frame;
        return std::move(revised.model);
    }
    if (surface.atlas_size == 0 && surface.texel_size_mm == 0 && !surface.new_uv && surface.seams == "free")
        return std::move(project.model);
    const atlas::Atlas& atlas = project.model.atlas;  // pages of the file stay
    surface.keep_uv |=
        atlas.from_file && (atlas.pages > 1 || !atlas.udims.empty()) && !surface.new_uv && surface.seams == "free";
    stroke::ModelOptions options = model_options(surface, console);
    return stroke::rescale_model(std::move(project.model), options);
}

namespace {

void print_replayed(std::span<const stroke::JournalEntry> entries, std::span<const stroke::StrokeReport> reports,
                    const atlas::Atlas& atlas) {
    const auto areas = static_cast<std::size_t>(std::ranges::count_if(entries, [](const stroke::JournalEntry& entry) {
        const stroke::Fill* fill = entry.as<stroke::Fill>();
        return fill && fill->area;
    }));
    const auto missed = std::ranges::count_if(reports, [](const stroke::StrokeReport& r) { return !r.touched(); });
    std::string what = areas == 0 ? "" : counted(areas, "area");
    if (!reports.empty() || areas == 0)
        what +=
            fmt::format("{}{}, {} of {} miss{} the model", areas == 0 ? "" : " and ", counted(reports.size(), "stroke"),
                        missed, areas == 0 ? "them" : "the strokes", missed == 1 ? "es" : "");
    fmt::print("replayed {}; atlas {} x {}\n", what, atlas.size, atlas.size);
}

}  // namespace

int run(const Replay& a) {
    Outputs outputs{a.out_project, a.exported, a.preview, a.view, {}};
    check_outputs(outputs);
    check_extension(a.moved, {".png"});
    check_output(a.moved);
    Console console(a.common.quiet);
    const auto reserved = reserve(a.out_project, console);
    const auto project = open_project(a.project, io::Access::read, console, model_cache(a.surface));
    const stroke::Model model = replay_model(a, *project, console);
    outputs.frame = project->frame;

    stroke::Document painting(model, {.tip_lags = tip_lag_cache(a.surface)});
    painting.use(project->substrate);
    io::use_presets(project->file, painting);
    const RevisedStrokes revised = replay_strokes(a, *project, painting);
    const mesh::SurfaceQuery& former = former_surface(a, *project, painting);
    const std::vector<stroke::JournalEntry>& strokes = revised.followed;
    const std::vector<stroke::StrokeReport> reports = painting.replay(strokes, console.progress());
    console.clear();
    const Fit fit = find_fit(a, revised, painting, former, reports);
    std::size_t missed = 0;
    for (const stroke::StrokeReport& r : reports) missed += !r.touched();
    note_fit(a, revised, fit, console);
    apply_recolouring(project->file, painting, a.recolouring, console);
    if (!a.out_project.empty()) {
        io::Project out = start_project(a.out_project, a.model.empty() ? project->source : a.model.string(),
                                        outputs.frame, painting, strokes);
        out.append(painting.journal().entries());
        if (!strokes.empty()) out.save_canvases(stroke::all_canvases(painting), strokes.back().id);
    }
    show_layers(painting, a.view.layers);
    write_outputs(outputs, painting, console);
    if (!a.moved.empty()) write_revision_picture(a, revised, fit, painting, former, console);
    console.clear();
    if (a.common.json) {
        nlohmann::json list = nlohmann::json::array();
        for (const stroke::StrokeMismatch& m : fit.mismatches) {
            list.push_back({{"stroke", m.stroke}, {"reason", m.reason.text()}});
            if (m.area) list.back()["area"] = true;
        }
        nlohmann::json j{{"project", a.project.string()},
                         {"strokes", reports.size()},
                         {"missed", missed},
                         {"mismatches", std::move(list)},
                         {"atlas", to_json(model.atlas, model.atlas_report)},
                         {"canvas_hash", fmt::format("{:016x}", painting.layers().hash())}};
        j["misfits"] = j["mismatches"];  // its name before
        if (!a.model.empty()) j["fit"] = to_json(revised, fit);
        print_json(j);
    } else {
        print_replayed(strokes, reports, model.atlas);
        for (const std::filesystem::path& path : {a.out_project, outputs.exported, outputs.preview, a.moved})
            if (!path.empty()) fmt::print("wrote {}\n", path.string());
    }
    return 0;
}

int run(const Export& a) {
    check_extension(a.output, {".glb", ".gltf", ".obj", ".3mf", ".png", ".exr", ".ora", ".inkml"});
    check_output(a.output);
    const std::string map = map_name(a);
    check_colour_space(a, map);
    const std::vector<ink::Filament> filaments = filaments_of(a);
    if (a.bits == 16 && (map != "base-colour" || a.output.extension() != ".png"))
        throw UsageError(
            "--bits: only a base-colour.png has a choice; other maps have 16 bits in PNG and floats in EXR");
    Console console(a.common.quiet);
    if (a.output.extension() == ".inkml") return write_strokes(a, console);
    const auto project = open_project(a.project, io::Access::read, console);
    stroke::Document painting(project->model);
    restore(*project, painting, console);
    show_layers(painting, a.layers);
    apply_recolouring(project->file, painting, a.recolouring, console);
    ink::ComposeOptions compose = painting.appearance().compose_options();
    if (!a.colour_space.empty()) compose.space = *ink::colour_space_named(a.colour_space);
    const std::string extension = a.output.extension().string();
    if (extension == ".png" || extension == ".exr")
        io::write_map(a.output, map, painting, compose, {.bits = a.bits, .profile = !a.colour_space.empty()});
    else if (extension == ".ora")
        io::write_layers(a.output, painting, compose);
    else if (!filaments.empty())
        return print_in_filaments(a, filaments, painting, console);
    else
        write_outputs({.exported = a.output, .frame = project->frame}, painting, console);
    console.clear();
    if (a.common.json)
        print_json(nlohmann::json{{"project", a.project.string()},
                                  {"wrote", a.output.string()},
                                  {"canvas_hash", fmt::format("{:016x}", painting.layers().hash())}});
    else
        fmt::print("wrote {}\n", a.output.string());
    return 0;
}

int run(const Render& a) {
    check_extension(a.output, {".png"});
    check_output(a.output);
    Console console(a.common.quiet);
    std::unique_ptr<OpenProject> project;
    std::unique_ptr<stroke::Document> painting;
    stroke::Model bare;
    const stroke::Model* model = &bare;
    if (is_project_file(a.file)) {
        project = open_project(a.file, io::Access::read, console);
        model = &project->model;
        painting = std::make_unique<stroke::Document>(*model);
        restore(*project, *painting, console);
        show_layers(*painting, a.view.layers);
        apply_recolouring(project->file, *painting, a.recolouring, console);
    } else {
        bare = load_bare(a.file, a, console).model;
        if (mesh::has_colours(*bare.mesh) && a.material.empty()) {
            stroke::ModelOptions options;
            options.unwrap.size = 4096;
            options.progress = console.progress();
            bare = stroke::rescale_model(std::move(bare), options);
        } else {
            bare.query = std::make_unique<mesh::SurfaceQuery>(*bare.mesh);
        }
    }
    const int count = std::max(1, a.turntable);
    std::vector<std::string> wrote;
    for (int i = 0; i < count; ++i) {
        const auto path = a.turntable > 0 ? numbered(a.output, i, count) : a.output;
        write_picture(path, draw_picture({*model, painting.get(), a.view, a.material, i, count}, console));
        wrote.push_back(path.string());
    }
    console.clear();
    if (a.common.json)
        print_json(nlohmann::json{{"wrote", wrote}});
    else
        for (const std::string& path : wrote) fmt::print("wrote {}\n", path);
    return 0;
}

}  // namespace tuft::cli
