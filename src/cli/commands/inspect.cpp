#include "mesh/repair/inspect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "cli/steps/commands.h"
#include "cli/steps/steps.h"
#include "core/files/files.h"
#include "core/text/counted.h"
#include "core/text/units.h"
#include "io/model/read_model.h"
#include "stroke/document/pick.h"
#include "stroke/journal/tables.h"

namespace tuft::cli {
namespace {

nlohmann::json vector_json(const Vec3& v_metres) {
    return {v_metres.x / kMillimetre, v_metres.y / kMillimetre, v_metres.z / kMillimetre};
}

// What lies at one point, as pigments of films.
int inspect_point(const Inspect& a) {
    check_extension(a.save_ink, {".toml"});
    check_output(a.save_ink);
    Console console(a.common.quiet);
    const auto project = open_project(a.file, io::Access::read, console);
    stroke::Document painting(project->model);
    restore(*project, painting, console);
    console.clear();
    const Vec3 at = kMillimetre * vector_of(a.at_mm);
    const stroke::Pick pick = a.palette ? stroke::pick_on_palette(painting, at) : stroke::pick(painting, at);
    if (!a.palette) check_on_surface(project->model, at, "--at");
    const std::string name = a.save_ink.empty() ? "picked" : a.save_ink.stem().string();
    const std::optional<ink::Ink> ink = stroke::picked_ink(pick, painting.layers().pigments(), name);
    if (!a.save_ink.empty()) {
        if (!ink) throw Error(a.file.string(), "has no ink at this point to make an ink of");
        const std::string toml = ink::ink_toml(*ink);
        write_file(a.save_ink, toml.data(), toml.size());
    }
    const std::vector<ink::Pigment>& pigments = painting.layers().pigments();
    const auto amounts = [&](const auto& of) {
        nlohmann::json j = nlohmann::json::object();
        for (std::size_t p = 0; p < pigments.size(); ++p)
            if (of[p] > 0) j[pigments[p].name] = of[p];
        return j;
    };
    if (a.common.json) {
        nlohmann::json j{{"project", a.file.string()},
                         {"at_mm", vector_json(pick.at.position)},
                         {"distance_mm", pick.at.distance / kMillimetre},
                         {"film", amounts(pick.amounts)},
                         {"liquid", pick.liquid},
                         {"films", nlohmann::json::array()},
                         {"parts", nlohmann::json::object()}};
        for (const stroke::PickedFilm& f : pick.films)
            j["films"].push_back(
                {{"layer",
                  f.layer == stroke::kPaletteLayer ? "palette" : painting.layers().table().find(f.layer)->name},
                 {"film", f.film == ink::kOpenFilm     ? "open"
                          : f.film == ink::kSoakedFilm ? "soaked"
                                                       : "dry " + std::to_string(f.film)},
                 {"amounts", amounts(f.amounts)}});
        if (ink)
            for (const ink::InkPart& part : ink->parts) j["parts"][part.pigment.name] = part.fraction;
        print_json(j);
        return 0;
    }
    if (!ink) fmt::print("bare\n");
    for (std::size_t p = 0; p < pigments.size(); ++p)
        if (pick.amounts[p] > 0) fmt::print("{:<16} {:.3f} film units\n", pigments[p].name, pick.amounts[p]);
    return 0;
}

struct GroupSum {
    std::string name;
    std::size_t entries = 0, strokes = 0, hidden = 0;
};
std::map<std::uint64_t, GroupSum> groups_of(const std::vector<stroke::JournalEntry>& entries) {
    std::map<std::uint64_t, GroupSum> groups;
    for (const stroke::JournalEntry& s : entries) {
        if (s.group.id == 0) continue;
        GroupSum& sum = groups[s.group.id];
        sum.name = s.group.name;
        ++sum.entries;
        sum.strokes += stroke::kind_of(s) == stroke::EntryKind::stroke;
        sum.hidden += s.hidden;
    }
    return groups;
}

// All entries have all keys; what a kind does not have is as it is by default.
nlohmann::json entry_to_json(const stroke::JournalEntry& entry) {
    const stroke::PaintStroke* stroke = entry.as<stroke::PaintStroke>();
    const stroke::BrushAction* action = entry.as<stroke::BrushAction>();
    const stroke::DipMode dip = stroke ? stroke->settings.dip : action ? action->dip : stroke::DipMode::each;
    nlohmann::json out{{"id", entry.id},
                       {"group", entry.group.id},
                       {"action", stroke::name_of(stroke::kind_of(entry))},
                       {"dip", stroke::name_of(dip)},
                       {"label", entry.label},
                       {"layer", stroke::layer_of(entry)},
                       {"on", stroke::on_palette(entry) ? "palette" : "model"},
                       {"mask", stroke::mask_of(entry)},
                       {"tool", stroke && stroke->erases() ? "eraser" : "brush"},
                       {"brush", stroke::brush_of(entry)},
                       {"ink", stroke::ink_of(entry)},
                       {"samples", stroke::samples_of(entry).samples.size()},
                       {"hidden", entry.hidden}};
    for (const stroke::ChangeNumber& n : stroke::numbers_of(stroke::Dip{})) out[n.name] = n.usual;
    if (action)
        for (const stroke::ChangeNumber& n : stroke::numbers_of(action->what)) out[n.name] = n.value;
    return out;
}

/// What `inspect` says of a project.
struct ProjectFacts {
    const io::Project& file;
    const io::ProjectModel& model;
    std::vector<stroke::JournalEntry> strokes;
    stroke::LayerTable layers;
    std::map<std::uint64_t, GroupSum> groups;
};

nlohmann::json project_json(const ProjectFacts& p, const std::filesystem::path& file) {
    const atlas::AtlasReport quality = atlas::measure(p.model.mesh, p.model.atlas);
    nlohmann::json j{{"project", file.string()},
                     {"format", p.file.format()},
                     {"written_by", p.file.written_by()},
                     {"model", p.model.source},
                     {"triangles", p.model.mesh.n_triangles()},
                     {"size_mm", vector_json(p.model.mesh.bounds.size())},
                     {"atlas", to_json(p.model.atlas, quality)},
                     {"layers", nlohmann::json::array()},
                     {"masks", nlohmann::json::array()},
                     {"groups", nlohmann::json::array()},
                     {"strokes", nlohmann::json::array()}};
    for (const stroke::Mask& m : stroke::masks_after(p.strokes).masks)
        j["masks"].push_back({{"id", m.id}, {"name", m.name}, {"kind", stroke::name_of(m.kind)}});
    for (const stroke::Layer& l : p.layers.layers)  // the lowest first
        j["layers"].push_back(to_json(l));
    for (const auto& [id, group] : p.groups)
        j["groups"].push_back({{"id", id},
                               {"name", group.name},
                               {"entries", group.entries},
                               {"strokes", group.strokes},
                               {"hidden", group.hidden == group.entries}});
    for (const stroke::JournalEntry& s : p.strokes) j["strokes"].push_back(entry_to_json(s));
    return j;
}

void print_project(const ProjectFacts& p, const std::filesystem::path& file) {
    const mesh::TriangleMesh& mesh = p.model.mesh;
    const atlas::Atlas& atlas = p.model.atlas;
    const Vec3 size = mesh.bounds.size() / kMillimetre;
    fmt::print("{}: project by {}, of {}\n", file.string(), p.file.written_by(), p.model.source);
    fmt::print("{}, {:.1f} x {:.1f} x {:.1f} mm; atlas {} x {}, {}, texel {:.3f} mm\n",
               counted(mesh.n_triangles(), "triangle"), size.x, size.y, size.z, atlas.size, atlas.size,
               counted(atlas.n_charts, "chart"), atlas.texel_size / kMillimetre);
    if (p.layers != stroke::LayerTable{})
        for (auto l = p.layers.layers.rbegin(); l != p.layers.layers.rend(); ++l)
            fmt::print("  layer   {:>4}  {}, opacity {:g}{}{}{}\n", l->id, l->name, l->opacity,
                       l->blend == ink::Blend::normal ? "" : std::string(", ") + ink::name_of(l->blend),
                       l->visible ? "" : ", hidden", l->locked ? ", locked" : "");
    std::uint64_t group = 0;
    for (const stroke::JournalEntry& s : p.strokes) {
        if (s.group.id != 0 && s.group.id != group) {
            const GroupSum& sum = p.groups.at(s.group.id);
            fmt::print("  group   {:>4}  {}: {}{}\n", s.group.id, sum.name, counted(sum.strokes, "stroke"),
                       sum.hidden == sum.entries ? " (hidden)" : "");
        }
        group = s.group.id;
        fmt::print("  {}{:<7} {:>4}  {:<14} {:<10} {:>6} samples  {}{}\n", group ? "  " : "",
                   stroke::name_of(stroke::kind_of(s)), s.id, stroke::brush_of(s), stroke::ink_of(s),
                   stroke::samples_of(s).samples.size(), s.label, s.hidden ? " (hidden)" : "");
    }
}

int inspect_project(const Inspect& a) {
    if (!a.at_mm.empty()) return inspect_point(a);
    Console console(a.common.quiet);
    const io::Project project = io::Project::open(a.file, open_options(io::Access::read, console));
    const io::ProjectModel model = project.model();
    std::vector<stroke::JournalEntry> strokes = project.strokes();
    const ProjectFacts facts{.file = project,
                             .model = model,
                             .strokes = strokes,
                             .layers = stroke::layers_after(strokes),
                             .groups = groups_of(strokes)};
    if (a.common.json)
        print_json(project_json(facts, a.file));
    else
        print_project(facts, a.file);
    return 0;
}

// What the UVs of a file cannot do well on pages of `page` texels, even where they are kept.
std::vector<std::string> uv_notes(const mesh::TriangleMesh& mesh, const atlas::Atlas& atlas, int gap,
                                  std::uint32_t page) {
    constexpr double kSmallChart = 9, kUneven = 3;  // texels; between the sizes of texels
    std::vector<std::string> notes;
    if (gap == 1)
        notes.push_back(
            fmt::format("charts lie 1 texel apart, and what lies between can have the colour of one only: where ink "
                        "ends at a seam, a line may show; at {} x {} texels they are 2 apart",
                        2 * page, 2 * page));
    if (gap > 1 && gap < 4)
        notes.push_back(fmt::format(
            "charts lie {} texels apart: clean up close, but from afar, in mip-maps, their colours mix", gap));
    std::vector<double> chart_texels(atlas.n_charts, 0);
    std::vector<std::pair<double, double>> texels;  // metres, m² of surface
    double area = 0;
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
        const Vec3 a = mesh.position(t, 0);
        const double here = 0.5 * glm::length(glm::cross(mesh.position(t, 1) - a, mesh.position(t, 2) - a));
        const Vec2 p(atlas.corner_uvs[3 * t]);
        const Vec2 u = Vec2(atlas.corner_uvs[3 * t + 1]) - p, v = Vec2(atlas.corner_uvs[3 * t + 2]) - p;
        const double n = 0.5 * std::abs(u.x * v.y - u.y * v.x) * atlas.size * atlas.size;
        if (!(n > 0 && std::isfinite(n))) continue;
        chart_texels[atlas.triangle_chart[t]] += n;
        texels.emplace_back(std::sqrt(here / n), here);
        area += here;
    }
    const auto small =
        std::count_if(chart_texels.begin(), chart_texels.end(), [](double n) { return n < kSmallChart; });
    if (small > 0)
        notes.push_back(
            fmt::format("{} of the charts have less than 3 x 3 texels: a stroke over them is as coarse", small));
    std::sort(texels.begin(), texels.end());
    const auto quantile = [&](double part) {
        double sum = 0;
        for (const auto& [size, here] : texels)
            if ((sum += here) >= part * area) return size;
        return texels.empty() ? 0 : texels.back().first;
    };
    const double finest = quantile(0.01), coarsest = quantile(0.99);
    if (coarsest > kUneven * finest)
        notes.push_back(
            fmt::format("texels are {:.3g} to {:.3g} mm wide, from place to place: ink is as much coarser there",
                        finest / kMillimetre, coarsest / kMillimetre));
    return notes;
}

/// What `inspect` says of a mesh.
struct MeshFacts {
    mesh::MeshSummary summary;
    atlas::UvCheck uvs;  ///< of the file, on pages of kPage texels
    atlas::AtlasReport quality;
    std::vector<std::string> uv_notes;
};

constexpr std::uint32_t kPage = 2048;  // texels that the file's UVs are measured on

/// Reads and repairs a mesh.
MeshFacts mesh_facts(const Inspect& a, Console& console) {
    mesh::PolygonSoup soup = io::read_model(a.file, cad_reading(a.file, a));
    Box bounds;
    for (const Vec3& p : soup.points) bounds.add(p);
    const mesh::UnitGuess guess = mesh::guess_unit(bounds);
    FileReading how = a;
    if (!io::metres_per_unit(soup, a.unit)) how.unit = guess.unit;
    const bool stated = soup.stated_unit > 0, overridden = io::overrides_unit(soup, a.unit);
    mesh::RepairOptions options = repair_of(soup, a.file, how, console);
    options.progress = console.progress();
    mesh::Surface surface;
    try {
        surface = mesh::build_surface(std::move(soup), options);
    } catch (const Error& error) {
        throw Error(a.file.string(), error.what());
    }
    MeshFacts facts{
        .summary = mesh::summarise(surface, options.metres_per_unit), .uvs = {}, .quality = {}, .uv_notes = {}};
    if (stated && !overridden)
        facts.summary.unit = {.unit = "m", .metres_per_unit = 1, .second = {}, .sentence = "as the file says"};
    else if (stated)
        facts.summary.unit = {.unit = a.unit,
                              .metres_per_unit = options.metres_per_unit,
                              .second = {},
                              .sentence = "not as the file says (--unit)"};
    if (facts.summary.has_uvs) {
        facts.uvs = atlas::check_file_uvs(surface.mesh, kPage);
        facts.quality = atlas::measure(surface.mesh, facts.uvs.atlas);
        if (facts.uvs.fault.empty())
            facts.uv_notes = uv_notes(surface.mesh, facts.uvs.atlas, facts.quality.smallest_gap, kPage);
    }
    return facts;
}

nlohmann::json mesh_json(const MeshFacts& facts, const std::filesystem::path& file) {
    const mesh::MeshSummary& s = facts.summary;
    const atlas::UvCheck& uvs = facts.uvs;
    return {{"file", file.string()},
            {"triangles", s.n_triangles},
            {"vertices", s.n_vertices},
            {"size_mm", vector_json(s.bounds.size())},
            {"area_cm2", s.area * 1e4},
            {"volume_cm3", s.volume * 1e6},
            {"median_edge_mm", s.median_edge / kMillimetre},
            {"unit_guess", s.unit.unit},
            {"unit_note", s.unit.sentence},
            {"has_colours", s.has_colours},
            {"pictures", s.pictures},
            {"groups", s.group_names},
            {"defects", texts(mesh::describe_defects(s.report))},
            {"mesh", to_json(s.report)},
            {"has_uvs", s.has_uvs},
            {"uv_fault", s.has_uvs && !uvs.fault.empty() ? nlohmann::json(uvs.fault.text()) : nlohmann::json()},
            {"uv_notes", facts.uv_notes},
            {"atlas", s.has_uvs ? to_json(uvs.atlas, facts.quality) : nlohmann::json()}};
}

void print_mesh(const MeshFacts& facts, const std::filesystem::path& file) {
    fmt::print("{}\n", file.string());
    for (const std::string& line : mesh::describe(facts.summary)) fmt::print("{}\n", line);
    if (!facts.summary.has_uvs) return fmt::print("UVs: none; painting makes them\n");
    const auto& [summary, uvs, quality, notes] = facts;
    fmt::print("UVs: {} on {}, seams {:.1f} x the diagonal; stretch L2 {:.4f}, Linf {:.2f}; {:.0f} % used\n",
               counted(quality.charts, "chart"),
               uvs.atlas.pages > 1 ? fmt::format("{} UDIM pages", uvs.atlas.pages) : "one page", quality.seam_length,
               quality.l2_stretch, quality.linf_stretch, 100 * quality.utilisation);
    fmt::print("     {} flipped triangles, {} without room; at {} x {} texels {} overlap, gap {}\n", quality.flips,
               quality.zero_area_triangles, kPage, kPage, quality.overlapping_texels, quality.smallest_gap);
    if (uvs.fault.empty())
        fmt::print("     --keep-uv keeps them\n");
    else
        fmt::print("     they cannot be kept: {}\n", uvs.fault.text());
    for (const std::string& note : notes) fmt::print("     {}\n", note);
}

}  // namespace

int run(const Inspect& a) {
    if (a.file.extension() == ".tuft" || io::is_project(a.file)) return inspect_project(a);
    if (!a.at_mm.empty()) throw UsageError("--at looks at a project, not at a mesh");
    Console console(a.common.quiet);
    const MeshFacts facts = mesh_facts(a, console);
    console.clear();
    if (a.common.json)
        print_json(mesh_json(facts, a.file));
    else
        print_mesh(facts, a.file);
    return 0;
}

}  // namespace tuft::cli
