#include "cli/steps/steps.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <span>

#include "cli/steps/drawing.h"
#include "core/files/extension.h"
#include "core/files/path_fault.h"
#include "core/text/units.h"
#include "ink/composite/composite.h"
#include "ink/composite/match.h"
#include "ink/composite/recolour.h"
#include "io/export/export.h"
#include "io/image/image.h"
#include "io/model/read_model.h"
#include "io/project/appearance.h"
#include "io/project/restore.h"
#include "io/svg/svg.h"
#include "mesh/repair/inspect.h"
#include "stroke/gesture/bias_correction.h"
#include "stroke/journal/entries.h"

namespace fs = std::filesystem;

namespace tuft::cli {

io::CadReading cad_reading(const fs::path& path, const FileReading& how) {
    if ((how.chord_mm > 0 || !how.groups.empty()) && io::is_model_file(path) && !io::is_cad_file(path))
        throw UsageError("--chord and --groups are for STEP and IGES files, and " + path.string() + " is none");
    return {.chord = how.chord_mm * kMillimetre,
            .groups = how.groups == "faces" ? io::CadGroups::faces : io::CadGroups::bodies,
            .unit = how.unit};
}

stroke::ModelOptions model_options(const Surface& s, Console& console) {
    stroke::ModelOptions options;
    options.unwrap.size = s.atlas_size;
    options.unwrap.texel_size = s.texel_size_mm * kMillimetre;
    options.unwrap.pages = std::max(s.pages, 1u);
    options.unwrap.cutting = s.tight   ? atlas::Cutting::tight
                             : s.whole ? atlas::Cutting::never
                                       : atlas::Cutting::where_useful;
    options.unwrap.seams.groups = s.seams == "groups" || s.seams == "both";
    if (s.seams == "sharp" || s.seams == "both") options.unwrap.seams.sharp_angle = s.sharp_angle_deg * kDegree;
    options.unwrap.uvs = s.new_uv    ? atlas::UvPolicy::renew
                         : s.keep_uv ? atlas::UvPolicy::keep
                                     : atlas::UvPolicy::automatic;
    options.texels = s.texel_store == "float"    ? atlas::TexelStore::floats
                     : s.texel_store == "packed" ? atlas::TexelStore::packed
                                                 : atlas::TexelStore::automatic;
    options.progress = console.progress();
    return options;
}

namespace {

struct Read {
    mesh::PolygonSoup soup;
    FileFrame frame;
};

std::string unit_name(double metres) {
    for (const auto& [unit, name] : {std::pair("um", "micrometres"),
                                     {"mm", "millimetres"},
                                     {"cm", "centimetres"},
                                     {"m", "metres"},
                                     {"in", "inches"},
                                     {"ft", "feet"}})
        if (std::abs(metres / *metres_per(unit) - 1) < 1e-6) return name;
    return fmt::format("units of {:g} m", metres);
}

Read read_file(const fs::path& path, const FileReading& how, const FileFrame* former, mesh::RepairOptions& repair,
               Console& console) {
    FileReading known = how;
    if (former && known.unit.empty() && former->unit_overrides) known.unit = former->unit;
    report(repair.progress, "reading", 0);
    Read read{io::read_model(path, cad_reading(path, known)), {}};
    report(repair.progress, "reading", 1);
    if (former && known.unit.empty() && read.soup.stated_unit == 0) known.unit = former->unit;
    if (former && known.up.empty() && former->y_up && !read.soup.turned_up) known.up = "y";
    read.frame.unit_overrides = io::overrides_unit(read.soup, known.unit);
    if (!io::metres_per_unit(read.soup, known.unit)) {
        Box bounds;
        for (const Vec3& p : read.soup.points) bounds.add(p);
        const mesh::UnitGuess guess = mesh::guess_unit(bounds);
        if (guess.unit != read.frame.unit) console.note(guess.sentence + " (see --unit)");
        known.unit = guess.unit;
    }
    if (!known.unit.empty()) read.frame.unit = known.unit;
    read.frame.y_up = known.up == "y";
    ProgressFn progress = std::move(repair.progress);
    repair = repair_of(read.soup, path, known, console);
    repair.progress = std::move(progress);
    return read;
}

/// A model that changed its sides on reading is not what its file says.
void tell_sides(const mesh::RepairReport& repairs, Console& console) {
    if (repairs.parts_turned == 0) return;
    mesh::RepairReport turned;
    turned.parts_turned = repairs.parts_turned;
    console.note(mesh::describe_defects(turned).front().text() + " (--sides file keeps them)");
}

}  // namespace

mesh::RepairOptions repair_of(const mesh::PolygonSoup& soup, const fs::path& path, const FileReading& how,
                              Console& console) {
    mesh::RepairOptions repair;
    repair.metres_per_unit = io::metres_per_unit(soup, how.unit).value_or(kMillimetre);
    repair.y_up = how.up == "y" && !soup.turned_up;
    if (!how.sides.empty()) repair.sides = mesh::open_sides_of(how.sides);
    const std::string name = path.filename().string();
    if (io::overrides_unit(soup, how.unit))
        console.note(fmt::format("{} is read in {} (--unit), not in {} as it states: {:g} times as large", name,
                                 unit_name(*metres_per(how.unit)), unit_name(soup.stated_unit),
                                 repair.metres_per_unit));
    if (!how.up.empty() && soup.turned_up)
        console.note("--up is left aside: " + name + " is read with the axes that it states");
    return repair;
}

DiskCache tip_lag_cache(const Surface& s) {
    return s.no_cache ? DiskCache() : stroke::shared_tip_lag_cache();
}

DiskCache model_cache(const Surface& s) {
    return s.no_cache ? DiskCache() : stroke::shared_model_cache();
}

Loaded load_model(const fs::path& path, const Surface& s, Console& console, const FileFrame* former) {
    stroke::ModelOptions options = model_options(s, console);
    options.cache = model_cache(s);
    options.repair.progress = options.progress;
    Read read = read_file(path, s, former, options.repair, console);
    options.repair.progress = nullptr;
    if (s.plain) mesh::drop_colours(read.soup);
    try {
        const bool stated = read.soup.stated_unit > 0 && !read.frame.unit_overrides;
        Loaded loaded{stroke::prepare_model(std::move(read.soup), options), read.frame, stated};
        tell_sides(loaded.model.repairs, console);
        for (const Message& warning : loaded.model.repairs.warnings) console.note("warning: " + warning.text());
        if (!loaded.model.base_colour.empty())
            console.note("ink lies on the colours that the model brings along (--plain leaves them aside)");
        return loaded;
    } catch (const Error& error) {
        const std::string what = error.what();
        if (what.starts_with(path.string())) throw;
        throw Error(path.string(), what);
    }
}

Loaded load_bare(const fs::path& path, const FileReading& how, Console& console) {
    mesh::RepairOptions options;
    options.progress = console.progress();
    Read read = read_file(path, how, nullptr, options, console);
    const bool stated = read.soup.stated_unit > 0 && !read.frame.unit_overrides;
    stroke::Model model;
    try {
        mesh::Surface surface = mesh::build_surface(std::move(read.soup), options);
        model.mesh = std::make_unique<mesh::TriangleMesh>(std::move(surface.mesh));
        model.repairs = std::move(surface.report);
        tell_sides(model.repairs, console);
    } catch (const Error& error) {
        const std::string what = error.what();
        if (what.starts_with(path.string())) throw;
        throw Error(path.string(), what);
    }
    return {std::move(model), read.frame, stated};
}

void check_output(const fs::path& path) {
    if (path.empty()) return;
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    std::error_code ec;
    if (fs::is_directory(path, ec)) throw Error(path.string(), "is a folder, not a file to write");
    check_output_folder(path);
    if (::access(folder.c_str(), W_OK) != 0)
        throw Error(path.string(), Message("the output folder '{}' cannot be written to", folder.string()));
}

void check_folder(const fs::path& folder) {
    const fs::path bare = folder.has_filename() ? folder : folder.parent_path();
    std::error_code ec;
    if (!fs::is_directory(bare, ec)) {
        if (fs::exists(bare, ec)) throw Error(folder.string(), "is a file, not a folder");
        return check_output(bare);
    }
    if (::access(bare.c_str(), W_OK) != 0) throw Error(folder.string(), "the folder cannot be written to");
}

void check_extension(const fs::path& path, const std::vector<std::string>& allowed) {
    if (path.empty()) return;
    const std::string extension = lower_extension(path);
    if (std::find(allowed.begin(), allowed.end(), extension) != allowed.end()) return;
    throw UsageError(path.string() + ": the name must end in " + fmt::format("{}", fmt::join(allowed, ", ")));
}

namespace {

io::SvgPainting painting_of(const Paint& a) {
    if (a.drawing.areas == "mask") return io::SvgPainting::areas;
    const bool one_ink = !a.stroke.ink.empty() || !a.stroke.brush.empty() || a.stroke.erases;
    return a.drawing.areas == "brush" || one_ink ? io::SvgPainting::brush : io::SvgPainting::automatic;
}

// A brush that was chosen, or prepared, paints every line itself.
bool fills_wide_lines(const Paint& a) {
    return a.drawing.areas.empty() && a.stroke.brush.empty() && !a.stroke.erases && a.stroke.prepare.empty() &&
           a.wet.film == "still";
}

// The file is a group, and so is each layer and named group in it.
void number_groups(std::span<stroke::JournalEntry> strokes, const fs::path& file, std::uint64_t& n_groups) {
    std::map<std::string, std::uint64_t> ids;
    for (stroke::JournalEntry& s : strokes) {
        const auto [at, fresh] = ids.try_emplace(s.group.name, n_groups + 1);
        if (fresh) ++n_groups;
        std::string name = stroke::group_name(file);
        if (!s.group.name.empty()) {
            name += ": " + s.group.name;
            std::replace(name.begin(), name.end(), '/', '-');
            name = stroke::group_name(fs::path(name));
        }
        s.group = {at->second, name};
    }
}

// One ink for all areas but those that are white.
void use_ink(stroke::JournalEntry& entry, const std::string& ink) {
    const stroke::Fill* fill = entry.as<stroke::Fill>();
    if (fill && fill->area && fill->ink != "#ffffff") stroke::set_ink(entry, ink);
}

}  // namespace

stroke::EntryOptions entry_options(const Paint& a) {
    stroke::StrokeSettings settings;
    settings.spine = stroke::spine_method_of(a.stroke.spine);
    settings.footprint = stroke::footprint_mapping_of(a.stroke.footprint);
    settings.contact = stroke::contact_method_of(a.stroke.contact);
    settings.endless = a.stroke.dip == "endless";
    settings.dip = settings.endless ? stroke::DipMode::each : stroke::dip_mode_of(a.stroke.dip);
    settings.smooth = a.hand.smooth;
    settings.stabilise = a.hand.stabilise_mm * kMillimetre;
    settings.roll = a.hand.roll_deg * kDegree;
    settings.roll_follow = a.hand.roll_follow;
    settings.film = stroke::film_model_of(a.wet.film);
    settings.down = {a.wet.down[0], a.wet.down[1], a.wet.down[2]};
    stroke::EntryOptions options{.settings = settings,
                                 .brush = a.stroke.brush,
                                 .ink = a.stroke.ink,
                                 .pressure = stroke::pressure_from(a.hand.pressure),
                                 .erases = a.stroke.erases};
    for (const std::string& text : a.stroke.prepare) options.prepare.push_back(stroke::preparation_of(text));
    return options;
}

std::vector<stroke::JournalEntry> load_strokes(const Paint& a, Console& console) {
    const stroke::EntryOptions options = entry_options(a);
    std::optional<stroke::BiasCorrection> bias;
    if (!a.hand.bias.empty()) bias = stroke::load_bias(a.hand.bias);

    std::vector<stroke::JournalEntry> strokes;
    std::uint64_t n_groups = 0;
    std::set<std::string> reported;  // a file that is painted twice is reported once
    for (const fs::path& file : a.strokes) {
        if (a.hand.as_pointer && lower_extension(file).starts_with(".svg"))
            throw UsageError(file.string() + ": a drawing is no recording of a hand, which --as-pointer takes");
        const std::size_t first = strokes.size();
        const io::InkmlOptions reading{.actions = true, .note = [&](const Message& line) {
                                           const std::string text = file.string() + ": " + line.text();
                                           if (reported.insert(text).second) console.note(text);
                                       }};
        std::vector<stroke::RecordedStroke> traces = io::read_strokes(
            file,
            io::SvgOptions{
                .painting = painting_of(a), .groups = a.drawing.only, .outlines = fills_wide_lines(a), .ink = reading});
        if (bias) traces = stroke::correct_bias(*bias, std::move(traces));
        for (stroke::RecordedStroke& trace : traces)
            for (stroke::Preparation& one : trace.before)
                if (auto* fill = std::get_if<stroke::Fill>(&one); fill && fill->area)
                    if (!a.place.edges.empty() || !fill->area->placed) fill->area->edges = edges_of(a);
        stroke::append_entries(strokes, std::move(traces), options);
        number_groups(std::span(strokes).subspan(first), file, n_groups);
        if (!a.stroke.ink.empty())
            for (std::size_t i = first; i < strokes.size(); ++i) use_ink(strokes[i], a.stroke.ink);
        if (a.wet.dry >= 0 && !strokes.empty())
            strokes.emplace_back(stroke::Dry{.seconds = a.wet.dry, .down = options.settings.down});
        report(console.progress(), "strokes", 1);
    }
    return strokes;
}

render::View picture_view(const View& v, const mesh::TriangleMesh& mesh) {
    render::View view;
    view.azimuth = v.azimuth * kDegree;
    view.elevation = v.elevation * kDegree;
    if (!v.target_mm.empty()) {
        view.target = kMillimetre * vector_of(v.target_mm);
        view.width_at_target = mesh.bounds.diagonal() / v.zoom;
    } else if (v.zoom != 1) {
        view.target = mesh.bounds.centre();
        view.width_at_target = 1.3 * mesh.bounds.diagonal() / v.zoom;
    }
    return view;
}

render::PictureOptions picture_options(const View& v, const stroke::Model& model) {
    render::PictureOptions options;
    options.width = v.width;
    options.height = v.height;
    options.view = picture_view(v, *model.mesh);
    options.light_azimuth = v.light * kDegree;
    if (v.raking) options.lights = render::Lights::raking;
    return options;
}

render::Image draw_picture(const PictureRequest& request, Console& console) {
    const auto& [model, painting, v, material, frame, count] = request;
    const pictures::PictureLook look = pictures::make_look(model, painting, material, v.raking);
    render::PictureOptions options = picture_options(v, model);
    options.progress = console.progress();
    if (count > 1) options = render::turntable_frame(options, frame, count);
    if (!painting) return render::render_picture(*model.mesh, *model.query, look.appearance, options);
    return render::render_with_glass(*model.mesh, *painting->parts().surface(), look.appearance,
                                     pictures::glass_of(look, *painting), options);
}

void check_outputs(const Outputs& o) {
    check_extension(o.project, {".tuft"});
    check_extension(o.exported, {".glb", ".gltf", ".obj"});
    check_extension(o.preview, {".png"});
    for (const fs::path& path : {o.project, o.exported, o.preview}) check_output(path);
}

void write_outputs(const Outputs& o, const stroke::Document& painting, Console& console) {
    const stroke::Model& model = painting.model();
    const stroke::Appearance& shown = painting.appearance();
    if (!o.exported.empty()) {
        const io::ModelMaps maps =
            io::make_maps(shown.stack(), model.texels, shown.substrate(), shown.compose_options());
        const std::vector<Message> notes =
            io::export_model(o.exported, *model.mesh, model.atlas, maps,
                             {.frame = o.frame,
                              .painted = io::painted_parts(shown.stack(), *model.mesh, model.atlas, model.texels),
                              .transmits = io::transmitting_parts(shown.stack(), shown.substrate(), *model.mesh,
                                                                  model.atlas, model.texels),
                              .progress = console.progress()});
        for (const Message& note : notes) console.note(note.text());
    }
    if (!o.preview.empty())
        write_picture(o.preview, draw_picture({.model = model, .painting = &painting, .view = o.view}, console));
}

void write_picture(const fs::path& path, const render::Image& image) {
    io::write_image(path, io::view_of(image.width, image.height, 3, image.rgb.data()));
}

io::Project start_project(const fs::path& path, const std::string& source, const FileFrame& frame,
                          stroke::Document& painting, const std::vector<stroke::JournalEntry>& strokes) {
    const stroke::Model& model = painting.model();
    io::Project project =
        io::Project::create(path, {.source = source,
                                   .frame = frame,
                                   .mesh = *model.mesh,
                                   .atlas = model.atlas,
                                   .substrate = ink::substrate_toml(painting.materials().substrate())});
    io::store_recolouring(project, painting);
    put_presets(project, painting, strokes);
    return project;
}

void put_presets(io::Project& project, stroke::Document& painting, const std::vector<stroke::JournalEntry>& strokes) {
    std::set<std::string> brushes, inks;
    for (const stroke::JournalEntry& s : strokes) {
        const std::string& brush = stroke::brush_of(s);
        if (stroke::has_brush(stroke::kind_of(s)) && brushes.insert(brush).second)
            project.put_brush({brush, brush::preset_toml(painting.materials().brush(brush))});
        for (const std::string& ink : stroke::inks_of(s))
            if (inks.insert(ink).second) project.put_ink({ink, ink::ink_toml(painting.materials().ink(ink))});
    }
}

void find_presets(stroke::Document& painting, const std::vector<stroke::JournalEntry>& strokes) {
    for (const stroke::JournalEntry& s : strokes) {
        if (stroke::has_brush(stroke::kind_of(s))) painting.materials().brush(stroke::brush_of(s));
        for (const std::string& ink : stroke::inks_of(s)) painting.materials().ink(ink);
    }
}

bool is_project_file(const fs::path& path) {
    return path.extension() == ".tuft" || io::is_project(path);
}

void show_layers(stroke::Document& painting, const std::vector<std::string>& names) {
    std::vector<std::uint32_t> ids;
    std::vector<std::string> all;
    for (const stroke::Layer& layer : painting.layers().table().layers) all.push_back(layer.name);
    for (const std::string& name : names) {
        const stroke::Layer* layer = painting.layers().table().find(name);
        if (!layer) throw UsageError(fmt::format("there is no layer '{}'; there are {}", name, fmt::join(all, ", ")));
        ids.push_back(layer->id);
    }
    if (!ids.empty()) painting.appearance().show_only(std::move(ids));
}

io::OpenOptions open_options(io::Access access, Console& console) {
    return {.access = access, .patience = std::chrono::seconds(2), .progress = console.progress()};
}

std::optional<io::ProjectLock> reserve(const fs::path& path, Console& console) {
    if (path.empty()) return std::nullopt;
    const io::OpenOptions options = open_options(io::Access::write, console);
    return io::ProjectLock(path, options.patience, options.progress);
}

std::unique_ptr<OpenProject> open_project(const fs::path& path, io::Access access, Console& console,
                                          const DiskCache& cache) {
    auto opened =
        std::make_unique<OpenProject>(OpenProject{.file = io::Project::open(path, open_options(access, console))});
    io::ProjectModel stored = opened->file.model();
    opened->source = stored.source;
    opened->frame = stored.frame;
    opened->substrate = ink::parse_substrate(stored.substrate, path.string());
    opened->model = stroke::prepare_model(std::move(stored.mesh), std::move(stored.atlas),
                                          stroke::ModelOptions{.cache = cache, .progress = console.progress()});
    return opened;
}

void apply_recolouring(const io::Project& project, stroke::Document& painting, const Recolouring& recolouring,
                       Console& console) {
    io::apply_recolouring(project, painting);
    std::set<std::string> used;
    for (const stroke::JournalEntry& s : painting.journal().entries())
        if (const std::string& ink = stroke::ink_of(s); !ink.empty()) used.insert(ink);
    for (const std::string& text : recolouring.recolours) {
        const auto equals = text.find('=');
        if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
            throw UsageError("--recolour: '" + text + "' is not INK=NAME, INK=FILE.toml or INK=#rrggbb");
        const std::string name = text.substr(0, equals);
        if (!used.contains(name))
            throw Error(Message("nothing is painted with ink '{}'; there are: {}", name,
                                fmt::format("{}", fmt::join(used, ", "))));
        painting.appearance().recolour(name,
                                       ink::ink_named(text.substr(equals + 1), painting.appearance().substrate()));
        for (const std::string& other : used)
            if (other != name &&
                !ink::shared_pigments(painting.materials().ink(name), painting.materials().ink(other)).empty())
                console.note(fmt::format("warning: ink {} shares pigments with {} and changes with it", other, name));
    }
    if (!recolouring.substrate.empty())
        painting.appearance().preview_substrate(ink::load_substrate(recolouring.substrate));
}

void restore(const OpenProject& project, stroke::Document& painting, Console& console) {
    painting.use(project.substrate);
    io::use_presets(project.file, painting);
    io::restore_strokes(project.file, painting, console.progress());
}

void check_on_surface(const stroke::Model& model, const Vec3& at, const char* option) {
    constexpr double kBeside = 0.05;  // of the diagonal
    const auto near = model.query->closest_point(at);
    if (!near || near->distance <= kBeside * model.mesh->bounds.diagonal()) return;
    const Vec3 mm = near->position / kMillimetre;
    throw Error(
        fmt::format("{}: the point lies {:.1f} mm beside the model, whose nearest point is {:.3f},{:.3f},{:.3f}",
                    option, near->distance / kMillimetre, mm.x, mm.y, mm.z));
}

void print_json(const nlohmann::json& json) {
    std::cout << json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
}

nlohmann::json to_json(const stroke::Layer& layer) {
    return {{"id", layer.id},
            {"name", layer.name},
            {"visible", layer.visible},
            {"opacity", layer.opacity},
            {"blend", ink::name_of(layer.blend)},
            {"locked", layer.locked}};
}

nlohmann::json to_json(const mesh::RepairReport& r) {
    return {{"points_in_file", r.file.points},
            {"polygons_in_file", r.file.polygons},
            {"polygons_triangulated", r.file.polygons_triangulated},
            {"vertices_welded", r.vertices_welded},
            {"unused_vertices_dropped", r.unused_vertices_dropped},
            {"degenerate_faces_dropped", r.degenerate_faces_dropped},
            {"duplicate_faces_dropped", r.duplicate_faces_dropped},
            {"non_manifold_edges_split", r.non_manifold.edges_split},
            {"non_manifold_vertices_split", r.non_manifold.vertices_split},
            {"faces_flipped", r.faces_flipped},
            {"components", r.components},
            {"holes", r.holes},
            {"border_edges", r.border_edges},
            {"closed", r.closed},
            {"warnings", texts(r.warnings)}};
}

nlohmann::json to_json(const atlas::Atlas& a, const atlas::AtlasReport& r) {
    nlohmann::json j{{"size", a.page_size()},
                     {"pages", a.pages},
                     {"texel_size_mm", a.texel_size / kMillimetre},
                     {"gutter", a.gutter},
                     {"uvs_from_file", a.from_file},
                     {"charts", r.charts},
                     {"flips", r.flips},
                     {"overlapping_texels", r.overlapping_texels},
                     {"roomless_triangles", r.zero_area_triangles},
                     {"l2_stretch", r.l2_stretch},
                     {"linf_stretch", r.linf_stretch},
                     {"angle_distortion", r.angle_distortion},
                     {"area_distortion", r.area_distortion},
                     {"utilisation", r.utilisation},
                     {"seam_length", r.seam_length},
                     {"smallest_gap", r.smallest_gap}};
    for (std::uint32_t page = 0; page < a.pages; ++page) j["udims"].push_back(atlas::udim_of(a, page));
    j["seconds"] = nlohmann::json::object();
    for (const auto& [phase, seconds] : r.seconds)  // some phases come more than once
        j["seconds"][phase] = j["seconds"].value(phase, 0.0) + seconds;
    return j;
}

nlohmann::json to_json(const stroke::StrokeReport& r, const stroke::JournalEntry& s) {
    return {{"id", r.stroke_id},
            {"label", s.label},
            {"brush", stroke::brush_of(s)},
            {"ink", stroke::ink_of(s)},
            {"samples", r.samples},
            {"stamps", r.stamps},
            {"unconverged", r.unconverged},
            {"ink_mm3", r.ink_given * ink::kFilmUnit * 1e9},
            {"removed_mm3", r.removed.sum() * ink::kFilmUnit * 1e9},
            {"touched", r.touched()},
            {"nearest_mm", r.nearest / kMillimetre},
            {"inside_mm", r.inside.deepest / kMillimetre},
            {"origin_inside_mm", r.inside.origin / kMillimetre},
            {"path_mm", r.path / kMillimetre},
            {"dry_from_mm", r.dryness.from < 0 ? nlohmann::json() : nlohmann::json(r.dryness.from / kMillimetre)},
            {"dry_path_mm", r.dryness.path / kMillimetre},
            {"ran_dry", r.ran_dry()}};
}

double peak_megabytes() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace tuft::cli
