#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/steps.h"
#include "io/export.h"
#include "io/image.h"
#include "io/read_model.h"

/// Commands that start from a project: replay, export, render.
namespace tuft::cli {
namespace {

std::filesystem::path numbered(const std::filesystem::path& path, int index, int count) {
    const int digits = static_cast<int>(std::to_string(count - 1).size());
    return path.parent_path() /
           fmt::format("{}-{:0{}}{}", path.stem().string(), index, digits, path.extension().string());
}

// The model to replay on: the stored one, with a new atlas if asked for, or a revised file.
stroke::Model replay_model(const Replay& a, OpenProject& project, Console& console) {
    Surface surface = a.surface;
    surface.unit = a.model.empty() ? "mm" : project.unit;
    if (surface.pages == 0) surface.pages = project.model.atlas.pages;
    if (!a.model.empty()) {
        if (surface.atlas_size == 0 && surface.texel_size_mm == 0)
            surface.atlas_size = project.model.atlas.page_size();
        return load_model(a.model, surface, console);
    }
    if (surface.atlas_size == 0 && surface.texel_size_mm == 0 && !surface.new_uv &&
        surface.seams == "free")
        return std::move(project.model);
    stroke::ModelOptions options = model_options(surface, console);
    return stroke::rescale_model(std::move(project.model), options);
}

}  // namespace

int run(const Replay& a) {
    const Outputs outputs{a.out_project, a.exported, a.preview, a.view, a.surface.unit};
    check_outputs(outputs);
    Console console(a.common.quiet);
    const auto project = open_project(a.project, console);
    std::vector<stroke::Stroke> strokes = project->file.strokes();
    const stroke::Model model = replay_model(a, *project, console);

    stroke::Painting painting(model);
    painting.use_substrate(project->substrate);
    use_presets(project->file, painting);
    for (stroke::Stroke& s : strokes) {
        if (!a.brush.empty()) s.trace.brush = a.brush;
        if (!a.ink.empty()) s.trace.ink = a.ink;
    }
    find_presets(painting, strokes);
    const std::vector<stroke::StrokeReport> reports = painting.replay(strokes, console.progress());
    console.clear();
    std::size_t missed = 0;
    for (const stroke::StrokeReport& r : reports) {
        if (r.touched()) continue;
        ++missed;
        console.note(fmt::format("warning: stroke {} no longer touches the model; it stays {:.2f} mm away",
                                 r.stroke_id, r.nearest * 1e3));
    }
    if (!a.out_project.empty()) {
        io::Project out = start_project(a.out_project, a.model.empty() ? project->source : a.model.string(),
                                        project->unit, painting, strokes);
        out.append(painting.journal().strokes());
        if (!strokes.empty()) out.save_canvases(painting.canvases(), strokes.back().id);
    }
    show_layers(painting, a.view.layers);
    write_outputs(outputs, painting, console);
    console.clear();
    if (a.common.json) {
        nlohmann::json j{{"project", a.project.string()},
                         {"strokes", reports.size()},
                         {"missed", missed},
                         {"atlas", to_json(model.atlas, model.atlas_report)},
                         {"canvas_hash", fmt::format("{:016x}", painting.hash())}};
        std::cout << j.dump(2) << '\n';
    } else {
        fmt::print("replayed {} strokes, {} of them miss the model; atlas {} x {}\n", reports.size(),
                   missed, model.atlas.size, model.atlas.size);
    }
    return 0;
}

int run(const Export& a) {
    check_extension(a.output, {".glb", ".gltf", ".obj", ".png", ".exr"});
    check_output(a.output);
    Console console(a.common.quiet);
    const auto project = open_project(a.project, console);
    stroke::Painting painting(project->model);
    painting.use_substrate(project->substrate);
    use_presets(project->file, painting);
    show_strokes(project->file, painting, console);
    show_layers(painting, a.layers);
    const ink::ComposeOptions compose = painting.compose_options();
    const std::string extension = a.output.extension().string();
    const atlas::Atlas& atlas = project->model.atlas;
    const auto write_pages = [&](const auto& map, const io::ImageOptions& options) {
        for (std::uint32_t page = 0; page < atlas.pages; ++page)
            io::write_image(io::page_path(a.output, atlas, page),
                            io::page_view(io::view_of(map), atlas, page), options);
    };
    if (extension == ".png") {
        write_pages(ink::compose_srgb8(painting.stack(), project->model.texels,
                                       painting.substrate(), compose), {});
    } else if (extension == ".exr") {
        write_pages(ink::compose_linear(painting.stack(), project->model.texels,
                                        painting.substrate(), compose), {.srgb = false});
    } else {
        write_outputs({.exported = a.output, .unit = project->unit}, painting, console);
    }
    console.clear();
    if (a.common.json)
        std::cout << nlohmann::json{{"project", a.project.string()}, {"wrote", a.output.string()}}.dump(2) << '\n';
    else
        fmt::print("wrote {}\n", a.output.string());
    return 0;
}

int run(const Render& a) {
    check_extension(a.output, {".png"});
    check_output(a.output);
    Console console(a.common.quiet);
    std::unique_ptr<OpenProject> project;
    std::unique_ptr<stroke::Painting> painting;
    stroke::Model bare;
    const stroke::Model* model = &bare;
    if (is_project_file(a.file)) {
        project = open_project(a.file, console);
        model = &project->model;
        painting = std::make_unique<stroke::Painting>(*model);
        painting->use_substrate(project->substrate);
        use_presets(project->file, *painting);
        show_strokes(project->file, *painting, console);
        show_layers(*painting, a.view.layers);
    } else {
        bare = load_bare(a.file, a.unit, console);
    }
    const int count = std::max(1, a.turntable);
    std::vector<std::string> wrote;
    for (int i = 0; i < count; ++i) {
        const auto path = a.turntable > 0 ? numbered(a.output, i, count) : a.output;
        write_picture(path, draw_picture(*model, painting.get(), a.material, a.view, i, count, console));
        wrote.push_back(path.string());
    }
    console.clear();
    if (a.common.json)
        std::cout << nlohmann::json{{"wrote", wrote}}.dump(2) << '\n';
    else
        for (const std::string& path : wrote) fmt::print("wrote {}\n", path);
    return 0;
}

}  // namespace tuft::cli
